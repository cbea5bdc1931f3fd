#include "physics/capillary/bridge.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "physics/capillary/bridge_branch.h"
#include "physics/capillary/bridge_table.h"
#include "physics/capillary/water.h"

namespace papilla::tests::bridge_test {
namespace {

constexpr double kDegree = kPi / 180;

std::vector<std::vector<std::string>> read_rows(const std::string& name) {
  std::ifstream in(std::string(PAPILLA_TEST_DATA) + "/capillary/" + name);
  std::vector<std::vector<std::string>> rows;
  std::string line;
  bool header = true;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#') continue;
    if (header) {
      header = false;
      continue;
    }
    std::vector<std::string> row;
    std::stringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    rows.push_back(row);
  }
  return rows;
}

TEST(Bridge, AgreesWithTheReferenceTable) {
  const auto rows = read_rows("bridge_reference.csv");
  ASSERT_EQ(rows.size(), 34u);
  for (const auto& row : rows) {
    const double t1 = std::stod(row[0]) * kDegree, t2 = std::stod(row[1]) * kDegree;
    const double h = std::stod(row[2]);
    const Bridge b = solve_bridge(1, h, t1, t2, 1);
    ASSERT_EQ(b.status, BridgeStatus::Converged) << row[0] << " " << row[1] << " " << h;
    const double got[] = {b.energy, b.force, b.pressure, b.radius1, b.radius2, b.free_area, b.arc};
    for (int k = 0; k < 7; ++k) {
      const double want = std::stod(row[3 + k]);
      EXPECT_NEAR(got[k], want, 1e-9 * std::max(1.0, std::abs(want)))
          << row[0] << " " << row[1] << " " << h << " column " << k;
    }
  }
}

TEST(Bridge, LimitsAgreeWithTheReferenceTable) {
  const auto rows = read_rows("bridge_limits.csv");
  ASSERT_EQ(rows.size(), 91u);
  for (const auto& row : rows) {
    const double t1 = std::stod(row[0]) * kDegree, t2 = std::stod(row[1]) * kDegree;
    const BridgeLimits b = bridge_limits(t1, t2);
    ASSERT_EQ(b.status, BridgeStatus::Converged) << row[0] << " " << row[1];
    EXPECT_NEAR(b.rupture, std::stod(row[2]), 1e-4) << row[0] << " " << row[1];
    EXPECT_EQ(b.pitchfork, row[3] == "bifurcation") << row[0] << " " << row[1];
    EXPECT_NEAR(b.switching, std::stod(row[6]), 1e-4) << row[0] << " " << row[1];
    EXPECT_NEAR(b.snap_in, std::stod(row[8]), 1e-5);
    if (row.size() > 11 && !row[11].empty()) {
      EXPECT_NEAR(b.zero_force, std::stod(row[11]), 1e-5) << row[0] << " " << row[1];
    }
  }
}

// Nearly equal angles are an imperfect pitchfork: the limit lies below that of equal ones by the
// difference to the power 2/3, and a table exists.
TEST(Bridge, NearlyEqualAnglesRuptureJustBeforeEqualOnes) {
  for (double theta : {42.0, 50.0, 65.0, 80.0, 88.0}) {
    const BridgeTable equal(theta * kDegree, theta * kDegree);
    const auto early = [&](double difference) {
      const BridgeTable table(theta * kDegree, (theta + difference) * kDegree);
      EXPECT_TRUE(table.valid()) << theta << " " << difference;
      EXPECT_NEAR(table(0.6).force, equal(0.6).force, 0.06 * std::abs(difference));
      return (equal.limits().rupture - table.limits().rupture) /
             std::pow(std::abs(difference), 2.0 / 3);
    };
    const double factor = 0.5 * (early(0.05) + early(-0.05));
    EXPECT_GT(factor, 0.03);
    EXPECT_LT(factor, 0.08);
    for (double difference : {1e-3, 0.004, 0.0126, 0.0292, 0.12, 0.3}) {
      EXPECT_NEAR(early(difference), factor, 0.1 * factor) << theta << " " << difference;
      EXPECT_NEAR(early(-difference), factor, 0.1 * factor) << theta << " " << -difference;
    }
    for (double difference : {-1e-5, -1e-9, 1e-7}) EXPECT_NEAR(early(difference), factor, 0.1);
  }
}

TEST(Bridge, TheCylinderRupturesAtItsPerimeter) {
  EXPECT_NEAR(bridge_limits(kPi / 2, kPi / 2).rupture, std::cbrt(kPi), 1e-6);
}

TEST(Bridge, VirialIdentityForceAndSymmetryHoldAtRandom) {
  RandomStream random(1, "bridges");
  int solved = 0;
  double worst_virial = 0, worst_force = 0, worst_swap = 0;
  for (int pair = 0; pair < 200; ++pair) {
    const double t1 = random.uniform(3, 177) * kDegree, t2 = random.uniform(3, 177) * kDegree;
    const double top = bridge_limits(t1, t2).rupture;
    if (top == 0) continue;
    for (int k = 0; k < 50; ++k) {
      const double h = top * random.uniform(0.02, 0.97);
      const double v = std::exp(random.uniform(-3, 3)), size = std::cbrt(v);
      const Bridge b = solve_bridge(v, h * size, t1, t2, 1);
      ASSERT_EQ(b.status, BridgeStatus::Converged)
          << t1 / kDegree << " " << t2 / kDegree << " " << h;
      ++solved;
      const double scale = std::abs(b.energy) + std::abs(3 * v * b.pressure);
      worst_virial = std::max(
          worst_virial, std::abs(3 * v * b.pressure + h * size * b.force - 2 * b.energy) / scale);
      if (k % 10) continue;
      const double step = 1e-4 * h * size;
      const auto e = [&](double x) { return solve_bridge(v, h * size + x, t1, t2, 1).energy; };
      const double slope = (8 * (e(step) - e(-step)) - (e(2 * step) - e(-2 * step))) / (12 * step);
      worst_force = std::max(worst_force, std::abs(slope - b.force) / (std::abs(b.force) + size));
      const Bridge s = solve_bridge(v, h * size, t2, t1, 1);
      worst_swap = std::max(worst_swap, std::abs(s.energy - b.energy) / scale);
      worst_swap = std::max(worst_swap, std::abs(s.force - b.force) / (std::abs(b.force) + size));
    }
  }
  EXPECT_GE(solved, 9900);
  EXPECT_LT(worst_virial, 1e-9);
  EXPECT_LT(worst_force, 1e-6);
  EXPECT_LT(worst_swap, 1e-9);
}

TEST(Bridge, BetweenAPlateThatIsWettedWhollyAndOneThatIsNotThereIsNone) {
  for (const auto& [wetted, dry] : {std::pair{0.0, 180.0}, {180.0, 0.0}, {0.3, 179.8}}) {
    EXPECT_EQ(solve_bridge(1, 1e-3, wetted * kDegree, dry * kDegree, 1).status,
              BridgeStatus::Ruptured);
    const BridgeLimits limits = bridge_limits(wetted * kDegree, dry * kDegree);
    EXPECT_EQ(limits.status, BridgeStatus::Converged);
    EXPECT_EQ(limits.rupture, 0);
    EXPECT_FALSE(BridgeTable(wetted * kDegree, dry * kDegree).valid());
  }
  // It is the limit of what happens beside it.
  const double near = bridge_limits(1 * kDegree, 180 * kDegree).rupture;
  EXPECT_GT(near, 0);
  EXPECT_LT(near, 0.05);
}

TEST(Bridge, BetweenPlatesThatHardlyTouchWaterItRupturesAtTheDiameterOfADrop) {
  // A ball: (6/pi)^(1/3).
  for (double other : {179.9, 179.999, 180.0}) {
    const BridgeLimits limits = bridge_limits(other * kDegree, 180 * kDegree);
    EXPECT_EQ(limits.status, BridgeStatus::Converged) << other;
    EXPECT_NEAR(limits.rupture, std::cbrt(6 / kPi), 1e-3) << other;
  }
}

TEST(Bridge, BeyondRuptureItSaysSo) {
  EXPECT_EQ(solve_bridge(1, 1.0, 80 * kDegree, 50 * kDegree, 1).status, BridgeStatus::Ruptured);
  EXPECT_EQ(solve_bridge(1, 1.47, 90 * kDegree, 90 * kDegree, 1).status, BridgeStatus::Ruptured);
  EXPECT_EQ(solve_bridge(0, 1.47, 1, 1, 1).status, BridgeStatus::Invalid);
  EXPECT_EQ(solve_bridge(1, 0.1, 4, 1, 1).status, BridgeStatus::Invalid);
}

TEST(Cap, AgreesWithTheReferenceTable) {
  const auto rows = read_rows("cap.csv");
  ASSERT_FALSE(rows.empty());
  for (const auto& row : rows) {
    const CapShape cap = cap_shape(std::stod(row[0]) * kDegree);
    EXPECT_NEAR(cap.sphere_radius, std::stod(row[1]), 1e-9 * cap.sphere_radius);
    EXPECT_NEAR(cap.height, std::stod(row[2]), 1e-10);
    EXPECT_NEAR(cap.footprint, std::stod(row[3]), 1e-9);
    EXPECT_NEAR(cap.energy, std::stod(row[4]), 1e-9);
  }
}

TEST(SphereBridge, AgreesWithTheReferenceTable) {
  int judged = 0;
  for (const auto& row : read_rows("sphere_plate.csv")) {
    // The distances are printed to six digits; they are round multiples of V^(1/3).
    const double v = std::stod(row[2]), size = std::cbrt(v);
    const double d = std::round(std::stod(row[3]) / size * 100) / 100 * size;
    const Bridge b =
        solve_sphere_bridge(v, d, 1, std::stod(row[0]) * kDegree, std::stod(row[1]) * kDegree, 1);
    if (d > 0.9 * size && b.status != BridgeStatus::Converged) continue;  // near rupture
    ASSERT_EQ(b.status, BridgeStatus::Converged) << row[0] << " " << row[1] << " " << v << " " << d;
    EXPECT_NEAR(b.energy, std::stod(row[4]), 1e-8 * (std::abs(b.energy) + std::cbrt(v * v)));
    EXPECT_NEAR(b.force, std::stod(row[5]), 1e-8 * std::abs(b.force));
    EXPECT_NEAR(b.radius1, std::stod(row[7]), 1e-8);
    EXPECT_NEAR(b.radius2, std::stod(row[8]), 1e-8);
    ++judged;
  }
  EXPECT_GE(judged, 97);
}

// Where stability ends is a bridge of its own: of volume 1, with the height and the angle that it
// is said to have.
TEST(BridgeLimit, IsABridgeOfTheBranch) {
  using namespace papilla::capillary::bridge_branch;
  const double degree = kPi / 180;
  for (const auto& [a, b] :
       {std::pair{80.0, 80.0}, {50.0, 50.0}, {120.0, 120.0}, {80.0, 50.0}, {110.0, 60.0}}) {
    const double theta1 = a * degree, theta2 = b * degree;
    const Limit limit = Branch(theta1, theta2).limit();
    ASSERT_TRUE(limit.found) << a << " " << b;
    const Profile q = profile(limit.at, theta1);
    // A fold is interpolated over 1e-5 of arclength.
    const double tolerance = limit.pitchfork ? 1e-9 : 1e-7;
    EXPECT_NEAR(q.volume, 1, tolerance) << a << " " << b;
    EXPECT_NEAR(q.height, limit.height, tolerance);
    EXPECT_NEAR(q.w * std::sin(theta2), q.u * std::cos(theta2), tolerance);
    if (a == b) {
      EXPECT_NEAR(q.r2, limit.at.r1, tolerance);
    }
    // Just below it there is a bridge nearby.
    Branch branch(theta1, theta2);
    ASSERT_TRUE(branch.go_to(limit.height * (1 - 1e-4)));
    EXPECT_NEAR(branch.at().p, limit.at.p, 0.05);
    EXPECT_NEAR(branch.at().r1, limit.at.r1, 0.05);
    EXPECT_FALSE(branch.go_to(limit.height * 1.01));
  }
}

TEST(Bridge, OfWhatIsNoneHasNoForceNoEnergyAndNoCircle) {
  const double infinity = std::numeric_limits<double>::infinity();
  const Bridge right = solve_sphere_bridge(1, 0.1, 2, 1, 1, 1);
  ASSERT_EQ(right.status, BridgeStatus::Converged);
  EXPECT_GT(right.force, 0);
  for (const Bridge& b :
       {Bridge{}, solve_bridge(-1, 0.1, 1, 1, 1), solve_bridge(1, 100, 1, 1, 1),
        solve_sphere_bridge(-1, 0.1, 2, 1, 1, 1), solve_sphere_bridge(1, -0.1, 2, 1, 1, 1),
        solve_sphere_bridge(1, 0.1, -2, 1, 1, 1), solve_sphere_bridge(1, 0.1, 2, 4, 1, 1),
        solve_sphere_bridge(1, 0.1, 2, 1, -1, 1), solve_sphere_bridge(1, 0.1, 2, 1, 1, 0),
        solve_sphere_bridge(infinity, 0.1, 2, 1, 1, 1),
        solve_sphere_bridge(1, infinity, 2, 1, 1, 1),
        solve_sphere_bridge(1, 0.1, infinity, 1, 1, 1)}) {
    EXPECT_TRUE(b.status == BridgeStatus::Invalid || b.status == BridgeStatus::Ruptured);
    for (const double v : {b.energy, b.force, b.pressure, b.radius1, b.radius2, b.free_area, b.arc})
      EXPECT_EQ(v, 0);
  }
}

}  // namespace
}  // namespace papilla::tests::bridge_test
