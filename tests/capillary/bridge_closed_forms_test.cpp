// Exact bridges where their numbers are known in closed form or from an identity, their limits, and
// the small systems that they are solved by.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "physics/capillary/bridge.h"
#include "physics/capillary/bridge_branch.h"
#include "physics/capillary/bridge_system.h"
#include "physics/capillary/bridge_table.h"
#include "physics/capillary/water.h"

namespace papilla::tests::bridge_closed_forms_test {
namespace {

namespace branch = capillary::bridge_branch;

constexpr double kDegree = kPi / 180;

const std::vector<std::pair<double, double>> kPairs{{80, 50},  {50, 80},  {20, 35},
                                                    {110, 95}, {30, 150}, {70, 70}};

// --- systems of equations ---

TEST(BridgeSystems, HaveTheAngleTheHeightAndTheVolumeAsTheirResiduals) {
  branch::Profile q;
  q.height = 0.5, q.volume = 3, q.w = 0.25, q.u = 2;
  q.height_slope = {1, 2, 3}, q.volume_slope = {4, 5, 6}, q.w_slope = {2, 4, 6},
  q.u_slope = {1, 3, -2};
  const double theta = 30 * kDegree, c = std::sqrt(0.75);
  const branch::System s = branch::plate_system(q, theta, 0.2);
  EXPECT_NEAR(s.residual[0], 0.125 - 2 * c, 1e-15);
  EXPECT_NEAR(s.residual[1], 0.3, 1e-15);
  EXPECT_EQ(s.residual[2], 2);
  const std::array<double, 3> angle{1 - c, 2 - 3 * c, 3 + 2 * c};
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(s.jacobian[0][i], angle[i], 1e-14);
  EXPECT_EQ(s.jacobian[1], q.height_slope);
  EXPECT_EQ(s.jacobian[2], q.volume_slope);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(branch::usable({1, -5, 1}));
  for (const auto& [r1, p, arc] : std::vector<std::array<double, 3>>{{0, 1, 1},
                                                                     {-1, 1, 1},
                                                                     {1, 1, 0},
                                                                     {1, 1, -1},
                                                                     {nan, 1, 1},
                                                                     {1, nan, 1},
                                                                     {1, 1, nan},
                                                                     {kInfinity, 1, 1},
                                                                     {1, -kInfinity, 1},
                                                                     {1, 1, kInfinity}})
    EXPECT_FALSE(branch::usable({r1, p, arc})) << r1 << " " << p << " " << arc;
}

// --- guesses and steps ---

// The meniscus of a slab is an arc from pi - theta_1 to theta_2; its mean offset from plate 1 in
// closed form.
TEST(BridgeSystems, TheSlabsGuessIsACircularArcAroundItsVolume) {
  for (const auto& [t1, t2] : kPairs) {
    for (const double h : {0.02, 0.2}) {
      const double theta1 = t1 * kDegree, theta2 = t2 * kDegree;
      const branch::Unknowns x = branch::slab_guess(h, theta1, theta2);
      const double mean = 1 / std::sqrt(kPi * h), a = kPi - theta1, b = theta2;
      double arc = h / std::sin(a), bend = 0, offset = 0.5 * h / std::tan(a);
      if (t1 + t2 != 180) {
        bend = (std::cos(a) - std::cos(b)) / h;  // heights are (cos a - cos phi) / bend
        arc = (b - a) / bend;
        offset = (0.5 * (b - a) - 0.25 * (std::sin(2 * b) - std::sin(2 * a)) +
                  std::sin(a) * (std::cos(b) - std::cos(a))) /
                 (h * bend * bend);
      }
      EXPECT_NEAR(x.arc, arc, 1e-10 * arc) << t1 << " " << t2;
      EXPECT_NEAR(x.r1, mean - offset, 1e-8 * mean) << t1 << " " << t2;
      EXPECT_NEAR(x.p, bend + meniscus_factor(theta1, theta2) / mean, 1e-9 * std::abs(x.p) + 1e-12);
    }
  }
  // An arc that stands off farther than the radius leaves a fifth of it.
  EXPECT_NEAR(branch::slab_guess(3, 150 * kDegree, 150 * kDegree).r1, 0.2 / std::sqrt(3 * kPi),
              1e-12);
  EXPECT_NEAR(branch::slab_guess(0.01, 0, kPi).arc, 10, 1e-9);  // nowhere steeper than 1 to 1000
}

TEST(BridgeSystems, NewtonComesBackToTheBridgeAndKnowsItsDeterminant) {
  for (const auto& [t1, t2] : kPairs) {
    const double theta1 = t1 * kDegree, theta2 = t2 * kDegree;
    branch::Branch b(theta1, theta2);
    ASSERT_TRUE(b.go_to(0.1));
    for (const double off : {0.97, 1.0, 1.04}) {
      double determinant = 0;
      const auto x = branch::newton({b.at().r1 * off, b.at().p + off - 1, b.at().arc / off}, theta1,
                                    theta2, 0.1, &determinant);
      ASSERT_TRUE(x) << t1 << " " << t2 << " " << off;
      EXPECT_NEAR(x->r1, b.at().r1, 1e-12);
      EXPECT_NEAR(x->p, b.at().p, 1e-10);
      EXPECT_NEAR(x->arc, b.at().arc, 1e-12);
      const branch::System s = branch::plate_system(branch::profile(*x, theta1), theta2, 0.1);
      for (const double r : s.residual) EXPECT_NEAR(r, 0, 1e-12);
      std::array<double, 3> unused = s.residual;
      const double here = numerics::solve<3>(s.jacobian, unused);
      EXPECT_NEAR(determinant, here, 1e-5 * std::abs(here));
    }
    EXPECT_FALSE(branch::newton({std::nan(""), 1, 1}, theta1, theta2, 0.1));
    EXPECT_FALSE(branch::newton({1, 1, -1}, theta1, theta2, 0.1));
  }
}

TEST(BridgeSystems, ABranchBeginsAsASlabOfATwentiethAndEndsAtItsLimit) {
  branch::Branch b(80 * kDegree, 50 * kDegree);
  EXPECT_TRUE(b.valid());
  EXPECT_EQ(b.height(), 0.05);
  EXPECT_NEAR(branch::profile(b.at(), 80 * kDegree).volume, 1, 1e-12);
  EXPECT_FALSE(b.go_to(2));
  const double end = bridge_limits(80 * kDegree, 50 * kDegree).rupture;
  EXPECT_LT(b.height(), end);
  EXPECT_GT(b.height(), end * (1 - 1e-6));  // as near as its steps get
  // From the end back into the slab, and below where it began.
  for (const double h : {0.9, 0.3, 0.05, 0.01, 0.002}) {
    EXPECT_TRUE(b.go_to(h)) << h;
    EXPECT_EQ(b.height(), h);
    EXPECT_NEAR(branch::profile(b.at(), 80 * kDegree).height, h, 1e-12);
  }
}

// --- bridges in closed form ---

// 90 and 90 deg: a cylinder, r = sqrt(V / (pi h)): E = gamma 2 pi r h, F = gamma pi r, p = gamma /
// r.
TEST(BridgeClosedForms, ACylinderIsOne) {
  for (const auto& [volume, gap] :
       {std::pair{1.0, 0.3}, {1.0, 1.4}, {8e-20, 2e-7}, {27e-18, 0.5e-6}}) {
    const Bridge b = solve_bridge(volume, gap, kPi / 2, kPi / 2, 0.07);
    const double r = std::sqrt(volume / (kPi * gap));
    ASSERT_EQ(b.status, BridgeStatus::Converged) << gap;
    EXPECT_NEAR(b.energy, 0.07 * 2 * kPi * r * gap, 1e-11 * b.energy);
    EXPECT_NEAR(b.force, 0.07 * kPi * r, 1e-10 * b.force);
    EXPECT_NEAR(b.pressure, 0.07 / r, 1e-10 * b.pressure);
    EXPECT_NEAR(b.radius1, r, 1e-11 * r);
    EXPECT_NEAR(b.radius2, r, 1e-11 * r);
    EXPECT_NEAR(b.free_area, 2 * kPi * r * gap, 1e-11 * b.free_area);
    EXPECT_NEAR(b.arc, gap, 1e-11 * gap);
  }
}

// At any angles to 1e-12 (bridge.h): 3 V p + h F = 2 E; the force at either plate; E of its areas;
// dE/dV = p.
TEST(BridgeClosedForms, IdentitiesHoldInAnyUnits) {
  const double volume = 3e-20, gamma = 0.05, size = std::cbrt(volume);
  for (const auto& [t1, t2] : kPairs) {
    const double theta1 = t1 * kDegree, theta2 = t2 * kDegree;
    const double top = bridge_limits(theta1, theta2).rupture;
    for (const double share : {0.05, 0.4, 0.9}) {
      const double gap = share * top * size;
      const Bridge b = solve_bridge(volume, gap, theta1, theta2, gamma);
      ASSERT_EQ(b.status, BridgeStatus::Converged);
      const double e = gamma * size * size, f = gamma * size;
      EXPECT_NEAR(3 * volume * b.pressure + gap * b.force, 2 * b.energy,
                  1e-12 * (e + std::abs(b.energy)));
      for (const auto& [r, theta] : {std::pair{b.radius1, theta1}, {b.radius2, theta2}})
        EXPECT_NEAR(2 * kPi * gamma * r * std::sin(theta) - kPi * r * r * b.pressure, b.force,
                    1e-12 * (f + std::abs(b.force)));
      EXPECT_NEAR(gamma * (b.free_area - kPi * (square(b.radius1) * std::cos(theta1) +
                                                square(b.radius2) * std::cos(theta2))),
                  b.energy, 1e-12 * (e + std::abs(b.energy)));
      const double by = 1e-4 * volume;
      const double slope = (solve_bridge(volume + by, gap, theta1, theta2, gamma).energy -
                            solve_bridge(volume - by, gap, theta1, theta2, gamma).energy) /
                           (2 * by);
      EXPECT_NEAR(slope, b.pressure, 1e-5 * (gamma / size + std::abs(b.pressure)));
    }
  }
}

TEST(BridgeClosedForms, UnderASphereForceAndEnergyBelongTogether) {
  const double volume = 2e-20, gamma = 0.05, size = std::cbrt(volume);
  for (const auto& [plate, sphere] : {std::pair{80.0, 50.0}, {20.0, 60.0}, {110.0, 40.0}}) {
    for (const double radius : {1.0 * size, 2 * size, 4 * size}) {
      for (const double distance : {0.02 * size, 0.2 * size, 0.4 * size}) {
        const auto at = [&](double d) {
          return solve_sphere_bridge(volume, d, radius, plate * kDegree, sphere * kDegree, gamma);
        };
        const Bridge b = at(distance);
        ASSERT_EQ(b.status, BridgeStatus::Converged)
            << plate << " " << radius / size << " " << distance / size;
        const double e = gamma * size * size, f = gamma * size,
                     beta = std::asin(b.radius2 / radius);
        // Line and pressure at the plate and, at the angle of the sphere and its slope, at the
        // sphere.
        EXPECT_NEAR(2 * kPi * gamma * b.radius1 * std::sin(plate * kDegree) -
                        kPi * square(b.radius1) * b.pressure,
                    b.force, 1e-12 * (f + std::abs(b.force)));
        EXPECT_NEAR(2 * kPi * gamma * b.radius2 * std::sin(sphere * kDegree + beta) -
                        kPi * square(b.radius2) * b.pressure,
                    b.force, 1e-12 * (f + std::abs(b.force)));
        EXPECT_NEAR(
            gamma * (b.free_area - kPi * square(b.radius1) * std::cos(plate * kDegree) -
                     2 * kPi * square(radius) * (1 - std::cos(beta)) * std::cos(sphere * kDegree)),
            b.energy, 1e-11 * (e + std::abs(b.energy)));
        // The meridian's own height and volume, less the cap of the sphere that dips into it.
        const branch::Profile q = branch::profile(
            {b.radius1 / size, b.pressure * size / gamma, b.arc / size}, plate * kDegree);
        const double sagitta = radius / size * (1 - std::cos(beta));
        EXPECT_NEAR(q.height, distance / size + sagitta, 1e-12);
        EXPECT_NEAR(q.volume - kPi * square(sagitta) * (3 * radius / size - sagitta) / 3, 1, 1e-12);
        EXPECT_NEAR(q.r2 * size, b.radius2, 1e-12 * size);
        EXPECT_NEAR(q.free_area * size * size, b.free_area, 1e-12 * size * size);
        const double by = 1e-4 * size;
        const double slope = (at(distance + by).energy - at(distance - by).energy) / (2 * by);
        EXPECT_NEAR(slope, b.force, 2e-5 * (f + std::abs(b.force)));
      }
    }
  }
}

TEST(BridgeClosedForms, WhatNoBridgeCanBeIsInvalid) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::array<double, 5>> wrong{
      {0, 0.1, 1, 1, 1},      {-1, 0.1, 1, 1, 1},        {1, 0, 1, 1, 1},
      {1, -0.1, 1, 1, 1},     {1, 0.1, -1e-9, 1, 1},     {1, 0.1, 1, -1e-9, 1},
      {1, 0.1, 3.1416, 1, 1}, {1, 0.1, 1, 3.1416, 1},    {1, 0.1, 1, 1, 0},
      {1, 0.1, 1, 1, -1},     {nan, 0.1, 1, 1, 1},       {1, nan, 1, 1, 1},
      {1, 0.1, nan, 1, 1},    {1, 0.1, 1, 1, kInfinity}, {kInfinity, 0.1, 1, 1, 1},
      {1, kInfinity, 1, 1, 1}};
  for (const auto& [volume, gap, theta1, theta2, gamma] : wrong) {
    const Bridge b = solve_bridge(volume, gap, theta1, theta2, gamma);
    EXPECT_EQ(b.status, BridgeStatus::Invalid)
        << volume << " " << gap << " " << theta1 << " " << theta2;
    EXPECT_EQ(b.force, 0);
  }
  EXPECT_EQ(solve_bridge(1, 0.1, 0, kPi / 2, 1).status, BridgeStatus::Converged);
  EXPECT_EQ(solve_bridge(1, 0.1, kPi, kPi / 2, 1).status, BridgeStatus::Converged);
  EXPECT_EQ(solve_sphere_bridge(1, 0, 3, 1, 1, 1).status, BridgeStatus::Converged);  // touching
  EXPECT_EQ(bridge_limits(-1e-9, 1).status, BridgeStatus::Invalid);
  EXPECT_EQ(bridge_limits(1, 3.1416).status, BridgeStatus::Invalid);
  // Wholly wetted and wholly dry, within 0.01 of 0 and 180 deg: none.
  EXPECT_EQ(bridge_limits(0.0099, kPi - 0.0099).rupture, 0);
  EXPECT_GT(bridge_limits(0.0102, kPi).rupture, 0);
  EXPECT_GT(bridge_limits(0, kPi - 0.0102).rupture, 0);
}

// --- limits ---

// Equal angles end where the contact lines are inflections: p = sin(theta) / r, arc 2 theta / p;
// with r = 1 the meridian (w, u) from phi = pi - theta has these integrals (Simpson's rule).
TEST(BridgeClosedForms, EqualAnglesEndAtTheirInflection) {
  for (const double degrees : {45.0, 60.0, 90.0, 125.0}) {
    const double theta = degrees * kDegree, p = std::sin(theta), arc = 2 * theta / p;
    double height = 0, volume = 0;
    constexpr int kSteps = 4000;
    for (int k = 0; k <= kSteps; ++k) {
      const double a = p * arc * k / kSteps;
      const double w = -std::cos(theta) * std::cos(a) + (1 / p - std::sin(theta)) * std::sin(a);
      const double u =
          std::sin(theta) * std::cos(a) - std::cos(theta) * std::sin(a) + (1 - std::cos(a)) / p;
      const double r = std::hypot(w, u);
      const double weight = arc / kSteps / 3 * (k == 0 || k == kSteps ? 1 : k % 2 ? 4 : 2);
      height += weight * u / r;
      volume += weight * kPi * r * u;
    }
    const BridgeLimits limits = bridge_limits(theta, theta);
    EXPECT_TRUE(limits.pitchfork);
    EXPECT_NEAR(limits.rupture, height / std::cbrt(volume), 1e-9) << degrees;
    const branch::Limit limit = branch::Branch(theta, theta).limit();
    EXPECT_NEAR(limit.at.r1, 1 / std::cbrt(volume), 1e-9);
    EXPECT_NEAR(limit.at.p, p * std::cbrt(volume), 1e-9);
    EXPECT_NEAR(limit.at.arc, arc / std::cbrt(volume), 1e-9);
  }
}

TEST(BridgeClosedForms, LimitsAreWhereTheirBridgesSaySo) {
  for (const auto& [t1, t2] : std::vector<std::pair<double, double>>{
           {80, 50}, {20, 35}, {110, 95}, {150, 100}, {30, 100}, {110, 110}, {25, 25}}) {
    const double theta1 = t1 * kDegree, theta2 = t2 * kDegree;
    const BridgeLimits l = bridge_limits(theta1, theta2);
    ASSERT_EQ(l.status, BridgeStatus::Converged);
    const CapShape cap = cap_shape(std::min(theta1, theta2));
    EXPECT_EQ(l.snap_in, cap.height);
    const auto at = [&](double h) { return solve_bridge(1, h, theta1, theta2, 1); };
    // Bridge and cap cost the same.
    ASSERT_GT(l.switching, 0) << t1 << " " << t2;
    EXPECT_NEAR(at(l.switching).energy, cap.energy, 1e-9) << t1 << " " << t2;
    EXPECT_LT(at(0.99 * l.switching).energy, cap.energy);
    // Beyond 180 deg it pushes below one gap.
    EXPECT_EQ(l.zero_force > 0, t1 + t2 > 180) << t1 << " " << t2;
    if (l.zero_force > 0) {
      EXPECT_NEAR(at(l.zero_force).force, 0, 1e-9);
      EXPECT_LT(at(0.9 * l.zero_force).force, 0);
      EXPECT_GT(at(1.05 * l.zero_force).force, 0);
    }
    EXPECT_EQ(at(l.rupture * (1 - 1e-5)).status, BridgeStatus::Converged);
    EXPECT_EQ(at(l.rupture * (1 + 1e-5)).status, BridgeStatus::Ruptured);
    EXPECT_EQ(l.pitchfork, t1 == t2 && t1 > 37);
    // There the Jacobian is singular.
    const branch::Limit limit = branch::Branch(theta1, theta2).limit();
    EXPECT_NEAR(limit.height, l.rupture, 1e-12);
    const auto determinant = [&](const branch::Unknowns& x, double h) {
      const branch::System s = branch::plate_system(branch::profile(x, theta1), theta2, h);
      std::array<double, 3> unused = s.residual;
      return numerics::solve<3>(s.jacobian, unused);
    };
    branch::Branch before(theta1, theta2);
    ASSERT_TRUE(before.go_to(0.8 * l.rupture));
    const double scale = std::abs(determinant(before.at(), 0.8 * l.rupture));
    EXPECT_NEAR(determinant(limit.at, limit.height), 0, 1e-8 * scale) << t1 << " " << t2;
    // And it is a bridge: a fold is interpolated over 1e-5 of its arclength.
    const branch::Profile q = branch::profile(limit.at, theta1);
    EXPECT_NEAR(q.volume, 1, 1e-10);
    EXPECT_NEAR(q.height, limit.height, 1e-10);
    EXPECT_NEAR(q.w * std::sin(theta2), q.u * std::cos(theta2), 1e-10);
  }
}

// --- the table ---

// At equal steps of u = 1 - sqrt(1 - (h / h_crit)^1.5) the table is the bridge itself.
TEST(BridgeClosedForms, AtItsNodesTheTableIsTheBridge) {
  for (const auto& [t1, t2] : kPairs) {
    const double theta1 = t1 * kDegree, theta2 = t2 * kDegree;
    for (const int nodes : {65, 9}) {
      const BridgeTable table(theta1, theta2, nodes);
      ASSERT_TRUE(table.valid());
      const double end = bridge_limits(theta1, theta2).rupture;
      EXPECT_EQ(table.limits().rupture, end);
      for (int k = 1; k + 1 < nodes; k += nodes / 9) {
        const double v = 1 - static_cast<double>(k) / (nodes - 1),
                     h = end * std::pow(1 - v * v, 2.0 / 3);
        const Bridge exact = solve_bridge(1, h, theta1, theta2, 1);
        const BridgeTable::Value got = table(h);
        EXPECT_NEAR(got.energy, exact.energy, 1e-9 * (1 + std::abs(exact.energy)))
            << t1 << " " << k;
        EXPECT_NEAR(got.force, exact.force, 1e-7 * (1 + std::abs(exact.force))) << t1 << " " << k;
      }
      const branch::Limit limit = branch::Branch(theta1, theta2).limit();
      EXPECT_NEAR(table(end).energy, branch::energy(limit.at, theta1, theta2), 1e-5);
      // The slab: -C + 2 sqrt(pi) f h^1.5 over h.
      const double h = 1e-4, c = wetting_gain(theta1, theta2), f = meniscus_factor(theta1, theta2);
      const double slab = (-c + 2 * std::sqrt(kPi) * f * h * std::sqrt(h)) / h;
      EXPECT_NEAR(table(h).energy, slab, 1e-6 * std::abs(slab) + 1e-4);
    }
  }
}

TEST(BridgeClosedForms, TablesAreKeptByTheirPairOfAnglesAndNotWithoutEnd) {
  const auto one = bridge_table(1.1, 0.7), same = bridge_table(0.7, 1.1),
             other = bridge_table(1.1, 0.8);
  EXPECT_EQ(one, same);
  EXPECT_NE(one, other);
  EXPECT_EQ(one->limits().rupture, bridge_limits(1.1, 0.7).rupture);
  EXPECT_NEAR(one->evaluate(2e-7, 8e-21, 0.05).force, 0.05 * 2e-7 * (*one)(1).force, 1e-18);
  EXPECT_NEAR(one->evaluate(1e-7, 8e-21, 0.05).energy, 0.05 * 4e-14 * (*one)(0.5).energy, 1e-24);
  // Tables of angles that are none cost nothing. More than 4,096 are dropped when the next is asked
  // for.
  int asked = 0;
  const auto until_dropped = [&] {
    const std::weak_ptr<const BridgeTable> first = bridge_table(-1 - 1e-3 * ++asked, 0);
    int count = 0;
    while (!first.expired() && count < 10000) {
      bridge_table(-1 - 1e-3 * ++asked, 0);
      ++count;
    }
    return count;
  };
  until_dropped();
  EXPECT_EQ(until_dropped(), 4096);  // beside the one that was asked for when the rest were dropped
}

}  // namespace
}  // namespace papilla::tests::bridge_closed_forms_test
