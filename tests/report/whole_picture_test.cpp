// Pictures as wholes: every element of small ones, at places that are worked out by hand.
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
#include "tests/temporary.h"

namespace papilla::tests {
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
  const auto drawn = [](int shift) {
    std::string out = fmt::format(
        "<text x=\"{}\" y=\"22\" font-size=\"14\" font-weight=\"bold\">t</text>\n", shift + 12);
    for (const auto& [x, number] : {std::pair(64, 0), {254, 50}, {444, 100}}) {
      out += fmt::format(
          "<line x1=\"{0}.0\" y1=\"76\" x2=\"{0}.0\" y2=\"330\" stroke=\"#e3e6ea\"/>"
          "<text x=\"{0}.0\" y=\"346\" text-anchor=\"middle\">{1}</text>\n",
          shift + x, number);
    }
    for (const auto& [y, number] :
         {std::pair(330.0, 0), {266.5, 1}, {203.0, 2}, {139.5, 3}, {76.0, 4}}) {
      out += fmt::format(
          "<line x1=\"{0}\" y1=\"{2:.1f}\" x2=\"{1}\" y2=\"{2:.1f}\" stroke=\"#e3e6ea\"/>"
          "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5}</text>\n",
          shift + 64, shift + 444, y, shift + 58, y + 4, number);
    }
    out +=
        fmt::format("<text x=\"{}\" y=\"368\" text-anchor=\"middle\">along</text>\n", shift + 254);
    out += fmt::format(
        "<text x=\"{0}\" y=\"203\" text-anchor=\"middle\" transform=\"rotate(-90 {0} 203)\">up"
        "</text>\n",
        shift + 16);
    out += fmt::format(
        "<polyline fill=\"none\" stroke=\"#111111\" stroke-width=\"1.8\" points=\"{0}.0,330.0 "
        "{1}.0,76.0 \"/>\n"
        "<g fill=\"#111111\" stroke=\"#111111\"><circle cx=\"{0}.0\" cy=\"330.0\" r=\"3.5\"/>"
        "<circle cx=\"{1}.0\" cy=\"76.0\" r=\"3.5\"/></g>\n"
        "<circle cx=\"{0}\" cy=\"50\" r=\"4\" fill=\"#111111\"/>"
        "<text x=\"{2}\" y=\"54\">abc</text>\n",
        shift + 64, shift + 444, shift + 73);
    // The second name 26 px and 6.6 px a letter behind the first: at 64 + 45.8.
    out += fmt::format(
        "<g fill=\"#111111\" stroke=\"#111111\"><circle cx=\"{}.0\" cy=\"266.5\" r=\"3.5\"/></g>\n"
        "<circle cx=\"{}\" cy=\"50\" r=\"4\" fill=\"#111111\"/>"
        "<text x=\"{}\" y=\"54\">de</text>\n",
        shift + 254, shift + 110, shift + 119);
    return out;
  };
  EXPECT_EQ(svg_picture({plot, plot}),
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 920 380\" width=\"920\" "
            "height=\"380\" font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"920\" "
            "height=\"380\" fill=\"white\"/>\n" +
                drawn(0) + drawn(460) + "</svg>\n");
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
  const std::string head =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"800\" height=\"560\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"100%\" height=\"100%\" "
      "fill=\"white\"/>\n<text x=\"400.0\" y=\"20.0\" text-anchor=\"middle\">a &amp; b</text>\n";
  const auto frame = [](int top) {
    return fmt::format(
        "<rect x=\"70\" y=\"{}\" width=\"680\" height=\"200\" fill=\"none\" stroke=\"#888\"/>\n",
        top);
  };
  std::string points;
  const char* heights[] = {"240.0", "40.0", "173.3", "140.0"};
  for (int k = 0; k < 680; ++k) {
    for (int twice = 0; twice < 2; ++twice)
      points += fmt::format("{}.0,{} ", 70 + k, heights[k / 170]);
  }
  const std::string period =
      frame(40) + "<polyline fill=\"none\" stroke=\"#1f6fb4\" stroke-width=\"1\" points=\"" +
      points +
      "\"/>\n<text x=\"64.0\" y=\"50.0\" text-anchor=\"end\">500 mN</text>\n"
      "<text x=\"64.0\" y=\"240.0\" text-anchor=\"end\">200</text>\n"
      "<text x=\"410.0\" y=\"256.0\" text-anchor=\"middle\">friction over 8 ms</text>\n";
  std::string spectrum = frame(310);
  for (const auto& [x, text] :
       {std::pair("70.0", "100"), {"296.7", "1000"}, {"523.3", "10000"}, {"750.0", "100000"}})
    spectrum +=
        fmt::format("<text x=\"{}\" y=\"526.0\" text-anchor=\"middle\">{} Hz</text>\n", x, text);
  // 0, 40, 80 and more than 120 dB below the largest; log10(200) = 2.30103 of 3 decades.
  for (const auto& [x, top] :
       {std::pair("70.0", "310.0"), {"296.7", "376.7"}, {"636.7", "443.3"}, {"591.6", "510.0"}})
    spectrum += fmt::format(
        "<line x1=\"{0}\" y1=\"510.0\" x2=\"{0}\" y2=\"{1}\" stroke=\"#b4411f\"/>\n", x, top);
  spectrum +=
      "<text x=\"64.0\" y=\"320.0\" text-anchor=\"end\">50 mN</text>\n"
      "<text x=\"64.0\" y=\"510.0\" text-anchor=\"end\">-120 dB</text>\n";
  EXPECT_EQ(drive_svg(c, r), head + period + spectrum + "</svg>\n");
  r.lines = {{0, 0.3}};  // nothing moves: an empty frame
  EXPECT_EQ(drive_svg(c, r), head + period + frame(310) + "</svg>\n");
  // A line alone on a decade has the decade from there on.
  r.lines = {{1000, 2e-6}};
  EXPECT_EQ(drive_svg(c, r),
            head + period + frame(310) +
                "<text x=\"70.0\" y=\"526.0\" text-anchor=\"middle\">1000 Hz</text>\n"
                "<text x=\"750.0\" y=\"526.0\" text-anchor=\"middle\">10000 Hz</text>\n"
                "<line x1=\"70.0\" y1=\"510.0\" x2=\"70.0\" y2=\"310.0\" stroke=\"#b4411f\"/>\n"
                "<text x=\"64.0\" y=\"320.0\" text-anchor=\"end\">0.002 mN</text>\n"
                "<text x=\"64.0\" y=\"510.0\" text-anchor=\"end\">-120 dB</text>\n</svg>\n");
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
  std::string expected =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"640\" height=\"420\" "
      "font-family=\"sans-serif\" font-size=\"12\">\n<rect width=\"640\" height=\"420\" "
      "fill=\"white\"/>\n";
  const std::string empty = expected + "</svg>\n";
  for (const auto& [x, decade] : {std::pair(70, 1), {270, 2}, {470, 3}})
    expected += fmt::format(
        "<line x1=\"{0}.0\" y1=\"40\" x2=\"{0}.0\" y2=\"360\" stroke=\"#ddd\"/>"
        "<text x=\"{0}.0\" y=\"376\" text-anchor=\"middle\">1e{1}</text>\n",
        x, decade);
  for (const auto& [y, decade] : {std::pair(360, -3), {200, -2}, {40, -1}})
    expected += fmt::format(
        "<line x1=\"70\" y1=\"{0}.0\" x2=\"470\" y2=\"{0}.0\" stroke=\"#ddd\"/>"
        "<text x=\"62\" y=\"{0}.0\" text-anchor=\"end\">1e{1}</text>\n",
        y, decade);
  expected +=
      "<text x=\"70\" y=\"24\" font-size=\"14\">grid: relative error against work</text>"
      "<text x=\"270\" y=\"400\" text-anchor=\"middle\">FFT pairs of 256 x 256</text>\n";
  const char* colours[] = {"#1b6ca8", "#d1495b", "#555555", "#3c8d5a", "#8a5fbf", "#c98a1b"};
  ASSERT_EQ(quantities.size(), std::size(colours));
  for (std::size_t q = 0; q < quantities.size(); ++q) {
    std::string points;
    const std::vector<std::pair<int, int>> at =
        q == 0   ? std::vector<std::pair<int, int>>{{70, 40}, {470, 360}}
        : q == 1 ? std::vector<std::pair<int, int>>{{70, 200}}
                 : std::vector<std::pair<int, int>>{};
    for (const auto& [x, y] : at) {
      expected += fmt::format("<circle cx=\"{}.0\" cy=\"{}.0\" r=\"3.5\" fill=\"{}\"/>\n", x, y,
                              colours[q]);
      points += fmt::format("{}.0,{}.0 ", x, y);
    }
    expected += fmt::format(
        "<polyline fill=\"none\" stroke=\"{0}\" stroke-width=\"1.5\" points=\"{1}\"/>"
        "<text x=\"484\" y=\"{2}\" fill=\"{0}\">{3}</text>\n",
        colours[q], points, 60 + 20 * q, quantities[q].name);
  }
  EXPECT_EQ(accuracy_svg(rows, "grid"), expected + "</svg>\n");
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
  std::string expected = svg_sheet(760, 540, 13);
  const auto square = [](double up, double right, double down, double left) {
    return fmt::format("{:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f} {:.1f},{:.1f} \"/>\n", 260.0,
                       260 - 180 * up, 260 + 180 * right, 260.0, 260.0, 260 + 180 * down,
                       260 - 180 * left, 260.0);
  };
  for (const double ring : {0.25, 0.5, 0.75, 1.0})
    expected +=
        "<polygon fill=\"none\" stroke=\"#cccccc\" points=\"" + square(ring, ring, ring, ring);
  const char* places[] = {"x=\"260.0\" y=\"54.0\"", "x=\"466.0\" y=\"260.0\"",
                          "x=\"260.0\" y=\"466.0\"", "x=\"54.0\" y=\"260.0\""};
  const char* texts[] = {"mean(friction):low", "mean(modulation):high", "variation(friction):low",
                         "mean(compliance):high"};
  for (std::size_t a = 0; a < 4; ++a)
    expected += fmt::format("<text {} text-anchor=\"middle\">{}</text>\n", places[a], texts[a]);
  const char* colours[] = {"#1b6ca8", "#d1495b", "#3c8d5a", "#8a5fbf", "#c98a1b",
                           "#4a4a4a", "#2aa9a9", "#b0467d", "#1b6ca8"};
  for (std::size_t i = 0; i < 9; ++i) {
    // None of low is the rim, and where all have none of high they are all there.
    expected += fmt::format(
        "<polygon fill=\"{0}\" fill-opacity=\"0.12\" stroke=\"{0}\" stroke-width=\"2\" "
        "points=\"{1}<text x=\"500\" y=\"{2}\" fill=\"{0}\">{3}. n{4}</text>\n",
        colours[i], i == 0 ? square(1, 0.5, 1, 1) : square(0.5, 1, 0, 1), 60 + 22 * i, i + 1,
        8 - i);
  }
  EXPECT_EQ(radar_svg(names, options, state), expected + "</svg>\n");
}

}  // namespace
}  // namespace papilla::tests
