// The water of the library is that of the rooms inside, which this file sees too.
#define PAPILLA_INSIDE
#include <gtest/gtest.h>
#include <papilla/physics.h>

#include "physics/capillary/water.h"

namespace {

TEST(DropletsOfTheLibrary, HaveTheWaterOfTheProgram) {
  const papilla::api::Water mine;
  const papilla::capillary::WaterProperties water;
  EXPECT_EQ(mine.surface_tension, water.surface_tension);
  EXPECT_EQ(mine.theta_skin, water.theta_skin);
  EXPECT_EQ(mine.theta_substrate, water.theta_substrate);
  EXPECT_EQ(mine.hysteresis, water.hysteresis);
}

}  // namespace
