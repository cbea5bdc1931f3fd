// Published samples under one finger: the same friction as the forward model's.
#include "published/samples.h"

#include <gtest/gtest.h>

#include "design/design.h"
#include "published/targets.h"

namespace papilla::tests {
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

}  // namespace
}  // namespace papilla::tests
