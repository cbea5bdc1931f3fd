// What the water piece costs, prints results/bench/water.csv:
// ninja -C build water_bench && build/tests/water_bench > results/bench/water.csv
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

using namespace papilla;

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
    fmt::print("{},,,{:.3g},{},,{}\n", what, value, unit, target);
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

void members() {
  struct Case {
    int pixels;
    double side, volume;
  };
  // One density (5 um3 in 12 x 12 um) and pixel from 100 to 10,000 droplets; then the target's
  // case.
  const double side_one = 12e-6 / std::sqrt(5.0);
  std::vector<Case> cases;
  for (double volume : {1.0, 3.0, 10.0, 30.0, 100.0}) {
    const double side = side_one * std::sqrt(volume);
    cases.push_back({static_cast<int>(std::lround(side / 93.75e-9)), side, volume * 1e-18});
  }
  cases.push_back({256, 12e-6, 5e-18});
  for (const Case& c : cases) {
    const Gap gap = rough_gap(c.pixels, c.side, 1);
    const double droplets = c.volume * 100e18;
    long evaluations = 0;
    constexpr int kMembers = 4, kRuns = 6;
    const double time = least(kRuns, kMembers, [&](int k) {
      SettleReport report;
      settle_droplets(gap, c.volume, {}, {}, 1, static_cast<std::uint64_t>(k), &report);
      evaluations += report.evaluations;
    });
    fmt::print("one member,{:.0f},{},{:.3g},ms,{:.1f},{}\n", droplets, c.pixels, 1e3 * time,
               static_cast<double>(evaluations) / (kRuns * kMembers * droplets),
               c.pixels == 256 ? "10 ms" : "");
    fmt::print("a droplet of it,{:.0f},{},{:.3g},us,,{}\n", droplets, c.pixels,
               1e6 * time / droplets, c.pixels == 256 ? "" : "flat over droplets");
  }
}

}  // namespace

int main() {
  fmt::print("what,droplets,pixels,value,unit,bridge_energies_per_droplet,target\n");
  bridges();
  members();
  return 0;
}
