#include "cases/persson.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "cases/droplets.h"
#include "design/design.h"
#include "report/reference.h"
#include "tests/temporary.h"

namespace papilla::tests::persson_test {
namespace {

const std::string kWrist = PAPILLA_SOURCE_DIR "/designs/physics/wrist_on_glass.toml";

TEST(MeanFieldFile, ReproducesTheFrequencyTable) {
  // Independent implementation, pure theory: A_on/A_off at 100 V over 1 um of permittivity 8.
  const MeanFieldCase c = read_mean_field(
      kWrist, {"theory.kappa=1.5957691216057308", "interface.dielectric.0.permittivity=8.0",
               "sweep.frequency=[\"1 Hz\",\"100 Hz\",\"1 kHz\",\"10 kHz\"]"});
  const MeanFieldResult r = solve_mean_field(c);
  ASSERT_EQ(r.frequency.size(), 4u);
  const double expected[] = {1.242, 1.181, 1.077, 1.021};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(r.frequency[i].on.pull.area / r.frequency[i].area_off, expected[i],
                5e-3 * expected[i]);
  }
  EXPECT_EQ(r.voltage.size(), 5u);
  EXPECT_GT(r.load[0].on.friction, 0);  // at no load
}

TEST(MeanFieldFile, AConductingGapTakesNoVoltageAtDc) {
  const MeanFieldResult r = solve_mean_field(
      read_mean_field(kWrist, {"drive.waveform=dc", "interface.gap_resistivity=1e6 ohm m"}));
  EXPECT_EQ(r.point.on.pull.pull, 0);
  EXPECT_EQ(r.point.capacitance, 0);
  // Insulating gap, lossy skin: the oxide alone is in series at DC.
  const MeanFieldResult dc = solve_mean_field(read_mean_field(kWrist, {"drive.waveform=dc"}));
  EXPECT_NEAR(std::abs(dc.point.thickness), 1e-6 / 3.9, 1e-15);
  EXPECT_GT(dc.point.on.pull.pull, 0);
}

// Layers and a lossless skin lie in series at any frequency; a gap that conducts adds its share in
// quadrature.
TEST(MeanFieldFile, ALosslessSkinAddsItsThicknessToThatOfTheLayers) {
  const std::vector<std::string> skin{"interface.lossy_skin=false",
                                      "interface.skin_equivalent=128 nm"};
  const auto thickness = [&](std::vector<std::string> more) {
    more.insert(more.end(), skin.begin(), skin.end());
    return read_mean_field(kWrist, more).interface.thickness(5e-6, 1e3);
  };
  const double both = 1e-6 / 3.9 + 128e-9;
  EXPECT_NEAR(thickness({}).real(), both, 1e-15);
  EXPECT_EQ(thickness({}).imag(), 0);
  const auto leaky = thickness({"interface.gap_resistivity=1e6 ohm m"});
  EXPECT_NEAR(leaky.real(), both, 1e-15);
  EXPECT_NEAR(leaky.imag() / both, 1 / (2 * kPi * 1e3 * kVacuumPermittivity * 1e6), 1e-9);
  const MeanFieldCase c = read_mean_field(kWrist, skin);
  EXPECT_NEAR(c.interface.thickness(5e-6, 0).real(), both, 1e-15);
}

TEST(MeanFieldFile, CapacitanceIsThatOfTheGapsInSeriesWithTheLayers) {
  // Pressed flat, only the layers are left.
  const MeanFieldResult r = solve_mean_field(
      read_mean_field(kWrist, {"skin.modulus=1 kPa", "skin.bulk_modulus=1 kPa", "touch.load=50 N",
                               "drive.amplitude=0 V", "touch.area=10 mm2"}));
  EXPECT_NEAR(r.point.on.pull.area, 1, 1e-3);
  EXPECT_NEAR(r.point.capacitance, kVacuumPermittivity * 1e-5 / std::abs(r.point.thickness),
              1e-2 * r.point.capacitance);
}

TEST(MeanFieldFile, MistakesAreNamedWithTheirPlace) {
  EXPECT_THROW(read_mean_field(kWrist, {"roughness.roll_off=1 1/m"}), InputError);
  EXPECT_THROW(read_mean_field(kWrist, {"drive.control=current"}), InputError);
  EXPECT_THROW(read_mean_field(kWrist, {"touch.finite_size_pressure=0 Pa"}), InputError);
  EXPECT_THROW(read_mean_field(kWrist, {"roughness.wave_number=[\"1e3 1/m\",\"1e5 1/m\"]"}),
               InputError);
  EXPECT_THROW(read_mean_field(kWrist, {"skin.hardness=1 kPa"}), InputError);
}

// Key, default, range and source of every number, as they are written down.
TEST(Keys, OfCasesAreThoseOfTheReference) {
  for (const char* section : {"persson", "circuit"}) {
    const std::string page = std::string(PAPILLA_SOURCE_DIR) + "/docs/reference/" + section + ".md";
    EXPECT_EQ(reference_section(section, ReferenceFormat::Markdown), read_bytes(page)) << section;
  }
}

// The water of the design's scene: its amount at this humidity, its droplets, its angles.
TEST(DropletCase, OfADesignHasTheWaterOfItsScene) {
  const std::string file = std::string(PAPILLA_DESIGNS_DIR) + "/m3_samples/flat.toml";
  const Design design = read_design(file);
  const SkinWater& water = design.finger.water;
  const DropletCase c = droplets_of_design(file, 0.55, 0, true, false);
  EXPECT_NEAR(c.how.drops_per_volume, water.drops_per_um3 * 1e18, 1e-6 * c.how.drops_per_volume);
  EXPECT_EQ(c.how.first_step, design.model.droplet_step);
  EXPECT_TRUE(c.how.rim_pinning);
  EXPECT_FALSE(c.how.corner_wicking);
  EXPECT_TRUE(c.how.rims);
  EXPECT_EQ(c.water.surface_tension, water.surface_tension);
  EXPECT_FALSE(c.water.pressure_alone);
  EXPECT_NEAR(c.volume, water.volume_per_area(0.55) * c.gap.grid.area(), 1e-12 * c.volume);
  EXPECT_NEAR(c.volume / droplets_of_design(file, 0.15, 0, true, false).volume,
              water.volume_per_area(0.55) / water.volume_per_area(0.15), 1e-9);
  // In contact somewhere, nowhere below the surface.
  EXPECT_EQ(*std::min_element(c.gap.value.begin(), c.gap.value.end()), 0);
  EXPECT_TRUE(droplets_of_design(file, 0.55, 0, false, true).how.corner_wicking);
}

// Of flat glass, whose model pins rims, asked for or not, and has the paper's force of a bridge.
TEST(DropletCase, OfADesignHasTheRimsAndTheForceOfItsModel) {
  Design design = read_design(std::string(PAPILLA_DESIGNS_DIR) + "/m3_samples/flat.toml");
  design.model.rim_pinning = true;
  design.model.preset = Preset::M3;
  const std::string file = temporary("pinned.toml");
  write_design(file, design);
  const DropletCase c = droplets_of_design(file, 0.55, 0, false, false);
  EXPECT_TRUE(c.how.rim_pinning);
  EXPECT_FALSE(c.how.corner_wicking);
  EXPECT_TRUE(c.water.pressure_alone);
}

// Both volumes and every placement once: what single placements give, averaged by hand.
TEST(DropletEnsemble, IsTheMeanOfItsPlacements) {
  const DropletCase c = droplets_of_design(
      std::string(PAPILLA_DESIGNS_DIR) + "/m3_samples/flat.toml", 0.35, 0, false, false);
  const DropletEnsemble all = solve_droplet_ensemble(c, 0.25, 3, 7, 40);
  EXPECT_EQ(all.placements, 3);
  ASSERT_EQ(all.volumes.size(), 2u);
  double whole = 0;
  for (std::size_t v = 0; v < 2; ++v) {
    DropletCase one = c;
    one.volume = (v == 0 ? 0.75 : 1.25) * c.volume;
    EXPECT_DOUBLE_EQ(all.volumes[v].volume, one.volume);
    double force = 0, bridges = 0, wetted = 0;
    for (std::uint64_t k = 0; k < 3; ++k) {
      const Wetting w = solve_droplets(one, WaterModel::Droplets, 7, 40 + k).wetting;
      force += w.capillary_force / 3, bridges += w.bridges / 3.0, wetted += w.wetted_fraction / 3;
    }
    EXPECT_NEAR(all.volumes[v].capillary_force.value, force, 1e-12 * force);
    EXPECT_NEAR(all.volumes[v].bridges.value, bridges, 1e-12 * bridges);
    EXPECT_NEAR(all.volumes[v].wetted_fraction.value, wetted, 1e-12 * wetted);
    whole += force / 2;
  }
  EXPECT_NEAR(all.mean_capillary_force, whole, 1e-12 * whole);
}

// Sum over decades of stress, by trapezes.
double pull_of(const std::vector<StressPoint>& stress) {
  double sum = 0;
  for (std::size_t k = 1; k < stress.size(); ++k)
    sum += 0.5 * (stress[k].per_decade + stress[k - 1].per_decade) *
           std::abs(std::log10(stress[k].stress / stress[k - 1].stress));
  return sum;
}

TEST(MeanFieldCurves, AddUpToThePointThatTheyBelongTo) {
  const MeanFieldCase c =
      read_mean_field(kWrist, {"interface.lossy_skin=false", "interface.skin_equivalent=100 nm"});
  const MeanFieldPoint p = solve_mean_field(c).point;
  const MeanFieldCurves curves = mean_field_curves(c);
  EXPECT_NEAR(curves.roughness.back().area, p.area_off, 1e-9 * p.area_off);
  // Wave numbers from the lowest to the highest, each beside its roughness.
  const auto spectrum = c.roughness.spectrum();
  EXPECT_NEAR(curves.roughness.front().wave_number, spectrum.lowest(), 1e-9 * spectrum.lowest());
  EXPECT_NEAR(curves.roughness.back().wave_number, spectrum.highest(), 1e-9 * spectrum.highest());
  for (const auto& at : curves.roughness)
    EXPECT_NEAR(at.given, spectrum.at(at.wave_number), 1e-9 * at.given) << at.wave_number;
  // The pull is that of the gaps in the table and of those below, whose stress is the largest.
  const double largest = 0.5 * kVacuumPermittivity * 5e3 / square(std::abs(p.thickness));
  const MeanField field(c.roughness.spectrum(), c.skin.solid,
                        {.kappa = c.theory.kappa, .energy_factor = c.theory.energy_factor});
  const double below = field.gaps(std::max(p.on.pull.pressure, c.touch.finite_size_pressure))
                           .cumulative(curves.stress.front().gap);
  EXPECT_NEAR(pull_of(curves.stress) + below * largest, p.on.pull.pull, 0.01 * p.on.pull.pull);
  // Of a finite body the gap stays below 10 kPa, of an infinite one it grows without end.
  EXPECT_NEAR(curves.separation.front().held_gap, curves.separation[80].gap, 1e-7);  // at 10 kPa
  EXPECT_GT(curves.separation.front().gap, 1.5 * curves.separation.front().held_gap);
  EXPECT_EQ(curves.separation.back().gap, curves.separation.back().held_gap);
  EXPECT_NEAR(curves.separation.front().pressure, 1, 1e-9);  // evenly over six decades
  EXPECT_NEAR(curves.separation.back().pressure, 1e6, 1e-3);
  EXPECT_NEAR(curves.separation[1].pressure / curves.separation[0].pressure,
              std::pow(1e6, 1.0 / static_cast<double>(curves.separation.size() - 1)), 1e-9);
  EXPECT_NEAR(curves.stress.front().gap, 1e-11, 1e-17);
  EXPECT_NEAR(curves.stress.back().gap, 1e-3, 1e-9);
  EXPECT_TRUE(curves.step.empty());  // a skin that does not leak takes no time
}

// Appendix of the paper: elastic contact of the smoothed spectrum is the elastic and the yielded
// contact of the given one, at every magnification.
TEST(MeanFieldCurves, TheSmoothedSpectrumHasTheAreaOfTheYieldingOne) {
  const MeanFieldCurves curves = mean_field_curves(
      read_mean_field(kWrist, {"skin.modulus=1 GPa", "skin.hardness=50 MPa", "touch.load=1 N"}));
  for (const auto& at : curves.roughness)
    EXPECT_NEAR(at.elastic + at.yielded, at.area, 0.02 * at.area) << at.wave_number;
  EXPECT_GT(curves.roughness.back().yielded, curves.roughness.back().elastic);
  EXPECT_LT(curves.roughness.back().smoothed, 0.1 * curves.roughness.back().given);
}

TEST(MeanFieldCurves, AStepChargesTheGapAsTheSkinsLayerEmpties) {
  const MeanFieldCurves curves = mean_field_curves(read_mean_field(kWrist));
  ASSERT_FALSE(curves.step.empty());
  for (std::size_t k = 1; k < curves.step.size(); ++k) {
    EXPECT_GE(curves.step[k].field, curves.step[k - 1].field);
    EXPECT_GE(curves.step[k].pull, curves.step[k - 1].pull);
  }
  // In the end the oxide alone is in series with the mean gap.
  const MeanFieldResult r = solve_mean_field(read_mean_field(kWrist));
  EXPECT_NEAR(curves.step.back().field, 100 / (r.point.on.pull.mean_gap + 1e-6 / 3.9),
              1e-3 * curves.step.back().field);
}

TEST(MeanFieldFile, EveryVoltageMeetsEveryLoad) {
  const MeanFieldResult r = solve_mean_field(read_mean_field(kWrist));
  const auto grid = mean_field_curves(read_mean_field(kWrist)).grid;
  ASSERT_EQ(grid.size(), r.voltage.size() * r.load.size());
  EXPECT_EQ(grid[2 * r.load.size() + 1].on.friction, r.load[1].on.friction);  // 100 V
}

}  // namespace
}  // namespace papilla::tests::persson_test
