// The pieces that both solvers are made of, each alone: the small set with an exact answer, the
// level that carries a load, interpolation, the start from half the pixels, pixels to watch.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "physics/contact/active_set.h"
#include "physics/contact/candidates.h"
#include "physics/contact/cubic.h"
#include "physics/contact/dense_fields.h"
#include "physics/contact/solvers.h"

namespace papilla::tests::pieces_test {
namespace {

using namespace papilla::contact;

const LayeredSolid kHalfSpace{1e6, 0, 0, 1e6, 0};  // E* = 1 MPa

// Catmull and Rom's weights by hand: a quarter of a coarse pixel to either side of its middle, and
// 1/3 off it.
TEST(Cubic, HasItsWeightsAndTakesUpTheCoarsePixelsAround) {
  const Cubic even = cubic(6, 2, 8), odd = cubic(7, 2, 8);  // at 2.75 and 3.25 coarse pixels
  const double near[4] = {-0.0234375, 0.2265625, 0.8671875, -0.0703125};
  EXPECT_EQ(even.first, 1);
  EXPECT_EQ(odd.first, 2);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(even.weight[k], near[k], 1e-15) << k;
    EXPECT_NEAR(odd.weight[k], near[3 - k], 1e-15) << k;
  }
  EXPECT_EQ(cubic(0, 2, 8).first, 6);   // at -0.25: from -2 on
  EXPECT_EQ(cubic(1, 2, 8).first, 7);   // at 0.25
  EXPECT_EQ(cubic(15, 2, 8).first, 6);  // at 7.25
  const Cubic third = cubic(5, 3, 8);   // at 4/3
  EXPECT_EQ(third.first, 0);
  const double thirds[4] = {-2.0 / 27, 7.0 / 9, 1.0 / 3, -1.0 / 27};
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(third.weight[k], thirds[k], 1e-15) << k;
}

TEST(Cubic, ParabolasAreInterpolatedAsTheyAre) {
  const Grid coarse{12, 10, 12, 10};
  std::vector<double> field(coarse.size());
  const auto value = [](double x, double y) {
    return 3 + x - 2 * y + 0.5 * x * x - 0.3 * x * y + 0.2 * y * y;
  };
  for (int iy = 0; iy < 10; ++iy) {
    for (int ix = 0; ix < 12; ++ix) field[coarse.index(ix, iy)] = value(ix, iy);
  }
  for (int iy = 6; iy < 14; ++iy) {  // where no weight reaches across the border
    for (int ix = 5; ix < 18; ++ix) {
      EXPECT_NEAR(interpolate(field, coarse, cubic(ix, 2, 12), cubic(iy, 2, 10)),
                  value(0.5 * ix - 0.25, 0.5 * iy - 0.25), 1e-12)
          << ix << " " << iy;
    }
  }
}

// Pressures on `pixels`, all touching, and the shift, under a load: elimination of the whole
// system.
std::vector<double> touching_all(const ContactKernel& kernel, const std::vector<int>& pixels,
                                 const std::vector<double>& gap, double load) {
  const std::size_t m = pixels.size();
  const Grid& grid = kernel.grid();
  std::vector<std::vector<double>> a(m + 1, std::vector<double>(m + 2, 0.0));
  for (std::size_t r = 0; r < m; ++r) {
    for (std::size_t c = 0; c < m; ++c) {
      a[r][c] = kernel.influence(wrap(pixels[r] % grid.nx - pixels[c] % grid.nx, grid.nx),
                                 wrap(pixels[r] / grid.nx - pixels[c] / grid.nx, grid.ny));
    }
    a[r][m] = -1;
    a[r][m + 1] = -gap[r];
    a[m][r] = 1;
  }
  a[m][m + 1] = load;
  for (std::size_t k = 0; k <= m; ++k) {
    std::size_t best = k;
    for (std::size_t r = k + 1; r <= m; ++r)
      if (std::abs(a[r][k]) > std::abs(a[best][k])) best = r;
    std::swap(a[k], a[best]);
    for (std::size_t r = 0; r <= m; ++r) {
      if (r == k) continue;
      const double f = a[r][k] / a[k][k];
      for (std::size_t c = k; c < m + 2; ++c) a[r][c] -= f * a[k][c];
    }
  }
  std::vector<double> x;
  for (std::size_t k = 0; k <= m; ++k) x.push_back(a[k][m + 1] / a[k][k]);
  return x;
}

// Six pixels on an oblong grid, some of them across its border: of the 63 sets that may touch the
// one whose pressures push and whose other pixels do not penetrate.
TEST(ActiveSet, FindsTheOneSetThatPushesAndDoesNotPenetrate) {
  const Grid grid{20, 12, 2e-6, 1.8e-6};
  const ContactKernel kernel(grid, {2e6, 0.3, 2e-7, 1e6, 0.4});
  const std::vector<int> pixels{1, 18, 21, 47, 130, 221};  // ascending
  RandomStream random(4, "gaps", 0);
  std::vector<int> sizes(7);
  for (int k = 0; k < 40; ++k) {
    std::vector<double> gap;
    for (int i = 0; i < 6; ++i) gap.push_back(random.uniform(-1e-9, 1e-9));
    const double load = std::pow(10, random.uniform(2, 4));
    std::vector<double> pressure(6, 0.0);
    double shift = 0;
    int found = 0;
    for (int set = 1; set < 64; ++set) {
      std::vector<int> in;
      std::vector<double> in_gap;
      for (int i = 0; i < 6; ++i) {
        if (!(set >> i & 1)) continue;
        in.push_back(pixels[static_cast<std::size_t>(i)]);
        in_gap.push_back(gap[static_cast<std::size_t>(i)]);
      }
      const std::vector<double> x = touching_all(kernel, in, in_gap, load);
      bool good = *std::min_element(x.begin(), x.end() - 1) > 0;
      for (std::size_t i = 0; i < 6; ++i) {
        if (set >> i & 1) continue;
        double v = gap[i] - x.back();
        for (std::size_t j = 0; j < in.size(); ++j)
          v += x[j] * kernel.influence(wrap(pixels[i] % 20 - in[j] % 20, 20),
                                       wrap(pixels[i] / 20 - in[j] / 20, 12));
        good = good && v >= 0;
      }
      if (!good) continue;
      ++found;
      shift = x.back();
      std::size_t at = 0;
      for (std::size_t i = 0; i < 6; ++i) pressure[i] = set >> i & 1 ? x[at++] : 0;
    }
    ASSERT_EQ(found, 1);
    const auto count = static_cast<std::size_t>(
        std::count_if(pressure.begin(), pressure.end(), [](double p) { return p > 0; }));
    ++sizes[count];
    for (const bool all : {true, false}) {  // from every pixel, and from one
      ActiveSet set(kernel);
      std::vector<std::pair<int, bool>> members;
      for (const int i : {3, 0, 5, 2, 4, 1})
        members.emplace_back(pixels[static_cast<std::size_t>(i)], all || i == 2);
      set.watch(members, [&](int pixel) {
        return gap[static_cast<std::size_t>(std::find(pixels.begin(), pixels.end(), pixel) -
                                            pixels.begin())];
      });
      ASSERT_TRUE(set.balance(load, 1e-16, 6));
      ASSERT_EQ(set.size(), 6u);
      EXPECT_NEAR(set.shift(), shift, 1e-9 * std::abs(shift) + 1e-18);
      EXPECT_EQ(set.touching().size(), count);
      for (std::size_t i = 0; i < 6; ++i) {
        EXPECT_EQ(set.pixel(i), pixels[i]);
        EXPECT_EQ(set.touches(i), pressure[i] > 0);
        EXPECT_NEAR(set.pressure(i), pressure[i], 1e-8 * load);
        double v = gap[i] - shift;
        for (std::size_t j = 0; j < 6; ++j)
          v += pressure[j] * kernel.influence(wrap(pixels[i] % 20 - pixels[j] % 20, 20),
                                              wrap(pixels[i] / 20 - pixels[j] / 20, 12));
        EXPECT_NEAR(set.gap(i), v, 1e-17);
      }
    }
  }
  EXPECT_GT(sizes[1], 0);  // few and many
  EXPECT_GT(sizes[4] + sizes[5] + sizes[6], 0);
}

TEST(ActiveSet, KeepsEachPixelOnceAndKnowsWhenItGivesUp) {
  const ContactKernel kernel({20, 12, 2e-6, 1.8e-6}, kHalfSpace);
  ActiveSet set(kernel);
  // A pixel listed twice touches if either does.
  std::vector<std::pair<int, bool>> members{{40, false}, {7, true},  {40, true},
                                            {9, false},  {7, false}, {9, false}};
  set.watch(members, [](int) { return 0.0; });
  ASSERT_EQ(set.size(), 3u);
  EXPECT_EQ(set.find(7), 0u);
  EXPECT_EQ(set.find(9), 1u);
  EXPECT_EQ(set.find(40), 2u);
  for (const int none : {0, 8, 41, 239}) EXPECT_EQ(set.find(none), 3u) << none;
  EXPECT_TRUE(set.touches(0));
  EXPECT_FALSE(set.touches(1));
  EXPECT_TRUE(set.touches(2));
  EXPECT_FALSE(set.balance(1e3, 0, 1));  // two touch
  EXPECT_FALSE(set.balance(1e3, 0, 2));  // the third penetrates and joins
  EXPECT_TRUE(set.balance(1e3, 0, 3));
  EXPECT_NEAR(set.pressure(0) + set.pressure(1) + set.pressure(2), 1e3, 1e-9);
  // What penetrates less than the slack stays apart.
  members = {{40, true}, {41, false}};
  const double deep =
      1e3 * (kernel.self_compliance() - kernel.influence(1, 0));  // of one under all
  for (const double slack : {1.01, 0.99}) {
    members = {{40, true}, {41, false}};
    set.watch(members, [](int) { return 0.0; });
    ASSERT_TRUE(set.balance(1e3, slack * deep, 2));
    EXPECT_EQ(set.touches(1), slack < 1);
    EXPECT_NEAR(set.pressure(1), slack < 1 ? 500 : 0, 1e-9);
  }
  members = {{40, false}};
  set.watch(members, [](int) { return 0.0; });
  EXPECT_FALSE(set.balance(1e3, 0, 5));  // nothing touches
}

// The sum of what is cut at 0 and the cap falls with the level: by halves.
TEST(LoadLevel, CarriesTheLoad) {
  RandomStream random(8, "level", 0);
  const auto carried = [](const std::vector<double>& raw, const std::vector<double>& ones,
                          double cap, double level) {
    double sum = 0;
    for (std::size_t k = 0; k < raw.size(); ++k)
      sum += std::clamp(raw[k] - level * (ones.empty() ? 1 : ones[k]), 0.0, cap);
    return sum;
  };
  for (int k = 0; k < 200; ++k) {
    const std::size_t n = 3 + static_cast<std::size_t>(random.below(30));
    const bool weighted = k % 2 == 0, capped = k % 3 == 0, barred = k % 5 == 0;
    const double lift = k % 7 == 0 ? -30 : k % 7 == 1 ? 30 : 0;  // far from the level of 0
    std::vector<double> raw, ones;
    for (std::size_t i = 0; i < n; ++i) {
      raw.push_back(random.normal() + lift);
      if (weighted) ones.push_back(random.uniform(0.2, 3));
    }
    const double cap = capped ? 0.8 : kInfinity;
    if (barred && capped) raw[0] = kBarred;
    if (barred) raw[1] = -kBarred;
    const double held = barred && capped ? cap : 0, most = static_cast<double>(n - 2) * 0.8;
    const double load = held + random.uniform(0.05, 0.9) * (capped ? most : 5);
    const double level = load_level(raw, ones, cap, load, load);
    EXPECT_NEAR(carried(raw, ones, cap, level), load, 1e-12 * load) << k << " " << n << " " << lift;
    double low = -200, high = 200;
    for (int i = 0; i < 100; ++i) {
      const double middle = 0.5 * (low + high);
      (carried(raw, ones, cap, middle) > load ? low : high) = middle;
    }
    EXPECT_NEAR(level, low, 1e-10) << k;
  }
}

TEST(RoomOf, IsHowOftenAStepFitsBetweenTheBounds) {
  EXPECT_DOUBLE_EQ(room_of<double>(-2, 3, 10), 2.5);  // from 5 down to 0
  EXPECT_DOUBLE_EQ(room_of<double>(2, 3, 10), 4.5);   // from 1 up to 10
  EXPECT_DOUBLE_EQ(room_of<double>(-2, 0, 10), 1);    // to the bound
  EXPECT_DOUBLE_EQ(room_of<double>(4, 10, 10), 1);
  EXPECT_EQ(room_of<double>(0, 3, 10), kInfinity);
  EXPECT_EQ(room_of<double>(2, 3, kInfinity), kInfinity);
}

// Each block of four carries what its pixel of the coarser grid does, as springs of a pixel's own
// compliance at their heights: those that carry reach one level, the others lie above it.
TEST(NestedStart, SharesTheCoarseLoadAmongFourSprings) {
  const Grid grid{64, 96, 2e-6, 2.5e-6};
  const auto kernel = make_contact_kernel(grid, {3e6, 0.3, 2e-7, 1e6, 0.4});
  ASSERT_TRUE(kernel->coarse());
  RandomStream random(2, "nested", 0);
  std::vector<double> height(grid.size());
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix)
      height[grid.index(ix, iy)] =
          1e-8 * std::cos(2 * kPi * ix / 64) * std::cos(4 * kPi * iy / 96) +
          2e-9 * random.uniform();
  }
  RealArray gap(grid.size());
  for (std::size_t i = 0; i < gap.size(); ++i) gap[i] = -height[i];
  const Grid half{32, 48, 2e-6, 2.5e-6};
  std::vector<double> top(half.size());
  for (int iy = 0; iy < 48; ++iy) {
    for (int ix = 0; ix < 32; ++ix) {
      top[half.index(ix, iy)] = std::max(
          {height[grid.index(2 * ix, 2 * iy)], height[grid.index(2 * ix + 1, 2 * iy)],
           height[grid.index(2 * ix, 2 * iy + 1)], height[grid.index(2 * ix + 1, 2 * iy + 1)]});
    }
  }
  const double load = 2e3 * 6144, cap = 4e4;
  for (const int kind : {0, 1, 2}) {  // load, load below a cap, approach
    StandardProblem problem{*kernel, height, {}, 5e-9, load};
    StandardProblem coarse{*kernel->coarse(), top, {}, 5e-9, load / 4};
    if (kind == 1) problem.cap = coarse.cap = cap;
    if (kind == 2) problem.approach = coarse.approach = true, problem.level = coarse.level = -7e-9;
    double pairs = 3;
    const std::vector<double> start = nested_start(problem, gap, 1e-6, pairs);
    const StandardState state = solve_dense(coarse, 2e-2, 200, {});  // as far as it is worth
    EXPECT_DOUBLE_EQ(pairs, 3 + 0.25 * state.pairs) << kind;
    int shared = 0, all_four = 0;
    for (int iy = 0; iy < 48; ++iy) {
      for (int ix = 0; ix < 32; ++ix) {
        double sum = 0, low = kInfinity, high = -kInfinity, apart = kInfinity;
        int carrying = 0;
        for (int k = 0; k < 4; ++k) {
          const std::size_t i = grid.index(2 * ix + k % 2, 2 * iy + k / 2);
          ASSERT_GE(start[i], 0);
          sum += start[i];
          if (start[i] > 0) {
            const double reached = gap[i] + start[i] * kernel->self_compliance();
            low = std::min(low, reached), high = std::max(high, reached);
            ++carrying;
          } else {
            apart = std::min(apart, gap[i]);
          }
        }
        const double p = state.p[half.index(ix, iy)];
        ASSERT_NEAR(sum, 4 * p, 1e-9 * (load / 6144 + p)) << kind << " " << ix << " " << iy;
        if (carrying == 0) continue;
        EXPECT_NEAR(low, high, 1e-18);
        EXPECT_GE(apart, high - 1e-18);
        shared += carrying > 1 && carrying < 4;
        all_four += carrying == 4;
      }
    }
    EXPECT_GT(shared, 10);
    EXPECT_GT(all_four, 0);
  }
  // A start that is asked for less accurately than that takes what is asked for.
  StandardProblem problem{*kernel, height, {}, 5e-9, load},
      coarse{*kernel->coarse(), top, {}, 5e-9, load / 4};
  double pairs = 0;
  nested_start(problem, gap, 0.5, pairs);
  EXPECT_DOUBLE_EQ(pairs, 0.25 * solve_dense(coarse, 0.5, 200, {}).pairs);
}

// Of fewer each is looked at: the lowest may stand in any order, every third pixel for one.
TEST(Candidates, OfASmallGridAreFoundWhereverTheyStand) {
  const Grid grid{96, 64, 8e-6, 5e-6};
  const ContactKernel kernel(grid, kHalfSpace);
  ContactSolution start;
  start.pressure.assign(grid.size(), 0.0);
  for (const std::size_t apart : {2, 3, 5}) {
    RealArray gap(grid.size(), 1e-8);
    for (std::size_t k = 0; k < 600; ++k) gap[apart * k] = 1e-12 * static_cast<double>(k);
    std::vector<double> height(gap.begin(), gap.end());
    start.gap = height;
    start.pressure.assign(grid.size(), 0.0);
    for (std::size_t k = 0; k < 200; ++k) start.pressure[apart * k] = 2;
    const auto near = watch_near({kernel, height, {}, 1, 400}, start, {300, false});
    ASSERT_TRUE(near);
    ASSERT_EQ(near->size(), 600u);
    for (std::size_t k = 0; k < 600; ++k) {
      ASSERT_EQ((*near)[k].first, static_cast<int>(apart * k));
      ASSERT_EQ((*near)[k].second, k < 200);
    }
  }
}

// More pixels than the sample of 8,192 holds: still the lowest, every one of them, in order.
TEST(Candidates, OfALargeGridAreTheLowestOfAll) {
  const Grid grid{256, 160, 8e-6, 5e-6};
  const ContactKernel kernel(grid, kHalfSpace);
  RandomStream random(5, "candidates", 0);
  RealArray gap(grid.size());
  for (double& g : gap) g = 1e-8 * random.uniform();
  std::vector<double> height(gap.begin(), gap.end());
  std::vector<int> order;
  for (std::size_t i = 0; i < gap.size(); ++i) order.push_back(static_cast<int>(i));
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return gap[static_cast<std::size_t>(a)] < gap[static_cast<std::size_t>(b)];
  });
  // Slopes by differences of neighbours, in a row not across the border; in its last column not at
  // all.
  double slopes = 0;
  for (int iy = 0; iy < 160; ++iy) {
    for (int ix = 0; ix < 255; ++ix) {
      const double here = gap[grid.index(ix, iy)];
      slopes += square((gap[grid.index(ix + 1, iy)] - here) / grid.dx()) +
                square((gap[grid.index(ix, (iy + 1) % 160)] - here) / grid.dy());
    }
  }
  const double slope = std::sqrt(slopes / static_cast<double>(grid.size()));
  for (const double wanted : {40.5, 1000.5, 5000.5}) {
    const StandardProblem problem{kernel, height, {}, 1, wanted * 1e6 * slope / 8};
    const auto watched = watch_lowest(problem, gap, {6000, false});
    ASSERT_TRUE(watched);
    const auto count = static_cast<std::size_t>(wanted);
    ASSERT_EQ(watched->size(), count);
    for (std::size_t k = 0; k < count; ++k) {
      ASSERT_EQ((*watched)[k].first, order[k]) << k;
      ASSERT_EQ((*watched)[k].second, 2 * k <= count) << k;
    }
  }
}

}  // namespace
}  // namespace papilla::tests::pieces_test
