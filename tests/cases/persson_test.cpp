#include "cases/persson.h"

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/error.h"

namespace papilla::tests {
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

}  // namespace
}  // namespace papilla::tests
