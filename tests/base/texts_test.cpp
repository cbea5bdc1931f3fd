// Texts as wholes: names that are nearly right, values with their errors at every border, tables.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "base/text.h"

namespace papilla::tests::texts_test {
namespace {

using Names = std::vector<std::string>;

TEST(Texts, ANameMayBeWrongInTwoLettersOrAThird) {
  const auto nearest = [](const char* name, const char* known) {
    return nearest_name(name, {known});
  };
  // Left out, put in, another: one, two and three of each.
  EXPECT_EQ(nearest("radius", "radius"), "radius");
  EXPECT_EQ(nearest("rdus", "radius"), "radius");
  EXPECT_EQ(nearest("rds", "radius"), "");
  EXPECT_EQ(nearest("raxdxius", "radius"), "radius");
  EXPECT_EQ(nearest("raxdxixus", "radius"), "radius");  // of nine letters three may be wrong
  EXPECT_EQ(nearest("raxdxixuxs", "radius"), "");
  EXPECT_EQ(nearest("rxdxus", "radius"), "radius");
  EXPECT_EQ(nearest("rxdxxs", "radius"), "");
  EXPECT_EQ(nearest("aradiu", "radius"), "radius");  // moved by one: two edits
  EXPECT_EQ(nearest("", "ab"), "ab");
  EXPECT_EQ(nearest("", "abc"), "");
  EXPECT_EQ(nearest("ab", ""), "");  // two edits, to a name of no letters
  EXPECT_EQ(nearest_name("abc", {}), "");
  EXPECT_EQ(nearest_name("gas", Names{"gab", "gap", "gals"}), "gab");  // the first of the nearest
  EXPECT_EQ(nearest_name("gaps", Names{"gab", "gap", "gals"}), "gap");
}

TEST(Texts, Utf8IsWhatTheStandardSays) {
  for (const char* text : {"", "a", "\u00e9", "\u20ac", "\U0001f600", "a\u00e9\u20ac\U0010ffff"})
    EXPECT_TRUE(is_utf8(text)) << text;
  for (const char* text :
       {"\xe9", "a\xc3", "\x80", "\xc0\xaf", "\xc1\xbf", "\xe0\x9f\xbf", "\xed\xa0\x80",
        "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xff", "ok\xe2\x82"})
    EXPECT_FALSE(is_utf8(text)) << text;
}

TEST(Texts, ControlCharactersAreShownNotSent) {
  EXPECT_EQ(visible("two\nlines\tand \u00e9 \u20ac \U0001f600"),
            "two\nlines\tand \u00e9 \u20ac \U0001f600");
  EXPECT_EQ(visible("\x1b[31mred\x1b[0m"), "\\x1b[31mred\\x1b[0m");
  EXPECT_EQ(visible("a\rb\x7f\x07"), "a\\x0db\\x7f\\x07");
  EXPECT_EQ(visible("\xc2\x9b"
                    "31m\xc2\xa0."),
            "\\xc2\\x9b31m\xc2\xa0.");  // C1 in UTF-8
  EXPECT_EQ(visible("r\xe9sum\xe9"), "r\\xe9sum\\xe9");
  EXPECT_EQ(visible(std::string("\0", 1)), "\\x00");
}

TEST(Texts, PartsAreCutAtEverySeparator) {
  EXPECT_EQ(split("  a  b ;c;; d", ';'), (Names{"a  b", "c", "", "d"}));
  EXPECT_EQ(split(";", ';'), (Names{"", ""}));
  EXPECT_EQ(split("   ", ';'), Names{""});
  EXPECT_EQ(split("one", ';'), Names{"one"});
  EXPECT_EQ(join_names({}), "");
  EXPECT_EQ(join_names({"", "b"}), "b");
  EXPECT_EQ(join_names({"a", "", "b"}, "-"), "a--b");
  EXPECT_EQ(counted(-1, "step"), "-1 steps");
  EXPECT_EQ(counted(1, "step") + counted(2, "step") + counted(12345678901, "step"),
            "1 step2 steps12345678901 steps");
}

TEST(Texts, AValueIsWrittenToTheSecondDigitOfItsError) {
  for (const auto& [value, error, text] :
       {std::tuple{1234.5, 9.94, "1234.5 ± 9.9"},
        {1234.5, 9.96, "1234 ± 10"},  // to even, as the digits are
        {1235.5, 10.0, "1236 ± 10"},
        {1234.5, 99.4, "1234 ± 99"},
        {1234.5, 99.6, "1230 ± 100"},
        {1234.5, 101.0, "1230 ± 100"},
        {1250.0, 990.0, "1250 ± 990"},
        {1251.0, 1100.0, "1300 ± 1100"},
        {-1251.0, 1100.0, "-1300 ± 1100"},
        {40.0, 1000.0, "0 ± 1000"},
        {-40.0, 1000.0, "0 ± 1000"},
        {0.5, 0.1, "0.50 ± 0.10"},
        {0.5, 0.011, "0.500 ± 0.011"},
        {-0.012346, 0.00012, "-0.01235 ± 0.00012"},
        {1.0, 1.0e-5, "1.000000 ± 0.000010"},
        {1.0, 9.94e-6, "1 ± 9.9e-06"},
        {1.0, 9.96e-6, "1.000000 ± 0.000010"},
        {123456.0, 1.2e-6, "1.235e+05 ± 1.2e-06"},
        {12.346, 0.0, "12.35 ± 0"},
        {12.346, -1.0, "12.35 ± -1"},
        {NAN, 1.0, "nan ± 1"},
        {12345.0, NAN, "12340 ± nan"},
        {-INFINITY, 1.0, "-inf ± 1"}})
    EXPECT_EQ(with_error(value, error), text) << value << " " << error;
}

TEST(Texts, DigitsAreThoseAskedFor) {
  EXPECT_EQ(significant(1234567, 2), "1200000");
  EXPECT_EQ(significant(-1234567, 7), "-1234567");
  EXPECT_EQ(significant(0.00012345, 3), "0.000123");
  EXPECT_EQ(significant(9.999, 3), "10");
  EXPECT_EQ(fixed(2.5, 0), "2");  // to even
  EXPECT_EQ(fixed(-2.345, 1), "-2.3");
  EXPECT_EQ(fixed(-0.04, 1), "0.0");
  EXPECT_EQ(fixed(-0.06, 1), "-0.1");
  EXPECT_EQ(fixed(-0.0, 0), "0");
}

TEST(Texts, WidthIsCountedInLetters) {
  EXPECT_EQ(text_width(""), 0u);
  EXPECT_EQ(text_width("abc"), 3u);
  EXPECT_EQ(text_width("µ"), 1u);    // two bytes
  EXPECT_EQ(text_width("≥1€"), 3u);  // three each
  EXPECT_EQ(text_width("\xF0\x9F\x94\xAC"), 1u);
}

TEST(Texts, TablesHaveTheirColumnsBesideEachOther) {
  EXPECT_EQ(aligned_table({}, 1), "");
  EXPECT_EQ(aligned_table({{"a"}}, 0), "a\n");
  EXPECT_EQ(
      aligned_table({{"name", "≥ µm", "n"}, {"x", "1.25"}, {}, {"longer name", "3", "12345"}}, 1),
      "name         ≥ µm      n\n"
      "x            1.25\n"
      "\n"
      "longer name     3  12345\n");
  EXPECT_EQ(aligned_table({{"name", "≥ µm", "n"}, {"x", "1.25"}, {"longer name", "3", "12345"}}, 2),
            "name         ≥ µm      n\n"
            "x            1.25\n"
            "longer name  3     12345\n");
  EXPECT_EQ(aligned_table({{"a", "bb"}, {"ccc", "d"}}, 0), "  a  bb\nccc   d\n");
}

TEST(Texts, MarkdownKeepsItsLinesAndAlignsEachTableAlone) {
  EXPECT_EQ(aligned_markdown(""), "");
  EXPECT_EQ(aligned_markdown("\n\n"), "\n\n");
  EXPECT_EQ(aligned_markdown("|"), "|");  // no row yet
  EXPECT_EQ(aligned_markdown("||"), "|     |\n");
  EXPECT_EQ(aligned_markdown("a | b\n| c\nd |\n"), "a | b\n| c\nd |\n");
  EXPECT_EQ(aligned_markdown("| a | b |\n|---|---|\n| ≥ | 12345 |\ntext\n| x |\n|---|\n| 1234 |"),
            "| a   | b     |\n"
            "| --- | ----- |\n"
            "| ≥   | 12345 |\n"
            "text\n"
            "| x    |\n"
            "| ---- |\n"
            "| 1234 |\n");
  // A row of more cells than the first.
  EXPECT_EQ(aligned_markdown("| a |\n| b | c |\n\nend"), "| a   |\n| b   | c   |\n\nend");
}

}  // namespace
}  // namespace papilla::tests::texts_test
