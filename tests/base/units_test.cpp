#include "base/units.h"

#include <gtest/gtest.h>

#include "base/constants.h"
#include "base/error.h"

namespace papilla::tests {
namespace {

TEST(Units, KnowTheUnitsOfTheField) {
  EXPECT_DOUBLE_EQ(parse_si("350 nm", "um"), 350e-9);
  EXPECT_DOUBLE_EQ(parse_si("15 %", ""), 0.15);
  EXPECT_DOUBLE_EQ(parse_si("0.01 um3", "m3"), 1e-20);
  EXPECT_DOUBLE_EQ(parse_si("72.1 mN/m", "N/m"), 0.0721);
  EXPECT_DOUBLE_EQ(parse_si("1 GV/m", "V/um"), 1e9);
  EXPECT_NEAR(parse_si("50 deg", "rad"), 0.8726646259971648, 1e-16);
  EXPECT_DOUBLE_EQ(parse_si("1e14 ohm m", "ohm m"), 1e14);
}

TEST(Units, RefuseAWrongDimensionAndABareNumber) {
  EXPECT_THROW(parse_si("3", "um"), InputError);
  EXPECT_THROW(parse_si("3 V", "um"), InputError);
  EXPECT_THROW(parse_si("3 parsec", "um"), InputError);
  EXPECT_THROW(parse_si("nan um", "um"), InputError);
}

TEST(Units, WrittenQuantitiesReadBackToTheSameDouble) {
  for (double si : {3e-6, 350e-9, 1.23456789e-7, 1e-3, 2.5e-6}) {
    for (const char* unit : {"um", "nm", "m", "mm"}) {
      EXPECT_EQ(parse_quantity(format_quantity(si, unit))->si, si) << si << " " << unit;
    }
  }
  for (int i = 1; i < 2000; ++i) {
    const double si = i * 1.2345678901e-3;
    EXPECT_EQ(parse_quantity(format_quantity(si, "deg"))->si, si);
    EXPECT_EQ(parse_quantity(format_quantity(si, "%"))->si, si);
  }
  EXPECT_EQ(format_quantity(3e-6, "um"), "3 um");
  EXPECT_EQ(format_quantity(0.15, "%"), "15 %");
  EXPECT_EQ(format_quantity(50 * kPi / 180, "deg"), "50 deg");
  EXPECT_EQ(parse_quantity("350 nm")->si, 350e-9);
}

}  // namespace
}  // namespace papilla::tests
