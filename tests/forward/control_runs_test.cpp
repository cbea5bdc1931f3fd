// The control skins of a set: that they are the runs that are stated, and that the errors are made
// of them as Eqs. accuracy.2 and 3 say.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/constants.h"
#include "forward/forward.h"
#include "forward/scene_terms.h"
#include "numerics/statistics.h"
#include "physics/electrostatics/full_field.h"

namespace papilla::tests::control_runs_test {
namespace {

struct Controlled {
  Scene scene;
  Texture texture;
  Fidelity fidelity = fidelity_level("search");
  PatchSet set;

  Controlled(Estimator estimator, int grid, double amplitude, Texture t = {})
      : texture(std::move(t)) {
    scene.drive.amplitude = amplitude;
    scene.environment.relative_humidity = {0.2, 0.5, 0.8};
    fidelity.grid = grid, fidelity.skins = 4, fidelity.control_skins = 3;
    fidelity.estimator = estimator;
    fidelity.threads = 1;
    set = solve_patches(scene, texture, fidelity);
    measure_errors(scene, texture, fidelity, set);
  }
  Response of(const Fidelity& changed) const {
    return respond(scene, changed, solve_patches(scene, texture, changed, set.field));
  }
};

using Points = std::vector<ResponsePoint>;

void expect_same(const Resampled& a, const Resampled& b) {
  ASSERT_EQ(a.points.size(), b.points.size());
  ASSERT_EQ(a.without.size(), b.without.size());
  const auto same = [](const Points& x, const Points& y) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      for (const PointQuantity& q : kPointQuantities) {
        const double value = (y[i].*q.value).value;
        EXPECT_NEAR((x[i].*q.value).value, value, 1e-9 * std::abs(value));
      }
    }
  };
  same(a.points, b.points);
  for (std::size_t k = 0; k < a.without.size(); ++k) same(a.without[k], b.without[k]);
}

TEST(ControlRunLaws, AreTheSameSkinsBySolvedAreasAndOnHalfThePixels) {
  const Controlled c(Estimator::Load, 32, 100);
  const ControlRuns& runs = c.set.controls;
  Fidelity own = c.fidelity;
  own.skins = 3;
  expect_same(runs.own, c.of(own));
  Fidelity areas = own;
  areas.estimator = Estimator::Area;
  expect_same(runs.areas, c.of(areas));
  Fidelity half = areas;
  half.grid = 16;
  expect_same(runs.coarse, c.of(half));
  // 750 nm on 32 pixels of 12 um, 100 nm of the skin.
  EXPECT_NEAR(runs.octaves, std::log2(7.5), 1e-9);
  EXPECT_EQ(runs.coarse_features, 0);
  ASSERT_EQ(c.set.errors.size(), 2u);
  EXPECT_EQ(c.set.errors[0].origin, &ErrorParts::grid);
  EXPECT_EQ(c.set.errors[1].origin, &ErrorParts::method);
  // 3 skins, 3 humidities: on half the pixels and by areas dry, off and on.
  EXPECT_EQ(c.set.errors[0].costs.contact_solves, 27);
  EXPECT_EQ(c.set.errors[1].costs.contact_solves, 27);
  EXPECT_EQ(c.set.area_factor, resolved_areas(runs));
  ASSERT_EQ(c.set.errors[1].pull_in.size(), 3u);
  for (const ModelStatus& s : c.set.errors[1].pull_in) EXPECT_TRUE(s.sound());
}

// Sizes by humidity and quantity: each its own or the root mean square over humidity, where a
// humidity with less of the quantity counts by the square of its share; areas with 2.3 % at 2.13
// pixels to the cut-off, order 1.5.
TEST(ControlRunLaws, TheErrorsAreMadeOfTheRuns) {
  for (const Estimator estimator : {Estimator::Load, Estimator::Area}) {
    const Controlled c(estimator, 48, 100);
    const ControlRuns& runs = c.set.controls;
    ASSERT_EQ(runs.areas.points.empty(), estimator == Estimator::Area);
    ASSERT_EQ(c.set.errors.size(), estimator == Estimator::Area ? 1u : 2u);
    const Points& fine = estimator == Estimator::Area ? runs.own.points : runs.areas.points;
    for (std::size_t m = 0; m < kPointQuantities.size(); ++m) {
      const PointQuantity& q = kPointQuantities[m];
      std::vector<double> grid, method, at_fine, at_law;
      for (std::size_t i = 0; i < 3; ++i) {
        const ControlledChange change = controlled_change(
            runs, q.grid, [&](const Points& p) { return std::optional((p[i].*q.value).value); });
        grid.push_back(grid_error(change.grid));
        method.push_back(std::max(method_error(change.method), mean_estimate(change.method).se));
        at_fine.push_back(std::abs((fine[i].*q.value).value));
        at_law.push_back(std::abs((runs.own.points[i].*q.value).value));
      }
      level_out(grid, at_fine);
      level_out(method, at_law);
      // Two pixels of 250 nm to the shortest wave.
      const double resolved = 0.023 * std::pow(2.13 / 2, 1.5);
      const bool area = q.grid == GridLaw::Area;
      for (std::size_t i = 0; i < 3; ++i) {
        const double own = grid[i];
        EXPECT_NEAR(c.set.errors[0].size[i][m], area ? std::hypot(own, resolved) : own,
                    1e-9 * (own + 1e-3))
            << m << i;
        if (estimator == Estimator::Area) continue;
        EXPECT_NEAR(c.set.errors[1].size[i][m], method[i], 1e-9) << m << i;
      }
    }
  }
}

// A grid that has all of the skin's waves states of areas what its coarse features leave, and the
// resolved waves' error.
TEST(ControlRunLaws, OfAResolvedSkinTheStepIsTheTexturesOwn) {
  const auto of_pixels = [](double width) {
    Scene scene;
    scene.finger.skin.cutoff = 1.5e-6;
    scene.finger.water.volume = {0, 0, 0, 0};
    scene.environment.relative_humidity = {0.5};
    Fidelity f = fidelity_level("search");
    f.grid = 32, f.skins = 3, f.control_skins = 3;
    const Texture texture{PillarArray{.period = 2 * width, .diameter = width, .height = 100e-9}};
    PatchSet set = solve_patches(scene, texture, f);
    measure_errors(scene, texture, f, set);
    return set;
  };
  // 4.5 um are 12 of 375 nm pixels: the whole step is missing; of 24 none; of 3 a third more.
  for (const double width : {6.75e-6, 4.5e-6, 1.2e-6}) {
    const PatchSet set = of_pixels(width);
    EXPECT_EQ(set.controls.octaves, 0);
    const double pixels = set.plan.feature_pixels;
    const double missing =
        std::clamp((24 - pixels) / 12, 0.0, 1.0) * std::max(1.0, 4 / std::max(pixels, 1.0));
    EXPECT_NEAR(set.controls.coarse_features, missing, 1e-12) << width;
    EXPECT_EQ(set.area_factor, 1);
    const ControlledChange change = controlled_change(
        set.controls, GridLaw::Area,
        [](const Points& p) { return std::optional(p[0].area_fraction_off.value); });
    const double side = std::max(set.plan.grid.dx(), set.plan.grid.dy());
    const double resolved = 0.023 * std::pow(2.13 * side / 1.5e-6, 1.5);
    EXPECT_NEAR(set.errors[0].size[0][3],
                std::hypot(missing * grid_error(change.halving), resolved), 1e-9)
        << width;
    EXPECT_EQ(set.errors.size(), 1u);  // neither water nor drive: nothing that a law stands for
  }
}

// Half the pixels drop an octave of the skin as well, or a part of one: of that step a fifth, or
// more, is the features'. Before it was the whole step once the finer grid had all of the skin,
// and bars were three times wider at `design` than at `draft`.
TEST(ControlRunLaws, OfAStepThatDropsWavesOfTheSkinThePartOfFeaturesIsSmaller) {
  const Texture texture{PillarArray{.period = 3e-6, .diameter = 1.5e-6, .height = 100e-9}};
  const auto share = [&](double cutoff) {
    Scene scene;
    scene.finger.skin.cutoff = cutoff;
    scene.finger.water.volume = {0, 0, 0, 0};
    scene.environment.relative_humidity = {0.5};
    Fidelity f = fidelity_level("search");
    f.grid = 32, f.skins = 2, f.control_skins = 2;
    PatchSet set = solve_patches(scene, texture, f);
    measure_errors(scene, texture, f, set);
    const double pixels = set.plan.feature_pixels;
    return set.controls.coarse_features /
           (std::clamp((24 - pixels) / 12, 0.0, 1.0) * std::max(1.0, 4 / std::max(pixels, 1.0)));
  };
  EXPECT_NEAR(share(1.5e-6), 1, 1e-12);     // 750 nm pixels resolve it
  EXPECT_NEAR(share(0.75e-6), 0.2, 1e-12);  // an octave of it is dropped
  EXPECT_NEAR(share(1.5e-6 / std::sqrt(2.0)), 0.6, 1e-12);
  EXPECT_NEAR(share(0.2e-6), 0.2, 1e-12);  // the finer grid has not all of it either
}

TEST(ControlRunLaws, TwoSkinsAndSixteenPixelsAreTheLeast) {
  Scene scene;
  scene.finger.water.volume = {0, 0, 0, 0};
  scene.environment.relative_humidity = {0.5};
  Fidelity f = fidelity_level("search");
  f.skins = 2;
  for (const int grid : {31, 32}) {
    for (const int controls : {1, 2, 5}) {
      f.grid = grid, f.control_skins = controls;
      PatchSet set = solve_patches(scene, Texture{}, f);
      set.area_factor = 3;
      measure_errors(scene, Texture{}, f, set);
      EXPECT_EQ(set.area_factor == 1, set.controls.coarse.points.empty());
      EXPECT_EQ(set.controls.own.points.empty(), controls < 2);
      EXPECT_EQ(set.errors.size(), controls >= 2 && grid == 32 ? 1u : 0u) << grid << controls;
      EXPECT_EQ(set.controls.own.without.size(), controls < 2 ? 0u : 2u);  // no more than there are
    }
  }
}

// A pull that no equilibrium holds is seen by solved areas alone.
TEST(ControlRunLaws, ThePullInOfSolvedAreasIsThatOfTheAnswer) {
  const Controlled c(Estimator::Load, 32, 700);
  int seen = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const ModelStatus& s = c.set.errors[1].pull_in[i];
    EXPECT_TRUE(s.sound() || s.pull_in());
    seen += s.pull_in();
    const ModelStatus& told = respond(c.scene, c.fidelity, c.set).points[i].status;
    EXPECT_EQ(told.pull_in(), s.pull_in()) << i;
  }
  EXPECT_GT(seen, 0);
}

// The 3-D field of a long patch has 64 pixels a side at least, whatever the run has.
TEST(ControlRunLaws, TheFieldsOwnPatchHasSixtyFourPixelsAtLeast) {
  Scene scene;
  scene.drive.amplitude = 200;
  scene.environment.relative_humidity = {0.3};
  scene.finger.water.volume = {0, 0, 0, 0};
  scene.surface.process = FilmProcess::Planar;
  scene.surface.dielectric[0].thickness = 1e-6;
  Fidelity f = fidelity_level("search");
  f.grid = 32, f.most_pixels = 32, f.field_skins = 1;
  const Texture texture{HoleArray{.period = 48e-6, .diameter = 24e-6, .depth = 600e-9}};
  const FieldRatio ratio = field_ratios(scene, texture, f)[0];
  Fidelity own = f;
  own.most_pixels = 64;
  const PatchPicture p = picture_patch(scene, texture, own, 0.3, 0);
  ASSERT_EQ(p.texture.grid.nx, 64);
  const CoveredSurface surface(p.texture, film_of(scene));
  const double full = solve_full_field({p.texture.grid, p.fields.off.gap}, &surface,
                                       p.fields.wetting_on, field_problem(scene, 0.3))
                          .mean_pressure;
  EXPECT_NEAR(ratio.correction, full / p.fields.pull.mean(), 1e-6);
  // One skin has no scatter of its own, but that of others.
  const auto of_skins = [](double r, double skins) {
    return std::hypot(0.03 * r, 0.3 * square(std::max(0.0, 1 - r))) / std::sqrt(skins) / r;
  };
  const auto error = [&](double r, double skins) {
    return std::hypot(full_field_error(r), of_skins(r, skins));
  };
  // And next to no lag at 5 kHz.
  EXPECT_NEAR(*ratio.error, error(ratio.correction, 1), 1e-7);
  // Two of nearly the same ratio.
  f.field_skins = 2;
  const FieldRatio two = field_ratios(scene, texture, f)[0];
  EXPECT_NEAR(*two.error, error(two.correction, 2), 1e-7);
}

TEST(ControlRunLaws, AnAnswerBeforeItIsAskedIsNothing) {
  const Response r;
  EXPECT_FALSE(r.driven);
  EXPECT_EQ(r.seconds, 0);
  EXPECT_EQ(r.contact_solves, 0);
  EXPECT_EQ(r.fft_pairs, 0);
  EXPECT_EQ(r.parameters.skins, 0);
  EXPECT_EQ(r.parameters.grid, 0);
  EXPECT_EQ(r.controls.octaves, 0);
  EXPECT_EQ(r.controls.coarse_features, 0);
  EXPECT_EQ(r.accuracy.target, 0);
  EXPECT_EQ(r.accuracy.reached, 0);
  EXPECT_EQ(r.accuracy.largest_share, 0);
  EXPECT_EQ(r.accuracy.largest_grid, 0);
  EXPECT_EQ(r.accuracy.most_skins, 0);
  const ResponsePoint p;
  EXPECT_EQ(p.weight, 1);
  EXPECT_EQ(p.field_correction, 1);
  EXPECT_EQ(p.oxide_margin, kInfinity);
  for (const double zero :
       {p.relative_humidity, p.patch_pressure, p.over_limit_area, p.over_limit_share,
        p.peak_oxide_field, p.peak_air_field, p.source_voltage, p.retention_gain, p.capillary_gain,
        p.strength, p.bridge_water_share, p.modulation.value, p.modulation.parts.sampling})
    EXPECT_EQ(zero, 0);
  const VoltageAnswer v;
  EXPECT_EQ(v.target, 0);
  EXPECT_EQ(v.limit, 0);
  EXPECT_EQ(v.modulation, 0);
  EXPECT_EQ(v.evaluations, 0);
  EXPECT_TRUE(v.reached());
  const PatchResult one;
  for (const PatchMember& m : kPatchMembers)
    EXPECT_EQ(one.*m.value, m.value == &PatchResult::oxide_margin ? kInfinity : 0);
  EXPECT_EQ(one.costs.contact_solves, 0);
  EXPECT_EQ(one.costs.fft_pairs, 0);
  EXPECT_EQ(one.costs.seconds.contact + one.costs.seconds.water + one.costs.seconds.field, 0);
  const FieldRatio ratio;
  EXPECT_EQ(ratio.correction, 1);
  EXPECT_FALSE(ratio.error);
  const Plan plan;
  EXPECT_EQ(plan.skin_cutoff + plan.effective_cutoff + plan.feature_pixels, 0);
  EXPECT_FALSE(plan.field || plan.water || plan.retention || plan.traction_solves);
}

}  // namespace
}  // namespace papilla::tests::control_runs_test
