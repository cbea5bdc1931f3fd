// A run in words and tables: made-up numbers, each another.
#include "report/summary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/files.h"
#include "base/folder.h"
#include "base/text.h"
#include "report/decision.h"
#include "report/grounds.h"
#include "report/limits.h"
#include "report/receipts.h"
#include "report/recommendation.h"
#include "report/remarks.h"
#include "report/results.h"
#include "report/run_json.h"
#include "report/run_numbers.h"
#include "report/sheet.h"
#include "report/stated_number.h"
#include "report/surface_changes.h"
#include "report/tables.h"
#include "report/yield.h"
#include "tests/report/same_json.h"
#include "tests/support/golden.h"
#include "tests/support/without_belief.h"
#include "tests/temporary.h"

namespace papilla::tests::summary_test {
namespace {

// Of period, diameter, depth and contact angle; more mean(modulation), less variation of it.
Study holes() {
  Study study = without_belief(read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml"));
  study.population.clear();
  study.design.accuracy.level = AccuracyLevel::Draft;
  study.search.time = 60;
  return study;
}

Score score(double mean, double variation, double worst) {
  Score s;
  s.ok = true;
  s.values = {mean, variation};
  s.errors = {0.013, 0.023};
  s.worst = worst;
  s.oxide_margin = 3;
  return s;
}

struct Searched {
  Study study;
  StudyProblem problem{study};
  JudgedDesigns history;
  OptimiseResult result;
  std::string folder, pick;

  explicit Searched(Study of = holes()) : study(std::move(of)) {
    result.method = "nsga2", result.why = "two objectives";
    result.evaluations = result.asked = 40;
    result.refused = 3, result.failures = 2;
    FinalDesign best, other;
    best.unit = problem.space().unit({5e-6, 3e-6, 300e-9, 70 * kPi / 180});
    best.design = problem.space().design(best.unit);
    best.confirmed = score(0.5, 0.3, 0.25);
    best.on_front = best.feasible = true;
    best.folder = "front/01";
    other = best;
    other.unit = problem.space().unit({8e-6, 4e-6, 500e-9, 40 * kPi / 180});
    other.design = problem.space().design(other.unit);
    other.on_front = false, other.folder = "";
    other.confirmed = score(0.45, 0.4, 0.2);
    result.finalists = {best, other};
    result.any_feasible = true;
    result.flat = score(0.4, 0.35, 0.2);
    result.flat_before = score(0.35, 0.45, 0.15);
    result.sensitivity = {{.variable = 0,
                           .change = {0.01, -0.02},
                           .share = {0.6, 0.25},
                           .step = 0.35e-6,
                           .down = {0.12e-6, Drift::End::Loss},
                           .up = {0.5e-6, Drift::End::StepTried}},
                          {.variable = 2,
                           .change = {},
                           .share = {},
                           .step = 50e-9,
                           .down = {},
                           .up = {20e-9, Drift::End::Limit, "min_wall"}}};
    result.stability.variants = {{"rough", {{0.5, 0.3}, {0.4, 0.35}}, {true, false}},
                                 {"smooth", {{0.55, 0.25}, {}}, {true, false}}};
    result.stability.times_on_front = {2, 0};
  }

  ResultFiles files() const { return {folder, study, problem, history, result, pick}; }
};

TEST(RunSummary, TheTableOfTheFinalistsIsInTheUnitsOfTheStudy) {
  const Searched run;
  EXPECT_TRUE(is_golden(result_table(run.study, run.result), "report/golden/finalists.md"));
  OptimiseResult failed = run.result;
  failed.finalists[0].feasible = failed.finalists[1].feasible = false;
  failed.finalists[1].confirmed.ok = false;
  EXPECT_TRUE(is_golden(result_table(run.study, failed), "report/golden/finalists_failed.md"));
}

TEST(RunSummary, EachPartHasItsNumbers) {
  Searched run;
  run.study.design.accuracy.target = 0.02;
  run.result.finalists[0].confirmed.reports = {
      R"({"accuracy": {"reached": 0.015, "quantity": "friction", "status": "reached"}})"};
  const std::string page = as_read(run_summary(run.files()));
  EXPECT_TRUE(is_golden(page, "report/golden/summary.md"));
  EXPECT_EQ(page.find(kNoBetter), std::string::npos);
  run.result.stability.times_on_front = {1, 2};
  run.pick = "knee";
  EXPECT_NE(as_read(run_summary(run.files())).find("\n`best/` is front/01: picked by \"knee\".\n"),
            std::string::npos);
  run.result.flat = score(0.5, 0.3, 0.2);
  EXPECT_NE(as_read(run_summary(run.files())).find(kNoBetter), std::string::npos);
}

TEST(RunSummary, WhatEndedEarlyHasNoTables) {
  Searched run;
  run.result.interrupted = true;
  run.result.evaluations = 1;
  EXPECT_EQ(as_read(run_summary(run.files())),
            "# Hole array under a grown oxide\n\nInterrupted after 1 evaluation; continue with "
            "--resume.\n");
  run.result.interrupted = false;
  run.result.refused = run.result.failures = 0;
  run.result.asked = 1;
  run.result.finalists.clear();
  EXPECT_EQ(as_read(run_summary(run.files())),
            "# Hole array under a grown oxide\n\nSearch: nsga2 (two objectives). 1 evaluation.\n\n"
            "**No design could be evaluated**: every one failed; history.csv says why for each.\n");
  OptimiseResult none;
  EXPECT_EQ(infeasible_text(none),
            "each is kept by some design that was tried, but not all by one");
  none.never_kept = {"min_hole", "min_wall"};
  EXPECT_EQ(infeasible_text(none),
            "no design of the space that was tried keeps min_hole, nor min_wall");
}

TEST(RunRemarks, EveryCutSaysWhatItLeavesUnsure) {
  Searched run;
  OptimiseResult& r = run.result;
  r.end = SearchEnd::Clock;
  r.cuts = {{RunPart::Search, 12, 40},    {RunPart::Narrow, 2, 5},    {RunPart::Confirm, 3, 9},
            {RunPart::Stability, 0, 1},   {RunPart::Flat, 0, 2},      {RunPart::Rounding, 0, 1},
            {RunPart::Sensitivity, 0, 1}, {RunPart::Parameters, 0, 1}};
  using Lines = std::vector<std::string>;
  EXPECT_EQ(run_remarks(run.study, run.problem, r),
            (Lines{"Stopped by the clock (60 s) after 12 of 40 evaluations; 2 of 5 designs judged "
                   "again before the confirmation; 3 of 9 finalists confirmed; the order under "
                   "other models not checked; the surface without texture not computed; the "
                   "rounded design not evaluated; the sensitivity not computed; the finger's "
                   "parameters not varied. Unsure: the best of 4 variables may lie where no design "
                   "was tried; a better design may have been passed over for one with lucky skins; "
                   "those left out may be as good; other choices of the model may order the "
                   "designs otherwise; whether the texture helps at all is not known; what "
                   "rounding does is not known; tolerances are not known; what they leave open is "
                   "not known."}));
  r.cuts = {{RunPart::Flat, 1, 2}};
  EXPECT_EQ(run_remarks(run.study, run.problem, r),
            (Lines{"Cut short by the clock (60 s): the study's own surface without texture not "
                   "computed. Unsure: what the finish does is not known."}));
  r.cuts = {{RunPart::Parameters, 1, 4}};
  EXPECT_EQ(run_remarks(run.study, run.problem, r),
            (Lines{"Cut short by the clock (60 s): 1 of 4 designs with the finger's parameters "
                   "varied. Unsure: what they leave open of the others is not known."}));
}

TEST(RunRemarks, ASearchThatWasEndedIsNoneThatHadNothingToTry) {
  Searched run;
  run.result.evaluations = 12;
  run.result.end = SearchEnd::Asked;
  EXPECT_EQ(run_remarks(run.study, run.problem, run.result),
            (std::vector<std::string>{"12 evaluations where 40 were asked for: the search was "
                                      "ended by request."}));
}

TEST(RunRemarks, SayWhatNeverMovedAndWhatLiesOnItsBound) {
  Searched run;
  OptimiseResult& r = run.result;
  r.evaluations = 12;
  r.end = SearchEnd::Refusals;
  r.one_value = {{3, 50 * kPi / 180}};
  r.at_bound = {{2, false, 0, true, 0, {}},
                {3, true, 80 * kPi / 180, false, 2.5 * kPi / 180, {0.031, -0.0052}},
                {1, false, 1e-6, false, 0, {}}};
  EXPECT_EQ(run_remarks(run.study, run.problem, r),
            (std::vector<std::string>{
                "12 evaluations where 40 were asked for: the limits of the shape refused ten times "
                "as many designs; loosen them or narrow the design space.",
                "surface.contact_angle took one value only, 50 deg, in 12 evaluations: what it "
                "does is not known.",
                "What is recommended has texture.depth on its lower bound, 0 nm, the last value "
                "that the model takes.",
                "What is recommended has surface.contact_angle on its upper bound, 80 deg. If the "
                "trend continues, 2.5 deg more would change mean(modulation) +0.031, "
                "variation(modulation) -0.0052.",
                "What is recommended has texture.diameter on its lower bound, 1 um: widen it to "
                "see whether more helps."}));
  r.evaluations = 40;
  r.one_value.clear(), r.at_bound.clear();
  EXPECT_TRUE(run_remarks(run.study, run.problem, r).empty());
}

TEST(BuildSheet, SaysWhatTheTextureGainsAndItsTolerances) {
  const Searched run;
  EXPECT_EQ(advice_of(run.problem, run.result), Advice::Texture);
  const std::string sheet = as_read(sheet_text(run.files()));
  EXPECT_TRUE(sheet.starts_with("\n## What to build\n\n**" + as_read(recommendation(run.files())) +
                                "**\n"));
  EXPECT_TRUE(is_golden(sheet, "report/golden/sheet.md"));
  Searched rounded;
  rounded.result.build = BuiltDesign{rounded.result.finalists[0], false};
  rounded.result.build->made.unit.front() += 1e-3;
  rounded.result.build->made.confirmed = score(0.49, 0.31, 0.24);
  EXPECT_NE(as_read(recommendation(rounded.files()))
                .find("over fingers and humidity is 0.240; without texture it is 0.200. Its "
                      "texture raises mean(modulation) by 0.090 ± 0.013 (better)"),
            std::string::npos)
      << as_read(recommendation(rounded.files()));
  EXPECT_NE(as_read(run_summary(rounded.files()))
                .find("| best design, rounded to the grid of the fab | 0.490 ± "),
            std::string::npos);
  Searched costly;
  costly.result.flat = score(0.4, 0.2, 0.2);  // 0.1 more variation with the texture
  EXPECT_NE(as_read(recommendation(costly.files()))
                .find("Its texture raises mean(modulation) by 0.100 ± 0.013 (better) and raises "
                      "variation(modulation) by 0.100 ± 0.023 (worse)."),
            std::string::npos)
      << as_read(recommendation(costly.files()));
  costly.result.flat = score(0.49, 0.29, 0.2);  // the texture gains 0.010, within its error
  EXPECT_EQ(
      as_read(recommendation(costly.files())),
      "Leave it flat and change the finish (contact angle of water 70 deg (50 deg in the study "
      "file)): that "
      "raises mean(modulation) by 0.140 ± 0.013 (better) and lowers variation(modulation) by "
      "0.160 ± 0.023 (better); no "
      "texture of this search adds more than the error of the difference.");
  costly.result.flat.reset();
  EXPECT_EQ(advice_of(costly.problem, costly.result), Advice::Unknown);
  EXPECT_NE(as_read(recommendation(costly.files()))
                .find("is not known: the surface without it was not computed in the time. What "
                      "follows is of design 01, the best of the front."),
            std::string::npos)
      << as_read(recommendation(costly.files()));
  costly.result.build = BuiltDesign{costly.result.finalists[0], true, false};
  EXPECT_NE(as_read(recommendation(costly.files())).find("off the grid of the fab"),
            std::string::npos)
      << as_read(recommendation(costly.files()));
  costly.result.build.reset();
  // Asked, and without an answer: the texture is worth building where there is no equilibrium.
  Score& unanswered = costly.result.flat_unanswered.emplace();
  unanswered.kind = TaskStatus::Kind::TimedOut;
  unanswered.reason = "smooth: took longer than 600 s and was ended";
  EXPECT_EQ(advice_of(costly.problem, costly.result), Advice::Unknown);
  EXPECT_NE(as_read(recommendation(costly.files()))
                .find("the surface without it has no number (smooth: took longer than 600 s"),
            std::string::npos);
  unanswered.kind = TaskStatus::Kind::NoEquilibrium;
  unanswered.reason = "smooth, 75 % RH: pull-in: no equilibrium short of a closed gap";
  EXPECT_EQ(advice_of(costly.problem, costly.result), Advice::Texture);
  const std::string lead = as_read(recommendation(costly.files()));
  EXPECT_TRUE(lead.starts_with("Build design 01 (")) << lead;
  EXPECT_NE(lead.find("The same surface without texture has no number to compare with (smooth, 75 "
                      "% RH: pull-in: no equilibrium short of a closed gap)."),
            std::string::npos)
      << lead;
  unanswered.kind = TaskStatus::Kind::NotDefined;  // a film that breaks down below that voltage
  EXPECT_EQ(advice_of(costly.problem, costly.result), Advice::Texture);
  costly.result.finalists[0].feasible = false;
  EXPECT_EQ(advice_of(costly.problem, costly.result), Advice::Nothing);
}

// However small beside its three decimals, a gain beyond its error is said.
TEST(BuildSheet, SaysASmallGainThatIsBeyondItsError) {
  Searched run;
  Score small = score(0.5004, 0.3, 0.25);
  small.errors = {1e-4, 0.023};
  run.result.finalists[0].confirmed = small;
  small.values[0] = 0.5;
  run.result.flat = small;
  EXPECT_NE(as_read(recommendation(run.files()))
                .find("Its texture raises mean(modulation) by 0.0004 ± 0.0001 (better)."),
            std::string::npos)
      << as_read(recommendation(run.files()));
}

TEST(ScoreChanges, AreThoseThatInstrumentsResolve) {
  Study study = holes();
  study.objective = {};
  study.objective.minimise = {parse_metric("contact_area"), parse_metric("colour_shift")};
  const Searched run(study);
  Score design = score(0.0160, 0.0021, 0.25), other = score(0.0164, 1.8e-7, 0.25);
  design.errors = other.errors = {1e-4, 0};
  const auto changes = [&] {
    return as_read(score_changes(run.files(), {"this", "that"}, design, other));
  };
  EXPECT_EQ(changes(),
            "lowers mean(contact_area) by 0.040 ± 0.010 % (better) and raises mean(colour_shift) "
            "by 0.0021 (worse)");
  design.values[1] = 1.6e-4;  // colour_shift is resolved to 0.001
  EXPECT_EQ(changes(), "lowers mean(contact_area) by 0.040 ± 0.010 % (better)");
}

// Where no texture of the study has depth 0 the flat surface is none of the finalists: what was
// checked of its texture is not said of it.
TEST(BuildSheet, ChecksOfATextureAreNotThoseOfTheSurfaceWithoutIt) {
  Study study = holes();
  for (Variable& v : study.variables) {
    if (v.path == "texture.depth") v.low = 100e-9;
  }
  Searched run(study);
  run.result.flat = score(0.49, 0.29, 0.2);
  ASSERT_EQ(advice_of(run.problem, run.result), Advice::Finish);
  EXPECT_EQ(recommended_place(run.files()), std::nullopt);
}

// Without a number that was searched there is neither a table of tolerances nor what they mean.
TEST(BuildSheet, OfAFlatSurfaceWithoutNumbersHasNoTolerances) {
  Study study = holes();
  study.variables.back().path = "texture.wall_angle";  // in place of the contact angle
  Searched run(study);
  EXPECT_NE(as_read(sheet_text(run.files())).find("Tolerance: "), std::string::npos);
  run.result.flat = run.result.flat_before = score(0.49, 0.29, 0.2);
  ASSERT_TRUE(sheet_rows(run.files()).empty());
  const std::string sheet = as_read(sheet_text(run.files()));
  for (const char* words : {"| dimension |", "Tolerance: "})
    EXPECT_EQ(sheet.find(words), std::string::npos) << words << " in " << sheet;
  EXPECT_NE(sheet.find("\n\n| limit |"), std::string::npos) << sheet;
}

// Lead, dimensions and JSON are of one surface: that without a texture.
TEST(BuildSheet, OfAFlatSurfaceIsFlatEverywhere) {
  Searched run;
  run.result.flat = score(0.49, 0.29, 0.2);
  ASSERT_EQ(advice_of(run.problem, run.result), Advice::Finish);
  EXPECT_FALSE(facts(built_design(run.files()).texture).relief.present);
  EXPECT_FALSE(facts(recommended_design(run.problem, run.result).design.texture).relief.present);
  const std::string sheet = as_read(sheet_text(run.files()));
  EXPECT_EQ(sheet.find("| texture."), std::string::npos) << sheet;
  EXPECT_NE(sheet.find("| surface.contact_angle | 70 deg |"), std::string::npos) << sheet;
  const auto json = as_read(run_json(run.files()));
  EXPECT_EQ(json["textured"], false);
  EXPECT_TRUE(json["design"].is_null());
  std::vector<std::string> beside;
  for (const auto& row : json["compared"]["rows"]) beside.push_back(row["surface"]);
  EXPECT_EQ(beside, (std::vector<std::string>{"without texture, recommended",
                                              "flat, finish and drive of the study",
                                              "design 01, with its texture"}));
  for (const auto& row : json["sheet"])
    EXPECT_EQ(row["name"].get<std::string>().find("texture."), std::string::npos);
  EXPECT_NE(
      as_read(run_summary(run.files())).find("`best/` is the flat surface that is recommended."),
      std::string::npos);
  run.folder = temporary("flat_run");
  std::filesystem::create_directories(run.folder);
  run.result.finalists[0].confirmed.reports = {R"({"a": 1})"};
  run.result.flat->reports = run.result.flat_before->reports = {R"({"b": 2})"};
  run.result.finalists[0].on_front = false;  // its folder is another test's
  write_results(run.files());
  for (const char* file : {"design.toml", "build.toml"}) {
    EXPECT_FALSE(facts(read_design(run.folder + "/best/" + file).texture).relief.present) << file;
  }
  EXPECT_FALSE(std::filesystem::exists(run.folder + "/best/mask.tif"));
  EXPECT_EQ(
      nlohmann::json::parse(read_bytes(run.folder + "/best/metrics.json"))["variables"].size(), 1u);
}

// Flat designs alone were confirmed: what is known of textures is what became of them.
TEST(BuildSheet, OfTexturesWithoutConfirmedNumbersSaysWhyNothingIsKnown) {
  Searched run;
  const auto unit = [&](double period, double diameter, double depth, double angle) {
    return run.problem.space().unit({period, diameter, depth, angle * kPi / 180});
  };
  FinalDesign& best = run.result.finalists[0];
  const FinalDesign texture = run.result.finalists[1];
  run.result.finalists.pop_back();
  run.result.stability = {};
  best.unit = unit(5e-6, 3e-6, 0, 70);
  best.design = run.problem.space().design(best.unit);
  run.result.flat = best.confirmed;
  ASSERT_EQ(advice_of(run.problem, run.result), Advice::Finish);
  const auto says = [&](const std::string& text) {
    const std::string lead = as_read(recommendation(run.files()));
    EXPECT_NE(lead.find("(better); " + text + "."), std::string::npos) << lead;
    EXPECT_EQ(lead.find("adds more than"), std::string::npos) << lead;
  };
  says("no texture was tried, so what one would gain is not known");
  // Walls of 300 and 350 nm, the first beside a depth of 350 nm.
  for (const Point& thin : {unit(5e-6, 4.7e-6, 350e-9, 50), unit(5e-6, 4.65e-6, 100e-9, 50)}) {
    search::Judgement refused;
    refused.outcome.constraints =
        run.problem.constraints().before_evaluation(run.problem.space().design(thin));
    run.history.add(thin, refused);
  }
  const std::string none = "no texture was evaluated, so what one would gain is not known (of ",
                    two =
                        "2 break a limit: min_wall at least 0.4 um by 2, aspect_ratio at most 1 "
                        "by 1";
  says(none + "2 that were tried " + two + ")");
  search::Judgement pulled_in;
  pulled_in.outcome.reason = "smooth: pull-in";
  run.history.add(unit(5e-6, 3e-6, 350e-9, 50), pulled_in);
  says(none + "3 that were tried " + two + "; 1 has no answer: smooth: pull-in)");
  search::Judgement impossible;
  impossible.outcome.constraints = {1, -1, 1, -1, -1};
  impossible.outcome.reason = "walls meet";
  run.history.add(unit(5e-6, 3e-6, 350e-9, 60), impossible);
  run.history.add(unit(5e-6, 3e-6, 350e-9, 65), impossible);
  says(none + "5 that were tried " + two +
       "; 2 cannot be made or judged, the first: walls meet; 1 has no answer: smooth: pull-in)");
  search::Judgement evaluated;
  evaluated.outcome.ok = true;
  evaluated.outcome.objectives = {-0.4, 0.3};
  run.history.add(texture.unit, evaluated);
  run.history.add(best.unit, evaluated);  // flat
  says(
      "no texture has confirmed numbers (1 of the 1 that were evaluated in the search keeps every "
      "limit at its coarser level), so what one would gain is not known at the accuracy of the "
      "study");
  const std::string page = as_read(run_summary(run.files()));
  EXPECT_NE(page.find("\n## What the finish does\n"), std::string::npos) << page;
  EXPECT_EQ(page.find("made by the texture"), std::string::npos) << page;
  run.result.finalists.push_back(texture);
  run.result.finalists[1].feasible = false;
  run.result.finalists[1].confirmed.oxide_margin = 1.5;
  const std::string broken =
      "none of the textures that were confirmed (1) keeps every limit, broken: "
      "oxide_breakdown_margin at least 2 by 1";
  says(broken);
  run.result.flat_before = run.result.flat;
  EXPECT_EQ(as_read(recommendation(run.files())),
            "Leave it flat: " + broken +
                "; the finish of the best adds no more than the error of the difference.");
  run.result.finalists[1].feasible = true;
  EXPECT_EQ(as_read(recommendation(run.files())),
            "Leave it flat: no texture or finish of this search gains more than the error of the "
            "difference.");
}

// The surface without the texture was not compared: what the run knows of it otherwise.
TEST(BuildSheet, SaysWhatIsKnownOfASurfaceThatWasNotCompared) {
  Searched run;
  run.result.flat.reset();
  run.result.finalists[0].searched = score(0.52, 0.31, 0);
  ASSERT_EQ(advice_of(run.problem, run.result), Advice::Unknown);
  const auto says = [&](const std::string& text) {
    const std::string lead = as_read(recommendation(run.files()));
    EXPECT_NE(lead.find("the surface without it was not computed in the time" + text +
                        ". What follows is of"),
              std::string::npos)
        << lead;
  };
  const auto flat = [&](double angle) {
    return run.problem.space().unit({5e-6, 3e-6, 0, angle * kPi / 180});
  };
  search::Judgement evaluated;
  evaluated.outcome.ok = true;
  evaluated.outcome.objectives = {-0.39, 0.36};
  run.history.add(run.result.finalists[0].unit, evaluated);
  says("");
  run.history.add(flat(40), evaluated);
  says(" (the flat surfaces of the search have another finish or drive)");
  run.history.add(flat(70), evaluated);
  says(
      ", though at the coarser level of the search it has mean(modulation) 0.390 where design 01 "
      "has 0.520, variation(modulation) 0.360 where that has 0.310");
  FinalDesign& confirmed = run.result.finalists[1];
  confirmed.unit = flat(70);
  confirmed.design = run.problem.space().design(confirmed.unit);
  says(
      ", though as a design of its own, not on the skins of the other, it has mean(modulation) "
      "0.450 ± 0.013 where design 01 has 0.500 ± 0.013, variation(modulation) 0.400 ± 0.023 where "
      "that has 0.300 ± 0.023");
}

// A recommendation whose place does not hold names where, and what holds instead.
TEST(BuildSheet, SaysWhyAPlaceDoesNotHoldAndTheAlternative) {
  Searched run;
  FinalDesign& other = run.result.finalists[1];
  other.feasible = other.on_front = true, other.folder = "front/02";
  run.result.stability.variants[1].on_front = {false, true};
  run.result.stability.variants[1].beaten_by = {1, std::nullopt};
  run.result.stability.times_on_front = {1, 2};
  EXPECT_NE(as_read(recommendation(run.files()))
                .find(" Its place holds in 1 of 2 checks only (smooth: design 02 is better). The "
                      "alternative that holds in 2 of 2 is design 02 (holes 4 um wide at the top, "
                      "500 nm deep, "
                      "8 um from one to the next in a square array, walls 88 deg steep)."),
            std::string::npos)
      << as_read(recommendation(run.files()));
  // Checks that it loses for one reason are told together, the first three by name.
  for (const char* name : {"moist", "rough", "a quarter of the droplets", "one pass"}) {
    run.result.stability.variants.push_back(run.result.stability.variants[1]);
    run.result.stability.variants.back().name = name;
  }
  EXPECT_NE(as_read(recommendation(run.files()))
                .find(" Its place holds in 1 of 6 checks only (smooth, moist, rough and 2 more: "
                      "design 02 is better)."),
            std::string::npos)
      << as_read(recommendation(run.files()));
}

// Where the worst modulation decides, what it costs in the other objectives is said.
TEST(BuildSheet, NamesTheDesignThatAllObjectivesAlikeWouldChoose) {
  Searched run;
  FinalDesign other = run.result.finalists[0];
  other.folder = "front/02";
  other.confirmed.values = {0.48, 0.1}, other.confirmed.worst = 0.2;
  run.result.finalists[1] = other;
  const auto said = [&] { return as_read(join_names(grounds(run.files()), "\n")); };
  const std::string sentence =
      "By the rule \"knee\", which weighs all objectives alike, design 02 would be built: "
      "mean(modulation) 0.480 in place of 0.500, variation(modulation) 0.100 in place of 0.300, a "
      "worst modulation of 0.200 in place of 0.250.";
  EXPECT_NE(said().find(sentence), std::string::npos) << said();
  // The lead has other numbers of what is built: these are of both before rounding.
  run.result.build = BuiltDesign{run.result.finalists[0], false};
  run.result.build->made.unit.front() += 1e-3;
  run.result.build->made.confirmed = score(0.49, 0.31, 0.24);
  EXPECT_NE(said().find("in place of 0.250 (both before rounding to the grid of the fab)."),
            std::string::npos)
      << said();
  run.result.build.reset();
  run.pick = "knee";
  EXPECT_EQ(said().find("By the rule"), std::string::npos);
  run.pick.clear();
  run.result.finalists[1].confirmed.values = {0.4, 0.3};
  EXPECT_EQ(said().find("By the rule"), std::string::npos);
}

// Which finger, what its natural skin does, what no ± holds, and a worst case that nobody feels.
TEST(BuildSheet, SaysWhatItRestsOn) {
  Searched run;
  Stability& s = run.result.stability;
  s.variants = {{"finger one", {{0.5, 0.3}, {0.4, 0.35}}},
                {"natural skin, not degreased", {{0.296, 0.627}, {0.2, 0.5}}},
                {"air breaks down", {{0.252, 0.2}, {0.2, 0.3}}},
                {"equilibrium", {{0.922, 0.4}, {0.8, 0.5}}}};
  for (StabilityVariant& v : s.variants) v.on_front = {true, true}, v.worst = {0.25, 0.2};
  s.variants[1].worst = {0.007, 0.1};
  s.times_on_front = {4, 4};
  s.other_skin = 1, s.first_choice = 2;
  run.result.finalists[0].confirmed.worst = 0.053;
  const std::vector<std::string> said = grounds(run.files());
  ASSERT_GE(said.size(), 5u);
  EXPECT_EQ(as_read(said[0]),
            "Film: 500 nm of SiO2, grown equally thick on every wall (conformal).");
  EXPECT_EQ(
      as_read(said[1]),
      "Judged for degreased fingers (finger.state = \"clean\") at 15 to 75 % relative "
      "humidity under 0.2 N, driven with 200 V (peak) at 5 kHz. On natural skin, not degreased, "
      "with finger \"" +
          run.problem.tasks().front().name +
          "\" alone and at the coarser level of the checks (64 pixels, 8 skins), it has "
          "mean(modulation) 0.296 in place of 0.500, variation(modulation) 0.627 in place of "
          "0.300, a worst modulation of 0.007 in place of 0.250.");
  const auto on_natural_skin = [&](const std::string& others) {
    const std::string lead = as_read(recommendation(run.files()));
    EXPECT_NE(lead.find(" But on natural skin, not degreased (finger \"reference\" alone, at the "
                        "coarser level of the checks) its worst modulation is 0.007, which people "
                        "do not notice, " +
                        others + "."),
              std::string::npos)
        << lead;
  };
  on_natural_skin("nor do they that of any other design here");
  s.variants[1].worst[1] = 0.25;
  on_natural_skin("a dominated design has 0.250 there");
  EXPECT_EQ(as_read(said[2]),
            "In no ±: choices of the model (2 of them, on finger \"reference\" at the coarser "
            "level of the checks; the table \"Does the order hold?\" has each): over these it has "
            "mean(modulation) 0.252 to 0.922, "
            "variation(modulation) 0.200 to 0.400.");
  EXPECT_EQ(as_read(said[3]),
            "The limits leave these tolerances, one dimension at a time: depth at most 20 nm up "
            "(min_wall at least 0.4 um).");
  EXPECT_EQ(as_read(said[4]),
            "At its worst, over fingers and humidity, the modulation is 0.053: below 0.2, the "
            "least relative difference of friction that people notice (Fehlberg 2022), it is not "
            "felt there.");
  run.result.confirmed_with.grid = 64, run.result.confirmed_with.skins = 8;
  EXPECT_NE(as_read(grounds(run.files())[1])
                .find("alone and at the level of the checks (64 pixels, 8 skins), it has"),
            std::string::npos);
  s.variants[1].values[0].clear();
  s.variants[1].unanswered = {"reference, 75 % RH: pull-in: no equilibrium", ""};
  EXPECT_NE(
      as_read(grounds(run.files())[1])
          .find("On natural skin, not degreased it has no value (reference, 75 % RH: pull-in: "
                "no equilibrium)."),
      std::string::npos);
}

// A layer may be made otherwise than the surface says.
TEST(BuildSheet, NamesThePenThatItIsJudgedFor) {
  Study study = holes();
  Pin& pen = study.design.counterface.pen;
  pen.name = "POM tip";
  pen.load = 1, pen.modulus = 3e9, pen.radius = 0.7e-3, pen.shear_strength = 30e6;
  const auto said = [&] { return as_read(join_names(grounds(Searched(study).files()), "\n")); };
  EXPECT_EQ(said().find("POM"), std::string::npos) << said();  // no objective is of it
  study.objective.minimise = {parse_metric("mean(pen.friction)")};
  EXPECT_NE(said().find("under 0.2 N, driven with 200 V (peak) at 5 kHz, and for the pen \"POM "
                        "tip\" under 1 N."),
            std::string::npos)
      << said();
}

TEST(BuildSheet, TellsHowEachLayerIsMade) {
  Searched run;
  Surface& surface = run.result.finalists[0].design.surface;
  const auto film = [&] { return as_read(grounds(run.files()).front()); };
  surface.process = FilmProcess::Planar;
  surface.dielectric[0].process = LayerProcess::Conformal;
  EXPECT_EQ(film(), "Film: 500 nm of SiO2, grown equally thick on every wall (conformal).");
  surface.process = FilmProcess::Conformal;
  surface.dielectric[0].process = LayerProcess::Planar;
  EXPECT_EQ(film(),
            "Film: 500 nm of SiO2 are laid, 300 nm are taken away where the texture is deep, 200 "
            "nm remain there.");
  surface.dielectric.push_back(surface.dielectric[0]);
  surface.dielectric[1].process = LayerProcess::Directional;
  surface.dielectric[1].material = "HfO2", surface.dielectric[1].thickness = 20e-9;
  EXPECT_EQ(film(),
            "Film: 500 nm of SiO2, on a flat electrode, with the texture cut into it (planar); 20 "
            "nm of HfO2, laid from above, thin on steep walls (directional).");
}

// A voltage that is found is what is built; a modulation at the amplitude of the study says nothing
// of it.
TEST(BuildSheet, OfAVoltageThatIsFoundNamesIt) {
  Study study = holes();
  study.objective = {};
  study.objective.minimise = {parse_metric("worst(voltage_for(modulation = 0.3))")};
  Searched run(study);
  const auto volts = [](double voltage) {
    Score s = score(0, 0, 0.007);
    s.values = {voltage}, s.errors = {2};
    return s;
  };
  run.result.finalists[0].confirmed = volts(147.5), run.result.finalists[1].confirmed = volts(170);
  run.result.flat = volts(160), run.result.flat_before = volts(165);
  run.result.sensitivity.clear();
  const std::string lead = as_read(recommendation(run.files()));
  EXPECT_TRUE(lead.starts_with("Build design 01")) << lead;
  EXPECT_EQ(lead.find("modulation is"), std::string::npos) << lead;
  EXPECT_EQ(lead.find("worst modulation"), std::string::npos) << lead;
  const std::string said = as_read(join_names(grounds(run.files()), "\n")),
                    drive =
                        "the voltage that is asked for (worst(voltage_for(modulation = 0.3)) 147.5 "
                        "± 2 V) at 5 kHz";
  EXPECT_NE(said.find("under 0.2 N, driven with " + drive + "."), std::string::npos) << said;
  EXPECT_EQ(said.find("not felt"), std::string::npos) << said;
  const auto json = as_read(run_json(run.files()));
  EXPECT_EQ(json["beside"].back()["text"], drive);
  EXPECT_EQ(json["compared"]["names"].size(), 1u);
  EXPECT_EQ(json["compared"]["rows"][0]["values"].size(), 1u);
  run.result.stability = {};
  const std::string page = as_read(run_summary(run.files()));
  EXPECT_EQ(page.find("worst modulation"), std::string::npos) << page;
  EXPECT_NE(page.find("`best/` is front/01: the best in worst(voltage_for(modulation = 0.3)).\n"),
            std::string::npos)
      << page;
  // Nor do the tables have it.
  run.folder = temporary("voltage");
  std::filesystem::create_directories(run.folder);
  for (FinalDesign& d : run.result.finalists) d.on_front = false;
  run.result.finalists[0].confirmed.ok = false;  // no folder to write
  run.history.evaluations = {{run.result.finalists[1].unit, {true, "", {170}, {-1}, {}}}};
  run.history.worst = {0.26};
  run.result.hypervolumes = {0.125};
  run.result.interrupted = true;
  write_results(run.files());
  const Folder folder(run.folder);
  using Texts = std::vector<std::string>;
  EXPECT_EQ(read_csv(folder, "history.csv").texts("worst modulation"), Texts{""});
  EXPECT_EQ(read_csv(folder, "pareto.csv").texts("worst modulation"), (Texts{"", ""}));
}

// Beside another wish it is weighed against that, not against a modulation that nobody asked for.
TEST(BuildSheet, OfAVoltageThatIsFoundAndAnotherWishIsTheKnee) {
  Study study = holes();
  study.objective = {};
  study.objective.minimise = {parse_metric("worst(voltage_for(modulation = 0.3))"),
                              parse_metric("mean(friction)")};
  Searched run(study);
  const auto asked = [](double voltage, double friction) {
    Score s = score(voltage, friction, 0.007);
    s.errors = {2, 0.001};
    return s;
  };
  run.result.finalists[0].confirmed = asked(147.5, 0.05);
  run.result.finalists[1].confirmed = asked(170, 0.06);
  run.result.flat = asked(160, 0.07), run.result.flat_before = asked(165, 0.08);
  run.result.sensitivity.clear();
  run.result.stability = {};
  const std::string page = as_read(run_summary(run.files()));
  EXPECT_NE(page.find("`best/` is front/01: the knee of the front: the least sum of its scaled "
                      "objectives.\n"),
            std::string::npos)
      << page;
  EXPECT_EQ(page.find("worst modulation"), std::string::npos) << page;
}

// Scenarios may fix humidity and drive.
TEST(BuildSheet, IsJudgedInTheAirAndUnderTheDriveOfItsScenarios) {
  Study study = holes();
  study.scenarios = {{"dry", 1, {{"drive.amplitude", 150}}},
                     {"damp", 1, {{"environment.relative_humidity.2", 0.85}}}};
  Searched run(study);
  std::string said = as_read(join_names(grounds(run.files()), "\n"));
  EXPECT_NE(said.find(" at 15 to 85 % relative humidity under 0.2 N, driven with 150 V (peak) at 5 "
                      "kHz and 200 V (peak) at 5 kHz."),
            std::string::npos)
      << said;
  EXPECT_EQ(as_read(run_json(run.files()))["beside"].back()["text"],
            "150 V (peak) at 5 kHz and 200 V (peak) at 5 kHz");
  study.scenarios = {{"off", 1, {{"drive.amplitude", 0}}}, {"on", 1, {}}};
  study.objective = {};
  study.objective.minimise = {parse_metric("mean(friction)"), parse_metric("variation(friction)")};
  const Searched off(study);
  said = as_read(join_names(grounds(off.files()), "\n"));
  EXPECT_NE(said.find("driven with no voltage and 200 V (peak) at 5 kHz."), std::string::npos)
      << said;
}

TEST(BuildSheet, ADirectVoltageHasNoFrequency) {
  Searched run;
  run.result.finalists[0].design.drive.waveform = Waveform::Dc;
  EXPECT_NE(as_read(join_names(grounds(run.files()), "\n"))
                .find("under 0.2 N, driven with 200 V, a direct voltage."),
            std::string::npos);
  EXPECT_EQ(as_read(run_json(run.files()))["beside"].back()["text"], "200 V, a direct voltage");
}

// A flat surface that is recommended for the best design is a finalist of its own here: what was
// tried on that was tried on it.
TEST(BuildSheet, OfAFlatSurfaceHasTheChecksOfTheFinalistThatItIs) {
  Searched run;
  run.result.flat = score(0.49, 0.29, 0.2);
  run.result.stability.first_choice = 1;
  const auto said = [&] { return as_read(join_names(grounds(run.files()), "\n")); };
  EXPECT_NE(said().find("which were not tried on it"), std::string::npos) << said();
  EXPECT_TRUE(as_read(run_json(run.files()))["stable"].is_null());
  FinalDesign& flat = run.result.finalists[1];
  flat.unit = *run.problem.space().flattened(run.result.finalists[0].unit);
  flat.design = run.problem.space().design(flat.unit);
  run.result.stability.variants[1].values[1] = {0.45, 0.28};
  EXPECT_EQ(said().find("which were not tried on it"), std::string::npos) << said();
  EXPECT_NE(said().find("mean(modulation) 0.450 to 0.450"), std::string::npos) << said();
  EXPECT_EQ(as_read(run_json(run.files()))["stable"], false);
}

// A flat surface is worth no more than a texture where nobody feels it.
TEST(BuildSheet, SaysOfAFlatSurfaceTooThatNobodyFeelsItOnNaturalSkin) {
  Searched run;
  run.result.flat = score(0.49, 0.29, 0.2);
  FinalDesign& flat = run.result.finalists[1];
  flat.unit = *run.problem.space().flattened(run.result.finalists[0].unit);
  flat.design = run.problem.space().design(flat.unit);
  Stability& s = run.result.stability;
  s.variants[1].values[1] = {0.45, 0.28};
  s.variants[0].worst = {0.3, 0.3}, s.variants[1].worst = {0.3, 0.05};
  s.other_skin = 1;
  const std::string lead = as_read(recommendation(run.files()));
  EXPECT_TRUE(lead.starts_with("Leave it flat")) << lead;
  EXPECT_NE(lead.find("its worst modulation is 0.050, which people do not notice, design 01 has "
                      "0.300 there."),
            std::string::npos)
      << lead;
}

// Without a limit on the film a design may hold by the field that was solved and not under a
// bridge.
TEST(BuildSheet, SaysThatAFilmIsAtRisk) {
  Study study = holes();
  study.constraints.clear();
  Searched run(study);
  run.result.finalists[0].confirmed.oxide_margin = 1;
  const auto said = [&] { return as_read(join_names(grounds(run.files()), "\n")); };
  EXPECT_EQ(said().find("oxide_breakdown_margin"), std::string::npos) << said();
  run.result.finalists[0].confirmed.oxide_margin = 0.75;
  EXPECT_NE(said().find("\nIts oxide_breakdown_margin is 0.75: below 1, a bridge or a contact on "
                        "the thinnest place of its film breaks it down. `oxide_breakdown_margin = "
                        "1` in [constraints] asks for designs that hold."),
            std::string::npos)
      << said();
}

TEST(BuildSheet, OfADesignThatBreaksItsLimitsSaysNothingOfWhatTheyLeave) {
  Searched run;
  const auto said = [&] { return as_read(join_names(grounds(run.files()), "\n")); };
  EXPECT_NE(said().find("The limits leave"), std::string::npos) << said();
  run.result.finalists[0].feasible = run.result.any_feasible = false;
  EXPECT_EQ(said().find("The limits leave"), std::string::npos) << said();
}

TEST(BuildSheet, TheStateThatWasNotTriedIsNotTheOneThatWas) {
  Study study = holes();
  study.design.finger.state = FingerState::Natural;
  const Searched run(study);
  const std::string said = as_read(join_names(grounds(run.files()), "\n"));
  EXPECT_NE(said.find("Judged for natural fingers, not degreased at "), std::string::npos) << said;
  EXPECT_NE(said.find("Another state of the skin (degreased) was not tried on it."),
            std::string::npos)
      << said;
}

double kind_of(const char* name) {
  const auto& kinds = texture_kinds();
  return static_cast<double>(std::find(kinds.begin(), kinds.end(), name) - kinds.begin());
}

// Holes and pillars that have a height of their own beside the depth of the holes.
Study holes_or_pillars() {
  Study study = holes();
  const double hole = kind_of("hole_array"), pillar = kind_of("pillar_array");
  study.variables.push_back({"texture.height", "nm", 100e-9, 900e-9, {}});
  study.variables.push_back(
      {"texture.type", "", std::min(hole, pillar), std::max(hole, pillar), {hole, pillar}});
  return study;
}

TEST(BuildSheet, LeavesOutTheNumbersOfAnotherKind) {
  const Study study = holes_or_pillars();
  const StudyProblem problem(study);
  const Searched like;
  OptimiseResult result = like.result;
  FinalDesign& pillars = result.finalists[0];
  pillars.unit =
      problem.space().unit({5e-6, 3e-6, 300e-9, 70 * kPi / 180, 546e-9, kind_of("pillar_array")});
  pillars.design = problem.space().design(pillars.unit);
  ASSERT_EQ(texture_name(pillars.design.texture), "pillar_array");
  result.finalists = {pillars};
  result.sensitivity = {{.variable = 4,
                         .change = {},
                         .share = {},
                         .step = 40e-9,
                         .down = {30e-9, Drift::End::Loss},
                         .up = {20e-9, Drift::End::Loss}}};
  const std::string table = result_table(study, result);
  EXPECT_NE(table.find("| front/01 | 5 um | 3 um |  | 70 deg | 546 nm | pillar_array |"),
            std::string::npos)
      << table;
  const std::vector<SheetRow> rows =
      sheet_rows({like.folder, study, problem, like.history, result, like.pick});
  const auto height = std::find_if(
      rows.begin(), rows.end(), [](const SheetRow& row) { return row.path == "texture.height"; });
  ASSERT_NE(height, rows.end());
  EXPECT_NEAR(height->value, 546e-9, 1e-15);
  ASSERT_TRUE(height->down);
  EXPECT_EQ(height->down->most, 30e-9);
}

TEST(YieldText, AnErrorThatPassesAnEndIsTheRangeThatItLeaves) {
  EXPECT_EQ(share_text(0.121, 0.004), "12.1 ± 0.4 %");
  EXPECT_EQ(share_text(1, 0.396), "60.4 to 100 %");
  EXPECT_EQ(share_text(0.003, 0.02), "0 to 2.3 %");
  EXPECT_EQ(share_text(0.4, 0.7), "0 to 100 %");
  // What is shown as nothing passes no end.
  EXPECT_EQ(share_text(1, 0.0001), "100.0 ± 0.0 %");
  EXPECT_EQ(share_text(0, 0), "0.0 ± 0.0 %");
  Searched run;
  run.result.yield.emplace().now = {1, 0.396};
  EXPECT_EQ(as_read(yield_sentence(run.files())),
            " Of the plates that scatter as stated 60.4 to 100 % keep every limit.");
  EXPECT_TRUE(
      as_read(yield_text(run.files())).starts_with("Yield: 60.4 to 100 % of the plates keep"));
  run.result.yield->now = {0.9, 0.01};
  EXPECT_EQ(as_read(yield_sentence(run.files())),
            " Of the plates that scatter as stated 90.0 ± 1.0 % keep every limit.");
  EXPECT_EQ(yield_json(run.files())["se"], 0.01);
}

TEST(YieldText, AToleranceOfACompetingKindHasItsUnit) {
  Study study = holes_or_pillars();
  study.variables.erase(study.variables.end() - 2);
  study.scatter = {{"texture.height", 20e-9}};
  EXPECT_EQ(tolerance_text(study, 0), "± 20 nm");
}

// Each step is from the one before it.
TEST(RunSteps, RoundTheSurfaceThatIsRecommended) {
  Searched run;
  run.result.flat = score(0.5, 0.3, 0.25);
  ASSERT_EQ(advice_of(run.problem, run.result), Advice::Finish);
  run.result.build = BuiltDesign{run.result.finalists[0], false};
  run.result.build->made.unit.front() += 1e-3;
  run.result.build->made.design.texture = Texture{};
  run.result.build->made.confirmed = score(0.49, 0.31, 0.24);
  std::vector<std::string> surfaces;
  const auto json = as_read(run_json(run.files()));
  for (const auto& step : json["steps"]) surfaces.push_back(step["surface"].get<std::string>());
  EXPECT_EQ(surfaces, (std::vector<std::string>{"flat, finish and drive of the study",
                                                "flat, finish and drive of the best",
                                                "flat, on the grid of the fab"}));
}

// The best flat surface of a run stands beside the texture, not only that under the texture's film.
TEST(BuildSheet, ComparesWithTheBestFlatSurfaceOfTheRunToo) {
  Searched run;
  FinalDesign& flat = run.result.finalists[1];
  flat.unit = run.problem.space().unit({5e-6, 3e-6, 0, 40 * kPi / 180});
  flat.design = run.problem.space().design(flat.unit);
  flat.confirmed = score(0.724, 0.9, 0.1);
  flat.feasible = flat.on_front = true, flat.folder = "front/02";
  EXPECT_NE(
      as_read(recommendation(run.files()))
          .find("Against the best flat surface of this run, design 02 (contact angle of water "
                "40 deg), it lowers variation(modulation) by 0.600 ± 0.023 (better) and lowers "
                "mean(modulation) by 0.224 ± 0.013 (worse)."),
      std::string::npos)
      << as_read(recommendation(run.files()));
  // A flat surface has no dimensions.
  EXPECT_NE(result_table(run.study, run.result).find("| front/02 |  |  |  | 40 deg |"),
            std::string::npos)
      << result_table(run.study, run.result);
}

// Of the surfaces that the best is compared with too; one that breaks a limit counts for nothing,
// and of one that was confirmed twice that on the patch of the best counts.
TEST(BuildSheet, TakesTheBestFlatSurfaceOfAllThatWereConfirmed) {
  Searched run;
  FinalDesign& flat = run.result.finalists[1];
  flat.unit = run.problem.space().unit({5e-6, 3e-6, 0, 40 * kPi / 180});
  flat.design = run.problem.space().design(flat.unit);
  flat.confirmed = score(0.3, 0.9, 0.1);
  flat.feasible = flat.on_front = true, flat.folder = "front/02";
  const std::string against = "Against the best flat surface of this run, ";
  const auto lead = [&] { return as_read(recommendation(run.files())); };
  // Its own surface without the texture is the best: that is said already.
  ASSERT_EQ(advice_of(run.problem, run.result), Advice::Texture);
  EXPECT_FALSE(best_flat(run.problem, run.result));
  EXPECT_EQ(lead().find(against), std::string::npos) << lead();
  EXPECT_TRUE(as_read(run_json(run.files()))["best_flat"].is_null());
  // The study's own is.
  run.result.flat_before = score(0.45, 0.45, 0.15);
  EXPECT_NE(
      lead().find(against + "that of the study file (contact angle of water 50 deg), it raises "
                            "mean(modulation) by 0.050"),
      std::string::npos)
      << lead();
  EXPECT_NE(as_read(run_summary(run.files()))
                .find("| difference from the best flat surface, that of the study file | +0.050"),
            std::string::npos)
      << as_read(run_summary(run.files()));
  flat.unit = *run.problem.space().flattened(
      run.problem.space().with_own_finish(run.result.finalists[0].unit));
  flat.design = run.problem.space().design(flat.unit);
  flat.confirmed = score(0.46, 0.45, 0.15);
  ASSERT_TRUE(best_flat(run.problem, run.result));
  EXPECT_EQ(best_flat(run.problem, run.result)->confirmed.values[0], 0.45);
  run.result.flat_before->oxide_margin = 1.5;  // of 2 at least
  EXPECT_FALSE(best_flat(run.problem, run.result));
}

// Of a run that recommends the study's own surface nothing was searched, so nothing is rounded.
TEST(BuildSheet, SaysThatTheStudysOwnSurfaceIsNotRounded) {
  Searched run;
  run.result.flat = score(0.5, 0.3, 0.25);
  run.result.flat_before = score(0.51, 0.3, 0.25);
  ASSERT_EQ(advice_of(run.problem, run.result), Advice::LeaveFlat);
  run.result.build = BuiltDesign{recommended_design(run.problem, run.result), false};
  const std::string sheet = as_read(sheet_text(run.files()));
  EXPECT_NE(sheet.find("Finish and drive are those of the study file and are not rounded."),
            std::string::npos)
      << sheet;
  EXPECT_EQ(sheet.find("search.rounding"), std::string::npos) << sheet;
  // It is the best flat surface of the run too: that is one surface, in one row.
  ASSERT_TRUE(best_flat(run.problem, run.result));
  const auto json = as_read(run_json(run.files()));
  std::vector<std::string> beside;
  for (const auto& row : json["compared"]["rows"]) beside.push_back(row["surface"]);
  EXPECT_EQ(beside, (std::vector<std::string>{"without texture, recommended",
                                              "design 01, with its texture"}));
  // Who exports it is told the same.
  const std::string folder = temporary("own_surface");
  std::filesystem::create_directories(folder);
  write_bytes(folder + "/run.json", json.dump());
  EXPECT_EQ(build_sheet_text(folder),
            "finish and drive are those of the study file, which are not rounded");
}

// A rounded design that keeps not every limit says which, by how much.
TEST(BuildSheet, SaysWhatRoundingBreaks) {
  Searched run;
  BuiltDesign build{run.result.finalists[0], true, false, 6, run.result.finalists[0]};
  build.nearest->confirmed.oxide_margin = 1.995;
  build.nearest->feasible = false;
  run.result.build = build;
  EXPECT_NE(as_read(recommendation(run.files()))
                .find("Its numbers are as searched, off the grid of the fab: of 6 designs of the "
                      "grid that were judged none keeps every limit (of the nearest "
                      "oxide_breakdown_margin is 1.995, below your limit of 2)"),
            std::string::npos)
      << as_read(recommendation(run.files()));
  EXPECT_EQ(as_read(sheet_text(run.files())).find("**broken**"), std::string::npos);
}

// The design that the lead names, on the grid of the fab, has the numbers that stand beside it.
TEST(BuildSheet, TheLeadHasTheNumbersOfTheDesignThatItNames) {
  Searched run;
  BuiltDesign build{run.result.finalists[0], false};
  const auto made = [&](double depth, double angle, const Score& worth) {
    const std::vector<double> value{5e-6, 3e-6, depth, angle * kPi / 180};
    build.made.unit = run.problem.space().unit(value);
    build.made.design = run.problem.space().design_of(value);
    build.made.confirmed = worth;
    run.result.build = build;
    return as_read(recommendation(run.files()));
  };
  const auto has = [](const std::string& lead, const std::string& text) {
    EXPECT_NE(lead.find(text), std::string::npos) << lead;
  };
  // The surface without texture has the finish of the search: the texture is judged with that.
  std::string lead = made(300e-9, 71, score(0.49, 0.31, 0.24));
  has(lead, "with contact angle of water 71 deg (50 deg in the study file).");
  has(lead,
      "over fingers and humidity is 0.240; before rounding, with contact angle of water 70 deg, it "
      "is 0.250; without texture, before rounding too, it is 0.200. Before rounding, with contact "
      "angle of water 70 deg, its texture raises mean(modulation) by 0.100 ± 0.013 (better)");
  lead = made(310e-9, 70, score(0.41, 0.35, 0.2));
  has(lead,
      "Its texture changes no objective by more than the error of the difference on the grid of "
      "the fab, where before rounding it raises mean(modulation) by 0.100 ± 0.013 (better)");
  EXPECT_EQ(lead.find("not judged"), std::string::npos) << lead;
  Score unjudged = score(0, 0, 0);
  unjudged.ok = false;
  lead = made(310e-9, 70, unjudged);
  has(lead, "310 nm deep");
  has(lead, "over fingers and humidity is 0.250;");
  has(lead,
      " These are its numbers before rounding to the grid of the fab: so rounded it was not "
      "judged.");
  EXPECT_EQ(scored_name(run.files()), "what is recommended");
  made(310e-9, 70, score(0.41, 0.35, 0.2));
  EXPECT_EQ(scored_name(run.files()), "what is built");
}

// A grid so coarse that it has no such design is not said to be kept.
TEST(BuildSheet, SaysThatTheGridHasNoSuchDesign) {
  Searched none;
  none.result.build = BuiltDesign{none.result.finalists[0], true, false};
  EXPECT_NE(as_read(recommendation(none.files()))
                .find("Its numbers are as searched, off the grid of the fab (10 nm): no design of "
                      "that grid near it keeps the limits of its shape, film and look"),
            std::string::npos)
      << as_read(recommendation(none.files()));
  EXPECT_EQ(as_read(run_json(none.files()))["build"]["on_grid"], false);
  Study study = holes();
  study.search.rounding = 3e-6;
  study.variables[0].low = 4.6e-6, study.variables[0].high = 5.4e-6;
  Searched run(study);
  run.result.build = BuiltDesign{run.result.finalists[0], false};
  EXPECT_NE(as_read(recommendation(run.files()))
                .find("Its period is off the grid of the fab (3 um), which has no value within low "
                      "and high of the study"),
            std::string::npos)
      << as_read(recommendation(run.files()));
  EXPECT_EQ(as_read(run_json(run.files()))["build"]["on_grid"], false);
  EXPECT_NE(as_read(sheet_text(run.files()))
                .find("Periods and widths that were searched are on a grid of 3 um "
                      "(`search.rounding`), and so are other lengths of 150 um and more; shorter "
                      "ones are on a finer one (`best/build.toml`); the range of texture.period "
                      "has no value of it"),
            std::string::npos)
      << as_read(sheet_text(run.files()));
}

// A distance of next to nothing is held against its target.
TEST(BuildSheet, ATargetSaysOfWhatTheToleranceIs) {
  Study study = holes();
  EXPECT_EQ(tolerance_end_text(Searched(study).files()),
            "an objective worsens by 5 % or a limit is reached");
  study.objective = {};
  study.objective.targets = {{kModulation, 0.4}};
  study.objective.minimise = {parse_metric("variation(modulation)")};
  EXPECT_EQ(
      tolerance_end_text(Searched(study).files()),
      "an objective worsens by 5 % (a distance: by 5 % of its target, or of itself if that is "
      "more) or a limit is reached");
}

// Who goes on with the files of a run that says to build none of its designs is told so.
TEST(RunLimits, OfARunThatKeepsThemNowhereAreNamed) {
  const TemporaryFolder place;
  const std::string folder = place.path();
  EXPECT_EQ(none_keeps_text(folder), "");
  nlohmann::json run{
      {"interrupted", false},
      {"feasible", false},
      {"limits",
       {{{"name", "min_wall"}, {"asked", "at least 1 um"}, {"text", "2 um"}, {"kept", true}},
        {{"name", "worst(modulation)"},
         {"asked", "at least 5"},
         {"text", "0.3075"},
         {"kept", false}}}}};
  write_bytes(folder + "/run.json", run.dump());
  EXPECT_EQ(none_keeps_text(folder),
            folder +
                ": build none of these: no design of the run keeps every limit; what it shows "
                "breaks worst(modulation) at least 5 (it has 0.3075)");
  run["feasible"] = true;
  write_bytes(folder + "/run.json", run.dump());
  EXPECT_EQ(none_keeps_text(folder), "");
  EXPECT_EQ(none_keeps_text(folder + "/run.json"), "");  // no folder
}

// What the limits are kept with stands in the lead where it is less than the study wants.
TEST(BuildSheet, TheLeadSaysThatBeliefBreaksLimits) {
  Searched run;
  search::Prospect prospect;
  prospect.p_best = 1;
  prospect.p_limit = {1, 1, 1, 0.28};
  prospect.p_limits = 0.28;
  run.result.decision.absent = "";
  run.result.decision.designs = {prospect};
  EXPECT_NE(as_read(recommendation(run.files()))
                .find(" By what is believed of finger and model it keeps every limit with "
                      "probability 28 % only; the study wants 90 % (risk.limits)."),
            std::string::npos)
      << as_read(recommendation(run.files()));
  run.result.decision.designs[0].p_limits = 0.9;
  EXPECT_EQ(as_read(recommendation(run.files())).find("believed of finger"), std::string::npos);
}

// Worths rise with what is wished for; what is said of a wish for less is the number itself.
TEST(BuildSheet, OfAWishForLessTheWorthIsTheNumber) {
  Searched run;
  run.result.decision.absent = "";
  run.result.decision.designs = {search::Prospect{}, search::Prospect{}};
  run.result.decision.rule = {search::PickRule::Kind::Objective, 1};
  run.result.decision.best_worth = -280;
  const std::string said = as_read(decision_grounds(run.files()).front());
  EXPECT_NE(said.find(", which has 280 ("), std::string::npos) << said;
}

// Belief has nothing to choose of one design; how surely it keeps the limits is said.
TEST(BuildSheet, OfOneDesignOnTheFrontSaysThatThereIsNothingToChoose) {
  Searched run;
  search::Prospect prospect;
  prospect.p_best = 1;
  prospect.p_limit = {1, 1, 1, 0.95};
  prospect.p_limits = 0.95;
  Decision& decision = run.result.decision;
  decision.absent = "";
  decision.designs = {prospect};
  decision.p_best_by = {{1}, {1}};
  decision.members = 32, decision.effective_members = 31.7;
  const std::vector<std::string> sure = decision_grounds(run.files());
  ASSERT_EQ(sure.size(), 1u);
  EXPECT_TRUE(as_read(sure[0]).starts_with(
      "How sure: design 01 is the one design on the front, so there is nothing to choose by "
      "belief. It was judged at 32 members of it. With probability 95 % design 01 keeps every "
      "limit"))
      << as_read(sure[0]);
  const std::string text = as_read(decision_text(run.files()));
  EXPECT_NE(text.find("front/01 is the one design on the front, so there is nothing to choose. It "
                      "was judged at 32 members of belief about finger and model (as good as 31.7 "
                      "equal ones).\n\n| design | p(every limit) | p(min_hole) |"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("| front/01 | 95 % | 100 % |"), std::string::npos) << text;
  for (const char* empty : {"p(best)", "regret", "overturn", "ranges"})
    EXPECT_EQ(text.find(empty), std::string::npos) << empty << " in " << text;
  EXPECT_NE(as_read(run_summary(run.files())).find("`best/` is front/01: the one design on the "),
            std::string::npos);
}

// Members of belief judge the front alone: of a surface that is not on it nobody knows how sure it
// is, whether it was confirmed beside the front or not at all.
TEST(BuildSheet, OfASurfaceBesideTheFrontSaysThatHowSureItIsWasNotJudged) {
  Searched run;
  Decision& decision = run.result.decision;
  decision.designs = {search::Prospect{}};
  decision.rule = {search::PickRule::Kind::Objective, 0};
  decision.best_worth = 0.5;
  const auto said = [&] { return as_read(decision_grounds(run.files()).front()); };
  EXPECT_TRUE(said().starts_with("How sure: design 01 is the one design on the front")) << said();
  run.result.flat = score(0.49, 0.29, 0.2);
  ASSERT_EQ(advice_of(run.problem, run.result), Advice::Finish);
  const std::string not_judged =
      "How sure that is was not judged: only designs of the front are judged at the members of "
      "belief, and the surface is none of them.";
  EXPECT_EQ(decision_grounds(run.files()), std::vector<std::string>{not_judged});
  EXPECT_EQ(as_read(grounds(run.files()).front()), not_judged);
  FinalDesign& flat = run.result.finalists[1];
  flat.unit = *run.problem.space().flattened(run.result.finalists[0].unit);
  flat.design = run.problem.space().design(flat.unit);
  EXPECT_EQ(decision_grounds(run.files()), std::vector<std::string>{not_judged});
  flat.on_front = true, flat.folder = "front/02";
  decision.designs.push_back(search::Prospect{});
  EXPECT_TRUE(said().starts_with(
      "How sure: of the 2 designs of the front design 02, the surface that is recommended, is"))
      << said();
  // The choice by belief is another one: each statement names the design that it is about.
  EXPECT_NE(
      said().find("; design 01 has the least expected regret. The recommendation follows the "
                  "objectives, in which the texture of design 01 gains no more than the error "
                  "of the difference; belief is judged in mean(modulation)."),
      std::string::npos)
      << said();
  const std::string text = as_read(decision_text(run.files()));
  EXPECT_NE(text.find("What would overturn the choice of front/01: "), std::string::npos) << text;
  // The best is flat too, and no better than the study's own surface: no texture is spoken of.
  FinalDesign& best = run.result.finalists[0];
  best.unit = *run.problem.space().flattened(best.unit);
  best.design = run.problem.space().design(best.unit);
  flat.unit = run.problem.space().snapped(run.problem.space().with_own_finish(best.unit));
  flat.design = run.problem.space().design(flat.unit);
  run.result.flat.reset();
  run.result.flat_before = best.confirmed;
  ASSERT_EQ(advice_of(run.problem, run.result), Advice::LeaveFlat);
  EXPECT_NE(said().find("in which the finish of design 01 gains no more than the error"),
            std::string::npos)
      << said();
}

TEST(BuildSheet, NamesNoLargerStepThanWasTried) {
  for (const double nm : {17.5 - 1e-14, 17.5, 17.0, 17.96})
    EXPECT_EQ(drift_text({nm * 1e-9, Drift::End::StepTried}, "nm"), "> 17 nm (largest step tried)");
  EXPECT_EQ(drift_text({1.77e-9, Drift::End::Limit, "min_wall"}, "nm"),
            "1.7 nm, then min_wall is reached");
  EXPECT_EQ(drift_text({1.77e-9, Drift::End::Loss}, "nm"), "1.7 nm");
  Searched run;
  run.result.sensitivity[1].up = {1.77e-9, Drift::End::Limit, "min_wall"};
  const std::string sheet = as_read(sheet_text(run.files()));
  EXPECT_NE(sheet.find("one dimension at a time: depth at most 1.7 nm up (min_wall"),
            std::string::npos)
      << sheet;
}

TEST(BuildSheet, ForProgramsIsInTheUnitsOfTheStudy) {
  Searched run;
  run.result.at_bound = {{0, true, 5e-6, false, 0, {}}};
  const auto json = as_read(run_json(run.files()));
  EXPECT_EQ(json["advice"], "texture");
  EXPECT_EQ(json["evaluations"], 40);
  EXPECT_EQ(json["asked"], 40);
  EXPECT_EQ(json["stopped_by_the_clock"], false);
  EXPECT_EQ(json["driven"], true);
  EXPECT_EQ(json["remarks"].size(), 1u);
  EXPECT_EQ(json["finish"], "contact angle of water 70 deg (50 deg in the study file)");
  expect_same(json["shown"]["mean(modulation)"], {{"scale", 1}, {"unit", ""}, {"decimals", 3}},
              "shown");
  expect_same(
      json["sheet"][0],
      {{"name", "texture.period"},
       {"words", "period"},
       {"unit", "um"},
       {"value", 5},
       {"build", 5},
       {"free", true},
       {"down", 0.12},
       {"down_at_least", false},
       {"down_limit", nullptr},
       {"up", 0.5},
       {"up_at_least", true},
       {"up_limit", nullptr},
       {"bound", "upper"},
       {"text", {{"build", "5 um"}, {"down", "0.12 um"}, {"up", "> 0.5 um (largest step tried)"}}}},
      "sheet");
  const auto step = [](const char* surface, double mean, double variation) {
    return nlohmann::json{{"surface", surface},
                          {"objectives",
                           {{"mean(modulation)", {{"value", mean}, {"se", 0.013}}},
                            {"variation(modulation)", {{"value", variation}, {"se", 0.023}}}}}};
  };
  expect_same(json["steps"],
              {step("flat, finish and drive of the study", 0.35, 0.45),
               step("flat, finish and drive of the best", 0.4, 0.35),
               step("best, with its texture", 0.5, 0.3)},
              "steps");
  expect_same(json["compared"],
              {{"names", {"mean(modulation)", "variation(modulation)", "worst modulation"}},
               {"rows",
                {{{"surface", "design 01, recommended"},
                  {"values", {"0.500 ± 0.013", "0.300 ± 0.023", "0.250"}}},
                 {{"surface", "the same without texture"},
                  {"values", {"0.400 ± 0.013", "0.350 ± 0.023", "0.200"}}}}}},
              "compared");
  expect_same(json["beside"],
              {{{"words", "film"}, {"text", "SiO2"}},
               {{"words", "narrowest wall"}, {"text", "2000 nm"}},
               {{"words", "drive"}, {"text", "200 V (peak) at 5 kHz"}}},
              "beside");
  run.result.interrupted = true;
  EXPECT_FALSE(as_read(run_json(run.files())).contains("advice"));
}

// The folder of a run: every cell of its tables.
TEST(RunFolder, ItsTablesHaveEachNumberUnderItsHead) {
  Searched run;
  run.folder = temporary("run");
  std::filesystem::create_directories(run.folder);
  FinalDesign& best = run.result.finalists[0];
  best.searched = score(0.52, 0.32, 0.27);
  best.confirmed.oxide_margin = 2.5;
  best.on_front = false;  // else its folder would be written twice
  best.confirmed.reports = {R"({"a": 1})"};
  run.result.flat->reports = {R"({"b": 2})"};
  run.result.finalists[1].confirmed.ok = false;
  run.result.finalists[1].confirmed.reason = "no, it \"failed\"";
  run.result.finalists[1].confirmed.oxide_margin = kInfinity;
  run.result.finalists[1].feasible = false;
  run.history.evaluations = {{best.unit, {true, "", {-0.51, 0.31}, {-1}, {}}},
                             {run.result.finalists[1].unit, {true, "", {-0.41, 0.21}, {0.5}, {}}},
                             {run.result.finalists[1].unit, {false, "a, b", {}, {}, {}}}};
  run.history.worst = {0.26, 0.16, 0};
  run.result.hypervolumes = {0.125, 0.25, 0.375};
  write_results(run.files());
  const std::string variables =
      ",texture.period [um],texture.diameter [um],texture.depth [nm],surface.contact_angle [deg]";
  EXPECT_EQ(read_bytes(run.folder + "/history.csv"),
            "evaluation" + variables +
                ",mean(modulation),variation(modulation),worst modulation,feasible,hypervolume,"
                "status\n1,5,3,300,70,0.51,0.31,0.26,yes,0.125,ok\n"
                "2,8,4,500,40,0.41,0.21,0.16,no,0.25,ok\n3,8,4,500,40,,,,no,0.375,a; b\n");
  EXPECT_EQ(
      read_bytes(run.folder + "/pareto.csv"),
      "design" + variables +
          ",mean(modulation),mean(modulation) se,mean(modulation) model,"
          "mean(modulation) at search level,variation(modulation),variation(modulation) se,"
          "variation(modulation) model,variation(modulation) at search level,worst "
          "modulation,breakdown margin,limit min_hole,limit min_wall,limit aspect_ratio,limit "
          "oxide_breakdown_margin,feasible,on front,status\n"
          "front/01,5,3,300,70,0.5,0.013,,0.52,0.3,0.023,,0.32,0.25,2.5,2.979 um,2 "
          "um,0.15,2.5,yes,no,ok\n"
          "infeasible,8,4,500,40,,,,,,,,,,,,,,,no,no,no; it ;failed;\n");
  expect_document(
      read_bytes(run.folder + "/sensitivity.json"),
      {{"schema", 1},
       {"variables",
        {{"texture.period",
          {{"step", 0.35e-6},
           {"change", {{"mean(modulation)", 0.01}, {"variation(modulation)", -0.02}}},
           {"variance_share", {{"mean(modulation)", 0.6}, {"variation(modulation)", 0.25}}},
           {"tolerance",
            {{"down", {{"most", 0.12e-6}, {"end", "loss"}, {"limit", nullptr}}},
             {"up", {{"most", 0.5e-6}, {"end", "step tried"}, {"limit", nullptr}}}}}}},
         {"texture.depth",
          {{"step", 50e-9},
           {"change", nlohmann::json::object()},
           {"variance_share", nlohmann::json::object()},
           {"tolerance",
            {{"down", {{"most", nullptr}, {"end", "range ends"}, {"limit", nullptr}}},
             {"up", {{"most", 20e-9}, {"end", "limit"}, {"limit", "min_wall"}}}}}}}}}});
  auto metrics = nlohmann::json::parse(read_bytes(run.folder + "/best/metrics.json"));
  expect_same(metrics["variables"],
              {{"texture.period", 5e-6},
               {"texture.diameter", 3e-6},
               {"texture.depth", 300e-9},
               {"surface.contact_angle", 70 * kPi / 180}},
              "variables");
  const auto value = [](double v, double se, bool maximise) {
    return nlohmann::json{{"value", v},
                          {"maximise", maximise},
                          {"se", se},
                          {"parameters", nullptr},
                          {"model", nullptr}};
  };
  expect_same(metrics["objectives"],
              {{"mean(modulation)", value(0.5, 0.013, true)},
               {"variation(modulation)", value(0.3, 0.023, false)}},
              "objectives");
  expect_same(metrics["objectives_at_search_level"],
              {{"mean(modulation)", value(0.52, 0.013, true)},
               {"variation(modulation)", value(0.32, 0.023, false)}},
              "search");
  EXPECT_EQ(metrics["worst_modulation"], 0.25);
  EXPECT_EQ(metrics["oxide_breakdown_margin"], 2.5);
  EXPECT_EQ(metrics["feasible"], true);
  expect_same(metrics["stability"],
              {{"on_front", 2}, {"variants", 2}, {"stable", true}, {"why", ""}}, "stable");
  expect_same(metrics["flat"],
              {{"finish_of", "front/01"},
               {"objectives",
                {{"mean(modulation)", value(0.4, 0.013, true)},
                 {"variation(modulation)", value(0.35, 0.023, false)}}},
               {"worst_modulation", 0.2},
               {"difference",
                {{"mean(modulation)", {{"value", 0.5 - 0.4}, {"se", 0.013}}},
                 {"variation(modulation)", {{"value", 0.3 - 0.35}, {"se", 0.023}}}}},
               {"no_better", nullptr}},
              "flat");
  expect_same(metrics["tasks"],
              nlohmann::json::array({{{"name", run.problem.tasks()[0].name},
                                      {"weight", 1},
                                      {"response", {{"a", 1}}},
                                      {"flat", {{"b", 2}}}}}),
              "tasks");
  EXPECT_FALSE(std::filesystem::exists(run.folder + "/front"));
  EXPECT_NE(recommendation_of(run.folder).find("Build design 01"), std::string::npos);
  EXPECT_EQ(recommendation_of(run.folder + "/best"), "");
}

// What the head, the build sheet and the decision say in digits is stated, but names.
TEST(RunSummary, EveryNumberOfTheFirstScreenHasAReceipt) {
  Searched run;
  run.folder = temporary("receipts_run");
  std::filesystem::create_directories(run.folder);
  run.result.build = BuiltDesign{run.result.finalists[0], false};
  run.result.build->made.confirmed = score(0.49, 0.31, 0.03);
  run.result.build->judged = 3;
  const nlohmann::ordered_json json = run_json(run.files());
  const std::vector<std::string> names{"design 01", "Fehlberg 2022", "5 %"};
  int numbers = 0;
  const auto check = [&](const std::string& where, const std::string& text) {
    for (const TextPart& part : said_parts(text)) {
      std::string words = part.text;
      for (const std::string& name : names) {
        for (std::size_t at; (at = words.find(name)) != std::string::npos;)
          words.erase(at, name.size());
      }
      numbers += part.number.has_value();
      EXPECT_TRUE(part.number || words.find_first_of("0123456789") == std::string::npos)
          << where << ": " << words;
    }
  };
  for (const char* key : {"recommendation", "facts", "finish"})
    check(key, json[key].get<std::string>());
  for (const auto& text : json["grounds"]) check("grounds", text.get<std::string>());
  for (const auto& text : json["remarks"]) check("remarks", text.get<std::string>());
  for (const auto& row : json["compared"]["rows"]) {
    for (const auto& text : row["values"]) check("compared", text.get<std::string>());
  }
  for (const auto& row : json["beside"]) {
    if (row["words"] != "film") check("beside", row["text"].get<std::string>());
  }
  for (const auto& row : json["sheet"]) {
    for (const char* way : {"build", "down", "up"})
      check("sheet", row["text"][way].get<std::string>());
    EXPECT_TRUE(row["value"].is_string());
  }
  for (const auto& row : json["limits"]) {
    check("limits", row["text"].get<std::string>());
    check("limits", row["asked"].get<std::string>());
  }
  check("build", json["build"]["said"].get<std::string>());
  check("sheet_text", sheet_text(run.files()));
  for (const auto& step : json["steps"]) {
    for (const auto& objective : step["objectives"]) {
      EXPECT_TRUE(objective["value"].is_string());
      ++numbers;
    }
  }
  EXPECT_GT(numbers, 40);
  const Receipts receipts = receipts_of(run.files(), json, run_summary(run.files()));
  EXPECT_GT(receipts.list.size(), 20u);
  EXPECT_LT(receipts.list.size(), static_cast<std::size_t>(numbers));
}

}  // namespace
}  // namespace papilla::tests::summary_test
