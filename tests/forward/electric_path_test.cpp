// Leakage and current sources in designs, against the circuit of `papilla solve drive`.
#include "forward/electric_path.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>

#include "base/constants.h"
#include "forward/scale_bridge.h"
#include "forward/scene_terms.h"
#include "physics/drive/network.h"
#include "physics/macro/fingertip.h"

namespace papilla::tests::electric_path_test {
namespace {

constexpr double kHumidity = 0.55, kGap = 0.4e-6, kArea = 3e-6;

Scene leaky(double resistivity, Waveform waveform = Waveform::Sine, double frequency = 5e3) {
  Scene scene;
  scene.drive.amplitude = 100;
  scene.drive.waveform = waveform;
  scene.drive.frequency = frequency;
  scene.surface.dielectric[0].thickness = 1e-6;
  scene.surface.dielectric[0].resistivity = resistivity;
  return scene;
}

constexpr std::array kFieldMethods{FieldMethod::Local, FieldMethod::Spread, FieldMethod::Full};

// The pull on a plane gap by the field rule of a design [Pa].
double pull(const Scene& scene) {
  const Grid grid{16, 16, 12e-6, 12e-6};
  const Gap gap{grid, std::vector<double>(grid.size(), kGap)};
  const CoveredSurface surface({grid, std::vector<double>(grid.size(), 0)}, film_of(scene));
  const FieldSolution out =
      solve_field(scene, gap, &surface, {}, field_problem(scene, kHumidity), 1e-9);
  EXPECT_TRUE(out.ok) << out.reason;
  return out.mean_pressure;
}

// The same gap, film and skin as a circuit.
Network circuit(const Scene& scene) {
  const ElectricalLayer& skin = scene.finger.electrical;
  const Dielectric& film = scene.surface.dielectric[0];
  const auto insulating = [](double value) { return value > 0 ? value : kInfinity; };
  Network n;
  n.dielectric = slab(film.thickness, film.permittivity, insulating(film.resistivity), kArea);
  const double capacitance = kVacuumPermittivity * kArea / skin.equivalent_thickness(kHumidity);
  n.skin = {1 / (2 * kPi * skin.corner_frequency * capacitance), capacitance};
  n.gap = plane_gap(kGap, 1, insulating(skin.gap_resistivity) * kGap / kArea, kArea);
  return n;
}

// Mean force of the circuit over its area [Pa].
double circuit_pull(const Scene& scene, double frequency) {
  const DriveResponse r =
      drive::respond(circuit(scene), DriveControl::Voltage, scene.drive.amplitude, frequency);
  return r.mean_force / kArea;
}

// The circuit is an exact complex solve of the flat stack.
TEST(ElectricPath, ALeakyFilmPullsAsTheCircuitOfSolveDriveAtEveryFrequency) {
  for (const double resistivity : {1e5, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e14}) {
    for (const double frequency : {0.1, 1.0, 30.0, 300.0, 5e3, 1e5}) {
      Scene scene = leaky(resistivity, Waveform::Sine, frequency);
      const double expected = circuit_pull(scene, frequency);
      for (const FieldMethod method : kFieldMethods) {
        scene.model.field = method;
        EXPECT_NEAR(pull(scene), expected, 0.01 * expected)
            << resistivity << ", " << frequency << ", " << static_cast<int>(method);
      }
    }
  }
}

// By hand: resistances in series share the voltage, and the gap has the field of its share.
TEST(ElectricPath, ADirectVoltageSharesItselfByResistances) {
  for (const double resistivity : {1e8, 3e8, 1e9, 3e9, 1e10, 1e11, 1e12}) {
    Scene scene = leaky(resistivity, Waveform::Dc);
    const ElectricalLayer& skin = scene.finger.electrical;
    // Each times an area [ohm m^2]; the skin's by its corner, 1 / (2 pi R C).
    const double of_gap = skin.gap_resistivity * kGap, of_film = resistivity * 1e-6;
    const double of_skin = skin.equivalent_thickness(kHumidity) /
                           (2 * kPi * skin.corner_frequency * kVacuumPermittivity);
    const double field = 100 * of_gap / (of_gap + of_film + of_skin) / kGap;
    const double expected = 0.5 * kVacuumPermittivity * square(field);
    for (const FieldMethod method : kFieldMethods) {
      scene.model.field = method;
      EXPECT_NEAR(pull(scene), expected, 0.01 * expected)
          << resistivity << ", " << static_cast<int>(method);
    }
  }
}

TEST(ElectricPath, ADirectVoltageOnALeakyFilmGivesJohnsenAndRahbeksForce) {
  for (const double resistivity : {1e6, 1e9, 1e11}) {
    const Scene scene = leaky(resistivity, Waveform::Dc);
    // At 0 Hz the circuit's mean force is that of a constant voltage.
    const double expected = circuit_pull(scene, 0);
    EXPECT_NEAR(pull(scene), expected, 0.01 * expected) << resistivity;
  }
}

TEST(ElectricPath, ADirectVoltageOnAPerfectInsulatorLeavesNoForce) {
  const double alternating = pull(leaky(0));
  EXPECT_LT(pull(leaky(0, Waveform::Dc)), 1e-12 * alternating);
  EXPECT_GT(alternating, 1e4);
  Scene sealed = leaky(0, Waveform::Dc);  // where nothing leaks at all, the charge stays
  sealed.finger.electrical.gap_resistivity = 0;
  sealed.finger.electrical.corner_frequency = 0;
  EXPECT_NEAR(pull(sealed), 2 * alternating, 0.01 * alternating);
}

TEST(ElectricPath, TheFieldInALeakyFilmIsItsShareOfTheVoltage) {
  for (const double frequency : {10.0, 5e3}) {
    const Scene scene = leaky(1e8, Waveform::Sine, frequency);
    const Network n = circuit(scene);
    const std::complex<double> film = n.dielectric.impedance(frequency);
    const double share =
        std::abs(film / (film + n.gap.layer.impedance(frequency) + n.skin.impedance(frequency)));
    const Grid grid{16, 16, 12e-6, 12e-6};
    const Gap gap{grid, std::vector<double>(grid.size(), kGap)};
    const CoveredSurface surface({grid, std::vector<double>(grid.size(), 0)}, film_of(scene));
    const double field =
        solve_field(scene, gap, &surface, {}, field_problem(scene, kHumidity), 1e-9)
            .peak_oxide_field;
    EXPECT_NEAR(field, share * 100 / 1e-6, 0.02 * field) << frequency;
  }
}

TEST(ElectricPath, ElectrowettingTakesTheVoltageOfFilmAndSkinBelowWater) {
  const Scene insulating = leaky(0);
  const double h = insulating.surface.equivalent_thickness() +
                   insulating.finger.electrical.equivalent_thickness(kHumidity);
  EXPECT_NEAR(wetted_series(insulating, kHumidity), h, 0.01 * h);
  // A conducting film leaves all of it to the skin, a thinner capacitor.
  const double skin = insulating.finger.electrical.equivalent_thickness(kHumidity);
  EXPECT_NEAR(wetted_series(leaky(1), kHumidity), skin, 0.01 * skin);
}

// Of the circuit without its gap: water that leads stands in its place.
TEST(ElectricPath, WaterHasTheMagnitudeOfTheCircuitsPotentialBetweenFilmAndSkin) {
  for (const double resistivity : {1e5, 1e8, 1e10, 0.0}) {
    for (const double frequency : {0.1, 30.0, 5e3}) {
      const Scene scene = leaky(resistivity, Waveform::Sine, frequency);
      const Network n = circuit(scene);
      const std::complex<double> film = n.dielectric.impedance(frequency),
                                 skin = n.skin.impedance(frequency);
      const double expected = std::abs(skin / (film + skin));
      const FieldProblem p = field_problem(scene, kHumidity);
      // A film that leads leaves all of the voltage to the water, but for a ten-thousandth.
      EXPECT_NEAR(p.water_skin_layer / (p.water_skin_layer + p.dielectric), expected, 2e-4)
          << resistivity << ' ' << frequency;
    }
  }
  const Scene scene = leaky(0);
  const double h = scene.finger.electrical.equivalent_thickness(kHumidity);
  EXPECT_NEAR(field_problem(scene, kHumidity).water_skin_layer, h, 1e-3 * h);  // far above corners
}

TEST(ElectricPath, WaterIsAtTheBodysPotentialInThePublishedRuleAndWithoutALayer) {
  Scene scene = leaky(0);
  scene.finger.electrical.thickness_15 = scene.finger.electrical.thickness_75 = 0;
  EXPECT_EQ(field_problem(scene, kHumidity).water_skin_layer, 0);
  Scene paper = leaky(0);
  paper.model.preset = Preset::M3;
  EXPECT_EQ(field_problem(paper, kHumidity).water_skin_layer, 0);
}

TEST(ElectricPath, ACurrentTakesTheVoltageOfTheRidgesImpedance) {
  Scene scene = leaky(0);
  scene.drive.control = DriveControl::Current;
  scene.drive.amplitude = 0;
  scene.drive.current = 0.1e-3;
  const RidgeLoad ridges = ridge_load(scene.finger.macro, scene.finger.load, kHumidity);
  const double film = scene.surface.equivalent_thickness();
  const double gap = capacitive_gap(scene.finger, ridges.mean_pressure, film, kHumidity);
  const double skin = scene.finger.electrical.equivalent_thickness(kHumidity);
  const double capacitance = kVacuumPermittivity * ridges.area / (gap + film + skin);
  const double expected = 0.1e-3 / (2 * kPi * 5e3 * capacitance);
  EXPECT_NEAR(source_voltage(scene, kHumidity).peak, expected, 1e-3 * expected);
  EXPECT_NEAR(source_voltage(scene, kHumidity).rms, expected / std::sqrt(2.0), 1e-3 * expected);
  EXPECT_FALSE(source_voltage(scene, kHumidity).at_compliance);
  scene.drive.source_compliance = 0.5 * expected;
  EXPECT_TRUE(source_voltage(scene, kHumidity).at_compliance);
  EXPECT_EQ(source_voltage(scene, kHumidity).peak, 0.5 * expected);
}

TEST(ElectricPath, TheCurrentsVoltageFallsAsTheContactGrowsWithHumidity) {
  Scene scene = leaky(0);
  scene.drive.control = DriveControl::Current;
  scene.drive.current = 0.1e-3;
  const double dry = source_voltage(scene, 0.15).peak, moist = source_voltage(scene, 0.75).peak;
  EXPECT_GT(dry / moist, 1 + scene.finger.macro.area_growth * 0.8);
}

TEST(ElectricPath, ADirectVoltageRelaxesInTheTimeOfItsCircuit) {
  const Scene scene = leaky(1e9, Waveform::Dc);
  const Network n = circuit(scene);
  // Film and skin in parallel with the gap for the charge between them.
  const double conductance =
      1 / n.gap.layer.resistance + 1 / (n.dielectric.resistance + n.skin.resistance);
  const double capacitance =
      n.gap.layer.capacitance + 1 / (1 / n.dielectric.capacitance + 1 / n.skin.capacitance);
  const double expected = capacitance / conductance;
  EXPECT_NEAR(relaxation_time(scene, kHumidity, kGap), expected, 1e-6 * expected);
}

// By hand: impedances in series, the skin a resistor beside a constant-phase element.
std::complex<double> skin_impedance(const Scene& scene, double frequency) {
  const ElectricalLayer& skin = scene.finger.electrical;
  const Network n = circuit(scene);
  const double alpha = skin.skin_exponent;
  const double q = n.skin.capacitance * std::pow(2 * kPi * skin.dispersion_frequency, 1 - alpha);
  const std::complex<double> turning(0, 2 * kPi * frequency);
  return 1.0 / (1 / n.skin.resistance + q * std::pow(turning, alpha));
}

// The gap's capacitor of air beside leakage that rises as a power of the frequency.
std::complex<double> gap_impedance(const Scene& scene, double frequency) {
  const ImpedanceLayer layer = circuit(scene).gap.layer;
  const std::complex<double> turning(0, 2 * kPi * frequency);
  const std::complex<double> leaks = std::pow(1.0 + turning * layer.resistance * layer.capacitance,
                                              1 - scene.finger.electrical.gap_exponent);
  return 1.0 / (turning * layer.capacitance + leaks / layer.resistance);
}

TEST(ElectricPath, ADispersiveSkinAndGapPullAsTheirComplexImpedancesSay) {
  for (const double skin : {1.0, 0.85, 0.7}) {
    for (const double gap : {1.0, 0.8}) {
      for (const double frequency : {3.0, 60.0, 1e3, 5e3, 1e5}) {
        for (const double resistivity : {1e8, 1e14}) {
          Scene scene = leaky(resistivity, Waveform::Sine, frequency);
          scene.finger.electrical.skin_exponent = skin;
          scene.finger.electrical.gap_exponent = gap;
          scene.finger.electrical.thickness_15 = scene.finger.electrical.thickness_75 = 300e-9;
          const std::complex<double> of_gap = gap_impedance(scene, frequency);
          const std::complex<double> all = of_gap + skin_impedance(scene, frequency) +
                                           circuit(scene).dielectric.impedance(frequency);
          const double field = 100 / std::sqrt(2.0) * std::abs(of_gap / all) / kGap;
          const double expected = 0.5 * kVacuumPermittivity * square(field);
          EXPECT_NEAR(pull(scene), expected, 0.01 * expected)
              << skin << ", " << gap << ", " << frequency << ", " << resistivity;
        }
      }
    }
  }
}

// Bare of a film, electrowetting takes the energy in the skin: less where it is not a capacitor.
TEST(ElectricPath, ElectrowettingOnADispersiveSkinTakesTheEnergyThatItStores) {
  Scene scene = leaky(0);
  scene.surface.dielectric.clear();
  scene.drive.frequency = 50e3;
  scene.finger.electrical.corner_frequency = 0;
  scene.finger.electrical.skin_exponent = 0.8;
  const double h = scene.finger.electrical.equivalent_thickness(kHumidity);
  const double stored = std::pow(10, -0.2) * std::sin(0.4 * kPi);  // of the capacitor's at 5 kHz
  EXPECT_NEAR(wetted_series(scene, kHumidity), h / stored, 1e-9 * h);
}

TEST(ElectricPath, AnExponentOfOneIsTheResistorAndTheCapacitorAndNearOneNearlySo) {
  Scene scene = leaky(1e10, Waveform::Sine, 200);
  scene.finger.electrical.dispersion_frequency = 123;  // says nothing then
  const double plain = pull(scene);
  EXPECT_EQ(plain, pull(leaky(1e10, Waveform::Sine, 200)));
  scene.finger.electrical.skin_exponent = scene.finger.electrical.gap_exponent = 1 - 1e-7;
  EXPECT_NEAR(pull(scene), plain, 1e-5 * plain);
}

// The voltage of a current falls with every octave, steeper where nothing
// disperses.
TEST(ElectricPath, TheVoltageOfACurrentFallsWithFrequencyForEveryExponent) {
  for (const double exponent : {1.0, 0.85, 0.7}) {
    Scene scene = leaky(0);
    scene.drive.control = DriveControl::Current;
    scene.drive.current = 10e-6;
    scene.finger.electrical.skin_exponent = scene.finger.electrical.gap_exponent = exponent;
    double before = kInfinity;
    for (double f = 1; f < 1e5; f *= 2) {
      scene.drive.frequency = f;
      const double now = source_voltage(scene, kHumidity).peak;
      EXPECT_LT(now, before) << exponent << ", " << f;
      before = now;
    }
  }
}

}  // namespace
}  // namespace papilla::tests::electric_path_test
