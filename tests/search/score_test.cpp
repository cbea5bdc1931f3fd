// Scores, outcomes and slopes of a study from answers that are written down here: no contact is
// solved.
#include "search/score.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/constants.h"
#include "search/levels.h"
#include "search/sensitivity.h"
#include "tests/support/without_belief.h"

namespace papilla::tests::score_test {
namespace {

Study default_study() {
  return without_belief(read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml"));
}

// Two scenarios of unlike weight, felt by one finger, at two humidities of unlike weight.
Study weighted_study() {
  Study study = default_study();
  study.population.clear();
  study.scenarios = {{"new", 3, {}}, {"worn", 1, {}}};
  study.design.environment.relative_humidity = {0.2, 0.7};
  study.design.environment.weights = {1, 4};
  return study;
}

// The answer of a task with these numbers at each humidity, alike for every objective.
TaskAnswer answer(const StudyProblem& problem, const std::vector<double>& points) {
  TaskAnswer out;
  for (std::size_t k = 0; k < problem.objectives().size(); ++k) {
    const double mean =
        std::accumulate(points.begin(), points.end(), 0.0) / static_cast<double>(points.size());
    out.objectives.push_back({mean, 0.1 * mean, points});
  }
  return out;
}

TEST(Scores, WeighTasksAndAddTheirErrorsByWeight) {
  const Study study = weighted_study();
  const StudyProblem problem(study);
  const Score score = problem.score(problem.study().design,
                                    {answer(problem, {0.2, 0.4}), answer(problem, {0.5, 0.9})});
  ASSERT_TRUE(score.ok) << score.reason;
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(score.values[k], (3 * 0.3 + 0.7) / 4, 1e-12);
    EXPECT_NEAR(score.errors[k], (3 * 0.03 + 0.07) / 4, 1e-12);
  }
}

// By the confirmed number, not by that of the few skins that members are run on: modulation is .3
// and .7 where they have half of it, so the members' halves and doubles are worth twice as much.
TEST(Scores, MembersMoveTheConfirmedNumberInProportion) {
  const Study study = weighted_study();
  const StudyProblem problem(study);
  std::vector<TaskAnswer> answers{answer(problem, {0.2, 0.4}), answer(problem, {0.5, 0.9})};
  const Score confirmed = problem.score(problem.study().design, answers);
  EXPECT_FALSE(parameter_error(confirmed, 0));
  for (const double of : {0.15, 0.35}) {
    TaskAnswer& a = answers[of > 0.2 ? 1 : 0];
    const auto run = [&](double v) { return RunReading{v, {v, v, v}}; };
    a.model.assign(2, {{}, {{0.5, 0.5}, {run(0.9 * of), run(1.1 * of)}, run(of)}});
  }
  Score score = confirmed;
  problem.add_steps(score, answers);
  EXPECT_NEAR(*parameter_error(score, 0), 0.1 * score.values[0], 1e-12);
  problem.add_steps(score, answers);  // once is as good as twice
  EXPECT_NEAR(*parameter_error(score, 0), 0.1 * score.values[0], 1e-12);
}

// What a study maximises is minimised with the other sign; what it minimises stays.
TEST(Scores, OnlyWhatIsMaximisedChangesItsSignForTheSearcher) {
  const Study study = default_study();
  const StudyProblem problem(study);
  ASSERT_TRUE(problem.objectives()[0].maximise);
  ASSERT_FALSE(problem.objectives()[1].maximise);
  Score score;
  score.ok = true;
  score.values = {0.6, 0.2};
  score.oxide_margin = 10;
  const Outcome outcome = problem.outcome(score);
  EXPECT_TRUE(outcome.ok);
  EXPECT_EQ(outcome.objectives, (std::vector<double>{-0.6, 0.2}));
  score.ok = false;
  score.reason = "why";
  EXPECT_FALSE(problem.outcome(score).ok);
  EXPECT_EQ(problem.outcome(score).reason, "why");
}

// A target's residuals: their squares sum to that of the distance, each on its side of the target.
TEST(Scores, ResidualsOfATargetSumToItsSquaredDistance) {
  Study study = weighted_study();
  study.objective = {};
  study.objective.targets = {{kModulation, 0.5}};
  const StudyProblem problem(study);
  const std::vector<std::vector<double>> points{{0.2, 0.4}, {0.5, 0.9}};
  const Score score = problem.score(problem.study().design,
                                    {answer(problem, points[0]), answer(problem, points[1])});
  ASSERT_TRUE(score.ok) << score.reason;
  ASSERT_EQ(score.residuals.size(), 4u);
  EXPECT_EQ(problem.residuals(), 4u);
  double sum = 0, squares = 0;
  for (std::size_t t = 0; t < 2; ++t) {
    for (std::size_t i = 0; i < 2; ++i) {
      const double weight = (t == 0 ? 3.0 : 1.0) * (i == 0 ? 1.0 : 4.0) / 20,
                   r = points[t][i] - 0.5;
      EXPECT_NEAR(score.residuals[2 * t + i], std::sqrt(weight) * r, 1e-12) << t << i;
      sum += square(score.residuals[2 * t + i]);
      squares += weight * r * r;
    }
  }
  EXPECT_NEAR(score.values[0], std::sqrt(squares), 1e-12);
  EXPECT_NEAR(sum, squares, 1e-12);
}

// The bad side over tasks, but of none in a scenario without weight: that is no task.
TEST(Scores, LimitsTakeTheWorstTaskThatCounts) {
  Study study = weighted_study();
  study.scenarios.push_back({"broken", 0, {}});
  study.constraints = {read_constraint("mean(friction)", 0.05),
                       {MetricLimit{parse_metric("mean(contact_area)")}, 0.1, true},
                       read_constraint("haze", 0.05),
                       read_constraint("gloss", 70),
                       read_constraint("most_gloss", 90)};
  const StudyProblem problem(study);
  ASSERT_EQ(problem.tasks().size(), 2u);
  EXPECT_EQ(problem.nominal_tasks(), 2u);
  std::vector<TaskAnswer> answers(2, answer(problem, {0.2, 0.4}));
  const double worst[] = {0.3, 0.2}, margin[] = {2, 3};
  const std::vector<double> limited[] = {{0.04, 0.3}, {0.06, 0.2}};
  for (std::size_t t = 0; t < 2; ++t) {
    answers[t].worst = worst[t], answers[t].oxide_margin = margin[t];
    answers[t].limited = limited[t];
    answers[t].look = Look{t == 1 ? 0.1 : 0.02, 0.9, 0.5, 0};
    answers[t].look->gloss = t == 1 ? 60 : 100;
  }
  const Score score = problem.score(problem.study().design, answers);
  EXPECT_EQ(score.worst, 0.2);
  EXPECT_EQ(score.oxide_margin, 2);
  EXPECT_EQ(score.limited, (std::vector<double>{0.06, 0.2}));
  // Of the look each limit has a side of its own: the haziest task shines least.
  const std::vector<LimitValue> values =
      problem.constraints().values(problem.study().design, score);
  ASSERT_EQ(values.size(), 5u);
  EXPECT_EQ(values[2].value, 0.1);
  EXPECT_EQ(values[3].value, 60);
  EXPECT_EQ(values[4].value, 100);
}

// Where no drive is applied there is no modulation, which is not the lowest one.
TEST(Scores, TheWorstModulationIsThatOfDrivenScenarios) {
  Study study = weighted_study();
  study.objective = {};
  study.objective.minimise = {parse_metric("mean(friction)")};
  study.constraints.clear();
  const auto worst = [&](std::vector<double> of) {
    const StudyProblem problem(study);
    std::vector<TaskAnswer> answers(2, answer(problem, {0.2, 0.4}));
    for (std::size_t t = 0; t < 2; ++t) answers[t].worst = of[t];
    const Score score = problem.score(study.design, answers);
    return std::pair{problem.driven(), score.worst};
  };
  EXPECT_EQ(worst({0.3, 0.2}), std::pair(true, 0.2));
  study.scenarios[1].set = {{"drive.amplitude", 0}};
  EXPECT_EQ(worst({0.3, 0}), std::pair(true, 0.3));
  study.scenarios[0].set = {{"drive.amplitude", 0}};
  EXPECT_EQ(worst({0, 0}), std::pair(false, 0.0));
  // Searched, it is driven but where a scenario turns it off.
  study.scenarios[0].set.clear();
  study.design.drive.amplitude = 0;
  study.variables.push_back({"drive.amplitude", "V", 0, 100, {}});
  EXPECT_EQ(worst({0.3, 0}), std::pair(true, 0.3));
}

// Of a model that is linear in every variable the slopes come back, in SI and with their sign; a
// tenth of the way that costs half a value costs a twentieth of it.
TEST(Slopes, OfALinearModelAreItsOwn) {
  const Study study = default_study();
  const StudyProblem problem(study);
  const DesignSpace& space = problem.space();
  const Point centre = space.unit({6e-6, 3e-6, 400e-9, 1.1});
  const std::vector<double> at = space.value(centre);
  const std::vector<std::vector<double>> slope{{0.4e6, -0.05e6, -2e6, 0.1},
                                               {-0.01e6, 0.03e6, -5e5, 0.3}};
  const auto scored = [&](const Point& unit) {
    const std::vector<double> v = space.value(unit);
    Score s;
    s.ok = true;
    s.values = {0.5, 0.25};
    s.oxide_margin = 10;
    for (std::size_t o = 0; o < 2; ++o) {
      for (std::size_t k = 0; k < v.size(); ++k) s.values[o] += slope[o][k] * (v[k] - at[k]);
    }
    return s;
  };
  const std::vector<SensitivityMove> moves = sensitivity_moves(problem, {centre});
  ASSERT_EQ(moves.size(), 8u);
  std::vector<Score> moved;
  for (const SensitivityMove& m : moves) moved.push_back(scored(m.unit));
  const auto found = sensitivity(problem, {centre}, moves, scored(centre), moved);
  ASSERT_EQ(found.size(), 4u);
  double squares[2] = {0, 0};
  for (std::size_t k = 0; k < 4; ++k) {
    const VariableSensitivity& s = found[k];
    EXPECT_EQ(s.variable, k);
    const double range = space.cube().dimensions[k].high - space.cube().dimensions[k].low;
    EXPECT_NEAR(s.step, 0.05 * range, 1e-9 * range);
    for (std::size_t o = 0; o < 2; ++o) {
      EXPECT_NEAR(s.change[o] / s.step, slope[o][k], 1e-6 * std::abs(slope[o][k])) << k << o;
      squares[o] += square(s.change[o]);
    }
    // The first is maximised, the second minimised: each loses where its slope says.
    const double lost[2] = {0.05 * 0.5 / std::abs(slope[0][k]),
                            0.05 * 0.25 / std::abs(slope[1][k])};
    double down = kInfinity, up = kInfinity;
    (slope[0][k] > 0 ? down : up) = lost[0];
    double& other = slope[1][k] > 0 ? up : down;
    other = std::min(other, lost[1]);
    EXPECT_NEAR(s.down.most, std::min(down, s.step), 1e-6 * s.step) << k;
    EXPECT_NEAR(s.up.most, std::min(up, s.step), 1e-6 * s.step) << k;
    using End = Drift::End;
    EXPECT_EQ(s.down.end, down > s.step ? End::StepTried : End::Loss) << k;
    EXPECT_EQ(s.up.end, up > s.step ? End::StepTried : End::Loss) << k;
  }
  for (const VariableSensitivity& s : found) {
    for (std::size_t o = 0; o < 2; ++o)
      EXPECT_NEAR(s.share[o], square(s.change[o]) / squares[o], 1e-12);
  }
}

// A share of people that is nothing changes by the last bits of a sum: that is no change, has no
// part of a variance and ends no tolerance.
TEST(Slopes, OfAShareThatIsNothingAreNothing) {
  Study study = default_study();
  study.objective = {};
  study.objective.maximise = {parse_metric("mean(felt(modulation = 0.35))")};
  const StudyProblem problem(study);
  const Point centre = problem.space().unit({6e-6, 3e-6, 400e-9, 1.1});
  const auto scored = [](double felt) {
    Score s;
    s.ok = true;
    s.values = {felt};
    s.oxide_margin = 10;
    return s;
  };
  const std::vector<SensitivityMove> moves = sensitivity_moves(problem, {centre});
  ASSERT_GE(moves.size(), 2u);
  std::vector<Score> moved(moves.size(), scored(1e-35));
  moved[1] = scored(1e-60);
  const auto found = sensitivity(problem, {centre}, moves, scored(1e-35), moved);
  EXPECT_EQ(found[0].change, std::vector<double>{0});
  EXPECT_EQ(found[0].share, std::vector<double>{0});
  EXPECT_EQ(found[0].up.end, Drift::End::StepTried);
}

// Half the change between both sides where both were judged, else that of the side that was.
TEST(Slopes, AreTheMeanOfBothSidesOrThoseOfTheOneThatThereIs) {
  const Study study = default_study();
  const StudyProblem problem(study);
  const DesignSpace& space = problem.space();
  const Point centre = space.unit({6e-6, 3e-6, 400e-9, 1.1});
  const auto moved_to = [&](std::size_t k, int sign) {
    Point u = centre;
    u[k] += 0.05 * sign;
    return SensitivityMove{k, sign, u};
  };
  const auto scored = [](double first, double second, bool ok = true) {
    Score s;
    s.ok = ok;
    s.values = {first, second};
    s.oxide_margin = 10;
    return s;
  };
  const std::vector<SensitivityMove> moves{moved_to(0, -1), moved_to(0, 1), moved_to(1, 1),
                                           moved_to(2, -1), moved_to(2, 1), moved_to(3, -1)};
  // From 0.5 and 0.25. Of the third variable the lower side failed.
  const std::vector<Score> moved{scored(0.47, 0.26),  scored(0.51, 0.25), scored(0.52, 0.24),
                                 scored(9, 9, false), scored(0.46, 0.29), scored(0.53, 0.25)};
  const auto found = sensitivity(problem, {centre}, moves, scored(0.5, 0.25), moved);
  ASSERT_EQ(found.size(), 4u);
  const double change[4][2] = {
      {0.5 * (0.03 + 0.01), 0.5 * (-0.01 + 0)}, {0.02, -0.01}, {-0.04, 0.04}, {-0.03, 0}};
  for (std::size_t o = 0; o < 2; ++o) {
    double squares = 0;
    for (const auto& c : change) squares += square(c[o]);
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(found[k].variable, k);
      EXPECT_NEAR(found[k].change[o], change[k][o], 1e-12) << k << o;
      EXPECT_NEAR(found[k].share[o], square(change[k][o]) / squares, 1e-12) << k << o;
    }
  }
  // A twentieth of the first is 0.025, of the second 0.0125.
  using End = Drift::End;
  EXPECT_NEAR(found[0].down.most, found[0].step * 0.025 / 0.03, 1e-9 * found[0].step);
  EXPECT_EQ(found[0].down.end, End::Loss);
  EXPECT_EQ(found[0].up.end, End::StepTried);
  EXPECT_EQ(found[1].up.end, End::StepTried);
  EXPECT_EQ(found[3].down.end, End::StepTried);
  EXPECT_EQ(found[0].up.most, found[0].step);
  EXPECT_NEAR(found[2].up.most, found[2].step * 0.0125 / 0.04, 1e-9 * found[2].step);
  EXPECT_EQ(found[2].down.end, End::Failed);
  EXPECT_FALSE(found[2].down.judged());
  EXPECT_TRUE(sensitivity(problem, {centre}, moves, scored(0.5, 0.25, false), moved).empty());
  // A variable of which nothing was judged has no share, and a sum of nothing none either.
  const auto none = sensitivity(problem, {centre}, {moved_to(1, -1), moved_to(2, 1)},
                                scored(0.5, 0.25), {scored(9, 9, false), scored(0.5, 0.3)});
  ASSERT_EQ(none.size(), 2u);
  EXPECT_TRUE(none[0].change.empty());
  EXPECT_EQ(none[0].share, (std::vector<double>{0, 0}));
  EXPECT_EQ(none[1].share, (std::vector<double>{0, 1}));
}

// A number may be off until a limit of the study is reached, and the sheet names that.
TEST(Slopes, EndAtTheLimitsOfTheStudy) {
  Study study = default_study();  // walls of 0.4 um at least, a margin of 2 at least
  const StudyProblem problem(study);
  const auto limit = [&](const std::string& name) {
    for (const Constraint& c : study.constraints) {
      if (limit_name(c.on) == name) return c.limit;
    }
    return 0.0;
  };
  const double wall = limit("min_wall");
  ASSERT_GT(wall, 0);
  // 20 nm of wall are left to lose; the margin goes from 2.01 to 1.75 with a step of the depth.
  const Point centre = problem.space().unit({4e-6, 4e-6 - wall - 20e-9, 300e-9, 1.1});
  const std::vector<SensitivityMove> moves = sensitivity_moves(problem, {centre});
  Score here;
  here.ok = true;
  here.values = {0.5, 0.25};
  here.oxide_margin = 2.01;
  std::vector<Score> moved(moves.size(), here);
  for (std::size_t i = 0; i < moves.size(); ++i) {
    if (moves[i].variable == 2) moved[i].oxide_margin = moves[i].sign > 0 ? 1.75 : 0;
  }
  const auto found = sensitivity(problem, {centre}, moves, here, moved);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].down.end, Drift::End::Limit);
  EXPECT_EQ(found[0].down.limit, "min_wall");
  EXPECT_NEAR(found[0].down.most, 20e-9, 1e-12);
  EXPECT_EQ(found[0].up.end, Drift::End::StepTried);
  EXPECT_EQ(found[1].up.limit, "min_wall");
  EXPECT_NEAR(found[1].up.most, 20e-9, 1e-12);
  EXPECT_EQ(found[2].up.limit, "oxide_breakdown_margin");
  // Linear in the number itself, which may go to zero.
  EXPECT_NEAR(found[2].up.most, found[2].step * 0.01 / 0.26, 1e-9 * found[2].step);
  EXPECT_EQ(found[2].down.limit, "oxide_breakdown_margin");
  EXPECT_NEAR(found[2].down.most, found[2].step * 0.01 / 2.01, 1e-9 * found[2].step);
}

// The level of the steps has 2.001 of a margin that is confirmed as 2.2 and may fall to 2: the room
// is that of the confirmed number, moved as the step moves that of its level.
TEST(Slopes, EndWhereTheConfirmedNumberReachesTheLimit) {
  const Study study = default_study();
  const StudyProblem problem(study);
  const Point centre = problem.space().unit({6e-6, 3e-6, 300e-9, 1.1});
  const std::vector<SensitivityMove> moves = sensitivity_moves(problem, {centre});
  Score here;
  here.ok = true;
  here.values = {0.5, 0.25};
  here.oxide_margin = 2.001;
  here.yield = YieldShare{0.4, 0.01};
  Score confirmed = here;
  confirmed.oxide_margin = 2.2;
  confirmed.yield = YieldShare{0.8, 0.01};
  std::vector<Score> moved(moves.size(), here);
  for (std::size_t i = 0; i < moves.size(); ++i) {
    if (moves[i].variable == 2 && moves[i].sign > 0) moved[i].oxide_margin = 1.75;
  }
  moved[0].yield->share = 0.3;
  set_confirmed_limits(problem, confirmed, here, moved);
  EXPECT_EQ(here.oxide_margin, 2.2);
  EXPECT_NEAR(moved[0].yield->share, 0.8 * 0.3 / 0.4, 1e-12);
  const auto found = sensitivity(problem, {centre}, moves, here, moved);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[2].up.limit, "oxide_breakdown_margin");
  EXPECT_NEAR(found[2].up.most, found[2].step * 0.2 / (2.2 * (1 - 1.75 / 2.001)),
              1e-9 * found[2].step);
}

// Where a whole step makes no shape, as a period below its width, a part of it is tried; where no
// room is left to a limit, that is said and not a room below any fab's.
TEST(Slopes, TryThePartOfAStepThatMakesAShape) {
  Study study = default_study();
  for (Constraint& c : study.constraints) {
    if (limit_name(c.on) == "min_wall") c.limit = 0.3e-6;
  }
  const StudyProblem problem(study);
  const DesignSpace& space = problem.space();
  const Point centre = space.unit({4e-6, 3.7e-6, 300e-9, 1.1});
  const std::vector<SensitivityMove> moves = sensitivity_moves(problem, {centre});
  const auto period = std::find_if(moves.begin(), moves.end(), [](const SensitivityMove& m) {
    return m.variable == 0 && m.sign < 0;
  });
  ASSERT_NE(period, moves.end());
  EXPECT_LT(period->part, 1);
  Score here;
  here.ok = true;
  here.values = {0.5, 0.25};
  here.oxide_margin = 10;
  std::vector<Score> moved(moves.size(), here);
  moved[static_cast<std::size_t>(period - moves.begin())].values[0] = 0.4;
  const auto found = sensitivity(problem, {centre}, moves, here, moved);
  const double range = space.cube().dimensions[0].high - space.cube().dimensions[0].low;
  EXPECT_NEAR(found[0].step, 0.05 * range, 1e-9 * range);
  EXPECT_EQ(found[0].down.end, Drift::End::Limit);
  EXPECT_EQ(found[0].down.limit, "min_wall");
  EXPECT_EQ(found[0].down.most, 0);
  // The slope between both ends, a part of a step and a step apart.
  EXPECT_NEAR(found[0].change[0], 0.1 / (1 + period->part), 1e-9);
}

// The space may end before a step where a limit is nearer: a width near its upper bound.
TEST(Slopes, EndAtALimitThatIsNearerThanTheEndOfTheSpace) {
  Study study = default_study();
  const StudyProblem problem(study);
  double wall = 0;
  for (const Constraint& c : study.constraints) {
    if (limit_name(c.on) == "min_wall") wall = c.limit;
  }
  const double widest = study.variables[1].high - 50e-9;
  const Point centre = problem.space().unit({widest + wall + 20e-9, widest, 300e-9, 1.1});
  const std::vector<SensitivityMove> moves = sensitivity_moves(problem, {centre});
  Score here;
  here.ok = true;
  here.values = {0.5, 0.25};
  here.oxide_margin = 10;
  const auto found =
      sensitivity(problem, {centre}, moves, here, std::vector<Score>(moves.size(), here));
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[1].up.limit, "min_wall");
  EXPECT_NEAR(found[1].up.most, 20e-9, 1e-12);
}

// Five per cent, or what is read of a look: of a sparkle of nothing nothing is lost.
TEST(Slopes, TolerateWhatInstrumentsDoNotRead) {
  const auto tolerated = [](const char* metric, double value) {
    return tolerated_loss({.expression = parse_metric(metric), .name = metric}, value);
  };
  EXPECT_DOUBLE_EQ(tolerated("mean(modulation)", -0.4), 0.02);
  EXPECT_EQ(tolerated("mean(sparkle)", 0), 0.001);
  EXPECT_NEAR(tolerated("mean(haze)", 0.06), std::hypot(0.003, 0.001), 1e-15);
  EXPECT_EQ(tolerated("mean(gloss)", 0), 0.1);
  EXPECT_EQ(tolerated("mean(adhesion)", 0), 1e-4);
  EXPECT_DOUBLE_EQ(tolerated("variation(adhesion)", 0.2), 0.01);
  EXPECT_EQ(tolerated("mean(felt(modulation = 0.35))", 0), 0.01);  // a share of people
  EXPECT_DOUBLE_EQ(tolerated("variation(felt(modulation = 0.35))", 0.2), 0.01);
}

// On a target the distance is next to nothing, and 5 % of it no tolerance.
TEST(Slopes, TolerateOfADistanceAShareOfItsTarget) {
  const auto tolerated = [](double target, double distance) {
    return tolerated_loss({.expression = parse_metric("mean(modulation)"),
                           .maximise = false,
                           .name = "distance(modulation)",
                           .aimed = true,
                           .target = target},
                          distance);
  };
  EXPECT_DOUBLE_EQ(tolerated(0.4, 0.009), 0.02);
  EXPECT_DOUBLE_EQ(tolerated(-0.4, 0.009), 0.02);
  EXPECT_DOUBLE_EQ(tolerated(0.4, 0.8), 0.04);
  EXPECT_DOUBLE_EQ(tolerated(0, 0.2), 0.01);  // a target of nothing has no share
}

TEST(Levels, OneDesignInThreeIsJudgedAgainAndNoMoreThan32) {
  SearchProblem p;
  p.space.dimensions.assign(2, Dimension{});
  p.objectives = 2;
  for (const auto& [evaluations, again] :
       {std::pair(2, 0u), {3, 1u}, {9, 3u}, {96, 32u}, {300, 32u}}) {
    p.evaluations = evaluations;
    EXPECT_EQ(narrowings(p), again) << evaluations;
  }
  p.objectives = 3;
  EXPECT_EQ(narrowings(p), 0u);
}

// Skins: sixteen over all fingers in a search, twice as many of others between, fresh ones at last.
TEST(Levels, NoTwoJudgeOnTheSameSkins) {
  Study study = default_study();
  study.design.accuracy.level = AccuracyLevel::Draft;
  for (const std::size_t fingers : {1u, 4u}) {
    study.population.assign(fingers, study.design.finger);
    const StudyProblem problem(study);
    const Fidelity search = stage_fidelity(problem, Stage::Search),
                   between = stage_fidelity(problem, Stage::Narrow),
                   confirmed = stage_fidelity(problem, Stage::Confirm);
    EXPECT_EQ(search.skins, fingers == 1 ? 8 : 4);
    EXPECT_EQ(between.skins, 2 * search.skins);
    EXPECT_EQ(between.grid, search.grid);
    EXPECT_EQ(between.field_skins, 1);  // what decides the order of kinds
    EXPECT_EQ(search.field_skins, 0);
    EXPECT_EQ(confirmed.skins, fingers == 1 ? 16 : 10);
    EXPECT_EQ(search.first_skin, 0);
    EXPECT_GT(between.first_skin, search.first_skin + search.skins);
    EXPECT_GT(confirmed.first_skin, between.first_skin + between.skins);
    EXPECT_EQ(steps_fidelity(problem, confirmed).skins, 12 / static_cast<int>(fingers));
  }
}

// A number that the study's own kind of texture does not have starts in the middle of its range.
TEST(Space, TheStudysOwnDesignIsItsPointAndUnknownNumbersStartInTheMiddle) {
  Study study = default_study();
  const StudyProblem problem(study);
  const DesignSpace& space = problem.space();
  EXPECT_EQ(space.design(space.unit_of_study()), study.design);
  study.design.texture = Texture{};  // flat: it has no diameter
  study.variables = {{"texture.diameter", "um", 1e-6, 4e-6, {}},
                     {"surface.contact_angle", "deg", 0.7, 1.5, {}}};
  const StudyProblem flat(study);
  const std::vector<double> value = flat.space().value(flat.space().unit_of_study());
  EXPECT_NEAR(value[0], 2.5e-6, 1e-15);
  EXPECT_NEAR(value[1], study.design.surface.contact_angle, 1e-12);
}

// What the file says is the study's own, inside its space or not; a number that the space fixes has
// that value.
TEST(Space, KeepsTheStudysOwnSurfaceBesideIt) {
  constexpr double kFilm = 550e-9;
  Study study = default_study();
  const double own = study.design.surface.contact_angle;
  study.variables = {{"texture.depth", "nm", 0, 900e-9, {}},
                     {"surface.contact_angle", "deg", own - 0.1, own + 0.1, {}},
                     {"surface.dielectric.0.thickness", "nm", kFilm, kFilm, {kFilm}}};
  const StudyProblem inside(study);
  const Point texture = inside.space().unit({400e-9, own + 0.05, kFilm});
  const Point at_home = inside.space().with_own_finish(texture);
  EXPECT_EQ(at_home[0], texture[0]);
  EXPECT_EQ(at_home[1], inside.space().unit_of_study()[1]);
  EXPECT_FALSE(DesignSpace::is_beside(at_home));
  EXPECT_NEAR(inside.space().own_values()[1], own, 1e-12);
  EXPECT_EQ(inside.space().own_values()[2], kFilm);
  const auto expect_beside = [&](const Variable& angle, double nearest) {
    study.variables[1] = angle;
    const StudyProblem problem(study);
    const DesignSpace& space = problem.space();
    EXPECT_NEAR(space.value(space.unit_of_study())[1], nearest, 1e-12);
    EXPECT_EQ(space.own_values()[1], own);
    const Point unit = space.with_own_finish(texture);
    EXPECT_TRUE(DesignSpace::is_beside(unit));
    const Design surface = space.design(unit);
    EXPECT_EQ(surface.surface.contact_angle, own);
    EXPECT_EQ(surface.surface.dielectric[0].thickness, kFilm);
    EXPECT_NEAR(space.value(unit)[0], 400e-9, 1e-15);  // the texture stays
  };
  const Variable range{"surface.contact_angle", "deg", own + 0.1, own + 0.3, {}};
  expect_beside(range, own + 0.1);
  Variable choice = range;
  choice.choices = {own + 0.1, own + 0.3};
  expect_beside(choice, own + 0.1);
  Variable hollow = range;
  hollow.low = own - 0.3, hollow.excluded = {{own - 0.2, own + 0.1}};
  expect_beside(hollow, own + 0.1);
}

// Only a limit on the look makes a search ask for looks before it evaluates.
TEST(Space, LooksAreAskedForBeforeAnEvaluationOnlyWhereTheyAreLimited) {
  Study study = default_study();
  EXPECT_FALSE(search_problem(StudyProblem{study}).costly_constraints);
  study.constraints.push_back(read_constraint("haze", 0.03));
  study.design.surface.refractive_index = 1.52;
  const StudyProblem problem(study);
  EXPECT_EQ(problem.constraints().in_look().size(), 1u);
  EXPECT_EQ(search_problem(problem).costly_constraints(problem.space().unit_of_study()).size(), 1u);
}

}  // namespace
}  // namespace papilla::tests::score_test
