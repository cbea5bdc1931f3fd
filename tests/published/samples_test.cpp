// Published samples under one finger: the same friction as the forward model's.
#include "published/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "design/design.h"
#include "forward/scale_bridge.h"
#include "numerics/statistics.h"
#include "published/targets.h"

namespace papilla::tests::samples_test {
namespace {

FingerModel small_model() {
  return FingerModel(read_finger(find_design("fingers/reference.toml")), Preset::Papilla, 1,
                     {"design", 4, 0, 64});
}

TEST(PublishedSamples, FrictionIsThatOfTheForwardModelWithoutRetention) {
  FingerModel model = small_model();
  const Sample& s = m3_sample(model, "flat");
  ASSERT_EQ(s.response.points.size(), static_cast<std::size_t>(kHumidities));
  for (int rh = 0; rh < kHumidities; ++rh) {
    const ResponsePoint& p = s.point(rh);
    EXPECT_NEAR(p.relative_humidity, humidity_percent(rh) / 100.0, 1e-12);
    EXPECT_GT(p.retention_force.value, 0);
    EXPECT_NEAR(
        (friction_off(s, rh, Skins::all()) + p.retention_force.value) / p.friction_off.value, 1,
        1e-12);
    const double held = p.retention_force.value + p.retention_gain;
    EXPECT_NEAR((friction_on(s, rh, Skins::all()) + held) / p.friction_on.value, 1, 1e-12);
  }
}

TEST(PublishedSamples, ASampleIsRunOncePerFinger) {
  FingerModel model = small_model();
  EXPECT_EQ(&m3_sample(model, "flat"), &m3_sample(model, "flat"));
}

TEST(PublishedTargets, TheGapIsThatOfTheSameCapacitanceBetweenPlates) {
  // 250 pF on 30 mm2, eps0 A / C = 1.0625 um.
  EXPECT_NEAR(kPublishedGap, 8.8541878128e-12 * 30e-6 / 250e-12, 0.005e-6);
}

// Areas of three skins at four humidities, written down here.
Sample sample_of(const std::vector<std::vector<double>>& off,
                 const std::vector<std::vector<double>>& on) {
  Sample out;
  for (std::size_t rh = 0; rh < off.size(); ++rh) {
    ResponsePoint p;
    p.strength = 2 + static_cast<double>(rh);
    p.samples.area_off = off[rh], p.samples.area_on = on[rh];
    for (const double a : off[rh]) p.samples.load_off.push_back(10 * a);
    out.response.points.push_back(p);
    out.preload.push_back(0.5 * static_cast<double>(rh));
  }
  return out;
}

TEST(PublishedSamples, NumbersAreThoseOfTheSkinsThatTheyAreOver) {
  const Sample s = sample_of({{0.1, 0.2, 0.3}, {0.2, 0.2, 0.5}, {0.3, 0.1, 0.2}, {0.4, 0.5, 0.3}},
                             {{0.2, 0.3, 0.4}, {0.3, 0.3, 0.9}, {0.4, 0.3, 0.2}, {0.5, 0.8, 0.5}});
  const Skins all = Skins::all();
  EXPECT_NEAR(Skins::only(1).mean({3, 5, 10}), 5, 1e-15);
  EXPECT_NEAR(Skins::without(1).mean({3, 5, 10}), 6.5, 1e-15);
  EXPECT_NEAR(all.mean({3, 5, 10}), 6, 1e-15);
  EXPECT_NEAR(friction_off(s, kDamp, all), 3 * 0.3, 1e-12);
  EXPECT_NEAR(friction_on(s, kDamp, all), 3 * 0.5, 1e-12);
  EXPECT_NEAR(effect(s, kDamp, all), 3 * 0.2, 1e-12);
  EXPECT_NEAR(effect(s, kWet, Skins::only(1)), 5 * 0.3, 1e-12);
  EXPECT_NEAR(modulation(s, kDry, all), 0.3 / 0.2 - 1, 1e-12);
  EXPECT_NEAR(modulation(s, kDry, Skins::without(0)), 0.35 / 0.25 - 1, 1e-12);
  EXPECT_NEAR(capillary_load(s, kMoist, all), 2 - 1.0, 1e-12);
  // Over humidity: modulations of 1/2, 2/3, 1/2 and 1/2.
  EXPECT_NEAR(mean_modulation(s, all), 13.0 / 24, 1e-12);
  EXPECT_NEAR(range_over_mean(s, all), (1.0 / 6) / (13.0 / 24), 1e-12);
  EXPECT_NEAR(deviation_over_mean(s, all), std::sqrt(3.0) / 24 / (13.0 / 24), 1e-12);
  const SkinEstimate growth = effect_ratio(s, kDry, kWet);
  EXPECT_EQ(growth.skins, 3);
  ASSERT_EQ(growth.single.size(), 3u);
  EXPECT_NEAR(growth.single[1], 5 * 0.3 / (2 * 0.1) - 1, 1e-12);
  // The jackknife of a mean is its samples: value and error of those.
  const SkinEstimate area =
      jackknife(s, [&](Skins over) { return over.mean(s.at(kWet).area_off); });
  EXPECT_NEAR(area.value, 0.4, 1e-12);
  EXPECT_NEAR(area.se, 0.1 / std::sqrt(3.0), 1e-12);
  EXPECT_NEAR(area.half_width(), student_t_quantile(0.975, 2) * area.se, 1e-12);
  EXPECT_FALSE(positive({{area.half_width() * 0.99, area.se}, 3}));
  EXPECT_TRUE(positive({{area.half_width() * 1.01, area.se}, 3}));
  EXPECT_TRUE(negative({{-area.half_width() * 1.01, area.se}, 3}));
  EXPECT_FALSE(negative({{area.half_width() * 1.01, area.se}, 3}));
  const Sample other = sample_of({{0.1, 0.1, 0.1}}, {{0.11, 0.12, 0.1}});
  EXPECT_NEAR(paired_percent(
                  s, other, [](const Sample& x, Skins over) { return over.mean(x.at(0).area_off); })
                  .value,
              100 * (0.1 / 0.2 - 1), 15);  // of few skins the jackknife is off a little
}

// A case changes what it names and nothing else of the design.
TEST(PublishedSamples, ACaseIsItsDesignUnderItsConditions) {
  const FingerModel model = small_model();
  const Design d = read_case(m3_case("a3h350"));
  const Scene own = scene_of(model, m3_case("a3h350"), d);
  EXPECT_EQ(own.surface.contact_angle, d.surface.contact_angle);
  EXPECT_EQ(own.finger.load, d.finger.load);
  EXPECT_EQ(own.model.preset, Preset::Papilla);
  EXPECT_GT(*std::max_element(own.finger.water.volume.begin(), own.finger.water.volume.end()), 0);
  EXPECT_NEAR(scene_of(model, m3_case("a3h350", 110), d).surface.contact_angle, 110 * kPi / 180,
              1e-12);
  SampleCase dry = m3_case("flat");
  dry.water = false;
  dry.state = FingerState::Wet;
  const Scene scene = scene_of(model, dry, read_case(dry));
  for (const double v : scene.finger.water.volume) EXPECT_EQ(v, 0);
  EXPECT_EQ(scene.finger.state, FingerState::Wet);
  EXPECT_EQ(m3_sample_names().size(), 6u);
}

// Each target again from the samples that its words name, by means over all skins; its error is of
// the size that the skins' own numbers scatter by.
TEST(PublishedTargets, AreTheNumbersThatTheyName) {
  FingerModel model = small_model();
  const auto targets = published_targets();
  const auto value = [&](const char* claim, const char* what) {
    for (const PublishedTarget& t : targets) {
      if (t.claim == claim && t.what.find(what) != std::string::npos) return t.model(model);
    }
    ADD_FAILURE() << claim << " " << what;
    return Estimate{};
  };
  const Skins all = Skins::all();
  const auto flat = [&](double angle, bool water) -> const Sample& {
    return sample(model, {.design = "m3_samples/flat.toml", .angle = angle, .water = water});
  };
  const Sample &own = flat(0, true), &dry = flat(0, false), &repelling = flat(110, true);
  const auto area = [&](const Sample& s, int rh) { return all.mean(s.at(rh).area_off); };
  const auto expect = [](const Estimate& e, double number, double scale) {
    EXPECT_NEAR(e.value, number, std::max(0.03 * scale, 2 * e.se));  // a jackknife of few skins
    EXPECT_LT(e.se, 0.5 * scale);
  };
  const double off =
      own.point(kWet).strength * area(own, kWet) / (own.point(kDry).strength * area(own, kDry));
  expect(value("M1", ""), off, off);
  expect(value("M2", ""), friction_on(own, kWet, all) / friction_on(own, kDry, all), off);
  const MacroContact& macro = model.finger().macro;
  const Estimate gross = value("M3", "");
  EXPECT_NEAR(gross.value, 100 * (macro.gross_area(0.2, 0.75) / macro.gross_area(0.2, 0.15) - 1),
              1e-9);
  EXPECT_EQ(gross.se, 0);
  expect(value("M4", ""), 100 * (area(own, kWet) / area(own, kDry) - 1), 100);
  expect(value("M5", ""), 100 * (area(own, kWet) / area(dry, kWet) - 1), 50);
  EXPECT_GT(value("M5", "").value, 0);  // capillaries add
  expect(value("M9", "flat"), effect(own, kDamp, all) / effect(own, kDry, all) - 1, 1);
  const Sample& deep = m3_sample(model, "a4h600");
  expect(value("M10", "15 to 35"), effect(deep, kDamp, all) / effect(deep, kDry, all) - 1, 1);
  expect(value("M10", "15 to 75"), effect(deep, kWet, all) / effect(deep, kDry, all) - 1, 1);
  expect(value("M13", ""),
         100 * (modulation(repelling, kWet, all) / modulation(own, kWet, all) - 1), 100);
  double most = 0;
  for (int rh = 0; rh < kHumidities; ++rh)
    most = std::max(most, modulation(flat(110, false), rh, all));
  expect(value("M15", ""), most, most);
  const ResponsePoint& wet = own.response.points[kWet];
  const Estimate retained = value("M17", "");
  EXPECT_NEAR(retained.value, 100 * wet.retention_force.value / wet.friction_off.value, 1e-9);
  EXPECT_NEAR(retained.se, 100 * wet.retention_force.se() / wet.friction_off.value, 1e-9);
  const double both = friction_off(own, kDamp, all) + friction_off(own, kMoist, all);
  expect(value(kFrictionTarget, ""), both / (2 * read_case(m3_case("flat")).finger.load), 0.3);
  EXPECT_NEAR(value(kGapTarget, "").value, 1e6 * capacitance_gap(model.finger()), 1e-9);
  for (const PublishedTarget& t : targets) {
    EXPECT_LE(t.low, t.high) << t.what;
    EXPECT_GT(t.sd, 0) << t.what;
  }
}

// The gap by its capacitance is that under 1 N on 30 mm2 of glass with 1 um of SiO2.
TEST(PublishedTargets, TheGapOfASlidingFingerIsUnderItsMeanPressure) {
  const Finger finger;
  EXPECT_DOUBLE_EQ(capacitance_gap(finger), capacitive_gap(finger, 1 / 30e-6, 0.256e-6, 0.45));
  EXPECT_GT(capacitive_gap(finger, 1 / 60e-6, 0.256e-6, 0.45), capacitance_gap(finger));
}

}  // namespace
}  // namespace papilla::tests::samples_test
