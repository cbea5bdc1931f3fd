// Statistics of a stated spectrum in contact: against Persson's full contact, mean heights, and the
// solver alone; what is refused.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

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

// One seed does not tell how seeds differ, and no controls what the grid changes: null and words.
TEST(ContactStatistics, SayWhatWasNotMeasured) {
  const auto solved = [](int seeds, int controls) {
    const StatisticsCase c =
        small({"press.pressure=[\"4 MPa\"]", "sampling.grid=64", "roughness.cutoff=1e5 1/m",
               "sampling.seeds=" + std::to_string(seeds),
               "sampling.controls=" + std::to_string(controls)});
    return std::pair(c, solve_statistics(c, 1));
  };
  const auto [neither_case, neither] = solved(1, 0);
  EXPECT_FALSE(neither.points.at(0).area.seeds);
  EXPECT_FALSE(neither.points.at(0).area.grid);
  EXPECT_FALSE(neither.points.at(0).area.error());
  const std::string text = statistics_text(neither_case, neither, 0);
  EXPECT_NE(text.find("±: neither how surfaces differ nor what the grid changes was measured"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("± unknown"), std::string::npos) << text;
  EXPECT_EQ(text.find("± 0"), std::string::npos) << text;
  const auto json = nlohmann::json::parse(statistics_json(neither_case, neither, 0));
  const auto& area = json["points"][0]["area_fraction"];
  EXPECT_GT(area["value"], 0);
  EXPECT_TRUE(area["error"].is_null() && area["seeds"].is_null() && area["grid"].is_null());
  const std::string gaps = gap_distribution_csv(neither);
  EXPECT_EQ(std::count(gaps.begin(), gaps.end(), '\n'), 121);
  for (std::size_t at = gaps.find('\n'), next;
       (next = gaps.find('\n', at + 1)) != std::string::npos; at = next)
    ASSERT_EQ(gaps[next - 1], ',');

  const auto [one_case, one] = solved(1, 1);
  EXPECT_FALSE(one.points.at(0).area.seeds);
  EXPECT_TRUE(one.points.at(0).area.grid);
  EXPECT_EQ(one.points.at(0).area.error(), one.points.at(0).area.grid);
  EXPECT_NE(statistics_text(one_case, one, 0).find("how surfaces differ was not measured"),
            std::string::npos);
  const auto [two_case, two] = solved(2, 0);
  EXPECT_TRUE(two.points.at(0).area.seeds);
  EXPECT_FALSE(two.points.at(0).area.grid);
  EXPECT_NE(statistics_text(two_case, two, 0).find("what the grid changes was not measured"),
            std::string::npos);
  const auto [both_case, both] = solved(2, 1);
  EXPECT_NE(statistics_text(both_case, both, 0)
                .find("±: one standard error over the surfaces and what the grid changes\n"),
            std::string::npos);
}

// The shortest wave, of a cut-off of 2e5 1/m, is 31.4 um long.
TEST(ContactStatistics, ASquareThatHoldsNoWaveIsRefused) {
  const auto refused = [](const std::string& size) {
    return keyed_refusal_of([&] { small({"sampling.size=" + size}); });
  };
  EXPECT_EQ(refused("5 um"),
            "sampling.size: a square of 5 um holds no wave of the spectrum, which ends at 31.42 "
            "um\n");
  EXPECT_NE(refused("31.4 um"), "");
  EXPECT_EQ(refused("31.5 um"), "");
  // A narrow band of wave numbers lies between the first two of a longer square.
  const auto band = [](const std::string& size) {
    return keyed_refusal_of([&] {
      small({"roughness.lowest=1.2e5 1/m", "roughness.roll_off=1.2e5 1/m",
             "roughness.cutoff=1.3e5 1/m", "sampling.size=" + size});
    });
  };
  EXPECT_EQ(band("62.8 um").substr(0, 13), "sampling.size");
  EXPECT_EQ(band("50 um"), "");
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
