#include "cases/contact_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/constants.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "design/design.h"
#include "geometry/roughness.h"
#include "physics/contact/contact.h"

namespace papilla::cases {
namespace {

constexpr int kBins = 120;
// Where the bins end: rms heights, and pressures of a full contact's deviation E* slope/2.
constexpr double kMostGap = 6, kMostStress = 8;

// What one seed gives at one pressure, in the order of StatisticsPoint.
struct Sample {
  double area = 0, pixels = 0, mean_gap = 0;
  std::vector<double> inverse, inverse_square, gaps, stresses;
};

struct Seed {
  double rms = 0, slope = 0;
  std::vector<Sample> at;  // one per pressure
  double certificate = 0;
  bool converged = true;
};

std::vector<double> histogram(const std::vector<double>& values, double width) {
  std::vector<double> out(kBins, 0);
  const double each = 1 / (width * static_cast<double>(values.size()));
  for (const double v : values) {
    if (v <= 0) continue;  // contact, or none
    const double bin = v / width;
    if (bin < kBins) out[static_cast<std::size_t>(bin)] += each;
  }
  return out;
}

Sample sampled(const StatisticsCase& c, const ContactKernel& kernel, const ContactSolution& s,
               double gap_width, double stress_width) {
  Sample out;
  const ContactArea area = measure_area(kernel, s, c.press.hardness);
  out.area = area.near_edge;
  out.pixels = area.raw;
  const auto n = static_cast<double>(s.gap.size());
  for (const double g : s.gap) out.mean_gap += g / n;
  // Eq. contact.18
  for (const double h0 : c.thickness) {
    double inverse = 0, square_inverse = 0;
    for (const double g : s.gap) {
      inverse += 1 / (g + h0) / n;
      square_inverse += 1 / square(g + h0) / n;
    }
    out.inverse.push_back(inverse);
    out.inverse_square.push_back(square_inverse);
  }
  out.gaps = histogram(s.gap, gap_width);
  out.stresses = histogram(s.pressure, stress_width);
  return out;
}

// rms slope of the waves that fit on a periodic square: of the spectrum itself, not of differences.
double slope_of(const PowerSpectrum& spectrum, double side) {
  double sum = 0;
  const double dq = 2 * kPi / side;
  const int most = static_cast<int>(spectrum.highest() / dq * (1 + 1e-12));
  for (int ky = -most; ky <= most; ++ky) {
    for (int kx = -most; kx <= most; ++kx) {
      const double q = dq * std::hypot(kx, ky);
      if (q > 0) sum += square(q) * spectrum.at(q) * dq * dq;
    }
  }
  return std::sqrt(sum);
}

Seed solve_seed(const StatisticsCase& c, const PowerSpectrum& spectrum, int index, int pixels) {
  const Grid grid{pixels, pixels, c.side(), c.side()};
  const auto kernel =
      make_contact_kernel(grid, {c.press.modulus, 0, 0, c.press.modulus, 0});  // E*, nu = 0
  const Heightmap h = random_surface([&](double q) { return spectrum.at(q); }, grid,
                                     static_cast<std::uint64_t>(c.sampling.seed + index));
  Seed out;
  double square_sum = 0;
  for (const double z : h.z) square_sum += z * z;
  out.rms = std::sqrt(square_sum / static_cast<double>(h.z.size()));
  out.slope = slope_of(spectrum, c.side());
  const double gap_width = kMostGap * spectrum.rms() / kBins;
  const double stress_width = kMostStress * 0.5 * c.press.modulus * spectrum.slope() / kBins;
  const ContactOptions options{.tolerance = c.sampling.tolerance, .hardness = c.press.hardness};
  ContactSolution last;
  for (const double pressure : c.press.pressure) {
    ContactSolution s =
        solve_contact(*kernel, h.z, pressure, {}, options, last.gap.empty() ? nullptr : &last);
    out.certificate = std::max(out.certificate, s.certificate);
    out.converged = out.converged && s.converged();
    out.at.push_back(sampled(c, *kernel, s, gap_width, stress_width));
    last = std::move(s);
  }
  return out;
}

// Mean over the seeds, and what the first of them change on half the pixels.
template <class Number>
StatisticsNumber over(const std::vector<Seed>& seeds, const std::vector<Seed>& coarse,
                      const Number& number) {
  std::vector<double> values;
  for (const Seed& s : seeds) values.push_back(number(s));
  const Estimate mean = mean_estimate(values);
  StatisticsNumber out{mean.value};
  if (seeds.size() > 1) out.seeds = mean.se;
  if (coarse.empty()) return out;
  double change = 0;
  for (std::size_t k = 0; k < coarse.size(); ++k)
    change += (number(coarse[k]) - values[k]) / static_cast<double>(coarse.size());
  out.grid = std::abs(change);
  return out;
}

Distribution over_bins(const std::vector<Seed>& seeds, std::size_t i, double width,
                       std::vector<double> Sample::*bins) {
  Distribution out{width, {}};
  for (int b = 0; b < kBins; ++b) {
    std::vector<double> values;
    for (const Seed& s : seeds) values.push_back((s.at[i].*bins)[static_cast<std::size_t>(b)]);
    out.density.push_back(mean_estimate(values));
  }
  return out;
}

}  // namespace

std::optional<double> StatisticsNumber::error() const {
  if (!seeds && !grid) return std::nullopt;
  return std::hypot(seeds.value_or(0), grid.value_or(0));
}

PowerSpectrum StatisticsCase::spectrum() const {
  const PowerSpectrum given = pressed.roughness.spectrum();
  return pressed.slope > 0 ? given.scaled(square(pressed.slope / slope_of(given, side()))) : given;
}

double StatisticsCase::side() const {
  return sampling.size > 0 ? sampling.size : 2 * kPi / pressed.roughness.spectrum().lowest();
}

void fields(FieldVisitor& v, PressedSettings& s) {
  fields(v, s.roughness);
  v.number({"slope", "", 0, 10,
            "rms slope that the waves on the square are scaled to together; 0: as they are"},
           s.slope);
}

void fields(FieldVisitor& v, PressSettings& s) {
  v.number({"modulus", "MPa", 0, 1e9, "E* of the two bodies: 1/E* = sum of (1 - nu^2)/E",
            Source::Choice, "", Presence::Required},
           s.modulus);
  v.number({"hardness", "MPa", 0, 1e9, "cap on the pressure; 0: none"}, s.hardness);
  v.numbers({"pressure", "kPa", 0, 1e12, "mean pressures", Source::Choice, "", Presence::Required},
            s.pressure);
}

void fields(FieldVisitor& v, SamplingSettings& s) {
  v.number({"size", "um", 0, 1e7, "side of the periodic square; 0: the longest wave"}, s.size);
  v.integer({"grid", "pixels along it, a power of two"}, 16, 4096, s.grid);
  v.integer({"seeds", "surfaces of random phases"}, 1, 10000, s.seeds);
  v.integer({"seed", "the first of them"}, 0, 1 << 30, s.seed);
  v.integer({"controls", "of them also on half the pixels: what the grid leaves open"}, 0, 10000,
            s.controls);
  v.number({"tolerance", "", 1e-14, 0.1, "on the certificate (docs/theory/contact.md)"},
           s.tolerance);
}

void fields(FieldVisitor& v, StatisticsCase& s) {
  v.integer(
      {"schema_version", "version of the file format", Source::Choice, "", Presence::Required}, 1,
      1, s.schema_version);
  v.text({"title", "name of the case"}, s.title);
  v.section({"roughness", "spectrum of both surfaces together"}, s.pressed);
  v.section({"press", "what presses, how hard"}, s.press);
  v.numbers({"thickness", "nm", 0, 1e9,
             "d/eps in series with the gap g: means of 1/(g + d/eps) and of its square"},
            s.thickness);
  v.section({"sampling", "how many surfaces on which grid"}, s.sampling);
}

StatisticsCase read_statistics(const std::string& path, const std::vector<std::string>& overrides) {
  return read_statistics(load_document(own_or_shipped(path), overrides, design_roots()));
}

StatisticsCase read_statistics(Document document) {
  StatisticsCase c;
  read_section(document, "", c);
  for (const auto& [key, message] : spectrum_problems(c.pressed.roughness))
    document.problem_at("roughness." + key, message);
  if (c.press.modulus <= 0) document.problem_at("press.modulus", "expected a modulus above 0");
  if (c.press.pressure.empty() ||
      !std::is_sorted(c.press.pressure.begin(), c.press.pressure.end(), std::less_equal<>()) ||
      c.press.pressure.front() <= 0)
    document.problem_at("press.pressure", "expected rising pressures above 0");
  // Far beyond what a linear solid stands for; at 1e12 of it round-off is all that is left.
  constexpr double kMostStrain = 100;
  if (!c.press.pressure.empty() && c.press.modulus > 0 &&
      c.press.pressure.back() > kMostStrain * c.press.modulus)
    document.problem_at("press.pressure", "expected at most 100 times the modulus");
  if (!c.press.pressure.empty() && c.press.hardness > 0 &&
      c.press.pressure.back() >= c.press.hardness)
    document.problem_at("press.pressure", "expected pressures below the hardness");
  for (const double h0 : c.thickness) {
    if (h0 <= 0)
      document.problem_at("thickness",
                          "expected thicknesses above 0: where surfaces touch 1/g has no mean");
  }
  if (!std::has_single_bit(static_cast<unsigned>(c.sampling.grid)))
    document.problem_at("sampling.grid", "expected a power of two");
  c.sampling.controls = std::min(c.sampling.controls, c.sampling.seeds);
  finish(document);
  const double most = kPi * c.sampling.grid / c.side();  // of the grid [1/m]
  const double highest = c.pressed.roughness.spectrum().highest();
  if (highest > most)
    throw InputError({Problem{
        "", 0, 0, "sampling.grid",
        fmt::format("{} pixels on {:.4g} um hold waves down to {:.4g} um; the "
                    "spectrum ends at {:.4g} um: a larger grid, a smaller "
                    "size or a lower roughness.cutoff",
                    c.sampling.grid, 1e6 * c.side(), 2e6 * kPi / most, 2e6 * kPi / highest)}});
  if (slope_of(c.pressed.roughness.spectrum(), c.side()) == 0)
    throw InputError({Problem{
        "", 0, 0, "sampling.size",
        fmt::format("a square of {:.4g} um holds no wave of the spectrum, which ends at {:.4g} um",
                    1e6 * c.side(), 2e6 * kPi / highest)}});
  return c;
}

StatisticsResult solve_statistics(const StatisticsCase& c, int threads) {
  const PowerSpectrum spectrum = c.spectrum();
  const int seeds = c.sampling.seeds, controls = c.sampling.controls;
  require_memory(300.0 * square(static_cast<double>(c.sampling.grid)) *
                     std::min(seeds, threads > 0 ? threads : 8),
                 "contacts of " + std::to_string(c.sampling.grid) + " pixels a side");
  std::vector<Seed> fine(static_cast<std::size_t>(seeds)),
      coarse(static_cast<std::size_t>(controls));
  parallel_for(
      seeds + controls,
      [&](int i) {
        if (i < seeds) {
          fine[static_cast<std::size_t>(i)] = solve_seed(c, spectrum, i, c.sampling.grid);
        } else {
          coarse[static_cast<std::size_t>(i - seeds)] =
              solve_seed(c, spectrum, i - seeds, c.sampling.grid / 2);
        }
      },
      threads);
  StatisticsResult out;
  out.rms = over(fine, coarse, [](const Seed& s) { return s.rms; });
  out.slope = over(fine, coarse, [](const Seed& s) { return s.slope; });
  for (const auto* set : {&fine, &coarse}) {
    for (const Seed& s : *set) {
      out.largest_certificate = std::max(out.largest_certificate, s.certificate);
      out.converged = out.converged && s.converged;
    }
  }
  for (std::size_t i = 0; i < c.press.pressure.size(); ++i) {
    StatisticsPoint& p = out.points.emplace_back();
    p.pressure = c.press.pressure[i];
    p.area = over(fine, coarse, [&](const Seed& s) { return s.at[i].area; });
    p.pixels = over(fine, coarse, [&](const Seed& s) { return s.at[i].pixels; });
    p.mean_gap = over(fine, coarse, [&](const Seed& s) { return s.at[i].mean_gap; });
    for (std::size_t k = 0; k < c.thickness.size(); ++k) {
      p.inverse.push_back(over(fine, coarse, [&](const Seed& s) { return s.at[i].inverse[k]; }));
      p.inverse_square.push_back(
          over(fine, coarse, [&](const Seed& s) { return s.at[i].inverse_square[k]; }));
    }
    p.gap = over_bins(fine, i, kMostGap * spectrum.rms() / kBins, &Sample::gaps);
    p.stress = over_bins(fine, i, kMostStress * 0.5 * c.press.modulus * spectrum.slope() / kBins,
                         &Sample::stresses);
  }
  return out;
}

}  // namespace papilla::cases
