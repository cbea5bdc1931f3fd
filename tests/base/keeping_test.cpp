// Memory that is kept, random numbers and checksums by their definitions.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>
#include <vector>

#include "base/cache.h"
#include "base/constants.h"
#include "base/digest.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/watch.h"

namespace papilla::tests::keeping_test {
namespace {

// A digest of the digests of 0 to 299 letters, by another implementation (Python's hashlib).
TEST(Sha256, OfEveryLengthIsThatOfAnotherImplementation) {
  std::string digests;
  for (int n = 0; n < 300; ++n) {
    std::string text;
    for (int k = 0; k < n; ++k) text += static_cast<char>((k * 37 + n) % 256);
    digests += sha256(text);
  }
  EXPECT_EQ(sha256(digests), "37293c9149fd1e92ade27cfaa67205d1fe897e27bf266af051f5258e9af5d6e0");
}

// splitmix64 as it is published, with the key's letters and index mixed in one after the other.
std::uint64_t mixed(std::uint64_t x) {
  x ^= x >> 30;
  x *= 0xbf58476d1ce4e5b9u;
  x ^= x >> 27;
  x *= 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

TEST(RandomStream, IsSplitmixFromItsSeedPurposeAndIndex) {
  constexpr std::uint64_t kStep = 0x9e3779b97f4a7c15u;
  for (const auto& [seed, purpose, index] :
       {std::tuple{std::uint64_t{0}, std::string(), std::uint64_t{0}},
        {5, "x\xE9", 9},
        {~0ull, "long name", 1ull << 60}}) {
    std::uint64_t state = mixed(seed + kStep);
    for (const unsigned char c : purpose) state = mixed(state + kStep + c);
    state = mixed(state + kStep * (index + 1));
    RandomStream bits(seed, purpose, index), units(seed, purpose, index),
        whole(seed, purpose, index), range(seed, purpose, index), normal(seed, purpose, index);
    double last = 0;
    for (int k = 0; k < 6; ++k) {
      const std::uint64_t b = mixed(state += kStep);
      const double u = std::ldexp(static_cast<double>(b >> 11), -53);
      EXPECT_EQ(bits.bits(), b);
      EXPECT_EQ(units.uniform(), u);
      EXPECT_EQ(whole.below(10), static_cast<int>(10 * u));
      EXPECT_DOUBLE_EQ(range.uniform(-3, 5), -3 + 8 * u);
      if (k % 2 == 1) {  // Box and Muller: the cosine first
        const double radius = std::sqrt(-2 * std::log1p(-last));
        EXPECT_NEAR(normal.normal(), radius * std::cos(2 * kPi * u), 1e-14);
        EXPECT_NEAR(normal.normal(), radius * std::sin(2 * kPi * u), 1e-14);
      }
      last = u;
    }
  }
  const std::uint64_t key = mixed(mixed(mixed(3 + kStep) + kStep * 8) + kStep * 1);
  EXPECT_EQ(hash_uniform(3, 7, 0), std::ldexp(static_cast<double>(key >> 11), -53));
}

// The weight of the newest does not matter, that of the others together does; what is looked up
// moves to the front.
TEST(Cache, DropsTheOnesUsedLongestAgo) {
  Cache<int, int> cache(3, 10);
  int made = 0;
  const auto get = [&](int key, double weight) {
    return *cache.get(key, weight, [&] {
      ++made;
      return std::make_shared<const int>(key);
    });
  };
  for (const int key : {1, 2, 3}) EXPECT_EQ(get(key, 1), key);
  EXPECT_EQ(get(1, 1), 1);  // 1 3 2
  EXPECT_EQ(get(4, 1), 4);  // 4 1 3
  EXPECT_EQ(made, 4);
  get(1, 1), get(3, 1), get(4, 1);  // all there: 4 3 1
  EXPECT_EQ(made, 4);
  get(2, 8);  // 2 4 3: 10
  EXPECT_EQ(cache.size(), 3u);
  get(5, 1);  // 5 2 4: 10
  EXPECT_EQ(cache.size(), 3u);
  get(6, 2);  // 6 5 2 weigh 11: 2 goes
  EXPECT_EQ(cache.size(), 2u);
  EXPECT_EQ(made, 7);
  get(5, 1), get(6, 2);
  EXPECT_EQ(made, 7);
  get(2, 8);
  EXPECT_EQ(made, 8);
}

#if !defined(__SANITIZE_ADDRESS__)  // which maps more than any limit
// A process that is limited has that much and no more.
TEST(Memory, TheLimitOfTheProcessCounts) {
  const double whole = memory_limit();
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  rlimit less = before;
  less.rlim_cur = std::min<rlim_t>(before.rlim_max, static_cast<rlim_t>(whole / 2));
  ASSERT_EQ(setrlimit(RLIMIT_AS, &less), 0);
  const double limited = memory_limit();
  setrlimit(RLIMIT_AS, &before);
  EXPECT_EQ(limited, static_cast<double>(less.rlim_cur));
  EXPECT_EQ(memory_limit(), whole);
}
#endif

// Pieces are counted as they end, and one that fails is not.
TEST(ParallelFor, CountsWhatEndedAndThrowsTheLowest) {
  std::vector<int> progress;
  Watch watch([&](int done) { progress.push_back(done); }, nullptr);
  int called = 0;
  try {
    parallel_for(
        6,
        [&](int i) {
          ++called;
          if (i == 2 || i == 4) throw i;
        },
        1);
    FAIL();
  } catch (const int i) {
    EXPECT_EQ(i, 2);
  }
  EXPECT_EQ(called, 6);
  EXPECT_EQ(progress, (std::vector<int>{1, 2, 3, 4}));
  parallel_for(
      0, [&](int) { ++called; }, 1);
  EXPECT_EQ(called, 6);
}

}  // namespace
}  // namespace papilla::tests::keeping_test
