// What messages and tables are put together with.
#include "base/text.h"

#include <gtest/gtest.h>

#include <cmath>

namespace papilla::tests::text_test {
namespace {

TEST(Text, TheNearestNameIsTheOneFewestEditsAway) {
  const std::vector<std::string> known{"modulation", "friction", "friction_on", "gap"};
  EXPECT_EQ(nearest_name("modulatoin", known), "modulation");
  EXPECT_EQ(nearest_name("fricton_on", known), "friction_on");
  EXPECT_EQ(nearest_name("friction", known), "friction");
  EXPECT_EQ(nearest_name("cap", known), "gap");   // one letter another
  EXPECT_EQ(nearest_name("gaps", known), "gap");  // one too many
  EXPECT_EQ(nearest_name("ap", known), "gap");    // one too few
  EXPECT_EQ(nearest_name("xyz", known), "");      // three edits: none of them
  EXPECT_EQ(nearest_name("xyp", known), "gap");   // two
  // A third of a long name may be wrong, and no more.
  EXPECT_EQ(nearest_name("abcdefghi", {"abcdefxyz"}), "abcdefxyz");
  EXPECT_EQ(nearest_name("abcdefghi", {"abcdewxyz"}), "");
}

TEST(Text, PartsLoseTheirBlanksAndStayWhereTheyAre) {
  using Parts = std::vector<std::string>;
  EXPECT_EQ(split("a, b c ,,d", ','), (Parts{"a", "b c", "", "d"}));
  EXPECT_EQ(split("", ','), Parts{""});
  EXPECT_EQ(split("a,", ','), (Parts{"a", ""}));
  EXPECT_EQ(join_names({"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(join_names({"a"}, "; "), "a");
  EXPECT_EQ(counted(1, "skin"), "1 skin");
  EXPECT_EQ(counted(0, "skin") + ", " + counted(2, "skin"), "0 skins, 2 skins");
}

TEST(Text, DigitsComeWithoutAnExponent) {
  EXPECT_EQ(significant(1671.8, 3), "1670");
  EXPECT_EQ(significant(1000, 3), "1000");
  EXPECT_EQ(significant(0.0123456, 3), "0.0123");
  EXPECT_EQ(significant(-0.0, 3), "0");
}

TEST(Text, AValueEndsWhereItsErrorDoes) {
  EXPECT_EQ(with_error(638.7, 132), "640 ± 130");
  EXPECT_EQ(with_error(29.42, 12.9), "29 ± 13");
  EXPECT_EQ(with_error(0.6123, 0.0996), "0.61 ± 0.10");
  EXPECT_EQ(with_error(-0.0004, 0.021), "0.000 ± 0.021");
  EXPECT_EQ(with_error(12.345, 0), "12.35 ± 0");
  EXPECT_EQ(with_error(1670, 1), "1670.0 ± 1.0");
  EXPECT_EQ(with_error(86420, 9960), "86000 ± 10000");  // 9960 is 10000 in two digits
  // Six decimals at most.
  EXPECT_EQ(with_error(0.5, 1.2e-5), "0.500000 ± 0.000012");
  EXPECT_EQ(with_error(0.5, 1.2e-6), "0.5 ± 1.2e-06");
  EXPECT_EQ(with_error(2, INFINITY), "2 ± inf");
  EXPECT_EQ(with_error(INFINITY, 2), "inf ± 2");
}

TEST(Text, ColumnsAreAsWideAsTheirWidestCell) {
  EXPECT_EQ(text_width("±µm"), 3u);  // five bytes
  EXPECT_EQ(aligned_table({{"name", "x", "y µm"}, {"a", "12.5", "1"}, {"ab", "3"}}, 1),
            "name     x  y µm\n"
            "a     12.5     1\n"
            "ab       3\n");
  EXPECT_EQ(aligned_table({{"a", "b"}, {"ccc", ""}}, 2), "a    b\nccc\n");
}

TEST(Text, MarkdownTablesAreAlignedAndTheRestIsKept) {
  EXPECT_EQ(aligned_markdown("# head\n\n| a | long µ |\n|---|---|\n| 12345 | x |\nafter\n"),
            "# head\n\n"
            "| a     | long µ |\n"
            "| ----- | ------ |\n"
            "| 12345 | x      |\n"
            "after\n");
  EXPECT_EQ(aligned_markdown("| a |\n|---|"), "| a   |\n| --- |\n");
  EXPECT_EQ(aligned_markdown("no table"), "no table");
}

}  // namespace
}  // namespace papilla::tests::text_test
