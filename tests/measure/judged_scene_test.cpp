// A scene of few pixels judged as coverage does it: every row against runs of its own.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/constants.h"
#include "estimate/target.h"
#include "forward/forward.h"
#include "measure/accuracy.h"
#include "measure/coverage.h"

namespace papilla::tests::judged_scene_test {
namespace {

constexpr int kScene = 39;  // no texture, a film that is alike everywhere: the cheapest

struct Judged {
  CoverageOptions options;
  std::vector<CoverageRow> rows;
  std::vector<std::string> notes;
  Texture texture;
  Scene scene;
};
const Judged& judged() {
  static const Judged once = [] {
    Judged out;
    out.options.scenes = 1;
    out.options.first = kScene;
    out.options.grid = 16;
    out.options.skins = 4;
    out.options.finer_grid = 32;
    out.options.finer_skins = 5;
    out.options.threads = 1;
    out.scene = random_scene(kScene, out.texture);
    CoverageOptions options = out.options;
    options.note = [&](const std::string& text) { out.notes.push_back(text); };
    out.rows = coverage(options);
    return out;
  }();
  return once;
}

Fidelity level(const char* name) {
  Fidelity f = fidelity_level(name);
  f.seed = kScene + 1;
  f.threads = 1;
  return f;
}

// Of the parts of an error, those that the comparison leaves: sampling, grid, solver and method,
// and of the 3-D field what is beyond what its own pixels leave, a mean over humidity.
double total(const ErrorParts& e, const Response& r) {
  double all = 0, own = 0;
  for (const ResponsePoint& p : r.points) {
    const double field = p.field_error.value_or(0);
    all += field,
        own +=
        std::sqrt(std::max(0.0, square(field) - square(full_field_error(p.field_correction))));
  }
  const double field = e.field.value_or(0) * (all > 0 ? own / all : 1);
  return std::sqrt(square(e.sampling) + square(e.grid.value_or(0)) + square(e.solver.value_or(0)) +
                   square(e.method.value_or(0)) + square(field) + square(e.parameters.value_or(0)));
}

void expect_rows(const std::string& fidelity, std::size_t from, const Response& r) {
  Fidelity fine = level("design");
  fine.grid = 32;
  fine.skins = 5;
  fine.first_skin = 1000;
  fine.control_skins = 0;
  static const Response truth = evaluate(judged().scene, judged().texture, fine);
  const char* names[]{"modulation",   "variation",       "friction",
                      "contact_area", "capillary_force", "pull"};
  const char* metrics[]{"modulation",   "modulation",      "friction",
                        "contact_area", "capillary_force", "electrostatic_force"};
  for (std::size_t q = 0; q < 6; ++q) {
    const CoverageRow& row = judged().rows.at(from + q);
    const Summary summary = q == 1 ? Summary::Variation : Summary::Mean;
    const Metric metric = *find_metric(metrics[q]);
    const auto v = summarise(summary, metric, r), t = summarise(summary, metric, truth);
    ASSERT_TRUE(v && t);
    const auto near = [&](double value, double expected) {
      EXPECT_NEAR(value, expected, 1e-9 * std::abs(expected)) << fidelity << " " << names[q];
    };
    EXPECT_EQ(row.scene, kScene);
    EXPECT_EQ(row.texture, "flat");
    EXPECT_EQ(row.fidelity, fidelity);
    EXPECT_EQ(row.quantity, names[q]);
    near(row.value, v->value);
    near(row.half_width, 1.96 * total(v->parts, r));
    near(row.reference, t->value);
    near(row.reference_error, t->parts.sampling);
    EXPECT_EQ(row.parts.sampling, v->parts.sampling);
    EXPECT_FALSE(row.parts.humidity);
  }
}

TEST(JudgedSceneOfOneRun, BothEstimatorsOnAFewPixels) {
  ASSERT_EQ(judged().rows.size(), 30u);
  EXPECT_EQ(judged().notes, std::vector<std::string>{"scene 1 of 1"});
  Fidelity f = level("design");
  f.grid = 16;
  f.skins = 4;
  f.estimator = Estimator::Load;
  expect_rows("16 pixels 4 skins load law", 0, evaluate(judged().scene, judged().texture, f));
  f.estimator = Estimator::Area;
  expect_rows("16 pixels 4 skins solved areas", 6, evaluate(judged().scene, judged().texture, f));
}

TEST(JudgedSceneOfOneRun, LevelsAndATarget) {
  expect_rows("search", 12, evaluate(judged().scene, judged().texture, level("search")));
  expect_rows("target 5 %", 24,
              evaluate_to_target(judged().scene, judged().texture,
                                 {.target = 0.05, .seed = kScene + 1, .threads = 1}));
  for (std::size_t q = 18; q < 24; ++q) EXPECT_EQ(judged().rows[q].fidelity, "draft");
}

// Nothing asked, nothing run: 50 scenes from the first on 64 pixels, against 48 skins of 256.
TEST(Coverage, AsksForTheScenesOfTheReports) {
  const CoverageOptions options;
  EXPECT_EQ(options.scenes, 50);
  EXPECT_EQ(options.first, 0);
  EXPECT_EQ(options.grid, 64);
  EXPECT_EQ(options.skins, 12);
  EXPECT_FALSE(options.tight);
  EXPECT_EQ(CoverageRow{}.scene, 0);
  CoverageOptions none;
  none.scenes = 0;
  none.first = 7;
  EXPECT_TRUE(coverage(none).empty());
}

}  // namespace
}  // namespace papilla::tests::judged_scene_test
