// How contact solves grow: time and memory with the grid, threads over independent solves.
//     contact_scaling_bench [largest grid, default 4096] > results/bench/contact_scaling.csv
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "base/memory.h"
#include "base/parallel.h"
#include "geometry/roughness.h"
#include "physics/contact/contact.h"
#include "scene/finger.h"

namespace papilla::tests {
namespace {

double wall() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Of this process alone: other work on the machine does not count.
double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// A line of this process's status, in bytes.
double status_bytes(const std::string& key) {
  std::ifstream file("/proc/self/status");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind(key, 0) == 0) return 1024 * std::strtod(line.c_str() + key.size(), nullptr);
  }
  return 0;
}

// The peak starts again from what is held now.
void reset_peak() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

LayeredSolid solid_of(const Skin& s) {
  return {s.layer_modulus, s.layer_poisson, s.layer_thickness, s.bulk_modulus, s.bulk_poisson};
}

Spectrum spectrum_of(const Skin& s) { return {s.rms, s.roll_off, s.hurst, s.cutoff}; }

// The reference finger's skin at its patch pressure, one cold solve to 1e-5 a grid.
void grids(int largest) {
  const Finger finger;
  fmt::print(
      "grid,contact,pairs,seconds,pair_seconds,ns_per_pixel_pair_log2,kernel_bytes_per_pixel,peak_"
      "bytes_per_pixel\n");
  for (int n = 256; n <= largest; n *= 2) {
    const Grid grid{n, n, 12e-6, 12e-6};
    const auto pixels = static_cast<double>(grid.size());
    reset_peak();
    const double before = status_bytes("VmRSS:");
    double pair = std::numeric_limits<double>::infinity(), seconds = 0, held = 0;
    ContactSolution s;
    {
      const ContactKernel kernel(grid, solid_of(finger.skin));
      held = status_bytes("VmRSS:") - before;
      const Heightmap h = random_surface(spectrum_of(finger.skin), grid, 1, 0);
      {
        RealArray p(grid.size(), 1.0), u(grid.size());
        SpectrumArray scratch(kernel.scratch_size());
        for (int k = 0; k < 3; ++k) {
          const double start = now();
          kernel.displace(p, u, scratch);
          pair = std::min(pair, now() - start);
        }
      }
      reset_peak();
      const double start = now();
      s = solve_contact(kernel, h.z, finger.patch_pressure(0.15), {}, {.tolerance = 1e-5});
      seconds = now() - start;
    }
    const double peak = status_bytes("VmHWM:") - before;
    double contact = 0;
    for (double p : s.pressure) contact += p > 0 ? 1 / pixels : 0;
    fmt::print("{},{:.4f},{:.1f},{:.4f},{:.5f},{:.3f},{:.0f},{:.0f}\n", n, contact, s.fft_pairs,
               seconds, pair, 1e9 * seconds / (s.fft_pairs * pixels * std::log2(pixels)),
               held / pixels, peak / pixels);
    std::fflush(stdout);
  }
}

// 32 solves of different skins at 256^2 on 1 and 2 threads, the best of three.
void threads() {
  const Finger finger;
  const Grid grid{256, 256, 12e-6, 12e-6};
  const auto kernel = make_contact_kernel(grid, solid_of(finger.skin));
  constexpr int kSolves = 32;
  std::vector<Heightmap> skin;
  for (int k = 0; k < kSolves; ++k) {
    skin.push_back(
        random_surface(spectrum_of(finger.skin), grid, 1, static_cast<std::uint64_t>(k)));
  }
  double one = 0;
  for (int count : {1, 2}) {
    double best = std::numeric_limits<double>::infinity();
    for (int repeat = 0; repeat < 3; ++repeat) {
      const double start = wall();
      parallel_for(
          kSolves,
          [&](int k) {
            solve_contact(*kernel, skin[static_cast<std::size_t>(k)].z, finger.patch_pressure(0.15),
                          {}, {.tolerance = 1e-5});
          },
          count);
      best = std::min(best, wall() - start);
    }
    if (count == 1) one = best;
    fmt::print("# {} threads: {} solves of 256^2 in {:.3f} s, {:.2f} times one thread\n", count,
               kSolves, best, one / best);
  }
}

}  // namespace
}  // namespace papilla::tests

int main(int argc, char** argv) {
  papilla::tests::grids(argc > 1 ? std::atoi(argv[1]) : 4096);
  papilla::tests::keep_freed_memory();
  papilla::tests::threads();
}
