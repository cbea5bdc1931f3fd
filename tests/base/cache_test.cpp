#include "base/cache.h"

#include <gtest/gtest.h>

namespace papilla::tests::cache_test {
namespace {

std::shared_ptr<const int> value_of(Cache<int, int>& cache, int key, double weight = 1) {
  return cache.get(key, weight, [&] { return std::make_shared<const int>(10 * key); });
}

TEST(Cache, MakesAValueOnceAndKeepsTheLastUsed) {
  Cache<int, int> cache(2, 1e9);
  const auto one = value_of(cache, 1);
  EXPECT_EQ(*one, 10);
  value_of(cache, 2);
  EXPECT_EQ(value_of(cache, 1), one);  // the same object, now the last used
  value_of(cache, 3);                  // 2 goes
  EXPECT_EQ(cache.size(), 2u);
  EXPECT_EQ(value_of(cache, 1), one);
}

TEST(Cache, KeepsWhatItsWeightAllowsAndTheNewestAlways) {
  Cache<int, int> cache(100, 10);
  for (int key = 0; key < 8; ++key) value_of(cache, key, 4);
  EXPECT_EQ(cache.size(), 2u);
  const auto heavy = value_of(cache, 9, 50);
  EXPECT_EQ(cache.size(), 1u);
  EXPECT_EQ(value_of(cache, 9, 50), heavy);
  cache.clear();
  EXPECT_EQ(cache.size(), 0u);
  EXPECT_EQ(*heavy, 90);  // who holds a value keeps it
}

// What went and what was cleared weighs nothing.
TEST(Cache, WeighsWhatItHolds) {
  Cache<int, int> cache(100, 10);
  value_of(cache, 1, 6);
  value_of(cache, 2, 4);
  EXPECT_EQ(cache.size(), 2u);  // 10 is allowed
  cache.clear();
  value_of(cache, 1, 3);
  value_of(cache, 2, 3);
  value_of(cache, 3, 4);
  EXPECT_EQ(cache.size(), 3u);
  value_of(cache, 4, 2);  // 12: the first goes, 9 stay
  EXPECT_EQ(cache.size(), 3u);
  value_of(cache, 5, 1);
  EXPECT_EQ(cache.size(), 4u);
}

}  // namespace
}  // namespace papilla::tests::cache_test
