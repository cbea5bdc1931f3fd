// The yield from the ends of the tolerances against plates that are evaluated one by one.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/search/direct_plates.h"
#include "tests/support/thorough.h"

namespace papilla::tests::yield_slow_test {
namespace {

// Within three points of 2,000 plates; half of the tolerance that is said to cost most gains most.
// Without the 3-D field, which takes half of a plate's time and moves both sides alike.
TEST(Yield, IsThatOfPlatesEvaluatedOneByOne) {
  const YieldCase holes = yield_cases().front();
  const JudgedYield judged = is_thorough() ? JudgedYield(holes) : JudgedYield(holes, 0);
  const Yield yield = judged.by_the_ends();
  EXPECT_NEAR(judged.direct(cases(600, 2000)), yield.now.share, 0.03);
  ASSERT_TRUE(yield.costliest().has_value());
  const int few = cases(80, 400);
  std::vector<double> halved;
  for (std::size_t k = 0; k < yield.halved.size(); ++k)
    halved.push_back(judged.direct(few, k, 0.5));
  EXPECT_EQ(std::max_element(halved.begin(), halved.end()) - halved.begin(),
            static_cast<std::ptrdiff_t>(*yield.costliest()));
}

}  // namespace
}  // namespace papilla::tests::yield_slow_test
