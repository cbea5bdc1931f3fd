// The layered fingertip by Gao's weight and Sneddon's integrals written out, and the shape that the
// finger file's law asks for.
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "physics/macro/fingertip.h"

namespace papilla::tests::layered_tip_test {
namespace {

TEST(LayeredTip, FeelsTheLayerByGaosWeight) {
  const TipSolid solid{20e3, 1e6, 0.5e-3};
  EXPECT_EQ(solid.modulus(0), 1e6);
  EXPECT_NEAR(solid.modulus(1e3), 20e3, 1);  // wide: tissue alone
  // I(t) = (2/pi) atan t - t/(pi (1 + t^2)): at t = 1, 1/2 - 1/(2 pi).
  EXPECT_NEAR(solid.modulus(0.5e-3), 20e3 + 980e3 * (0.5 - 0.5 / kPi), 1e-3);
  EXPECT_NEAR(solid.modulus(0.25e-3), 20e3 + 980e3 * (2 / kPi * std::atan(2) - 0.4 / kPi), 1e-3);
  EXPECT_EQ((TipSolid{20e3, 1e6, 0}).modulus(1e-3), 20e3);
}

// Gamma(m/2 + 1)/Gamma((m + 1)/2) sqrt(pi) c m a^(m - 1).
double slope(const TipShape& s, double a) {
  return std::sqrt(kPi) * std::tgamma(s.power / 2 + 1) / std::tgamma((s.power + 1) / 2) *
         s.coefficient * s.power * std::pow(a, s.power - 1);
}

// Of the sphere's indentation a^2/R and of the cone's pi/2 a cot: the load of each by its rings,
// 20000 of them.
TEST(LayeredTip, LoadAndPressureAreTheSumsOfItsPunches) {
  const TipSolid solid{25e3, 1.2e6, 0.3e-3};
  constexpr int kRings = 20000;
  for (const TipShape& shape : {TipShape{2, 62.5}, TipShape{1, 0.2}, TipShape{2.85, 3e4}}) {
    const double a = 2.4e-3;
    double load = 0, indentation = 0;
    for (int i = 0; i < kRings; ++i) {
      const double s = a * (i + 0.5) / kRings, ds = a / kRings;
      indentation += slope(shape, s) * ds;
      load += 2 * solid.modulus(s) * s * slope(shape, s) * ds;
    }
    const TipContact c = tip_contact_at(shape, solid, a);
    EXPECT_EQ(c.radius, a);
    EXPECT_NEAR(c.area, kPi * a * a, 1e-15);
    EXPECT_NEAR(c.indentation, indentation, 1e-5 * indentation);
    EXPECT_NEAR(c.load, load, 1e-5 * load);
    EXPECT_NEAR(c.mean_pressure(), c.load / c.area, 1e-9 * c.mean_pressure());
    const TipContact found = tip_contact(shape, solid, c.load);
    EXPECT_NEAR(found.radius, a, 1e-9 * a);
    EXPECT_NEAR(found.load, c.load, 1e-9 * c.load);
    for (const double share : {0.2, 0.5, 0.9}) {
      // s = sqrt(r^2 + t^2): midpoints in t.
      const double r = share * a, end = std::sqrt(a * a - r * r);
      double pressure = 0;
      for (int i = 0; i < kRings; ++i) {
        const double t = end * (i + 0.5) / kRings, s = std::hypot(r, t);
        pressure += solid.modulus(s) * slope(shape, s) / s * end / kRings / kPi;
      }
      EXPECT_NEAR(tip_pressure(shape, solid, a, r), pressure, 1e-5 * pressure) << share;
    }
    EXPECT_EQ(tip_pressure(shape, solid, a, a), 0);
    EXPECT_EQ(tip_pressure(shape, solid, a, 1.1 * a), 0);
    EXPECT_EQ(tip_pressure(shape, solid, 0, 0), 0);
  }
  const TipContact none = tip_contact({}, solid, 0);
  EXPECT_EQ(none.area, 0);
  EXPECT_EQ(none.mean_pressure(), 0);
  EXPECT_EQ(tip_contact_at({}, solid, 0).load, 0);
  // A heavy hand is wider than the first guess of a millimetre, by far.
  EXPECT_NEAR(tip_contact({2, 62.5}, {25e3}, 40).radius, std::cbrt(3 * 40 * 8e-3 / (4 * 25e3)),
              1e-9);
}

// A tip of a power m carries area ~ load^(2/(m + 1)).
TEST(LayeredTip, TheShapeFollowsFromTheLawOfTheFingersArea) {
  for (const double exponent : {0.3, 0.52, 2.0 / 3, 1.0}) {
    MacroContact macro;
    macro.load_exponent = exponent;
    for (const double radius : {8e-3, 11e-3}) {
      const Fingertip tip = fingertip(macro, 0.15, radius);
      EXPECT_NEAR(tip.shape.power, 2 / exponent - 1, 1e-12);
      // As high at the edge of the contact at 0.2 N as a sphere of that radius.
      const double a = std::sqrt(macro.area_15 / kPi);
      EXPECT_NEAR(tip.shape.coefficient * std::pow(a, tip.shape.power), a * a / (2 * radius),
                  1e-12);
      EXPECT_NEAR(tip_contact(tip.shape, tip.solid, 0.2).area, macro.area_15, 1e-6 * macro.area_15);
      EXPECT_EQ(tip.solid.thickness, 0);
    }
    // 8 mm where none is said.
    EXPECT_EQ(fingertip(macro, 0.15).shape.coefficient,
              fingertip(macro, 0.15, 8e-3).shape.coefficient);
    // The tissue's area ~ modulus^(-n): softer by the growth to the power 1/n.
    const double growth = macro.gross_area(0.2, 0.6) / macro.gross_area(0.2, 0.15);
    EXPECT_NEAR(fingertip(macro, 0.15).solid.tissue / fingertip(macro, 0.6).solid.tissue,
                std::pow(growth, 1 / exponent), 1e-9);
  }
  // No law is steeper than a cone's (n = 1) or flatter than n = 0.05.
  MacroContact macro;
  macro.load_exponent = 1.4;
  EXPECT_NEAR(fingertip(macro, 0.15).shape.power, 1, 1e-12);
  macro.load_exponent = 0.01;
  EXPECT_NEAR(fingertip(macro, 0.15).shape.power, 39, 1e-9);
}

TEST(LayeredTip, RidgesPressByTheShareThatTheyAre) {
  MacroContact macro;
  macro.ridge_share = 0.4;
  const RidgeLoad r = ridge_load(macro, 0.8, 0.5);
  const double gross = macro.gross_area(0.8, 0.5);
  EXPECT_NEAR(r.area, 0.4 * gross, 1e-15);
  EXPECT_NEAR(r.mean_pressure, 0.8 / (0.4 * gross), 1e-6);
  // In the middle of p ~ int_r^a s^(m-2)... at r = 0: (1/pi) E delta'(a)/(m - 1), and the load is
  // 2 E delta'(a) a^2/(m + 1): their ratio times the gross area is (m + 1)/(2 (m - 1)).
  const double m = 2 / macro.load_exponent - 1;
  EXPECT_NEAR(r.peak_pressure / r.mean_pressure, (m + 1) / (2 * (m - 1)), 1e-4);
  for (const double load : {0.0, -1.0}) {
    const RidgeLoad none = ridge_load(macro, load, 0.5);
    EXPECT_EQ(none.mean_pressure, 0);
    EXPECT_EQ(none.peak_pressure, 0);
  }
}

}  // namespace
}  // namespace papilla::tests::layered_tip_test
