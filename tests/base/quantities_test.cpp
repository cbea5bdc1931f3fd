// Units and numbers as whole texts: every name of a dimension, where a number turns to an exponent,
// the longest way of an angle to its text, what each wrong input is told.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"

namespace papilla::tests::quantities_test {
namespace {

std::string refusal(const std::string& text, const std::string& unit) {
  try {
    parse_si(text, unit);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Quantities, NamesOfADimensionAreThesePrefixesInThisOrder) {
  const auto names = [](const char* like) { return join_names(unit_names(*find_unit(like))); };
  EXPECT_EQ(names("m"), "m, fm, pm, nm, um, µm, μm, mm, cm, km, Mm, Gm, Tm");
  EXPECT_EQ(names("V"), "V, fV, pV, nV, uV, µV, μV, mV, cV, kV, MV, GV, TV");
  EXPECT_EQ(names("h"), "s, fs, ps, ns, us, µs, μs, ms, cs, ks, Ms, Gs, Ts, min, h");
  EXPECT_EQ(names("deg"),
            "rad, frad, prad, nrad, urad, µrad, μrad, mrad, crad, krad, Mrad, Grad, Trad, deg");
  EXPECT_EQ(names(""), "%");
  EXPECT_EQ(names("N m"), "J, fJ, pJ, nJ, uJ, µJ, μJ, mJ, cJ, kJ, MJ, GJ, TJ");
  EXPECT_EQ(names("m2"), "");
}

// Products, one quotient and powers of two to four.
TEST(Quantities, AUnitIsAProductOverAProductOfPowers) {
  const auto is = [](const char* name, const Unit& unit) {
    const auto found = find_unit(name);
    ASSERT_TRUE(found) << name;
    EXPECT_NEAR(found->to_si / unit.to_si, 1, 1e-14) << name;
    EXPECT_TRUE(found->same_dimension(unit)) << name << found->metre << found->kilogram
                                             << found->second << found->ampere << found->radian;
  };
  is("", {1, 0, 0, 0, 0, 0});
  is("1", {1, 0, 0, 0, 0, 0});
  is("mm2", {1e-6, 2, 0, 0, 0, 0});
  is("mm^4", {1e-12, 4, 0, 0, 0, 0});
  is("cm³", {1e-6, 3, 0, 0, 0, 0});
  is("um²/s", {1e-12, 2, 0, -1, 0, 0});
  is("kg mm/ms2 A", {1e3, 1, 1, -2, -1, 0});  // all that follows the stroke divides
  is("1/cm3", {1e6, -3, 0, 0, 0, 0});
  is("µm", {1e-6, 1, 0, 0, 0, 0});  // the micro sign, and the Greek letter
  is("μm", {1e-6, 1, 0, 0, 0, 0});
  is("uA h", {3.6e-3, 0, 0, 1, 1, 0});
  is("deg/min", {kPi / 180 / 60, 0, 0, -1, 0, 1});
  is("mF*V2", {1e-3, 2, 1, -2, 0, 0});
  is("%", {0.01, 0, 0, 0, 0, 0});
  is("rad3", {1, 0, 0, 0, 0, 3});
  for (const char* none : {"m1", "m5", "m0", "^2", "2", "/", "/m", "m/", " ", "m**s", "mm^", "m^5",
                           "µ", "kk", "m%", "kdeg", "mmin", "uh", "m/s/A"})
    EXPECT_FALSE(find_unit(none)) << none;
}

TEST(Quantities, EachExponentCountsForTheDimension) {
  const Unit one{2, 1, 2, 3, 4, 5};
  EXPECT_TRUE(one.same_dimension({7, 1, 2, 3, 4, 5}));
  EXPECT_FALSE(one.same_dimension({2, 9, 2, 3, 4, 5}));
  EXPECT_FALSE(one.same_dimension({2, 1, 9, 3, 4, 5}));
  EXPECT_FALSE(one.same_dimension({2, 1, 2, 9, 4, 5}));
  EXPECT_FALSE(one.same_dimension({2, 1, 2, 3, 9, 5}));
  EXPECT_FALSE(one.same_dimension({2, 1, 2, 3, 4, 9}));
  EXPECT_EQ(Unit{}.to_si, 1);
  EXPECT_TRUE(Unit{}.same_dimension({1, 0, 0, 0, 0, 0}));
}

// As they are read: blanks around, one sign, any exponent, the unit with or without a blank.
TEST(Quantities, AreReadWithTheirBlanksAndSigns) {
  const auto read = [](const char* text, double value, const char* unit, double si) {
    const auto q = parse_quantity(text);
    ASSERT_TRUE(q) << text;
    EXPECT_EQ(q->value, value) << text;
    EXPECT_EQ(q->unit, unit) << text;
    EXPECT_EQ(q->si, si) << text;
  };
  read("3 um", 3, "um", 3e-6);
  read("  +3um  ", 3, "um", 3e-6);
  read("-0.5   kV", -0.5, "kV", -500);
  read("1e-3 GPa", 1e-3, "GPa", 1e6);
  read("2.5E2 nm", 250, "nm", 250e-9);
  read("7", 7, "", 7);
  read("12 %", 12, "%", 0.12);
  read("90 deg", 90, "deg", 90 * (kPi / 180));
  read("2 h", 2, "h", 7200);
  read("0.1 mN/m", 0.1, "mN/m", 1e-4);
  read("123456789 pm", 123456789, "pm", 123456789e-12);
  for (const char* none : {"", " ", "um", "+ 3 um", "++3 um", "3 parsec", "nan um", "inf",
                           "1e400 um", "3,5 um", "3 um um/", "1e308 km"})
    EXPECT_FALSE(parse_quantity(none)) << none;
}

TEST(Quantities, AreRefusedWithTheWayOut) {
  EXPECT_EQ(refusal("3 um", "um"), "");
  EXPECT_EQ(refusal("3 V", "um"),
            "\"3 V\" is a voltage, expected a length; write it like \"1 um\"");
  EXPECT_EQ(refusal("3", "mN/m"),
            "\"3\" is a plain number or a percentage, expected a surface tension; "
            "write it like \"1 mN/m\"");
  EXPECT_EQ(refusal("3 furlong", "um"),
            "\"3 furlong\" is not a number with a known unit; write it like \"1 um\"");
  EXPECT_EQ(refusal("1 m4", "Pa"),
            "\"1 m4\" is another kind of quantity, expected a pressure; write it like \"1 Pa\"");
}

TEST(Quantities, WithoutAUnitAreAskedForItAsTheyMayBeMeant) {
  const auto asked = [](double value, const char* unit) {
    const BareNumber bare = bare_number(value, unit);
    return (bare.ambiguous ? "ambiguous: " : "") + bare.advice;
  };
  EXPECT_EQ(asked(0.07, "%"),
            "ambiguous: needs a unit: \"7 %\" if 0.07 is a share of 1, \"0.07 %\" if it is in "
            "percent");
  EXPECT_EQ(asked(1.5, "%"), "needs a unit, e.g. \"1.5 %\"");
  EXPECT_EQ(asked(0, "%"), "needs a unit, e.g. \"0 %\"");
  EXPECT_EQ(asked(5700, "kHz"),
            "ambiguous: needs a unit: \"5.7 kHz\" if 5700 is in Hz, \"5700 kHz\" if it is in kHz");
  EXPECT_EQ(asked(3.3e-6, "um"),
            "ambiguous: needs a unit: \"3.3 um\" if 3.3e-6 is in m, \"3.3e-6 um\" if it is in um");
  EXPECT_EQ(asked(5, "kHz"), "needs a unit, e.g. \"5 kHz\"");
  EXPECT_EQ(asked(-3e-6, "um"), "needs a unit, e.g. \"-3e-6 um\"");
  EXPECT_EQ(asked(0.5, "deg"), "needs a unit, e.g. \"0.5 deg\"");
}

// Plain from 0.00001 to a million in whole digits, and no more zeros than six behind the digits.
TEST(Quantities, NumbersTurnToAnExponentWhereZerosWouldBeCounted) {
  for (const auto& [value, text] : {std::pair{0.0, "0"},
                                    {-0.0, "-0"},
                                    {1.0, "1"},
                                    {-1.0, "-1"},
                                    {10.0, "10"},
                                    {12.5, "12.5"},
                                    {0.5, "0.5"},
                                    {0.05, "0.05"},
                                    {-0.0123, "-0.0123"},
                                    {1.25e-5, "0.0000125"},
                                    {9e-6, "9e-6"},
                                    {-1.25e-6, "-1.25e-6"},
                                    {3e6, "3000000"},
                                    {3e7, "3e7"},
                                    {1.2e7, "12000000"},
                                    {1.2e8, "1.2e8"},
                                    {1.25e8, "125000000"},
                                    {123456789012345.0, "123456789012345"},
                                    {1234567890123456.0, "1.234567890123456e15"},
                                    {1e100, "1e100"},
                                    {kInfinity, "inf"}})
    EXPECT_EQ(format_number(value), text) << value;
}

TEST(Quantities, AreWrittenInTheirUnit) {
  EXPECT_EQ(format_quantity(2.5e-7, "um"), "0.25 um");
  EXPECT_EQ(format_quantity(-3e-9, "nm"), "-3 nm");
  EXPECT_EQ(format_quantity(1.5e6, "MPa"), "1.5 MPa");
  EXPECT_EQ(format_quantity(0.0721, "mN/m"), "72.1 mN/m");
  EXPECT_EQ(format_quantity(0, "um"), "0 um");
  EXPECT_EQ(format_quantity(0.155, "%"), "15.5 %");
  EXPECT_EQ(format_quantity(5400, "min"), "90 min");
  EXPECT_EQ(format_quantity(5400, "h"), "1.5 h");
  EXPECT_EQ(format_quantity(-kPi / 6, "deg"), "-30 deg");
  EXPECT_EQ(format_quantity(90 * (kPi / 180), "deg"), "90 deg");
  EXPECT_EQ(format_quantity(NAN, "um"), "nan um");
  // A unit with a sum of exponents that is no power of ten: "V/min" is 1/60.
  EXPECT_EQ(format_quantity(0.5, "V/min"), "30 V/min");
}

// Every angle comes back to its double, by as few digits as do it, or is written in radians.
TEST(Quantities, AnglesReadBackByTheFewestDigits) {
  int long_ones = 0, radians = 0;
  for (int k = 1; k < 4000; ++k) {
    const double si = std::sqrt(static_cast<double>(k)) / 40;
    const std::string text = format_quantity(si, "deg");
    EXPECT_EQ(parse_quantity(text)->si, si) << text;
    if (text.ends_with(" rad")) {
      ++radians;
      continue;
    }
    ASSERT_TRUE(text.ends_with(" deg")) << text;
    const std::size_t digits = text.find(' ') - (text.find('.') != std::string::npos ? 1 : 0);
    long_ones += digits >= 15;
    // A digit less does not read back.
    const double value = parse_quantity(text)->value;
    std::size_t significant_digits = 0;
    bool leading = true;
    for (const char c : text) {
      if (c == ' ') break;
      if (c < '0' || c > '9') continue;
      leading = leading && c == '0';
      significant_digits += !leading;
    }
    if (significant_digits > 6 && significant_digits < 17) {
      char shorter[64];
      std::snprintf(shorter, sizeof shorter, "%.*g", static_cast<int>(significant_digits) - 1,
                    value);
      EXPECT_NE(std::strtod(shorter, nullptr) * find_unit("deg")->to_si, si) << text;
    }
  }
  EXPECT_GT(long_ones, 3000);
  EXPECT_LT(radians, 400);
}

}  // namespace
}  // namespace papilla::tests::quantities_test
