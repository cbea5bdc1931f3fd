// A calculation by loops over several pixels at once, and pixel by pixel.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "numerics/loops.h"

namespace papilla::tests {

template <class Work>
auto both_ways(const Work& work) {
  auto together = work();
  const PixelByPixel alone;
  auto apart = work();
  return std::pair(std::move(together), std::move(apart));
}

// Equal to rounding against the largest of them.
template <class Values>
void expect_alike(const Values& a, const Values& b, double rounding, const char* what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  double most = 0, apart = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    most = std::max(most, std::abs(static_cast<double>(a[i])));
    if (a[i] != b[i])  // infinite ones are equal, and have no difference
      apart = std::max(apart, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
  }
  EXPECT_LE(apart, rounding * most) << what;
}

}  // namespace papilla::tests
