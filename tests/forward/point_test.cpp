// The answer of a humidity from patches whose numbers are written down here.
#include "forward/point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "forward/scene_terms.h"
#include "numerics/statistics.h"
#include "physics/contact/facts.h"

namespace papilla::tests::point_test {
namespace {

// Three skins; every number of one is proportional to the same share.
struct Case {
  Scene scene;
  Fidelity fidelity = fidelity_level("search");
  Plan plan;
  std::vector<PatchResult> patches;

  Case() {
    scene.drive.amplitude = 100;
    plan = make_plan(scene, Texture{}, fidelity);
    plan.water = false;  // no band of its own
    for (const double x : {1.0, 2.0, 3.0}) {
      PatchResult p;
      p.load = 1e-6;
      p.capillary_off = 1e-7 * x;
      p.capillary_on = 2e-7 * x;
      p.pull = 3e-7 * x;
      p.retention = 1e-8 * x;
      p.retention_on = 1.5e-8 * x;
      p.area_dry = 0.01 * x;
      p.area_off = 0.02 * x;
      p.area_on = 0.03 * x * x;
      p.bridges = 5 * x;
      p.wetted = 0.1 * x;
      p.bridge_volume = 1e-18 * x;
      p.volume = 4e-18;
      p.mean_gap = 1e-7 * x;
      p.indentation = 2e-7 * x;
      p.over_limit_area = 0.1 * x;
      p.over_limit_share = 0.2 * x;
      p.peak_oxide_field = 1e8 * (4 - x);
      p.peak_air_field = 2e7 * x;
      p.oxide_margin = 5 - x;
      p.certificate = 1e-4 * x;
      patches.push_back(p);
    }
  }

  ResponsePoint point(double area_factor = 1) const {
    const ScaleBridge bridge(scene, fidelity, plan.grid, 0.5);
    return response_point({scene, plan, fidelity, area_factor}, 0.5, 0.25, bridge, patches);
  }
  // Load-carrying area of the finger [m^2].
  double carrying() const {
    const MacroContact& macro = scene.finger.macro;
    return macro.load_share * macro.gross_area(scene.finger.load, 0.5);
  }
};

void expect(const Measured& m, double value, double sampling) {
  EXPECT_NEAR(m.value, value, 1e-12 * std::abs(value));
  EXPECT_NEAR(m.parts.sampling, sampling, 1e-12 * std::abs(value));
}

// The mean of 1, 2, 3 is 2 and its standard error 1 over the root of 3.
const double kSe = 1 / std::sqrt(3.0);

TEST(Point, MeansAreOfThePatchesAndForcesOfTheFinger) {
  const Case c;
  const ResponsePoint p = c.point();
  const double n = c.carrying() / c.plan.grid.area();
  EXPECT_EQ(p.relative_humidity, 0.5);
  EXPECT_EQ(p.weight, 0.25);
  EXPECT_DOUBLE_EQ(p.source_voltage, 100);
  EXPECT_DOUBLE_EQ(p.patch_pressure, c.scene.finger.patch_pressure(0.5));
  expect(p.capillary_force, 2e-7 * n, 1e-7 * kSe * n);
  expect(p.electrostatic_force, 6e-7 * n, 3e-7 * kSe * n);
  expect(p.retention_force, 2e-8 * n, 1e-8 * kSe * n);
  expect(p.bridges, 10, 5 * kSe);
  expect(p.wetted_fraction, 0.2, 0.1 * kSe);
  expect(p.mean_gap, 2e-7, 1e-7 * kSe);
  expect(p.indentation, 4e-7, 2e-7 * kSe);
  EXPECT_NEAR(p.over_limit_area, 0.2, 1e-12);
  EXPECT_NEAR(p.over_limit_share, 0.4, 1e-12);
  EXPECT_DOUBLE_EQ(p.oxide_margin, 2);
  EXPECT_DOUBLE_EQ(p.peak_oxide_field, 3e8);
  EXPECT_DOUBLE_EQ(p.peak_air_field, 6e7);
  EXPECT_NEAR(p.bridge_water_share, 0.5, 1e-12);
  EXPECT_NEAR(p.retention_gain, 1e-8 * n, 1e-20 * n);
  for (std::size_t k = 0; k < 3; ++k) {
    const auto x = static_cast<double>(k + 1);
    EXPECT_DOUBLE_EQ(p.samples.load_off[k], 1e-6 + 1e-7 * x);
    EXPECT_DOUBLE_EQ(p.samples.load_on[k], 1e-6 + 5e-7 * x);
    EXPECT_DOUBLE_EQ(p.samples.area_off[k], 0.02 * x);
    EXPECT_DOUBLE_EQ(p.samples.area_on[k], 0.03 * x * x);
  }
}

TEST(Point, ByTheLoadLawAreasGoWithThePowerOfTheLoads) {
  const Case c;
  const ResponsePoint p = c.point();
  const double beta = c.fidelity.load_exponent, off = std::pow(1.2, beta), on = std::pow(2, beta);
  EXPECT_NEAR(p.area_fraction_off.value, 0.02 * off, 1e-12);
  EXPECT_NEAR(p.area_fraction_on.value, 0.02 * on, 1e-12);
  // The dry area's scatter, and that of the load's ratio through the power: of the same skins.
  EXPECT_NEAR(p.area_fraction_off.parts.sampling, 0.02 * off * (kSe / 2 + beta * 0.1 * kSe / 1.2),
              1e-10);
  EXPECT_NEAR(p.area_fraction_on.parts.sampling, 0.02 * on * (kSe / 2 + beta * 0.5 * kSe / 2),
              1e-10);
  EXPECT_DOUBLE_EQ(p.strength, shear_strength(c.scene, 0.5) * c.carrying());
  const double n = c.carrying() / c.plan.grid.area();
  const double friction = p.strength * 0.02 * off + 2e-8 * n,
               driven = p.strength * 0.02 * on + 3e-8 * n;
  EXPECT_NEAR(p.friction_off.value, friction, 1e-12 * friction);
  EXPECT_NEAR(p.friction_on.value, driven, 1e-12 * driven);
  EXPECT_NEAR(p.modulation.value, driven / friction - 1, 1e-12);
  EXPECT_NEAR(p.friction_off.parts.sampling,
              p.strength * p.area_fraction_off.parts.sampling + 1e-8 * kSe * n, 1e-12 * friction);
}

// Second method for the error of sampling: the friction without each of sixteen skins, whose area,
// loads and retention go together in part.
TEST(Point, TheScatterOfFrictionIsThatOfTheJackknife) {
  Case c;
  c.patches.clear();
  constexpr int kSkins = 16;
  for (int k = 0; k < kSkins; ++k) {
    const double x = 1 + 0.3 * std::sin(k), y = 1 + 0.3 * std::cos(2.3 * k);
    PatchResult p;
    p.load = 1e-6;
    p.capillary_off = 2e-7 * (x + 0.5 * y);
    p.capillary_on = p.capillary_off;
    p.pull = 4e-7 * x;
    p.area_dry = 0.02 * x;
    p.area_off = 0.02 * x;
    p.area_on = 0.03 * x;
    p.retention = p.retention_on = 5e-6 * (x + y);
    c.patches.push_back(p);
  }
  const auto expect_jackknife = [&] {
    const ResponsePoint all = c.point();
    for (const auto friction : {&ResponsePoint::friction_off, &ResponsePoint::friction_on}) {
      std::vector<double> without;
      for (int k = 0; k < kSkins; ++k) {
        Case others = c;
        others.patches.erase(others.patches.begin() + k);
        without.push_back((others.point().*friction).value);
      }
      const Measured& stated = all.*friction;
      const double wanted = mean_estimate(jackknife_samples(stated.value, without)).se;
      EXPECT_GT(stated.parts.sampling, 0);
      EXPECT_NEAR(stated.parts.sampling, wanted, 0.01 * wanted);
    }
  };
  expect_jackknife();
  c.fidelity.estimator = Estimator::Area;
  c.plan.traction_solves = true;
  expect_jackknife();
  c.scene.touch.coefficient = 0.3;
  expect_jackknife();
}

// Half the patch is a tenth of a per cent off the power, and ten times the patch is the patch.
TEST(Point, ByTheLoadLawAreasEndSmoothlyAtThePatch) {
  Case c;
  c.plan.retention = false;
  double before = 0;
  for (double pull = 1e-7; pull < 1e-2; pull *= 1.3) {
    for (PatchResult& p : c.patches) p.pull = pull;
    const ResponsePoint p = c.point();
    const double open = 0.02 * std::pow(1.4 + pull / 1e-6, c.fidelity.load_exponent);
    EXPECT_GT(p.area_fraction_on.value, before);
    before = p.area_fraction_on.value;
    EXPECT_LE(before, 1);
    if (open < 0.5) {
      EXPECT_NEAR(before, open, 5e-4 * open);
    }
    if (open > 2) {
      EXPECT_NEAR(before, 1, 5e-4);
    }
    EXPECT_EQ(p.status.trouble == Trouble::FullContact, open > 1) << open;
    EXPECT_NEAR(p.modulation.value, before / p.area_fraction_off.value - 1, 2e-2);
  }
  EXPECT_GT(before, 0.999);
}

TEST(Point, BySolvedAreasTheModulationIsThatOfTheirSums) {
  Case c;
  c.fidelity.estimator = Estimator::Area;
  c.plan.traction_solves = true;
  c.plan.retention = false;
  const ResponsePoint p = c.point(0.5);
  expect(p.area_fraction_off, 0.5 * 0.04, 0.5 * 0.02 * kSe);
  EXPECT_NEAR(p.area_fraction_on.value, 0.5 * 0.03 * 14 / 3, 1e-12);
  EXPECT_NEAR(p.modulation.value, 0.42 / 0.12 - 1, 1e-12);
  EXPECT_EQ(p.retention_force.value, 0);
  EXPECT_EQ(p.retention_gain, 0);
  EXPECT_NEAR(p.friction_on.value, p.strength * 0.07, 1e-12 * p.friction_on.value);
  EXPECT_DOUBLE_EQ(p.samples.area_off[2], 0.03);
  EXPECT_DOUBLE_EQ(p.samples.area_on[2], 0.135);
  // A plan without solves under tractions has the load law alone.
  c.plan.traction_solves = false;
  EXPECT_NEAR(c.point().area_fraction_on.value, 0.02 * std::pow(2, c.fidelity.load_exponent),
              1e-12);
}

TEST(Point, TheSolversPartIsOfTheWorstCertificate) {
  const Case c;
  const ResponsePoint p = c.point();
  const double relative = contact::contact_error(3e-4);
  for (const PointQuantity& q : kPointQuantities) {
    const Measured& m = p.*q.value;
    const double of = q.value == &PointQuantities::modulation ? 1 + m.value : std::abs(m.value);
    EXPECT_NEAR(*m.parts.solver, relative * of, 1e-12 * of);
  }
}

// Eq. friction.4: what an attraction lacks is a share of the load, and friction by a coefficient
// lacks all of it.
TEST(Point, FrictionByACoefficientIsOffAsTheLoadIs) {
  Case c;
  c.patches[0].coupling_residual = 0.01;
  for (PatchResult& p : c.patches) p.certificate = 0;
  const ResponsePoint by_areas = c.point();
  c.scene.touch.coefficient = 0.3;
  const ResponsePoint by_load = c.point();
  const double beta = c.fidelity.load_exponent;
  EXPECT_NEAR(*by_areas.friction_on.parts.solver, 0.01 * beta * by_areas.friction_on.value, 1e-12);
  EXPECT_NEAR(*by_load.friction_on.parts.solver, 0.01 * by_load.friction_on.value, 1e-12);
  EXPECT_NEAR(*by_load.area_fraction_on.parts.solver, 0.01 * beta * by_load.area_fraction_on.value,
              1e-12);
}

// Load times a coefficient is given: of the contact only attractions and retention stand.
TEST(Point, TheContactsErrorIsOfTheFrictionThatACoefficientLeavesToIt) {
  Case c;
  c.scene.touch.coefficient = 0.3;
  const double relative = contact::contact_error(3e-4);
  const double n = c.carrying() / c.plan.grid.area(), given = 0.3 * 1e-6 * n;
  const ResponsePoint p = c.point();
  EXPECT_NEAR(*p.friction_off.parts.solver, relative * (p.friction_off.value - given),
              1e-9 * p.friction_off.value);
  EXPECT_NEAR(*p.friction_on.parts.solver, relative * (p.friction_on.value - given),
              1e-9 * p.friction_on.value);
  EXPECT_NEAR(*p.modulation.parts.solver,
              relative * (p.friction_on.value - given) / p.friction_off.value, 1e-9);
  EXPECT_NEAR(*p.area_fraction_on.parts.solver, relative * p.area_fraction_on.value, 1e-12);
  for (PatchResult& patch : c.patches)
    patch.capillary_off = patch.retention = patch.retention_on = 0;
  EXPECT_NEAR(*c.point().friction_off.parts.solver, 0, 1e-9 * given);
}

TEST(Point, TroubleIsTheFirstPatchesAPullInOrContactOfMoreThanThePatch) {
  Case c;
  EXPECT_TRUE(c.point().status.sound());
  EXPECT_EQ(c.point(1000).status.trouble, Trouble::FullContact);
  EXPECT_NEAR(c.point(1000).status.number, 20 * std::pow(1.2, c.fidelity.load_exponent), 1e-9);
  c.patches[1].status.note({Trouble::Flooded, 0, ""});
  c.patches[2].status.note({Trouble::PassesUsedUp, 0, ""});
  EXPECT_EQ(c.point(1000).status.trouble, Trouble::Flooded);
  c.patches[2].status.note({Trouble::ClosedPullIn, 0, ""});
  EXPECT_EQ(c.point(1000).status.trouble, Trouble::ClosedPullIn);
}

// Load times a coefficient, whatever touches.
TEST(Point, FrictionByACoefficientHasNoFullContact) {
  Case c;
  c.scene.touch.coefficient = 0.3;
  const ResponsePoint open = c.point(), full = c.point(1000);
  EXPECT_TRUE(full.status.sound()) << text(full.status);
  EXPECT_EQ(full.friction_on.value, open.friction_on.value);
  c.fidelity.estimator = Estimator::Area;
  c.plan.traction_solves = true;
  EXPECT_TRUE(c.point(1000).status.sound());
  c.scene.touch.coefficient = 0;
  EXPECT_EQ(c.point(1000).status.trouble, Trouble::FullContact);
}

// Closure balance: patches that the open gaps bring into contact count among what touches, of which
// there is no more than the patch.
TEST(Point, ByTheLoadLawAreasOfMorePatchesEndAtThePatchToo) {
  Case c;
  c.plan.retention = false;
  c.scene.model.closure = Closure::Balance;
  c.scene.finger.macro.far_gaps = 1;
  const ScaleBridge bridge(c.scene, c.fidelity, c.plan.grid, 0.5);
  const double growth = bridge.growth_on();
  ASSERT_GT(growth, 2);
  const double beta = c.fidelity.load_exponent;
  for (const double open : {0.3, 1.5}) {
    // The load on a patch in contact, whose own area stays below the patch.
    const double times = std::pow(open / (0.02 * growth), 1 / beta);
    for (PatchResult& p : c.patches) {
      p.capillary_off = p.capillary_on = 0;
      p.pull = (times * growth - 1) * p.load;
    }
    const ResponsePoint p = c.point();
    EXPECT_EQ(p.status.trouble == Trouble::FullContact, open > 1) << open << ": " << text(p.status);
    EXPECT_EQ(p.knows_driven(), open < 1) << open;
    EXPECT_LE(p.area_fraction_on.value, 1);
    EXPECT_NEAR(p.area_fraction_on.value, std::min(open, 1.0), 0.05 * std::min(open, 1.0)) << open;
    EXPECT_NEAR(p.modulation.value, p.area_fraction_on.value / p.area_fraction_off.value - 1,
                1e-9 * p.modulation.value);
  }
}

// A smooth pin touches everywhere under its load: attraction brings no more into contact, and the
// friction under voltage is the friction without it.
TEST(Point, AContactThatTheLoadAloneHasClosedIsNoTroubleAndDoesNotGrow) {
  Case c;
  for (PatchResult& patch : c.patches) {
    patch.area_dry = 1;
    patch.retention = patch.retention_on = 0;
  }
  const ResponsePoint closed = c.point();
  EXPECT_TRUE(closed.status.sound()) << text(closed.status);
  EXPECT_NEAR(closed.area_fraction_on.value, 1, 1e-12);
  EXPECT_NEAR(closed.modulation.value, 0, 1e-12);
  // Where it leaves a tenth open, the law says more than there is.
  for (PatchResult& patch : c.patches) patch.area_dry = 0.9;
  EXPECT_EQ(c.point().status.trouble, Trouble::FullContact);
}

TEST(Point, WithoutADriveThereIsNoModulation) {
  Case c;
  c.plan.field = false;
  const ResponsePoint p = c.point();
  EXPECT_EQ(p.modulation.value, 0);
  EXPECT_EQ(p.modulation.parts.sampling, 0);
  EXPECT_EQ(p.source_voltage, 0);
  for (PatchResult& patch : c.patches) patch.volume = 0;
  EXPECT_EQ(c.point().bridge_water_share, 0);
}

// The volumes of the reference finger are known from 15 to 75 % RH.
TEST(Point, WaterBeyondItsFitAndWaterWithoutRoomAreSaid) {
  Case c;
  ModelStatus before;
  const auto at = [&](double rh) {
    ResponsePoint p = c.point();
    p.relative_humidity = rh;
    p.status = before;
    note_water(p, c.scene.finger.water);
    return p.status;
  };
  EXPECT_TRUE(at(0.15).sound() && at(0.5).sound() && at(0.75).sound());
  EXPECT_EQ(at(0.14), (ModelStatus{Trouble::WaterBeyondFit, 0.15, ""}));
  EXPECT_EQ(at(0.9), (ModelStatus{Trouble::WaterBeyondFit, 0.75, ""}));
  for (PatchResult& p : c.patches) p.wetted = 0.93;  // and contact has some 2 to 3 %
  EXPECT_EQ(at(0.5).trouble, Trouble::NearlyFlooded);
  EXPECT_NEAR(at(0.5).number, 1 - 0.93 - c.point().area_fraction_off.value, 1e-12);
  for (PatchResult& p : c.patches) p.wetted = 0.9;
  EXPECT_TRUE(at(0.5).sound());
  before = {Trouble::Flooded, 0, ""};  // says more
  EXPECT_EQ(at(0.9), before);
  // And hides no volume that is continued.
  ResponsePoint flooded = c.point();
  flooded.status = before, flooded.relative_humidity = 0.9;
  note_water(flooded, c.scene.finger.water);
  EXPECT_EQ(flooded.water_fit, (ModelStatus{Trouble::WaterBeyondFit, 0.75, ""}));
}

// The load of the finger under the drive is the preload, what water holds without the drive, this
// and the pull.
TEST(Point, TheLoadUnderTheDriveIsThatOfItsForces) {
  Case c;
  const ResponsePoint p = c.point();
  const double n = c.carrying() / c.plan.grid.area();
  EXPECT_NEAR(p.capillary_gain, n * 2e-7, 1e-12 * n * 2e-7);
  double on = 0;
  for (const double load : p.samples.load_on) on += n * load / 3;
  EXPECT_NEAR(n * p.samples.preload + p.capillary_force.value + p.capillary_gain +
                  p.electrostatic_force.value,
              on, 1e-12 * on);
  c.plan.field = false;
  EXPECT_EQ(c.point().capillary_gain, 0);
}

}  // namespace
}  // namespace papilla::tests::point_test
