// A response as people and programs read it: made-up numbers, each another.
#include "report/response.h"

#include <gtest/gtest.h>

#include <string>

#include "base/constants.h"
#include "report/sweep.h"
#include "tests/report/same_json.h"

namespace papilla::tests::response_test {
namespace {

// The quantities of a point by their place in the table: 100, 101, ... thousandths.
ResponsePoint numbered() {
  ResponsePoint p;
  for (std::size_t k = 0; k < kPointQuantities.size(); ++k) {
    Measured& m = p.*kPointQuantities[k].value;
    m.value = 1e-3 * (100.0 + static_cast<double>(k));
    m.parts.sampling = 1e-3 * (3.0 + static_cast<double>(k));
  }
  p.relative_humidity = 0.35;
  p.weight = 2;
  p.patch_pressure = 45e3;
  p.over_limit_area = 0.021, p.over_limit_share = 0.22;
  p.peak_oxide_field = 2.3e8, p.oxide_margin = 2.4, p.bridged_margin = 1.9,
  p.peak_air_field = 2.5e7;
  p.field_correction = 0.94, p.field_error = 0.06, p.bridge_water_share = 0.27;
  p.capillary_gain = 0.019;
  return p;
}

Response driven() {
  Response r;
  r.driven = true;
  r.points = {numbered()};
  r.fidelity.level = "draft";
  r.fidelity.grid = 96, r.fidelity.skins = 5;
  r.fidelity.contact_tolerance = 2e-4;
  r.plan.grid = {96, 48, 12e-6, 6e-6};
  r.plan.effective_cutoff = 2.5e-7;
  r.plan.feature_pixels = 8.5;
  r.plan.warnings = {"a smoother skin"};
  r.plan.steps = {{Piece::Contact, "dense", "why", 1.5, 0.01}, {Piece::Water, "w", "x", 0.5, 0}};
  r.plan.skipped = {{Piece::Kelvin, "small", 0.002, false}};
  r.contact_solves = 12;
  r.fft_pairs = 34.5;
  r.seconds = 6.5;
  r.piece_seconds = {1, 2, 3};
  return r;
}

TEST(ResponseReport, TheTableHasEachNumberUnderItsHead) {
  Response r = driven();
  r.points[0].bridges.value = 7.25;
  r.points[0].mean_gap.value = 110e-9;
  const std::string table = response_table(r);
  EXPECT_TRUE(table.starts_with(
      "    RH patch kPa         F_off mN          F_on mN      modulation  contact off %   "
      "capillary mN     electro mN   bridges    gap nm\n"
      "   35%        45       100.0 ±3.0       101.0 ±4.0    0.102 ±0.005  10.300 ±0.600     "
      "105.0 ±8.0     106.0 ±9.0       7.2       110\n"
      "modulation █  mean 0.102 ±0.005  worst 0.102 ±0.005\n"
      "error of the mean modulation: sampling 4.9 %; parameters not asked for (--parameters); "
      "error "
      "from grid, solver: not measured\n"
      "not in ±: choices of the model (papilla explain), expected Kelvin condensation 0.2 %, "
      "what air withstands (model.air_limit), where 22 % of the pull stands\n"
      "air beyond its breakdown field on up to 2.1 % of the patch, 22 % of the pull; peak field in "
      "the dielectric 230 V/um\n"
      "pull: field rule times 0.94 to 0.94, by the 3-D field; good to 6 %\n"))
      << table;
  r.points[0].oxide_margin = 0.8;
  const std::string broken = response_table(r);
  EXPECT_NE(broken.find("the field in a layer is 1.25 times its strength; at most 0.8 of this "
                        "amplitude holds"),
            std::string::npos)
      << broken;
  EXPECT_EQ(broken.find("pull: field rule"), std::string::npos);
  r.driven = false;
  const std::string off = response_table(r);
  EXPECT_NE(off.find("mean friction 100.0 ±3.0 mN; error: sampling 3.0 %"), std::string::npos)
      << off;
  EXPECT_EQ(off.find("modulation █"), std::string::npos);
}

TEST(ResponseReport, OverHumidityItSaysHowItVaries) {
  Response r = driven();
  r.points.assign(3, numbered());
  for (std::size_t k = 0; k < 3; ++k) {
    r.points[k].relative_humidity = 0.2 * static_cast<double>(k + 1);
    r.points[k].weight = 1;
    r.points[k].modulation.value = 0.1 * static_cast<double>(k + 1);
    r.points[k].modulation.parts = {.sampling = 0.03};
    r.points[k].field_correction = 0.9 + 0.05 * static_cast<double>(k);
    r.points[k].field_error = 0.05 + 0.02 * static_cast<double>(k);
  }
  const std::string table = response_table(r);
  // Mean 0.2, deviation sqrt(2/3) / 10, range 0.2; the errors of the mean add, the points share
  // their skins.
  EXPECT_NE(table.find("modulation ▃▆█  mean 0.200 ±0.030  worst 0.100 ±0.030  variation (sd/mean) "
                       "0.408 ±"),
            std::string::npos)
      << table;
  EXPECT_NE(table.find("range/mean 1.000 ±"), std::string::npos) << table;
  EXPECT_NE(table.find("times 0.90 to 1.00, by the 3-D field; good to 9 %"), std::string::npos)
      << table;
}

TEST(ResponseReport, ErrorsAreNamedWithTheirShares) {
  Response r = driven();
  r.plan.field = r.plan.water = true;
  r.points[0].modulation.value = 0.2;
  r.points[0].modulation.parts = {.sampling = 0.01,
                                  .grid = 0.02,
                                  .solver = 0.001,
                                  .humidity = std::nullopt,
                                  .method = 0.005,
                                  .parameters = 0.03,
                                  .water = 0.04};
  EXPECT_NE(response_table(r).find("sampling 5.0 %, grid 10 %, solver 0.5 %, method 2.5 %, "
                                   "parameters 15 %; beside it: water 20 %, common to all designs; "
                                   "error from field: not measured\n"),
            std::string::npos)
      << response_table(r);
}

TEST(ResponseReport, VoltagesTargetAndLookHaveALineEach) {
  Response r = driven();
  VoltageAnswer reached;
  reached.target = 0.5;
  reached.amplitude.value = 123.4;
  reached.amplitude.parts = {.sampling = 3, .grid = 4};
  VoltageAnswer ends;
  ends.target = 2, ends.modulation = 0.75, ends.limit = 300, ends.end = VoltageEnd::Breakdown;
  VoltageAnswer none;  // is not asked of the model: nothing came first
  none.target = 3, none.end = VoltageEnd::NoField;
  r.points[0].voltages = {reached, ends, none};
  r.accuracy.target = 0.02, r.accuracy.reached = 0.015, r.accuracy.quantity = "mean(modulation)";
  r.appearance = Optics{};
  r.appearance->haze = 0.0123, r.appearance->transmittance = 0.912, r.appearance->gloss = 87;
  r.appearance->colour_shift = 0.0021;
  const std::string table = response_table(r);
  for (const std::string& line :
       {std::string(
            "modulation 0.5 at 35 % RH: 123.4 ±5.0 V (±: sampling, grid; not in ±: solver, method, "
            "field, parameters, model, water)\n"),
        "modulation 2 at 35 % RH: " + text(ends) + " first (modulation 0.75)\n",
        "modulation 3 at 35 % RH: " + text(none) + "\n",
        std::string("accuracy 2 % asked for, 1.5 % of mean(modulation): reached (96 pixels, 5 "
                    "skins, solved areas)\n"),
        std::string(
            "haze 1.23 %  transmittance 91.2 %, 100.0 % in all  gloss 87.0 GU  distinctness of "
            "image 100.0 %  colour shift 0.0021  (flat)\n")})
    EXPECT_NE(table.find(line), std::string::npos) << line << table;
}

TEST(ResponseReport, UnderCurrentTheVoltagesAreNamedWithTheirHumidities) {
  Response r = driven();
  r.points.push_back(r.points[0]);
  r.points[0].source_voltage = 81.4, r.points[1].source_voltage = 12.6;
  r.points[1].relative_humidity = 0.75;
  EXPECT_NE(response_table(r).find("the current takes 13 V at 75 % RH to 81 V at 35 %\n"),
            std::string::npos)
      << response_table(r);
  r.points[1].source_voltage = 81.4;
  EXPECT_EQ(response_table(r).find("the current takes"), std::string::npos);
}

TEST(ResponseReport, ForProgramsEveryQuantityIsUnderItsName) {
  const Response r = driven();
  const auto json = nlohmann::json::parse(response_json(r));
  const nlohmann::json& p = json["points"][0];
  // These keys are a promise; the list may grow.
  for (const char* key : {"F_off", "F_on", "modulation", "area_fraction_off", "area_fraction_on",
                          "capillary_force", "electrostatic_force", "retention_force", "bridges",
                          "wetted_fraction", "mean_gap", "indentation"})
    EXPECT_TRUE(p.contains(key)) << key;
  for (const auto& q : api::kQuantities<Measured>) {
    const Measured& m = r.points[0].*q.value;
    expect_same(p.at(q.key),
                {{"value", m.value},
                 {"se", m.parts.sampling},
                 {"numerical", m.parts.sampling},
                 {"model", nullptr},
                 {"parts",
                  {{"sampling", m.parts.sampling},
                   {"grid", nullptr},
                   {"field", nullptr},
                   {"solver", nullptr},
                   {"humidity", nullptr},
                   {"method", nullptr},
                   {"parameters", nullptr},
                   {"model", nullptr},
                   {"water", nullptr}}}},
                q.key);
  }
  for (const auto& [key, value] : {std::pair{"relative_humidity", 0.35},
                                   {"weight", 2.0},
                                   {"patch_pressure", 45e3},
                                   {"bridge_water_share", 0.27},
                                   {"over_limit_area", 0.021},
                                   {"over_limit_share", 0.22},
                                   {"capillary_gain", 0.019},
                                   {"peak_air_field", 2.5e7},
                                   {"peak_oxide_field", 2.3e8},
                                   {"field_correction", 0.94},
                                   {"field_error", 0.06},
                                   {"oxide_margin", 2.4},
                                   {"bridged_margin", 1.9}})
    EXPECT_EQ(p.at(key), value) << key;
  EXPECT_EQ(p["status"], "ok");
  EXPECT_NEAR(json["summary"]["mean_modulation"]["value"].get<double>(), 0.102, 1e-12);
  EXPECT_NEAR(json["summary"]["mean_friction"]["value"].get<double>(), 0.1, 1e-12);
  expect_same(json["plan"],
              {{"grid", {{"nx", 96}, {"ny", 48}, {"lx", 12e-6}, {"ly", 6e-6}}},
               {"effective_cutoff", 2.5e-7},
               {"feature_pixels", 8.5},
               {"warnings", {"a smoother skin"}},
               {"seconds", 2},
               {"steps",
                {{{"piece", "contact"},
                  {"method", "dense"},
                  {"reason", "why"},
                  {"seconds", 1.5},
                  {"error", 0.01}},
                 {{"piece", r.plan.steps[1].name()},
                  {"method", "w"},
                  {"reason", "x"},
                  {"seconds", 0.5},
                  {"error", 0}}}},
               {"skipped",
                {{{"piece", r.plan.skipped[0].name()},
                  {"reason", "small"},
                  {"bound", 0.002},
                  {"estimate", false}}}}},
              "plan");
  expect_same(json["processor_seconds"], {{"contact", 1}, {"water", 2}, {"field", 3}}, "seconds");
  EXPECT_EQ(json["seconds"], 6.5);
  EXPECT_EQ(json["contact_solves"], 12);
  EXPECT_EQ(json["fft_pairs"], 34.5);
  expect_same(json["fidelity"],
              {{"level", "draft"},
               {"grid", 96},
               {"window", 12e-6},
               {"skins", 5},
               {"estimator", "area"},
               {"contact_tolerance", 2e-4}},
              "fidelity");
  const auto timeless = nlohmann::json::parse(response_json(r, false));
  EXPECT_FALSE(timeless.contains("seconds") || timeless.contains("processor_seconds"));
  Response undriven = r;
  undriven.driven = false;
  const auto off = nlohmann::json::parse(response_json(undriven))["points"][0];
  EXPECT_TRUE(off["F_on"].is_null() && off["modulation"].is_null());
  EXPECT_TRUE(off["area_fraction_on"].is_null());
  Response broken = r;
  broken.points[0].oxide_margin = 0.9;
  const auto numberless = nlohmann::json::parse(response_json(broken));
  const nlohmann::json& there = numberless["points"][0];
  EXPECT_TRUE(there["status"].get<std::string>().starts_with("breakdown: "));
  EXPECT_TRUE(numberless["status"].get<std::string>().starts_with("35 % RH: breakdown: "));
  for (const char* name : {"F_on", "modulation", "area_fraction_on", "electrostatic_force"})
    EXPECT_TRUE(there[name].is_null()) << name;
  EXPECT_FALSE(there["F_off"].is_null() || there["area_fraction_off"].is_null());
  for (const char* name : {"mean_modulation", "variation", "range", "worst", "std"})
    EXPECT_TRUE(numberless["summary"][name].is_null()) << name;
  EXPECT_FALSE(numberless["summary"]["mean_friction"].is_null());
  Response closed = r;
  closed.points[0].status = {Trouble::GrowingPullIn, 0, ""};
  closed.points[0].source_voltage = 400;
  const auto jumped = nlohmann::json::parse(response_json(closed));
  EXPECT_TRUE(jumped["points"][0]["status"].get<std::string>().starts_with("pull-in: "));
  EXPECT_TRUE(jumped["points"][0]["modulation"].is_null());
  EXPECT_TRUE(jumped["summary"]["mean_modulation"].is_null());
  EXPECT_FALSE(jumped["points"][0]["F_off"].is_null());
  broken.points[0].area_fraction_off.value = 1.5;  // full contact under the load alone
  const auto full = nlohmann::json::parse(response_json(broken));
  EXPECT_TRUE(full["points"][0]["F_off"].is_null() && full["summary"]["mean_friction"].is_null());
}

TEST(ResponseReport, ASweepHasALineAValue) {
  Response r = driven();
  r.appearance = Optics{};
  r.appearance->haze = 0.0345;
  EXPECT_EQ(sweep_head("texture.depth", true),
            "   texture.depth     F_off mN    mean modulation      variation          worst   haze "
            "%\n");
  EXPECT_EQ(sweep_line("300 nm", r),
            "          300 nm 100.000 ±3.000       0.102 ±0.005              -   0.102 ±0.005     "
            "3.45\n");
  r.points[0].oxide_margin = 0.5;
  EXPECT_NE(sweep_line("1", r).find("  35 % RH: breakdown: "), std::string::npos);
  EXPECT_EQ(sweep_line("1", r).find("0.102"), std::string::npos);
  const auto json = nlohmann::json::parse(sweep_json("texture.depth", {{3e-7, r}, {4e-7, r}}));
  EXPECT_EQ(json["runs"][0]["value"], 3e-7);
  EXPECT_EQ(json["runs"][1]["value"], 4e-7);
  EXPECT_EQ(json["runs"][1]["response"]["points"][0]["weight"], 2);
}

// Each in parts of the mean's size, whatever its sign.
TEST(ResponseReport, ATargetNamesWhatItLeavesOut) {
  Response r = driven();
  r.accuracy.target = 0.02;
  EXPECT_EQ(response_table(r).find("not counted in it"), std::string::npos);
  for (const double modulation : {0.2, -0.2}) {
    r.points[0].modulation.value = modulation;
    r.points[0].modulation.parts = {.sampling = 0.01, .field = 0.01, .parameters = 0.03};
    EXPECT_NE(response_table(r).find("\nnot counted in it: field 5 %, parameters 15 %\n"),
              std::string::npos)
        << response_table(r);
  }
  r.points[0].modulation.parts = {.sampling = 0.01, .field = 0.0, .parameters = 0.03};
  EXPECT_NE(response_table(r).find("\nnot counted in it: parameters 15 %\n"), std::string::npos)
      << response_table(r);
  r.driven = false;  // then it is the friction that was asked for, 0.1 N
  r.points[0].friction_off.parts = {.sampling = 0.01, .field = 0.002};
  EXPECT_NE(response_table(r).find("\nnot counted in it: field 2 %\n"), std::string::npos)
      << response_table(r);
}

TEST(ResponseReport, StepsOfTheFingerHaveALine) {
  Response r = driven();
  const Resampled same = r;
  r.parameters.steps.assign(3, {same, same});
  r.parameters.skins = 16, r.parameters.grid = 64;
  const std::string line =
      "parameters: 3 directions of the finger's covariance, one standard deviation up and down, 16 "
      "skins, 64 pixels";
  EXPECT_NE(response_table(r).find(line + "\n"), std::string::npos) << response_table(r);
  r.parameters.troubles = {{0.35, {Trouble::Flooded, 0, ""}}};
  EXPECT_NE(response_table(r).find(line + "; a step is not sound: " + text(r.parameters.troubles)),
            std::string::npos)
      << response_table(r);
}

}  // namespace
}  // namespace papilla::tests::response_test
