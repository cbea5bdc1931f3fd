// Cost of contact solves against their certificate: transform pairs, pair-times (processor time
// over that of one transform pair of the same grid by FFTW, measured beside) and seconds, beside a
// plain restarted Polonsky-Keer solver: on FFTW, as others build it, and on the kernel's own
// convolution.
//     contact_bench [all|finger|rough|sequence [smallest [largest grid]]] >
//     results/bench/contact.csv
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <limits>
#include <string>

#include "base/constants.h"
#include "base/memory.h"
#include "geometry/roughness.h"
#include "physics/contact/contact.h"
#include "scene/finger.h"

namespace papilla::tests {
namespace {

// Of this process alone: other work on the machine does not count.
double now() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

// u = S p by FFTW.
void displace_by_fftw(const ContactKernel& kernel, const RealArray& p, RealArray& u,
                      SpectrumArray& scratch) {
  kernel.fft().forward(p.data(), scratch.data());
  const std::vector<double>& symbol = kernel.symbol();
  for (std::size_t i = 0; i < symbol.size(); ++i) scratch[i] *= symbol[i];
  kernel.fft().inverse(scratch.data(), u.data());
}

double pair_time(const ContactKernel& kernel) {
  RealArray p(kernel.grid().size(), 1.0), u(kernel.grid().size());
  SpectrumArray scratch(kernel.fft().spectrum_size());
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 5; ++k) {
    const double start = now();
    displace_by_fftw(kernel, p, u, scratch);
    best = std::min(best, now() - start);
  }
  return best;
}

struct Cost {
  double pairs = 0, seconds = 0, certificate = 0, area = 0;
  double pair = 0;  // seconds of one transform pair, measured beside
};

// Polonsky and Keer 1999: Fletcher-Reeves directions, restarted when pixels join; two pairs an
// iteration. Stops on the same certificate.
Cost polonsky_keer_once(const ContactKernel& kernel, const std::vector<double>& height, double mean,
                        double tolerance, bool own_convolution) {
  const std::size_t n = height.size();
  const double count = static_cast<double>(n), load = mean * count;
  double average = 0, spread = 0;
  for (double h : height) average += h / count;
  for (double h : height) spread += square(h - average) / count;
  spread = std::sqrt(spread);
  RealArray p(n, mean), w(n), d(n, 0.0), u(n);
  SpectrumArray scratch(std::max(kernel.scratch_size(), kernel.fft().spectrum_size()));
  const auto displace = [&](const RealArray& pressure, RealArray& to) {
    if (own_convolution) {
      kernel.displace(pressure, to, scratch);
    } else {
      displace_by_fftw(kernel, pressure, to, scratch);
    }
  };
  Cost cost;
  cost.pair = pair_time(kernel);
  const double begin = now();
  double old_g = 1;
  bool restart = true;
  for (int k = 0; k < 3000; ++k) {
    displace(p, w);
    ++cost.pairs;
    double low = std::numeric_limits<double>::infinity(), work = 0, shift = 0, inside = 0;
    for (std::size_t i = 0; i < n; ++i) {
      w[i] -= height[i];
      low = std::min(low, w[i]);
      work += p[i] * w[i];
      if (p[i] > 0) {
        shift += w[i];
        inside += 1;
      }
    }
    shift /= inside;
    cost.certificate = (work - low * load) / (load * spread);
    cost.area = inside / count;
    if (cost.certificate <= tolerance) break;
    double g = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (p[i] > 0) g += square(w[i] - shift);
    }
    const double beta = restart ? 0 : g / old_g;
    old_g = g;
    for (std::size_t i = 0; i < n; ++i) d[i] = p[i] > 0 ? w[i] - shift + beta * d[i] : 0;
    displace(d, u);
    ++cost.pairs;
    double mean_u = 0, rd = 0, du = 0;
    for (std::size_t i = 0; i < n; ++i) {
      if (p[i] > 0) mean_u += u[i];
    }
    mean_u /= inside;
    for (std::size_t i = 0; i < n; ++i) {
      if (p[i] > 0) {
        rd += (w[i] - shift) * d[i];
        du += (u[i] - mean_u) * d[i];
      }
    }
    const double alpha = rd / du;
    double sum = 0;
    restart = false;
    for (std::size_t i = 0; i < n; ++i) {
      if (p[i] > 0) {
        p[i] = std::max(0.0, p[i] - alpha * d[i]);
      } else if (w[i] < shift) {
        p[i] = -alpha * (w[i] - shift);
        restart = true;
      }
      sum += p[i];
    }
    for (double& v : p) v *= load / sum;
  }
  cost.seconds = now() - begin;
  return cost;
}

// Better of two.
Cost polonsky_keer(const ContactKernel& kernel, const std::vector<double>& height, double mean,
                   double tolerance, bool own_convolution) {
  const Cost first = polonsky_keer_once(kernel, height, mean, tolerance, own_convolution);
  Cost second = polonsky_keer_once(kernel, height, mean, tolerance, own_convolution);
  second.seconds = std::min(first.seconds, second.seconds);
  second.pair = std::min(first.pair, second.pair);
  return second;
}

Cost solve(const ContactKernel& kernel, const std::vector<double>& height, double mean,
           const std::vector<double>& traction, const ContactOptions& options,
           const ContactSolution* start, ContactSolution* keep = nullptr) {
  Cost cost;
  ContactSolution s;
  cost.seconds = cost.pair = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 4; ++k) {
    cost.pair = std::min(cost.pair, pair_time(kernel));
    const double begin = now();
    s = solve_contact(kernel, height, mean, traction, options, start);
    cost.seconds = std::min(cost.seconds, now() - begin);
  }
  cost.pairs = s.fft_pairs;
  cost.certificate = s.certificate;
  cost.area = measure_area(kernel, s).raw;
  if (keep) *keep = std::move(s);
  return cost;
}

void row(const std::string& scene, int n, const std::string& method, double tolerance,
         const Cost& cost) {
  fmt::print("{},{},{},{:.0e},{:.4f},{:.1f},{:.1f},{:.5f},{:.1e}\n", scene, n, method, tolerance,
             cost.area, cost.pairs, cost.seconds / cost.pair, cost.seconds, cost.certificate);
  std::fflush(stdout);
}

void dense_scenes(int n) {
  // H = 0.8, rms slope 0.5, cut-off of 8 pixels, E* = 1: the surfaces that solvers are compared on.
  const Grid grid{n, n, 1, 1};
  Heightmap surface = random_surface({0.1, 1, 0.8, 8.0 / n, 1}, grid, 7, 0);
  double slope = 0;
  for (int iy = 0; iy < n; ++iy) {
    for (int ix = 0; ix < n; ++ix) {
      slope += 2 * square((surface(wrap(ix + 1, n), iy) - surface(ix, iy)) * n) /
               static_cast<double>(grid.size());
    }
  }
  for (double& z : surface.z) z *= 0.5 / std::sqrt(slope);
  const auto kernel = make_contact_kernel(grid, {1, 0, 0, 1, 0});
  for (double load : {0.01, 0.05, 0.2}) {
    const std::string name = fmt::format("rough p/E*={}", load);
    row(name, n, "polonsky-keer fftw", 1e-8, polonsky_keer(*kernel, surface.z, load, 1e-8, false));
    row(name, n, "polonsky-keer fused", 1e-8, polonsky_keer(*kernel, surface.z, load, 1e-8, true));
    for (double t : {1e-4, 1e-8}) {
      row(name, n, "papilla cold", t,
          solve(*kernel, surface.z, load, {}, {.tolerance = t, .method = ContactMethod::Dense},
                nullptr));
    }
  }
}

void finger_scenes(int n) {
  // The reference finger's skin on a flat surface at its patch pressure: the loaded regime.
  const Finger finger;
  const Grid grid{n, n, 12e-6, 12e-6};
  const Skin& skin = finger.skin;
  const auto kernel =
      make_contact_kernel(grid, {skin.layer_modulus, skin.layer_poisson, skin.layer_thickness,
                                 skin.bulk_modulus, skin.bulk_poisson});
  const Heightmap height =
      random_surface({skin.rms, skin.roll_off, skin.hurst, skin.cutoff}, grid, 1, 0);
  std::vector<double> traction(grid.size(), 0.0);  // a bridge-like disc, twice the preload
  const double mean = finger.patch_pressure(0.15),
               humid = finger.patch_pressure(0.35) / skin.modulus_factor(0.35);
  for (int iy = 0; iy < n; ++iy) {
    for (int ix = 0; ix < n; ++ix) {
      if (std::hypot(grid.x(ix) - 4e-6, grid.y(iy) - 7e-6) < 2e-6) {
        traction[grid.index(ix, iy)] = 2 * mean;
      }
    }
  }
  for (double t : {1e-4, 1e-5, 1e-6, 1e-8}) {
    if (n > 512 && t != 1e-5) continue;
    ContactSolution base;
    row("loaded", n, "polonsky-keer fftw", t, polonsky_keer(*kernel, height.z, mean, t, false));
    row("loaded", n, "polonsky-keer fused", t, polonsky_keer(*kernel, height.z, mean, t, true));
    row("loaded", n, "papilla cold", t,
        solve(*kernel, height.z, mean, {}, {.tolerance = t, .method = ContactMethod::Dense},
              nullptr, &base));
    row("loaded next humidity", n, "papilla warm", t,
        solve(*kernel, height.z, humid, {}, {.tolerance = t, .method = ContactMethod::Dense},
              &base));
    row("loaded off to on", n, "papilla warm", t,
        solve(*kernel, height.z, mean, traction, {.tolerance = t, .method = ContactMethod::Dense},
              &base));
  }
  // Light contact: the paper's uniform preload.
  const auto stiff = make_contact_kernel(grid, {200e6, 0.5, 1e-6, 25e6, 0.5});
  const Heightmap light = random_surface({330e-9, 12e-6, 0.8, 50e-9}, grid, 3, 0);
  for (ContactMethod method : {ContactMethod::Dense, ContactMethod::Auto}) {
    const std::string name = method == ContactMethod::Dense ? "dense" : "automatic";
    ContactSolution base;
    row("light 15 kPa", n, name + " cold", 1e-8,
        solve(*stiff, light.z, 15e3, {}, {.tolerance = 1e-8, .method = method}, nullptr, &base));
    row("light +10 %", n, name + " warm", 1e-8,
        solve(*stiff, light.z, 16.5e3, {}, {.tolerance = 1e-8, .method = method}, &base));
  }
}

// The light scene at 15 kPa and then 12 amounts of threshold water, each with the drive off and on:
// 25 states, every one certified.
void sequence(int n) {
  const Grid grid{n, n, 12e-6, 12e-6};
  const auto kernel = make_contact_kernel(grid, {200e6, 0.5, 1e-6, 25e6, 0.5});
  const Heightmap skin = random_surface({330e-9, 12e-6, 0.8, 50e-9}, grid, 3, 0);
  const double load = 15e3;
  for (ContactMethod method : {ContactMethod::Dense, ContactMethod::Auto}) {
    const ContactOptions options{.tolerance = 1e-8, .method = method};
    Cost best;
    best.seconds = best.pair = std::numeric_limits<double>::infinity();
    for (int repeat = 0; repeat < 4; ++repeat) {
      best.pair = std::min(best.pair, pair_time(*kernel));
      Cost total;
      const double begin = now();
      const auto count = [&](ContactSolution s) {
        total.pairs += s.fft_pairs;
        total.certificate = std::max(total.certificate, s.certificate);
        return s;
      };
      const ContactSolution dry = count(solve_contact(*kernel, skin.z, load, {}, options));
      ContactSolution off = dry;
      double tractions = 0;  // seconds, not of the solver
      for (int k = 1; k <= 12; ++k) {
        const double made = now();
        const double reach = 10e-9 * k, suction = 2 * 0.072 * std::cos(50 * kPi / 180) / reach;
        std::vector<double> wet(grid.size(), 0.0), driven(grid.size());
        for (std::size_t i = 0; i < grid.size(); ++i) {
          if (dry.gap[i] < reach) wet[i] = suction;
          driven[i] = wet[i] + 0.5 * 8.854e-12 * square(30 / (dry.gap[i] + 128e-9));
        }
        tractions += now() - made;
        off = count(solve_contact(*kernel, skin.z, load, wet, options, &off));
        count(solve_contact(*kernel, skin.z, load, driven, options, &off));
      }
      total.seconds = now() - begin - tractions;
      total.area = measure_area(*kernel, off).raw;
      total.seconds = std::min(total.seconds, best.seconds);
      total.pair = best.pair;
      best = total;
    }
    best.pair = std::min(best.pair, pair_time(*kernel));
    row("light preload + 12 waters off and on", n,
        method == ContactMethod::Dense ? "dense warm" : "automatic warm", 1e-8, best);
  }
}

}  // namespace
}  // namespace papilla::tests

int main(int argc, char** argv) {
  papilla::tests::keep_freed_memory();
  const std::string part = argc > 1 ? argv[1] : "all";
  const int smallest = argc > 2 ? std::atoi(argv[2]) : 256;
  const int largest = argc > 3 ? std::atoi(argv[3]) : 512;
  fmt::print("scene,n,method,tolerance,contact,pairs,pair_times,seconds,certificate\n");
  for (int n = smallest; n <= largest; n *= 2) {
    if (part == "finger" || part == "all") papilla::tests::finger_scenes(n);
    if (part == "rough" || part == "all") papilla::tests::dense_scenes(n);
    if (part == "sequence" || part == "all") papilla::tests::sequence(n);
  }
}
