#include "physics/capillary/bridge_table.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>

#include "base/constants.h"
#include "base/random.h"

namespace papilla::tests::bridge_table_test {
namespace {

constexpr double kDegree = kPi / 180;

TEST(BridgeTable, AgreesWithTheExactBridge) {
  RandomStream random(1, "table");
  const double pairs[][2] = {{80, 50},  {80, 30},   {110, 80}, {80, 80},  {90, 90},  {0, 0},
                             {110, 50}, {110, 110}, {60, 10},  {130, 20}, {150, 150}};
  for (const auto& pair : pairs) {
    const double t1 = pair[0] * kDegree, t2 = pair[1] * kDegree;
    const BridgeTable table(t1, t2);
    ASSERT_TRUE(table.valid()) << pair[0] << " " << pair[1];
    double worst_energy = 0, worst_force = 0;
    for (int k = 0; k < 100; ++k) {
      const double h = table.limits().rupture * random.uniform(0.005, 0.999);
      const Bridge b = solve_bridge(1, h, t1, t2, 1);
      ASSERT_EQ(b.status, BridgeStatus::Converged) << h;
      const auto v = table(h);
      worst_energy =
          std::max(worst_energy, std::abs(v.energy - b.energy) / (1 + std::abs(b.energy)));
      worst_force = std::max(worst_force, std::abs(v.force - b.force) / (1 + std::abs(b.force)));
    }
    EXPECT_LT(worst_energy, 5e-5) << pair[0] << " " << pair[1];
    EXPECT_LT(worst_force, 5e-4) << pair[0] << " " << pair[1];
  }
}

// On a plate that water wholly keeps off too: without a table a drop is a slab that never lets go.
TEST(BridgeTable, IsKnownUpTo180Degrees) {
  for (const double wetted : {3.0, 25.0, 55.0, 70.0, 80.0, 85.0, 90.0, 105.0, 115.0, 150.0}) {
    const BridgeTable table(wetted * kDegree, 180 * kDegree);
    ASSERT_TRUE(table.valid()) << wetted;
    const BridgeLimits limits = bridge_limits(wetted * kDegree, 180 * kDegree);
    EXPECT_NEAR(table.limits().rupture, limits.rupture, 1e-4 * limits.rupture) << wetted;
    for (const double share : {0.1, 0.5, 0.9}) {
      const double h = share * limits.rupture;
      const Bridge b = solve_bridge(1, h, wetted * kDegree, 180 * kDegree, 1);
      ASSERT_EQ(b.status, BridgeStatus::Converged) << wetted;
      EXPECT_NEAR(table(h).force, b.force, 1e-3 * (1 + std::abs(b.force))) << wetted;
    }
  }
}

TEST(BridgeTable, ForceIsTheDerivativeOfItsEnergy) {
  const BridgeTable table(80 * kDegree, 50 * kDegree);
  RandomStream random(2, "table");
  for (int k = 0; k < 200; ++k) {
    const double h = table.limits().rupture * random.uniform(0.05, 0.99);
    const double step = 1e-5 * h;
    const double slope = (table(h + step).energy - table(h - step).energy) / (2 * step);
    EXPECT_NEAR(table(h).force, slope, 1e-6 * (1 + std::abs(slope)));
  }
}

TEST(BridgeTable, ScalesWithVolumeAndTension) {
  const auto table = bridge_table(80 * kDegree, 50 * kDegree);
  EXPECT_EQ(table, bridge_table(50 * kDegree, 80 * kDegree));
  const Bridge b = solve_bridge(1e-20, 100e-9, 80 * kDegree, 50 * kDegree, 0.0721);
  const auto v = table->evaluate(100e-9, 1e-20, 0.0721);
  EXPECT_NEAR(v.force, b.force, 5e-4 * b.force);
  EXPECT_NEAR(v.energy, b.energy, 5e-4 * std::abs(b.energy));
}

}  // namespace
}  // namespace papilla::tests::bridge_table_test
