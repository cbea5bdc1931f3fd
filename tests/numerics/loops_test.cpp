// Loops and reductions of every length, with vectors and pixel by pixel.
#include "numerics/loops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "numerics/reductions.h"
#include "numerics/window.h"
#include "tests/numerics/both_ways.h"

namespace papilla::tests::loops_test {
namespace {

std::vector<double> numbers(std::size_t n) {
  std::vector<double> out(n);
  for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<double>(i + 1);
  return out;
}

TEST(Loops, VisitEveryPixelOnceForAnyLength) {
  for (std::size_t n = 0; n < 40; ++n) {
    const auto [together, apart] = both_ways([&] {
      std::vector<double> v = numbers(n);
      for_each_pixel(n / 3, n, [&](auto at) { at.store(v, at(v) * at(v)); });
      return v;
    });
    for (std::size_t i = 0; i < n; ++i) {
      const auto x = static_cast<double>(i + 1);
      EXPECT_EQ(together[i], i < n / 3 ? x : x * x) << n;
    }
    EXPECT_EQ(together, apart);
    EXPECT_EQ(padded(n), (n + 7) / 8 * 8);
  }
}

TEST(Loops, SumsCountEveryNumberOnceForAnyLength) {
  for (std::size_t n = 0; n < 40; ++n) {
    const std::vector<double> v = numbers(n);
    const auto m = static_cast<double>(n);
    EXPECT_EQ(sum(v), m * (m + 1) / 2);
    EXPECT_EQ(dot(v, v), m * (m + 1) * (2 * m + 1) / 6);
    EXPECT_EQ(count_above(v, 3), n < 3 ? 0 : n - 3);
  }
}

// Number k goes to the partial sum k modulo eight, whatever the registers and whichever way: the
// sum is the same to the last bit.
TEST(Loops, SumsAreThoseOfEightPartialSums) {
  RandomStream random(4, "sums");
  for (const std::size_t n : {5u, 64u, 1003u}) {
    std::vector<double> v(n);
    double part[8] = {}, expected = 0;
    for (std::size_t i = 0; i < n; ++i) part[i % 8] += v[i] = random.normal();
    for (const double p : part) expected += p;
    const auto [together, apart] = both_ways([&] { return sum(v); });
    EXPECT_EQ(together, expected);
    EXPECT_EQ(apart, expected);
  }
}

TEST(Loops, TheLeastAndTheLargestMayStandAnywhere) {
  for (std::size_t k = 0; k < 21; ++k) {
    std::vector<double> v(21, 1);
    v[k] = -5;
    EXPECT_EQ(least(v), -5);
    EXPECT_EQ(largest(v), 1);
    v[k] = 7;
    EXPECT_EQ(least(v), 1);
    EXPECT_EQ(largest(v), 7);
  }
  EXPECT_EQ(least({}), kInfinity);
  EXPECT_EQ(largest({}), -kInfinity);
}

TEST(Loops, ReduceSeveralValuesAtOnce) {
  const std::vector<double> v = numbers(19);
  const auto [together, apart] = both_ways([&] {
    return reduce(19, [&](auto at) {
      const auto x = at(v);
      return std::tuple(x, Least(-x), Largest(10 - x), std::array{x * x, 1 + 0 * x});
    });
  });
  EXPECT_EQ(together, apart);
  const auto [all, low, high, moments] = together;
  EXPECT_EQ(all, 190);
  EXPECT_EQ(low, -19);
  EXPECT_EQ(high, 9);
  EXPECT_EQ(moments, (std::array<double, 2>{2470, 19}));
}

TEST(Loops, FollowListsAndFillWhatIsMissing) {
  const std::vector<int> list{3, 0, 17, 5, 4, 16, 8, 9, 11, 1};
  const auto [together, apart] = both_ways([&] {
    std::vector<double> v = numbers(18);
    const std::vector<double> none;
    for_each_pixel(list.size(), [&](auto at) {
      at.store_listed(v, list, 100 * at.listed(v, list) + at(none, 7));
    });
    return v;
  });
  EXPECT_EQ(together, apart);
  for (std::size_t i = 0; i < 18; ++i) {
    const bool listed = std::find(list.begin(), list.end(), static_cast<int>(i)) != list.end();
    const auto x = static_cast<double>(i + 1);
    EXPECT_EQ(together[i], listed ? 100 * x + 7 : x);
  }
}

TEST(Loops, VisitWhereAConditionHoldsInOrder) {
  std::vector<double> v(50, 0.0);
  const std::vector<std::size_t> where{0, 7, 8, 9, 31, 32, 47, 48, 49};
  for (const std::size_t i : where) v[i] = 1;
  const auto [together, apart] = both_ways([&] {
    std::vector<std::size_t> found;
    for_each_where(
        v.size(), [&](auto at) { return at(v) > 0.5; }, [&](std::size_t i) { found.push_back(i); });
    return found;
  });
  EXPECT_EQ(together, where);
  EXPECT_EQ(apart, where);
}

TEST(Loops, AskForSingleNumbersOnlyWhereTheyMay) {
  const std::vector<double> v = numbers(21);
  const auto [together, apart] = both_ways([&] {
    int asked = 0;
    std::vector<char> even(v.size());
    for_each_pixel(v.size(), [&](auto at) {
      at.store(even, holds_for(
                         at(v) > 10.0,
                         [&](double a, double b) {
                           ++asked;
                           EXPECT_EQ(b, -a);
                           return std::fmod(a, 2) == 0;
                         },
                         at(v), -at(v)));
    });
    return std::pair(asked, even);
  });
  EXPECT_EQ(together, apart);
  EXPECT_EQ(together.first, 11);
  for (std::size_t i = 0; i < v.size(); ++i) EXPECT_EQ(together.second[i], i > 10 && i % 2 == 1);
}

TEST(Reductions, TheVarianceIsAboutTheMean) {
  const std::vector<double> v{1e6 + 1, 1e6 + 2, 1e6 + 3, 1e6 + 6};
  EXPECT_NEAR(variance(v), 3.5, 1e-9);
  EXPECT_TRUE(std::isnan(variance(std::vector<double>{1, 2, std::nan("")})));
}

TEST(Window, SumsItsWeightsTimesTwoImages) {
  Window<2> window;
  std::vector<float> a(40 * 9), b(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = static_cast<float>(i % 11);
    b[i] = static_cast<float>(i % 5);
  }
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) window.weight(dx, dy) = static_cast<float>(dx + 3 * dy);
  }
  const std::size_t from = 2 * 40 + 7;
  float expected_a = 0, expected_b = 0;
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      const std::size_t i = from + static_cast<std::size_t>((dy + 2) * 40 + dx + 2);
      expected_a += static_cast<float>(dx + 3 * dy) * a[i];
      expected_b += static_cast<float>(dx + 3 * dy) * b[i];
    }
  }
  const auto [together, apart] =
      both_ways([&] { return window.sums(a.data(), b.data(), from, 40); });
  EXPECT_EQ(together.a, expected_a);
  EXPECT_EQ(together.b, expected_b);
  EXPECT_EQ(apart.a, expected_a);
  EXPECT_EQ(apart.b, expected_b);
}

}  // namespace
}  // namespace papilla::tests::loops_test
