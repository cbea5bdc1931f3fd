#include "physics/electrostatics/lossy.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "tests/electrostatics/table.h"

namespace papilla {
namespace {

const LossyLayer kSkin{200e-6, 2000, 2e4};
constexpr double kInsulator = HUGE_VAL;

TEST(LossyLayers, ConductBelowTheirCornerAndInsulateAboveIt) {
  const double corner = 1 / (2 * kPi * kSkin.relaxation_time());
  EXPECT_EQ(equivalent_thickness(kSkin, 0), 0.0);
  EXPECT_LT(std::abs(equivalent_thickness(kSkin, 1e-3 * corner)), 1.1e-3 * 100e-9);
  EXPECT_NEAR(std::abs(equivalent_thickness(kSkin, corner)), 100e-9 / std::sqrt(2.0), 1e-15);
  EXPECT_NEAR(std::abs(equivalent_thickness(kSkin, 1e6)), 100e-9, 1e-13);
  // d/(eps + i/(omega eps0 rho))
  const double f = 37;
  const std::complex<double> direct =
      200e-6 / std::complex<double>(2000, 1 / (2 * kPi * f * kVacuumPermittivity * 2e4));
  EXPECT_NEAR(std::abs(equivalent_thickness(kSkin, f) - direct), 0, 1e-20);
  EXPECT_EQ(equivalent_thickness({1e-6, 3.9, kInsulator}, 0), 1e-6 / 3.9);
}

TEST(LossyLayers, AnInsulatingGapSeesTheirEquivalentThickness) {
  const LossyLayer layers[] = {{500e-9, 3.9, 1e14}, kSkin};
  for (double f : {1.0, 300.0, 5e3, 1e6}) {
    const auto h = equivalent_thickness(layers[0], f) + equivalent_thickness(layers[1], f);
    const auto expected = 1.0 / (100e-9 + h);
    EXPECT_NEAR(std::abs(gap_field(100e-9, kInsulator, layers, f) / expected - 1.0), 0, 1e-12) << f;
  }
}

TEST(LossyLayers, DirectVoltageDividesByResistanceOrFallsOnTheInsulators) {
  const LossyLayer resistive[] = {{10e-6, 10, 1e9}, kSkin};
  // Johnsen-Rahbek: all the voltage across an insulating gap on resistive layers.
  EXPECT_DOUBLE_EQ(gap_field(100e-9, kInsulator, resistive, 0).real(), 1 / 100e-9);
  const double gap_share = 1e-7 * 1e12, rest = 10e-6 * 1e9 + 200e-6 * 2e4;
  EXPECT_NEAR(gap_field(1e-7, 1e12, resistive, 0).real() * 1e-7, gap_share / (gap_share + rest),
              1e-12);
  const LossyLayer oxide[] = {{500e-9, 3.9, kInsulator}, kSkin};
  EXPECT_DOUBLE_EQ(gap_field(100e-9, kInsulator, oxide, 0).real(), 1 / (100e-9 + 500e-9 / 3.9));
  EXPECT_EQ(gap_field(100e-9, 1e10, oxide, 0), 0.0);  // a leaky gap discharges onto the oxide
  // Slow enough, an alternating field is the direct one.
  const std::complex<double> direct = gap_field(1e-7, 1e12, resistive, 0);
  EXPECT_NEAR(std::abs(gap_field(1e-7, 1e12, resistive, 1e-9) / direct - 1.0), 0, 1e-5);
}

TEST(LossyLayers, ALeakyGapLosesItsFieldAtLowFrequency) {
  const LossyLayer oxide[] = {{500e-9, 3.9, kInsulator}};
  const double high = std::abs(gap_field(100e-9, 1e6, oxide, 1e6));
  EXPECT_NEAR(high, 1 / (100e-9 + 500e-9 / 3.9), 1e-3 * high);
  EXPECT_LT(std::abs(gap_field(100e-9, 1e6, oxide, 1)), 1e-3 * high);
}

TEST(LossyLayers, TheSkinRelaxesInTheStatedTime) {
  EXPECT_NEAR(kSkin.relaxation_time(), 3.54e-4, 1e-6);
}

}  // namespace
}  // namespace papilla
