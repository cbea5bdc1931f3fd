// The tables of docs/measured/look.md: three theories of lattices where two hold, published sheets
// of etched glass, sparkle by closed forms beside Monte Carlo, and the pitch of bumps for two
// panels.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <vector>

#include "base/constants.h"
#include "forward/appearance.h"
#include "geometry/roughness.h"
#include "physics/optics/lattice/lattice.h"
#include "physics/optics/lattice/look.h"
#include "physics/optics/optics.h"
#include "physics/optics/sparkle.h"

namespace papilla::rooms {
namespace {

constexpr double kWavelength = 560e-9, kIndex = 1.46;

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Texture lines_of(double period, double depth) {
  Grating t;
  t.period = period, t.width = 0.5 * period, t.depth = depth, t.wall_angle = kPi / 2;
  t.edge_radius = 0;
  return {t};
}
Texture holes_of(double period, double depth) {
  HoleArray t;
  t.period = period, t.diameter = 0.5 * period, t.depth = depth, t.wall_angle = kPi / 2;
  t.edge_radius = 0;
  return {t};
}

struct Straight {
  double value = 0, seconds = 0;
};

// The undeviated share through the face, mean over polarisations.
Straight rigorous(const Texture& texture, int beyond) {
  const FeatureArray array = *forward::sections(texture);
  const LatticeStack stack = lattice_stack(array, {kIndex, 1});
  const bool line = array.shape == FeatureArray::Shape::Line;
  Straight out;
  out.seconds = seconds_of([&] {
    out.value = diffract(stack, {kWavelength, 0, Polarisation::P}, beyond).straight();
    if (line)
      out.value =
          0.5 * (out.value + diffract(stack, {kWavelength, 0, Polarisation::S}, beyond).straight());
  });
  return out;
}

OpticalMedia bonded() {
  OpticalMedia out{kIndex, 1};
  out.back = kIndex;
  return out;
}

Straight screened(const Texture& texture) {
  const FeatureArray array = *forward::sections(texture);
  Straight out;
  out.seconds = seconds_of(
      [&] { out.value = array_screen(array, bonded(), {{kWavelength}}).spectrum[0].transmitted; });
  return out;
}

Straight layered(const Texture& texture, bool lines) {
  const TextureFacts known = facts(texture);
  Straight out;
  out.seconds = seconds_of([&] {
    out.value =
        effective_medium(*known.open_share, *known.relief.height(),
                         lines ? Features::Lines : Features::Holes, bonded(), {}, {{kWavelength}})
            .spectrum[0]
            .transmitted;
  });
  return out;
}

void theories() {
  fmt::print(
      "| texture | period um | depth nm | rigorous | its error | s | screen | off by | layer | off "
      "by |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const bool lines : {true, false}) {
    for (const double period : {0.1e-6, 0.2e-6, 0.27e-6, 0.5e-6, 0.9e-6, 1.44e-6, 2e-6, 4e-6}) {
      if (!lines && period > 2e-6) continue;
      for (const double depth : {100e-9, 300e-9}) {
        const Texture t = lines ? lines_of(period, depth) : holes_of(period, depth);
        const Straight exact = rigorous(t, 6), coarse = rigorous(t, 4), screen = screened(t),
                       layer = layered(t, lines);
        const bool fine = period < kWavelength / kIndex;
        fmt::print("| {} | {:.2f} | {:.0f} | {:.4f} | {:.0e} | {:.3f} | {:.4f} | {:+.3f} | {} |\n",
                   lines ? "grating" : "holes", 1e6 * period, 1e9 * depth, exact.value,
                   std::abs(exact.value - coarse.value), coarse.seconds, screen.value,
                   screen.value - exact.value,
                   fine ? fmt::format("{:.4f} | {:+.4f}", layer.value, layer.value - exact.value)
                        : std::string("– | –"));
      }
    }
  }
  fmt::print(
      "\n| holes, 1 um, 300 nm: orders beyond | unknowns | undeviated | balance − 1 | s |\n"
      "|---|---|---|---|---|\n");
  const LatticeStack stack = lattice_stack(*forward::sections(holes_of(1e-6, 300e-9)), {kIndex, 1});
  for (const int beyond : {1, 2, 3, 4, 6, 8, 10}) {
    Diffracted d;
    const double s = seconds_of([&] {
      d = diffract(stack, {kWavelength, 0, Polarisation::P}, beyond);
    });
    fmt::print("| {} | {} | {:.6f} | {:.0e} | {:.3f} |\n", beyond, d.waves, d.straight(),
               d.balance() - 1, s);
  }
}

struct Sheet {
  const char* name;
  double gloss, haze, ra, rsm;
};
constexpr std::array kSheets{
    Sheet{"VRD50", 50, 12.6, 0.58e-6, 110e-6}, Sheet{"VRD70", 70, 4.2, 0.39e-6, 110e-6},
    Sheet{"VRD90", 90, 2.2, 0.25e-6, 110e-6},  Sheet{"VRD120", 120, 0.6, 0.14e-6, 110e-6},
    Sheet{"LST40", 40, 20, 0.38e-6, 55e-6},    Sheet{"LST50", 50, 11.1, 0.26e-6, 55e-6},
    Sheet{"LST70", 70, 5.5, 0.20e-6, 55e-6},   Sheet{"LST90", 90, 3.6, 0.13e-6, 55e-6},
    Sheet{"LST120", 120, 1.7, 0.08e-6, 55e-6}};

Optics etched(double rms, double length, bool black) {
  Light light{{550e-9}};
  light.meters.black_back = black;
  return rough_look({{rms, length}}, {1.52, 1}, light);
}

void sheets() {
  fmt::print(
      "| product | Ra um | free length um | RSm/4.4 um | haze % | sheet | gloss GU | sheet | haze "
      "at "
      "RSm/4.4 | gloss there |\n|---|---|---|---|---|---|---|---|---|---|\n");
  for (const Sheet& s : kSheets) {
    const double rms = std::sqrt(kPi / 2) * s.ra;
    double best = kInfinity, length = 0;
    Optics found;
    for (double l = 4e-6; l < 40e-6; l *= 1.015) {
      const Optics o = etched(rms, l, false);
      const double off =
          square((100 * o.haze / s.haze - 1) / 0.2) + square((o.gloss - s.gloss) / 10);
      if (off < best) best = off, length = l, found = o;
    }
    const Optics there = etched(rms, s.rsm / 4.4429, false);
    fmt::print(
        "| {} | {:.2f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.0f} | {:.0f} | {:.2g} | {:.0f} |\n",
        s.name, 1e6 * s.ra, 1e6 * length, 1e6 * s.rsm / 4.4429, 100 * found.haze, s.haze,
        found.gloss, s.gloss, 100 * there.haze, there.gloss);
  }
}

Panel panel(double width, double height, double distance) {
  return {width, height, 1.2e-3 / 1.5, std::atan(2e-3 / distance), 550e-9};
}

void sparkles() {
  const Panel reference = panel(60e-6, 180e-6, 0.5);
  fmt::print(
      "| rms nm | length um | weak % | exact % | Monte Carlo % | s exact | s Monte Carlo |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const double rms : {20e-9, 100e-9, 300e-9}) {
    for (const double length : {4e-6, 10e-6, 25e-6, 60e-6}) {
      const std::vector<RoughScale> scales{{rms, length}};
      double exact = 0, sampled = 0;
      const double fast = seconds_of([&] { exact = rough_sparkle(scales, 0.5, reference); });
      constexpr int kScreens = 2;
      const double slow = seconds_of([&] {
        for (std::uint64_t k = 0; k < kScreens; ++k)
          sampled += square(map_sparkle(random_surface(scales, {1024, 1024, 1.5e-3, 1.5e-3}, k + 1),
                                        0.5, reference)) /
                     kScreens;
      });
      fmt::print("| {:.0f} | {:.0f} | {:.2f} | {:.2f} | {:.2f} | {:.3f} | {:.1f} |\n", 1e9 * rms,
                 1e6 * length, 100 * weak_sparkle(scales, 0.5, reference), 100 * exact,
                 100 * std::sqrt(sampled), fast, slow);
    }
  }
  const std::vector<RoughScale> bumps{{100e-9, 12e-6}};
  fmt::print("\n| 100 nm, 12 um | sparkle % |\n|---|---|\n");
  for (const double width : {15e-6, 30e-6, 60e-6, 120e-6})
    fmt::print("| subpixel {:.0f} × {:.0f} um | {:.2f} |\n", 1e6 * width, 3e6 * width,
               100 * rough_sparkle(bumps, 0.5, panel(width, 3 * width, 0.5)));
  for (const double depth : {0.4e-3, 0.8e-3, 1.6e-3}) {
    Panel p = reference;
    p.depth = depth;
    fmt::print("| thickness/index to the panel {:.1f} mm | {:.2f} |\n", 1e3 * depth,
               100 * rough_sparkle(bumps, 0.5, p));
  }
  for (const double distance : {0.25, 0.5, 1.0})
    fmt::print("| eye at {:.2f} m | {:.2f} |\n", distance,
               100 * rough_sparkle(bumps, 0.5, panel(60e-6, 180e-6, distance)));
}

// Etched glass of 60 GU of its textured face, by the pitch of its bumps (RSm = 4.44 correlation
// lengths).
void pitches() {
  const Panel phone = panel(18e-6, 54e-6, 0.35), monitor = panel(55e-6, 165e-6, 0.6);
  fmt::print(
      "| pitch RSm um | rms nm for 60 GU | haze % | sparkle, phone 470 ppi % | sparkle, screen "
      "154 ppi % |\n|---|---|---|---|---|\n");
  for (const double length : {1.5e-6, 2e-6, 3e-6, 4e-6, 6e-6, 8e-6, 12e-6, 18e-6, 27e-6, 40e-6}) {
    double low = 5e-9, high = 2e-6;
    for (int k = 0; k < 40; ++k) {
      const double middle = std::sqrt(low * high);
      (etched(middle, length, true).gloss > 60 ? low : high) = middle;
    }
    const Optics o = etched(low, length, true);
    fmt::print("| {:.1f} | {:.0f} | {:.1f} | {:.2f} | {:.2f} |\n", 4.4429e6 * length, 1e9 * low,
               100 * o.haze, 100 * rough_sparkle({{low, length}}, 0.52, phone),
               100 * rough_sparkle({{low, length}}, 0.52, monitor));
  }
}

void run() {
  fmt::print("## Lattices\n\n");
  theories();
  fmt::print("\n## Published etched glass\n\n");
  sheets();
  fmt::print("\n## Sparkle\n\n");
  sparkles();
  fmt::print("\n## Pitch\n\n");
  pitches();
}

}  // namespace
}  // namespace papilla::rooms

int main() { papilla::rooms::run(); }
