#include "forward/skips.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <sstream>

#include "base/files.h"
#include "base/text.h"
#include "measure/coverage.h"
#include "numerics/statistics.h"
#include "physics/contact/contact.h"

namespace papilla::tests::skips_test {
namespace {

Fidelity small() {
  Fidelity f = fidelity_level("design");
  f.grid = 64;
  f.skins = 2;
  f.control_skins = 0;
  f.threads = 1;
  return f;
}

// In one pass, as the bounds are.
Scene scene_at(int index, Texture& texture) {
  Scene scene = random_scene(index, texture);
  scene.model.coupling = Coupling::OnePass;
  scene.environment.relative_humidity.resize(1);
  return scene;
}

// Bound over actual in the median; every actual below its bound.
void expect_bounds(const char* piece, const std::vector<double>& bounds,
                   const std::vector<double>& actual) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    EXPECT_LE(actual[i], bounds[i] * (1 + 1e-6) + 1e-9) << piece << " " << i;
    if (actual[i] > 1e-6 && std::isfinite(bounds[i])) ratios.push_back(bounds[i] / actual[i]);
  }
  ASSERT_FALSE(ratios.empty()) << piece;
  const double median = quantile(ratios, 0.5);
  std::cout << piece << ": " << bounds.size() << " scenes, bound over actual " << median
            << " in the median of " << ratios.size() << "\n";
  EXPECT_LT(median, 10) << piece;
}

TEST(SkipBounds, HoldForTheCouplingInOnePass) {
  std::vector<double> bounds, actual;
  for (int i = 0; i < 24; ++i) {
    Texture texture;
    Scene scene = scene_at(i, texture);
    const Response one = evaluate(scene, texture, small());
    bounds.push_back(skip_bounds(scene, texture, small()).self_consistency);
    scene.model.coupling = Coupling::Equilibrium;
    const Response settled = evaluate(scene, texture, small());
    if (!settled.points[0].status.sound()) {
      bounds.pop_back();
      continue;
    }
    actual.push_back(
        std::abs(settled.points[0].friction_on.value / one.points[0].friction_on.value - 1));
  }
  expect_bounds("equilibrium", bounds, actual);
}

TEST(SkipBounds, HoldForRetention) {
  std::vector<double> bounds, actual;
  for (int i = 0; i < 12; ++i) {
    Texture texture;
    Scene scene = scene_at(i, texture);
    scene.surface.contact_angle = 0.9;
    scene.drive.amplitude = 0;
    const Response with = evaluate(scene, texture, small());
    Scene slippery = scene;
    slippery.finger.water.hysteresis = 0;
    const Response without = evaluate(slippery, texture, small());
    scene.model.preset = Preset::M3;
    actual.push_back(with.points[0].friction_off.value / without.points[0].friction_off.value - 1);
    bounds.push_back(skip_bounds(scene, texture, small()).retention);
  }
  expect_bounds("retention", bounds, actual);
}

// What the plan says of the load law is what the committed scenes have: both estimators on the
// same skins.
TEST(PlanSkips, TheLoadLawIsAsFarOffAsOnTheCommittedScenes) {
  std::vector<double> friction, modulation;
  for (const char* file : {"coverage.csv", "training/coverage.csv"}) {
    std::istringstream in(
        read_bytes(std::string(PAPILLA_SOURCE_DIR) + "/results/accuracy/" + file));
    std::map<std::string, std::map<bool, double>> scenes;  // [scene][load law]
    for (std::string line; std::getline(in, line);) {
      const std::vector<std::string> c = split(line, ',');
      if (line[0] == '#' || c[0] == "scene") continue;
      if (c[2].starts_with("64 pixels") && c[3] == "modulation")
        scenes[c[0]][c[2].ends_with("load law")] = std::stod(c[4]);
    }
    for (const auto& [name, m] : scenes) {
      if (m.size() < 2) continue;
      friction.push_back(std::abs((1 + m.at(true)) / (1 + m.at(false)) - 1));
      modulation.push_back(std::abs(m.at(true) / m.at(false) - 1));
    }
  }
  ASSERT_EQ(friction.size(), 180u);
  EXPECT_NEAR(quantile(friction, 0.95), 0.05, 0.005);
  EXPECT_NEAR(quantile(modulation, 0.95), 0.15, 0.005);
  EXPECT_NEAR(quantile(modulation, 1), 0.31, 0.01);
  Scene scene;
  scene.drive.amplitude = 200;
  const Plan plan = make_plan(scene, Texture{}, fidelity_level("draft"));
  for (const PlanSkip& skip : plan.skipped) {
    if (skip.piece != Piece::Tractions) continue;
    EXPECT_NEAR(skip.bound, quantile(friction, 1), 0.005);
    EXPECT_NE(plan.text().find("estimate 7.1 % of friction"), std::string::npos) << plan.text();
  }
}

// A priori estimates hold on the published sample's patches, for skin as it is at 15 % RH: on
// softer skin the same contact carries less. Only measured ones are called bounds.
TEST(PlanSkips, AreEstimatesUntilMeasured) {
  Scene scene;
  scene.drive.amplitude = 200;
  scene.environment.relative_humidity = {0.55};
  const Texture texture{HoleArray{}};
  const Plan before = make_plan(scene, texture, small());
  const Plan after = measured_plan(scene, texture, small());
  EXPECT_EQ(before.text().find("(bound"), std::string::npos) << before.text();
  for (std::size_t i = 0; i < before.skipped.size(); ++i) {
    const PlanSkip &a = before.skipped[i], &b = after.skipped[i];
    EXPECT_TRUE(a.estimate) << a.name();
    if (a.piece != Piece::Kelvin) continue;
    EXPECT_FALSE(b.estimate);
    EXPECT_GE(a.bound, b.bound * scene.finger.skin.modulus_factor(0.55));
  }
}

// Contact solved again under the attraction of the piece that has no model of its own.
TEST(SkipBounds, HoldForKelvinCondensation) {
  std::vector<double> bounds, actual;
  for (int i = 0; i < 16; ++i) {
    Texture texture;
    Scene scene = scene_at(i, texture);
    scene.drive.amplitude = 0;
    scene.finger.water.volume = {0, 0, 0, 0};
    const double rh = scene.environment.relative_humidity[0];
    const SkipBounds b = skip_bounds(scene, texture, small(), 1);
    bounds.push_back(b.kelvin);
    const PatchPicture p = picture_patch(scene, texture, small(), rh, 0);
    const Grid& grid = p.texture.grid;
    const Skin& s = scene.finger.skin;
    const double soft = s.modulus_factor(rh);
    const auto kernel =
        make_contact_kernel(grid, {s.layer_modulus * soft, s.layer_poisson, s.layer_thickness,
                                   s.bulk_modulus * soft, s.bulk_poisson, 0, 0.4});
    std::vector<double> height(grid.size());
    for (std::size_t k = 0; k < height.size(); ++k) height[k] = p.texture.z[k] + p.skin.z[k];
    const double load = scene.finger.patch_pressure(rh);
    const ContactOptions options{.tolerance = 1e-7};
    const ContactSolution dry = solve_contact(*kernel, height, load, {}, options);
    const Gap gap{grid, dry.gap};
    const Traction t = kelvin_traction(gap, scene, rh);
    const ContactSolution wet = solve_contact(*kernel, height, load, t.value, options, &dry);
    actual.push_back(
        std::abs(measure_area(*kernel, wet).near_edge / measure_area(*kernel, dry).near_edge - 1));
  }
  expect_bounds("Kelvin condensation", bounds, actual);
}

// Each is a force over the load, in a law of friction over the load: twice the exponent, twice the
// bound. The attraction is that of the gaps, whatever the texture.
TEST(SkipBounds, GoWithTheExponentOfTheLaw) {
  Fidelity once = small(), twice = small();
  once.load_exponent = 0.4, twice.load_exponent = 0.8;
  const std::array bounds{&SkipBounds::van_der_waals, &SkipBounds::kelvin,
                          &SkipBounds::self_consistency};
  std::array<double, 3> sum{};
  for (int i = 0; i < 6; ++i) {
    Texture texture;
    const Scene scene = scene_at(i, texture);
    const SkipBounds a = skip_bounds(scene, texture, once, 1),
                     b = skip_bounds(scene, texture, twice, 1);
    for (std::size_t k = 0; k < bounds.size(); ++k) {
      if (!std::isfinite(a.*bounds[k])) continue;
      EXPECT_NEAR(b.*bounds[k], 2 * (a.*bounds[k]), 1e-9 * (a.*bounds[k])) << i << " " << k;
      sum[k] += a.*bounds[k];
    }
    const double rh = scene.environment.relative_humidity[0];
    const PatchPicture p = picture_patch(scene, texture, once, rh, 0);
    const double waals = van_der_waals_traction({p.texture.grid, p.fields.off.gap}).mean();
    EXPECT_NEAR(a.van_der_waals, 0.8 * waals / mean_estimate(p.fields.off.pressure).value,
                0.05 * a.van_der_waals);
  }
  for (const double s : sum) EXPECT_GT(s, 0);
}

}  // namespace
}  // namespace papilla::tests::skips_test
