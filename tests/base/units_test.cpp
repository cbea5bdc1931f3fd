#include "base/units.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "base/constants.h"
#include "base/error.h"

namespace papilla::tests::units_test {
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

// Every unit by its definition in metre, kilogram, second, ampere and radian.
TEST(Units, AreWhatTheSiSays) {
  const std::map<std::string, Unit> si{
      {"m", {1, 1, 0, 0, 0, 0}},   {"N", {1, 1, 1, -2, 0, 0}},    {"Pa", {1, -1, 1, -2, 0, 0}},
      {"V", {1, 2, 1, -3, -1, 0}}, {"s", {1, 0, 0, 1, 0, 0}},     {"Hz", {1, 0, 0, -1, 0, 0}},
      {"A", {1, 0, 0, 0, 1, 0}},   {"ohm", {1, 2, 1, -3, -2, 0}}, {"F", {1, -2, -1, 4, 2, 0}},
      {"J", {1, 2, 1, -2, 0, 0}},  {"g", {1e-3, 0, 1, 0, 0, 0}},  {"rad", {1, 0, 0, 0, 0, 1}}};
  const std::map<std::string, double> prefixes{
      {"", 1},     {"f", 1e-15}, {"p", 1e-12}, {"n", 1e-9}, {"u", 1e-6}, {"µ", 1e-6},
      {"m", 1e-3}, {"c", 1e-2},  {"k", 1e3},   {"M", 1e6},  {"G", 1e9},  {"T", 1e12}};
  for (const auto& [name, unit] : si) {
    for (const auto& [prefix, factor] : prefixes) {
      const auto found = find_unit(prefix + name);
      ASSERT_TRUE(found) << prefix << name;
      EXPECT_TRUE(found->same_dimension(unit)) << prefix << name;
      EXPECT_NEAR(found->to_si, factor * unit.to_si, 1e-15 * factor * unit.to_si) << prefix << name;
    }
  }
  for (const auto& [name, value] : {std::pair{"min", 60.0}, {"h", 3600.0}, {"%", 0.01}})
    EXPECT_DOUBLE_EQ(find_unit(name)->to_si, value) << name;
  // Powers, products and quotients: equal dimensions by other ways.
  for (const auto& [one, other, ratio] : {std::tuple{"N", "kg m/s2", 1.0},
                                          {"mN/m", "kg/s2", 1e-3},
                                          {"J", "N*m", 1.0},
                                          {"V", "kg m2/A s3", 1.0},
                                          {"ohm m", "V m/A", 1.0},
                                          {"F", "A s/V", 1.0},
                                          {"um^3", "m3", 1e-18},
                                          {"mm²", "m2", 1e-6},
                                          {"um³", "m3", 1e-18},
                                          {"1/mm3", "1/m3", 1e9},
                                          {"1/m", "rad/rad m", 1.0}}) {
    const auto a = find_unit(one), b = find_unit(other);
    ASSERT_TRUE(a && b) << one << ", " << other;
    EXPECT_TRUE(a->same_dimension(*b)) << one << ", " << other;
    EXPECT_NEAR(a->to_si / b->to_si, ratio, 1e-14 * ratio) << one << ", " << other;
  }
  for (const char* none : {"parsec", "m//s", "m/s/s", "m ", " m", "kmin", "m5", "u"})
    EXPECT_FALSE(find_unit(none)) << none;
}

TEST(Units, PowersOfAnglesAreNoAngles) {
  EXPECT_EQ(find_unit("rad2")->radian, 2);
  EXPECT_EQ(find_unit("1/rad")->radian, -1);
  EXPECT_FALSE(find_unit("rad2")->same_dimension(*find_unit("rad")));
  EXPECT_EQ(find_unit("A2")->ampere, 2);
  EXPECT_EQ(find_unit("s3")->second, 3);
}

// Those of one factor, with their prefixes; minutes and hours have none.
TEST(Units, NamesOfADimensionAreAllThatReadAsIt) {
  for (const char* like : {"m", "Pa", "s", "%", "rad", "V"}) {
    const Unit unit = *find_unit(like);
    const std::vector<std::string> names = unit_names(unit);
    EXPECT_NE(std::find(names.begin(), names.end(), like), names.end()) << like;
    for (const std::string& name : names) {
      const auto found = find_unit(name);
      ASSERT_TRUE(found) << name;
      EXPECT_TRUE(found->same_dimension(unit)) << name;
    }
  }
  const std::vector<std::string> times = unit_names(*find_unit("s"));
  for (const char* name : {"ms", "min", "h", "ns"})
    EXPECT_NE(std::find(times.begin(), times.end(), name), times.end()) << name;
  for (const char* name : {"mh", "kmin", "m", "Hz"})
    EXPECT_EQ(std::find(times.begin(), times.end(), name), times.end()) << name;
}

TEST(Units, WhatHasNoUnitIsWrittenAsItIs) {
  EXPECT_EQ(format_quantity(3, "parsec"), "3 parsec");
  EXPECT_EQ(format_quantity(kInfinity, "um"), "inf um");
  EXPECT_EQ(format_quantity(0.25, ""), "0.25");
}

TEST(Units, DimensionsHaveNames) {
  for (const auto& [unit, name] : {std::pair{"", "a plain number or a percentage"},
                                   {"um", "a length"},
                                   {"mm2", "an area"},
                                   {"um3", "a volume"},
                                   {"1/um", "an inverse length"},
                                   {"mN", "a force"},
                                   {"kPa", "a pressure"},
                                   {"V", "a voltage"},
                                   {"h", "a time"},
                                   {"kHz", "a frequency"},
                                   {"uA", "a current"},
                                   {"Mohm", "a resistance"},
                                   {"pF", "a capacitance"},
                                   {"fJ", "an energy"},
                                   {"deg", "an angle"},
                                   {"mN/m", "a surface tension"},
                                   {"ohm m", "a resistivity"},
                                   {"V/um", "an electric field"},
                                   {"1/um3", "a number per volume"},
                                   {"m4", "another kind of quantity"}})
    EXPECT_EQ(dimension_name(*find_unit(unit)), name) << unit;
}

TEST(Units, EveryUnitHasTheNameOfItsSiUnit) {
  for (const auto& [unit, si] : {std::pair{"nm", "m"},
                                 {"um3", "m3"},
                                 {"deg", "rad"},
                                 {"%", ""},
                                 {"h", "s"},
                                 {"kHz", "Hz"},
                                 {"MPa", "Pa"},
                                 {"mN/m", "N/m"},
                                 {"V/um", "V/m"},
                                 {"1/um3", "1/m3"},
                                 {"um4", "m4"},
                                 {"g/s3", "kg1 s-3"}}) {
    EXPECT_EQ(si_name(*find_unit(unit)), si) << unit;
    EXPECT_NEAR(find_unit(si).value_or(Unit{}).to_si, 1, 1e-15) << si;
  }
}

TEST(Units, NumbersAreWrittenAsShortAsTheyReadBack) {
  for (const auto& [value, text] : {std::pair{0.0, "0"},
                                    {-0.25, "-0.25"},
                                    {1e6, "1000000"},
                                    {1e7, "1e7"},
                                    {12345678, "12345678"},
                                    {1.5e16, "1.5e16"},
                                    {1e-4, "0.0001"},
                                    {1e-5, "0.00001"},
                                    {1e-6, "1e-6"},
                                    {-2.5e-7, "-2.5e-7"},
                                    {0.1 + 0.2, "0.30000000000000004"}}) {
    EXPECT_EQ(format_number(value), text);
    EXPECT_EQ(std::strtod(format_number(value).c_str(), nullptr), value);
  }
  EXPECT_EQ(parse_quantity(" +2.5e2 nm ")->si, 250e-9);
  EXPECT_EQ(parse_quantity("1e-3 GPa")->si, 1e6);
  EXPECT_FALSE(parse_quantity("1e400 um"));
  EXPECT_FALSE(parse_quantity("um"));
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
}  // namespace papilla::tests::units_test
