// Statistics of a stated spectrum in contact: against Persson's full contact, mean heights, and the
// solver alone; what is refused.
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "cases/contact_statistics.h"
#include "report/contact_statistics.h"
#include "tests/support/refusal.h"

namespace papilla::tests::statistics_test {
namespace {

const std::string kCase = PAPILLA_SOURCE_DIR "/designs/physics/rough_contact.toml";

StatisticsCase small(std::vector<std::string> more) {
  std::vector<std::string> all{"roughness.cutoff=2e5 1/m", "sampling.grid=128", "sampling.seeds=4"};
  all.insert(all.end(), more.begin(), more.end());
  return read_statistics(kCase, all);
}

// Far above E* slope everything touches, and the pull is that of plates on the film.
TEST(ContactStatistics, PressedFlatAllOfThemTouch) {
  const StatisticsResult r = solve_statistics(small({"press.pressure=[\"2 GPa\"]"}), 2);
  const StatisticsPoint& p = r.points.at(0);
  EXPECT_NEAR(p.area.value, 1, 1e-9);
  EXPECT_NEAR(p.mean_gap.value, 0, 1e-15);
  EXPECT_NEAR(p.inverse_square.at(0).value * square(400e-9), 1, 1e-9);
  EXPECT_NEAR(r.slope.value, 0.2, 0.01);  // sum over modes and integral
}

// The gaps' share and their mean are those of the distribution, the pressures carry the load.
TEST(ContactStatistics, DistributionsHoldTheArea) {
  const StatisticsResult r = solve_statistics(small({"press.pressure=[\"10 MPa\"]"}), 2);
  const StatisticsPoint& p = r.points.at(0);
  double open = 0, mean = 0, pressed = 0, load = 0;
  for (std::size_t b = 0; b < p.gap.density.size(); ++b) {
    const double middle = static_cast<double>(b) + 0.5;
    open += p.gap.density[b].value * p.gap.width;
    mean += p.gap.density[b].value * p.gap.width * middle * p.gap.width;
    pressed += p.stress.density[b].value * p.stress.width;
    load += p.stress.density[b].value * p.stress.width * middle * p.stress.width;
  }
  EXPECT_NEAR(open, 1 - p.pixels.value, 2e-3);
  EXPECT_NEAR(mean, p.mean_gap.value, 2e-3 * p.mean_gap.value);
  EXPECT_NEAR(pressed, p.pixels.value, 1e-9);
  EXPECT_NEAR(load, 10e6, 0.02 * 10e6);
  EXPECT_GT(p.area.seeds, 0);
  EXPECT_GT(p.mean_gap.grid, 0);
}

// At light load the area goes with the pressure, kappa p/(E* slope), kappa 1.6 to 2.6.
TEST(ContactStatistics, LightContactGoesWithThePressure) {
  const StatisticsResult r =
      solve_statistics(small({"press.pressure=[\"1 MPa\", \"2 MPa\"]", "sampling.seeds=8"}), 2);
  for (const StatisticsPoint& p : r.points) {
    const double kappa = p.area.value * 1e9 * r.slope.value / p.pressure;
    EXPECT_GT(kappa, 1.6);
    EXPECT_LT(kappa, 2.6);
  }
  EXPECT_LT(r.points[1].mean_gap.value, r.points[0].mean_gap.value);
}

TEST(ContactStatistics, AreTheSameForAnyNumberOfThreads) {
  const StatisticsCase c = small({"press.pressure=[\"4 MPa\"]"});
  EXPECT_EQ(statistics_json(c, solve_statistics(c, 1), 0),
            statistics_json(c, solve_statistics(c, 2), 0));
}

TEST(ContactStatistics, WhatMakesNoSenseIsRefused) {
  const auto refused = [](const std::string& set) {
    return keyed_refusal_of([&] { small({set}); });
  };
  EXPECT_NE(refused("press.modulus=0 MPa").find("press.modulus"), std::string::npos);
  EXPECT_NE(refused("press.pressure=[\"2 MPa\", \"1 MPa\"]").find("rising"), std::string::npos);
  EXPECT_NE(refused("sampling.grid=100").find("power of two"), std::string::npos);
  EXPECT_NE(refused("sampling.grid=32").find("a larger grid"), std::string::npos);
  EXPECT_NE(refused("thickness=[\"0 nm\"]").find("above 0"), std::string::npos);
  EXPECT_NE(refused("roughness.cutoff=1e3 1/m").find("roll_off"), std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::statistics_test
