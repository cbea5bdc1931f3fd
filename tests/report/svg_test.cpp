// Plots read back by the numbers that stand at their ticks.
#include "report/svg.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <regex>
#include <string>
#include <utility>
#include <vector>

#include "base/files.h"
#include "report/accuracy.h"
#include "report/front.h"
#include "report/response.h"
#include "tests/temporary.h"

namespace papilla::tests::svg_test {
namespace {

using Matches = std::vector<std::vector<std::string>>;

Matches matches(const std::string& text, std::string pattern) {
  for (std::size_t at = 0; (at = pattern.find('@', at)) != std::string::npos;)
    pattern.replace(at, 1, "([-+.e0-9]+)");
  Matches out;
  const std::regex regex(pattern);
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it)
    out.emplace_back(it->begin(), it->end());
  return out;
}

// Pixels to numbers by the first and the last tick.
struct Scale {
  double p0, p1, v0, v1;
  bool even = true;  // the ticks between stand where they say

  explicit Scale(const std::vector<std::pair<double, double>>& ticks)
      : p0(ticks.front().first),
        p1(ticks.back().first),
        v0(ticks.front().second),
        v1(ticks.back().second) {
    for (const auto& [p, v] : ticks) even = even && std::abs((*this)(p)-v) < 1e-3 * (v1 - v0);
  }
  double operator()(double p) const { return v0 + (v1 - v0) * (p - p0) / (p1 - p0); }
};

// What a plot between `left` and `left` + 460 px shows.
struct ReadPlot {
  std::string svg;
  Scale x, y;

  ReadPlot(const std::string& all, double left)
      : svg(all), x(x_ticks(all, left)), y(y_ticks(all, left)) {}

  static bool here(double px, double left) { return px > left && px < left + 460; }
  static std::vector<std::pair<double, double>> x_ticks(const std::string& svg, double left) {
    std::vector<std::pair<double, double>> out;
    for (const auto& m : matches(svg, R"(<line x1="@" y1="76" x2="@" y2="330"[^>]*/>)"
                                      R"(<text x="@" y="346" text-anchor="middle">@</text>)")) {
      EXPECT_EQ(m[1], m[2]);
      EXPECT_EQ(m[1], m[3]);
      if (here(std::stod(m[1]), left)) out.emplace_back(std::stod(m[1]), std::stod(m[4]));
    }
    return out;
  }
  static std::vector<std::pair<double, double>> y_ticks(const std::string& svg, double left) {
    std::vector<std::pair<double, double>> out;
    for (const auto& m : matches(svg, R"(<line x1="@" y1="@" x2="@" y2="@"[^>]*/>)"
                                      R"(<text x="@" y="@" text-anchor="end">@</text>)")) {
      EXPECT_EQ(m[2], m[4]);
      EXPECT_NEAR(std::stod(m[6]), std::stod(m[2]) + 4, 0.11);
      if (here(std::stod(m[1]), left)) out.emplace_back(std::stod(m[2]), std::stod(m[7]));
    }
    return out;
  }
  // Of a shape of points "x,y x,y ".
  std::vector<std::pair<double, double>> points(const std::string& shape) const {
    std::vector<std::pair<double, double>> out;
    const std::size_t at = svg.find("points=\"", svg.find(shape)) + 8;
    for (const auto& m : matches(svg.substr(at, svg.find('"', at) - at), "@,@"))
      out.emplace_back(x(std::stod(m[1])), y(std::stod(m[2])));
    return out;
  }
};

TEST(SvgPictures, PointsBarsAndBandsStandAtTheirNumbers) {
  SvgSeries bars{.name = "first <",
                 .colour = "#111111",
                 .x = {10, 35, std::nan(""), 80},
                 .y = {1.5, -0.25, 7, 0.5},
                 .ex = {2, 0, 0, 5},
                 .ey = {0.25, 0.5, 0, 0}};
  SvgSeries band{.name = "second",
                 .colour = "#222222",
                 .x = {20, 60},
                 .y = {0.3, 0.9},
                 .ex = {},
                 .ey = {0.1, 0.2}};
  band.line = band.band = true;
  const std::string svg = svg_picture({{.title = "a & b", .x = "x [%]", .y = "y", .series = {bars}},
                                       {.title = "", .x = "", .y = "", .series = {band}}});
  EXPECT_NE(svg.find("viewBox=\"0 0 920 380\" width=\"920\" height=\"380\""), std::string::npos);
  EXPECT_NE(svg.find(">a &amp; b<"), std::string::npos);
  EXPECT_NE(svg.find(">first &lt;<"), std::string::npos);
  const ReadPlot left(svg, 0), right(svg, 460);
  EXPECT_TRUE(left.x.even && left.y.even && right.x.even && right.y.even);
  // Ticks are round and hold all numbers with their bars.
  EXPECT_EQ(std::pair(left.x.v0, left.x.v1), std::pair(0.0, 100.0));
  EXPECT_EQ(std::pair(left.y.v0, left.y.v1), std::pair(-1.0, 2.0));
  EXPECT_EQ(std::pair(right.x.v0, right.x.v1), std::pair(20.0, 60.0));
  const Matches circles = matches(svg, R"(<circle cx="@" cy="@" r="3.5"/>)");
  ASSERT_EQ(circles.size(), 5u);  // what is no number has no place
  for (const auto& [i, k] : {std::pair<std::size_t, std::size_t>{0, 0}, {1, 1}, {3, 2}}) {
    EXPECT_NEAR(left.x(std::stod(circles[k][1])), bars.x[i], 0.02);
    EXPECT_NEAR(left.y(std::stod(circles[k][2])), bars.y[i], 0.001);
  }
  const Matches across = matches(svg, R"(<path d="M@ @H@"/>)"),
                up = matches(svg, R"(<path d="M@ @V@"/>)");
  ASSERT_EQ(across.size(), 2u);
  ASSERT_EQ(up.size(), 2u);
  EXPECT_NEAR(left.x(std::stod(across[0][1])), 8, 0.02);
  EXPECT_NEAR(left.x(std::stod(across[0][3])), 12, 0.02);
  EXPECT_NEAR(left.x(std::stod(across[1][1])), 75, 0.02);
  EXPECT_EQ(across[0][2], circles[0][2]);
  EXPECT_NEAR(left.y(std::stod(up[0][2])), 1.25, 0.001);
  EXPECT_NEAR(left.y(std::stod(up[0][3])), 1.75, 0.001);
  EXPECT_NEAR(left.y(std::stod(up[1][2])), -0.75, 0.001);
  EXPECT_EQ(up[1][1], circles[1][1]);
  const auto line = right.points("<polyline"), shape = right.points("<polygon");
  ASSERT_EQ(line.size(), 2u);
  ASSERT_EQ(shape.size(), 4u);  // above from left to right, below back
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(line[i].first, band.x[i], 0.02);
    EXPECT_NEAR(line[i].second, band.y[i], 0.001);
    EXPECT_NEAR(shape[i].second, band.y[i] + band.ey[i], 0.001);
    EXPECT_NEAR(shape[3 - i].first, band.x[i], 0.02);
    EXPECT_NEAR(shape[3 - i].second, band.y[i] - band.ey[i], 0.001);
  }
}

TEST(SvgPictures, AxesBeginAtZeroWhereAskedAndHoldASingleNumber) {
  SvgSeries s{.name = "", .colour = "#111111", .x = {4, 4}, .y = {3, 3}, .ex = {}, .ey = {}};
  SvgPlot plot{.title = "", .x = "", .y = "", .series = {s}};
  const ReadPlot single(svg_picture({plot}), 0);
  EXPECT_EQ(std::pair(single.x.v0, single.x.v1), std::pair(2.0, 6.0));  // half of it to either side
  EXPECT_EQ(std::pair(single.y.v0, single.y.v1), std::pair(1.0, 5.0));
  plot.from_zero = true;
  EXPECT_EQ(ReadPlot(svg_picture({plot}), 0).y.v0, 0);
  plot.series[0].y = {3, 17};
  const ReadPlot more(svg_picture({plot}), 0);
  EXPECT_EQ(std::pair(more.y.v0, more.y.v1), std::pair(0.0, 20.0));
  plot.series[0].y = {0, 9};  // a tick a quarter of the span or finer: 1, 2 or 5
  EXPECT_EQ(matches(svg_picture({plot}), "text-anchor=\"end\">").size(), 3u);  // 0, 5, 10
  plot.series[0].y = {0, 8};
  EXPECT_EQ(matches(svg_picture({plot}), "text-anchor=\"end\">").size(), 5u);  // 0, 2, ... 8
  plot.series[0].y = {0, 4};
  EXPECT_EQ(matches(svg_picture({plot}), "text-anchor=\"end\">").size(), 5u);  // 0, 1, ... 4
}

TEST(SvgPictures, FrictionOverHumidityWithTwoStandardErrors) {
  Response r;
  r.driven = true;
  for (double rh : {0.2, 0.6}) {
    ResponsePoint p;
    p.relative_humidity = rh;
    p.friction_off.value = 0.1 + rh / 10;
    p.friction_on.value = 0.3;
    p.friction_off.parts.sampling = 0.01;
    p.modulation.value = 2;
    r.points.push_back(p);
  }
  const std::string svg = response_svg(r, "title");
  const ReadPlot force(svg, 0), modulation(svg, 460);
  EXPECT_EQ(force.y.v0, 0);
  EXPECT_GE(force.y.v1, 300);
  const auto off = force.points("<polyline"), band = force.points("<polygon");
  EXPECT_NEAR(off[0].first, 20, 0.1);
  EXPECT_NEAR(off[1].second, 160, 1);
  EXPECT_NEAR(band[1].second, 180, 1);
  EXPECT_NEAR(band[2].second, 140, 1);
  EXPECT_GE(modulation.y.v1, 2);
  r.driven = false;  // friction alone, without voltage
  EXPECT_EQ(response_svg(r, "").find("drive on"), std::string::npos);
  EXPECT_NE(response_svg(r, "").find("width=\"460\""), std::string::npos);
}

// A state that is not there has no mark: after breakdown, that under the drive.
TEST(SvgPictures, OfNoStateNothingIsDrawn) {
  Response r;
  r.driven = true;
  for (const bool breaks : {false, true}) {
    ResponsePoint p;
    p.relative_humidity = breaks ? 0.6 : 0.2;
    p.friction_off.value = 0.1;
    p.friction_on.value = 0.3;
    if (breaks) p.oxide_margin = 0.5;
    r.points.push_back(p);
  }
  ASSERT_FALSE(r.points[1].knows_driven());
  // Off at both; on and modulation at the first; the names of the first two.
  EXPECT_EQ(matches(response_svg(r, ""), "<circle").size(), 2u + 1 + 1 + 2);
}

TEST(SvgPictures, AFrontIsWhatItsTablesHold) {
  const std::filesystem::path folder = temporary("front");
  std::filesystem::create_directories(folder);
  write_bytes(folder / "pareto.csv",
              "design,up,up se,down,down se,on front\n"
              "front/01,1,0.5,20,4,yes\n,2,0,10,0,no\nfront/02,4,0,40,0,yes\n");
  write_bytes(folder / "history.csv", "evaluation,up,down\n1,3,30\n");
  const std::string svg = front_svg(folder);
  const ReadPlot plot(svg, 0);
  const Matches circles = matches(svg, R"x(<circle cx="@" cy="@" r="(?:2.5|4.5)"/>)x");
  ASSERT_EQ(circles.size(), 4u);  // searched, dominated, then the front
  const std::vector<std::pair<double, double>> expected{{30, 3}, {10, 2}, {20, 1}, {40, 4}};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(plot.x(std::stod(circles[i][1])), expected[i].first, 0.02) << i;
    EXPECT_NEAR(plot.y(std::stod(circles[i][2])), expected[i].second, 0.01) << i;
  }
  const Matches across = matches(svg, R"(<path d="M@ @H@"/>)");
  ASSERT_EQ(across.size(), 1u);
  EXPECT_NEAR(plot.x(std::stod(across[0][1])), 16, 0.02);
  EXPECT_NE(svg.find(">up against down<"), std::string::npos);
}

// Decades of work to the right, of error up.
TEST(SvgPictures, ASweepOfAccuracyStandsOnItsDecades) {
  std::vector<AccuracyRow> rows(3);
  const std::size_t quantities = accuracy_quantities().size();
  for (std::size_t k = 0; k < 3; ++k) {
    rows[k].sweep = k < 2 ? "grid" : "other";
    rows[k].work = k == 0 ? 30 : 2000;
    rows[k].error.assign(quantities, 0);  // 0 has no place on decades
  }
  rows[0].error[0] = -0.05;
  rows[1].error[0] = 0.002;
  const std::string svg = accuracy_svg(rows, "grid");
  const Matches across = matches(svg, R"(<text x="@" y="376" text-anchor="middle">1e@</text>)"),
                up = matches(svg, R"(<text x="62" y="@" text-anchor="end">1e@</text>)"),
                circles = matches(svg, R"(<circle cx="@" cy="@")");
  ASSERT_EQ(across.size(), 4u);  // 1e1 to 1e4
  ASSERT_EQ(up.size(), 3u);      // 1e-3 to 1e-1
  ASSERT_EQ(circles.size(), 2u);
  const auto ticks = [](const Matches& labels) {
    std::vector<std::pair<double, double>> out;
    for (const auto& m : labels) out.emplace_back(std::stod(m[1]), std::stod(m[2]));
    return Scale(out);
  };
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(ticks(across)(std::stod(circles[k][1])), std::log10(rows[k].work), 1e-3);
    EXPECT_NEAR(ticks(up)(std::stod(circles[k][2])), std::log10(std::abs(rows[k].error[0])), 1e-3);
  }
  EXPECT_EQ(std::stod(across[0][1]), 70);
  EXPECT_EQ(std::stod(up[0][1]), 360);
  EXPECT_EQ(accuracy_svg(rows, "none").find("<line"), std::string::npos);
}

// What is written stands beside what it names and over nothing else.
TEST(SvgPictures, NamesStandBesideTheirMarksAndTitlesBesideTheirAxes) {
  const SvgSeries one{.name = "a name of some length",
                      .colour = "#111111",
                      .x = {1, 2},
                      .y = {3, 4},
                      .ex = {},
                      .ey = {}};
  SvgSeries two = one;
  two.name = "b";
  const SvgPlot plot{.title = "title", .x = "along", .y = "up", .series = {one, two}};
  const std::string svg = svg_picture({plot, plot});
  const Matches names =
      matches(svg, R"(<circle cx="@" cy="50" r="4" fill="#111111"/><text x="@" y="54">[ab][^<]*<)");
  ASSERT_EQ(names.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const double dot = std::stod(names[i][1]), text = std::stod(names[i][2]);
    EXPECT_EQ(text - dot, 9);
    EXPECT_EQ(dot, i % 2 == 0 ? 64 + 460 * static_cast<double>(i / 2)
                              : std::round(std::stod(names[i - 1][1]) + 26 + 6.6 * 21));
  }
  const Matches titles = matches(svg, R"(<text x="@" y="22" [^>]*>title<)"),
                along = matches(svg, R"(<text x="@" y="@" text-anchor="middle">along<)"),
                up = matches(svg, R"re(<text x="@" y="@" [^>]*rotate.-90 @ @.">up<)re");
  ASSERT_EQ(titles.size(), 2u);
  ASSERT_EQ(along.size(), 2u);
  ASSERT_EQ(up.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const double left = 460 * static_cast<double>(i);
    EXPECT_EQ(std::stod(titles[i][1]), left + 12);
    EXPECT_EQ(std::stod(along[i][1]), left + 254);  // the middle of 64 to 444
    EXPECT_GT(std::stod(along[i][2]), 330 + 16 + 12);
    EXPECT_LT(std::stod(along[i][2]), 380);
    EXPECT_EQ(std::stod(up[i][1]), left + 16);
    EXPECT_EQ(std::stod(up[i][2]), 203);
    EXPECT_EQ(up[i][3] + up[i][4], up[i][1] + up[i][2]);  // turned about its own middle
  }
  // The numbers of an axis end before it.
  const Matches numbers =
      matches(svg, R"re(<line x1="@" y1="@" x2="@" [^>]*/><text x="@" y="@" text-anchor="end">)re");
  ASSERT_FALSE(numbers.empty());
  for (const auto& m : numbers) EXPECT_EQ(std::stod(m[1]) - std::stod(m[4]), 6);
}

// Steps of 1, 2 and 5 at every size, as many as can be read; one number stands in the middle.
TEST(SvgPictures, TicksAreRoundAtEverySize) {
  const auto alone = [](const std::vector<double>& x, const std::vector<double>& y) {
    const SvgSeries s{.name = "", .colour = "#111111", .x = x, .y = y, .ex = {}, .ey = {}};
    return svg_picture({{.title = "", .x = "", .y = "", .series = {s}}});
  };
  for (const double size : {1e-7, 1.0, 1e5}) {
    for (const double most : {1.0, 1.9, 2.1, 3.9, 4.1, 7.9, 8.1, 9.9}) {
      const auto ticks = ReadPlot::x_ticks(alone({-most * size, most * size}, {0, 1}), 0);
      ASSERT_GE(ticks.size(), 3u) << most;
      EXPECT_LE(ticks.size(), 9u) << most;
      const double step = ticks[1].second - ticks[0].second;
      const double digit = step / std::pow(10, std::floor(std::log10(step) + 1e-6));
      EXPECT_TRUE(std::abs(digit - 1) < 1e-4 || std::abs(digit - 2) < 1e-4 ||
                  std::abs(digit - 5) < 1e-4)
          << step;
      EXPECT_LE(ticks.front().second, -most * size * (1 - 1e-3));
      EXPECT_GT(ticks.front().second, -most * size - step);
      EXPECT_NEAR(ticks.front().second, -ticks.back().second, 1e-3 * step);
    }
  }
  for (const double value : {0.0, 40.0, -0.2}) {
    const ReadPlot plot(alone({value}, {value}), 0);
    const double half = std::max(0.5 * std::abs(value), 0.5);
    EXPECT_LE(plot.x.v0, value - half + 1e-9) << value;
    EXPECT_GE(plot.x.v1, value + half - 1e-9) << value;
    EXPECT_LE(plot.x.v1 - plot.x.v0, 4 * half) << value;
  }
}

}  // namespace
}  // namespace papilla::tests::svg_test
