// Of which measured map a part alone is the texture.
#include <gtest/gtest.h>

#include "design/paths.h"
#include "design/scans.h"
#include "design/study.h"

namespace papilla::tests::taken_parts_test {
namespace {

bool says_part(double width, double height, double taken) {
  DesignScan scan{"a.gsf", {}, taken};
  scan.changes.width = width, scan.changes.height = height;
  return text(scan).find("; of its") != std::string::npos;
}

// A patch as long as the longer side is the whole of it, to a billionth.
TEST(TakenParts, AreSaidWhereThePatchIsShorterThanTheLongerSide) {
  EXPECT_TRUE(says_part(20e-6, 10e-6, 10e-6));
  EXPECT_TRUE(says_part(10e-6, 20e-6, 10e-6));
  EXPECT_FALSE(says_part(12e-6, 12e-6, 12e-6));
  EXPECT_FALSE(says_part(12e-6, 12e-6, 12e-6 * (1 - 0.5e-9)));
  EXPECT_TRUE(says_part(12e-6, 12e-6, 12e-6 * (1 - 1.5e-9)));
  EXPECT_FALSE(says_part(12e-6, 12e-6, 0));  // of a skin: each window takes its own
  DesignScan scan{"a.gsf", {}, 12e-6};
  scan.changes.width = 25.6e-6, scan.changes.height = 20e-6, scan.changes.as_is = true;
  EXPECT_EQ(
      text(scan),
      "a.gsf: taken as it is, neither levelled nor mended; of its 25.6 x 20 um a square of 12 "
      "um is the texture (texture.patch, at_x, at_y)");
  scan.changes.as_is = false;
  EXPECT_NE(text(scan).find(
                " um is the texture (texture.patch, at_x, at_y), blended along two borders with "
                "what lies beyond, so that it repeats"),
            std::string::npos)
      << text(scan);
}

Node table(std::vector<std::pair<std::string, Node>> members) {
  Node out = table_node();
  for (auto& [key, value] : members) out.set(key, std::move(value));
  return out;
}

std::string paths(const Node& section, const std::vector<std::string>& whole) {
  std::string out;
  for (const auto& [path, node] : members_by_path(section, whole)) out += path + " ";
  return out;
}

// Keys that hold points and tables of tables are one path; a variable with choices or a range is a
// member itself where it is asked for.
TEST(Members, AreFoundByTheirPathsAndErasedByThem) {
  const Node choices = table({{"choice", array_node({})}}),
             range = table({{"range", array_node({})}});
  Node section = table({{"a", integer_node(1)},
                        {"b", table({{"c", integer_node(2)}, {"d", choices}})},
                        {"b.c", integer_node(3)},
                        {"be", table({{"c", range}})}});
  EXPECT_EQ(paths(section, {}), "a b.c b.d.choice b.c be.c.range ");
  EXPECT_EQ(paths(section, {"choice", "range"}), "a b.c b.d b.c be.c ");
  erase_member(section, "be.c");
  EXPECT_EQ(paths(section, {"choice", "range"}), "a b.c b.d b.c ");
  erase_member(section, "b.c");  // in both its writings
  EXPECT_EQ(paths(section, {"choice", "range"}), "a b.d ");
  erase_member(section, "b.x");
  EXPECT_EQ(paths(section, {"choice", "range"}), "a b.d ");
  erase_member(section, "b");
  EXPECT_EQ(paths(section, {"choice", "range"}), "a ");
}

}  // namespace
}  // namespace papilla::tests::taken_parts_test
