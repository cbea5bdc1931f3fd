// A drive case as people and programs read it, and its picture read back by its own labels.
#include "report/drive.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <string>
#include <vector>

#include "base/constants.h"
#include "tests/report/same_json.h"

namespace papilla::tests::drive_test {
namespace {

struct Driven {
  DriveCase c;
  DriveResult r;

  Driven() {
    c.title = "a <case>";
    c.drive.waveform = Waveform::Am;
    c.touch.real_area = 1e-7;
    c.sweep.frequency = {1000};
    r.network.dielectric = {kInfinity, 2e-12};
    r.network.skin = {5e6, 1e-10};
    r.network.gap = {{2e9, 3e-12}, 4e-6, 5e-8};
    r.area = 6e-5;
    r.carrier = {.gap_voltage = 70,
                 .source_voltage = 100,
                 .current = 8e-4,
                 .mean_force = 0.009,
                 .ripple = 0.0045};
    r.series.mean_force = 0.003;
    r.series.peak_current = 0.0011, r.series.peak_source_voltage = 120;
    r.series.peak_gap_voltage = 81;
    r.series.source_voltage.value = {0, 100, 50, -20};
    r.series.current.value = {0, 1e-4, 2e-4, 3e-4};
    r.series.gap_voltage.value = {0, 70, 35, -14};
    r.series.force.value = {0, 0.01, 0.002, 0.004};
    r.friction = {0.008, {0.2, 0.5, 0.3, 0.25}};
    r.distortion = 0.025;
    r.lines = {{0, 0.3}, {100, 0.05}, {1000, 0.0005}, {20000, 5e-8}};
    r.response = {{.gap_voltage = 400,
                   .source_voltage = 600,
                   .current = 0.0003,
                   .mean_force = 0.008,
                   .ripple = 0.0008}};
    r.checks = {{DriveLimit::BodyCurrent, 0.0004, 0.0005}, {DriveLimit::SourceVoltage, 200, 150}};
    r.onset_off = 0.21, r.onset_on = 0.22, r.onset_static = 0.23;
  }
};

TEST(DriveReport, ForPeopleHasEachNumberInTheUnitBesideIt) {
  const Driven d;
  EXPECT_EQ(
      drive_text(d.c, d.r),
      "a <case>\n"
      "dielectric       insulator            2 pF   corner 0 Hz\n"
      "gap              2000 Mohm            3 pF   corner 26.53 Hz\n"
      "skin                5 Mohm          100 pF   corner 318.3 Hz\n"
      "gap          4 um on 60 mm2; 0.5 mN at 100 V\n"
      "carrier      100 V at the source, 70 V in the gap, 0.8 mA\n"
      "pull         mean 9 mN, ripple at twice the frequency 4.5 mN (unmodulated)\n"
      "pull         mean 3 mN over the signal\n"
      "distortion   2.5 % below half the carrier's frequency\n"
      "onset        210 mN without voltage, 220 mN with it; 230 mN from a patch all in static "
      "contact\n"
      "body current    0.4 mA of 0.5: ok\n"
      "source voltage  200 V of 150: TOO MUCH\n"
      "\nfriction, lines\n          Hz           mN\n"
      "           0          300\n"
      "         100           50\n"
      "        1000          0.5\n"
      "       20000        5e-05\n"
      "\na plain sine\n          Hz     source V        gap V   current mA      mean mN    "
      "ripple mN\n"
      "        1000          600          400          0.3            8          0.8  source "
      "voltage beyond 150 V\n");
}

// Thickness 0: a capacitance of 0 would be that of an open gap.
TEST(DriveReport, ALayerThatIsNotThereHasNoNumbers) {
  Driven d;
  d.r.network.skin = d.r.network.dielectric = slab(0, 4, 1e4, 1e-6);
  EXPECT_NE(drive_text(d.c, d.r).find("\ndielectric            none\n"), std::string::npos)
      << drive_text(d.c, d.r);
  EXPECT_NE(drive_text(d.c, d.r).find("\nskin                  none\n"), std::string::npos);
  const auto json = nlohmann::json::parse(drive_json(d.c, d.r));
  EXPECT_TRUE(json["skin"].is_null() && json["dielectric"].is_null());
  // A film that relaxes is there, under its own name.
  d.r.network.relaxing = {{kInfinity, 2e-12}};
  const std::string text = drive_text(d.c, d.r);
  EXPECT_EQ(text.find("dielectric"), std::string::npos) << text;
  EXPECT_NE(text.find("\nrelaxing         insulator            2 pF"), std::string::npos) << text;
  // So is each layer of the film that leaks at another time constant.
  d.r.network.dielectric = {kInfinity, 3e-12};
  d.r.network.apart = {{5e6, 4e-12}};
  EXPECT_NE(drive_text(d.c, d.r).find("\ndielectric       insulator            3 pF   corner 0 Hz\n"
                                      "dielectric          5 Mohm            4 pF"),
            std::string::npos)
      << drive_text(d.c, d.r);
  const auto apart = nlohmann::json::parse(drive_json(d.c, d.r))["dielectric_apart"];
  ASSERT_EQ(apart.size(), 1u);
  EXPECT_EQ(apart[0]["resistance"], 5e6);
}

TEST(DriveReport, OfManyLinesShowsTheStrongestByFrequency) {
  Driven d;
  d.r.lines.clear();
  for (int i = 0; i < 30; ++i) d.r.lines.push_back({100.0 + i, 0.001 * (i + 1)});
  const std::string text = drive_text(d.c, d.r);
  EXPECT_EQ(text.find("         105 "), std::string::npos);  // the sixth weakest
  const std::size_t weak = text.find("         106            7\n"),
                    strong = text.find("         129           30\n");
  EXPECT_LT(weak, strong);
  EXPECT_NE(strong, std::string::npos);
  EXPECT_NE(text.find("and 6 weaker ones\n"), std::string::npos);
}

TEST(DriveReport, ForProgramsIsInSi) {
  const Driven d;
  const auto sine = [](double gap, double source, double current, double mean, double ripple) {
    return nlohmann::json{{"gap_voltage", gap},
                          {"source_voltage", source},
                          {"current", current},
                          {"mean_force", mean},
                          {"ripple", ripple}};
  };
  nlohmann::json sweep = sine(400, 600, 0.0003, 0.008, 0.0008);
  sweep["frequency"] = 1000;
  expect_document(
      drive_json(d.c, d.r),
      {{"schema", 1},
       {"title", "a <case>"},
       {"area", 6e-5},
       {"dielectric", {{"resistance", nullptr}, {"capacitance", 2e-12}, {"corner_frequency", 0}}},
       {"gap",
        {{"resistance", 2e9},
         {"capacitance", 3e-12},
         {"corner_frequency", 1 / (2 * kPi * 2e9 * 3e-12)},
         {"distance", 4e-6},
         {"force_factor", 5e-8}}},
       {"skin",
        {{"resistance", 5e6},
         {"capacitance", 1e-10},
         {"corner_frequency", 1 / (2 * kPi * 5e6 * 1e-10)}}},
       {"carrier", sine(70, 100, 8e-4, 0.009, 0.0045)},
       {"period", 0.008},
       {"mean_pull", 0.003},
       {"peak_current", 0.0011},
       {"peak_source_voltage", 120},
       {"peak_gap_voltage", 81},
       {"distortion", 0.025},
       {"friction_lines",
        {{{"frequency", 0}, {"amplitude", 0.3}},
         {{"frequency", 100}, {"amplitude", 0.05}},
         {{"frequency", 1000}, {"amplitude", 0.0005}},
         {{"frequency", 20000}, {"amplitude", 5e-8}}}},
       {"over_frequency", nlohmann::json::array({sweep})},
       {"onset_off", 0.21},
       {"onset_on", 0.22},
       {"onset_static", 0.23},
       {"checks",
        {{{"name", "body current"}, {"value", 0.0004}, {"limit", 0.0005}, {"passes", true}},
         {{"name", "source voltage"}, {"value", 200}, {"limit", 150}, {"passes", false}}}}});
}

TEST(DriveReport, TablesHaveTheColumnsOfTheirHead) {
  const Driven d;
  EXPECT_EQ(drive_series_csv(d.r),
            "t [s],source voltage [V],current [A],gap voltage [V],pull [N],friction [N]\n"
            "0,0,0,0,0,0.2\n"
            "0.002,100,0.0001,70,0.01,0.5\n"
            "0.004,50,0.0002,35,0.002,0.3\n"
            "0.006,-20,0.0003,-14,0.004,0.25\n");
  EXPECT_EQ(drive_lines_csv(d.r),
            "frequency [Hz],friction amplitude [N]\n0,0.3\n100,0.05\n1000,0.0005\n20000,5e-08\n");
}

TEST(DriveReport, ASwipeByItsStates) {
  Swipe swipe;
  swipe.steps = {{0.25, SlipState::Stuck, 0.002},
                 {0.5, SlipState::Partial, 0.001},
                 {0.75, SlipState::Full, 0},
                 {1, SlipState::Idle, 0}};
  swipe.duration = 1.5, swipe.driven = 0.625;
  EXPECT_EQ(swipe_text(swipe),
            "\nswipe\n         s  state           current mA\n"
            "     0.250  stuck                    2\n"
            "     0.500  partial slip             1\n"
            "     0.750  full slip                0\n"
            "     1.000  idle                     0\n"
            "driven for 0.625 s of 1.5 s\n");
  swipe.without_tones = true;
  EXPECT_TRUE(swipe_text(swipe).starts_with(
      "\nswipe\nthe current is the carrier's amplitude, in the place of what the tones make of it\n"
      "         s  state           current mA\n"));
}

std::vector<std::vector<double>> numbers_in(const std::string& text, const std::string& pattern) {
  std::vector<std::vector<double>> out;
  const std::regex regex(pattern);
  for (std::sregex_iterator it(text.begin(), text.end(), regex), end; it != end; ++it) {
    out.emplace_back();
    for (std::size_t k = 1; k < it->size(); ++k) out.back().push_back(std::stod((*it)[k]));
  }
  return out;
}

// Decades begin below the first line, wherever it lies in its own.
TEST(DriveReport, ALineBetweenTwoDecadesStandsBetweenTheirLabels) {
  Driven d;
  d.r.lines = {{0, 0.3}, {250, 0.05}, {4000, 0.01}};
  const std::string svg = drive_svg(d.c, d.r), number = "([-+.e0-9]+)";
  const auto decades = numbers_in(svg, "<text x=\"" + number + "\" y=\"[0-9.]+\" " +
                                           "text-anchor=\"middle\">" + number + " Hz<");
  ASSERT_EQ(decades.size(), 3u);
  const auto lines = numbers_in(svg, "<line x1=\"" + number + "\"");
  ASSERT_EQ(lines.size(), 2u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(decades[k][1], std::pow(10, k + 2)) << k;
  for (std::size_t k = 0; k < 2; ++k) {
    const double decade = (lines[k][0] - decades[0][0]) / (decades[1][0] - decades[0][0]);
    EXPECT_NEAR(decade, std::log10(d.r.lines[k + 1].frequency / 100), 2e-3) << k;
  }
}

// Friction from its lowest to its highest line, and each line of the spectrum where the labels of
// the decades put it, down 120 dB.
TEST(DriveReport, ThePictureIsReadBackByItsLabels) {
  const Driven d;
  const std::string svg = drive_svg(d.c, d.r), number = "([-+.e0-9]+)";
  EXPECT_NE(svg.find(">a &lt;case><"), std::string::npos);
  EXPECT_NE(svg.find(">500 mN<"), std::string::npos);
  EXPECT_NE(svg.find(">200<"), std::string::npos);
  EXPECT_NE(svg.find(">friction over 8 ms<"), std::string::npos);
  const auto frames = numbers_in(svg, "<rect x=\"" + number + "\" y=\"" + number + "\" width=\"" +
                                          number + "\" height=\"" + number + "\" fill=\"none\"");
  ASSERT_EQ(frames.size(), 2u);
  const auto bottom = [&](std::size_t k) { return frames[k][1] + frames[k][3]; };
  EXPECT_GT(frames[1][1], bottom(0));  // one below the other
  const std::string points = svg.substr(svg.find("points=\"") + 8);
  std::vector<double> lowest(5, kInfinity), highest(5, -kInfinity);  // friction by quarter
  double last = 0;
  for (const auto& p : numbers_in(points.substr(0, points.find('"')), number + "," + number)) {
    const double share = (p[0] - frames[0][0]) / frames[0][2];
    EXPECT_GE(p[0], last);
    last = p[0];
    const double newton = 0.2 + 0.3 * (bottom(0) - p[1]) / frames[0][3];
    const auto quarter = static_cast<std::size_t>(4 * share + 1e-9);
    lowest[quarter] = std::min(lowest[quarter], newton);
    highest[quarter] = std::max(highest[quarter], newton);
  }
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(lowest[k], d.r.friction.value[k], 2e-4) << k;
    EXPECT_NEAR(highest[k], d.r.friction.value[k], 2e-4) << k;
  }
  const auto decades = numbers_in(svg, "<text x=\"" + number + "\" y=\"[0-9.]+\" " +
                                           "text-anchor=\"middle\">" + number + " Hz<");
  ASSERT_GE(decades.size(), 3u);
  EXPECT_EQ(decades.front()[1], 100);
  EXPECT_EQ(decades.back()[1], 100000);
  EXPECT_EQ(decades.front()[0], frames[1][0]);
  EXPECT_EQ(decades.back()[0], frames[1][0] + frames[1][2]);
  const auto lines = numbers_in(svg, "<line x1=\"" + number + "\" y1=\"" + number + "\" x2=\"" +
                                         number + "\" y2=\"" + number + "\"");
  ASSERT_EQ(lines.size(), 3u);  // 0 Hz has no place
  for (std::size_t k = 0; k < 3; ++k) {
    const double decade = (lines[k][0] - decades[0][0]) / (decades[1][0] - decades[0][0]);
    EXPECT_NEAR(decade, std::log10(d.r.lines[k + 1].frequency / 100), 2e-3);
    EXPECT_EQ(lines[k][0], lines[k][2]);
    EXPECT_EQ(lines[k][1], bottom(1));
    const double decibel = 120 * (bottom(1) - lines[k][3]) / frames[1][3] - 120;
    EXPECT_NEAR(decibel, std::max(-120.0, 20 * std::log10(d.r.lines[k + 1].amplitude / 0.05)), 0.1);
  }
  EXPECT_NE(svg.find(">50 mN<"), std::string::npos);  // the largest line
  // Labels of the sides end just before their frame, at its upper and its lower edge.
  const auto sides =
      numbers_in(svg, "<text x=\"" + number + "\" y=\"" + number + "\" text-anchor=\"end\">");
  ASSERT_EQ(sides.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& f = frames[i / 2];
    EXPECT_EQ(sides[i][0], f[0] - 6);
    EXPECT_EQ(sides[i][1], i % 2 == 0 ? f[1] + 10 : f[1] + f[3]) << i;
  }
}

// No friction at all is a line along the lower edge.
TEST(DriveReport, FrictionThatStaysZeroIsDrawn) {
  Driven d;
  d.r.friction.value = {0, 0, 0, 0};
  const std::string svg = drive_svg(d.c, d.r);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  const std::string points = svg.substr(svg.find("points=\"") + 8);
  for (const auto& p : numbers_in(points.substr(0, points.find('"')), "([-+.e0-9]+),([-+.e0-9]+)"))
    ASSERT_EQ(p[1], 240);
}

TEST(DriveReport, ASwipeForProgramsIsInSi) {
  Swipe swipe;
  swipe.steps = {{0.25, SlipState::Stuck, 0.002}, {0.5, SlipState::Full, 0.001}};
  swipe.duration = 1.5, swipe.driven = 0.625;
  swipe.samples = {{.time = 0.125,
                    .place = 0.01,
                    .lateral = 0.3,
                    .state = SlipState::Partial,
                    .current = 0.004}};
  EXPECT_EQ(swipe_csv(swipe),
            "t [s],place [m],lateral [N],state,current [A]\n0.1250,0.01,0.3,partial slip,0.004\n");
  Driven d;
  d.r.spots = 4e6;
  const auto json = nlohmann::json::parse(drive_json(d.c, d.r, {swipe}));
  EXPECT_EQ(json["contact_spots"], 4e6);
  expect_same(json["swipes"][0],
              {{"duration", 1.5},
               {"driven", 0.625},
               {"steps",
                {{{"time", 0.25}, {"state", "stuck"}, {"current", 0.002}},
                 {{"time", 0.5}, {"state", "full slip"}, {"current", 0.001}}}}},
              "swipe");
  for (const bool counted : {false, true}) {
    d.c.gap.contact_spots = counted;
    EXPECT_NE(drive_text(d.c, d.r).find(
                  std::string("spots        4 Mohm through the skin to its contact spots, ") +
                  (counted ? "beside the gap\n" : "not counted (gap.contact_spots)\n")),
              std::string::npos);
  }
}

}  // namespace
}  // namespace papilla::tests::drive_test
