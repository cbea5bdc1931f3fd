// Pictures as wholes: what of them is a number, and committed files for the rest. The files are
// byte for byte the pictures that were put together by hand once.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "report/accuracy.h"
#include "report/drive.h"
#include "report/front.h"
#include "report/ranking.h"
#include "report/response.h"
#include "report/svg.h"
#include "tests/support/golden.h"
#include "tests/temporary.h"

namespace papilla::tests::whole_picture_test {
namespace {

SvgSeries series(std::string name, std::vector<double> x, std::vector<double> y) {
  return {.name = std::move(name),
          .colour = "#111111",
          .x = std::move(x),
          .y = std::move(y),
          .ex = {},
          .ey = {}};
}

// 0 to 100 in steps of 50 over 380 px from 64 on, 0 to 4 in steps of 1 over 254 px up from 330.
TEST(WholePictures, APlotOfTwoSeriesAndOneBesideIt) {
  SvgSeries first = series("abc", {0, 100}, {0, 4});
  first.ex = {0, 0}, first.ey = {0, 0};
  first.line = true;
  const SvgSeries second = series("de", {50}, {1});
  const SvgPlot plot{.title = "t", .x = "along", .y = "up", .series = {first, second}};
  EXPECT_TRUE(is_golden(svg_picture({plot, plot}), "report/golden/two_plots.svg"));
  EXPECT_EQ(svg_sheet(30, 20, 9),
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"30\" height=\"20\" "
            "font-family=\"sans-serif\" font-size=\"9\">\n<rect width=\"30\" height=\"20\" "
            "fill=\"white\"/>\n");
}

// The numbers at the ticks of the x axis of values.
std::vector<std::string> ticks(const std::vector<double>& x, bool y_from_zero = false) {
  SvgPlot plot{.title = "", .x = "", .y = "", .series = {series("", x, x)}};
  plot.from_zero = y_from_zero;
  const std::string svg = svg_picture({plot});
  const std::string mark =
      y_from_zero ? "text-anchor=\"end\">" : "y=\"346\" text-anchor=\"middle\">";
  std::vector<std::string> out;
  for (std::size_t at = 0; (at = svg.find(mark, at)) != std::string::npos;) {
    at += mark.size();
    out.push_back(svg.substr(at, svg.find('<', at) - at));
  }
  return out;
}

TEST(WholePictures, TicksHoldTheValuesAndNoMore) {
  using Texts = std::vector<std::string>;
  // One value: half of it to either side, a half at least.
  EXPECT_EQ(ticks({40}), (Texts{"20", "30", "40", "50", "60"}));
  EXPECT_EQ(ticks({-40}), (Texts{"-60", "-50", "-40", "-30", "-20"}));
  EXPECT_EQ(ticks({0}), (Texts{"-0.5", "0", "0.5"}));
  EXPECT_EQ(ticks({0.4}), (Texts{"-0.5", "0", "0.5", "1"}));
  EXPECT_EQ(ticks({NAN}), (Texts{"-0.5", "0", "0.5"}));  // none
  EXPECT_EQ(ticks({NAN}, true), (Texts{"-0.5", "0", "0.5"}));
  EXPECT_EQ(ticks({5, 17}, true), (Texts{"0", "5", "10", "15", "20"}));
  // Quarters of the span: up to 1, 2, 5 and 10 of its decade.
  EXPECT_EQ(ticks({0, 40}), (Texts{"0", "10", "20", "30", "40"}));
  EXPECT_EQ(ticks({0, 41}), (Texts{"0", "20", "40", "60"}));
  EXPECT_EQ(ticks({0, 80}), (Texts{"0", "20", "40", "60", "80"}));
  EXPECT_EQ(ticks({0, 81}), (Texts{"0", "50", "100"}));
  EXPECT_EQ(ticks({0, 200}), (Texts{"0", "50", "100", "150", "200"}));
  EXPECT_EQ(ticks({0, 201}), (Texts{"0", "100", "200", "300"}));
  // 1.1 / 0.1 is above 11 by rounding, 0.3 / 0.1 below 3: neither takes a tick more.
  EXPECT_EQ(ticks({0.8, 1.1}), (Texts{"0.8", "0.9", "1", "1.1"}));
  EXPECT_EQ(ticks({0.3, 0.6}), (Texts{"0.3", "0.4", "0.5", "0.6"}));
}

// Four values over 680 columns, each column twice at its value, 0.2 to 0.5 N over 200 px; decades
// of 100 Hz to 100 kHz over 680 px, 120 dB over 200 px.
TEST(WholePictures, ADriveOfFourValuesAndFourLines) {
  DriveCase c;
  c.title = "a & b";
  DriveResult r;
  r.friction = {0.008, {0.2, 0.5, 0.3, 0.35}};
  r.lines = {{0, 0.3}, {100, 0.05}, {1000, 0.0005}, {31622.7766, 5e-6}, {20000, 1e-9}};
  EXPECT_TRUE(is_golden(drive_svg(c, r), "report/golden/drive.svg"));
  const auto spectrum = [&] {
    const std::string svg = drive_svg(c, r);
    return svg.substr(svg.find("friction over"));
  };
  r.lines = {{0, 0.3}};  // nothing moves: an empty frame
  const std::string empty = spectrum();
  // A line alone on a decade has the decade from there on.
  r.lines = {{1000, 2e-6}};
  EXPECT_TRUE(is_golden(empty + spectrum(), "report/golden/drive_spectra.txt"));
}

std::string period_points(const std::vector<double>& friction) {
  DriveResult r;
  r.friction = {1, friction};
  const std::string svg = drive_svg({}, r);
  const std::size_t at = svg.find("points=\"") + 8;
  return svg.substr(at, svg.find('"', at) - at);
}

// Of many samples a column shows the least and the most; 2.5 a column here, on a straight line.
TEST(WholePictures, AColumnOfAPeriodHasTheLeastAndTheMostOfItsSamples) {
  std::vector<double> ramp;
  for (int i = 0; i < 1700; ++i) ramp.push_back(0.1 + 0.001 * i);
  std::string expected;
  for (int k = 0; k < 680; ++k) {
    for (const int i : {5 * k / 2, 5 * (k + 1) / 2 - 1})
      expected += fmt::format("{}.0,{:.1f} ", 70 + k, 240 - 200 * i / 1699.0);
  }
  EXPECT_EQ(period_points(ramp), expected);
}

// What moves by less than 1e-12 of itself does not move, and 1e-13 is a tenth of that.
TEST(WholePictures, APeriodThatStaysIsALineAlongItsLowerEdge) {
  std::string low, tenth;
  for (int k = 0; k < 680; ++k) {
    for (int twice = 0; twice < 2; ++twice) {
      low += fmt::format("{}.0,240.0 ", 70 + k);
      tenth += fmt::format("{}.0,{} ", 70 + k, k < 340 ? "240.0" : "220.0");
    }
  }
  EXPECT_EQ(period_points({0.3, 0.3}), low);
  EXPECT_EQ(period_points({-0.3, -0.3}), low);
  EXPECT_EQ(period_points({0, 0}), low);
  EXPECT_EQ(period_points({1, 1 + 450 * std::pow(2.0, -52)}), tenth);  // 0.9992e-13
}

// The same as a plot that is put together here: two standard errors, percent and millinewton.
TEST(WholePictures, AResponseIsItsPlots) {
  Response r;
  r.driven = true;
  for (const double k : {1.0, 2.0, 3.0}) {
    ResponsePoint p;
    p.relative_humidity = 0.25 * k;
    p.friction_off.value = 0.1 * k, p.friction_off.parts.sampling = 0.01 * k;
    p.friction_on.value = 0.3 * k, p.friction_on.parts.sampling = 0.02 * k;
    p.modulation.value = 0.7 * k, p.modulation.parts.sampling = 0.04 * k;
    r.points.push_back(p);
  }
  const auto curve = [](const char* name, const char* colour, double value, double error) {
    SvgSeries s{.name = name,
                .colour = colour,
                .x = {25, 50, 75},
                .y = {value, 2 * value, 3 * value},
                .ex = {},
                .ey = {error, 2 * error, 3 * error}};
    s.line = s.band = true;
    return s;
  };
  SvgPlot force{.title = "a title",
                .x = "relative humidity [%]",
                .y = "friction [mN]",
                .series = {curve("drive off", "#1f6f9f", 100, 20)},
                .from_zero = true};
  const SvgPlot modulation{.title = "",
                           .x = "relative humidity [%]",
                           .y = "modulation (F_on - F_off)/F_off",
                           .series = {curve("", "#3a7d44", 0.7, 0.08)},
                           .from_zero = true};
  const SvgPlot off = force;
  force.series.push_back(curve("drive on", "#c2571a", 300, 40));
  EXPECT_EQ(response_svg(r, "a title"), svg_picture({force, modulation}));
  r.driven = false;
  EXPECT_EQ(response_svg(r, "a title"), svg_picture({off}));
}

TEST(WholePictures, AFrontIsAPlotForEachObjectiveBesideTheFirst) {
  const std::filesystem::path folder = temporary("three");
  std::filesystem::create_directories(folder);
  write_bytes(folder / "pareto.csv",
              "design,up,up se,down,down se,third,third se,on front\n"
              "front/01,1,0.5,20,4,7,0.25,yes\n,2,0.125,10,0,8,0,no\nfront/02,4,0,40,0,9,0,yes\n");
  write_bytes(folder / "history.csv", "evaluation,up,down\n1,3,30\n2,5,50\n");
  const auto points = [](const char* name, const char* colour, double radius, std::vector<double> x,
                         std::vector<double> y, std::vector<double> ex, std::vector<double> ey) {
    SvgSeries s{.name = name, .colour = colour, .x = x, .y = y, .ex = ex, .ey = ey};
    s.radius = radius;
    return s;
  };
  const SvgPlot down{
      .title = "up against down",
      .x = "down",
      .y = "up",
      .series = {points("searched", "#b9c0ca", 2.5, {30, 50}, {3, 5}, {}, {}),
                 points("confirmed, dominated", "#7a4fa3", 4.5, {10}, {2}, {0}, {0.125}),
                 points("front, confirmed", "#1f6f9f", 4.5, {20, 40}, {1, 4}, {4, 0}, {0.5, 0})}};
  // The history does not know the third.
  const SvgPlot third{
      .title = "up against third",
      .x = "third",
      .y = "up",
      .series = {points("confirmed, dominated", "#7a4fa3", 4.5, {8}, {2}, {0}, {0.125}),
                 points("front, confirmed", "#1f6f9f", 4.5, {7, 9}, {1, 4}, {0.25, 0}, {0.5, 0})}};
  EXPECT_EQ(front_svg(folder), svg_picture({down, third}));
  // In the units that the run says people read.
  write_bytes(folder / "run.json", R"({"shown": {"down": {"scale": 1000, "unit": "mN"}}})");
  SvgPlot scaled = down;
  scaled.x = "down [mN]";
  for (SvgSeries& s : scaled.series) {
    for (auto* values : {&s.x, &s.ex}) {
      for (double& v : *values) v *= 1000;
    }
  }
  EXPECT_EQ(front_svg(folder), svg_picture({scaled, third}));
  std::filesystem::remove(folder / "run.json");
  // All on the front and no history: that series alone.
  write_bytes(folder / "pareto.csv", "a,a se,b,b se,on front\n1,0,2,0,yes\n");
  std::filesystem::remove(folder / "history.csv");
  EXPECT_EQ(
      front_svg(folder),
      svg_picture({{.title = "a against b",
                    .x = "b",
                    .y = "a",
                    .series = {points("front, confirmed", "#1f6f9f", 4.5, {2}, {1}, {0}, {0})}}}));
  write_bytes(folder / "pareto.csv", "a,a se,b,on front\n1,0,2,yes\n");
  EXPECT_THROW(front_svg(folder), InputError);  // one objective
}

// Work of 10 to 1000 over 400 px, errors of 1e-3 to 1e-1 over 320 px.
TEST(WholePictures, ASweepOfAccuracyOverDecades) {
  std::vector<AccuracyRow> rows(3);
  const std::vector<AccuracyQuantity>& quantities = accuracy_quantities();
  for (std::size_t k = 0; k < 3; ++k) {
    rows[k].sweep = k < 2 ? "grid" : "other";
    rows[k].work = k == 0 ? 10 : k == 1 ? 1000 : 1e7;
    rows[k].error.assign(quantities.size(), k == 2 ? 0.9 : NAN);
  }
  rows[0].error[0] = -0.1, rows[1].error[0] = 0.001;
  rows[0].error[1] = 0.01, rows[1].error[1] = 0;  // none has no place
  ASSERT_EQ(quantities.size(), 6u);
  const std::string empty =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"640\" height=\"420\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"640\" height=\"420\" "
      "fill=\"white\"/>\n</svg>\n";
  EXPECT_TRUE(is_golden(accuracy_svg(rows, "grid"), "report/golden/accuracy.svg"));
  EXPECT_EQ(accuracy_svg(rows, "none"), empty);
  rows.resize(1);  // one work has no decades
  EXPECT_EQ(accuracy_svg(rows, "grid"), empty);
}

// Four axes: up, right, down, left of (260, 260), the rim at 180, the names at 206.
TEST(WholePictures, ARadarOfFourCriteria) {
  RankOptions options;
  options.criteria =
      parse_criteria("friction:low,modulation:high,variation(friction):low,compliance:high");
  StateRanking state;
  state.candidates.resize(9);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < 9; ++i) {
    RankedCandidate& c = state.candidates[i];
    c.index = 8 - i, c.rank = static_cast<int>(i) + 1;
    // Of low the least is best, 2 of 4 half as good; of high the most, whatever their signs.
    c.metrics.resize(4);
    c.metrics[0].value = i == 0 ? 2 : 4, c.metrics[1].value = i == 0 ? -3 : 6;
    c.metrics[2].value = i == 0 ? 0 : -1, c.metrics[3].value = 0;
    names.push_back(fmt::format("n{}", i));
  }
  // None of low is the rim, and where all have none of high they are all there.
  EXPECT_TRUE(is_golden(radar_svg(names, options, state), "report/golden/radar.svg"));
}

}  // namespace
}  // namespace papilla::tests::whole_picture_test
