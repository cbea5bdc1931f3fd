// A skin that is smooth over many pixels is the same body on every grid: its pull moves with the
// grid only as that of the potential itself does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "forward/forward.h"
#include "forward/scene_terms.h"
#include "measure/field_accuracy.h"
#include "physics/electrostatics/full_field.h"
#include "tests/support/one_pass.h"

namespace papilla::tests::refined_bodies_test {
namespace {

Design smooth_skin() {
  Design design = read_design(find_design("m3_samples/a3h350.toml"));
  design.finger = one_pass_finger();
  design.model = design.finger.calibrated_for;
  design.finger.skin.roll_off = 12e-6;
  design.finger.skin.cutoff = 4e-6;
  return design;
}

// Rows of few pixels, and what the processor had done before and after [s].
struct TimedRows {
  std::vector<FieldAccuracyRow> rows;
  double before, after;
};
TimedRows run(const Design& design, const FieldAccuracyOptions& options) {
  const auto spent = [] { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  TimedRows out;
  out.before = spent();
  out.rows = field_accuracy("name", design, options);
  out.after = spent();
  return out;
}

TEST(RefinedBodies, HaveThePullOfTheirPotential) {
  Design design = smooth_skin();
  design.texture = Texture{};
  design.environment.relative_humidity = {0.55};
  for (double& v : design.finger.water.volume) v = 0;
  FieldAccuracyOptions options;
  options.pixels = 32;
  options.skin = 3;
  const TimedRows r = run(design, options);
  ASSERT_EQ(r.rows.size(), 6u);
  const char* methods[]{"local", "screened", "spread", "full", "full", "full"};
  const int pixels[]{32, 32, 32, 32, 64, 128};
  double least = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const FieldAccuracyRow& row = r.rows[i];
    EXPECT_EQ(row.sample, "name");
    EXPECT_EQ(row.method, methods[i]);
    EXPECT_EQ(row.relative_humidity, 0.55);
    EXPECT_EQ(row.pixels, pixels[i]);
    EXPECT_EQ(row.status, "");
    EXPECT_NEAR(row.error, row.pull / r.rows[5].pull - 1, 1e-14);
    EXPECT_GE(row.seconds, 0);
    least += row.seconds;
  }
  EXPECT_LE(least, r.after - r.before);  // the shortest of the runs that were timed
  // The field that spreads and the 3-D one, on any grid: within three tenths of a per cent.
  for (std::size_t i = 2; i < 6; ++i) EXPECT_LT(std::abs(r.rows[i].error), 4e-3) << i;
  // Finer grids come nearer, and by less at each step.
  EXPECT_LT(std::abs(r.rows[4].error), std::abs(r.rows[3].error));
}

// The rules on the patch as it was solved: the gap, the texture under its films, the water under
// the drive.
TEST(RefinedBodies, StartAtTheSolvedPatch) {
  Design design = smooth_skin();
  design.environment.relative_humidity = {0.15, 0.75};
  FieldAccuracyOptions options;
  options.pixels = 32;
  options.skin = 2;
  options.refinements = {1, 2};
  const TimedRows r = run(design, options);
  ASSERT_EQ(r.rows.size(), 10u);
  Fidelity fidelity = fidelity_level("draft");
  fidelity.grid = 32;
  const Scene scene = scene_of(design);
  for (std::size_t k = 0; k < 2; ++k) {
    const double humidity = design.environment.relative_humidity[k];
    const PatchPicture p = picture_patch(scene, design.texture, fidelity, humidity, 2);
    const CoveredSurface surface(p.texture, film_layers(design.surface));
    const Gap gap{p.texture.grid, p.fields.off.gap};
    FieldProblem problem = field_problem(scene, humidity);
    const auto expect = [&](std::size_t row, const FieldSolution& s) {
      EXPECT_EQ(r.rows[5 * k + row].relative_humidity, humidity);
      EXPECT_NEAR(r.rows[5 * k + row].pull, s.mean_pressure, 1e-9 * s.mean_pressure) << row;
    };
    expect(2, solve_spread_field(gap, &surface, p.fields.wetting_on, problem));
    expect(3, solve_full_field(gap, &surface, p.fields.wetting_on, problem));
    problem.screening = false;
    expect(0, solve_local_field(gap, &surface, p.fields.wetting_on, problem));
    problem.screening = true;
    expect(1, solve_local_field(gap, &surface, p.fields.wetting_on, problem));
    // The walls of the holes stand on few pixels.
    EXPECT_EQ(r.rows[5 * k + 4].error, 0);
    EXPECT_LT(std::abs(r.rows[5 * k + 3].error), 0.15);
    EXPECT_GT(std::abs(r.rows[5 * k].error), 1e-3);
  }
}

// Droplets and their bridges keep their places on finer pixels.
TEST(RefinedBodies, CarryTheirWaterAlong) {
  Design design = smooth_skin();
  design.texture = Texture{};
  design.environment.relative_humidity = {0.75};
  FieldAccuracyOptions options;
  options.pixels = 32;
  options.refinements = {1, 2};
  const TimedRows r = run(design, options);
  for (double& v : design.finger.water.volume) v = 0;
  const TimedRows dry = run(design, options);
  ASSERT_EQ(r.rows.size(), 5u);
  for (const std::size_t i : {3u, 4u}) EXPECT_LT(r.rows[i].pull, 0.9 * dry.rows[i].pull);
  EXPECT_LT(std::abs(r.rows[3].error), 0.09);  // the edges of bridges are pixels
}

}  // namespace
}  // namespace papilla::tests::refined_bodies_test
