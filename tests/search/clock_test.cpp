#include "search/clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "report/recommendation.h"
#include "report/remarks.h"
#include "report/stated_number.h"
#include "search/findings.h"
#include "search/levels.h"
#include "search/rounding.h"
#include "search/run.h"
#include "tests/support/without_belief.h"

namespace papilla::tests::clock_test {
namespace {

Study holes() {
  Study study = without_belief(read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml"));
  study.population.clear();
  study.design.accuracy.level = AccuracyLevel::Draft;
  return study;
}

PartSeconds all(double seconds) {
  PartSeconds out;
  out.fill(seconds);
  return out;
}

// What a run was prepared for, its price measured, is of its time.
TEST(Clock, WhatWasSpentBeforeTheRunIsOfItsTime) {
  const RunClock clock(60, 5), alone(60);
  EXPECT_GE(clock.seconds(), 5);
  EXPECT_LT(clock.left(all(0)), 55.01);
  EXPECT_NEAR(alone.left(all(0)) - clock.left(all(0)), 5, 1);
}

TEST(Clock, TheSearchKeepsHalfOrWithBeliefFourTenthsHoweverMuchTheRestWants) {
  PartSeconds fitted = all(1e6);  // without a belief
  fitted[static_cast<std::size_t>(RunPart::Belief)] = 0;
  EXPECT_DOUBLE_EQ(part_deadline(60, RunPart::Search, fitted), 30);
  EXPECT_DOUBLE_EQ(part_deadline(60, RunPart::Search, all(1e6)), 24);
  // What the rest does not want is the search's: nine parts of 1 s.
  EXPECT_DOUBLE_EQ(part_deadline(60, RunPart::Search, all(1)), 51);
  EXPECT_DOUBLE_EQ(part_deadline(60, RunPart::Files, all(1e6)), 60);
}

TEST(Clock, SharesAreTheWholeAndDeadlinesRise) {
  double sum = 0, before = 0;
  for (std::size_t p = 0; p < kParts; ++p) {
    sum += part_share(static_cast<RunPart>(p));
    const double deadline = part_deadline(100, static_cast<RunPart>(p), all(1e6));
    EXPECT_NEAR(deadline, 100 * sum, 1e-9);
    EXPECT_GT(deadline, before);
    before = deadline;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
}

// Skins first, then pixels, then more skins; the price is kept where it can be.
TEST(Clock, AConfirmationShrinksToItsPrice) {
  const Study study = holes();
  const StudyProblem problem(study);
  const Fidelity full = stage_fidelity(problem, Stage::Confirm);
  const double price = task_price(problem, Stage::Confirm);
  EXPECT_EQ(stage_fidelity(problem, Stage::Confirm, price).skins, full.skins);
  const Fidelity less = stage_fidelity(problem, Stage::Confirm, 0.85 * price);
  EXPECT_LT(less.skins, full.skins);
  EXPECT_EQ(less.grid, full.grid);
  EXPECT_LE(task_price(problem, Stage::Confirm, 0.85 * price), 0.85 * price);
  const Fidelity least = stage_fidelity(problem, Stage::Confirm, 1e-9);
  EXPECT_EQ(least.skins, 4);
  EXPECT_EQ(least.grid, 64);
  EXPECT_EQ(least.first_skin, full.first_skin);
}

Evaluation tried(const StudyProblem& problem, double period_um, double depth_nm, double angle_deg) {
  Evaluation e;
  e.unit = problem.space().unit(
      {period_um * 1e-6, 3e-6, depth_nm * 1e-9, angle_deg * std::acos(-1.0) / 180});
  e.outcome.ok = true;
  e.outcome.objectives = {-0.5, 0.1};
  return e;
}

// The search that never moved, of which nothing was said.
TEST(Findings, AVariableOfOneValueIsNamed) {
  const Study study = holes();
  const StudyProblem problem(study);
  std::vector<Evaluation> history{tried(problem, 4, 100, 50), tried(problem, 4, 200, 50),
                                  tried(problem, 4, 300, 60)};
  const std::vector<OneValue> one = one_value_variables(problem, history);
  ASSERT_EQ(one.size(), 2u);
  EXPECT_EQ(study.variables[one[0].variable].path, "texture.period");
  EXPECT_NEAR(one[0].value, 4e-6, 1e-12);
  EXPECT_EQ(study.variables[one[1].variable].path, "texture.diameter");
  history.back().unit[0] += 0.1;
  EXPECT_EQ(one_value_variables(problem, history).size(), 1u);
  history.back().outcome.ok = false;  // what failed has shown nothing
  EXPECT_EQ(one_value_variables(problem, history).size(), 3u);
}

TEST(Findings, ABoundIsNamedWithWhatWideningGives) {
  const Study study = holes();
  const StudyProblem problem(study);
  const Point best = tried(problem, 10, 350, 80).unit;  // period and angle at their upper bounds
  VariableSensitivity s;
  s.variable = 0;
  s.step = 0.35e-6;
  s.change = {0.01, -0.02};
  s.share = {1, 1};
  const std::vector<AtBound> at = variables_at_bound(problem, best, {s});
  ASSERT_EQ(at.size(), 2u);
  EXPECT_EQ(study.variables[at[0].variable].path, "texture.period");
  EXPECT_TRUE(at[0].upper);
  EXPECT_FALSE(at[0].last);
  EXPECT_EQ(at[0].change, s.change);
  EXPECT_EQ(study.variables[at[1].variable].path, "surface.contact_angle");
  OptimiseResult result;
  result.asked = result.evaluations = 40;
  result.at_bound = at;
  EXPECT_TRUE(run_remarks(study, problem, result)[0].starts_with(
      "What comes nearest to the limits has texture.period on its upper bound, 10 um."));
  result.any_feasible = true;
  const std::vector<std::string> remarks = run_remarks(study, problem, result);
  ASSERT_EQ(remarks.size(), 2u);
  EXPECT_EQ(
      remarks[0],
      "What is recommended has texture.period on its upper bound, 10 um. If the trend continues, "
      "0.35 um more would change mean(modulation) +0.01, variation(modulation) -0.02.");
  EXPECT_NE(remarks[1].find("widen it to see whether more helps"), std::string::npos);
}

Score score(double mean, double variation, double oxide_margin = 3) {
  Score s;
  s.ok = true;
  s.values = {mean, variation};
  s.errors = {0.01, 0.01};
  s.oxide_margin = oxide_margin;
  return s;
}

// One design that holds, 0.5 / 0.3; the study's own contact angle is 50 deg.
OptimiseResult one_design(const StudyProblem& problem) {
  OptimiseResult result;
  FinalDesign best;
  best.unit = tried(problem, 5, 300, 70).unit;
  best.design = problem.space().design(best.unit);
  best.confirmed = score(0.5, 0.3);
  best.on_front = best.feasible = true;
  best.folder = "front/01";
  result.finalists = {best};
  result.any_feasible = true;
  return result;
}

// What the finish does takes a second surface, for which there may be no time.
TEST(Sheet, WithoutTheStudysOwnSurfaceTheFinishIsNotJudged) {
  const Study study = holes();
  const StudyProblem problem(study);
  OptimiseResult result = one_design(problem);
  result.flat = score(0.6, 0.2);
  const JudgedDesigns history;
  const ResultFiles files{"", study, problem, history, result, ""};
  EXPECT_EQ(advice_of(problem, result), Advice::Finish);
  EXPECT_NE(report::as_read(recommendation(files))
                .find("What the finish does (contact angle of water 70 deg (50 deg"),
            std::string::npos)
      << report::as_read(recommendation(files));
  result.flat_before = score(0.4, 0.4);
  EXPECT_EQ(report::as_read(recommendation(files)).find("not known"), std::string::npos)
      << report::as_read(recommendation(files));
}

TEST(Sheet, ATextureThatAloneKeepsALimitIsWorthBuilding) {
  const Study study = holes();
  const StudyProblem problem(study);
  OptimiseResult result = one_design(problem);
  result.flat = result.flat_before = score(0.6, 0.2, 1.5);  // better, but its film does not hold
  const JudgedDesigns history;
  const ResultFiles files{"", study, problem, history, result, ""};
  EXPECT_EQ(advice_of(problem, result), Advice::Texture);
  EXPECT_NE(report::as_read(recommendation(files))
                .find("Without its texture the same surface breaks a limit: "
                      "oxide_breakdown_margin is 1.5, below your limit of 2."),
            std::string::npos)
      << report::as_read(recommendation(files));
  result.flat = result.flat_before = score(0.6, 0.2, 2.5);
  EXPECT_EQ(advice_of(problem, result), Advice::LeaveFlat)
      << report::as_read(recommendation(files));
}

// The finish gains nothing but that a limit is kept.
TEST(Sheet, AFinishThatAloneKeepsALimitNamesTheLimit) {
  const Study study = holes();
  const StudyProblem problem(study);
  OptimiseResult result = one_design(problem);
  result.flat = score(0.6, 0.2, 2.5);
  result.flat_before = score(0.6, 0.2, 1.5);
  const JudgedDesigns history;
  const ResultFiles files{"", study, problem, history, result, ""};
  EXPECT_EQ(advice_of(problem, result), Advice::Finish);
  const std::string said = report::as_read(recommendation(files));
  EXPECT_NE(said.find("): the study's own surface breaks a limit (oxide_breakdown_margin is 1.5, "
                      "below your limit of 2); no texture of this search adds more"),
            std::string::npos)
      << said;
  result.flat_before = score(0.4, 0.1, 1.5);
  const std::string both = report::as_read(recommendation(files));
  EXPECT_NE(both.find("): that raises mean(modulation) by 0.20"), std::string::npos) << both;
  EXPECT_NE(both.find(" and raises variation(modulation) by 0.10"), std::string::npos) << both;
}

// At a lower bound a widening goes the other way than a step up.
TEST(Findings, TheSlopeAtALowerBoundIsTakenDownwards) {
  const Study study = holes();
  const StudyProblem problem(study);
  VariableSensitivity s;
  s.variable = 0;
  s.step = 0.35e-6;
  s.change = {0.01, -0.02};
  const std::vector<AtBound> at = variables_at_bound(problem, tried(problem, 3, 350, 50).unit, {s});
  ASSERT_EQ(at.size(), 1u);
  EXPECT_FALSE(at[0].upper);
  EXPECT_EQ(at[0].change, (std::vector<double>{-0.01, 0.02}));
}

// A period begins at 10 nm: a step of 350 nm below 100 nm is none.
TEST(Findings, NoStepGoesBeyondWhatTheModelTakes) {
  Study study = holes();
  study.variables[0].low = 100e-9;
  const StudyProblem problem(study);
  VariableSensitivity s;
  s.variable = 0;
  s.step = 0.35e-6;
  s.change = {0.01};
  const std::vector<AtBound> at =
      variables_at_bound(problem, tried(problem, 0.1, 350, 50).unit, {s});
  ASSERT_EQ(at.size(), 1u);
  EXPECT_FALSE(at[0].last);
  EXPECT_NEAR(at[0].step, 90e-9, 1e-15);
  EXPECT_NEAR(at[0].change[0], -0.01 * 90 / 350, 1e-9);
}

TEST(Remarks, TheClockComesFirstAndSaysWhatItLeavesUnsure) {
  Study study = holes();
  study.search.time = 60;
  const StudyProblem problem(study);
  OptimiseResult result;
  result.evaluations = 12;
  result.asked = 40;
  result.end = SearchEnd::Clock;
  result.cuts = {{RunPart::Search, 12, 40}, {RunPart::Confirm, 3, 9}, {RunPart::Sensitivity, 0, 1}};
  const std::vector<std::string> remarks = run_remarks(study, problem, result);
  ASSERT_EQ(remarks.size(), 1u);
  EXPECT_TRUE(remarks[0].starts_with(
      "Stopped by the clock (60 s) after 12 of 40 evaluations; 3 of 9 finalists confirmed"))
      << remarks[0];
  EXPECT_NE(remarks[0].find("tolerances are not known"), std::string::npos);
  result.cuts.clear();
  result.end = SearchEnd::Before;
  EXPECT_EQ(run_remarks(study, problem, result).at(0),
            "12 evaluations where 40 were asked for: the search of the run that was resumed had "
            "ended. More of them are another run, in a folder of its own.");
  result.end = SearchEnd::Exhausted;
  EXPECT_EQ(run_remarks(study, problem, result).at(0),
            "12 evaluations where 40 were asked for: the search had nothing more to try.");
}

TEST(Rounding, LengthsGoToTheGridAndSmallOnesToAFinerOne) {
  const Variable period{"texture.period", "um", 3e-6, 10e-6, {}};
  EXPECT_DOUBLE_EQ(on_grid(period, 7.048326377461542e-6, 10e-9), 7.05e-6);
  const Variable depth{"texture.depth", "nm", 0, 1e-6, {}};
  EXPECT_DOUBLE_EQ(on_grid(depth, 103.4e-9, 10e-9), 103e-9);
  EXPECT_DOUBLE_EQ(on_grid(depth, 0, 10e-9), 0);
  EXPECT_DOUBLE_EQ(on_grid(depth, 996e-9, 10e-9), 1000e-9);
  // Out of what is excluded, to the end where the value lies.
  const Variable depths{"texture.depth", "nm", 0, 1e-6, {}, {{503e-9, 596e-9}}};
  EXPECT_DOUBLE_EQ(on_grid(depths, 503e-9, 10e-9), 500e-9);
  EXPECT_DOUBLE_EQ(on_grid(depths, 596e-9, 10e-9), 600e-9);
  EXPECT_DOUBLE_EQ(on_grid(depths, 203.4e-9, 10e-9), 203e-9);  // beside it as anywhere
  EXPECT_DOUBLE_EQ(on_grid(depths, 703.4e-9, 10e-9), 700e-9);
  // Within its interval: 10 um is out, 9.99 um in.
  const Variable narrow{"texture.period", "um", 3e-6, 9.998e-6, {}};
  EXPECT_DOUBLE_EQ(on_grid(narrow, 9.998e-6, 10e-9), 9.99e-6);
  const double degree = std::acos(-1.0) / 180;
  const Variable angle{"surface.contact_angle", "deg", 30 * degree, 80 * degree, {}};
  EXPECT_NEAR(on_grid(angle, 63.43 * degree, 10e-9), 63 * degree, 1e-12);
  const Variable volts{"drive.amplitude", "V", 10, 500, {}};
  EXPECT_DOUBLE_EQ(on_grid(volts, 187.65, 10e-9), 188);
}

// Of what comes later each keeps its share of 100 s, or less where it wants less.
TEST(Clock, EachLaterPartKeepsItsShareOrWhatItWants) {
  PartSeconds wanted{};
  wanted[static_cast<std::size_t>(RunPart::Narrow)] = 50;      // its share is 12
  wanted[static_cast<std::size_t>(RunPart::Confirm)] = 10;     // of 16
  wanted[static_cast<std::size_t>(RunPart::Parameters)] = 99;  // 2
  wanted[static_cast<std::size_t>(RunPart::Files)] = 1;        // of 4
  EXPECT_NEAR(part_deadline(100, RunPart::Search, wanted), 100 - 12 - 10 - 2 - 1, 1e-12);
  EXPECT_NEAR(part_deadline(100, RunPart::Narrow, wanted), 100 - 10 - 2 - 1, 1e-12);
  EXPECT_NEAR(part_deadline(100, RunPart::Confirm, wanted), 100 - 2 - 1, 1e-12);
  EXPECT_NEAR(part_deadline(100, RunPart::Parameters, wanted), 100 - 1, 1e-12);
  RunClock clock(1000);
  EXPECT_TRUE(clock.limited());
  EXPECT_NEAR(clock.left(wanted), 1000 - 50 - 10 - 20 - 1, 1);  // less what passes meanwhile
  clock.enter(RunPart::Files);
  EXPECT_NEAR(clock.left(wanted), 1000, 1);
  EXPECT_EQ(RunClock(0).left(wanted), std::numeric_limits<double>::infinity());
  EXPECT_FALSE(RunClock(0).limited());
}

}  // namespace
}  // namespace papilla::tests::clock_test
