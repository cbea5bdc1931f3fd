// The pieces that bridges and films are made of against second ways of computing them, on oblong
// pixels and across the border; and the units of all of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "physics/capillary/bridge_branch.h"
#include "physics/capillary/drop.h"
#include "physics/capillary/drop_hash.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/film.h"
#include "physics/capillary/footprint.h"
#include "physics/capillary/gap_table.h"
#include "physics/capillary/threshold.h"

namespace papilla::tests::invariants_test {
namespace {

namespace branch = capillary::bridge_branch;

// --- meridians ---

struct Walked {
  double r, z, phi, volume, area;
};

// The Delaunay surface of constant curvature phi' + sin(phi)/r = p, step by step (Runge-Kutta).
Walked walked(const branch::Unknowns& x, double theta1) {
  using State = std::array<double, 5>;
  const auto rate = [&](const State& y) {
    return State{std::cos(y[2]), std::sin(y[2]), x.p - std::sin(y[2]) / y[0],
                 kPi * y[0] * y[0] * std::sin(y[2]), 2 * kPi * y[0]};
  };
  State y{x.r1, 0, kPi - theta1, 0, 0};
  constexpr int kSteps = 4000;
  const double s = x.arc / kSteps;
  for (int k = 0; k < kSteps; ++k) {
    const auto moved = [&](const State& by, double share) {
      State out = y;
      for (std::size_t i = 0; i < 5; ++i) out[i] += share * s * by[i];
      return out;
    };
    const State a = rate(y), b = rate(moved(a, 0.5)), c = rate(moved(b, 0.5)),
                d = rate(moved(c, 1));
    for (std::size_t i = 0; i < 5; ++i) y[i] += s / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
  }
  return {y[0], y[1], y[2], y[3], y[4]};
}

const std::vector<std::pair<branch::Unknowns, double>> kMeridians{{{1.2, -3.0, 0.35}, 0.6},
                                                                  {{0.9, 0.8, 0.5}, 1.4},
                                                                  {{0.7, 2.6, 0.8}, 2.2},
                                                                  {{1.5, 1e-5, 0.2}, 1.1}};

TEST(Meridians, AreThoseOfConstantCurvature) {
  for (const auto& [x, theta1] : kMeridians) {
    const branch::Profile q = branch::profile(x, theta1);
    const Walked w = walked(x, theta1);
    EXPECT_NEAR(q.r2, w.r, 1e-9) << theta1;
    EXPECT_NEAR(q.w, w.r * std::cos(w.phi), 1e-9) << theta1;
    EXPECT_NEAR(q.u, w.r * std::sin(w.phi), 1e-9) << theta1;
    EXPECT_NEAR(q.height, w.z, 1e-9) << theta1;
    EXPECT_NEAR(q.volume, w.volume, 1e-9) << theta1;
    EXPECT_NEAR(q.free_area, w.area, 1e-9) << theta1;
  }
}

TEST(Meridians, TheirSlopesAreTheirDifferences) {
  for (const auto& [x, theta1] : kMeridians) {
    const branch::Profile q = branch::profile(x, theta1);
    for (std::size_t i = 0; i < 3; ++i) {
      const double by = 1e-5;
      const auto at = [&](double sign) {
        branch::Unknowns y = x;
        (i == 0 ? y.r1 : i == 1 ? y.p : y.arc) += sign * by;
        return branch::profile(y, theta1);
      };
      const branch::Profile more = at(1), less = at(-1);
      EXPECT_NEAR(q.height_slope[i], (more.height - less.height) / (2 * by), 1e-7) << i << theta1;
      EXPECT_NEAR(q.volume_slope[i], (more.volume - less.volume) / (2 * by), 1e-7) << i << theta1;
      EXPECT_NEAR(q.w_slope[i], (more.w - less.w) / (2 * by), 1e-7) << i << theta1;
      EXPECT_NEAR(q.u_slope[i], (more.u - less.u) / (2 * by), 1e-7) << i << theta1;
    }
  }
}

// Along the branch: volume 1, the height asked for, both contact angles, force dE/dh; the same on
// the way back.
TEST(Meridians, OfABranchMeetBothPlatesAtTheirAngles) {
  for (const auto& [theta1, theta2] : {std::pair{0.9, 1.4}, {1.8, 0.7}, {1.2, 1.2}, {0.6, 2.0}}) {
    branch::Branch b(theta1, theta2);
    ASSERT_TRUE(b.valid());
    std::vector<double> forces;
    for (const double h : {0.02, 0.1, 0.25, 0.4, 0.25, 0.1, 0.02}) {
      ASSERT_TRUE(b.go_to(h)) << h;
      EXPECT_EQ(b.height(), h);
      const branch::Unknowns x = b.at();
      const branch::Profile q = branch::profile(x, theta1);
      EXPECT_NEAR(q.height, h, 1e-10);
      EXPECT_NEAR(q.volume, 1, 1e-10);
      // The surface leaves the upper plate at its own angle.
      EXPECT_NEAR(std::atan2(q.u, q.w), theta2, 1e-9) << theta1 << " " << theta2;
      const double by = 1e-5 * h;
      branch::Branch up = b, down = b;
      ASSERT_TRUE(up.go_to(h + by) && down.go_to(h - by));
      const double slope =
          (branch::energy(up.at(), theta1, theta2) - branch::energy(down.at(), theta1, theta2)) /
          (2 * by);
      EXPECT_NEAR(branch::force(x, theta1), slope, 1e-5 * (1 + std::abs(slope))) << h;
      forces.push_back(branch::force(x, theta1));
    }
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(forces[i], forces[6 - i], 1e-8 * (1 + std::abs(forces[i])));
  }
}

// --- gaps over discs ---

constexpr Grid kGrid{60, 36, 6e-6, 5.4e-6};  // 100 x 150 nm

Gap smooth_gap() {
  Gap gap{kGrid, std::vector<double>(kGrid.size())};
  for (int iy = 0; iy < kGrid.ny; ++iy) {
    for (int ix = 0; ix < kGrid.nx; ++ix) {
      const double u = 2 * kPi * kGrid.x(ix) / kGrid.lx, v = 2 * kPi * kGrid.y(iy) / kGrid.ly;
      gap.value[kGrid.index(ix, iy)] =
          300e-9 + 120e-9 * std::cos(u + 0.4) + 60e-9 * std::sin(2 * v) + 40e-9 * std::cos(u - v);
    }
  }
  return gap;
}

double gap_there(double x, double y) {
  const double u = 2 * kPi * x / kGrid.lx, v = 2 * kPi * y / kGrid.ly;
  return 300e-9 + 120e-9 * std::cos(u + 0.4) + 60e-9 * std::sin(2 * v) + 40e-9 * std::cos(u - v);
}

double mean_on(double x, double y, double radius) {
  double sum = 0;
  for (int k = 0; k < 360; ++k)
    sum += gap_there(x + radius * std::cos(k * kPi / 180), y + radius * std::sin(k * kPi / 180));
  return sum / 360;
}

const std::vector<std::array<double, 3>> kDiscs{{3e-6, 2.5e-6, 0.9e-6},   {2.1e-6, 3.3e-6, 0.3e-6},
                                                {0.2e-6, 0.1e-6, 0.8e-6}, {5.9e-6, 3e-6, 1.5e-6},
                                                {3e-6, 5.35e-6, 1.2e-6},  {-1e-6, 7e-6, 0.6e-6}};

TEST(GapTables, HoldTheGapOverDiscsAndOnTheirRims) {
  const capillary::GapTable table(smooth_gap(), 0.3e-9);
  for (const auto& [x, y, radius] : kDiscs) {
    const auto rule = table.rule(radius);
    EXPECT_NEAR(table.at(x, y), gap_there(x, y), 1.5e-9) << x;
    double volume = 0;
    constexpr int kRings = 400;
    for (int k = 0; k < kRings; ++k) {
      const double r = (k + 0.5) * radius / kRings;
      volume += 2 * kPi * r * radius / kRings * mean_on(x, y, r);
    }
    EXPECT_NEAR(table.disc_volume(x, y, radius, rule), volume, 6e-3 * volume) << x << " " << y;
    const auto rim = table.rim(x, y, radius, rule);
    EXPECT_NEAR(rim.gap, mean_on(x, y, radius), 2e-9) << x << " " << y;
    const double slope =
        (mean_on(x, y, 1.01 * radius) - mean_on(x, y, 0.99 * radius)) / (0.02 * radius);
    EXPECT_NEAR(rim.slope, slope, 6e-3) << x << " " << y;
    // Every period is the same.
    EXPECT_NEAR(table.disc_volume(x + kGrid.lx, y - kGrid.ly, radius, rule),
                table.disc_volume(x, y, radius, rule), 1e-9 * volume);
  }
  // What is nearer than a molecule counts as a molecule.
  const capillary::GapTable floored(smooth_gap(), 350e-9);
  EXPECT_EQ(floored.floor(), 350e-9);
  double least = 1;
  for (int ix = 0; ix < 60; ++ix) least = std::min(least, floored.at(kGrid.x(ix), kGrid.y(9)));
  EXPECT_EQ(least, 350e-9);
}

TEST(Footprints, HoldTheVolumeWhateverTheGuess) {
  const capillary::GapTable table(smooth_gap(), 0.3e-9);
  for (const auto& [x, y, radius] : kDiscs) {
    const double volume = table.disc_volume(x, y, radius, table.rule(radius));
    for (const double guess : {0.0, 0.3 * radius, radius, 2 * radius}) {
      const capillary::Footprint found = capillary::solve_footprint(table, x, y, volume, guess);
      EXPECT_NEAR(found.radius, radius, 2e-3 * radius) << guess;  // rules change with the radius
      EXPECT_NEAR(table.disc_volume(x, y, found.radius, table.rule(found.radius)), volume,
                  1e-12 * volume);
      const auto rim = table.rim(x, y, found.radius, table.rule(found.radius));
      EXPECT_NEAR(found.rim.gap, rim.gap, 1e-9 * rim.gap);
      EXPECT_NEAR(found.rim.slope, rim.slope, 1e-9);
    }
  }
}

// --- which drops overlap ---

// A disc of about half the patch meets rows of cells from both sides.
TEST(DropHashes, FindEveryOverlapOfADiscOfHalfThePatch) {
  RandomStream random(7, "wide discs of a test", 0);
  const Grid patch{64, 64, 10e-6, 10e-6};
  std::vector<capillary::Drop> drops(60);
  for (capillary::Drop& d : drops) {
    d.x = random.uniform(0, patch.lx), d.y = random.uniform(0, patch.ly);
    d.radius = 0.1e-6;
  }
  capillary::DropHash hash(patch);
  hash.build(drops);
  for (int k = 0; k < 5000; ++k) {
    capillary::Drop d;
    d.x = random.uniform(0, patch.lx), d.y = random.uniform(0, patch.ly);
    d.radius = random.uniform(3.5e-6, 6e-6);
    std::vector<int> found, expected;
    hash.collect_overlaps(d, found);
    std::sort(found.begin(), found.end());
    for (int i = 0; i < static_cast<int>(drops.size()); ++i) {
      const capillary::Drop& o = drops[static_cast<std::size_t>(i)];
      if (std::hypot(capillary::nearest_image(d.x - o.x, patch.lx),
                     capillary::nearest_image(d.y - o.y, patch.ly)) < d.radius + o.radius)
        expected.push_back(i);
    }
    ASSERT_EQ(found, expected) << k;
  }
}

TEST(DropHashes, FindEveryOverlapThatAComparisonOfAllFinds) {
  RandomStream random(6, "drops of a test", 0);
  std::vector<capillary::Drop> drops(150);
  for (std::size_t i = 0; i < drops.size(); ++i) {
    drops[i].x = random.uniform(0, kGrid.lx);
    drops[i].y = random.uniform(0, kGrid.ly);
    drops[i].radius = i < 3 ? 1.5e-6 : random.uniform(0.02e-6, 0.25e-6);
  }
  capillary::DropHash hash(kGrid);
  hash.build(drops);
  const auto overlapped = [&](const capillary::Drop& d, const std::vector<int>& known) {
    std::vector<int> out = known;
    for (int i = 0; i < static_cast<int>(drops.size()); ++i) {
      const capillary::Drop& o = drops[static_cast<std::size_t>(i)];
      const double dx = capillary::nearest_image(d.x - o.x, kGrid.lx),
                   dy = capillary::nearest_image(d.y - o.y, kGrid.ly);
      if (std::hypot(dx, dy) < d.radius + o.radius &&
          std::find(known.begin(), known.end(), i) == known.end())
        out.push_back(i);
    }
    std::sort(out.begin(), out.end());
    return out;
  };
  const auto found = [&](const capillary::Drop& d, std::vector<int> members) {
    hash.collect_overlaps(d, members);
    std::sort(members.begin(), members.end());
    return members;
  };
  const auto expect_all = [&] {
    for (int k = 0; k < 120; ++k) {
      capillary::Drop d;
      d.x = random.uniform(0, kGrid.lx), d.y = random.uniform(0, kGrid.ly);
      d.radius = random.uniform(0.02e-6, k % 10 == 0 ? 2e-6 : 0.4e-6);
      ASSERT_EQ(found(d, {}), overlapped(d, {})) << k;
      ASSERT_EQ(found(d, {k}), overlapped(d, {k})) << k;
    }
  };
  expect_all();
  for (int i = 0; i < 150; i += 7) {  // taken out, changed, put back
    capillary::Drop& d = drops[static_cast<std::size_t>(i)];
    hash.unlink(i, d);
    d.x = random.uniform(0, kGrid.lx), d.y = random.uniform(0, kGrid.ly);
    d.radius = random.uniform(0.02e-6, 0.8e-6);
    hash.link(i, d);
  }
  expect_all();
}

TEST(Discs, CoverThePixelsWhoseCentresTheyHold) {
  for (const auto& [x, y, radius] : kDiscs) {
    const double px = capillary::into_period(x, kGrid.lx), py = capillary::into_period(y, kGrid.ly);
    std::vector<int> times(kGrid.size());
    capillary::for_pixels(kGrid, {px, py, radius}, [&](std::size_t i) { ++times[i]; });
    for (std::size_t i = 0; i < times.size(); ++i) {
      const double way = std::sqrt(capillary::square_distance(kGrid, i, px, py));
      ASSERT_EQ(times[i], way < radius ? 1 : 0) << i << " " << way / radius;
    }
    const std::size_t pixel = capillary::pixel_of(kGrid, px, py);
    EXPECT_LE(capillary::square_distance(kGrid, pixel, px, py),
              square(0.5 * kGrid.dx()) + square(0.5 * kGrid.dy()) + 1e-20);
  }
}

// --- units and sides of whole answers ---

Gap rough_gap() {
  Gap gap = smooth_gap();
  RandomStream random(8, "rough gap of a test", 0);
  for (double& g : gap.value) g = std::max(0.0, 0.5 * g - 60e-9 + 40e-9 * random.uniform());
  return gap;
}

// Lengths times two, tension times three: forces times six, energies times twelve.
TEST(WaterUnits, LengthsAndTensionsScaleOut) {
  const Gap gap = rough_gap();
  Gap large = gap;
  large.grid.lx *= 2, large.grid.ly *= 2;
  for (double& g : large.value) g *= 2;
  DropletOptions options, wide;
  wide.drops_per_volume = options.drops_per_volume / 8;
  wide.first_step = 2 * options.first_step;
  wide.gap_floor = 2 * options.gap_floor;
  wide.film_width = 2 * options.film_width;
  WaterProperties water, heavy;
  heavy.surface_tension = 3 * water.surface_tension;
  for (const double volume : {0.3e-18, 1.2e-18}) {
    SettleReport a_report, b_report;
    const Wetting a = settle_droplets(gap, volume, water, options, 5, 2, &a_report),
                  b = settle_droplets(large, 8 * volume, heavy, wide, 5, 2, &b_report);
    ASSERT_EQ(a.status, b.status);
    ASSERT_EQ(a.droplets.size(), b.droplets.size());
    EXPECT_GE(a.bridges, 1);
    EXPECT_EQ(a.bridges, b.bridges);
    EXPECT_EQ(a.bridged, b.bridged);
    EXPECT_NEAR(b.capillary_force, 6 * a.capillary_force, 1e-6 * std::abs(6 * a.capillary_force));
    EXPECT_NEAR(b.retention, 6 * a.retention, 1e-6 * 6 * a.retention);
    EXPECT_NEAR(b.bridge_volume, 8 * a.bridge_volume, 1e-6 * 8 * a.bridge_volume);
    EXPECT_NEAR(b.wetted_fraction, a.wetted_fraction, 1e-9);
    EXPECT_NEAR(b_report.final_energy, 12 * a_report.final_energy,
                1e-6 * std::abs(12 * a_report.final_energy));
    EXPECT_EQ(a_report.moves, b_report.moves);
    EXPECT_EQ(a_report.merges, b_report.merges);
    for (std::size_t i = 0; i < a.droplets.size(); ++i) {
      EXPECT_NEAR(b.droplets[i].radius, 2 * a.droplets[i].radius, 1e-6 * b.droplets[i].radius);
      EXPECT_NEAR(b.droplets[i].height, 2 * a.droplets[i].height, 1e-6 * b.droplets[i].height);
      EXPECT_NEAR(b.droplets[i].edge_gap, 2 * a.droplets[i].edge_gap, 1e-12);
    }
    // As pressures on the skin: 3/2 of the smaller one's.
    const Traction ta = capillary_traction(a, gap, water), tb = capillary_traction(b, large, heavy);
    for (std::size_t i = 0; i < ta.value.size(); ++i)
      ASSERT_NEAR(tb.value[i], 1.5 * ta.value[i], 1e-5 * (1 + std::abs(tb.value[i])));
  }
}

// The least level below which the gap holds the water; its force by hand; on any side.
TEST(ThresholdWater, FillsTheLeastGapsWhereverTheyAre) {
  const Gap gap = smooth_gap();
  const WaterProperties water;
  const double volume = 0.4e-18;
  const Wetting own = fill_threshold(gap, volume, water);
  ASSERT_EQ(own.status, WettingStatus::Film);
  double held = 0, highest = 0, lowest_dry = 1, wet = 0;
  for (std::size_t i = 0; i < gap.value.size(); ++i) {
    if (own.bridged[i]) {
      held += gap.value[i] * kGrid.pixel_area();
      highest = std::max(highest, gap.value[i]);
      wet += 1;
    } else {
      lowest_dry = std::min(lowest_dry, gap.value[i]);
    }
  }
  EXPECT_LE(highest, lowest_dry);
  EXPECT_NEAR(held, volume, 0.02 * volume);
  EXPECT_NEAR(own.wetted_fraction, wet / static_cast<double>(kGrid.size()), 0.01);
  EXPECT_NEAR(own.volume, volume, 1e-6 * volume);
  const double pressure_force = water.surface_tension *
                                capillary::wetting_gain(water.theta_skin, water.theta_substrate) *
                                own.wetted_fraction * kGrid.area() / (0.5 * (highest + lowest_dry));
  EXPECT_GT(own.capillary_force, pressure_force * 0.95);  // and the rim beside it
  EXPECT_LT(own.capillary_force, pressure_force * 1.6);
  const Grid turned{kGrid.ny, kGrid.nx, kGrid.ly, kGrid.lx};
  struct Case {
    Grid grid;
    std::function<std::size_t(int, int)> from;
  };
  for (const Case& c :
       {Case{turned, [](int ix, int iy) { return kGrid.index(iy, ix); }},
        Case{kGrid, [](int ix, int iy) { return kGrid.index(59 - ix, iy); }},
        Case{kGrid, [](int ix, int iy) { return kGrid.index((ix + 31) % 60, (iy + 20) % 36); }}}) {
    Gap other{c.grid, std::vector<double>(gap.value.size())};
    for (int iy = 0; iy < c.grid.ny; ++iy) {
      for (int ix = 0; ix < c.grid.nx; ++ix)
        other.value[c.grid.index(ix, iy)] = gap.value[c.from(ix, iy)];
    }
    const Wetting w = fill_threshold(other, volume, water);
    EXPECT_NEAR(w.capillary_force, own.capillary_force, 1e-6 * own.capillary_force);
    EXPECT_NEAR(w.retention, own.retention, 0.02 * own.retention);
    EXPECT_EQ(w.bridges, own.bridges);
    EXPECT_NEAR(w.wetted_fraction, own.wetted_fraction, 1e-9);
    for (int iy = 0; iy < c.grid.ny; ++iy) {
      for (int ix = 0; ix < c.grid.nx; ++ix)
        ASSERT_EQ(w.bridged[c.grid.index(ix, iy)], own.bridged[c.from(ix, iy)]);
    }
  }
}

// Regions hang together over sides and the border, not over corners.
TEST(Regions, AreJoinedBySidesAndOverTheBorder) {
  const Grid grid{6, 5, 1, 1};
  const auto regions = [&](const std::vector<std::pair<int, int>>& wet) {
    std::vector<std::uint8_t> mask(grid.size());
    for (const auto& [ix, iy] : wet) mask[grid.index(ix, iy)] = 1;
    std::vector<int> label;
    const int count = capillary::label_regions(grid, mask, label);
    EXPECT_EQ(label.size(), grid.size());
    for (std::size_t i = 0; i < label.size(); ++i) {
      EXPECT_EQ(label[i] > 0, mask[i] != 0);
      EXPECT_LE(label[i], count);
    }
    return count;
  };
  EXPECT_EQ(regions({}), 0);
  EXPECT_EQ(regions({{2, 2}}), 1);
  EXPECT_EQ(regions({{2, 2}, {3, 3}}), 2);
  EXPECT_EQ(regions({{2, 2}, {3, 2}, {3, 3}}), 1);
  EXPECT_EQ(regions({{0, 1}, {5, 1}}), 1);
  EXPECT_EQ(regions({{4, 0}, {4, 4}}), 1);
  EXPECT_EQ(regions({{0, 0}, {5, 4}}), 2);
  EXPECT_EQ(regions({{0, 0}, {2, 0}, {4, 0}, {0, 2}, {2, 2}, {4, 2}}), 6);
}

}  // namespace
}  // namespace papilla::tests::invariants_test
