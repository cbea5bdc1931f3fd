// One patch before and under the drive, piece by piece: each number is that of the piece of physics
// asked by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "forward/coupling.h"
#include "forward/load_law.h"
#include "forward/patch_setup.h"
#include "forward/scene_terms.h"
#include "physics/capillary/droplets.h"
#include "physics/electrostatics/breakdown.h"

namespace papilla::tests::drive_patch_test {
namespace {

constexpr double kHumidity = 0.6, kPressure = 4e5;

Scene driven(double amplitude) {
  Scene scene;
  scene.drive.amplitude = amplitude;
  scene.environment.relative_humidity = {kHumidity};
  return scene;
}

// A small patch of the finger's skin on glass.
struct Patch {
  Fidelity fidelity = fidelity_level("search");
  PatchSetup setup;
  std::vector<double> height;
  std::shared_ptr<const ContactKernel> kernel;
  PatchProblem problem;
  Plan plan;

  explicit Patch(const Scene& scene, Estimator estimator = Estimator::Load,
                 const Texture& texture = {}, int passes = 12)
      : fidelity([&] {
          Fidelity f = fidelity_level("search");
          f.grid = 32, f.estimator = estimator, f.coupling_passes = passes;
          return f;
        }()),
        setup(scene, texture, fidelity),
        height(setup.height(setup.skin(0))),
        kernel(contact_kernel(setup.scene(), setup.body(), setup.plan().grid, kHumidity)),
        problem(setup.problem(height, *kernel, kHumidity, kPressure, {1.5, 3})),
        plan(setup.plan()) {
    problem.field_correction = 0.8;
  }
  double area() const { return plan.grid.area(); }
  double softness() const { return 1 / setup.scene().finger.skin.modulus_factor(kHumidity); }

  // Under an attraction [Pa], as the skin is at this humidity.
  ContactSolution contact(std::vector<double> traction, const ContactSolution* start) const {
    for (double& t : traction) t *= softness();
    ContactOptions options;
    options.tolerance = fidelity.contact_tolerance;
    return solve_contact(*kernel, height, kPressure * softness(), traction, options, start);
  }
  WaterProperties water(double angle) const { return water_properties(setup.scene(), angle); }
  FieldProblem field() const { return field_problem(setup.scene(), kHumidity); }
  FieldSolution pull(const Gap& gap, const Wetting& wetting) const {
    return solve_field(setup.scene(), gap, &setup.surface(), wetting, field(),
                       fidelity.field_tolerance);
  }
};

double mean(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x;
  return sum / static_cast<double>(v.size());
}

// The skin that is softer by a factor touches as the dry one under a load as much larger.
TEST(DrivePatch, BeforeTheDriveItIsContactAndThenWaterOnIt) {
  const Patch patch(driven(0));
  const UndrivenPatch u = undriven_patch(patch.problem, patch.plan, patch.fidelity, {});
  ASSERT_TRUE(u.result.status.sound()) << text(u.result.status);
  const ContactSolution dry = patch.contact({}, nullptr);
  EXPECT_EQ(u.dry.gap, dry.gap);
  EXPECT_EQ(u.dry.pressure, dry.pressure);
  EXPECT_GT(patch.softness(), 1.1);
  const PatchResult& r = u.result;
  EXPECT_NEAR(r.load, kPressure * patch.area(), 1e-12 * r.load);
  EXPECT_EQ(r.area_dry, measure_area(*patch.kernel, dry).near_edge);
  EXPECT_EQ(r.area_off, r.area_dry);
  EXPECT_EQ(r.area_on, r.area_dry);
  EXPECT_EQ(r.certificate, dry.certificate);
  EXPECT_EQ(r.costs.contact_solves, 1);
  EXPECT_EQ(r.costs.fft_pairs, dry.fft_pairs);
  EXPECT_NEAR(r.mean_gap, mean(dry.gap), 1e-12 * r.mean_gap);
  // The approach since first touch: highest point over the mean, less the mean gap.
  const double top = *std::max_element(patch.height.begin(), patch.height.end());
  EXPECT_NEAR(r.indentation, top - mean(patch.height) - mean(dry.gap), 1e-9 * r.indentation);
  // Its water: one and a half times the finger's, droplets of stream 3.
  const Scene& scene = patch.setup.scene();
  const double volume = 1.5 * patch.area() * scene.finger.water.volume_per_area(kHumidity);
  EXPECT_NEAR(r.volume, volume, 1e-12 * volume);
  DropletOptions options;
  options.drops_per_volume = scene.finger.water.drops_per_um3 * 1e18;
  options.first_step = scene.model.droplet_step;
  const Gap gap{patch.plan.grid, dry.gap};
  const Wetting w =
      settle_droplets(gap, r.volume, patch.water(scene.surface.contact_angle), options, 1, 3);
  EXPECT_EQ(u.water.bridged, w.bridged);
  ASSERT_GT(w.bridges, 0);
  EXPECT_EQ(r.bridges, w.bridges);
  EXPECT_EQ(r.wetted, w.wetted_fraction);
  EXPECT_EQ(r.bridge_volume, w.bridge_volume);
  EXPECT_EQ(r.retention, w.retention);
  EXPECT_EQ(r.retention_on, w.retention);
  EXPECT_EQ(r.capillary_off, w.capillary_force);
  EXPECT_EQ(r.capillary_on, w.capillary_force);
  double between = 0;
  for (const Droplet& d : w.droplets) between += d.film > 0 && d.film < 1 ? d.volume : 0;
  EXPECT_EQ(r.on_its_way, between);
  EXPECT_EQ(r.pull, 0);
  // On a contact that is solved already the same, without a solve.
  const UndrivenPatch again = wet_patch(patch.problem, patch.plan, patch.fidelity, dry);
  EXPECT_EQ(again.result.costs.contact_solves, 0);
  EXPECT_EQ(again.result.area_dry, r.area_dry);
  EXPECT_EQ(again.result.capillary_off, r.capillary_off);
  EXPECT_EQ(again.result.mean_gap, r.mean_gap);
  EXPECT_EQ(again.result.certificate, r.certificate);
}

TEST(DrivePatch, ByTheLoadLawTheFieldPullsOverTheGapAtRest) {
  const Patch patch(driven(150));
  const UndrivenPatch u = undriven_patch(patch.problem, patch.plan, patch.fidelity, {});
  PatchFields fields;
  const PatchResult r = drive_patch(patch.problem, patch.plan, patch.fidelity, u, &fields);
  ASSERT_TRUE(r.status.sound()) << text(r.status);
  const Gap gap{patch.plan.grid, u.dry.gap};
  const Scene& scene = patch.setup.scene();
  const Wetting on = rewet(u.water, gap, patch.water(driven_contact_angle(scene, kHumidity)));
  EXPECT_EQ(r.capillary_on, on.capillary_force);
  EXPECT_NE(r.capillary_on, r.capillary_off);
  EXPECT_EQ(r.retention_on, on.retention);
  EXPECT_EQ(r.capillary_off, u.result.capillary_off);
  const FieldSolution field = patch.pull(gap, on);
  EXPECT_NEAR(r.pull, 0.8 * field.mean_pressure * patch.area(), 1e-12 * r.pull);
  for (std::size_t i = 0; i < field.traction.value.size(); ++i)
    ASSERT_NEAR(fields.pull.value[i], 0.8 * field.traction.value[i], 1e-9 * field.mean_pressure);
  EXPECT_EQ(r.over_limit_area, field.over_limit_area);
  EXPECT_EQ(r.over_limit_share, field.over_limit_share);
  EXPECT_EQ(r.peak_air_field, field.peak_air_field);
  EXPECT_EQ(r.peak_oxide_field, field.peak_oxide_field);
  // 1 GV/m of the one layer over its peak.
  EXPECT_NEAR(r.oxide_margin, 1e9 / field.peak_oxide_field, 1e-9 * r.oxide_margin);
  EXPECT_EQ(r.area_on, r.area_dry);
  EXPECT_EQ(r.costs.contact_solves, 1);
  EXPECT_EQ(fields.off.gap, u.dry.gap);
  EXPECT_EQ(fields.on.gap, u.dry.gap);
  EXPECT_EQ(fields.wetting_off.bridged, u.water.bridged);
  EXPECT_EQ(fields.wetting_on.bridged, on.bridged);
}

// What stands on the film is divided as its layers leak: a direct voltage stands on the oxide.
TEST(DrivePatch, TheMarginIsThatOfTheLayerThatHoldsTheVoltage) {
  Scene scene = driven(100);
  scene.drive.waveform = Waveform::Dc;
  FilmDielectric oxide = scene.surface.dielectric.front(), polymer = oxide;
  oxide.thickness = 100e-9;
  polymer.thickness = 10e-6, polymer.permittivity = 3, polymer.resistivity = 1e8;
  scene.surface.dielectric = {polymer, oxide};
  const Patch patch(scene);
  PatchStates states;
  const PatchResult r = solve_patch(patch.problem, patch.plan, patch.fidelity, states);
  ASSERT_GT(r.peak_oxide_field, 0);
  const double on_film = r.peak_oxide_field * 10.1e-6;  // [V]
  EXPECT_NEAR(r.oxide_margin, 1e9 * 100e-9 / on_film, 1e-3 * r.oxide_margin);
}

// The contact carries what presses: the preload, and under tractions what they add.
TEST(DrivePatch, PressuresOfSofterSkinCarryTheLoad) {
  const Patch by_load(driven(150));
  ASSERT_GT(by_load.softness(), 1.3);
  PatchStates states;
  PatchFields fields;
  solve_patch(by_load.problem, by_load.plan, by_load.fidelity, states, &fields);
  EXPECT_NEAR(mean(fields.off.pressure), kPressure, 1e-4 * kPressure);
  EXPECT_EQ(fields.on.pressure, fields.off.pressure);
  const Patch by_area(driven(150), Estimator::Area);
  states = {};
  const PatchResult r =
      solve_patch(by_area.problem, by_area.plan, by_area.fidelity, states, &fields);
  EXPECT_NEAR(mean(fields.off.pressure), kPressure + r.capillary_off / by_area.area(),
              0.01 * kPressure);
  EXPECT_NEAR(mean(fields.on.pressure), kPressure + (r.capillary_on + r.pull) / by_area.area(),
              0.01 * kPressure);
  // What the next humidity starts from stays at the moduli of the kernel.
  EXPECT_NEAR(mean(states.dry.pressure), by_area.softness() * kPressure, 1e-3 * kPressure);
}

// Eq. coupling.1: capillary tractions before the drive, the water of the drive and the field under
// it, each one solve more.
TEST(DrivePatch, BySolvedAreasEveryTractionPressesTheSkin) {
  const Patch patch(driven(150), Estimator::Area);
  ASSERT_TRUE(patch.plan.traction_solves);
  PatchStates states;
  const UndrivenPatch u = undriven_patch(patch.problem, patch.plan, patch.fidelity, {});
  PatchFields fields;
  const PatchResult r = solve_patch(patch.problem, patch.plan, patch.fidelity, states, &fields);
  const Gap gap{patch.plan.grid, u.dry.gap};
  const Scene& scene = patch.setup.scene();
  const WaterProperties rest = patch.water(scene.surface.contact_angle),
                        driven_water = patch.water(driven_contact_angle(scene, kHumidity));
  const ContactSolution off = patch.contact(capillary_traction(u.water, gap, rest).value, &u.dry);
  const double area_off = measure_area(*patch.kernel, off).near_edge;
  EXPECT_NEAR(r.area_off, area_off, 1e-9 * area_off);
  const Wetting on = rewet(u.water, gap, driven_water);
  std::vector<double> total = capillary_traction(on, gap, driven_water).value;
  const FieldSolution field = patch.pull(gap, on);
  for (std::size_t i = 0; i < total.size(); ++i) total[i] += 0.8 * field.traction.value[i];
  const ContactSolution pressed = patch.contact(total, &off);
  const double area_on = measure_area(*patch.kernel, pressed).near_edge;
  EXPECT_NEAR(r.area_on, area_on, 1e-9 * area_on);
  EXPECT_GT(area_on, 1.02 * area_off);
  EXPECT_GT(area_off, 1.001 * r.area_dry);
  EXPECT_EQ(r.costs.contact_solves, 3);
  EXPECT_NEAR(r.costs.fft_pairs, u.dry.fft_pairs + off.fft_pairs + pressed.fft_pairs, 1e-9);
  EXPECT_EQ(r.certificate, std::max({u.dry.certificate, off.certificate, pressed.certificate}));
  // The pull is added in another order here: gaps of the same contact to rounding.
  const auto expect_same_gap = [](const ContactSolution& got, const ContactSolution& want) {
    ASSERT_EQ(got.gap.size(), want.gap.size());
    for (std::size_t i = 0; i < got.gap.size(); ++i) EXPECT_NEAR(got.gap[i], want.gap[i], 1e-15);
  };
  EXPECT_EQ(fields.off.gap, off.gap);
  expect_same_gap(fields.on, pressed);
  // From here the next humidity starts.
  EXPECT_EQ(states.dry.gap, u.dry.gap);
  EXPECT_EQ(states.off.gap, off.gap);
  expect_same_gap(states.on, pressed);
  // The same problem again starts where it ends.
  const PatchResult again = solve_patch(patch.problem, patch.plan, patch.fidelity, states);
  EXPECT_LT(again.costs.fft_pairs, 0.7 * r.costs.fft_pairs);
  EXPECT_NEAR(again.area_on, area_on, 5e-3 * area_on);
}

// Eq. coupling.5: what a next pass would pull, over what this one has, less one.
TEST(DrivePatch, OnePassStatesTheRiseOfANextThatWouldDoubleThePull) {
  int told = 0, quiet = 0;
  for (const double amplitude : {200.0, 350.0, 450.0, 550.0, 700.0}) {
    const Patch patch(driven(amplitude), Estimator::Area);
    PatchStates states;
    PatchFields fields;
    const PatchResult r = solve_patch(patch.problem, patch.plan, patch.fidelity, states, &fields);
    ASSERT_FALSE(fields.on.gap.empty());
    const double next =
        0.8 * patch.pull({patch.plan.grid, fields.on.gap}, fields.wetting_on).mean_pressure *
        patch.area();
    if (next >= 2 * r.pull) {
      EXPECT_EQ(r.status.trouble, Trouble::SecondPassPullIn) << amplitude;
      EXPECT_NEAR(r.status.number, next / r.pull - 1, 1e-9) << amplitude;
      ++told;
    } else {
      EXPECT_TRUE(r.status.sound()) << amplitude << text(r.status);
      ++quiet;
    }
  }
  EXPECT_GT(told, 0);
  EXPECT_GT(quiet, 0);
}

// Eq. coupling.2: what settles is contact under its own field and water.
TEST(DrivePatch, InEquilibriumItIsContactUnderItsOwnFieldAndWater) {
  Scene scene = driven(120);
  scene.model.coupling = Coupling::Equilibrium;
  const Patch patch(scene, Estimator::Area, {}, 60);
  PatchStates states;
  PatchFields fields;
  const PatchResult r = solve_patch(patch.problem, patch.plan, patch.fidelity, states, &fields);
  ASSERT_TRUE(r.status.sound()) << text(r.status);
  const Gap gap{patch.plan.grid, fields.on.gap};
  const FieldSolution field = patch.pull(gap, fields.wetting_on);
  // The contact is solved once more, to its last tolerance, after the pull that settled.
  EXPECT_NEAR(r.pull, 0.8 * field.mean_pressure * patch.area(), 1e-3 * r.pull);
  EXPECT_EQ(r.area_on, measure_area(*patch.kernel, states.on).near_edge);
  const WaterProperties water = patch.water(driven_contact_angle(patch.setup.scene(), kHumidity));
  std::vector<double> total = capillary_traction(fields.wetting_on, gap, water).value;
  for (std::size_t i = 0; i < total.size(); ++i) total[i] += 0.8 * field.traction.value[i];
  const ContactSolution next = patch.contact(total, &states.on);
  const double settled =
      0.8 * patch.pull({patch.plan.grid, next.gap}, fields.wetting_on).mean_pressure * patch.area();
  EXPECT_NEAR(settled, r.pull, 0.03 * r.pull);
  EXPECT_EQ(r.capillary_on, fields.wetting_on.capillary_force);
  EXPECT_EQ(r.retention_on, fields.wetting_on.retention);
  // Passes that end before it settles are told.
  const Patch few(scene, Estimator::Area, {}, 1);
  PatchStates none;
  const PatchResult cut = solve_patch(few.problem, few.plan, few.fidelity, none);
  EXPECT_EQ(cut.status.trouble, Trouble::PassesUsedUp);
  EXPECT_EQ(cut.status.number, 1);
}

// More than nine tenths of the patch touch in the first state: nothing more is asked.
TEST(DrivePatch, AClosedGapEndsTheSearchForAnEquilibrium) {
  Scene scene = driven(20000);
  scene.model.coupling = Coupling::Equilibrium;
  scene.finger.water.volume = {0, 0, 0, 0};
  const Patch closed(scene, Estimator::Area);
  PatchStates states;
  const PatchResult shut = solve_patch(closed.problem, closed.plan, closed.fidelity, states);
  EXPECT_EQ(shut.status, (ModelStatus{Trouble::ClosedPullIn, 0, ""})) << text(shut.status);
  EXPECT_TRUE(shut.status.pull_in());
  EXPECT_EQ(shut.costs.contact_solves, 2);
}

// A smooth, stiff plate whose load closes all but one pixel in sixteen, or in sixty-four, of the
// glass: what the load has closed is no pull-in under a drive of 20 V.
TEST(DrivePatch, WhatTheLoadAloneClosesIsNoPullIn) {
  Scene scene = driven(20);
  scene.model.coupling = Coupling::Equilibrium;
  scene.finger.water.volume = {0, 0, 0, 0};
  Patch patch(scene, Estimator::Area);
  const LayeredSolid stiff{3e9, 0.4, 0, 3e9, 0.4};
  const auto kernel = make_contact_kernel(patch.plan.grid, stiff);
  patch.problem.kernel = kernel.get();
  for (const int every : {4, 8}) {
    for (std::size_t i = 0; i < patch.height.size(); ++i) {
      const int x = static_cast<int>(i) % 32, y = static_cast<int>(i) / 32;
      patch.height[i] = x % every == 0 && y % every == 0 ? -350e-9 : 0;
    }
    patch.problem.height = patch.height;
    PatchStates states;
    const PatchResult r = solve_patch(patch.problem, patch.plan, patch.fidelity, states);
    EXPECT_TRUE(r.status.sound()) << text(r.status);
    EXPECT_GT(r.pull, 0);
    const auto touching = std::count_if(states.on.pressure.begin(), states.on.pressure.end(),
                                        [](double p) { return p > 0; });
    EXPECT_GT(touching, 0.93 * 1024);
  }
}

// Water three hundred times as strong closes the gap whatever the drive.
TEST(DrivePatch, SaysWhereAGapClosesWithoutTheDrive) {
  Scene scene = driven(10);
  scene.model.coupling = Coupling::Equilibrium;
  scene.finger.water.surface_tension *= 300;
  const Patch closed(scene, Estimator::Area);
  const UndrivenPatch before = undriven_patch(closed.problem, closed.plan, closed.fidelity, {});
  EXPECT_TRUE(before.result.status.pull_in_undriven()) << text(before.result.status);
  EXPECT_EQ(drive_patch(closed.problem, closed.plan, closed.fidelity, before).status,
            before.result.status);
}

// Eq. coupling.14: the load law by the first skins of a scene, on the others, beside these in
// equilibrium themselves; and on those that it was measured on.
TEST(LoadLaw, StandsForTheEquilibriumOfPatchesItWasNotMeasuredOn) {
  for (const AirLimit air : {AirLimit::Emission, AirLimit::Ionisation}) {
    Scene scene = driven(150);
    scene.model.coupling = Coupling::Equilibrium;
    scene.model.air_limit = air;
    const Patch patch(scene);
    std::vector<AttractionSample> samples;
    for (int k = 0; k < 24; ++k) {
      const std::vector<double> height = patch.setup.height(patch.setup.skin(k));
      PatchProblem problem = patch.problem;
      problem.height = height;
      problem.droplet_index = static_cast<std::uint64_t>(k);
      PatchStates states, settled;
      UndrivenPatch before;
      const PatchResult dry =
          solve_patch(problem, patch.plan, patch.fidelity, states, nullptr, &before);
      samples.push_back({dry, settled_patch(problem, patch.plan, patch.fidelity, before, settled)});
    }
    // How far the law is from the equilibrium of skins, in units of what one pass lacks.
    const auto missing = [&](const AttractionLaw& law, std::span<const AttractionSample> of) {
      double by_law = 0, solved = 0, dry = 0;
      for (const AttractionSample& s : of) {
        PatchResult by = s.dry;
        law.apply(by);
        by_law += by.pull + by.capillary_on;
        solved += s.settled.pull + s.settled.capillary_on;
        dry += s.dry.pull + s.dry.capillary_on;
      }
      EXPECT_GT(solved, 1.02 * dry);
      return std::abs(by_law - solved) / (solved - dry);
    };
    const std::span<const AttractionSample> all = samples;
    const AttractionLaw few = attraction_law(all.first(3)), own = attraction_law(all);
    ASSERT_TRUE(few.status.sound() && own.status.sound());
    EXPECT_GT(few.pull, 0);
    EXPECT_LT(missing(few, all.subspan(3)), 0.5) << static_cast<int>(air);
    EXPECT_LT(missing(own, all), 0.15) << static_cast<int>(air);
  }
}

// Eq. coupling.14: an exponent is ln(after/before)/ln(L) where the load tells it, and none where
// the load is hardly more than the nominal one; more skins tell more.
TEST(LoadLaw, ShrinksAnExponentThatTheLoadDoesNotTell) {
  // Water and pull that grow by these factors, beside a load of 1.
  const auto law = [](double water, double water_by, double pull, double pull_by, int skins) {
    AttractionSample s;
    s.dry.load = s.settled.load = 1;
    s.dry.capillary_off = s.dry.capillary_on = water, s.dry.pull = pull;
    s.settled = s.dry;
    s.settled.capillary_off *= water_by, s.settled.capillary_on *= water_by;
    s.settled.pull *= pull_by;
    const std::vector<AttractionSample> all(static_cast<std::size_t>(skins), s);
    return attraction_law(all);
  };
  const auto shrunk = [](double by, double load, double unknown) {
    return std::log(by) * std::log(load) / (square(std::log(load)) + unknown);
  };
  const AttractionLaw few = law(0.05, 1.3, 0.6, 1.2, 2);
  EXPECT_NEAR(few.capillary_off, shrunk(1.3, 1 + 0.05 * 1.3, 0.1 / 2), 1e-12);
  EXPECT_LT(few.capillary_off, 0.31);  // unshrunk 4.2
  const double on = 1 + 0.05 * 1.3 + 0.6 * 1.2;
  EXPECT_NEAR(few.capillary_on, shrunk(1.3, on, 0.1 / 2), 1e-12);
  EXPECT_NEAR(few.pull, shrunk(1.2, on, 0.02 / 2), 1e-12);
  const AttractionLaw many = law(0.05, 1.3, 0.6, 1.2, 1000);
  EXPECT_NEAR(many.pull, std::log(1.2) / std::log(on), 1e-4);
  EXPECT_NEAR(many.capillary_on, std::log(1.3) / std::log(on), 1e-3);
  // Nothing that attracts closes nothing, whatever the noise.
  EXPECT_EQ(law(0, 1, 0, 1, 2).pull, 0);
  EXPECT_NEAR(law(1e-9, 2, 0, 1, 2).capillary_off, 0, 1e-7);
}

TEST(LoadLaw, KnowsTheLoadOfItsSamples) {
  std::vector<AttractionSample> samples(3);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    PatchResult &dry = samples[k].dry, &settled = samples[k].settled;
    dry.load = settled.load = 2;
    dry.capillary_off = dry.capillary_on = dry.pull = 1;
    settled.capillary_off = settled.capillary_on = 1.1;
    settled.pull = k == 1 ? 3 : 1.2;
  }
  const AttractionLaw law = attraction_law(samples);
  EXPECT_NEAR(law.sampled_off, 1.55, 1e-12);
  EXPECT_NEAR(law.sampled_on, 1 + (3 * 1.1 + 5.4) / 6, 1e-12);
  EXPECT_NEAR(law.toward(AttractionLaw{}, 0.5).sampled_on, (law.sampled_on + 1) / 2, 1e-12);
}

// Powers whose fixed points are known: T = T0 sqrt(L) and T = T0 L; and water that pushes so hard
// that every step goes beyond the root, T = -0.9 L^3.
TEST(LoadLaw, SolvesItsFixedPoint) {
  AttractionLaw law;
  law.sampled_off = law.sampled_on = 10;
  law.pull = 0.5;
  const double root = law.load_on(0, 0.6);
  EXPECT_NEAR(std::sqrt(root), 0.3 + std::sqrt(1 + 0.09), 1e-9);
  law.pull = 1;
  EXPECT_NEAR(law.load_on(0, 0.6), 2.5, 1e-8);
  EXPECT_NEAR(law.load_off(0.1), 1.1, 1e-12);
  law.capillary_off = 3;
  law.sampled_off = 0.1;
  const double pushed = law.load_off(-0.9);
  EXPECT_NEAR(pushed, 1 - 0.9 * pushed * pushed * pushed, 1e-9);
}

// Beyond the load that was sampled nothing grows: T = T0 L, which has no root from T0 = 1
// on, stops there, and nothing steps where it begins to.
TEST(LoadLaw, GoesNoFartherThanItsSamples) {
  AttractionLaw law;
  law.pull = 1;
  law.sampled_on = 2;
  EXPECT_NEAR(law.load_on(0, 0.4), 1 / 0.6, 1e-8);
  EXPECT_NEAR(law.load_on(0, 0.4999), law.load_on(0, 0.5001), 2e-3);
  EXPECT_NEAR(law.load_on(0, 3), 1 + 3 * 2, 1e-9);
  PatchResult patch;
  patch.load = 2;
  patch.pull = 6;
  law.apply(patch);
  EXPECT_NEAR(patch.pull, 12, 1e-9);
  EXPECT_TRUE(patch.status.sound());
}

// A pull-in is one of a skin that was solved, the water's before the drive or the drive's.
TEST(LoadLaw, HasThePullInOfItsSamples) {
  for (const Trouble trouble : {Trouble::UndrivenPullIn, Trouble::ClosedPullIn}) {
    std::vector<AttractionSample> samples(3);
    for (AttractionSample& s : samples) s.dry.load = s.settled.load = 1;
    samples[1].settled.status.note({trouble, 0, ""});
    PatchResult patch;
    patch.load = 1;
    attraction_law(samples).apply(patch);
    EXPECT_EQ(patch.status.trouble, trouble);
  }
}

TEST(DrivePatch, WhatAPieceCannotSolveIsItsStatus) {
  // A bare electrode below a skin without its layer.
  Scene bare = driven(100);
  bare.surface.dielectric.clear();
  bare.finger.electrical.thickness_15 = bare.finger.electrical.thickness_75 = 0;
  bare.finger.water.volume = {0, 0, 0, 0};
  const Patch shorted(bare);
  PatchStates states;
  const PatchResult r = solve_patch(shorted.problem, shorted.plan, shorted.fidelity, states);
  EXPECT_EQ(r.status, (ModelStatus{Trouble::FieldUnsolved, 0,
                                   "no dielectric anywhere: contact would short the drive"}));
  // More load than the skin's hardness holds: no contact, and nothing after it.
  Scene soft = driven(100);
  soft.finger.skin.hardness = 1e5;
  const Patch crushed(soft);
  const UndrivenPatch u = undriven_patch(crushed.problem, crushed.plan, crushed.fidelity, {});
  EXPECT_EQ(u.result.status.trouble, Trouble::ContactUnsolved);
  EXPECT_EQ(u.result.status.number, 0);
  EXPECT_FALSE(u.result.status.reason.empty());
  EXPECT_TRUE(u.dry.gap.empty());
  EXPECT_EQ(u.result.volume, 0);
  states.dry.gap = {1}, states.off.gap = {1};
  const PatchResult none = solve_patch(crushed.problem, crushed.plan, crushed.fidelity, states);
  EXPECT_EQ(none.pull, 0);
  EXPECT_TRUE(states.dry.gap.empty() && states.off.gap.empty() && states.on.gap.empty());
}

// Far more water than gap.
TEST(DrivePatch, AFloodHasNoMeniscus) {
  Scene scene = driven(0);
  scene.finger.water.volume = {1e-15, 1e-15, 1e-15, 1e-15};
  const Patch patch(scene);
  const UndrivenPatch u = undriven_patch(patch.problem, patch.plan, patch.fidelity, {});
  EXPECT_EQ(u.result.status, (ModelStatus{Trouble::Flooded, 0, ""}));
  EXPECT_EQ(u.result.capillary_off, 0);
}

}  // namespace
}  // namespace papilla::tests::drive_patch_test
