// What the water piece costs, prints results/bench/water.csv:
// ninja -C build/release water_bench && build/release/bench/water_bench > results/bench/water.csv
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

#include "base/constants.h"
#include "geometry/roughness.h"
#include "physics/capillary/bridge_table.h"
#include "physics/capillary/droplets.h"

namespace {

using namespace papilla::tests;

// Of the processor, on one thread: waiting for it does not count.
template <class Work>
double seconds(int repeats, Work&& work) {
  const std::clock_t start = std::clock();
  for (int k = 0; k < repeats; ++k) work(k);
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / repeats;
}

// A rough surface cut off where 3 % of it touches: mean gap about 1.9 rms.
Gap rough_gap(int pixels, double side, std::uint64_t index) {
  const Grid grid{pixels, pixels, side, side};
  Heightmap z = random_surface({.rms = 200e-9, .roll_off = 3.7e-6, .hurst = 0.8, .cutoff = 2e-7},
                               grid, 1, index);
  std::vector<double> sorted = z.z;
  const auto at = sorted.begin() + static_cast<long>(0.03 * static_cast<double>(sorted.size()));
  std::nth_element(sorted.begin(), at, sorted.end());
  for (double& v : z.z) v = std::max(0.0, v - *at);
  return {grid, std::move(z.z)};
}

// The least of several runs: other work on the machine only adds.
template <class Work>
double least(int runs, int repeats, Work&& work) {
  double best = 1e300;
  for (int r = 0; r < runs; ++r) best = std::min(best, seconds(repeats, work));
  return best;
}

void bridges() {
  const double t1 = 80 * kPi / 180, t2 = 50 * kPi / 180;
  volatile double sink = 0;
  const auto row = [](const char* what, double value, const char* unit, const char* target) {
    fmt::print("{},,,{:.3g},{},,,{}\n", what, value, unit, target);
  };
  row("exact bridge cold",
      1e6 * least(5, 40, [&](int k) { sink = solve_bridge(1, 0.05 + 0.02 * k, t1, t2, 1).force; }),
      "us", "");
  row("stability limits", 1e3 * least(3, 3, [&](int) { sink = bridge_limits(t1, t2).rupture; }),
      "ms", "");
  row("building one table", 1e3 * least(3, 2, [&](int) { sink = BridgeTable(t1, t2)(0.5).force; }),
      "ms", "");
  const BridgeTable table(t1, t2);
  double sum = 0;
  const double time = least(10, 200000, [&](int k) {
    const auto v = table(0.05 + 4.5e-6 * k);
    sum += v.energy + v.force;
  });
  sink = sum;
  row("table energy and force", 1e9 * time, "ns", "50 ns");
}

// The patch repeated: every droplet meets the same gaps, whatever the number of droplets.
Gap tiled(const Gap& gap, int times) {
  const Grid& one = gap.grid;
  const Grid grid{one.nx * times, one.ny * times, one.lx * times, one.ly * times};
  std::vector<double> value(grid.size());
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      value[grid.index(ix, iy)] = gap.value[one.index(ix % one.nx, iy % one.ny)];
    }
  }
  return {grid, std::move(value)};
}

// Members on four rough patches of one pixel and density (5 um3 in 12 x 12 um), each repeated times
// x times. Ten thousand droplets are timed at once, whatever their number in one member, so that
// other work on the machine disturbs all alike.
struct Case {
  int pixels, times;
  double side;
  const char *member_target, *droplet_target;
  std::vector<Gap> gaps = {};
  double volume = 0, droplets = 0;      // [m3]
  std::vector<double> time = {};        // the least of a droplet, per patch [s]
  double evaluations = 0, bridges = 0;  // a droplet

  void run() {
    const int n = static_cast<int>(gaps.size());
    const int members = std::max(1, static_cast<int>(std::lround(1e4 / droplets)));
    evaluations = bridges = 0;
    time.resize(gaps.size(), 1e300);
    const double each = 1 / (droplets * members);
    for (std::size_t g = 0; g < gaps.size(); ++g) {
      const auto one = [&](int k) {
        SettleReport report;
        const Wetting wetting =
            settle_droplets(gaps[g], volume, {}, {}, 1, static_cast<std::uint64_t>(k), &report);
        evaluations += each * static_cast<double>(report.evaluations) / n;
        bridges += each * wetting.bridges / n;
      };
      time[g] = std::min(time[g], seconds(members, one) / droplets);
    }
  }
  double droplet() const {
    double sum = 0;
    for (double t : time) sum += t / static_cast<double>(time.size());
    return sum;
  }
};

void members() {
  const double side = 12e-6 / std::sqrt(5.0);  // 100 droplets
  std::vector<Case> cases;
  for (int times : {1, 2, 3, 5, 10}) cases.push_back({57, times, side, "", "flat over droplets"});
  cases.push_back({256, 1, 12e-6, "10 ms", ""});
  for (Case& c : cases) {
    for (std::uint64_t k = 0; k < 4; ++k) {
      c.gaps.push_back(tiled(rough_gap(c.pixels, c.side, k), c.times));
    }
    c.volume = 5e-18 * square(c.side * c.times / 12e-6);
    c.droplets = c.volume * 100e18;
  }
  // In turns: what disturbs one disturbs all.
  for (int round = 0; round < 12; ++round) {
    for (Case& c : cases) c.run();
  }
  for (const Case& c : cases) {
    const int pixels = c.pixels * c.times;
    fmt::print("one member,{:.0f},{},{:.3g},ms,{:.2f},{:.3f},{}\n", c.droplets, pixels,
               1e3 * c.droplet() * c.droplets, c.evaluations, c.bridges, c.member_target);
    fmt::print("a droplet of it,{:.0f},{},{:.3g},us,,,{}\n", c.droplets, pixels, 1e6 * c.droplet(),
               c.droplet_target);
  }
}

}  // namespace

int main() {
  fmt::print(
      "what,droplets,pixels,value,unit,bridge_energies_per_droplet,bridges_per_droplet,target\n");
  bridges();
  members();
  return 0;
}
