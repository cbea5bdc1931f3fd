// The Gauss rule of patch pressures against the moments of its density, which are known: the odd
// ones are those of a whole bell, the even ones end at zero pressure. Eq. persson.15
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "base/check.h"
#include "base/constants.h"
#include "physics/persson/patches.h"

namespace papilla::tests::patch_rule_test {
namespace {

double relative(double a, double b) { return std::abs(a / b - 1); }

// int s^k [e^-(s-x)^2 - e^-(s+x)^2] ds / sqrt(pi) over s > 0, in units of sqrt(M). The bells about
// -x and x are odd together: for odd k half of the whole line, by parts for even k.
double moment(int k, double x) {
  const double bell = std::exp(-x * x) / std::sqrt(kPi);
  switch (k) {
    case 0:
      return std::erf(x);
    case 1:
      return x;
    case 2:
      return (x * x + 0.5) * std::erf(x) + x * bell;
    case 3:
      return x * x * x + 1.5 * x;
    case 4:
      return (x * x * (x * x + 3) + 0.75) * std::erf(x) + x * (x * x + 2.5) * bell;
    default:
      return x * (x * x * (x * x + 5) + 3.75);
  }
}

TEST(PatchRule, IsExactToTwiceItsNodes) {
  const double root = 3e5;
  for (const double x : {0.01, 0.4, 1.5, 6.0, 12.0}) {
    for (const int nodes : {1, 2, 3}) {
      const PatchPressures patches(square(root), x * root, nodes);
      ASSERT_EQ(patches.pressure().size(), static_cast<std::size_t>(nodes));
      ASSERT_EQ(patches.share().size(), static_cast<std::size_t>(nodes));
      for (int k = 0; k < 2 * nodes; ++k) {
        double sum = 0;
        for (int i = 0; i < nodes; ++i) {
          const auto at = static_cast<std::size_t>(i);
          sum += patches.share()[at] * std::pow(patches.pressure()[at] / root, k);
        }
        EXPECT_LT(relative(sum, moment(k, x)), 1e-10) << x << ", degree " << k;
      }
      for (std::size_t i = 1; i < patches.pressure().size(); ++i)
        EXPECT_GT(patches.pressure()[i], patches.pressure()[i - 1]);
    }
  }
}

// Parts of the area with nominal pressures of their own: the moments are their mean.
TEST(PatchRule, OfSeveralNominalPressuresIsTheirMean) {
  const double root = 3e5;
  const std::vector<NominalPressure> parts{{0.05 * root, 0.3}, {0.4 * root, 0.5}, {2 * root, 0.2}};
  for (const int nodes : {1, 2, 3}) {
    const PatchPressures patches(square(root), parts, nodes);
    for (int k = 0; k < 2 * nodes; ++k) {
      double sum = 0, mean = 0;
      for (const NominalPressure& part : parts)
        mean += part.share * moment(k, part.pressure / root);
      for (int i = 0; i < nodes; ++i) {
        const auto at = static_cast<std::size_t>(i);
        sum += patches.share()[at] * std::pow(patches.pressure()[at] / root, k);
      }
      EXPECT_LT(relative(sum, mean), 1e-10) << "degree " << k;
    }
    // At other pressures of the parts they carry those.
    const std::vector<double> pressed{0.1 * root, 0.5 * root, 3 * root};
    const std::vector<double> share = patches.share_at(pressed);
    EXPECT_LT(
        relative(std::inner_product(share.begin(), share.end(), patches.pressure().begin(), 0.0),
                 (0.3 * 0.1 + 0.5 * 0.5 + 0.2 * 3) * root),
        1e-12);
    EXPECT_LT(
        relative(patches.share_at({0.05 * root, 0.4 * root, 2 * root})[0], patches.share()[0]),
        1e-12);
  }
}

// Shares at another load: each times the ratio of the densities at its pressure, and the load.
TEST(PatchRule, FollowsAnotherLoadByTheRatioOfTheDensities) {
  const double root = 3e5, p = 0.6 * root;
  const PatchPressures patches(square(root), p, 5);
  const std::vector<double> same = patches.share_at(p);
  for (std::size_t k = 0; k < 5; ++k) EXPECT_LT(relative(same[k], patches.share()[k]), 1e-9);
  for (const double other : {0.1 * root, 0.9 * root, 4.0 * root}) {
    const auto density = [&](double s, double nominal) {
      return std::exp(-square((s - nominal) / root)) - std::exp(-square((s + nominal) / root));
    };
    std::vector<double> expected;
    double load = 0;
    for (std::size_t k = 0; k < 5; ++k) {
      const double s = patches.pressure()[k];
      expected.push_back(patches.share()[k] * density(s, other) / density(s, p));
      load += expected.back() * s;
    }
    const std::vector<double> share = patches.share_at(other);
    for (std::size_t k = 0; k < 5; ++k)
      EXPECT_LT(relative(share[k], expected[k] * other / load), 1e-9) << other << " " << k;
  }
}

// Far above the nominal load the ratios would overflow: the largest is taken as one.
TEST(PatchRule, CarriesAnyLoad) {
  const double root = 1e5;
  const PatchPressures patches(square(root), 1e-3 * root, 4);
  for (const double factor : {1e-6, 1.0, 1e6}) {
    const std::vector<double> share = patches.share_at(factor * root);
    double load = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      ASSERT_TRUE(std::isfinite(share[k])) << factor;
      load += share[k] * patches.pressure()[k];
    }
    EXPECT_LT(relative(load, factor * root), 1e-12);
  }
}

TEST(PatchRule, RefusesWhatHasNoRule) {
  EXPECT_NO_THROW(PatchPressures(1e10, 1e5, 64));
  EXPECT_THROW(PatchPressures(1e10, 1e5, 65), InternalError);
  EXPECT_THROW(PatchPressures(1e10, 1e5, 0), InternalError);
  EXPECT_THROW(PatchPressures(0, 1e5, 3), InternalError);
  EXPECT_THROW(PatchPressures(1e10, 0, 3), InternalError);
  EXPECT_THROW(PatchPressures(1e10, 1e5, 3).share_at(0), InternalError);
}

}  // namespace
}  // namespace papilla::tests::patch_rule_test
