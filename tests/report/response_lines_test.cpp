// The lines below the table of a response, and the parts of its document that are there on request:
// each as a whole, of made-up numbers.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/constants.h"
#include "report/response.h"
#include "report/sweep.h"
#include "tests/report/same_json.h"

namespace papilla::tests::response_lines_test {
namespace {

using Json = nlohmann::json;

ResponsePoint point(double humidity, double friction) {
  ResponsePoint p;
  p.relative_humidity = humidity;
  p.patch_pressure = 40e3;
  p.friction_off.value = friction, p.friction_off.parts.sampling = 0.1 * friction;
  p.friction_on.value = 2 * friction, p.friction_on.parts.sampling = 0.2 * friction;
  p.modulation.value = 1, p.modulation.parts.sampling = 0.05;
  p.oxide_margin = 5;
  return p;
}

// What stands below the table's line of this humidity.
std::string below(const Response& r) {
  std::string table = response_table(r);
  for (std::size_t i = 0; i <= r.points.size(); ++i) table.erase(0, table.find('\n') + 1);
  return table;
}

TEST(ResponseLines, WithoutADriveThereIsFrictionAlone) {
  Response r;
  r.points = {point(0.15, 0.1)};
  r.points[0].capillary_force.value = 0.0123, r.points[0].capillary_force.parts.grid = 0.002;
  r.points[0].bridges.value = 2.25, r.points[0].mean_gap.value = 1.5e-6;
  r.points[0].area_fraction_off.value = 0.01;
  EXPECT_EQ(
      response_table(r),
      "    RH patch kPa         F_off mN          F_on mN      modulation  contact off %   "
      "capillary mN     electro mN   bridges    gap nm\n"
      "   15%        40      100.0 ±10.0                -               -   1.000 ±0.000      "
      "12.3 ±2.0              -       2.2      1500\n"
      "undriven (0 V): no modulation\n"
      "mean friction 100.0 ±10.0 mN; error: sampling 10.0 %; parameters not asked for "
      "(--parameters); error from grid, solver: not measured\n");
  EXPECT_EQ(modulation_sparkline(r), "");
  r.points[0].friction_off.value = 0;  // no size to compare an error to
  EXPECT_EQ(below(r), "undriven (0 V): no modulation\nmean friction 0.0 ±10.0 mN; error: \n");
}

TEST(ResponseLines, CountNoErrorOfArithmetic) {
  Response r;
  r.points = {point(0.15, 0.1)};
  r.points[0].friction_off.parts.grid = 1e-4, r.points[0].friction_off.parts.solver = 2e-20;
  EXPECT_NE(below(r).find("error: sampling 10.0 %, grid 0.1 %, solver 0 %;"), std::string::npos)
      << below(r);
}

// Of a load of a millinewton digits follow the error; of what is zero there are no more.
TEST(ResponseLines, HaveDigitsOfSmallNumbersToo) {
  Response r;
  r.points = {point(0.149, 0.0003), point(0.15, 0.1)};
  r.points[0].friction_off.parts.sampling = 1.2e-5;
  r.points[0].capillary_force.value = 1.234e-6, r.points[0].capillary_force.parts.grid = 5e-7;
  r.points[0].area_fraction_off.value = 1.5e-5, r.points[0].area_fraction_off.parts.grid = 2e-6;
  const std::string table = response_table(r);
  EXPECT_NE(table.find("\n 14.9%        40       0.30 ±0.01                -               - "
                       "0.0015 ±0.0002 0.0012 ±0.0005              -"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find("\n 15.0%        40      100.0 ±10.0"), std::string::npos) << table;
  EXPECT_NE(table.find("  0.0 ±0.0 "), std::string::npos) << table;  // no water at all
  r.points.pop_back();
  r.points[0].friction_off.value = 0.0003;
  EXPECT_TRUE(response_table(r).find("\n   15%") != std::string::npos) << response_table(r);
  EXPECT_NE(below(r).find("mean friction 0.30 ±0.01 mN"), std::string::npos) << below(r);
}

// Where the drive raises what water holds by a fifth of the pull or more, or less it.
TEST(ResponseLines, NameTheLoadThatTheDriveAddsBesideThePull) {
  Response r;
  r.driven = true;
  r.points = {point(0.15, 0.1), point(0.35, 0.1), point(0.75, 0.1)};
  for (ResponsePoint& p : r.points) p.electrostatic_force.value = 0.1;
  r.points[0].capillary_gain = 0.019;
  EXPECT_EQ(below(r).find("capillary"), std::string::npos) << below(r);
  r.points[1].capillary_gain = 0.4067, r.points[2].capillary_gain = -0.03;
  EXPECT_NE(below(r).find("F_on follows the pull and the capillary force under the drive, which "
                          "differs from that without it by +406.7 mN at 35 % RH, -30.0 mN at 75 % "
                          "RH\n"),
            std::string::npos)
      << below(r);
  r.points[1].status = {Trouble::ClosedPullIn, 0, ""};  // has no number; the other has
  EXPECT_NE(below(r).find(" by -30.0 mN at 75 % RH\n"), std::string::npos) << below(r);
}

TEST(ResponseLines, OfTheFieldSayTheWorstOfAllHumidities) {
  Response r;
  r.driven = true;
  r.points = {point(0.2, 0.1), point(0.8, 0.1)};
  ResponsePoint &a = r.points[0], &b = r.points[1];
  a.over_limit_area = 0.3, b.over_limit_area = 0.1;
  a.over_limit_share = 0.1, b.over_limit_share = 0.4;
  a.peak_oxide_field = 2e8, b.peak_oxide_field = 1e8;
  a.field_correction = 1.2, b.field_correction = 0.8;
  a.field_error = 0.02;
  const std::string air =
      "air beyond its breakdown field on up to 30.0 % of the patch, 40 % of the pull; peak field "
      "in the dielectric 200 V/um\n";
  const auto last = [&] {
    const std::string text = below(r);
    return text.substr(text.find("air beyond"));
  };
  // Of one humidity it was not measured: then of none.
  EXPECT_EQ(last(), air +
                        "pull: by the field rule, its distance from the 3-D field not measured "
                        "at this level\n");
  b.field_error = 0.07;
  EXPECT_EQ(last(), air + "pull: field rule times 0.80 to 1.20, by the 3-D field; good to 7 %\n");
  a.oxide_margin = 1;  // holds just so
  EXPECT_EQ(last(), air + "pull: field rule times 0.80 to 1.20, by the 3-D field; good to 7 %\n");
  a.bridged_margin = 1;
  EXPECT_EQ(last(), air + "pull: field rule times 0.80 to 1.20, by the 3-D field; good to 7 %\n");
  a.bridged_margin = 0.8;
  EXPECT_EQ(last(), air +
                        "warning: the dielectric is at risk: it holds the field that was solved, "
                        "but under a bridge or a contact on its thinnest place the field is "
                        "1.25 times its strength; at most 0.8 of this amplitude is sure to hold, "
                        "and voltage_for and studies that limit oxide_breakdown_margin go no "
                        "farther\n"
                        "pull: field rule times 0.80 to 1.20, by the 3-D field; good to 7 %\n");
  a.bridged_margin = 0;
  EXPECT_EQ(last(), air +
                        "warning: the dielectric is at risk: it holds the field that was solved, "
                        "but the electrode is bare on side walls, where a bridge or a contact "
                        "would short the drive; voltage_for and studies that limit "
                        "oxide_breakdown_margin refuse it: cover the walls "
                        "(surface.step_coverage, a conformal layer)\n"
                        "pull: field rule times 0.80 to 1.20, by the 3-D field; good to 7 %\n");
  a.oxide_margin = 0.5;
  EXPECT_EQ(last(), air +
                        "warning: the dielectric breaks down: the field in a layer is 2 times its "
                        "strength; at most 0.5 of this amplitude holds; the numbers under voltage "
                        "mean nothing physical\n"
                        "note: 20 % RH: breakdown: the field in a layer of the dielectric is 2 "
                        "times its strength, the numbers under voltage mean nothing physical\n");
  EXPECT_NE(response_table(r).find("modulation: no number over humidity"), std::string::npos);
  a.oxide_margin = a.bridged_margin = 5;
  for (Measured PointQuantities::*area :
       {&PointQuantities::area_fraction_off, &PointQuantities::area_fraction_on}) {
    (b.*area).value = 1;
    EXPECT_NE(last(), air);
    (b.*area).value = 1.01;  // more contact than there is patch
    EXPECT_EQ(last(), air);
    (b.*area).value = 0;
  }
}

// What breaks down at one humidity has no mean over them, nor a band of the members.
TEST(ResponseLines, OfBeliefHaveNoMeanOfWhatBreaksDown) {
  Response r;
  r.driven = true;
  r.points = {point(0.352, 0.1), point(0.354, 0.1)};
  r.belief.own = {r.points, {r.points, r.points}};
  r.belief.members = {{0.5, "", r.belief.own}, {0.5, "", r.belief.own}};
  const auto row = [&](const std::string& name) {
    const std::string table = response_table(r);
    const auto begin = table.find("\n" + name, table.find("median [95 %]")) + 1;
    return table.substr(begin, table.find('\n', begin) - begin);
  };
  const auto cells = [](const char* value, const char* numerical, const char* model) {
    return fmt::format(" {:>12} {:>12} {:>30}", value, numerical, model);
  };
  const std::string off = cells("100.0", "10.0", "0.0; 100.0 [100.0, 100.0]"),
                    on = cells("200.0", "20.0", "0.0; 200.0 [200.0, 200.0]"),
                    more = cells("1.000", "0.050", "0.000; 1.000 [1.000, 1.000]"),
                    none = cells("-", "-", "-");
  EXPECT_EQ(row(" 35.2%"), " 35.2%" + off + on + more);  // two that per cents do not tell apart
  EXPECT_EQ(row("  mean").find('-'), std::string::npos) << row("  mean");
  r.points[0].oxide_margin = 0.5;
  EXPECT_EQ(row(" 35.2%"), " 35.2%" + off + none + none);
  EXPECT_EQ(row(" 35.4%"), " 35.4%" + off + on + more);
  EXPECT_TRUE(row("  mean").ends_with("100.0 [100.0, 100.0]" + none + none)) << row("  mean");
}

// One list for the table and for the studio's page: with its lines the table ends, before notes.
TEST(ResponseLines, ThatLimitTrustEndTheTable) {
  Response r;
  r.driven = true;
  r.points = {point(0.15, 0.1)};
  r.points[0].electrostatic_force.value = 0.1, r.points[0].capillary_gain = 0.4;
  r.points[0].over_limit_area = 0.3, r.points[0].over_limit_share = 0.4;
  r.points[0].field_error = 0.02;
  r.appearance = Optics{};
  r.plan.warnings = {"one", "two"};
  const std::vector<std::string> lines = caveats(r);
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_TRUE(lines[0].starts_with("not in ±: choices of the model")) << lines[0];
  EXPECT_TRUE(lines[1].starts_with("F_on follows the pull and the capillary force")) << lines[1];
  EXPECT_TRUE(lines[2].starts_with("air beyond its breakdown field on up to 30.0 %")) << lines[2];
  EXPECT_TRUE(lines[3].ends_with("by the 3-D field; good to 2 %")) << lines[3];
  EXPECT_EQ(lines[4], "warning: one");
  EXPECT_EQ(lines[5], "warning: two");
  std::string all;
  for (const std::string& line : lines) all += line + "\n";
  EXPECT_TRUE(response_table(r).ends_with("\n" + all)) << response_table(r);
  r.driven = false;
  EXPECT_EQ(caveats(r), (std::vector<std::string>{"warning: one", "warning: two"}));
  r.plan.warnings.clear();
  EXPECT_TRUE(caveats(r).empty());
}

TEST(ResponseLines, ASparklineHasEightHeights) {
  Response r;
  r.driven = true;
  for (int k = 0; k < 8; ++k) {
    r.points.push_back(point(0.1 * k, 0.1));
    r.points.back().modulation.value = 0.3 * k / 7;
  }
  EXPECT_EQ(modulation_sparkline(r), "▁▂▃▄▅▆▇█");
  for (ResponsePoint& p : r.points) p.modulation.value = -0.1;
  r.points[2].modulation.value = 0.2;
  EXPECT_EQ(modulation_sparkline(r), "▁▁█▁▁▁▁▁");
  for (ResponsePoint& p : r.points) p.modulation.value = 0;
  EXPECT_EQ(modulation_sparkline(r), "▁▁▁▁▁▁▁▁");
  r.points.clear();
  EXPECT_EQ(modulation_sparkline(r), "");
}

TEST(ResponseLines, SayWhatWasAskedForBesideTheFriction) {
  Response r;
  r.points = {point(0.15, 0.1)};
  r.fidelity.grid = 64, r.fidelity.skins = 3, r.fidelity.estimator = Estimator::Load;
  r.accuracy.target = 0.05, r.accuracy.reached = 0.1, r.accuracy.quantity = "mean(friction)";
  r.accuracy.end = TargetEnd::TimeSpent;
  r.points[0].friction_off.parts.field = 0.004;
  r.appearance = Optics{};
  r.appearance->regime = OpticsRegime::Refused;
  r.appearance->warning = "too deep";
  r.plan.warnings = {"one", "two"};
  r.points[0].status = {Trouble::Flooded, 0, ""};
  VoltageAnswer v;
  v.target = 0.3, v.amplitude.value = 99.96, v.amplitude.parts = {.sampling = 2};
  v.amplitude.parts.method = 1.5, v.amplitude.parts.water = 5, v.amplitude.parts.humidity = 7;
  r.points[0].voltages = {v};
  const std::string said = below(r);
  EXPECT_EQ(said.substr(said.find("appearance")),
            "appearance: too deep\n"
            "modulation 0.3 at 15 % RH: 100.0 ±7.4 V (±: sampling, method; not in ±: grid, solver, "
            "field, parameters, model, water)\n"
            "accuracy 5 % asked for, 10 % of mean(friction): not reached: the time limit of the "
            "run left no more (64 pixels, 3 skins, load law)\n"
            "not counted in it: field 4 %\n"
            "warning: one\nwarning: two\nnote: " +
                text(r.troubles()) + "\n");
  r.appearance->regime = OpticsRegime::PhaseScreen;
  r.appearance->haze = 0.5, r.appearance->transmittance = 0.25, r.appearance->gloss = 12.5;
  r.appearance->colour_shift = 0.0625;
  EXPECT_NE(below(r).find("\nhaze 50.00 %  transmittance 25.0 %, 100.0 % in all  gloss 12.5 GU  "
                          "distinctness of image 100.0 %  colour shift 0.0625 "
                          " (phase screen: too deep)\n"),
            std::string::npos)
      << below(r);
  // A sweep has a refused look in its column.
  EXPECT_NE(sweep_line("1", r).find("    50.00  15 % RH: flooded: "), std::string::npos);
  r.appearance->regime = OpticsRegime::Refused;
  EXPECT_NE(sweep_line("1", r).find("  refused  15 % RH: flooded: "), std::string::npos);
  EXPECT_EQ(sweep_head("p", false),
            "               p     F_off mN    mean modulation      variation          worst\n");
}

TEST(ResponseDocuments, HaveTheirPartsOnRequest) {
  Response r;
  r.driven = true;
  r.points = {point(0.15, 0.1), point(0.35, 0.2)};
  r.points[0].source_voltage = 81;
  VoltageAnswer reached, ends;
  reached.target = 0.5, reached.amplitude.value = 120, reached.amplitude.parts.sampling = 3;
  reached.modulation = 0.51, reached.limit = 500, reached.evaluations = 5;
  ends.target = 2, ends.modulation = 0.75, ends.limit = 300, ends.evaluations = 4;
  ends.end = VoltageEnd::Breakdown;
  r.points[0].voltages = {reached, ends};
  r.appearance = Optics{};
  r.appearance->haze = 0.01, r.appearance->transmittance = 0.9, r.appearance->gloss = 80;
  r.appearance->colour_shift = 0.002, r.appearance->warning = "shallow";
  const Resampled same = r;
  r.parameters.steps.assign(2, {same, same});
  r.parameters.skins = 16, r.parameters.grid = 64;
  r.accuracy.target = 0.02, r.accuracy.reached = 0.015, r.accuracy.quantity = "mean(modulation)";
  r.accuracy.steps = {"first", "second"};
  Json json = Json::parse(response_json(r));
  const Json parts{{"sampling", 3},         {"grid", nullptr},   {"solver", nullptr},
                   {"humidity", nullptr},   {"method", nullptr}, {"field", nullptr},
                   {"parameters", nullptr}, {"model", nullptr},  {"water", nullptr}};
  expect_same(
      json["points"][0]["voltage_for"],
      Json::array(
          {{{"modulation", 0.5},
            {"amplitude",
             {{"value", 120}, {"se", 3}, {"numerical", 3}, {"model", nullptr}, {"parts", parts}}},
            {"highest_modulation", nullptr},
            {"limit", 500},
            {"evaluations", 5},
            {"status", "ok"}},
           {{"modulation", 2},
            {"amplitude", nullptr},
            {"highest_modulation", 0.75},
            {"limit", 300},
            {"evaluations", 4},
            {"status", text(ends)}}}),
      "voltages");
  EXPECT_FALSE(json["points"][1].contains("voltage_for"));
  EXPECT_EQ(json["points"][0]["source_voltage"], 81);
  expect_same(json["appearance"],
              {{"regime", text(r.appearance->regime)},
               {"warning", "shallow"},
               {"haze", 0.01},
               {"transmittance", 0.9},
               {"gloss", 80},
               {"total_transmittance", 1},
               {"gloss_20", 0},
               {"gloss_85", 0},
               {"distinctness", 1},
               {"sparkle", 0},
               {"colour_shift", 0.002}},
              "appearance");
  expect_same(json["parameters"],
              {{"directions", 2}, {"skins", 16}, {"grid", 64}, {"status", "ok"}}, "parameters");
  expect_same(json["accuracy"],
              {{"target", 0.02},
               {"reached", 0.015},
               {"quantity", "mean(modulation)"},
               {"parts", {"sampling", "grid", "method", "solver"}},
               {"status", "reached"},
               {"steps", {"first", "second"}}},
              "accuracy");
  // Frictions of 0.1 and 0.2 N: their mean. The modulation is 1 at both: it does not vary.
  const auto value = [&](const char* key) { return json["summary"][key]["value"].get<double>(); };
  EXPECT_NEAR(value("mean_friction"), 0.15, 1e-12);
  EXPECT_NEAR(value("mean_modulation"), 1, 1e-12);
  EXPECT_NEAR(value("worst"), 1, 1e-12);
  for (const char* key : {"variation", "range", "std"}) EXPECT_NEAR(value(key), 0, 1e-12) << key;
  EXPECT_EQ(json["summary"].size(), 8u);
  // Each of them in its place.
  r.points[1].modulation.value = 2;
  json = Json::parse(response_json(r));
  EXPECT_NEAR(value("mean_modulation"), 1.5, 1e-12);
  EXPECT_NEAR(value("std"), 0.5, 1e-12);
  EXPECT_NEAR(value("variation"), 1 / 3.0, 1e-12);
  EXPECT_NEAR(value("range"), 2 / 3.0, 1e-12);
  EXPECT_NEAR(value("worst"), 1, 1e-12);
  // Nothing is asked for: nothing stands there; a refused look has no numbers.
  r.appearance->regime = OpticsRegime::Refused;
  r.parameters.steps.clear(), r.accuracy.target = 0;
  json = Json::parse(response_json(r));
  for (const char* key : {"haze", "transmittance", "gloss", "colour_shift"})
    EXPECT_TRUE(json["appearance"][key].is_null()) << key;
  EXPECT_FALSE(json.contains("parameters") || json.contains("accuracy"));
  r.appearance.reset();
  EXPECT_FALSE(Json::parse(response_json(r)).contains("appearance"));
  // A field beyond the strength says so, whatever else there is.
  r.points[0].oxide_margin = 0.99;
  const auto status = [&] {
    return Json::parse(response_json(r))["points"][0]["status"].get<std::string>();
  };
  EXPECT_TRUE(status().starts_with("breakdown: "));
  r.points[0].status = {Trouble::Flooded, 0, ""};
  EXPECT_TRUE(status().starts_with("breakdown: "));
  r.points[0].status = {};
  r.driven = false;
  EXPECT_EQ(status(), "ok");
  EXPECT_TRUE(Json::parse(response_json(r))["points"][0]["source_voltage"].is_null());
  EXPECT_TRUE(Json::parse(response_json(r))["points"][0]["capillary_gain"].is_null());
}

TEST(ResponseDocuments, APlanIsADocumentOfItsOwn) {
  Plan plan;
  plan.grid = {8, 4, 2e-6, 1e-6};
  plan.steps = {{Piece::Contact, "m", "r", 2, 0.5}};
  plan.effective_cutoff = 3e-7, plan.feature_pixels = kInfinity;
  expect_document(plan_document(plan),
                  {{"schema", 1},
                   {"plan",
                    {{"grid", {{"nx", 8}, {"ny", 4}, {"lx", 2e-6}, {"ly", 1e-6}}},
                     {"effective_cutoff", 3e-7},
                     {"feature_pixels", nullptr},
                     {"warnings", Json::array()},
                     {"seconds", 2},
                     {"steps",
                      {{{"piece", "contact"},
                        {"method", "m"},
                        {"reason", "r"},
                        {"seconds", 2},
                        {"error", 0.5}}}},
                     {"skipped", Json::array()}}}});
}

}  // namespace
}  // namespace papilla::tests::response_lines_test
