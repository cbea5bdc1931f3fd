// What the studio tells of a program that failed.
#include "studio/child.h"

#include <gtest/gtest.h>

#include <string>

namespace papilla::tests::child_test {
namespace {

TEST(ChildsFailure, IsToldByItsErrorsWithoutWhatCameBefore) {
  const std::string first = "error: a.toml:3:1: drive.amplitude: needs a unit\n",
                    second = "a.toml:9:1: texture.depth: is too large\n";
  EXPECT_EQ(why_failed("expected: 3 min\nno error: yet\n" + first + second), first + second);
  EXPECT_EQ(why_failed(first), first);
  EXPECT_FALSE(says_an_error("expected error: 3 %\n"));
  EXPECT_TRUE(says_an_error("expected: 3 min\n" + first));
}

// Of many mistakes the first ones; of a long log that names none the last lines. None is cut.
TEST(ChildsFailure, IsToldInWholeLines) {
  std::string many = "error: mistake 0\n", log;
  for (int i = 1; i < 200; ++i) many += "mistake " + std::to_string(i) + "\n";
  const std::string told = why_failed("a preamble\n" + many);
  EXPECT_TRUE(told.starts_with("error: mistake 0\nmistake 1\n")) << told;
  EXPECT_TRUE(told.ends_with("\n…\n")) << told;
  const std::string kept = told.substr(0, told.size() - std::string("…\n").size());
  EXPECT_TRUE(many.starts_with(kept)) << told;
  EXPECT_LT(kept.size(), 620U);
  for (int i = 0; i < 200; ++i) log += "line " + std::to_string(i) + "\n";
  const std::string end = why_failed(log);
  EXPECT_TRUE(end.starts_with("line ")) << end;
  EXPECT_TRUE(log.ends_with("\n" + end)) << end;
  EXPECT_GT(end.size(), 580U);
}

}  // namespace
}  // namespace papilla::tests::child_test
