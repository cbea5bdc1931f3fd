// An exported file judged as what a maker will get.
#include "fabricate/verify.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/constants.h"
#include "fabricate/export.h"

namespace papilla::tests {
namespace {

TEST(Verify, NamesWhatIsNarrowerThanItsLimitAndHowFarTheMeritIsOff) {
  Study study;
  study.design.environment.relative_humidity = {0.35};
  HoleArray holes;
  holes.period = 6e-6, holes.diameter = 4e-6, holes.depth = 200e-9, holes.wall_angle = kPi / 2;
  study.design.texture = Texture{holes};
  study.constraints = {{"min_wall", 1.9e-6, true}, {"min_hole", 3.9e-6, true}};
  ExportOptions options;
  options.formats = {"gsf"};
  options.size = 12e-6;
  options.pixels = 192;
  const std::string folder = testing::TempDir() + "papilla_verify";
  const std::string file = export_design(study.design, options, folder).files.at(0).path;
  const Verification sound = verify_export(study, file, 0.2);
  EXPECT_TRUE(sound.faults.empty()) << sound.faults.front();
  EXPECT_NEAR(sound.pixels.min_wall, 2e-6, 0.1e-6);
  EXPECT_NEAR(sound.pixels.min_hole, 4e-6, 0.1e-6);
  EXPECT_EQ(sound.merit, "mean(friction)");  // undriven
  EXPECT_NEAR(sound.loss, std::abs(sound.file - sound.design) / sound.design, 1e-12);
  EXPECT_LT(sound.loss, 0.2);
  study.constraints[0].limit = 2.5e-6;
  const Verification narrow = verify_export(study, file, 0.2);
  ASSERT_EQ(narrow.faults.size(), 1u);
  EXPECT_TRUE(narrow.faults[0].starts_with("min_wall of the file is ")) << narrow.faults[0];
  EXPECT_NE(narrow.faults[0].find(" um, below 2.5 um (pixel 0.062 um)"), std::string::npos)
      << narrow.faults[0];
  EXPECT_EQ(verify_export(study, file, 0).faults.size(), 1u + (narrow.loss > 0));
}

}  // namespace
}  // namespace papilla::tests
