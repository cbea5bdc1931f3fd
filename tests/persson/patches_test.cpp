#include "physics/persson/patches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/constants.h"
#include "physics/persson/persson.h"
#include "tests/persson/table.h"

namespace papilla::tests::patches_test {
namespace {

constexpr double kPatch = 2 * kPi / 12e-6;  // wave number of a patch of 12 um

double relative(double a, double b) { return std::abs(a / b - 1); }

// Persson's own area of a patch in place of a solver of patches.
double bridged_area(const MeanField& field, double pressure, int nodes) {
  const double below = field.stress_measure(kPatch), above = field.stress_measure() - below;
  const PatchPressures patches(below, pressure, nodes);
  double area = 0;
  for (std::size_t k = 0; k < patches.pressure().size(); ++k) {
    area += patches.share()[k] * std::erf(patches.pressure()[k] / std::sqrt(above));
  }
  return area;
}

TEST(PatchPressures, PerssonsOwnPatchGivesTheFullTheoryBack) {
  const MeanField field(wrist_spectrum(), {});
  for (double p : {1e3, 1e4, 1e6, 3e7}) {  // from a light touch to nearly full contact of patches
    const double full = field.area(p);
    EXPECT_LT(relative(bridged_area(field, p, 40), full), 1e-12) << p;
    EXPECT_LT(relative(bridged_area(field, p, 3), full), 2e-3) << p;
    EXPECT_LT(relative(bridged_area(field, p, 1), full), 0.11) << p;
  }
}

TEST(PatchPressures, MatchTheTable) {
  for (const TableRow& row : read_table("t50_patch_bridge.csv", true)) {
    const auto& v = row.values;
    const MeanField field(wrist_spectrum().scaled(v[2]), {v[0] * 1e6, 0.5, 200e-6, 10e3, 0.5},
                          {.kappa = kPurePersson});
    const double p = v[1] * 1e3;
    const PatchPressures patches(field.stress_measure(kPatch), p, 6);
    const double touching = std::accumulate(patches.share().begin(), patches.share().end(), 0.0);
    EXPECT_LT(relative(touching, v[3]), 5e-3);
    EXPECT_LT(relative(p / touching, v[4] * 1e6), 5e-3);
    EXPECT_LT(relative(bridged_area(field, p, 6), v[11]), 5e-3);
  }
}

// Ridges of next to no roughness: each part of the area has one pressure, far from the others'.
TEST(PatchPressures, KeepPartsThatLieFarApart) {
  const std::vector<NominalPressure> parts{{1e4, 0.2}, {2e4, 0.3}, {3e4, 0.5}};
  for (const int nodes : {1, 3}) {
    const PatchPressures patches(1, parts, nodes);
    double touching = 0, load = 0, squares = 0;
    for (std::size_t k = 0; k < patches.share().size(); ++k) {
      const double share = patches.share()[k], s = patches.pressure()[k];
      touching += share, load += share * s, squares += share * s * s;
    }
    EXPECT_NEAR(touching, 1, 1e-9) << nodes;
    EXPECT_NEAR(load, 2.3e4, 1e-9 * 2.3e4) << nodes;
    if (nodes > 1) {
      EXPECT_NEAR(squares, 5.9e8, 1e-8 * 5.9e8);
    }
  }
}

TEST(PatchPressures, CarryTheLoad) {
  for (double x : {1e-3, 0.1, 1.0, 5.0, 30.0}) {
    const double root = 2e6;
    const PatchPressures patches(square(root), x * root, 5);
    double load = 0, touching = 0;
    for (std::size_t k = 0; k < 5; ++k) {
      EXPECT_GT(patches.share()[k], 0);
      load += patches.share()[k] * patches.pressure()[k];
      touching += patches.share()[k];
    }
    EXPECT_LT(relative(load, x * root), 1e-10) << x;
    EXPECT_LT(relative(touching, std::erf(x)), 1e-10) << x;
  }
}

TEST(PatchPressures, FollowAChangeOfTheNominalPressure) {
  const double root = 2e6;
  for (double x : {1e-3, 0.1, 0.5}) {
    const PatchPressures patches(square(root), x * root, 4);
    const double p = 1.4 * x * root;
    const std::vector<double> share = patches.share_at(p);
    const PatchPressures fresh(square(root), p, 40);
    double load = 0, value = 0, expected = 0;
    for (std::size_t k = 0; k < share.size(); ++k) {
      load += share[k] * patches.pressure()[k];
      value += share[k] * std::erf(patches.pressure()[k] / (3 * root));
    }
    for (std::size_t k = 0; k < 40; ++k) {
      expected += fresh.share()[k] * std::erf(fresh.pressure()[k] / (3 * root));
    }
    EXPECT_LT(relative(load, p), 1e-12);
    EXPECT_LT(relative(value, expected), 2e-3) << x;
  }
}

// Fine roughness under a hard tip: the parts of the area press by many times sqrt(M) apart.
TEST(PatchPressures, OfPartsFarApartStayNumbers) {
  for (const double x : {20.0, 40.0, 85.0, 150.0}) {
    for (const int nodes : {1, 2, 4}) {
      const PatchPressures patches(square(2e6), {{x * 1e6, 0.3}, {x * 2e6, 0.4}, {x * 3e6, 0.3}},
                                   nodes);
      const std::vector<double> same = patches.share_at({x * 1e6, x * 2e6, x * 3e6});
      const std::vector<double> more = patches.share_at({x * 1.01e6, x * 2.02e6, x * 3.03e6});
      double load = 0;
      for (std::size_t k = 0; k < same.size(); ++k) {
        EXPECT_NEAR(same[k], patches.share()[k], 1e-6) << x << " " << nodes;
        load += more[k] * patches.pressure()[k];
      }
      EXPECT_NEAR(load, x * 2.02e6, 1e-9 * x * 1e6) << x << " " << nodes;
    }
  }
}

TEST(PatchPressures, FarGapsAndPatchesTogetherPullLikeTheFullTheory) {
  for (const TableRow& row : read_table("t51_patch_electro.csv", true)) {
    const auto& v = row.values;
    const MeanFieldSolid solid{v[0] * 1e6, 0.5, 200e-6, 10e3, 0.5};
    const PowerSpectrum spectrum = wrist_spectrum().scaled(v[2]);
    const MeanFieldOptions options{.kappa = kPurePersson, .smallest_gap = 1e-11};
    const MeanField field(spectrum, solid, options);
    const double p = v[1] * 1e3, h0 = 0.2e-6;
    const GapDistribution gaps = field.gaps(p);
    const double full = gaps.inverse_square(h0);
    EXPECT_LT(relative(full, v[3]), 5e-3);
    const MeanField within(spectrum.between(kPatch, spectrum.highest()), solid, options);
    const PatchPressures patches(field.stress_measure(kPatch), p, 6);
    double sum = gaps.far_inverse_square(h0, kPatch);
    for (std::size_t k = 0; k < patches.pressure().size(); ++k) {
      sum += patches.share()[k] * within.gaps(patches.pressure()[k]).inverse_square(h0);
    }
    EXPECT_LT(relative(sum, full), 0.05) << v[0] << " " << v[2];
    // One nominal pressure on every patch pulls many times too much.
    EXPECT_GT(within.gaps(p).inverse_square(h0), 2 * full);
  }
}

TEST(PowerSpectrum, AStepIsAllowed) {
  // Two bands of different level joined at one wave number.
  const PowerSpectrum low = self_affine_spectrum(1e-6, 1e3, 1e3, 1e5, 0.8);
  const PowerSpectrum high = self_affine_spectrum(3e-7, 1e5 * (1 + 1e-9), 1e6, 1e7, 0.8);
  PowerSpectrum both = low;
  both.wave_number.insert(both.wave_number.end(), high.wave_number.begin(), high.wave_number.end());
  both.density.insert(both.density.end(), high.density.begin(), high.density.end());
  EXPECT_LT(relative(both.rms(), std::hypot(1e-6, 3e-7)), 1e-9);
  const MeanField field(both, {1e6, 0.5, 0, 1e6, 0.5});
  const MeanField a(low, {1e6, 0.5, 0, 1e6, 0.5}), b(high, {1e6, 0.5, 0, 1e6, 0.5});
  EXPECT_LT(relative(field.stress_measure(), a.stress_measure() + b.stress_measure()), 1e-8);
}

}  // namespace
}  // namespace papilla::tests::patches_test
