// What the water piece costs and how far its options move it. Prints tables; run by hand:
// ninja -C build water_bench && build/tests/water_bench
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "base/constants.h"
#include "base/statistics.h"
#include "geometry/roughness.h"
#include "physics/capillary/bridge_table.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/threshold.h"

namespace {

using namespace papilla;

template <class Work>
double seconds(int repeats, Work&& work) {
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < repeats; ++k) work(k);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / repeats;
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

void bridges() {
  const double t1 = 80 * kPi / 180, t2 = 50 * kPi / 180;
  volatile double sink = 0;
  fmt::print("exact bridge, cold        {:8.1f} us\n",
             1e6 * seconds(200, [&](int k) {
               sink = solve_bridge(1, 0.05 + 0.004 * k, t1, t2, 1).force;
             }));
  fmt::print("stability limits          {:8.2f} ms\n",
             1e3 * seconds(20, [&](int) { sink = bridge_limits(t1, t2).rupture; }));
  fmt::print("building one table        {:8.2f} ms\n",
             1e3 * seconds(10, [&](int) { sink = BridgeTable(t1, t2)(0.5).force; }));
  const BridgeTable table(t1, t2);
  double sum = 0;
  const double time = seconds(1000000, [&](int k) {
    const auto v = table(0.05 + 0.9e-6 * k);
    sum += v.energy + v.force;
  });
  sink = sum;
  fmt::print("table, energy and force   {:8.1f} ns\n\n", 1e9 * time);
}

void members() {
  fmt::print("members: 5 um3 in 12 x 12 um, larger patches at the same density and pixel\n");
  fmt::print("  droplets  pixels   ms/member  us/droplet\n");
  struct Case {
    int pixels;
    double side, volume;
  };
  for (const Case& c : {Case{128, 12e-6, 1e-18}, Case{128, 12e-6, 5e-18}, Case{256, 12e-6, 5e-18},
                        Case{256, 24e-6, 20e-18}, Case{572, 53.66e-6, 100e-18}}) {
    const Gap gap = rough_gap(c.pixels, c.side, 1);
    settle_droplets(gap, c.volume, {}, {}, 1, 0);
    const double time = seconds(c.volume > 10e-18 ? 3 : 10, [&](int k) {
      settle_droplets(gap, c.volume, {}, {}, 1, static_cast<std::uint64_t>(k));
    });
    fmt::print("  {:8.0f}  {:5}^2  {:9.2f}  {:9.2f}\n", c.volume * 100e18, c.pixels, 1e3 * time,
               1e6 * time / (c.volume * 100e18));
  }
}

void options() {
  fmt::print("\ncapillary force [uN] over 24 rough gaps (128^2), 80/50 deg\n");
  fmt::print(
      "  water um3   default        step 50 nm     step 800 nm    25 per um3     300 per um3  "
      "  last step 3 nm  threshold, same bridge water\n");
  std::vector<Gap> gaps;
  for (int k = 0; k < 24; ++k) gaps.push_back(rough_gap(128, 12e-6, static_cast<std::uint64_t>(k)));
  for (double volume : {0.36e-18, 1.8e-18, 8.8e-18}) {
    fmt::print("  {:9.2f}", volume * 1e18);
    DropletOptions small, large, few, many, fine;
    small.first_step = 50e-9;
    small.halvings = 2;
    large.first_step = 800e-9;
    large.halvings = 6;
    few.drops_per_volume = 25e18;
    many.drops_per_volume = 300e18;
    fine.halvings = 6;
    std::vector<double> film(gaps.size());
    bool first = true;
    for (const DropletOptions& o : {DropletOptions{}, small, large, few, many, fine}) {
      std::vector<double> force(gaps.size());
      for (std::size_t k = 0; k < gaps.size(); ++k) {
        const Wetting w = settle_droplets(gaps[k], volume, {}, o, 1, k);
        force[k] = w.capillary_force * 1e6;
        if (first) film[k] = fill_threshold(gaps[k], w.bridge_volume, {}).capillary_force * 1e6;
      }
      first = false;
      const Estimate mean = mean_estimate(force);
      fmt::print("  {:6.2f} ±{:4.2f} ", mean.value, mean.se);
    }
    const Estimate mean = mean_estimate(film);
    fmt::print("  {:6.2f} ±{:4.2f}\n", mean.value, mean.se);
  }
}

}  // namespace

int main() {
  bridges();
  members();
  options();
  return 0;
}
