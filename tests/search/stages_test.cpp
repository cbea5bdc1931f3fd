// The stages of a run with formulas for answers: which designs are asked of at each, what their
// numbers decide, and that a run goes on from its journal. No contact is solved.
#include "search/stages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <tuple>

#include "base/constants.h"
#include "base/files.h"
#include "base/watch.h"
#include "config/describe.h"
#include "search/advice.h"
#include "search/building.h"
#include "search/levels.h"
#include "search/records.h"
#include "search/rounding.h"
#include "tests/search/formula_run.h"
#include "tests/search/small_study.h"

namespace papilla::tests::stages_test {
namespace {

using Formula = TaskFormula;
using Requests = std::vector<TaskRequest>;

// Two variables: depth from flat on, and contact angle, of which 50 deg is the study's own.
Study two_variables() {
  Study study = small_study();
  study.design.finger.uncertainty.clear();
  study.variables = {study.variables[2], study.variables[3]};
  study.search.evaluations = 15;
  study.search.jobs = 1;
  study.search.rounding = 10e-9;
  return study;
}
Study evolved() {
  Study study = two_variables();
  study.search.method = "nsga2";
  study.search.evaluations = 12;
  return study;
}
constexpr double kOwnAngle = 0.4;  // (50 - 30) / (80 - 30)

// Straight lines in both variables, each level with an offset of its own.
TaskAnswer lines(const TaskRequest& r) {
  const double depth = r.flat ? 0 : r.unit[0], angle = r.unit[1];
  const double offset = r.stage == Stage::Search ? 0.04 : r.stage == Stage::Narrow ? 0.02 : 0;
  TaskAnswer out;
  const double mean = 0.8 - 0.3 * depth + 0.1 * angle + offset,
               variation = 0.5 - 0.4 * depth + 0.02 * angle;
  out.objectives = {{mean, 0.01, {mean, mean}}, {variation, 0.01, {variation, variation}}};
  out.worst = 0.2 + 0.1 * depth;
  out.oxide_margin = 10;
  return out;
}

// A run that a formula answers.
struct AnsweredRun {
  AnsweredRun(const Study& of, const std::string& folder, const Formula& formula,
              bool resume = false, const std::atomic<bool>* stop = nullptr,
              std::function<void(const Progress&)> progress = {}, bool finish = false,
              const std::string& pick = "", std::size_t workers = 1)
      : study(of),
        options{.folder = folder,
                .resume = resume,
                .progress = std::move(progress),
                .stop = stop,
                .pick = pick,
                .finish = finish},
        run(study, options, mpi, std::make_unique<FormulaWorker>(formula, asked, workers)) {}
  AnsweredRun(const AnsweredRun&) = delete;
  AnsweredRun& operator=(const AnsweredRun&) = delete;

  bool whole() {
    try {
      search_designs(run);
      narrow(run);
      confirm(run);
      check(run);
    } catch (const WorkStopped&) {
      return false;
    }
    run.replay.end(run.result.end == SearchEnd::Exhausted);
    return true;
  }
  std::ptrdiff_t count(Stage stage, bool flat = false) const {
    return std::count_if(asked.begin(), asked.end(),
                         [&](const TaskRequest& r) { return r.stage == stage && r.flat == flat; });
  }

  const Study study;
  const OptimiseOptions options;
  const MpiSession mpi;
  Requests asked;
  Run run;
};

// One that several tests read.
const AnsweredRun& whole_run() {
  static AnsweredRun run(two_variables(), fresh_folder("stages"), lines);
  static const bool done = run.whole();
  EXPECT_TRUE(done);
  return run;
}

TEST(Stages, EachAsksAsManyDesignsAsItSays) {
  const AnsweredRun& a = whole_run();
  const OptimiseResult& result = a.run.result;
  EXPECT_EQ(result.evaluations, 15);
  EXPECT_EQ(result.failures, 0);
  EXPECT_EQ(result.end, SearchEnd::Budget);
  EXPECT_EQ(a.count(Stage::Search), 15);
  EXPECT_EQ(a.count(Stage::Draft), 0);
  EXPECT_EQ(a.run.narrowed.size(), narrowings(a.run.search));
  EXPECT_EQ(a.count(Stage::Narrow), 5);  // a third
  ASSERT_GE(result.finalists.size(), 3u);
  EXPECT_LE(result.finalists.size(), kFinalists + 1);
  EXPECT_EQ(a.count(Stage::Confirm), static_cast<std::ptrdiff_t>(result.finalists.size()));
  const auto front = std::count_if(result.finalists.begin(), result.finalists.end(),
                                   [](const FinalDesign& f) { return f.on_front; });
  EXPECT_EQ(a.count(Stage::Stability),
            front * static_cast<std::ptrdiff_t>(stability_variants(a.run.problem).size()));
  EXPECT_TRUE(result.cuts.empty());
  EXPECT_EQ(a.run.confirm_seconds, 0);
  // Finalists come from the level between; flat is the best in the first objective anyhow.
  const JudgedDesigns& between = a.run.narrowed;
  for (const FinalDesign& f : result.finalists) {
    EXPECT_TRUE(std::any_of(between.evaluations.begin(), between.evaluations.end(),
                            [&](const Evaluation& e) { return e.unit == f.unit; }));
    if (f.searched.ok) {
      EXPECT_NEAR(f.searched.values[0], f.confirmed.values[0] + 0.04, 1e-12);
      EXPECT_NEAR(f.searched.values[1], f.confirmed.values[1], 1e-12);
    }
  }
}

// Answers scatter from design to design: what is gained beside a judged one is luck.
TEST(Stages, TheLevelBetweenAsksOfNoDesignBesideAJudgedOne) {
  const Formula scattered = [](const TaskRequest& r) {
    TaskAnswer out = lines(r);
    const double luck = 0.03 * std::sin(1e4 * (r.unit[0] + 2 * r.unit[1]));
    TaskObjective& variation = out.objectives[1];
    variation.value += luck;
    for (double& point : variation.points) point += luck;
    return out;
  };
  Study study = two_variables();
  study.search.evaluations = 60;
  AnsweredRun a(study, fresh_folder("stages_apart"), scattered);
  search_designs(a.run);
  narrow(a.run);
  const std::vector<Evaluation>& searched = a.run.history.evaluations;
  const std::vector<Evaluation>& between = a.run.narrowed.evaluations;
  ASSERT_EQ(between.size(), 20u);
  int fresh = 0;
  for (std::size_t i = 0; i < between.size(); ++i) {
    const Point& u = between[i].unit;
    if (std::any_of(searched.begin(), searched.end(),
                    [&](const Evaluation& e) { return e.unit == u; }))
      continue;
    ++fresh;
    for (std::size_t j = 0; j < i; ++j) {
      const Point& v = between[j].unit;
      EXPECT_GT(std::max(std::abs(u[0] - v[0]), std::abs(u[1] - v[1])), 0.03) << i << ", " << j;
    }
  }
  EXPECT_GT(fresh, 5);
}

// Where flat is nowhere on the front, the first finalist's own surface is confirmed without its
// texture, second of all.
TEST(Stages, TheFlatSurfaceIsConfirmedSecond) {
  AnsweredRun a(evolved(), fresh_folder("stages_second"), [](const TaskRequest& r) {
    TaskAnswer out = lines(r);
    out.objectives[0].value += (r.flat ? 0 : 0.6 * r.unit[0]);  // a texture is better in both
    return out;
  });
  search_designs(a.run);
  narrow(a.run);
  confirm(a.run);
  std::vector<Point> confirmed;
  for (const TaskRequest& r : a.asked) {
    if (r.stage == Stage::Confirm) confirmed.push_back(r.unit);
  }
  ASSERT_GE(confirmed.size(), 2u);
  EXPECT_GT(confirmed[0][0], 0);
  EXPECT_EQ(confirmed[1][0], 0);
  double best = 0, angle = 0;  // of the finalists by the level between
  for (const Evaluation& e : a.run.narrowed.evaluations) {
    const bool chosen = std::find(confirmed.begin(), confirmed.end(), e.unit) != confirmed.end();
    if (chosen && e.outcome.objectives[0] < best) best = e.outcome.objectives[0], angle = e.unit[1];
  }
  EXPECT_EQ(confirmed[1][1], angle);
}

// Over at once: one design is judged and confirmed for a fiftieth of its price, the rest is cut.
TEST(Stages, WithoutTimeOneDesignIsConfirmedAndTheRestIsSaidToBeCut) {
  Study study = two_variables();
  study.search.time = 1e-6;
  study.search.rounding = 0;
  AnsweredRun a(study, fresh_folder("stages_clock"), lines);
  ASSERT_TRUE(a.whole());
  const OptimiseResult& result = a.run.result;
  EXPECT_EQ(result.end, SearchEnd::Clock);
  EXPECT_EQ(a.asked.size(), 2u);
  EXPECT_EQ(result.finalists.size(), 1u);
  EXPECT_TRUE(result.finalists[0].on_front);
  EXPECT_FALSE(result.flat || result.flat_before);
  ASSERT_TRUE(result.build);  // as it was searched
  EXPECT_EQ(result.build->made.unit, result.finalists[0].unit);
  EXPECT_TRUE(result.sensitivity.empty());
  EXPECT_NEAR(a.run.confirm_seconds, 0.02 * task_price(a.run.problem, Stage::Confirm),
              1e-9 * a.run.confirm_seconds);
  EXPECT_EQ(a.asked[1].most_seconds, a.run.confirm_seconds);
  EXPECT_EQ(result.confirmed_with.skins, 4);
  const std::vector<std::tuple<RunPart, std::size_t, std::size_t>> expected{
      {RunPart::Search, 1, 15},   {RunPart::Narrow, 0, 5}, {RunPart::Confirm, 1, 2},
      {RunPart::Stability, 0, 1}, {RunPart::Flat, 0, 1},   {RunPart::Sensitivity, 0, 1}};
  ASSERT_EQ(result.cuts.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_EQ(std::tuple(result.cuts[i].part, result.cuts[i].done, result.cuts[i].of), expected[i])
        << i;
}

TEST(Stages, TheConfirmedNumbersDecideTheFrontAndItsOrder) {
  const AnsweredRun& a = whole_run();
  const OptimiseResult& result = a.run.result;
  EXPECT_TRUE(result.any_feasible);
  EXPECT_TRUE(result.never_kept.empty());
  std::size_t front = 0;
  double worst = 0;
  for (const FinalDesign& f : result.finalists) {
    const bool beaten =
        std::any_of(result.finalists.begin(), result.finalists.end(), [&](const FinalDesign& g) {
          const std::vector<double>&x = f.confirmed.values, &y = g.confirmed.values;
          return y[0] >= x[0] && y[1] <= x[1] && y != x;
        });
    EXPECT_EQ(f.on_front, !beaten);
    EXPECT_TRUE(f.feasible);
    EXPECT_EQ(f.folder, f.on_front ? "front/0" + std::to_string(front + 1) : "");
    if (&f != &result.finalists.front() && f.on_front) {
      EXPECT_LE(f.confirmed.values[0], (&f - 1)->confirmed.values[0]);
      EXPECT_TRUE((&f - 1)->on_front);
    }
    front += f.on_front;
    if (f.on_front) worst = std::max(worst, f.confirmed.worst);
  }
  ASSERT_GE(front, 2u);
  EXPECT_EQ(result.finalists[result.best].confirmed.worst, worst);
  // Along the lines what one gains of the first it loses of the second.
  const int variants = static_cast<int>(result.stability.variants.size());
  for (const int times : result.stability.times_on_front) EXPECT_EQ(times, variants);
}

TEST(Stages, TheChecksSayWhatTheTextureAndTheFinishDo) {
  const AnsweredRun& a = whole_run();
  const OptimiseResult& result = a.run.result;
  const FinalDesign& best = result.finalists[result.best];
  ASSERT_TRUE(result.flat);
  EXPECT_NEAR(result.flat->values[0], 0.8 + 0.1 * best.unit[1], 1e-12);
  ASSERT_EQ(result.flat_before.has_value(),
            best.unit[1] != a.run.problem.space().unit_of_study()[1]);
  EXPECT_EQ(a.count(Stage::Confirm, true), result.flat_before ? 2 : 1);
  if (result.flat_before) {
    EXPECT_NEAR(result.flat_before->values[0], 0.8 + 0.1 * kOwnAngle, 1e-9);
  }
  // Straight lines: nine tenths of the first objective's change are the depth's.
  ASSERT_EQ(result.sensitivity.size(), 2u);
  for (const VariableSensitivity& s : result.sensitivity) {
    const bool depth = s.variable == 0;
    EXPECT_NEAR(s.share[0], depth ? 0.9 : 0.1, 1e-9);
    EXPECT_NEAR(s.change[0], 0.05 * (depth ? -0.3 : 0.1), 1e-9);
    EXPECT_NEAR(s.change[1], 0.05 * (depth ? -0.4 : 0.02), 1e-9);
  }
  ASSERT_TRUE(result.build);
  const FinalDesign& made = result.build->made;
  const double depth = made.flat ? 0 : made.unit[0];
  EXPECT_NEAR(made.confirmed.values[0], 0.8 - 0.3 * depth + 0.1 * made.unit[1], 1e-12);
  EXPECT_TRUE(made.feasible);
  // A flat surface has no model of its neighbourhood, but neighbours.
  EXPECT_EQ(a.count(Stage::Rounding, made.flat), static_cast<int>(result.build->judged));
  EXPECT_LE(result.build->judged, kJudgedOnGrid);
  EXPECT_TRUE(result.build->on_grid);
}

// A textureless surface of a larger angle is the better one.
TaskAnswer smooth(const TaskRequest& r, double angle) {
  const double depth = r.flat ? 0 : r.unit.front();
  TaskAnswer out;
  const double mean = 0.8 - 0.3 * depth + 0.1 * angle, variation = 0.5 + 0.4 * depth - 0.03 * angle;
  out.objectives = {{mean, 0.001, {mean, mean}}, {variation, 0.001, {variation, variation}}};
  out.worst = 0.2 - 0.1 * depth;
  out.oxide_margin = 10;
  return out;
}

// Its file has a better finish than its space: that is what is compared with and left as it is,
// from a journal too.
TEST(Stages, TheStudysOwnSurfaceMayLieBesideTheSpace) {
  Study study = evolved();
  const double own = study.design.surface.contact_angle;
  study.variables[1].low = own + 0.1;
  const Formula formula = [](const TaskRequest& r) {
    return smooth(r, r.unit[1] == DesignSpace::kBeside ? 2 : r.unit[1]);
  };
  const std::string folder = fresh_folder("stages_beside");
  for (const bool again : {false, true}) {
    AnsweredRun a(study, folder, formula, again);
    ASSERT_TRUE(a.whole());
    EXPECT_EQ(a.asked.empty(), again);
    const OptimiseResult& result = a.run.result;
    ASSERT_TRUE(result.flat_before);
    EXPECT_NEAR(result.flat_before->values[0], 1.0, 1e-12);
    EXPECT_EQ(changed_finish(a.run.problem, result), (std::vector<std::size_t>{1}));
    EXPECT_EQ(advice_of(a.run.problem, result), Advice::LeaveFlat);
    ASSERT_TRUE(result.build);
    EXPECT_EQ(result.build->made.design.surface.contact_angle, own);
    EXPECT_FALSE(facts(result.build->made.design.texture).relief.present);
    EXPECT_NEAR(result.build->made.confirmed.values[0], 1.0, 1e-12);
    EXPECT_EQ(result.build->judged, 0u);
    EXPECT_TRUE(result.at_bound.empty());
    EXPECT_TRUE(result.sensitivity.empty());
  }
}

// Flat glass on another patch differs by what its skins scatter: what the finish does is judged on
// the patch of the best texture, with its finish and with that of the study, here beside the space.
TEST(Stages, TheFinishIsComparedOnThePatchOfTheBestTexture) {
  Study study = evolved();
  study.variables[1].low = study.design.surface.contact_angle + 0.1;
  AnsweredRun a(study, fresh_folder("stages_patch"), lines);
  ASSERT_TRUE(a.whole());
  const Point best = a.run.result.finalists[a.run.result.best].unit;
  ASSERT_NE(best[0], a.run.problem.space().unit_of_study()[0]);
  ASSERT_TRUE(a.run.result.flat && a.run.result.flat_before);
  std::vector<Point> flat;
  for (const TaskRequest& r : a.asked) {
    if (r.stage == Stage::Confirm && r.flat) flat.push_back(r.unit);
  }
  EXPECT_EQ(flat, (std::vector<Point>{best, {best[0], DesignSpace::kBeside}}));
}

// Nothing of the study's own surface was searched: it is built as its file says, though numbers of
// the grid beside it may be judged better.
TEST(Stages, TheStudysOwnSurfaceIsNotRounded) {
  AnsweredRun a(evolved(), fresh_folder("stages_own"), [](const TaskRequest& r) {
    TaskAnswer out = smooth(r, kOwnAngle);
    if (r.stage == Stage::Rounding) out.objectives[0].value += 0.5;
    return out;
  });
  ASSERT_TRUE(a.whole());
  const OptimiseResult& result = a.run.result;
  ASSERT_EQ(advice_of(a.run.problem, result), Advice::LeaveFlat);
  EXPECT_EQ(a.count(Stage::Rounding, true) + a.count(Stage::Rounding, false), 0);
  ASSERT_TRUE(result.build);
  EXPECT_TRUE(result.build->on_grid);
  EXPECT_NEAR(result.build->made.design.surface.contact_angle, a.study.design.surface.contact_angle,
              1e-12);
}

// Of a study without texture: what its finish changes is against its own surface.
TEST(Stages, AFlatStudyIsComparedWithItsOwnSurface) {
  Study study = evolved();
  study.design.texture = Texture{};
  study.variables = {study.variables[1]};
  AnsweredRun a(study, fresh_folder("stages_flat_study"), [](const TaskRequest& r) {
    TaskRequest flat = r;
    flat.flat = true;
    return smooth(flat, r.unit[0]);
  });
  ASSERT_TRUE(a.whole());
  const OptimiseResult& result = a.run.result;
  EXPECT_FALSE(result.flat);  // there is no texture to leave out
  ASSERT_TRUE(result.flat_before);
  EXPECT_NEAR(result.flat_before->values[0], 0.8 + 0.1 * kOwnAngle, 1e-9);
  EXPECT_EQ(a.count(Stage::Confirm, true), 1);
  EXPECT_EQ(advice_of(a.run.problem, result), Advice::Finish);
}

// The deepest design, which is picked first, has a flat surface as good as itself: that is built.
// Of another one the texture is, whose rounding no journal has.
TEST(Stages, ARunThatIsDoneJudgesWhatIsPickedNow) {
  constexpr double kDeep = 0.6, kShallow = 0.05;
  const Formula formula = [](const TaskRequest& r) {
    TaskAnswer out = lines(r);
    if (r.flat && r.unit[0] > kDeep) out.objectives[0].value = 2, out.objectives[1].value = 0;
    return out;
  };
  const std::string folder = fresh_folder("stages_picked");
  std::size_t other = 0;
  {
    AnsweredRun first(evolved(), folder, formula);
    ASSERT_TRUE(first.whole());
    const std::vector<FinalDesign>& finalists = first.run.result.finalists;
    EXPECT_GT(finalists[first.run.result.best].unit[0], kDeep);
    EXPECT_TRUE(recommended_design(first.run.problem, first.run.result).flat);
    EXPECT_EQ(first.count(Stage::Rounding, false), 0);
    const Point own = first.run.problem.space().unit_of_study();  // on the grid already
    while (other < finalists.size() &&
           (finalists[other].unit[0] < kShallow || finalists[other].unit[0] > kDeep ||
            finalists[other].unit == own))
      ++other;
    ASSERT_LT(other, finalists.size());
    ASSERT_TRUE(finalists[other].on_front);
  }
  AnsweredRun second(evolved(), folder, formula, true, nullptr, {}, false,
                     std::to_string(other + 1));
  ASSERT_TRUE(second.whole());
  EXPECT_EQ(second.run.result.best, other);
  EXPECT_GT(second.count(Stage::Rounding), 0);
  EXPECT_GT(second.count(Stage::Sensitivity), 0);
  ASSERT_TRUE(second.run.result.build);
  EXPECT_FALSE(second.run.result.build->made.flat);
  EXPECT_FALSE(second.run.result.sensitivity.empty());
}

// Both objectives are best in the middle of the space, on no place of the grid.
TaskAnswer bowl(const TaskRequest& r) {
  const double depth = r.flat ? 0 : r.unit[0], angle = r.unit[1];
  const double off = square(depth - 0.5372) + 0.3 * square(angle - 0.6131);
  TaskAnswer out;
  const double mean = 0.8 - off, variation = 0.3 + off;
  out.objectives = {{mean, 0.001, {mean, mean}}, {variation, 0.001, {variation, variation}}};
  out.worst = mean;
  out.oxide_margin = 10;
  return out;
}

// Of the nearest design of the grid and the best ones by the model the best is built.
TEST(Stages, TheBestOfTheGridIsBuiltNotTheNearest) {
  AnsweredRun a(evolved(), fresh_folder("stages_best_of_grid"), bowl);
  ASSERT_TRUE(a.whole());
  const BuiltDesign& build = *a.run.result.build;
  const FinalDesign searched = recommended_design(a.run.problem, a.run.result);
  ASSERT_TRUE(build.nearest);
  ASSERT_FALSE(searched.flat);
  const auto gain = [&](const FinalDesign& of) {
    const std::vector<double>&before = searched.confirmed.values, &here = of.confirmed.values;
    return std::min((here[0] - before[0]) / before[0], (before[1] - here[1]) / before[1]);
  };
  EXPECT_GT(gain(build.made), gain(*build.nearest));
  EXPECT_EQ(build.judged, kJudgedOnGrid);
  EXPECT_NE(build.made.unit, build.nearest->unit);
}

// Of the grid the nearest that keeps its look is built where there is no time to judge any: here
// the nearest is deeper than the searched one, which has just the haze that is allowed.
TEST(Stages, WithoutTimeWhatIsBuiltKeepsItsLook) {
  Study study = two_variables();
  study.search.time = 1e-6;
  const std::vector<double> searched{302.6e-9, 60 * kPi / 180};
  const auto haze_of = [&](double depth) {
    Design design = study.design;
    set_number(design, "texture.depth", depth);
    return appearance_of(design).haze;
  };
  const double allowed = haze_of(searched[0]) * (1 + 1e-9);
  ASSERT_GT(haze_of(303e-9), allowed);
  study.constraints = {read_constraint("haze", allowed)};
  AnsweredRun a(study, fresh_folder("stages_look"), lines);
  FinalDesign recommended;
  recommended.unit = a.run.problem.space().unit(searched);
  recommended.design = a.run.problem.space().design(recommended.unit);
  recommended.confirmed = a.run.problem.score(
      recommended.design, {lines({Stage::Confirm, 0, false, recommended.unit})});
  recommended.feasible = true;
  const BuiltDesign build = built_of(a.run, recommended);
  EXPECT_TRUE(a.asked.empty());
  EXPECT_TRUE(build.on_grid);
  EXPECT_TRUE(build.widened);
  EXPECT_NE(build.made.unit, recommended.unit);
  EXPECT_LE(appearance_of(build.made.design).haze, allowed);
}

// No design of the grid keeps the limit that the searched one keeps by a hair: it is built as
// searched.
TEST(Stages, WhatTheGridWouldBreakIsBuiltAsSearched) {
  Study study = evolved();
  study.constraints = {read_constraint("worst(modulation)", 0.2)};
  AnsweredRun a(study, fresh_folder("stages_off_grid"), [](const TaskRequest& r) {
    TaskAnswer out = bowl(r);
    out.limited = {r.stage == Stage::Rounding ? 0.19 : 0.21};
    out.limited_errors = {0};
    return out;
  });
  ASSERT_TRUE(a.whole());
  const BuiltDesign& build = *a.run.result.build;
  EXPECT_FALSE(build.on_grid);
  EXPECT_TRUE(build.made.feasible);
  EXPECT_EQ(build.made.unit, recommended_design(a.run.problem, a.run.result).unit);
  EXPECT_EQ(build.judged, kMostJudgedOnGrid);
  ASSERT_TRUE(build.nearest);
  EXPECT_FALSE(build.nearest->feasible);
}

// A number on the way to a result has its unit, and the level that it is of.
TEST(Stages, TellTheBestSoFarInItsUnitAtItsLevel) {
  Study study = evolved();
  study.objective = {};
  study.objective.maximise = {parse_metric("mean(modulation)")};
  study.objective.minimise = {parse_metric("mean(friction)")};
  std::string last;
  AnsweredRun a(study, fresh_folder("stages_units"), lines, false, nullptr,
                [&](const Progress& p) { last = p.best; });
  ASSERT_TRUE(a.whole());
  EXPECT_NE(last.find(": mean(modulation) "), std::string::npos) << last;
  EXPECT_TRUE(last.ends_with(" mN (search level)")) << last;
}

// The one period of the grid leaves no wall: nothing is judged, and the grid is not said to be
// kept.
TEST(Stages, WhatHasNoShapeOnTheGridIsBuiltAsSearched) {
  Study study = evolved();
  study.variables[0] = small_study().variables[0];  // the period
  study.variables[0].low = 3e-6, study.variables[0].high = 4.5e-6;
  study.design.texture.kind = HoleArray{.period = 4e-6, .diameter = 3e-6};
  study.search.rounding = 3e-6;
  study.constraints = {read_constraint("min_wall", 0.4e-6)};
  AnsweredRun a(study, fresh_folder("stages_no_shape"), bowl);
  ASSERT_TRUE(a.whole());
  const BuiltDesign& build = *a.run.result.build;
  EXPECT_FALSE(build.on_grid);
  EXPECT_FALSE(build.nearest);
  EXPECT_EQ(build.judged, 0u);
  EXPECT_EQ(build.made.unit, recommended_design(a.run.problem, a.run.result).unit);
}

// Interrupted anywhere, and continued: the same answers to the same questions, none asked twice.
void expect_to_go_on(std::size_t after) {
  static AnsweredRun straight(evolved(), fresh_folder("stages_straight"), lines);
  static const bool done = straight.whole();
  ASSERT_TRUE(done);
  const std::string folder = fresh_folder("stages_continued");
  Requests asked;
  std::atomic<bool> stop{false};
  {
    std::size_t answered = 0;
    AnsweredRun first(
        evolved(), folder,
        [&](const TaskRequest& r) {
          stop = ++answered >= after;
          return lines(r);
        },
        false, &stop);
    EXPECT_FALSE(first.whole());
    asked = first.asked;
    EXPECT_EQ(asked.size(), after);
  }
  AnsweredRun second(evolved(), folder, lines, true);
  ASSERT_TRUE(second.whole());
  asked.insert(asked.end(), second.asked.begin(), second.asked.end());
  EXPECT_EQ(asked, straight.asked);
  const OptimiseResult &one = straight.run.result, &other = second.run.result;
  EXPECT_EQ(other.evaluations, 12);
  EXPECT_EQ(other.best, one.best);
  ASSERT_EQ(other.finalists.size(), one.finalists.size());
  for (std::size_t i = 0; i < one.finalists.size(); ++i) {
    EXPECT_EQ(other.finalists[i].unit, one.finalists[i].unit);
    EXPECT_EQ(other.finalists[i].folder, one.finalists[i].folder);
  }
}

TEST(Stages, ASearchThatIsContinuedAsksOnlyWhatIsLeft) { expect_to_go_on(4); }
TEST(Stages, ALevelBetweenThatIsContinuedAsksOnlyWhatIsLeft) { expect_to_go_on(14); }
TEST(Stages, AConfirmationThatIsContinuedAsksOnlyWhatIsLeft) { expect_to_go_on(17); }

// Interrupted after four of twelve designs: those four are judged again and confirmed.
TEST(Stages, ASearchThatIsToFinishAsksForNoMoreDesigns) {
  const std::string folder = fresh_folder("stages_finished");
  std::atomic<bool> stop{false};
  {
    AnsweredRun first(
        evolved(), folder,
        [&, answered = 0](const TaskRequest& r) mutable {
          stop = ++answered >= 4;
          return lines(r);
        },
        false, &stop);
    EXPECT_FALSE(first.whole());
  }
  for (bool again : {false, true}) {  // and so it stays
    AnsweredRun last(evolved(), folder, lines, true, nullptr, {}, true);
    ASSERT_TRUE(last.whole());
    EXPECT_EQ(last.run.result.evaluations, 4);
    EXPECT_EQ(last.run.result.end, SearchEnd::Asked);
    EXPECT_TRUE(last.run.result.cuts.empty());
    EXPECT_TRUE(last.run.result.has_best());
    EXPECT_EQ(last.count(Stage::Search), 0);
    EXPECT_EQ(last.asked.empty(), again);
  }
  AnsweredRun none(evolved(), fresh_folder("stages_finished_at_once"), lines, false, nullptr, {},
                   true);
  ASSERT_TRUE(none.whole());
  EXPECT_EQ(none.run.result.evaluations, 1);  // one there must be
}

TEST(Stages, ARunThatIsDoneAsksNothingMore) {
  const std::string folder = fresh_folder("stages_done");
  {
    AnsweredRun first(evolved(), folder, lines);
    ASSERT_TRUE(first.whole());
  }
  AnsweredRun again(evolved(), folder, lines, true);
  ASSERT_TRUE(again.whole());
  EXPECT_TRUE(again.asked.empty());
  EXPECT_EQ(again.run.result.end, SearchEnd::Budget);
  EXPECT_EQ(again.run.replay.evaluated(), 12);
  const auto last = again.run.replay.next();
  ASSERT_TRUE(last);
  EXPECT_EQ(last->stage, Stage::Done);
}

// Another version may have taken other steps at the end: what it did not ask is asked, and no more.
TEST(Stages, ARunWhoseVersionTookFewerStepsIsGoneOnFrom) {
  const std::string folder = fresh_folder("stages_steps"), other = fresh_folder("stages_fewer");
  const Study study = evolved();
  {
    AnsweredRun first(study, folder, lines);
    ASSERT_TRUE(first.whole());
  }
  const StudyProblem problem(study);
  const Journal all(Folder::made(folder), kJournalName, journal_key(problem), true);
  std::ptrdiff_t steps = 0;
  {
    Journal fewer(Folder::made(other), kJournalName, journal_key(problem), false);
    for (const JournalRecord& record : all.records()) {
      const bool step = decode_request(record.key)->stage == Stage::Sensitivity;
      // The design itself, which comes first, and every other step.
      if (!step || steps++ % 2 == 0) fewer.append(record);
    }
  }
  ASSERT_GE(steps, 3);
  AnsweredRun again(study, other, lines, true);
  ASSERT_TRUE(again.whole());
  EXPECT_EQ(again.count(Stage::Sensitivity), steps / 2);
  EXPECT_EQ(static_cast<std::ptrdiff_t>(again.asked.size()), steps / 2);
  AnsweredRun same(study, folder, lines, true);
  ASSERT_TRUE(same.whole());
  ASSERT_EQ(again.run.result.sensitivity.size(), same.run.result.sensitivity.size());
  for (std::size_t k = 0; k < same.run.result.sensitivity.size(); ++k)
    EXPECT_EQ(again.run.result.sensitivity[k].change, same.run.result.sensitivity[k].change);
}

// Of two choices there are two designs; a journal knows why the search ended.
TEST(Stages, ASearchThatKnowsEveryChoiceIsExhausted) {
  Study study = two_variables();
  const double own = study.design.surface.contact_angle;
  study.variables = {study.variables[1]};
  study.variables[0].choices = {own, own + 0.2};
  study.search.evaluations = 9;
  const Formula formula = [](const TaskRequest& r) {
    return lines({r.stage, r.task, false, {0.5, r.unit[0]}});
  };
  const std::string folder = fresh_folder("stages_exhausted");
  for (const bool again : {false, true}) {
    AnsweredRun a(study, folder, formula, again);
    ASSERT_TRUE(a.whole());
    EXPECT_EQ(a.run.result.end, SearchEnd::Exhausted);
    EXPECT_EQ(a.run.result.evaluations, 2);
    EXPECT_EQ(a.asked.empty(), again);
  }
}

// Of three choices a population has each many times.
Study three_choices() {
  Study study = two_variables();
  const double own = study.design.surface.contact_angle;
  study.variables = {study.variables[1]};
  study.variables[0].choices = {own, own + 0.2, own + 0.4};
  study.search.method = "nsga2";
  study.search.evaluations = 60;
  return study;
}
TaskAnswer chosen_lines(const TaskRequest& r) {
  return lines({r.stage, r.task, false, {0.5, r.unit[0]}});
}

TEST(Stages, ADesignThatIsAskedOfAgainIsJudgedOnce) {
  const std::string folder = fresh_folder("stages_once");
  for (const bool again : {false, true}) {
    AnsweredRun a(three_choices(), folder, chosen_lines, again);
    ASSERT_TRUE(a.whole());
    EXPECT_EQ(a.count(Stage::Search), again ? 0 : 3);
    EXPECT_EQ(a.run.result.end, SearchEnd::Exhausted);
    EXPECT_EQ(a.run.result.evaluations, 3);
    EXPECT_EQ(a.run.history.size(), 3u);
  }
}

// The journal of a search that judged a design each time is gone on with as it was begun.
TEST(Stages, ASearchThatJudgedDesignsAgainGoesOn) {
  Study study = three_choices();
  study.search.evaluations = 15;
  const std::string path = fresh_folder("stages_again");
  std::size_t first = 0;
  {
    AnsweredRun none(study, path, chosen_lines);
    const std::vector<Point> asked = make_searcher(none.run.method, none.run.search)->ask();
    first = asked.size();
    std::filesystem::remove(std::filesystem::path(path) / kJournalName);
    Journal journal(Folder::made(path), kJournalName, journal_key(none.run.problem), false);
    for (const Point& unit : asked)
      journal.append({encode(TaskRequest{Stage::Search, 0, false, unit}),
                      encode(judged_at(Stage::Search, none.run, chosen_lines, unit))});
  }
  ASSERT_GT(first, 3u);
  ASSERT_LT(first, 15u);
  AnsweredRun second(study, path, chosen_lines, true);
  search_designs(second.run);
  EXPECT_EQ(second.run.result.evaluations, 15);
  EXPECT_EQ(second.asked.size(), 15 - first);
}

// On fresh skins every film is too weak: one more than the finalists is confirmed, none twice, and
// the least bad is what there is.
TEST(Stages, WhereNothingHoldsSaferDesignsAreConfirmed) {
  AnsweredRun a(evolved(), fresh_folder("stages_none"), [](const TaskRequest& r) {
    TaskAnswer out = lines(r);
    const bool sure = r.stage == Stage::Confirm;
    out.oxide_margin = sure ? 1.5 + 0.1 * r.unit[1] : 2.5;
    return out;
  });
  search_designs(a.run);
  narrow(a.run);
  confirm(a.run);
  const OptimiseResult& result = a.run.result;
  EXPECT_FALSE(result.any_feasible);
  ASSERT_EQ(result.finalists.size(), kFinalists + 1);
  double least = 0;
  int best = 0;
  for (std::size_t i = 0; i < result.finalists.size(); ++i) {
    const FinalDesign& f = result.finalists[i];
    EXPECT_FALSE(f.feasible || f.on_front);
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(f.unit, result.finalists[j].unit);
    least = std::max(least, f.confirmed.oxide_margin);
    best += f.folder == "best";
  }
  EXPECT_EQ(best, 1);
  EXPECT_EQ(result.finalists.front().folder, "best");
  EXPECT_EQ(result.finalists.front().confirmed.oxide_margin, least);
}

// Numbers scatter from design to design: of many that are alike one would keep the limit by luck.
TEST(Stages, WhereNothingHoldsNoDesignBesideOneThatFailedIsConfirmed) {
  AnsweredRun a(evolved(), fresh_folder("stages_beside"), [](const TaskRequest& r) {
    TaskAnswer out = lines(r);
    const double luck = 0.02 * std::sin(1e4 * (r.unit[0] + 2 * r.unit[1]));
    out.oxide_margin = (r.stage == Stage::Confirm ? 1 : 2.5) + 0.1 * r.unit[1] + luck;
    return out;
  });
  search_designs(a.run);
  narrow(a.run);
  confirm(a.run);
  std::vector<Point> confirmed;
  for (const TaskRequest& r : a.asked) {
    if (r.stage == Stage::Confirm) confirmed.push_back(r.unit);
  }
  std::size_t asked_anew = 0;
  for (std::size_t i = 0; i < confirmed.size(); ++i) {
    const Point& u = confirmed[i];
    const auto is_it = [&](const Evaluation& e) { return e.unit == u; };
    const std::vector<Evaluation>&searched = a.run.history.evaluations,
          &between = a.run.narrowed.evaluations;
    if (u[0] == 0 || std::any_of(searched.begin(), searched.end(), is_it) ||
        std::any_of(between.begin(), between.end(), is_it))
      continue;
    ++asked_anew;
    for (std::size_t j = 0; j < i; ++j) {
      const Point& v = confirmed[j];
      EXPECT_GT(std::max(std::abs(u[0] - v[0]), std::abs(u[1] - v[1])), 0.03) << i << ", " << j;
    }
  }
  EXPECT_GT(asked_anew, 1u);
}

// Along the front none holds on fresh skins, beside it some do: until one of them is confirmed.
TEST(Stages, ASaferDesignThatHoldsIsFound) {
  AnsweredRun a(evolved(), fresh_folder("stages_safer"), [](const TaskRequest& r) {
    TaskAnswer out = lines(r);
    out.objectives[0].value -= 0.2 * r.unit[1];  // a large angle is worse in both
    out.oxide_margin = (r.stage == Stage::Confirm ? 1.5 : 2.2) + r.unit[1];
    return out;
  });
  search_designs(a.run);
  narrow(a.run);
  confirm(a.run);
  const OptimiseResult& result = a.run.result;
  EXPECT_TRUE(result.any_feasible);
  EXPECT_LE(result.finalists.size(), kFinalists + 1);
  for (const FinalDesign& f : result.finalists) {
    EXPECT_EQ(f.feasible, f.unit[1] >= 0.5) << f.unit[1];
    EXPECT_TRUE(!f.on_front || f.feasible);
  }
  EXPECT_TRUE(result.finalists.front().on_front);
}

// A study of one number and one objective.
Study of_one(const Variable& variable) {
  Study study = two_variables();
  study.variables = {variable};
  study.objective = {};
  return study;
}

// An amplitude from 20 V to 250 V, as low as a worst modulation of .5 allows: 125 V, where the
// levels below say 122.5 V. All designs of the level between but one lie in that gap.
TEST(Stages, AFarDesignThatHoldsDoesNotEndTheConfirmation) {
  constexpr double kPerSquaredVolt = 3.2e-5, kLimit = 0.5;
  const auto volts = [](double u) { return 20 + 230 * u; };
  const auto unit = [](double v) { return Point{(v - 20) / 230}; };
  const Formula formula = [&](const TaskRequest& r) {
    const double v = volts(r.unit[0]);
    TaskAnswer out;
    out.worst = kPerSquaredVolt * v * v + (r.stage == Stage::Confirm ? 0 : 0.02);
    out.objectives = {{v, 0.01, {v, v}}};
    out.limited = {out.worst};
    out.limited_errors = {0};
    out.oxide_margin = 10;
    return out;
  };
  Study study = of_one(two_variables().variables[1]);
  study.objective.minimise = {parse_metric("mean(friction)")};
  study.constraints = {read_constraint("worst(modulation)", kLimit)};
  for (const bool searched_between : {false, true}) {
    AnsweredRun a(study, fresh_folder("stages_far"), formula);
    std::vector<double> searched{20, 66, 112, 158, 204, 250};
    if (searched_between) searched.push_back(135);
    for (const double v : searched)
      a.run.add_to_history(unit(v), judged_at(Stage::Search, a.run, formula, unit(v)));
    for (const double v : {122.6, 122.8, 123.0, 123.3, 123.6, 124.0, 124.5, 250.0})
      a.run.narrowed.add(unit(v), judged_at(Stage::Narrow, a.run, formula, unit(v)));
    confirm(a.run);
    // The best that the search knows of those that keep the tightened limit.
    ASSERT_GE(a.asked.size(), 2u);
    EXPECT_LT(volts(a.asked[0].unit[0]), 125);
    EXPECT_NEAR(volts(a.asked[1].unit[0]), searched_between ? 135 : 158, 1e-9);
    const std::vector<FinalDesign>& finalists = a.run.result.finalists;
    EXPECT_LE(finalists.size(), kFinalists + 1);
    ASSERT_TRUE(finalists.front().on_front);
    EXPECT_LE(finalists.front().confirmed.values[0], 1.1 * std::sqrt(kLimit / kPerSquaredVolt));
  }
}

// The best by the model, and of the raw numbers the luckiest, which a fab draws as the same.
TEST(Stages, OfTwoDesignsThatAreDrawnAlikeOneIsConfirmed) {
  Study study = of_one(two_variables().variables[0]);
  study.variables[0].low = 20e-9;
  study.variables[0].high = 300e-9;
  study.objective.maximise = {parse_metric("mean(modulation)")};
  const Point lucky{0.04 / 280};  // 20.04 nm
  const Formula formula = [&](const TaskRequest& r) {
    const double value = 1 - 0.5 * r.unit[0] + (r.unit == lucky ? 0.01 : 0);
    TaskAnswer out;
    out.objectives = {{value, 0.01, {value, value}}};
    out.worst = value;
    out.oxide_margin = 10;
    return out;
  };
  AnsweredRun a(study, fresh_folder("stages_alike"), formula);
  for (const Point& unit :
       {Point{0}, lucky, Point{0.2}, Point{0.4}, Point{0.6}, Point{0.8}, Point{1}}) {
    const search::Judgement judgement = judged_at(Stage::Narrow, a.run, formula, unit);
    a.run.add_to_history(unit, judgement);
    a.run.narrowed.add(unit, judgement);
  }
  confirm(a.run);
  std::set<double> drawn;
  for (const FinalDesign& f : a.run.result.finalists) {
    const double depth = a.run.problem.space().value(f.unit)[0];
    EXPECT_TRUE(drawn.insert(on_grid(study.variables[0], depth, study.search.rounding)).second)
        << depth;
  }
  EXPECT_EQ(drawn.size(), 1u);
}

// A failure is an evaluation, and no refusal.
TEST(Stages, FailuresAreCounted) {
  AnsweredRun a(evolved(), fresh_folder("stages_failures"), [](const TaskRequest& r) {
    if (r.stage == Stage::Search && r.unit[0] > 0.5)
      return TaskAnswer::refused(TaskStatus::Kind::Crashed, "crashed");
    return lines(r);
  });
  search_designs(a.run);
  int failed = 0;
  for (const Evaluation& e : a.run.history.evaluations) {
    EXPECT_EQ(e.outcome.ok, e.unit[0] <= 0.5);
    failed += !e.outcome.ok;
  }
  EXPECT_EQ(a.run.result.failures, failed);
  EXPECT_GT(failed, 0);
  EXPECT_EQ(a.run.result.evaluations, 12);
  EXPECT_EQ(a.run.result.refused, 0);
}

// What is left of a run is priced by what was timed: the same stage by itself, another by plans and
// what such stages take of their plans, half to twice as much.
TEST(Stages, TimesAreThoseOfTheTasksThatWereDone) {
  AnsweredRun a(evolved(), fresh_folder("stages_times"), lines);
  search::Run& run = a.run;
  EXPECT_EQ(run.seconds_of(3, Stage::Search), 0);  // nothing timed yet
  search_designs(run);
  const Replay::Spent& spent = run.replay.spent(Stage::Search);
  EXPECT_EQ(spent.tasks, 12);
  const double each = spent.seconds / 12;
  ASSERT_GT(each, 0);
  EXPECT_NEAR(run.seconds_of(6, Stage::Search), 6 * each, 1e-9 * each);
  for (const Stage stage : {Stage::Narrow, Stage::Confirm, Stage::Stability, Stage::Sensitivity}) {
    const double ratio = task_price(run.problem, stage) / task_price(run.problem, Stage::Search);
    const double over = run.seconds_of_designs(2, stage) / (2 * each * ratio);
    EXPECT_GT(over, 0.5);
    EXPECT_LT(over, 2);
  }
  const PartSeconds all = run.wanted();
  const auto part = [&](RunPart p) { return all[static_cast<std::size_t>(p)]; };
  EXPECT_EQ(part(RunPart::Search), 0);
  EXPECT_DOUBLE_EQ(part(RunPart::Narrow), run.seconds_of(4, Stage::Narrow));
  EXPECT_DOUBLE_EQ(part(RunPart::Confirm), run.seconds_of(9, Stage::Confirm));
  EXPECT_DOUBLE_EQ(part(RunPart::Stability),
                   run.seconds_of(8 * stability_variants(run.problem).size(), Stage::Stability));
  EXPECT_DOUBLE_EQ(part(RunPart::Flat), run.seconds_of(2, Stage::Confirm));
  EXPECT_DOUBLE_EQ(part(RunPart::Rounding), run.seconds_of(kJudgedOnGrid, Stage::Rounding));
  EXPECT_DOUBLE_EQ(part(RunPart::Sensitivity), run.seconds_of(5, Stage::Sensitivity));
  EXPECT_EQ(part(RunPart::Parameters), 0);
  EXPECT_DOUBLE_EQ(part(RunPart::Files), 1 + run.seconds_of(1, Stage::Confirm) / 8);
  EXPECT_DOUBLE_EQ(run.seconds_from(RunPart::Files), part(RunPart::Files));
  EXPECT_DOUBLE_EQ(run.seconds_from(RunPart::Sensitivity),
                   part(RunPart::Sensitivity) + part(RunPart::Parameters) + part(RunPart::Files));
}

// What a run says while it runs, and what its clock and the prices of its parts said then.
struct Said {
  Progress said;
  double since = 0, confirm = 0, stability = 0, confirmations = 0;
};

std::vector<Said> said_by(const Study& study, const std::string& folder) {
  std::vector<Said> out;
  search::Run* run = nullptr;
  AnsweredRun a(study, folder, lines, false, nullptr, [&](const Progress& p) {
    const int left = p.total - p.done;
    out.push_back(
        {p, run->clock.seconds(), run->seconds_from(RunPart::Confirm),
         run->seconds_from(RunPart::Stability),
         run->seconds_of_designs(static_cast<std::size_t>(std::max(0, left)), Stage::Confirm)});
  });
  run = &a.run;
  EXPECT_TRUE(a.whole());
  const auto front = std::count_if(a.run.result.finalists.begin(), a.run.result.finalists.end(),
                                   [](const FinalDesign& f) { return f.on_front; });
  EXPECT_EQ(out.back().said.stage, "check");
  EXPECT_EQ(out.back().said.total, 4 + front);  // and the flat one, two of the best, its fit
  return out;
}

// Each stage counts up to its end; what is left is what the rest of it takes at the pace so far,
// and what the next ones cost.
TEST(Progress, CountsUpAndSaysWhatTheRestWillTake) {
  Study study = two_variables();
  study.search.drafts = 3;
  const std::vector<Said> all = said_by(study, fresh_folder("stages_said"));
  std::string stages;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Progress& p = all[i].said;
    const bool first = i == 0 || p.stage != all[i - 1].said.stage;
    if (first) stages += p.stage + " ";
    EXPECT_LE(p.done, p.total) << p.stage;
    const bool last = i + 1 == all.size() || all[i + 1].said.stage != p.stage;
    EXPECT_GT(p.done, first ? -1 : all[i - 1].said.done);
    EXPECT_EQ(p.done == p.total, last) << p.stage;
    const double rest = all[i].since / std::max(1, p.done) * (p.total - p.done);  // at most
    if (p.stage == "draft") {
      EXPECT_GT(p.seconds_left, 0);  // by what drafts take and plans say of the rest
    } else if (p.stage == "narrow") {
      EXPECT_GE(p.seconds_left, all[i].confirm);
      EXPECT_LE(p.seconds_left, all[i].confirm + rest);
    } else if (p.stage == "confirm" && p.done == 0) {
      EXPECT_DOUBLE_EQ(p.seconds_left, all[i].confirm);
      EXPECT_GT(p.seconds_left, 0);
    } else if (p.stage == "confirm") {
      EXPECT_DOUBLE_EQ(p.seconds_left, all[i].confirmations + all[i].stability);
    } else if (p.stage == "check") {
      EXPECT_GE(p.seconds_left, last ? 0 : all.back().said.seconds_left);
    }
    EXPECT_GT(p.share, 0);
    EXPECT_LE(p.share, 1);
  }
  EXPECT_EQ(stages, "draft search narrow confirm check ");
}

// A clock leaves no more than itself.
TEST(Progress, OfALimitedRunLeavesNoMoreThanItsClock) {
  Study study = two_variables();
  study.search.drafts = 3;
  study.search.time = 100;
  for (const Said& s : said_by(study, fresh_folder("stages_limited"))) {
    EXPECT_LE(s.said.seconds_left, 100);
    EXPECT_GE(s.said.seconds_left, 0) << s.said.stage;
  }
}

// Drafts come first and count for nothing but the searcher.
TEST(Stages, DraftsSteerAndAreNoEvaluations) {
  Study study = two_variables();
  study.search.drafts = 6;
  study.search.evaluations = 8;
  AnsweredRun a(study, fresh_folder("stages_drafts"), lines);
  search_designs(a.run);
  EXPECT_EQ(a.count(Stage::Draft), 6);
  EXPECT_EQ(a.count(Stage::Search), 8);
  for (std::size_t i = 0; i < a.asked.size(); ++i)
    EXPECT_EQ(a.asked[i].stage, i < 6 ? Stage::Draft : Stage::Search) << i;
  EXPECT_EQ(a.run.history.size(), 8u);
  EXPECT_EQ(a.run.result.evaluations, 8);
  EXPECT_EQ(a.run.replay.evaluated(), 8);
}

// The clock leaves four drafts of each of two rounds, and one evaluation. With more time, and
// however many workers, the search goes on from there.
TEST(Stages, RoundsOfDraftsThatTheClockCutAreGoneOnFrom) {
  Study study = two_variables();
  study.search.drafts = 15;
  study.search.time = 1e-6;
  const std::string cut = fresh_folder("stages_cut_drafts");
  {
    AnsweredRun a(study, cut, lines);
    search_designs(a.run);
    EXPECT_EQ(a.count(Stage::Draft), 8);
    EXPECT_EQ(a.count(Stage::Search), 1);
  }
  study.search.time = 0;
  const auto journal = [](const std::string& folder) {
    return read_bytes(std::filesystem::path(folder) / kJournalName);
  };
  std::set<std::string> journals;
  for (const std::size_t workers : {1u, 3u}) {
    const std::string folder = fresh_folder("stages_more_drafts" + std::to_string(workers));
    std::filesystem::copy(cut, folder, std::filesystem::copy_options::recursive);
    AnsweredRun a(study, folder, lines, true, nullptr, {}, false, "", workers);
    search_designs(a.run);
    EXPECT_EQ(a.count(Stage::Draft), 0);
    EXPECT_EQ(a.count(Stage::Search), 14);
    EXPECT_EQ(a.run.result.evaluations, 15);
    EXPECT_TRUE(journal(folder).starts_with(journal(cut)));
    journals.insert(journal(folder));
  }
  EXPECT_EQ(journals.size(), 1u);
}

// Of eight designs the next round may well begin with the one that the clock cut the last one at:
// the journal still tells both apart.
TEST(Stages, RoundsOfDraftsOfChoicesAloneAreReadAsTheyWere) {
  Study study = two_variables();
  Variable &depth = study.variables[0], &angle = study.variables[1];
  depth.choices = {100e-9, 300e-9, 500e-9, 700e-9};
  angle.choices = {50 * kPi / 180, 70 * kPi / 180};
  for (Variable* v : {&depth, &angle}) v->low = v->choices.front(), v->high = v->choices.back();
  study.search.drafts = 12;
  for (int seed = 1; seed <= 8; ++seed) {
    study.search.seed = seed;
    study.search.time = 1e-6;
    const std::string folder = fresh_folder("stages_drafts_of_choices" + std::to_string(seed));
    {
      AnsweredRun a(study, folder, lines);
      search_designs(a.run);
      EXPECT_EQ(a.count(Stage::Search), 1) << seed;
    }
    study.search.time = 0;
    AnsweredRun a(study, folder, lines, true, nullptr, {}, true);
    EXPECT_NO_THROW(search_designs(a.run)) << seed;
    EXPECT_TRUE(a.asked.empty()) << seed;
  }
}

}  // namespace
}  // namespace papilla::tests::stages_test
