// What pages draw of a texture.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "config/describe.h"
#include "design/design.h"
#include "report/page_data.h"

namespace papilla::tests::page_test {
namespace {

// Wide holes leave narrow walls: more than half of the surface is deep.
TEST(Section, GoesThroughTheMiddleOfHolesHoweverWide) {
  Design design = read_design(PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml");
  for (const double diameter : {1.5e-6, 3e-6, 5.2e-6}) {
    set_number(design, "texture.diameter", diameter);
    const auto section = shape_json(design.texture).at("section");
    EXPECT_NEAR(section.at("low").get<double>(), -600e-9, 1e-12) << diameter;
    EXPECT_NEAR(section.at("high").get<double>(), 0, 1e-12) << diameter;
    EXPECT_GE(section.at("at").get<double>(), 0);
    EXPECT_LT(section.at("at").get<double>(), 1);
  }
}

TEST(Section, IsOfShapesOnALatticeAlone) {
  Texture rough = default_texture(7);
  ASSERT_EQ(texture_name(rough), "random_rough");
  EXPECT_FALSE(shape_json(rough).contains("section"));
}

}  // namespace
}  // namespace papilla::tests::page_test
