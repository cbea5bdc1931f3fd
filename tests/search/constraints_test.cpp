// Limits of a study: how far beyond one a design is, and how people read it.
#include "search/constraints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "report/limits.h"
#include "report/stated_number.h"
#include "search/problem.h"
#include "tests/support/refusal.h"
#include "tests/support/without_belief.h"

namespace papilla::tests::constraints_test {
namespace {

Study limited(const std::vector<Constraint>& constraints) {
  Study study = without_belief(read_study(PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml"));
  study.population.clear();
  study.constraints = constraints;
  return study;
}

// Of a limit at least: limit / value - 1, at most: value / limit - 1; bounded by 11.
TEST(Constraints, OfAShapeAreRelativeToTheirLimit) {
  const Study study =
      limited({read_constraint("min_wall", 0.5e-6), read_constraint("min_hole", 2e-6),
               read_constraint("aspect_ratio", 0.05)});
  const StudyProblem problem(study);
  // Period 5 um, holes of 4 um, 400 nm deep, walls of 1 um at 88 degrees from the land.
  const Point unit = problem.space().unit({5e-6, 4e-6, 400e-9, 0.87});
  const std::vector<double> g = problem.constraints().geometry(unit);
  ASSERT_EQ(g.size(), 4u);
  EXPECT_EQ(g[0], -1);  // it can be made
  EXPECT_NEAR(g[1], 0.5 - 1, 1e-9);
  EXPECT_NEAR(g[2], 2 / (4 - 0.8 * std::tan(kPi / 90)) - 1, 1e-9);
  EXPECT_NEAR(g[3], 0.4 / 0.05 - 1, 1e-9);
  EXPECT_EQ(problem.constraints().geometry_reason(unit), "aspect_ratio 0.4 is above 0.05");
}

TEST(Constraints, OfAnEvaluationAreRelativeAndBounded) {
  const Study study =
      limited({read_constraint("oxide_breakdown_margin", 2),
               read_constraint("mean(friction)", 0.05), read_constraint("min_wall", 0.5e-6)});
  const StudyProblem problem(study);
  ASSERT_EQ(problem.constraints().evaluated(), 2u);
  const auto violations = [&](double margin, double friction) {
    Score score;
    score.oxide_margin = margin;
    score.limited = {friction};
    return problem.constraints().violations(score);
  };
  EXPECT_EQ(violations(4, 0.075), (std::vector<double>{2.0 / 4 - 1, 0.075 / 0.05 - 1}));
  EXPECT_EQ(violations(1, 0), (std::vector<double>{1, -1}));
  EXPECT_EQ(violations(0, 0.05), (std::vector<double>{11, 0}));  // never
  const double large = violations(1, 0.05 * 21)[1], larger = violations(1, 0.05 * 41)[1];
  EXPECT_NEAR(large, 11 - 10.0 / 20, 1e-9);
  EXPECT_NEAR(larger, 11 - 10.0 / 40, 1e-9);
}

TEST(Constraints, ThoseThatNobodyKeepsAreNamed) {
  const Study study = limited({read_constraint("min_wall", 5.5e-6), read_constraint("haze", 0.05),
                               read_constraint("mean(friction)", 0.05)});
  const StudyProblem problem(study);
  Evaluation refused, judged;
  refused.outcome.constraints = {-1, 0.3, 0.2};
  judged.outcome.ok = true;
  judged.outcome.constraints = {0.5};
  const auto never = [&](const std::vector<Evaluation>& tried) {
    return problem.constraints().never_kept(tried);
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(never({refused}), (Names{"min_wall (at least 5.5 um)", "haze (at most 5 %)"}));
  EXPECT_EQ(never({refused, judged}), (Names{"mean(friction) (at most 50 mN)"}));
  judged.outcome.constraints = {-0.1};
  EXPECT_EQ(never({refused, judged}), Names{});
  EXPECT_EQ(never({}), Names{});
}

// 5.41 um less 5.01 um is a wall of 0.4 um, though not to the last bit.
TEST(Constraints, AreKeptWithinABillionth) {
  const Study study = limited({read_constraint("min_wall", 0.4e-6)});
  const StudyProblem problem(study);
  ASSERT_LT(5.41e-6 - 5.01e-6, 0.4e-6);
  const auto wall = [&](double period) {
    return problem.constraints().geometry(problem.space().unit({period, 5.01e-6, 100e-9, 1}))[1];
  };
  EXPECT_LE(wall(5.41e-6), 0);
  EXPECT_GT(wall(5.41e-6 - 1e-14), 0);
  for (const bool at_least : {true, false}) {
    const Constraint limit{MetricLimit{parse_metric("mean(friction)")}, 0.05, at_least};
    const double worse = at_least ? -1 : 1;
    EXPECT_TRUE(keeps(limit, 0.05 * (1 + worse * 0.9e-9)));
    EXPECT_FALSE(keeps(limit, 0.05 * (1 + worse * 1.1e-9)));
  }
}

// The design that a study starts from keeps its limits where they are its own numbers.
TEST(Constraints, OfAStudyAreKeptByItsOwnDesign) {
  Study study = limited({});
  const FabricationMargins own = facts(study.design.texture).margins;
  study.constraints = {read_constraint("min_wall", own.min_wall),
                       read_constraint("min_hole", own.min_hole),
                       read_constraint("aspect_ratio", own.aspect_ratio)};
  const StudyProblem problem(study);
  for (const double v : problem.constraints().geometry(problem.space().unit_of_study()))
    EXPECT_LE(v, 0);
}

TEST(Constraints, ReadAsBrokenWhereTheyAre) {
  const Constraint wall = read_constraint("min_wall", 0.4e-6);
  EXPECT_EQ(report::as_read(report::limit_broken({wall, 0.39999e-6})),
            "min_wall is 0.39999 um, below your limit of 0.4 um");
  EXPECT_EQ(limit_value_text(wall, 0.4e-6 * (1 - 1e-10)), "0.4 um");  // kept
  EXPECT_EQ(limit_value_text(wall, 0.40001e-6), "0.4 um");
  EXPECT_EQ(limit_value_text(wall, 0.123456e-6), "0.1235 um");
  const Constraint ratio = read_constraint("aspect_ratio", 1.23456);
  EXPECT_EQ(limit_text(ratio), "at most 1.23456");
  EXPECT_EQ(limit_value_text(ratio, 1.2346), "1.235");
  EXPECT_EQ(limit_value_text(ratio, 1.23454), "1.2345");  // 1.235 would be above it
  EXPECT_EQ(limit_value_text(ratio, 0.87654), "0.8765");
  const Constraint haze = read_constraint("haze", 0.2);
  EXPECT_EQ(limit_value_text(haze, 2.018e-12), "0 %");  // the last bits of a sum
  EXPECT_EQ(limit_value_text(haze, 1e-5), "0.001 %");
  EXPECT_EQ(limit_value_text(read_constraint("haze", 0), 2e-12), "2e-10 %");  // not kept
}

TEST(Constraints, HaveAValueOfEachDesign) {
  const Study study =
      limited({read_constraint("min_wall", 0.5e-6), read_constraint("oxide_breakdown_margin", 2),
               read_constraint("mean(friction)", 0.05)});
  const StudyProblem problem(study);
  Score score;
  score.ok = true;
  score.oxide_margin = 1.995;
  score.limited = {0.036};
  const Design design = problem.space().design(problem.space().unit({5e-6, 4e-6, 400e-9, 0.87}));
  const std::vector<LimitValue> values = problem.constraints().values(design, score);
  ASSERT_EQ(values.size(), 3u);
  EXPECT_NEAR(values[0].value, 1e-6, 1e-12);
  EXPECT_TRUE(values[0].kept());
  EXPECT_NEAR(values[1].value, 1.995, 1e-12);
  EXPECT_FALSE(values[1].kept());
  EXPECT_EQ(limit_value_text(values[1].limit, values[1].value), "1.995");
  EXPECT_EQ(limit_text(values[0].limit), "at least 0.5 um");
  EXPECT_EQ(limit_value_text(values[2].limit, values[2].value), "36 mN");
  EXPECT_TRUE(values[2].kept());
  EXPECT_FALSE(problem.constraints().kept(design, score));
}

// Each number of a vector of violations is beside the limit that it judges: the limit alone gives
// the same number.
TEST(Constraints, NumbersStandBesideTheirLimits) {
  const Study study =
      limited({read_constraint("mean(friction)", 0.05), read_constraint("haze", 0.05),
               read_constraint("oxide_breakdown_margin", 2), read_constraint("min_wall", 0.5e-6),
               read_constraint("worst(friction)", 0.06), read_constraint("aspect_ratio", 3)});
  const StudyProblem problem(study);
  const StudyConstraints& constraints = problem.constraints();
  const Design design = problem.space().design(problem.space().unit({5e-6, 4e-6, 400e-9, 0.87}));
  Score score;
  score.ok = true;
  score.oxide_margin = 1.5;
  score.limited = {0.036, 0.07};
  std::set<const Constraint*> seen;
  const auto compare = [&](const Judged& judged, const std::vector<double>& numbers,
                           const auto& value) {
    ASSERT_EQ(judged.size(), numbers.size());
    for (std::size_t k = 0; k < judged.size(); ++k) {
      if (!judged[k]) continue;  // that the shape exists
      seen.insert(judged[k]);
      EXPECT_EQ(numbers[k], violation(*judged[k], value(judged[k]->on)))
          << limit_name(judged[k]->on);
    }
  };
  const auto before = constraints.before_evaluation(design);
  EXPECT_EQ(constraints.in_before_evaluation()[0], nullptr);
  EXPECT_EQ(before[0], -1);
  compare(constraints.in_before_evaluation(), before, [&](const Limited& on) {
    if (on == Limited{ShapeLimit{ShapeMargin::MinWall}})
      return facts(design.texture).margins.min_wall;
    if (on == Limited{ShapeLimit{ShapeMargin::AspectRatio}})
      return facts(design.texture).margins.aspect_ratio;
    return on == Limited{FilmLimit{}} ? constraints.film_margin(design)
                                      : appearance_of(design).haze;
  });
  compare(constraints.in_evaluation(), constraints.violations(score), [&](const Limited& on) {
    if (on == Limited{FilmLimit{}}) return 1.5;
    return limit_name(on) == "mean(friction)" ? 0.036 : 0.07;
  });
  EXPECT_EQ(seen.size(), study.constraints.size());
}

// The film holds the drives that tasks have: not that of the study where each scenario has its own,
// nor that of a scenario without weight.
TEST(Constraints, OfTheFilmAreForTheDrivesOfTheScenarios) {
  Study study = limited({read_constraint("oxide_breakdown_margin", 2)});
  const auto margin = [&] { return StudyProblem(study).constraints().film_margin(study.design); };
  const double own = margin(), volts = study.design.drive.amplitude;
  study.scenarios = {{"weak", 1, {{"drive.amplitude", volts / 2}}},
                     {"never", 0, {{"drive.amplitude", 4 * volts}}}};
  EXPECT_NEAR(margin(), 2 * own, 1e-9 * own);
  study.scenarios[1].weight = 1;
  EXPECT_NEAR(margin(), own / 4, 1e-9 * own);
}

// Whatever a shipped study limits has a name that reads back to it, and a value on its own design.
TEST(Constraints, HaveAValueInEveryShippedStudy) {
  namespace fs = std::filesystem;
  std::set<std::size_t> alternatives;
  int limits = 0;
  for (const auto& entry : fs::recursive_directory_iterator(PAPILLA_SOURCE_DIR "/designs")) {
    const std::string file = entry.path().string();
    if (!file.ends_with(".toml") || read_bytes(file).find("[constraints]") == std::string::npos)
      continue;
    const Study study = read_study(file);
    const StudyProblem problem(study);
    Score score;
    score.ok = true;
    score.oxide_margin = 3;
    score.limited.assign(problem.goals().limited.size(), 0.25);
    score.yield = YieldShare{0.9, 0.01};
    const std::vector<LimitValue> values = problem.constraints().values(study.design, score);
    ASSERT_EQ(values.size(), study.constraints.size()) << file;
    for (const LimitValue& v : values) {
      EXPECT_EQ(read_constraint(limit_name(v.limit.on), v.limit.limit), v.limit) << file;
      EXPECT_FALSE(std::isnan(v.value)) << file << " " << limit_name(v.limit.on);
      EXPECT_FALSE(limit_value_text(v.limit, v.value).empty());
      EXPECT_EQ(v.kept(), violation(v.limit, v.value) <= 0);
      alternatives.insert(v.limit.on.index());
      ++limits;
    }
  }
  EXPECT_GE(limits, 10);
  EXPECT_GE(alternatives.size(), 3u);
}

// All limits with a key of their own and all metrics with a better direction: the text reads back.
TEST(Constraints, ReadBackFromTheirNames) {
  for (const ConstraintKind& kind : constraint_kinds()) {
    const Constraint limit = read_constraint(kind.name, 0.3);
    EXPECT_EQ(limit.on, kind.on);
    EXPECT_EQ(limit_name(limit.on), kind.name);
    EXPECT_EQ(limit.at_least, kind.at_least);
  }
  for (const char* key : {"worst(modulation)", "variation(friction)", "mean(haze)",
                          "worst(voltage_for(modulation = 0.3))", "mean(felt(modulation = 0.2))"}) {
    const Constraint limit = read_constraint(key, 0.3);
    EXPECT_EQ(limit.on, Limited{MetricLimit{parse_metric(key)}});
    EXPECT_EQ(limit_name(limit.on), key);
  }
  EXPECT_THROW(read_constraint("min_whole", 1), InputError);
  EXPECT_THROW(read_constraint("mean(bridges)", 1), InputError);  // of no better direction
}

// Holes of 5 um and walls of 8 um take a period of 13 um, where the space ends at 10.
TEST(Constraints, ThatContradictEachOtherAreNamedWithWhatThereIs) {
  Study study = limited({read_constraint("min_hole", 5e-6), read_constraint("min_wall", 8e-6),
                         read_constraint("haze", 0.3)});
  const auto both = StudyProblem(study).constraints().contradiction();
  ASSERT_TRUE(both);
  EXPECT_EQ(both->text.find("constraints: no texture of [design_space] keeps min_hole (at least 5 "
                            "um) and min_wall (at least 8 um): the nearest has min_hole "),
            0u)
      << both->text;
  EXPECT_NE(both->text.find("(at texture.period 10 um, "), std::string::npos) << both->text;
  EXPECT_TRUE(both->flat_keeps);  // a depth of 0 is in the space
  EXPECT_EQ(study_warnings(StudyProblem(study)),
            std::vector<std::string>{both->text + "; only the flat surface is left"});
  study.constraints = {read_constraint("min_wall", 20e-6), read_constraint("min_hole", 1e-6)};
  study.variables[2].low = 100e-9;
  const auto one = StudyProblem(study).constraints().contradiction();
  ASSERT_TRUE(one);
  EXPECT_EQ(one->text.find("constraints: no texture of [design_space] keeps min_wall (at least 20 "
                           "um): the nearest has min_wall "),
            0u)
      << one->text;
  EXPECT_FALSE(one->flat_keeps);
  EXPECT_EQ(refusal_of([&] { study_warnings(StudyProblem(study)); }), one->text);
  study.constraints = {read_constraint("min_hole", 5e-6),
                       read_constraint("min_wall", 4.9e-6)};  // just so
  EXPECT_FALSE(StudyProblem(study).constraints().contradiction());
  EXPECT_TRUE(study_warnings(StudyProblem(study)).empty());
}

}  // namespace
}  // namespace papilla::tests::constraints_test
