// The exact bridges on grids over all angles, gaps and spheres: that each is found, whichever plate
// is the first.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "base/constants.h"
#include "physics/capillary/bridge.h"

namespace papilla::tests::bridge_everywhere_test {
namespace {

constexpr double kDegree = kPi / 180;

TEST(BridgeEverywhere, ItsLimitsDoNotAskWhichPlateIsTheFirst) {
  for (const double t1 : {3.0, 62.0, 117.0, 172.0}) {
    for (const double t2 : {11.0, 45.0, 101.0, 133.0, 178.0}) {
      const BridgeLimits a = bridge_limits(t1 * kDegree, t2 * kDegree),
                         b = bridge_limits(t2 * kDegree, t1 * kDegree);
      ASSERT_EQ(a.status, BridgeStatus::Converged) << t1 << " " << t2;
      ASSERT_EQ(b.status, BridgeStatus::Converged) << t2 << " " << t1;
      EXPECT_GT(a.rupture, 0) << t1 << " " << t2;
      EXPECT_NEAR(a.rupture, b.rupture, 1e-9) << t1 << " " << t2;
      EXPECT_NEAR(a.switching, b.switching, 1e-9) << t1 << " " << t2;
      EXPECT_NEAR(a.zero_force, b.zero_force, 1e-9) << t1 << " " << t2;
      EXPECT_EQ(a.snap_in, b.snap_in);
      EXPECT_FALSE(a.pitchfork || b.pitchfork);
    }
  }
}

TEST(BridgeEverywhere, EveryGapBelowTheRuptureHasOne) {
  for (const double t1 : {0.0, 25.0, 90.0, 120.0, 165.0}) {
    for (const double t2 : {5.0, 40.0, 90.0, 140.0, 179.0}) {
      const double top = bridge_limits(t1 * kDegree, t2 * kDegree).rupture;
      for (const double share : {1e-3, 0.03, 0.3, 0.7, 0.999}) {
        const Bridge b = solve_bridge(1, share * top, t1 * kDegree, t2 * kDegree, 1);
        ASSERT_EQ(b.status, BridgeStatus::Converged) << t1 << " " << t2 << " " << share;
        EXPECT_NEAR(3 * b.pressure + share * top * b.force, 2 * b.energy,
                    1e-10 * (1 + std::abs(b.energy)))
            << t1 << " " << t2 << " " << share;
      }
    }
  }
}

TEST(BridgeEverywhere, EverySphereNearAPlateHasOne) {
  for (const double plate : {0.0, 10.0, 50.0, 90.0, 120.0}) {
    for (const double sphere : {0.0, 10.0, 50.0, 75.0}) {
      for (const double radius : {1.5, 5.0, 20.0, 60.0}) {
        for (const double distance : {0.0, 0.01, 0.1, 0.25}) {
          const Bridge b =
              solve_sphere_bridge(1, distance, radius, plate * kDegree, sphere * kDegree, 1);
          ASSERT_EQ(b.status, BridgeStatus::Converged)
              << plate << " " << sphere << " " << radius << " " << distance;
          const double beta = std::asin(b.radius2 / radius);
          EXPECT_NEAR(2 * kPi * b.radius2 * std::sin(sphere * kDegree + beta) -
                          kPi * square(b.radius2) * b.pressure,
                      b.force, 1e-10 * (1 + std::abs(b.force)))
              << plate << " " << sphere << " " << radius << " " << distance;
        }
      }
    }
  }
}

// The volume below a large sphere is a small difference of large ones where it is not written by
// half angles.
TEST(BridgeEverywhere, LargeSpheresToo) {
  for (const double plate : {10.0, 50.0, 90.0}) {
    for (const double sphere : {10.0, 50.0}) {
      for (const double radius : {300.0, 1000.0}) {
        for (const double distance : {0.01, 0.05}) {
          const Bridge b =
              solve_sphere_bridge(1, distance, radius, plate * kDegree, sphere * kDegree, 1);
          ASSERT_EQ(b.status, BridgeStatus::Converged)
              << plate << " " << sphere << " " << radius << " " << distance;
          const double beta = std::asin(b.radius2 / radius);
          EXPECT_NEAR(2 * kPi * b.radius2 * std::sin(sphere * kDegree + beta) -
                          kPi * square(b.radius2) * b.pressure,
                      b.force, 1e-9 * (1 + std::abs(b.force)))
              << plate << " " << sphere << " " << radius << " " << distance;
        }
      }
    }
  }
}

}  // namespace
}  // namespace papilla::tests::bridge_everywhere_test
