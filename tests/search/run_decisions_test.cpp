// What a run decides between its stages, with a formula for answers: which designs go on, what the
// rest will take, what is counted and what is cut.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "base/files.h"
#include "optim/pareto.h"
#include "search/levels.h"
#include "search/stability.h"
#include "tests/search/formula_run.h"

namespace papilla::tests::run_decisions_test {
namespace {

// By depth from flat on, and contact angle.
Study two_variables(int evaluations) {
  Study study = small_study();
  study.design.finger.uncertainty.clear();
  study.variables = {study.variables[2], study.variables[3]};
  study.search.evaluations = evaluations;
  study.search.jobs = 1;
  study.search.method = "nsga2";
  return study;
}

// Straight lines in both variables; the worst is that of the deepest.
TaskAnswer lines(const TaskRequest& r) {
  const double depth = r.flat ? 0 : r.unit[0], angle = r.unit[1];
  TaskAnswer out;
  const double mean = 0.8 - 0.3 * depth + 0.1 * angle, variation = 0.5 - 0.4 * depth + 0.02 * angle;
  out.objectives = {{mean, 0.01, {mean}}, {variation, 0.01, {variation}}};
  out.worst = 0.2 + 0.1 * depth;
  out.oxide_margin = 10;
  return out;
}

bool holds(const std::vector<Evaluation>& all, const Point& unit) {
  return std::any_of(all.begin(), all.end(), [&](const Evaluation& e) { return e.unit == unit; });
}

// Half of the level between are the most promising of the search and the one with the highest worst
// modulation, the others new.
TEST(RunDecisions, TheLevelBetweenBeginsWithTheBestOfTheSearch) {
  FormulaRun a(two_variables(18), fresh_folder("decided_between"), lines);
  search_designs(a.run);
  narrow(a.run);
  const std::vector<Evaluation>& history = a.run.history.evaluations;
  std::vector<std::size_t> chosen = promising(a.run.search, history, 3);
  std::size_t steady = 0;
  double most = -1;
  for (std::size_t i : pareto_front(history)) {
    if (a.run.history.worst[i] > most) most = a.run.history.worst[i], steady = i;
  }
  if (std::find(chosen.begin(), chosen.end(), steady) == chosen.end()) chosen.push_back(steady);
  const std::vector<Point> judged = a.units(Stage::Narrow);
  ASSERT_EQ(judged.size(), 6u);
  ASSERT_LT(chosen.size(), 6u);
  for (std::size_t i = 0; i < chosen.size(); ++i)
    EXPECT_EQ(judged[i], history[chosen[i]].unit) << i;
  std::size_t known = 0;
  for (const Point& unit : judged) known += holds(history, unit);
  EXPECT_EQ(known, chosen.size());
}

// Of four designs there is a level between, of three none: finalists come from the search then.
TEST(RunDecisions, FourDesignsMakeALevelBetween) {
  for (const auto& [evaluations, between] : {std::pair{12, 4u}, {11, 3u}}) {
    FormulaRun a(two_variables(evaluations), fresh_folder("decided_four"), lines);
    search_designs(a.run);
    narrow(a.run);
    confirm(a.run);
    ASSERT_EQ(a.run.narrowed.size(), between);
    const std::vector<Evaluation>& from =
        between == 4 ? a.run.narrowed.evaluations : a.run.history.evaluations;
    std::size_t inside = 0, flat = 0;
    const std::vector<Point> confirmed = a.units(Stage::Confirm);
    for (const Point& unit : confirmed) {
      inside += holds(from, unit);
      flat += !holds(from, unit) && unit[0] == 0;
    }
    EXPECT_EQ(inside + flat, confirmed.size()) << evaluations;
    EXPECT_GE(inside, 2u);
    // What the search said of a finalist is in the user's sign.
    for (const FinalDesign& f : a.run.result.finalists) {
      EXPECT_EQ(f.searched.ok, holds(a.run.history.evaluations, f.unit));
      EXPECT_EQ(f.searched.values.size(), f.searched.ok ? 2u : 0u);
      for (const double v : f.searched.values) EXPECT_GT(v, 0);
    }
  }
}

// What is left of a search takes as long as its designs did, with what the searcher itself took for
// each, and what follows: not the start of the program again for every design.
TEST(RunDecisions, ASearchSaysWhatItsRestWillTake) {
  search::Run* run = nullptr;
  std::vector<int> done;
  FormulaRun a(two_variables(12), fresh_folder("decided_left"), lines, [&](const Progress& p) {
    ASSERT_EQ(p.stage, "search");
    EXPECT_EQ(p.total, 12);
    done.push_back(p.done);
    const double now = run->clock.seconds();
    const auto left = static_cast<std::size_t>(12 - p.done);
    const double rest = run->seconds_of_designs(left, Stage::Search),
                 next = run->seconds_from(RunPart::Narrow);
    EXPECT_GT(run->replay.spent(Stage::Search).seconds, 0);
    EXPECT_GE(p.seconds_left, (rest + next) * (1 - 1e-12));
    EXPECT_LE(p.seconds_left, rest + now / p.done * static_cast<double>(left) + next);
    EXPECT_LE(p.share, now / (now + p.seconds_left));
    EXPECT_GT(p.share, 0);
  });
  run = &a.run;
  search_designs(a.run);
  // Two at a time keep one worker busy.
  ASSERT_GE(done.size(), 3u);
  EXPECT_EQ(done[0], 2);
  EXPECT_EQ(done[1], 4);
  EXPECT_EQ(done.back(), 12);
}

// Under a limit the first design is evaluated alone: what it takes is not known.
TEST(RunDecisions, UnderALimitTheFirstDesignIsEvaluatedAlone) {
  Study study = two_variables(12);
  study.search.time = 1e6;
  std::vector<int> done;
  FormulaRun a(study, fresh_folder("decided_alone"), lines,
               [&](const Progress& p) { done.push_back(p.done); });
  search_designs(a.run);
  ASSERT_GE(done.size(), 3u);
  EXPECT_EQ(done[0], 1);
  EXPECT_EQ(done[1], 3);
  EXPECT_EQ(a.run.result.end, SearchEnd::Budget);
  EXPECT_TRUE(a.run.result.cuts.empty());
}

// A level between of too few designs for its share of the time is none; the checks are those of the
// front that there is.
TEST(RunDecisions, APartWantsWhatItsDesignsTake) {
  const auto part = [](const search::Run& run, RunPart p) {
    return run.wanted()[static_cast<std::size_t>(p)];
  };
  Study study = two_variables(12);
  for (const double time : {1e9, 1e-7}) {
    study.search.time = time;
    FormulaRun a(study, fresh_folder("decided_wanted"), lines);
    search_designs(a.run);
    const double four = a.run.seconds_of_designs(4, Stage::Narrow);
    ASSERT_GT(four, 0);
    EXPECT_DOUBLE_EQ(part(a.run, RunPart::Narrow), time > 1 ? four : 0);
    EXPECT_GT(part(a.run, RunPart::Confirm), 0);
  }
  study.search.time = 0;
  FormulaRun a(study, fresh_folder("decided_front"), lines);
  search_designs(a.run);
  narrow(a.run);
  confirm(a.run);
  std::size_t front = 0;
  for (const FinalDesign& f : a.run.result.finalists) front += !f.folder.empty();
  ASSERT_NE(front, kFinalists);
  EXPECT_DOUBLE_EQ(
      part(a.run, RunPart::Stability),
      a.run.seconds_of(front * stability_variants(a.run.problem).size(), Stage::Stability));
}

// While two of four are confirmed, one of which breaks a limit, three may be on the front.
TEST(RunDecisions, DuringTheConfirmationPartsWantWhatAllThatAreChosenMayTake) {
  FormulaRun a(two_variables(12), fresh_folder("decided_during"), lines);
  search_designs(a.run);
  const auto stability_of = [&](std::size_t designs) {
    return a.run.seconds_of(designs * stability_variants(a.run.problem).size(), Stage::Stability);
  };
  const auto wanted = [&](RunPart p) { return a.run.wanted()[static_cast<std::size_t>(p)]; };
  a.run.chosen = 4;
  EXPECT_DOUBLE_EQ(wanted(RunPart::Confirm), a.run.seconds_of_designs(4, Stage::Confirm));
  EXPECT_DOUBLE_EQ(wanted(RunPart::Stability), stability_of(4));
  a.run.result.finalists.resize(2);
  a.run.result.finalists[0].feasible = true;
  EXPECT_EQ(a.run.may_hold(), 3u);
  EXPECT_DOUBLE_EQ(wanted(RunPart::Stability), stability_of(3));
}

TEST(RunDecisions, OnlyALimitCutsAndAPartOnce) {
  Study study = two_variables(12);
  {
    FormulaRun a(study, fresh_folder("decided_uncut"), lines);
    a.run.cut(RunPart::Flat, 0, 1);
    EXPECT_TRUE(a.run.result.cuts.empty());
    EXPECT_TRUE(a.run.begin(RunPart::Flat, Stage::Confirm, true, 1e12));
    EXPECT_TRUE(a.run.fits(1e300));
  }
  study.search.time = 1e3;
  FormulaRun a(study, fresh_folder("decided_cut"), lines);
  a.run.cut(RunPart::Confirm, 2, 2);
  EXPECT_TRUE(a.run.result.cuts.empty());
  a.run.cut(RunPart::Confirm, 1, 2);
  a.run.cut(RunPart::Confirm, 0, 2);
  EXPECT_TRUE(a.run.begin(RunPart::Flat, Stage::Confirm, true, 1));
  EXPECT_FALSE(a.run.begin(RunPart::Flat, Stage::Confirm, true, 1e4));
  ASSERT_EQ(a.run.result.cuts.size(), 2u);
  EXPECT_EQ(a.run.result.cuts[0].part, RunPart::Confirm);
  EXPECT_EQ(a.run.result.cuts[0].done, 1u);
  EXPECT_EQ(a.run.result.cuts[0].of, 2u);
  EXPECT_EQ(a.run.result.cuts[1].part, RunPart::Flat);
  EXPECT_EQ(a.run.result.cuts[1].done, 0u);
  EXPECT_EQ(a.run.result.cuts[1].of, 1u);
}

// Refused is what breaks a limit of the shape; what fails otherwise was evaluated.
TEST(RunDecisions, ARefusalIsNoEvaluation) {
  Study study = small_study();  // period, diameter, depth, angle; walls of 0.4 um at least
  study.search.jobs = 1;
  FormulaRun a(study, fresh_folder("decided_refused"), lines);
  const Point good = a.run.problem.space().unit({5e-6, 3e-6, 350e-9, 1}),
              thin = a.run.problem.space().unit({5e-6, 4.8e-6, 350e-9, 1});
  search::Judgement ok, failed;
  ok.outcome.ok = true;
  EXPECT_TRUE(a.run.add_to_history(good, ok));
  EXPECT_TRUE(a.run.add_to_history(good, failed));
  EXPECT_FALSE(a.run.add_to_history(thin, failed));
  EXPECT_FALSE(a.run.add_to_history(thin, failed));
  EXPECT_EQ(a.run.result.evaluations, 2);
  EXPECT_EQ(a.run.result.failures, 1);
  EXPECT_EQ(a.run.result.refused, 2);
  EXPECT_EQ(a.run.history.size(), 4u);
}

// The tail of a scatter knows its lower from its upper end.
TEST(RunDecisions, ATailIsThatOfItsOwnScatter) {
  Study study = two_variables(12);
  study.design.environment.relative_humidity = {0.35};
  study.objective = {};
  study.objective.maximise = {parse_metric("mean(modulation)")};
  study.objective.risk = "cvar 20 %";
  study.scatter = {{"texture.depth", 20e-9}, {"surface.contact_angle", 0.02}};
  const StudyProblem problem(study);
  ASSERT_EQ(problem.tasks().size(), 5u);
  std::vector<TaskAnswer> answers(5);
  const double values[] = {0.5, 0.3, 0.62, 0.45, 0.51};  // own, both ends of the first, the second
  for (std::size_t t = 0; t < 5; ++t) answers[t].objectives = {{values[t], 0.01, {values[t]}}};
  const Risk risk = parse_risk("cvar 20 %");
  const ScatterLaw law(study.scatter, {});
  const std::vector<double> sample =
      scattered_values(risk, true, 0.5, {0.3, 0.45}, {0.62, 0.51}, law);
  const Score score = problem.score(problem.study().design, answers);
  ASSERT_TRUE(score.ok) << score.reason;
  EXPECT_NEAR(score.values[0],
              apply_risk(risk, true, sample, std::vector<double>(sample.size(), 1.0)), 1e-12);
  const std::vector<double> turned =
      scattered_values(risk, true, 0.5, {0.62, 0.51}, {0.3, 0.45}, law);
  EXPECT_GT(std::abs(apply_risk(risk, true, turned, std::vector<double>(turned.size(), 1.0)) -
                     score.values[0]),
            1e-9);
}

// A journal belongs to everything that decides its numbers, and to nothing else.
TEST(RunDecisions, WhatDecidesTheResultIsInTheKeyOfTheJournal) {
  Study study = two_variables(12);
  study.scenarios = {{"new", 1, {}}, {"worn", 2, {{"surface.contact_angle", 1.2}}}};
  study.variables[1].choices = {0.8, 1.0};
  const auto identity = [](const Study& of) { return StudyProblem(of).identity(); };
  std::set<std::string> all{identity(study)};
  const std::vector<std::function<void(Study&)>> changes{
      [](Study& s) { s.variables[0].low = 1e-9; },
      [](Study& s) { s.variables[0].high = 0.9e-6; },
      [](Study& s) {
        s.variables[0].excluded = {{0.2e-6, 0.3e-6}};
      },
      [](Study& s) {
        s.variables[0].excluded = {{0.2e-6, 0.4e-6}};
      },
      [](Study& s) {
        s.variables[1].choices = {0.8, 1.1};
      },
      [](Study& s) { std::swap(s.objective.maximise, s.objective.minimise); },
      [](Study& s) {
        s.scatter = {{"texture.depth", 20e-9}};
      },
      [](Study& s) {
        s.scatter = {{"texture.depth", 30e-9}};
      },
      [](Study& s) {
        s.scatter = {{"texture.diameter", 20e-9}};
      },
      [](Study& s) { s.objective.risk = "worst"; },
      [](Study& s) { s.constraints[0].limit *= 1.1; },
      [](Study& s) { s.scenarios[1].weight = 3; },
      [](Study& s) { s.scenarios[1].name = "old"; },
      [](Study& s) { s.scenarios[1].set[0].value = 1.3; },
      [](Study& s) { s.design.finger.load *= 2; },
      [](Study& s) { std::get<HoleArray>(s.design.texture.kind).period *= 1.1; },
      [](Study& s) { s.search.method = "auto"; },
      [](Study& s) { s.search.seed = 5; },
      [](Study& s) { s.search.drafts = 7; }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Study other = study;
    changes[i](other);
    EXPECT_TRUE(all.insert(identity(other)).second) << i;
  }
  study.search.evaluations = 99, study.search.time = 5, study.search.jobs = 3;
  EXPECT_FALSE(all.insert(identity(study)).second);
}

// By its content: a copy, or a map that was written once more, continues the run.
TEST(RunDecisions, WhatIsInAMapIsInTheKeyOfTheJournal) {
  Study study = two_variables(12);
  const auto identity = [&](const std::string& file, const std::string& bytes) {
    study.design.finger.skin.map = temporary(file);
    write_bytes(study.design.finger.skin.map, bytes);
    return StudyProblem(study).identity();
  };
  const std::string first = identity("a.npy", "one map");
  EXPECT_NE(first, identity("a.npy", "another"));
  EXPECT_EQ(first, identity("b.npy", "one map"));
}

}  // namespace
}  // namespace papilla::tests::run_decisions_test
