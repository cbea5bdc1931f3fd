// The yield of a design against closed forms: what plates keep, by which limit and tolerance they
// break, and what a limit on it asks for.
#include "search/yield.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "base/error.h"
#include "numerics/statistics.h"
#include "search/problem.h"
#include "search/protocol.h"

namespace papilla::tests::yield_test {
namespace {

// Holes of 4.4 um every 5 um: walls of 0.6 um.
constexpr const char* kHoles = R"toml(schema_version = 1
[texture]
type = "hole_array"
period = "5 um"
diameter = "4.4 um"
depth = "350 nm"
[surface]
contact_angle = "50 deg"
[drive]
amplitude = "200 V"
frequency = "5 kHz"
[design_space]
"texture.depth" = ["100 nm", "900 nm"]
[objective]
maximise = "mean(modulation)"
)toml";

Study study_with(const std::string& more) { return parse_study(kHoles + more, "holes.toml"); }

// A modulation that is linear in the deviations, in units of the ends; no field.
Score linear(const StudyProblem& problem, double nominal, const std::vector<double>& slopes,
             double error = 0) {
  std::vector<TaskAnswer> answers;
  for (const StudyTask& task : problem.tasks()) {
    TaskAnswer a;
    double value = nominal;
    if (!task.nominal()) value += task.sign * slopes.at(static_cast<std::size_t>(task.scattered));
    a.objectives = {{value, 0.01, std::vector<double>(1, value)}};
    a.limited.assign(problem.goals().limited.size(), value);
    a.limited_errors.assign(a.limited.size(), error);
    a.oxide_margin = kInfinity;
    a.worst = value;
    answers.push_back(std::move(a));
  }
  return problem.score(problem.study().design, answers);
}

Yield yield_of(const Study& study, const std::vector<double>& slopes, double error = 0) {
  const StudyProblem problem(study);
  const auto yield = problem.yield(study.design, linear(problem, 0.5, slopes, error));
  EXPECT_TRUE(yield.has_value());
  return yield.value_or(Yield{});
}

// Within three errors, and within half a point.
void expect_share(const YieldShare& share, double exact) {
  EXPECT_NEAR(share.share, exact, 0.005);
  EXPECT_LE(std::abs(share.share - exact), 3 * share.error + 1e-3);
}

const std::string kLimit = "[constraints]\n\"worst(modulation)\" = 0.46\n";

TEST(Yield, OfOneLinearLimitIsThatOfItsDistribution) {
  // 0.5 + 0.1 u is at least 0.46 from u = -0.4 on.
  const Yield uniform =
      yield_of(study_with("[scatter]\n\"texture.depth\" = \"20 nm\"\n" + kLimit), {0.1});
  expect_share(uniform.now, 0.7);
  EXPECT_LT(uniform.now.error, 0.002);
  // Half the tolerance: from -0.8 on.
  expect_share({uniform.now.share + uniform.halved.at(0).share, 0.002}, 0.9);
  EXPECT_EQ(uniform.costliest(), 0u);
  EXPECT_EQ(uniform.plates, kPlates);
  ASSERT_EQ(uniform.broken.size(), 1u);
  EXPECT_DOUBLE_EQ(uniform.broken[0], 1 - uniform.now.share);
  // Of a normal one the end is sqrt(3) standard deviations away.
  const Yield normal = yield_of(
      study_with("[scatter]\n\"texture.depth\" = { sigma = \"20 nm\" }\n" + kLimit), {0.1});
  expect_share(normal.now, normal_cdf(0.4 * std::sqrt(3.0)));
  expect_share({normal.now.share + normal.halved.at(0).share, 0.002},
               normal_cdf(0.8 * std::sqrt(3.0)));
}

TEST(Yield, OfTwoNumbersKnowsTheirCorrelation) {
  for (const double correlation : {0.0, 0.6, -0.6}) {
    const Yield yield = yield_of(
        study_with(
            "[scatter]\n\"texture.depth\" = { sigma = \"20 nm\" }\n\"surface.contact_angle\" "
            "= { sigma = \"2 deg\" }\ncorrelation = [{ between = [\"texture.depth\", "
            "\"surface.contact_angle\"], value = " +
            std::to_string(correlation) + " }]\n" + kLimit),
        {0.1, 0.05});
    const double sd = std::sqrt((0.01 + 0.0025 + 2 * 0.1 * 0.05 * correlation) / 3);
    expect_share(yield.now, normal_cdf(0.04 / sd));
    EXPECT_EQ(yield.costliest(), 0u) << correlation;
  }
}

// Uniform numbers have the correlation that was asked for, and stay uniform.
TEST(Yield, PlatesHaveTheCorrelationAskedFor) {
  using Kind = Scatter::Kind;
  for (const Kind second : {Kind::Uniform, Kind::Normal}) {
    for (const double wanted : {0.7, -0.4}) {
      const ScatterLaw law({{"a", 1}, {"b", 1, second}}, {{"a", "b", wanted}});
      double both = 0, a2 = 0, b2 = 0;
      constexpr int kCount = 20000;
      for (int i = 0; i < kCount; ++i) {
        const std::vector<double> u = law.plate(3, static_cast<std::uint64_t>(i));
        both += u[0] * u[1] / kCount, a2 += u[0] * u[0] / kCount, b2 += u[1] * u[1] / kCount;
        EXPECT_LE(std::abs(u[0]), 1);
      }
      EXPECT_NEAR(a2, 1.0 / 3, 3e-3);
      EXPECT_NEAR(b2, 1.0 / 3, 3e-3);
      EXPECT_NEAR(both / std::sqrt(a2 * b2), wanted, 5e-3);
    }
  }
}

// Walls of 0.6 um less what a diameter is too wide: known of every plate without an evaluation.
TEST(Yield, OfAShapeIsCountedPlateByPlate) {
  const Yield yield = yield_of(study_with("[scatter]\n\"texture.diameter\" = \"300 nm\"\n"
                                          "\"surface.contact_angle\" = \"5 deg\"\n"
                                          "[constraints]\nmin_wall = \"0.48 um\"\n"),
                               {0, 0});
  expect_share(yield.now, (300.0 + 120.0) / 600.0);
  EXPECT_EQ(yield.costliest(), 0u);
  EXPECT_EQ(yield.halved.at(1).share, 0);
  EXPECT_EQ(yield.not_makeable, 0);
}

// A quadratic of one number: 0.5 - 0.1 u^2 is at least 0.46 within sqrt(0.4).
TEST(Yield, FollowsTheCurvatureOfALimit) {
  const Study study = study_with("[scatter]\n\"texture.depth\" = \"20 nm\"\n" + kLimit);
  const StudyProblem problem(study);
  Score score = linear(problem, 0.5, {0});
  for (std::size_t end : {1u, 2u}) score.by_task.at(end).limited = {0.4};
  expect_share(problem.yield(study.design, score)->now, std::sqrt(0.4));
}

// What the error of a limited metric leaves open is in the error: 0.02 of a width of 0.2.
TEST(Yield, HasTheErrorOfTheLimitedMetrics) {
  const Study study = study_with("[scatter]\n\"texture.depth\" = \"20 nm\"\n" + kLimit);
  EXPECT_NEAR(yield_of(study, {0.1}, 0.02).now.error, 0.1, 0.003);
}

// A limit on the yield: the other limits and the worst modulation are the design's own then, and
// the ends are the yield's.
TEST(Yield, AsALimitIsJudgedBesideTheDesignAsDrawn) {
  const std::string scatter = "[scatter]\n\"texture.depth\" = \"20 nm\"\n";
  const Study strict = study_with(scatter + kLimit);
  const Study by_yield = study_with(scatter + kLimit + "yield = \"90 %\"\n");
  const StudyProblem without(strict), with(by_yield);
  const Score ends = linear(without, 0.5, {0.1}), drawn = linear(with, 0.5, {0.1});
  EXPECT_DOUBLE_EQ(ends.limited.at(0), 0.4);
  EXPECT_DOUBLE_EQ(ends.worst, 0.4);
  EXPECT_FALSE(ends.yield.has_value());
  EXPECT_DOUBLE_EQ(drawn.limited.at(0), 0.5);
  EXPECT_DOUBLE_EQ(drawn.worst, 0.5);
  ASSERT_TRUE(drawn.yield.has_value());
  EXPECT_NEAR(drawn.yield->share, 0.7, 0.01);
  const std::vector<double> violations = with.constraints().violations(drawn);
  ASSERT_EQ(violations.size(), 2u);
  EXPECT_LT(violations[0], 0);
  EXPECT_NEAR(violations[1], 0.9 / drawn.yield->share - 1, 1e-12);
  EXPECT_FALSE(with.feasible(drawn, by_yield.design));
  EXPECT_TRUE(with.feasible(linear(with, 0.56, {0.1}), by_yield.design));
  EXPECT_FALSE(without.feasible(linear(without, 0.54, {0.1}), strict.design));
}

// What is announced for a study has its plates; a look takes a millisecond, so that they are few.
TEST(Yield, IsPricedByItsPlates) {
  const std::string scatter = "[scatter]\n\"texture.depth\" = \"20 nm\"\n";
  const Study none = study_with(kLimit), own = study_with(scatter + kLimit),
              limited = study_with(scatter + kLimit + "yield = \"90 %\"\n"),
              looks = study_with(scatter + "[constraints]\nhaze = \"10 %\"\n");
  EXPECT_EQ(yield_price(none, 0, 50, 9), 0);
  EXPECT_DOUBLE_EQ(yield_price(own, 0, 50, 9), 1e-5 * 2 * kPlates);
  EXPECT_DOUBLE_EQ(yield_price(limited, 0, 50, 9), 1e-5 * (11 * kPlates + 50 * kFewPlates));
  EXPECT_DOUBLE_EQ(yield_price(looks, 1, 50, 9), 1e-3 * 2 * kFewPlates);
  EXPECT_DOUBLE_EQ(yield_price(looks, 3, 50, 9), 3 * 1e-3 * 2 * kFewPlates);  // three scenarios
  EXPECT_EQ(plates_of(looks, true), kFewPlates);
}

// Nobody misses the depth of a texture that is not there.
TEST(Yield, OfAFlatSurfaceDoesNotHangOnItsTexture) {
  const Study study = study_with("[scatter]\n\"texture.depth\" = \"20 nm\"\n" + kLimit);
  Design flat = study.design;
  flat.texture = Texture{};
  const StudyProblem problem(study);
  for (const StudyTask& task : problem.tasks())
    EXPECT_EQ(task_design(study, flat, task).texture, flat.texture) << task.name;
}

TEST(Yield, WhatCannotBeIsRefusedWithTheWayOut) {
  const auto refusal = [](const std::string& more) -> std::string {
    try {
      study_with(more);
    } catch (const InputError& error) {
      return error.problems().front().message;
    }
    return "";
  };
  EXPECT_NE(refusal("[constraints]\nmin_wall = \"0.4 um\"\nyield = \"95 %\"\n").find("[scatter]"),
            std::string::npos);
  const std::string scatter =
      "[scatter]\n\"texture.depth\" = \"20 nm\"\n\"texture.diameter\" = \"9 nm\"\n";
  EXPECT_NE(refusal(scatter + "[constraints]\nyield = \"95 %\"\n").find("no other limit"),
            std::string::npos);
  EXPECT_NE(refusal(scatter + "[constraints]\nmin_wall = \"0.4 um\"\nyield = \"101 %\"\n")
                .find("at most 100 %"),
            std::string::npos);
  const auto correlated = [&](const std::string& a, const std::string& b,
                              const std::string& value) {
    return refusal(scatter + "correlation = [{ between = [\"" + a + "\", \"" + b +
                   "\"], value = " + value + " }]\n");
  };
  EXPECT_EQ(correlated("texture.depth", "texture.diameter", "0.5"), "");
  EXPECT_NE(correlated("texture.depth", "texture.diameter", "1").find("nearer to 0"),
            std::string::npos);
  EXPECT_NE(correlated("texture.depth", "texture.period", "0.5").find("has no tolerance"),
            std::string::npos);
  EXPECT_NE(correlated("texture.depth", "texture.depth", "0.5").find("stands twice"),
            std::string::npos);
  EXPECT_NE(refusal(scatter + "correlation = 3\n").find("expected a list of { between"),
            std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::yield_test
