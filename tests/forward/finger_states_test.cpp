// A wet and an occluded finger beside a clean one.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "design/design.h"
#include "forward/fidelity.h"
#include "forward/forward.h"

namespace papilla::tests::finger_states_test {
namespace {

ResponsePoint rubbed(const std::string& sample, std::vector<std::string> with,
                     const std::string& state = "clean") {
  with.push_back("finger.state=" + state);
  with.emplace_back("drive.amplitude=0 V");
  with.emplace_back("environment.relative_humidity=[\"55 %\"]");
  const Design design =
      read_design(std::string(PAPILLA_DESIGNS_DIR) + "/m3_samples/" + sample + ".toml", with);
  Fidelity fidelity = fidelity_level("search");
  fidelity.skins = 6;
  fidelity.control_skins = 0;
  return evaluate(scene_of(design), design.texture, fidelity).points.at(0);
}

double friction(const std::string& sample, const std::vector<std::string>& with,
                const std::string& state = "clean") {
  return rubbed(sample, with, state).friction_off.value;
}

// Adams 2013, Pasumarty 2011: several times, at every load.
TEST(WetFinger, RubsSeveralTimesMoreThanACleanOneOnSmoothGlass) {
  for (const char* load : {"0.05 N", "0.2 N", "1 N"}) {
    const std::vector<std::string> with{std::string("finger.load=\"") + load + "\""};
    const double ratio = friction("flat", with, "wet") / friction("flat", with);
    EXPECT_GT(ratio, 3) << load;
    EXPECT_LT(ratio, 15) << load;
  }
}

TEST(WetFinger, GainsLessTheRougherTheGlass) {
  double before = 1e9;
  for (const char* sample : {"flat", "screen_smooth", "screen_middle", "screen_rough"}) {
    const double ratio = friction(sample, {}, "wet") / friction(sample, {});
    EXPECT_LT(ratio, before) << sample;
    before = ratio;
  }
}

TEST(WetFinger, TouchesLessThanAllOfThePatchAtEveryLoad) {
  double before = 0;
  for (const char* load : {"0.05 N", "0.2 N", "1 N", "5 N", "20 N"}) {
    const double area = rubbed("flat", {std::string("finger.load=\"") + load + "\""}, "wet")
                            .area_fraction_off.value;
    EXPECT_GT(area, before) << load;
    EXPECT_LT(area, 1) << load;
    before = area;
  }
}

// Dzidek 2017: contact on glass grows over seconds and saturates within 20 s.
TEST(Occlusion, MakesACleanFingerRubMoreWithEverySecondUntilItIsSaturated) {
  std::vector<double> f;
  for (const char* time : {"0 s", "2 s", "7 s", "20 s", "200 s", "400 s"})
    f.push_back(friction("flat", {std::string("finger.touch_time=\"") + time + "\""}));
  for (std::size_t i = 1; i < 5; ++i) EXPECT_GT(f[i], f[i - 1]) << i;
  EXPECT_GT(f[4], 3 * f[0]);
  EXPECT_GT((f[3] - f[0]) / (f[4] - f[0]), 0.9);
  EXPECT_NEAR(f[5], f[4], 1e-6 * f[4]);
}

}  // namespace
}  // namespace papilla::tests::finger_states_test
