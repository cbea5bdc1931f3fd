// Every published target with its band, and what it reads off samples whose areas are written down
// here.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "forward/dry_areas.h"
#include "forward/forward.h"
#include "forward/scale_bridge.h"
#include "published/targets.h"
#include "tests/published/planted.h"

namespace papilla::tests::planted_targets_test {
namespace {

constexpr double kAny = std::numeric_limits<double>::infinity();

class PlantedTargets : public ::testing::Test {
 protected:
  static FingerModel model_of(Finger finger = {}) {
    return {std::move(finger), Preset::Papilla, 1, {.level = "search", .skins = 2, .grid = 32}};
  }
  void expect(const std::string& what, double value, double se) {
    for (const PublishedTarget& t : published_targets()) {
      if (t.what.find(what) == std::string::npos) continue;
      const Estimate e = t.model(model_);
      EXPECT_NEAR(e.value, value, 1e-9 * std::abs(value) + 1e-12) << t.what;
      EXPECT_NEAR(e.se, se, 1e-9 * se + 1e-12) << t.what;
      return;
    }
    ADD_FAILURE() << what;
  }

  FingerModel model_ = model_of();
};

// The numbers of the papers with the widths that their words leave.
TEST_F(PlantedTargets, AreFourteenNumbersWithTheirBandsAndWidths) {
  struct Row {
    const char *claim, *what;
    double low, high, sd;
  };
  const std::vector<Row> rows{
      {"M1", "F_off(75 %) / F_off(15 %), flat", 2, 2, 0.2},
      {"M2", "F_on(75 %) / F_on(15 %), flat", 2, 2, 0.2},
      {"M3", "growth of the gross area, %", 58.5, 58.5, 3},
      {"M4", "growth of the patch's real area, flat, %", 45.5, 45.5, 4},
      {"M5", "area added by capillaries at 75 %, flat, %", 22.3, 24.1, 4},
      {"M9", "change of ΔF, 15 to 35 %, flat", 0.02, kAny, 0.05},
      {"M9", "change of ΔF, 35 to 75 %, a4h350", -kAny, -0.08, 0.05},
      {"M10", "change of ΔF, 15 to 35 %, a4h600", -0.25, 0.05, 0.1},
      {"M10", "change of ΔF, 15 to 75 %, a4h600", -0.25, 0.05, 0.1},
      {"M13", "110° against 50°, flat at 75 %, %", 130, 130, 20},
      {"M15", "largest modulation at 110° without water", 1.38, 1.38, 0.1},
      {"M17", "retention at 75 %, flat, % of F_off", 5, 5, 2},
      {"C_gap", "gap of a sliding finger by its capacitance, um", 1.06, 1.06, 0.1},
      {"friction", "friction coefficient, flat, 35 and 55 %", 0.2, 0.4, 0.1}};
  const std::vector<PublishedTarget> targets = published_targets();
  ASSERT_EQ(targets.size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(targets[i].claim, rows[i].claim);
    EXPECT_EQ(targets[i].what, rows[i].what);
    EXPECT_DOUBLE_EQ(targets[i].low, rows[i].low) << rows[i].what;
    EXPECT_DOUBLE_EQ(targets[i].high, rows[i].high) << rows[i].what;
    EXPECT_DOUBLE_EQ(targets[i].sd, rows[i].sd) << rows[i].what;
  }
}

// Of 0.5 at a strength of 2 N to 0.6 and 0.8 at 5 N; without water 0.5 of the two is left. Under
// voltage 0.8 becomes 1 and 1.2.
TEST_F(PlantedTargets, FrictionAndAreaGrowFromDryToWet) {
  plant(model_, m3_case("flat"),
        planted({{0.5, 0.5}, {9, 9}, {8, 8}, {0.6, 0.8}}, {{0.8, 0.8}, {9, 9}, {8, 8}, {1, 1.2}},
                {2, 9, 8, 5}));
  plant(model_, {.design = "m3_samples/flat.toml", .water = false},
        planted(on_two_skins({9, 9, 9, 0.5}), on_two_skins({9, 9, 9, 9})));
  expect("F_off(75 %)", 3.5, 0.5);
  expect("F_on(75 %)", 3.4375, 0.3125);
  expect("real area", 40, 20);
  expect("by capillaries", 40, 20);
  expect("friction coefficient", (9 * 9 + 8 * 8) / (2 * 0.2), 0);  // at 35 and 55 %, of 0.2 N
}

TEST_F(PlantedTargets, TheGrossAreaGrowsByWhatItsFingerSays) {
  Finger finger;
  finger.macro.area_growth = 0.37;
  model_ = model_of(finger);
  expect("gross area", 37, 0);
}

// Effects of a strength times the difference of two areas.
TEST_F(PlantedTargets, EffectsChangeFromOneHumidityToAnother) {
  const auto acting = [&](const char* name, const std::vector<double>& difference, double scatter) {
    Numbers off = on_two_skins({0.25, 0.25, 0.25, 0.25}), on = off;
    for (std::size_t rh = 0; rh < on.size(); ++rh) {
      on[rh][0] += difference[rh] - (rh > 0 ? scatter : 0);
      on[rh][1] += difference[rh] + (rh > 0 ? scatter : 0);
    }
    plant(model_, m3_case(name), planted(off, on, {1, 2, 4, 8}));
  };
  acting("flat", {0.5, 0.375, 9, 8}, 0.125);  // 1/2 N to 3/4 N, a quarter more or less
  expect("15 to 35 %, flat", 0.5, 0.5);
  acting("a4h350", {9, 0.5, 8, 0.1}, 0);  // 1 N to 0.8 N
  expect("35 to 75 %, a4h350", -0.2, 0);
  acting("a4h600", {1, 0.45, 8, 0.0625}, 0.0125);  // 1 N to 0.9 N and to 0.5 N
  expect("15 to 35 %, a4h600", -0.1, 0.025);
  expect("15 to 75 %, a4h600", -0.5, 0.1);
}

TEST_F(PlantedTargets, HydrophobicGlassModulatesMore) {
  plant(model_, m3_case("flat"), modulated({9, 8, 7, 0.4}));
  plant(model_, m3_case("flat", 110), modulated({{6, 6}, {5, 5}, {4, 4}, {0.9, 1.1}}));
  expect("110° against 50°", 150, 25);
  plant(model_, {.design = "m3_samples/flat.toml", .angle = 110, .water = false},
        modulated({{0.1, 0.1}, {0.2, 0.2}, {1.2, 1.4}, {0.3, 0.3}}));
  expect("largest modulation", 1.3, 0.1);
}

// The grid's error is part of the retention's; that of the friction is not.
TEST_F(PlantedTargets, TheRetentionIsAShareOfTheWetFriction) {
  Sample s = modulated({1, 1, 1, 1});
  for (ResponsePoint& p : s.response.points) p.friction_off.value = p.retention_force.value = 7;
  ResponsePoint& wet = s.response.points[kWet];
  wet.retention_force = {0.02, {.sampling = 3e-3, .grid = 4e-3}};
  wet.friction_off = {0.25, {.sampling = 9}};
  plant(model_, m3_case("flat"), s);
  expect("retention", 8, 2);
}

// 1 N on 30 mm2 at 45 % RH, under a micrometre of SiO2.
TEST_F(PlantedTargets, TheGapIsThatOfTheFingerOfTheModel) {
  Finger finger;
  finger.macro.ridge_rms *= 1.5;
  model_ = model_of(finger);
  const double gap = capacitive_gap(finger, 1 / 30e-6, 0.256e-6, 0.45);
  expect("by its capacitance", 1e6 * gap, 0);
  EXPECT_GT(std::abs(gap / capacitance_gap(Finger{}) - 1), 0.01);
}

// The skins of a fit: a level with its grid, its count and where it starts, solved to 1e-5 at
// least; the load law goes without a 3-D field.
TEST(SkinSampling, IsItsLevelOnItsSkins) {
  const Fidelity claims = SkinSampling{}.fidelity(3);
  EXPECT_EQ(claims.level, "design");
  EXPECT_EQ(claims.grid, 256);
  EXPECT_EQ(claims.skins, 40);
  EXPECT_EQ(claims.first_skin, 5000);
  EXPECT_EQ(claims.threads, 3);
  EXPECT_EQ(claims.contact_tolerance, 1e-5);
  EXPECT_EQ(claims.field_skins, 2);
  const SkinSampling few{.level = "draft", .skins = 5, .first_skin = 7, .grid = 1};
  const Fidelity fit = few.fidelity(1);
  EXPECT_EQ(fit.level, "draft");
  EXPECT_EQ(fit.grid, 1);
  EXPECT_EQ(fit.skins, 5);
  EXPECT_EQ(fit.first_skin, 7);
  EXPECT_EQ(fit.contact_tolerance, 1e-5);
  EXPECT_EQ(fit.field_skins, 0);
  EXPECT_EQ((SkinSampling{.level = "reference"}.fidelity(1).contact_tolerance), 1e-6);
}

TEST(FingerModel, AsksOnceUnderEachWord) {
  FingerModel model(Finger{}, Preset::M3, 2, {.skins = 3});
  int made = 0;
  const std::function<int()> make = [&] { return ++made; };
  EXPECT_EQ(model.once("a", make), 1);
  EXPECT_EQ(model.once("b", make), 2);
  EXPECT_EQ(model.once("a", make), 1);
  EXPECT_EQ(model.preset(), Preset::M3);
  EXPECT_EQ(model.fidelity().threads, 2);
  EXPECT_EQ(model.sampling().skins, 3);
}

// By the load law areas follow loads: each skin's area times the 0.84th power of its load over the
// preload, which is the patch's pressure times its area. At rest: four times as many skins.
TEST(PublishedSamples, AreasOfTheLoadLawAreThoseOfLoads) {
  FingerModel model(Finger{}, Preset::Papilla, 1,
                    {.level = "search", .skins = 2, .first_skin = 5, .grid = 32});
  const Design d = read_case(m3_case("flat"));
  const auto expect = [](const Sample& s, const Response& r) {
    ASSERT_EQ(s.preload.size(), r.points.size());
    for (std::size_t rh = 0; rh < r.points.size(); ++rh) {
      const double preload = r.points[rh].patch_pressure * r.plan.grid.lx * r.plan.grid.ly;
      EXPECT_NEAR(s.preload[rh], preload, 1e-12 * preload);
      const PatchSamples &was = r.points[rh].samples, &is = s.response.points[rh].samples;
      ASSERT_EQ(is.area_off.size(), was.load_off.size());
      for (std::size_t k = 0; k < is.area_off.size(); ++k) {
        EXPECT_NEAR(is.area_off[k], was.area_off[k] * std::pow(was.load_off[k] / preload, 0.84),
                    1e-12 * is.area_off[k]);
        EXPECT_NEAR(is.area_on[k], was.area_on[k] * std::pow(was.load_on[k] / preload, 0.84),
                    1e-12 * is.area_on[k]);
      }
    }
  };
  Scene scene = scene_of(model, m3_case("flat"), d);
  Fidelity fidelity = model.fidelity();
  expect(m3_sample(model, "flat"), evaluate_resolved(scene, d.texture, fidelity, kDrySkins));
  EXPECT_GT(m3_sample(model, "flat").at(kWet).load_on[0], m3_sample(model, "flat").preload[kWet]);
  scene.drive.amplitude = 0;
  fidelity.skins = 8;
  const Sample& resting = m3_sample_at_rest(model, "flat");
  expect(resting, evaluate_resolved(scene, d.texture, fidelity, kDrySkins));
  EXPECT_EQ(resting.at(kDry).area_off.size(), 8u);
  EXPECT_EQ(resting.at(kWet).load_on, resting.at(kWet).load_off);
}

}  // namespace
}  // namespace papilla::tests::planted_targets_test
