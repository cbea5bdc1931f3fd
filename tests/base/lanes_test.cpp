// Sums of eight numbers side by side, at every length.
#include "base/lanes.h"

#include <gtest/gtest.h>

#include <vector>

namespace papilla::tests {
namespace {

std::vector<double> numbers(std::size_t n) {
  std::vector<double> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<double>(i + 1);
  return out;
}

TEST(Lanes, BeyondTheEndTheyHoldWhatIsAskedFor) {
  const std::vector<double> v = numbers(11);
  const Lanes lanes = lanes_at(v, 8, -1);
  for (std::size_t k = 0; k < kLanes; ++k) {
    EXPECT_EQ(lanes[k], k < 3 ? 9 + static_cast<double>(k) : -1);
  }
  EXPECT_EQ(total(lanes_at({}, 0, 2)), 16);
}

TEST(Lanes, AreStoredAsFarAsTheListGoes) {
  std::vector<double> v(11, 0);
  store_lanes(all_lanes(3), v, 8);
  EXPECT_EQ(v, (std::vector<double>{0, 0, 0, 0, 0, 0, 0, 0, 3, 3, 3}));
}

TEST(Lanes, SumsCountEveryNumberOnceForAnyLength) {
  for (std::size_t n = 0; n < 20; ++n) {
    const std::vector<double> v = numbers(n);
    const auto m = static_cast<double>(n);
    EXPECT_EQ(sum(v), m * (m + 1) / 2);
    EXPECT_EQ(dot(v, v), m * (m + 1) * (2 * m + 1) / 6);
  }
}

TEST(Lanes, TheLeastAndTheLargestMayStandAnywhere) {
  for (std::size_t k = 0; k < kLanes; ++k) {
    Lanes v = all_lanes(1);
    v[k] = -5;
    EXPECT_EQ(least(v), -5);
    EXPECT_EQ(largest(v), 1);
    v[k] = 7;
    EXPECT_EQ(least(v), 1);
    EXPECT_EQ(largest(v), 7);
  }
}

}  // namespace
}  // namespace papilla::tests
