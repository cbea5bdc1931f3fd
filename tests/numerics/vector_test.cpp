// Numbers side by side give what each gives alone.
#include "numerics/vector.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

namespace papilla::tests::vector_test {
namespace {

using Numbers = Vector<double>;
using Indices = IndexOf<Numbers>;
constexpr int kSize = Numbers::kSize;

constexpr std::array<double, kSize> kA{-2.5, -1, -0.25, 0, 0.5, 1, 3.75, 1e9},
    kB{-3, -1, 0.25, 0, 0.25, 2, -3.75, 1};

// A function of T, of several numbers at once and of each alone.
template <class Function>
void expect_each(const Function& function) {
  const Numbers a = Numbers::load(kA.data()), b = Numbers::load(kB.data());
  const Numbers of_all = function(a, b);
  for (int k = 0; k < kSize; ++k) {
    const auto i = static_cast<std::size_t>(k);
    EXPECT_EQ(of_all[k], function(kA[i], kB[i])) << k;
  }
}

TEST(Vector, ComputesAsItsNumbersDo) {
  expect_each([](auto a, auto b) { return (a + b) * (a - b); });
  expect_each([](auto a, auto b) { return 1 / (2 + b * b) - -a; });
  expect_each([](auto a, auto b) { return smaller(a, b) + 3 * larger(a, b); });
  expect_each([](auto a, auto b) { return root(a * a + b * b); });
  expect_each([](auto a, auto b) {
    auto sum = a;
    sum += b;
    sum *= 2.0;
    sum -= a;
    return sum / 8;
  });
}

TEST(Vector, ChoosesWhereAComparisonHolds) {
  expect_each([](auto a, auto b) { return chosen(a < b, a, b); });
  expect_each([](auto a, auto b) { return chosen(a > 0.0 && b <= 1.0, 1.0, a); });
  expect_each([](auto a, auto b) { return chosen(a == b || !(a >= 0.5), b, 0.0); });
  expect_each([](auto a, auto b) { return chosen(chosen(a != b, a < 0.0, b < 0.0), 1.0, 2.0); });
}

TEST(Vector, FindsTheIntegersBelowAndTowardsZero) {
  expect_each([](auto a, auto b) { return as_number(floored(a)) + b; });
  expect_each([](auto a, auto b) { return as_number(truncated(a)) + b; });
  EXPECT_EQ(floored(-2.5), -3);
  EXPECT_EQ(truncated(-2.5), -2);
}

TEST(Vector, LooksUpWhatItsIndicesSay) {
  std::vector<double> values;
  for (int k = 0; k < 40; ++k) values.push_back(k * k);
  const std::array<int, kSize> where{38, 0, 7, 7, 21, 1, 12, 30};
  const Indices at = Indices::load(where.data());
  const Numbers here = values_at(values.data(), at);
  const auto [first, second] = pairs_at(values.data(), at);
  for (int k = 0; k < kSize; ++k) {
    const int i = where[static_cast<std::size_t>(k)];
    EXPECT_EQ(here[k], i * i);
    EXPECT_EQ(first[k], i * i);
    EXPECT_EQ(second[k], (i + 1) * (i + 1));
    EXPECT_EQ(pairs_at(values.data(), i), (std::pair{1.0 * i * i, 1.0 * (i + 1) * (i + 1)}));
  }
}

TEST(Vector, ReadsAndStoresNumbersOfOtherTypes) {
  const std::array<std::uint8_t, kSize> bytes{0, 1, 200, 3, 0, 255, 6, 7};
  const std::array<float, kSize> floats{0.5F, 1, 2, 3, 4, 5, 6, 7.25F};
  std::array<float, kSize> out{};
  (Numbers::load(bytes.data()) + Numbers::load(floats.data())).store(out.data());
  for (std::size_t k = 0; k < bytes.size(); ++k)
    EXPECT_EQ(out[k], static_cast<float>(bytes[k]) + floats[k]);
  std::array<char, kSize> flags{};
  (Numbers::load(bytes.data()) > 2.0).store(flags.data());
  EXPECT_EQ(flags, (std::array<char, kSize>{0, 0, 1, 1, 0, 1, 1, 1}));
}

TEST(Vector, KnowsItsLargestAndABitForEachAnswer) {
  for (int k = 0; k < 16; ++k) {
    std::array<float, 16> values;
    values.fill(-3);
    values[static_cast<std::size_t>(k)] = -1;
    const auto v = Vector<float>::load(values.data());
    EXPECT_EQ(largest_of(v), -1);
    EXPECT_EQ((v > -2.0F).bits(), 1u << k);
    EXPECT_TRUE((v > -2.0F)[k]);
    EXPECT_TRUE(any(v > -2.0F));
    EXPECT_FALSE(any(v > 0.0F));
  }
  for (int k = 0; k < kSize; ++k) {
    std::array<double, kSize> values{};
    values[static_cast<std::size_t>(k)] = 1;
    EXPECT_EQ((Numbers::load(values.data()) > 0.0).bits(), 1u << k);
  }
}

}  // namespace
}  // namespace papilla::tests::vector_test
