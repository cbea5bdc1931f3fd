// The fingertip against Hertz and Sneddon, and against published areas of fingertips.
#include "physics/macro/fingertip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"

namespace papilla::tests::fingertip_test {
namespace {

TEST(Fingertip, ASphereOfOneMaterialIsHertz) {
  const double radius = 8e-3, modulus = 30e3, load = 0.5;
  const TipShape sphere{2, 1 / (2 * radius)};
  const TipSolid solid{modulus};
  const TipContact c = tip_contact(sphere, solid, load);
  const double a = std::cbrt(3 * load * radius / (4 * modulus));
  EXPECT_NEAR(c.radius / a, 1, 1e-9);
  EXPECT_NEAR(c.indentation / (a * a / radius), 1, 1e-9);
  const double peak = 3 * load / (2 * kPi * a * a);
  for (double r : {0.0, 0.3, 0.6, 0.9}) {
    EXPECT_NEAR(tip_pressure(sphere, solid, c.radius, r * a) / (peak * std::sqrt(1 - r * r)), 1,
                1e-6);
  }
}

TEST(Fingertip, AConeIsSneddon) {
  const double cotangent = 0.3, modulus = 1e6, a = 2e-3;
  const TipContact c = tip_contact_at({1, cotangent}, {modulus}, a);
  EXPECT_NEAR(c.load / (0.5 * kPi * a * a * modulus * cotangent), 1, 1e-9);
  EXPECT_NEAR(c.indentation / (0.5 * kPi * a * cotangent), 1, 1e-9);
}

TEST(Fingertip, ThePressureCarriesTheLoad) {
  for (const TipSolid& solid : {TipSolid{25e3}, TipSolid{25e3, 1.5e6, 0.3e-3}}) {
    const TipShape shape{2.85, 3e4};
    const TipContact c = tip_contact(shape, solid, 0.7);
    double sum = 0;
    constexpr int kRings = 4000;
    for (int i = 0; i < kRings; ++i) {
      const double r = c.radius * (i + 0.5) / kRings;
      sum += tip_pressure(shape, solid, c.radius, r) * 2 * kPi * r * c.radius / kRings;
    }
    EXPECT_NEAR(sum / 0.7, 1, 2e-3);
  }
}

TEST(Fingertip, ALayerActsBetweenItsLimits) {
  const TipShape sphere{2, 62.5};
  const double soft = tip_contact(sphere, {25e3}, 0.5).area;
  const double hard = tip_contact(sphere, {1e6}, 0.5).area;
  EXPECT_NEAR(tip_contact(sphere, {25e3, 1e6, 1e-7}, 0.5).area / soft, 1, 5e-3);
  EXPECT_NEAR(tip_contact(sphere, {25e3, 1e6, 1.0}, 0.5).area / hard, 1, 5e-3);
  double last = soft;
  for (double thickness : {0.1e-3, 0.3e-3, 1e-3, 3e-3}) {
    const double area = tip_contact(sphere, {25e3, 1e6, thickness}, 0.5).area;
    EXPECT_LT(area, last);
    last = area;
  }
  EXPECT_GT(last, hard);
}

TEST(Fingertip, TheFingerFilesLawIsAFingertip) {
  const MacroContact macro;
  for (double rh : {0.15, 0.45, 0.75}) {
    const Fingertip tip = fingertip(macro, rh);
    for (double load : {0.05, 0.2, 0.5, 1.0, 2.0}) {
      EXPECT_NEAR(tip_contact(tip.shape, tip.solid, load).area / macro.gross_area(load, rh), 1,
                  1e-6);
    }
  }
  // Growth of the area by 58.5 % from 15 to 75 % RH asks for this softening of the tissue.
  const double softening =
      fingertip(macro, 0.15).solid.tissue / fingertip(macro, 0.75).solid.tissue;
  EXPECT_NEAR(softening, std::pow(1.585, 1 / macro.load_exponent), 1e-6);
}

TEST(Fingertip, StiffnessAndAreaLieWhereFingertipsWereMeasured) {
  const MacroContact macro;
  // Tissue of finite-element fingertips: 25 kPa (radius 8 mm). Gross area at 1 N: about 100 mm2.
  const double tissue = fingertip(macro, 0.15).solid.tissue * 0.75;  // Young's modulus, nu = 1/2
  EXPECT_GT(tissue, 10e3);
  EXPECT_LT(tissue, 60e3);
  EXPECT_NEAR(macro.gross_area(1, 0.15), 100e-6, 15e-6);
  // With nothing but a sphere of that tissue the area grows by F^(2/3): faster than measured.
  const TipShape sphere{2, 1 / (2 * 8e-3)};
  const double growth =
      tip_contact(sphere, {30e3}, 2.0).area / tip_contact(sphere, {30e3}, 0.2).area;
  EXPECT_NEAR(growth, std::pow(10, 2.0 / 3), 1e-6);
  EXPECT_GT(growth, macro.gross_area(2, 0.15) / macro.gross_area(0.2, 0.15));
}

TEST(Fingertip, RidgesCarryTheWholeLoad) {
  const MacroContact macro;
  const RidgeLoad r = ridge_load(macro, 1, 0.15);
  EXPECT_NEAR(r.mean_pressure * r.area, 1, 1e-12);
  EXPECT_NEAR(r.area / macro.gross_area(1, 0.15), 0.3, 1e-12);
  // A pad flatter than a sphere: the middle presses less than Hertz' 3/2 of the mean.
  EXPECT_GT(r.peak_pressure, r.mean_pressure);
  EXPECT_LT(r.peak_pressure, 1.5 * r.mean_pressure);
  EXPECT_EQ(ridge_load(macro, 0, 0.15).mean_pressure, 0);
}

// Eq. macro.5: of a paraboloid 2 (1 - t) over the share of area t, of Hertz 1.5 (1 - t)^.5.
TEST(Fingertip, RingsCarryTheirProfile) {
  ASSERT_EQ(pressure_rings(1, 3).size(), 1u);
  for (const double peak : {1.5, 2.0, 3.0}) {
    double share = 0, mean = 0, second = 0;
    for (const PressureRing& ring : pressure_rings(peak, 3)) {
      share += ring.share;
      mean += ring.share * ring.over_mean;
      second += ring.share * ring.over_mean * ring.over_mean;
    }
    EXPECT_NEAR(share, 1, 1e-12);
    EXPECT_NEAR(mean, 1, 1e-12);
    EXPECT_NEAR(second, peak * peak / (2 * peak - 1), 2e-2);
  }
}

}  // namespace
}  // namespace papilla::tests::fingertip_test
