// Hard cases of whole scenes: every number is finite and its status says what happened.
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "forward/forward.h"
#include "metrics/metrics.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/threshold.h"
#include "physics/electrostatics/field.h"

namespace papilla::tests::scenes_test {
namespace {

Fidelity small(Estimator estimator = Estimator::Load) {
  Fidelity f = fidelity_level("search");
  f.grid = 48;
  f.skins = 2;
  f.estimator = estimator;
  f.threads = 1;
  return f;
}

Scene driven() {
  Scene scene;
  scene.drive.amplitude = 200;
  scene.environment.relative_humidity = {0.35, 0.75};
  return scene;
}

void expect_sane(const Response& r, const std::string& what) {
  EXPECT_FALSE(r.points.empty()) << what;
  for (const ResponsePoint& p : r.points) {
    for (const Measured* m :
         {&p.friction_off, &p.friction_on, &p.modulation, &p.area_fraction_off, &p.area_fraction_on,
          &p.capillary_force, &p.electrostatic_force, &p.retention_force, &p.bridges,
          &p.wetted_fraction, &p.mean_gap, &p.indentation}) {
      EXPECT_TRUE(std::isfinite(m->value) && std::isfinite(m->se())) << what;
      EXPECT_GE(m->se(), 0) << what;
    }
    for (const Measured* m : {&p.friction_off, &p.friction_on, &p.electrostatic_force, &p.bridges,
                              &p.mean_gap, &p.area_fraction_off, &p.area_fraction_on}) {
      EXPECT_GE(m->value, 0) << what;
    }
    EXPECT_LE(p.wetted_fraction.value, 1 + 1e-12) << what;
    if (p.area_fraction_on.value > 1) {
      EXPECT_FALSE(p.status.sound()) << what;
    }
  }
}

Response run(const Scene& scene, const Texture& texture, const std::string& what,
             Estimator estimator = Estimator::Load) {
  Response r = evaluate(scene, texture, small(estimator));
  expect_sane(r, what);
  return r;
}

TEST(HardScene, PeriodsThatDoNotDivideThePatch) {
  for (double period : {2.7e-6, 5.1e-6, 7.7e-6, 11e-6, 25e-6}) {
    for (Lattice lattice : {Lattice::Square, Lattice::Hexagonal}) {
      const Texture t{HoleArray{.lattice = lattice, .period = period, .diameter = 0.5 * period}};
      const Grid grid = patch_grid(t, 64);
      EXPECT_NEAR(std::remainder(grid.lx, period), 0, 1e-9 * period);
      run(driven(), t, "period");
    }
  }
}

TEST(HardScene, DegenerateTextures) {
  for (double angle : {kPi / 2, 1.0}) {
    run(driven(), Texture{HoleArray{.depth = 0, .wall_angle = angle}}, "depth 0");
    run(driven(), Texture{HoleArray{.wall_angle = angle}}, "steep walls");
    run(driven(), Texture{PillarArray{.wall_angle = angle}}, "pillars");
    run(driven(), Texture{Grating{.wall_angle = angle}}, "grating");
  }
  // A diameter of the period or more leaves no land: refused before anything runs.
  for (double diameter : {6e-6, 7e-6}) {
    EXPECT_FALSE(problems(Texture{HoleArray{.period = 6e-6, .diameter = diameter}}).empty());
  }
}

TEST(HardScene, ParticlesTouchingOverlappingAndImpossible) {
  run(driven(), Texture{ParticleFilm{.radius = 0.8e-6, .coverage = 0.4, .clustering = 1}},
      "touching particles");
  run(driven(), Texture{ParticleFilm{.radius = 0.8e-6, .coverage = 0}}, "no particle");
  // More than random placing can cover is refused before it is tried ...
  EXPECT_FALSE(problems(Texture{ParticleFilm{.coverage = 0.9}}).empty());
  // ... and what finds no place on its patch, after.
  const Grid small{64, 64, 12e-6, 12e-6};
  EXPECT_THROW(generate(Texture{ParticleFilm{.radius = 7e-6, .coverage = 0.4}}, small), InputError);
}

TEST(HardScene, NoWaterAndNoVoltage) {
  Scene dry = driven();
  dry.finger.water.volume = {0, 0, 0, 0};
  for (const ResponsePoint& p : run(dry, Texture{}, "no water").points) {
    EXPECT_EQ(p.capillary_force.value, 0);
  }
  Scene off = driven();
  off.drive.amplitude = 0;
  for (const ResponsePoint& p : run(off, Texture{}, "0 V").points) {
    EXPECT_EQ(p.friction_on.value, p.friction_off.value);
  }
}

TEST(HardScene, WaterThatFloodsEveryGapSaysSo) {
  for (WaterModel model : {WaterModel::Droplets, WaterModel::Threshold}) {
    Scene scene = driven();
    scene.model.water = model;
    scene.environment.relative_humidity = {0.75};
    scene.finger.water.volume = {1e-15, 1e-15, 1e-15, 1e-15};
    const Response r = run(scene, Texture{HoleArray{}}, "flooded");
    EXPECT_FALSE(r.troubles().empty());
  }
}

TEST(HardScene, HumidityFromNoneToAll) {
  Scene scene = driven();
  scene.environment.relative_humidity = {0, 1};
  for (WaterModel model : {WaterModel::Droplets, WaterModel::Threshold}) {
    scene.model.water = model;
    run(scene, Texture{HoleArray{}}, "0 and 100 % RH");
  }
}

TEST(HardScene, EveryContactAngle) {
  for (double degrees : {0.0, 1.0, 90.0, 99.9, 100.0, 100.1, 179.0, 180.0}) {
    Scene scene = driven();
    scene.surface.contact_angle = degrees * kPi / 180;
    run(scene, Texture{HoleArray{}}, "angle " + std::to_string(degrees));
  }
}

TEST(HardScene, OneHumidityHasNoVariationToSpeakOf) {
  Scene scene = driven();
  scene.environment.relative_humidity = {0.55};
  const Response r = run(scene, Texture{}, "one humidity");
  const auto variation = summarise(Summary::Variation, kModulation, r);
  if (variation) {
    EXPECT_EQ(variation->value, 0);
  }
}

TEST(HardScene, ElectrodeLimits) {
  Scene scene = driven();
  scene.finger.electrical.thickness_15 = scene.finger.electrical.thickness_75 = 0;
  run(scene, Texture{}, "h_SC = 0");
  scene.drive.amplitude = 20000;  // beyond breakdown everywhere, and past pull-in
  for (Coupling coupling : {Coupling::OnePass, Coupling::Equilibrium}) {
    scene.model.coupling = coupling;
    const Response r = run(scene, Texture{}, "20 kV");
    EXPECT_FALSE(r.troubles().empty());
    for (const ResponsePoint& p : r.points) {
      if (coupling == Coupling::OnePass) {
        EXPECT_GT(p.over_limit_area, 0.5);
      }
    }
  }
}

TEST(HardScene, FrictionThatVanishes) {
  // Bridges between repelling walls lift a light finger: F_off -> 0.
  Scene scene = driven();
  scene.surface.contact_angle = kPi;
  scene.finger.water.contact_angle = 170 * kPi / 180;
  scene.finger.load = 1e-6;
  for (Estimator estimator : {Estimator::Load, Estimator::Area}) {
    run(scene, Texture{}, "repelled finger", estimator);
  }
}

TEST(HardScene, AFingerWithoutRoughnessOrWithoutElasticity) {
  Scene smooth = driven();
  smooth.finger.skin.rms = 0;
  run(smooth, Texture{}, "smooth on flat", Estimator::Area);
  run(smooth, Texture{HoleArray{}}, "smooth on holes", Estimator::Area);
  Scene hard = driven();
  hard.finger.skin.hardness = 1e5;  // below the patch pressure
  EXPECT_FALSE(run(hard, Texture{}, "too soft to carry", Estimator::Area).troubles().empty());
}

// --- water and field alone ---

Gap flat_gap(double value, int n = 48) {
  const Grid grid{n, n, 12e-6, 12e-6};
  return {grid, std::vector<double>(grid.size(), value)};
}

TEST(HardWater, OneDropletLargerThanThePatch) {
  const Gap gap = flat_gap(100e-9);
  DropletOptions one;
  one.drops_per_volume = 0;
  const Wetting w = settle_droplets(gap, 2 * gap.grid.area() * 100e-9, {}, one, 1, 0);
  EXPECT_EQ(w.status, WettingStatus::Flooded);
  EXPECT_EQ(w.capillary_force, 0);
  const Wetting half = settle_droplets(gap, 0.5 * gap.grid.area() * 100e-9, {}, one, 1, 0);
  EXPECT_EQ(half.status, WettingStatus::Film);
  EXPECT_TRUE(std::isfinite(half.capillary_force));
}

TEST(HardWater, TheForceChangesSignWhereTheAnglesAddUpToAHalfTurn) {
  const Gap gap = flat_gap(50e-9);
  WaterProperties water;
  water.theta_skin = 80 * kPi / 180;
  double previous = 1e300;
  for (double degrees : {60.0, 90.0, 99.0, 101.0, 120.0, 160.0}) {
    water.theta_substrate = degrees * kPi / 180;
    const Wetting w = settle_droplets(gap, 0.2e-18, water, {}, 1, 0);
    ASSERT_TRUE(std::isfinite(w.capillary_force));
    EXPECT_LE(w.capillary_force, previous);
    previous = w.capillary_force;
    if (degrees < 95) {
      EXPECT_GT(w.capillary_force, 0);
    }
    if (degrees > 110) {
      EXPECT_LE(w.capillary_force, 0);
    }
  }
}

TEST(HardWater, ADropletThatTouchesWithoutBridgingRaisesThePullAndHasNoForce) {
  const Gap gap = flat_gap(3e-6);
  const Wetting w = settle_droplets(gap, 0.5e-18, {}, {}, 1, 0);
  EXPECT_EQ(w.bridges, 0);
  EXPECT_EQ(w.capillary_force, 0);
  FieldProblem problem;
  problem.v_rms = 141.4;
  problem.v_peak = 200;
  problem.dielectric = 128e-9;
  problem.dielectric_thickness = 500e-9;
  problem.skin_layer = 20e-9;
  const FieldSolution with = solve_local_field(gap, nullptr, w, problem);
  problem.droplet_enhancement = false;
  const FieldSolution without = solve_local_field(gap, nullptr, w, problem);
  ASSERT_TRUE(with.ok && without.ok);
  EXPECT_GT(with.mean_pressure, without.mean_pressure);
}

TEST(HardWater, NoGapHoldsNoWater) {
  for (const Wetting& w : {settle_droplets(flat_gap(0), 1e-18, {}, {}, 1, 0),
                           fill_threshold(flat_gap(0), 1e-18, {})}) {
    EXPECT_TRUE(std::isfinite(w.capillary_force));
    EXPECT_TRUE(w.status == WettingStatus::Flooded || w.status == WettingStatus::Film);
  }
}

TEST(HardField, BreakdownEverywhereIsReported) {
  FieldProblem problem;
  problem.v_rms = 7000;
  problem.v_peak = 10000;
  problem.dielectric = 128e-9;
  problem.dielectric_thickness = 500e-9;
  const FieldSolution f = solve_local_field(flat_gap(100e-9), nullptr, {}, problem);
  ASSERT_TRUE(f.ok);
  EXPECT_EQ(f.over_limit_area, 1);
  EXPECT_EQ(f.over_limit_share, 1);
  EXPECT_TRUE(std::isfinite(f.mean_pressure));
}

}  // namespace
}  // namespace papilla::tests::scenes_test
