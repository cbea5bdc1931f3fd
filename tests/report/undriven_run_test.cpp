// A run without a drive, with what the fit of its finger leaves open and with lengths on the grid
// of a fab: summary, sheet and tables as wholes, of made-up numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/files.h"
#include "report/recommendation.h"
#include "report/results.h"
#include "report/run_json.h"
#include "report/sheet.h"
#include "report/stated_number.h"
#include "report/summary.h"
#include "tests/report/same_json.h"
#include "tests/support/golden.h"
#include "tests/support/without_belief.h"
#include "tests/temporary.h"

namespace papilla::tests::undriven_run_test {
namespace {

// Less friction and less variation of it, by the diameter, the depth and the contact angle.
Study undriven() {
  Study study = without_belief(read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml"));
  study.population.clear();
  study.constraints.clear();
  study.objective = {};
  study.objective.minimise = {parse_metric("mean(friction)"), parse_metric("variation(friction)")};
  study.design.drive.amplitude = 0;
  study.design.accuracy.level = AccuracyLevel::Draft;
  study.design.accuracy.parameters = true;
  study.design.finger.uncertainty = {{"macro.shear_strength", 0.1, {}}};
  study.design.title = "";
  study.name = "a study";
  study.variables.erase(study.variables.begin());
  study.search.rounding = 20e-9;
  return study;
}

// first, second: what the finger's parameters do to each objective, alike on all skins.
Score score(double friction, double variation, double first, double second) {
  Score s;
  s.ok = true;
  s.values = {friction, variation};
  s.errors = {0.002, 0.012};
  s.parameter_steps = {{{first, first}}, {{second, second}}};
  return s;
}

struct Searched {
  Study study = undriven();
  StudyProblem problem{study};
  JudgedDesigns history;
  OptimiseResult result;
  std::string folder, pick;

  Searched() {
    result.method = "nsga2", result.why = "why";
    result.evaluations = result.asked = 7;
    FinalDesign best;
    best.unit = problem.space().unit({3e-6, 304e-9, 70 * kPi / 180});
    best.design = problem.space().design(best.unit);
    best.confirmed = score(0.08, 0.25, 0.03, 0.02);
    best.searched = score(0.085, 0.26, 0, 0);
    best.on_front = best.feasible = true;
    best.folder = "front/01";
    result.finalists = {best};
    result.any_feasible = true;
    result.flat = score(0.1, 0.2, 0.025, -0.02);
    BuiltDesign build{best, false};
    build.made.unit = problem.space().unit({3e-6, 300e-9, 70 * kPi / 180});
    build.made.design = problem.space().design_of({3e-6, 300e-9, 70 * kPi / 180});
    build.made.confirmed = score(0.081, 0.255, 0, 0);
    result.build = build;
    result.sensitivity = {{.variable = 1,
                           .change = {0.004, -0.03},
                           .share = {0.9, 0.1},
                           .step = 50e-9,
                           .down = {12e-9, Drift::End::Loss},
                           .up = {50e-9, Drift::End::StepTried}}};
    result.stability.variants = {{"only", {{0.08, 0.25}}, {true}}};
    result.stability.times_on_front = {1};
  }

  ResultFiles files() const { return {folder, study, problem, history, result, pick}; }
};

TEST(UndrivenRun, ItsSummaryIsWithoutModulation) {
  Searched run;
  ASSERT_EQ(run.problem.parameters_unknown(), "");
  ASSERT_FALSE(run.problem.driven());
  const std::string page = as_read(run_summary(run.files()));
  EXPECT_TRUE(is_golden(page, "report/golden/undriven_summary.md"));
  // One design has no order, and a flat surface that is not compared has no row of its own.
  EXPECT_EQ(page.find("Does the order hold?"), std::string::npos);
  EXPECT_EQ(page.find("From the first row to the second"), std::string::npos);
  EXPECT_EQ(page.find("worst modulation"), std::string::npos);
  run.study.design.accuracy.parameters = false;
  EXPECT_NE(as_read(run_summary(run.files()))
                .find("In brackets, of the best design (all: `[accuracy] parameters = true`), the "
                      "model part, what "
                      "the fit"),
            std::string::npos);
  run.result.flat.reset();
  EXPECT_NE(result_table(run.study, run.result).find("common to all designs.\n"),
            std::string::npos);
}

TEST(UndrivenRun, WhatIsBuiltIsOnTheGridOfTheFab) {
  Searched run;
  const Design built = built_design(run.files());
  const auto& holes = std::get<HoleArray>(built.texture.kind);
  EXPECT_DOUBLE_EQ(holes.depth, 300e-9);
  EXPECT_DOUBLE_EQ(holes.diameter, 3e-6);
  const auto json = as_read(run_json(run.files()));
  EXPECT_EQ(json["grid"], 20e-9);
  EXPECT_EQ(json["driven"], false);
  expect_same(json["shown"],
              {{"mean(friction)", {{"scale", 1e3}, {"unit", "mN"}, {"decimals", nullptr}}},
               {"variation(friction)", {{"scale", 1}, {"unit", ""}, {"decimals", 3}}}},
              "shown");
  const auto row = std::find_if(json["sheet"].begin(), json["sheet"].end(),
                                [](const auto& r) { return r["name"] == "texture.depth"; });
  expect_same(
      *row,
      {{"name", "texture.depth"},
       {"words", "depth"},
       {"unit", "nm"},
       {"value", 304},
       {"build", 300},
       {"free", true},
       {"down", 12},
       {"down_at_least", false},
       {"down_limit", nullptr},
       {"up", 50},
       {"up_at_least", true},
       {"up_limit", nullptr},
       {"bound", nullptr},
       {"text", {{"build", "300 nm"}, {"down", "12 nm"}, {"up", "> 50 nm (largest step tried)"}}}},
      "sheet");
  const auto step = [](const char* surface, double friction, double variation) {
    return nlohmann::json{{"surface", surface},
                          {"objectives",
                           {{"mean(friction)", {{"value", friction}, {"se", 0.002}}},
                            {"variation(friction)", {{"value", variation}, {"se", 0.012}}}}}};
  };
  expect_same(json["steps"],
              {step("flat", 0.1, 0.2), step("best, with its texture", 0.08, 0.25),
               step("best, on the grid of the fab", 0.081, 0.255)},
              "steps");
  run.result.build->made.confirmed.ok = false;  // there was no time to judge it
  EXPECT_EQ(as_read(run_json(run.files()))["steps"].size(), 2u);
  EXPECT_NE(
      as_read(sheet_text(run.files())).find("(`best/build.toml`); it was not judged again so.\n"),
      std::string::npos);
  EXPECT_NE(as_read(sheet_text(run.files())).find("| texture.depth | 300 nm |"), std::string::npos);
  run.result.build.reset();
  EXPECT_NEAR(std::get<HoleArray>(built_design(run.files()).texture.kind).depth, 304e-9, 1e-15);
  EXPECT_EQ(as_read(sheet_text(run.files())).find("Periods and widths that"), std::string::npos);
}

// What decides whether to build: the errors of the differences, and what is known at all.
TEST(UndrivenRun, AnAdviceNeedsAGainBeyondItsError) {
  Searched run;
  run.result.build.reset();  // of another advice
  const auto advice = [&](double friction, double variation) {
    run.result.flat = score(friction, variation, 0, 0);
    return advice_of(run.problem, run.result);
  };
  EXPECT_EQ(advice(0.0825, 0.25), Advice::Texture);
  EXPECT_EQ(advice(0.0815, 0.25), Advice::Finish);  // within 2 mN
  EXPECT_EQ(advice(0.0815, 0.263), Advice::Texture);
  EXPECT_EQ(advice(0.07, 0.261), Advice::Finish);  // within 0.012
  run.result.flat_before = score(0.0805, 0.255, 0, 0);
  EXPECT_EQ(advice(0.08, 0.25), Advice::LeaveFlat);
  run.result.flat_before = score(0.0825, 0.255, 0, 0);
  EXPECT_EQ(advice(0.08, 0.25), Advice::Finish);
  EXPECT_EQ(
      as_read(recommendation(run.files())),
      "Leave it flat and change the finish (contact angle of water 70 deg (50 deg in the study "
      "file)): that "
      "lowers mean(friction) by 2.5 ± 2 mN (better); no texture of this search adds "
      "more than the error of the "
      "difference.");
  run.result.flat_before.reset();
  run.result.finalists[0].unit[2] = run.problem.space().unit_of_study()[2];
  EXPECT_EQ(advice(0.08, 0.25), Advice::LeaveFlat);  // there is no other finish
  run.result.flat.reset();
  EXPECT_EQ(advice_of(run.problem, run.result), Advice::Unknown);
  run.result.finalists[0].feasible = false;
  EXPECT_EQ(as_read(recommendation(run.files())),
            "Build none of these: no design that was tried keeps every constraint.");
}

// "No texture gains" is said only where it is so of all: the advice is about the best design, whose
// texture changes nothing, while another of the front has 30 mN less for .05 more variation.
TEST(UndrivenRun, AFlatAdviceNamesWhatOtherTexturesGain) {
  Searched run;
  run.result.build.reset();  // of another advice
  FinalDesign other = run.result.finalists[0];
  other.folder = "front/02";
  other.unit[1] = 0.9;
  other.confirmed = score(0.05, 0.30, 0, 0);
  run.result.finalists.push_back(other);
  run.result.flat = score(0.0815, 0.25, 0, 0);
  run.result.flat_before = score(0.0845, 0.255, 0, 0);
  const std::string gained =
      " What other textures of the front change: design 02 lowers mean(friction) by 31.5 ± 2 "
      "mN (better) and raises variation(friction) by 0.050 ± 0.012 (worse).";
  EXPECT_EQ(
      as_read(recommendation(run.files())),
      "Leave it flat and change the finish (contact angle of water 70 deg (50 deg in the study "
      "file)): that "
      "lowers mean(friction) by 3 ± 2 mN (better); the texture of design 01, the best "
      "design, adds no "
      "more than the error of the difference." +
          gained);
  run.result.flat_before = score(0.0815, 0.25, 0, 0);
  EXPECT_EQ(as_read(recommendation(run.files())),
            "Leave it flat: the texture of design 01, the best design, adds no more than the error "
            "of the difference." +
                gained.substr(0, gained.size() - 1) + " against the same surface without it.");
  run.result.finalists[1].on_front = false;  // what is beaten is no alternative
  EXPECT_EQ(as_read(recommendation(run.files())),
            "Leave it flat: no texture or finish of this search gains more than the error of the "
            "difference.");
}

// What another design gains is its texture's as far as its own surface without it does not have it.
TEST(UndrivenRun, AFlatAdviceCreditsTexturesWithWhatTheirFinishDoesNot) {
  Searched run;
  run.result.build.reset();  // of another advice
  FinalDesign other = run.result.finalists[0];
  other.folder = "front/02";
  other.unit = run.problem.space().unit({3e-6, 304e-9, 40 * kPi / 180});
  other.design = run.problem.space().design(other.unit);
  other.confirmed = score(0.05, 0.30, 0, 0);
  run.result.finalists.push_back(other);
  run.result.flat = score(0.0815, 0.25, 0, 0);
  run.result.flat_before = score(0.0845, 0.255, 0, 0);
  const auto says = [&](const std::string& text) {
    const std::string lead = as_read(recommendation(run.files()));
    EXPECT_TRUE(lead.ends_with(text + ".")) << lead;
  };
  const std::string all =
      " What other designs of the front change: design 02 lowers mean(friction) by 31.5 ± 2 mN "
      "(better) and raises variation(friction) by 0.050 ± 0.012 (worse) by ";
  says(all + "texture and finish (contact angle of water 40 deg) together");
  FinalDesign flat = other;
  flat.on_front = false, flat.folder = "";
  flat.unit = run.problem.space().unit({3e-6, 0, 40 * kPi / 180});
  flat.design = run.problem.space().design(flat.unit);
  flat.confirmed = score(0.0505, 0.30, 0, 0);
  run.result.finalists.push_back(flat);
  says(all +
       "its finish (contact angle of water 40 deg), to which its texture adds no more than the "
       "error of the difference");
  run.result.finalists[2].confirmed = score(0.09, 0.30, 0, 0);
  says(
      " What other textures of the front change: design 02 lowers mean(friction) by 40 ± 2 mN "
      "(better) against the same surface without it");
}

TEST(UndrivenRun, ItsTablesHaveTheParametersAndNoModulation) {
  Searched run;
  run.study.design.title = "Holes";
  run.folder = temporary("undriven");
  std::filesystem::create_directories(run.folder);
  FinalDesign& best = run.result.finalists[0];
  best.on_front = false;  // else its folder would be written twice
  best.confirmed.oxide_margin = kInfinity;
  run.history.evaluations = {{best.unit, {true, "", {0.085, 0.26}, {}, {}}}};
  run.history.worst = {0.3};
  run.result.hypervolumes = {0.5};
  write_results(run.files());
  const std::string variables =
      ",texture.diameter [um],texture.depth [nm],"
      "surface.contact_angle [deg]";
  EXPECT_EQ(read_bytes(run.folder + "/history.csv"),
            "evaluation" + variables +
                ",mean(friction),variation(friction),worst modulation,feasible,hypervolume,status\n"
                "1,3,304,70,0.085,0.26,,yes,0.5,ok\n");
  EXPECT_EQ(read_bytes(run.folder + "/pareto.csv"),
            "design" + variables +
                ",mean(friction),mean(friction) se,mean(friction) model,mean(friction) at "
                "search level,variation(friction),variation(friction) se,variation(friction) "
                "model,variation(friction) at search level,worst modulation,breakdown "
                "margin,feasible,on front,status\n"
                "front/01,3,304,70,0.08,0.002,0.03,0.085,0.25,0.012,0.02,0.26,,,yes,no,ok\n");
  const auto titled = [&](const std::string& file) {
    return read_design(run.folder + "/best/" + file).title;
  };
  EXPECT_TRUE(titled("design.toml").starts_with("Holes; ")) << titled("design.toml");
  EXPECT_NE(titled("design.toml").find("; texture.depth 304 nm"), std::string::npos);
  EXPECT_NE(titled("build.toml").find("; texture.depth 300 nm"), std::string::npos);
  const auto metrics = nlohmann::json::parse(read_bytes(run.folder + "/best/metrics.json"));
  EXPECT_EQ(metrics["title"], titled("design.toml"));
  expect_same(
      metrics["parameters"],
      {{"status", "ok"},
       {"source", "the fit of the finger"},
       {"of_the_difference_to_flat", {{"mean(friction)", 0.005}, {"variation(friction)", 0.04}}}},
      "parameters");
  EXPECT_TRUE(metrics["worst_modulation"].is_null());
  EXPECT_TRUE(metrics["flat"]["worst_modulation"].is_null());
  EXPECT_NEAR(metrics["objectives"]["mean(friction)"]["parameters"].get<double>(), 0.03, 1e-12);
  EXPECT_NEAR(metrics["flat"]["difference"]["mean(friction)"]["value"].get<double>(), -0.02, 1e-12);
  EXPECT_EQ(metrics["stability"]["stable"], true);
  EXPECT_DOUBLE_EQ(
      std::get<HoleArray>(read_design(run.folder + "/best/build.toml").texture.kind).depth, 300e-9);
}

}  // namespace
}  // namespace papilla::tests::undriven_run_test
