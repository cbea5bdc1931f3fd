// What a computation may ask for.
#include "base/memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <string>

#include "base/error.h"

namespace papilla::tests::memory_test {
namespace {

TEST(Memory, TheLimitIsAtMostThatOfTheMachine) {
  const double machine =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  EXPECT_LE(memory_limit(), machine);
  EXPECT_GT(memory_limit(), 1 << 26);  // this test needs some
}

TEST(Memory, WhatNeedsMoreThanTheLimitIsRefusedInGibibytes) {
  EXPECT_NO_THROW(require_memory(memory_limit(), "a field"));
  constexpr double kPebibyte = 1125899906842624;
  try {
    require_memory(kPebibyte, "a field");
    FAIL();
  } catch (const InputError& e) {
    const std::string text = e.what(), needs = "a field needs 1e+06 GiB of memory; ";
    ASSERT_TRUE(text.starts_with(needs)) << text;
    const double there = memory_limit() / (1 << 30);
    EXPECT_NEAR(std::stod(text.substr(needs.size())), there, 0.06 * there) << text;
  }
  EXPECT_THROW(require_memory(std::nan(""), "nothing known"), InputError);
}

TEST(Errors, NameTheirPlaceTheirKeyAndWhatIsWrong) {
  EXPECT_EQ((Problem{"a.toml", 3, 7, "finger.load", "no unit"}.text()),
            "a.toml:3:7: finger.load: no unit");
  EXPECT_EQ((Problem{"a.toml", 0, 0, "", "no file"}.text()), "a.toml: no file");
  EXPECT_EQ((Problem{"a.toml", 1, 2, "", "bad"}.text()), "a.toml:1:2: bad");
  EXPECT_EQ((Problem{"", 3, 7, "k", "bad"}.text()), "k: bad");
  const InputError two({Problem{"", 0, 0, "a", "one"}, Problem{"", 0, 0, "b", "two"}});
  EXPECT_STREQ(two.what(), "a: one\nb: two");
  EXPECT_EQ(two.problems().size(), 2u);
  EXPECT_STREQ(InputError("alone").what(), "alone");
}

}  // namespace
}  // namespace papilla::tests::memory_test
