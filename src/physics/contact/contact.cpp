// Heights, load and tractions as a standard problem, its solver, the solution in the caller's
// terms.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numerics/reductions.h"
#include "physics/contact/solvers.h"

namespace papilla::contact {
namespace {

bool usable(const ContactSolution* start, std::size_t n) {
  return start && start->pressure.size() == n && start->converged() &&
         std::any_of(start->pressure.begin(), start->pressure.end(),
                     [](double p) { return p > 0; });
}

void fail(std::size_t n, ContactSolution& out) {
  out.pressure.assign(n, 0);
  out.gap.assign(n, 0);
  out.status = ContactStatus::Invalid;
}

void finish(const StandardProblem& problem, StandardState state, const ContactOptions& options,
            ContactSolution& out) {
  out.pressure = std::move(state.p);
  out.gap = std::move(state.gap);
  out.certificate = state.certificate;
  out.iterations = state.iterations;
  out.fft_pairs += state.pairs;
  out.shift = state.shift;
  out.elastic_energy = 0.5 * state.work * problem.kernel.grid().pixel_area();
  if (state.certified) {
    out.status = ContactStatus::Converged;
    return;
  }
  out.status = state.exhausted ? ContactStatus::IterationLimit : ContactStatus::Stagnated;
  out.reason = fmt::format("certificate {:.2g} above {:.2g} after {} iterations", out.certificate,
                           options.tolerance, out.iterations);
}

// First touch without load: gaps above the lowest point.
void leave_untouched(std::span<const double> g0, double level, const std::string& reason,
                     ContactSolution& out) {
  out.pressure.assign(g0.size(), 0);
  out.gap.resize(g0.size());
  for (std::size_t i = 0; i < g0.size(); ++i) out.gap[i] = g0[i] - level;
  out.shift = level;
  out.status = ContactStatus::NoLoad;
  out.reason = reason;
}

// A load-controlled problem by the sparse solver where that is allowed and able, else by the dense
// one, which goes on from what the other found. start: a usable one, or null.
void press(const StandardProblem& problem, const ContactOptions& options,
           const ContactSolution* start, ContactSolution& out) {
  const bool demand = options.method == ContactMethod::Sparse;
  std::span<const double> first;
  if (start) first = start->pressure;
  StandardState state;
  if (options.method != ContactMethod::Dense && options.hardness <= 0) {
    if (solve_sparse(problem, options.tolerance, start, demand, state)) {
      out.method = ContactMethod::Sparse;
      finish(problem, std::move(state), options, out);
      return;
    }
    out.fft_pairs += state.pairs;
    if (std::any_of(state.p.begin(), state.p.end(), [](double p) { return p > 0; })) {
      first = state.p;
    }
  }
  out.method = ContactMethod::Dense;
  finish(problem, solve_dense(problem, options.tolerance, options.max_iterations, first), options,
         out);
}

}  // namespace

double StandardProblem::rise_unpressed(RealArray& rise, SpectrumArray& scratch) const {
  if (traction.empty()) {
    rise.assign(height.size(), 0.0);
    return 0;
  }
  rise.assign(traction.begin(), traction.end());
  scratch.resize(kernel.scratch_size());
  kernel.displace(rise, rise, scratch);
  return 1;
}

ContactSolution solve_contact(const ContactKernel& kernel, std::span<const double> height,
                              double mean_pressure, std::span<const double> traction,
                              const ContactOptions& options, const ContactSolution* start) {
  const Grid& grid = kernel.grid();
  const std::size_t n = grid.size();
  ContactSolution out;
  const double square_height = height.size() == n ? variance(height) : 0;
  const double mean_traction = sum(traction) / static_cast<double>(n);
  if (height.size() != n || (!traction.empty() && traction.size() != n) ||
      !std::isfinite(square_height) || !std::isfinite(mean_traction) ||
      !std::isfinite(mean_pressure)) {
    fail(n, out);
    out.reason = "heights, load or tractions are not finite numbers on the kernel's grid";
    return out;
  }

  // Height spread that normalises the certificate; a flat surface is measured by what a pixel
  // yields.
  const double mean = mean_pressure + mean_traction;
  const double spread = std::max(std::sqrt(square_height), 1e-6 * mean * kernel.self_compliance());
  StandardProblem problem{kernel, height, traction, spread, mean * static_cast<double>(n)};
  if (mean <= 0) {
    RealArray g0;
    SpectrumArray scratch;
    out.fft_pairs += problem.rise_unpressed(g0, scratch);
    for (std::size_t i = 0; i < n; ++i) g0[i] = -height[i] - g0[i];
    leave_untouched(g0, *std::min_element(g0.begin(), g0.end()),
                    mean < 0 ? "the tractions lift the surfaces apart" : "no load: first touch",
                    out);
    return out;
  }
  if (options.hardness > 0 && mean >= options.hardness) {
    out.status = ContactStatus::Invalid;
    out.reason = fmt::format("mean load {:.3g} Pa is beyond the hardness {:.3g} Pa everywhere",
                             mean, options.hardness);
    out.pressure.assign(n, options.hardness);
    return out;
  }
  if (options.hardness > 0) problem.cap = options.hardness;

  press(problem, options, usable(start, n) ? start : nullptr, out);
  return out;
}

ContactSolution solve_approach(const ContactKernel& kernel, std::span<const double> height,
                               double approach, const ContactOptions& options,
                               const ContactSolution* start) {
  const std::size_t n = kernel.grid().size();
  ContactSolution out;
  const double square_height = height.size() == n ? variance(height) : 0;
  if (height.size() != n || !std::isfinite(square_height) || !std::isfinite(approach)) {
    fail(n, out);
    out.reason = "heights or approach are not finite numbers on the kernel's grid";
    return out;
  }
  StandardProblem problem{kernel, height, {}, std::sqrt(square_height)};
  double mean = 0, highest = height[0];
  for (double h : height) {
    mean -= h / static_cast<double>(n);
    highest = std::max(highest, h);
  }
  const double level = approach - highest;
  if (approach <= 0) {
    RealArray g0(n);
    for (std::size_t i = 0; i < n; ++i) g0[i] = -height[i];
    leave_untouched(g0, level, "the surfaces do not touch yet", out);
    return out;
  }
  if (level >= mean) {  // the mean surface cannot be passed: every load closes the gap there
    fail(n, out);
    out.reason = fmt::format("approach {:.4g} m beyond full contact, reached at {:.4g} m", approach,
                             approach + mean - level);
    return out;
  }
  if (options.hardness > 0) problem.cap = options.hardness;
  problem.approach = true;
  problem.level = level;
  out.method = ContactMethod::Dense;
  std::span<const double> first;
  if (usable(start, n)) first = start->pressure;
  finish(problem, solve_dense(problem, options.tolerance, options.max_iterations, first), options,
         out);
  return out;
}

}  // namespace papilla::contact
