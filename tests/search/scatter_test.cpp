// Robustness to fabrication: the distribution over the scatter, and a study that uses it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/error.h"
#include "base/random.h"
#include "search/problem.h"
#include "search/task.h"

namespace papilla::tests::scatter_test {
namespace {

const std::string kStudy = PAPILLA_SOURCE_DIR "/designs/m3_glass/conformal.toml";
const std::vector<std::string> kSmall{"environment.relative_humidity=[\"55 %\"]",
                                      "population.fingers=[\"../fingers/reference.toml\"]"};

Study small_study(const std::vector<std::string>& more) {
  std::vector<std::string> overrides = kSmall;
  overrides.insert(overrides.end(), more.begin(), more.end());
  return read_study(kStudy, overrides);
}

// So many numbers, uniform and independent.
ScatterLaw uniform(std::size_t numbers) {
  return {std::vector<Scatter>(numbers, Scatter{"texture.depth", 1}), {}};
}

double mean_of(const std::vector<double>& v) {
  return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
}
double std_of(const std::vector<double>& v) {
  const double mean = mean_of(v);
  double sum = 0;
  for (double x : v) sum += (x - mean) * (x - mean);
  return std::sqrt(sum / static_cast<double>(v.size()));
}

// f = 3 + sum of a u + b u^2, each u uniform in [-1, 1].
struct Quadratic {
  std::vector<double> a{0.4, -0.2, 0.05}, b{0.1, -0.3, 0.2};

  double at(const std::vector<double>& u) const {
    double f = 3;
    for (std::size_t k = 0; k < a.size(); ++k) f += a[k] * u[k] + b[k] * u[k] * u[k];
    return f;
  }
  std::vector<double> ends(double sign) const {
    std::vector<double> out;
    for (std::size_t k = 0; k < a.size(); ++k) out.push_back(3 + sign * a[k] + b[k]);
    return out;
  }
  std::vector<double> sample(int count) const {
    RandomStream random(1, "scatter");
    std::vector<double> out;
    for (int i = 0; i < count; ++i) {
      std::vector<double> u;
      for (std::size_t k = 0; k < a.size(); ++k) u.push_back(random.uniform(-1.0, 1.0));
      out.push_back(at(u));
    }
    return out;
  }
  std::vector<double> values(const char* risk, bool higher) const {
    return scattered_values(parse_risk(risk), higher, 3, ends(-1), ends(1), uniform(a.size()));
  }
};

TEST(Scatter, HasTheMomentsOfTheQuadraticModel) {
  const Quadratic q;
  const std::vector<double> sample = q.sample(200000);
  EXPECT_NEAR(mean_of(q.values("", true)), mean_of(sample), 2e-3);
  EXPECT_NEAR(mean_of(q.values("mean - 2 std", true)), mean_of(sample), 2e-3);
  EXPECT_NEAR(std_of(q.values("mean - 2 std", true)), std_of(sample), 2e-3);
}

TEST(Scatter, TheWorstIsTheLeastOverTheWholeBox) {
  const Quadratic q;
  std::vector<double> grid;
  for (int i = 0; i <= 40; ++i) {
    for (int j = 0; j <= 40; ++j) {
      for (int k = 0; k <= 40; ++k) grid.push_back(q.at({i / 20. - 1, j / 20. - 1, k / 20. - 1}));
    }
  }
  EXPECT_NEAR(q.values("worst", true)[0], *std::min_element(grid.begin(), grid.end()), 2e-3);
  EXPECT_NEAR(q.values("worst", false)[0], *std::max_element(grid.begin(), grid.end()), 2e-3);
}

TEST(Scatter, TheCvarIsThatOfALargeSample) {
  const Quadratic q;
  std::vector<double> sample = q.sample(200000);
  std::sort(sample.begin(), sample.end());
  sample.resize(sample.size() / 5);
  const std::vector<double> values = q.values("cvar 20 %", true);
  const std::vector<double> weights(values.size(), 1.0);
  EXPECT_NEAR(apply_risk(parse_risk("cvar 20 %"), true, values, weights), mean_of(sample), 0.02);
}

TEST(Scatter, WithoutScatterTheNominalValueStays) {
  EXPECT_EQ(scattered_values(parse_risk("cvar 20 %"), true, 7, {}, {}, {}), std::vector<double>{7});
}

TEST(Scatter, AStudyJudgesTheDesignWithinItsTolerances) {
  const Study study = small_study({"scatter.texture.depth=60 nm", "objective.risk=worst"});
  const StudyProblem problem(study);
  ASSERT_EQ(problem.nominal_tasks(), 1u);
  ASSERT_EQ(problem.tasks().size(), 3u);
  Fidelity f = fidelity_level("search");
  f.skins = 4;
  const Design design = study.design;
  std::vector<TaskAnswer> tasks;
  for (std::size_t t = 0; t < 3; ++t) tasks.push_back(evaluate_task(problem, design, t, {f}));
  const auto value = [&](std::size_t t) { return tasks[t].objectives[0].value; };
  // The ends are designs of their own.
  for (const auto& [t, depth] : {std::pair(1, 290e-9), std::pair(2, 410e-9)}) {
    const Design moved = with_settings(design, {{"texture.depth", depth}});
    EXPECT_NEAR(evaluate_task(problem, moved, 0, {f}).objectives[0].value,
                value(static_cast<std::size_t>(t)), 1e-12);
  }
  const Score worst = problem.score(problem.study().design, tasks);
  ASSERT_TRUE(worst.ok) << worst.reason;
  EXPECT_LE(worst.values[0], std::min({value(0), value(1), value(2)}) + 1e-12);
  EXPECT_LT(worst.values[0], value(0));
}

TEST(Scatter, AShapeThatCannotExistWithinItsToleranceIsRefused) {
  const Study study = small_study({"scatter.texture.diameter=300 nm"});
  const StudyProblem problem(study);
  // period 5 um: a hole of 4.8 um may come out as 5.1 um.
  EXPECT_NE(
      problem.constraints().geometry_reason(problem.space().unit({5e-6, 4.8e-6, 350e-9, 0.87})),
      "");
  EXPECT_EQ(
      problem.constraints().geometry_reason(problem.space().unit({5e-6, 4.0e-6, 350e-9, 0.87})),
      "");
}

TEST(Scatter, WrongTolerancesAreReported) {
  EXPECT_THROW(small_study({"scatter.texture.depht=10 nm"}), InputError);
  EXPECT_THROW(small_study({"scatter.texture.depth=0 nm"}), InputError);
  EXPECT_THROW(small_study({"scatter.texture.depth=3 deg"}), InputError);
}

TEST(Target, TheDistanceIsTheRootMeanSquareOverHumidityAndFingers) {
  const Study study = small_study({"objective={ target = { modulation = 0.8 } }",
                                   "environment.relative_humidity=[\"15 %\", \"75 %\"]"});
  const StudyProblem problem(study);
  ASSERT_EQ(problem.objectives().size(), 1u);
  EXPECT_EQ(problem.objectives()[0].name, "distance(modulation = 0.8)");
  Fidelity f = fidelity_level("search");
  f.skins = 4;
  const TaskAnswer task = evaluate_task(problem, study.design, 0, {f});
  ASSERT_TRUE(task.status.ok()) << task.status.text;
  const std::vector<double>& points = task.objectives[0].points;
  const double a = points[0] - 0.8, b = points[1] - 0.8;
  EXPECT_NEAR(problem.score(problem.study().design, {task}).values[0],
              std::sqrt((a * a + b * b) / 2), 1e-12);
  EXPECT_THROW(small_study({"objective={ target = { modulatoin = 0.8 } }"}), InputError);
}

// Over all of the scatter the tail is the mean, nominal + sum of b/3; a slope alone is even.
TEST(Scatter, TheSampleOfATailLiesOnTheQuadratic) {
  const auto sample = [](double a, double b) {
    return scattered_values(parse_risk("cvar 20 %"), true, 2, {2 - a + b}, {2 + a + b}, uniform(1));
  };
  for (const auto& [a, b] : {std::pair{0.0, 0.6}, {0.0, -0.6}, {0.3, 0.0}, {0.3, 0.6}}) {
    const std::vector<double> values = sample(a, b);
    ASSERT_EQ(values.size(), 128u);
    EXPECT_NEAR(mean_of(values), 2 + b / 3, 0.01) << a << " " << b;
    EXPECT_NEAR(std_of(values), std::sqrt(a * a / 3 + 4 * b * b / 45), 0.02) << a << " " << b;
  }
  for (const double v : sample(0, 0.6)) EXPECT_GE(v, 2);
}

}  // namespace
}  // namespace papilla::tests::scatter_test
