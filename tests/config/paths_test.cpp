// Paths into lists, and what is said where they lead nowhere.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "base/error.h"
#include "config/reader.h"

namespace papilla::tests::paths_test {
namespace {

constexpr const char* kText =
    "few = [7, 8]\n[[layer]]\nx = 1\n[[layer]]\nx = 2\ny = [[3, 4], [5]]\n";

TEST(Paths, OfItemsAreTheirPlacesFromZero) {
  Document document = parse_document(kText, "list.toml");
  for (const char* there : {"few", "few.0", "few.1", "layer.0", "layer.1", "layer.0.x", "layer.1.x",
                            "layer.1.y.0.1", "layer.1.y.1.0"})
    EXPECT_TRUE(document.has(there)) << there;
  for (const char* none : {"few.2", "few.x", "few.00001x", "few.000001", "layer.2", "layer.2.x",
                           "layer.0.y", "layer.-1", "layer.1.y.0.2", "few.0.x", "more"})
    EXPECT_FALSE(document.has(none)) << none;
  EXPECT_EQ(document.take("few.1")->integer, 8);
  EXPECT_EQ(document.take("layer.1.x")->integer, 2);
  EXPECT_EQ(document.take("layer.1.y.1.0")->integer, 5);
  EXPECT_EQ(document.origins().at("layer.1.x").line, 5);
  EXPECT_EQ(document.origins().at("layer.1.x").column, 5);
  document.problem_at("layer.1.z.0", "one");
  document.problem_at("layer.3.x", "two");
  ASSERT_EQ(document.problems().size(), 2u);
  EXPECT_EQ(document.problems()[0].text(), "list.toml:4:1: layer.1.z.0: one");
  EXPECT_EQ(document.problems()[1].text(), "list.toml:2:1: layer.3.x: two");
}

// On a command line.
TEST(Paths, OfOverridesReachItemsOrAreRefused) {
  const auto said = [](const std::string& change) -> std::string {
    try {
      parse_document(kText, "list.toml", {change});
    } catch (const InputError& error) {
      const std::string head = "--set " + change + ": ";
      EXPECT_TRUE(std::string(error.what()).starts_with(head)) << error.what();
      return std::string(error.what()).substr(head.size());
    }
    return "";
  };
  const auto value = [](const std::string& change, const char* path) {
    return parse_document(kText, "list.toml", {change}).take(path)->integer;
  };
  EXPECT_EQ(value("layer.1.x=9", "layer.1.x"), 9);
  EXPECT_EQ(value("layer.0.x = 9", "layer.0.x"), 9);
  EXPECT_EQ(value("layer.0.x = 9", "layer.1.x"), 2);
  EXPECT_EQ(value("few.1=9", "few.1"), 9);
  EXPECT_EQ(value("few.1=9", "few.0"), 7);
  EXPECT_EQ(value("layer.0.new.deep=9", "layer.0.new.deep"), 9);
  EXPECT_EQ(said("few.2=9"), "few.2: no item 2 in a list of 2");
  EXPECT_EQ(said("few.one=9"), "few.one: no item one in a list of 2");
  EXPECT_EQ(said("layer.2.x=9"), "layer.2.x: no item 2 in a list of 2");
  EXPECT_EQ(said("few.0.x=9"), "few.0.x: has no members");
  EXPECT_EQ(said("few"), "expected KEY=VALUE, e.g. drive.amplitude=150V");
  EXPECT_EQ(said("=9"), "expected KEY=VALUE, e.g. drive.amplitude=150V");
}

}  // namespace
}  // namespace papilla::tests::paths_test
