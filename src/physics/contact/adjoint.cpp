#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "physics/contact/contact.h"

namespace papilla {

ContactAdjoint contact_adjoint(const ContactKernel& kernel, const ContactSolution& solution,
                               std::span<const double> by_pressure, std::span<const double> by_gap,
                               double hardness, double tolerance) {
  const std::size_t n = kernel.grid().size();
  const double cap = hardness > 0 ? hardness : kInfinity;
  ContactAdjoint out;
  out.by_height.assign(n, 0);
  std::vector<std::size_t> set;
  for (std::size_t i = 0; i < n; ++i) {
    if (solution.pressure[i] > 0 && solution.pressure[i] < cap) set.push_back(i);
  }
  // Gaps: h raises the skin towards the other surface; where pressed, the gap stays closed.
  RealArray field(n, 0.0), image(n);
  SpectrumArray scratch(kernel.scratch_size());
  double total = 0;
  if (!by_gap.empty()) {
    for (std::size_t i = 0; i < n; ++i) {
      if (solution.pressure[i] > 0) continue;
      field[i] = by_gap[i];
      out.by_height[i] = -by_gap[i];
      total += by_gap[i];
    }
    kernel.displace(field, image, scratch);
    ++out.fft_pairs;
  } else {
    std::fill(image.begin(), image.end(), 0.0);
  }
  if (set.empty()) {
    out.converged = true;
    return out;
  }
  // S y - sigma = c on the set, sum y = total: conjugate gradients without mean from a uniform y,
  // preconditioned by the inverse kernel.
  const std::size_t m = set.size();
  const auto count = static_cast<double>(m);
  std::vector<double> y(m, total / count), r(m), z(m), d(m, 0.0);
  const auto apply = [&](const std::vector<double>& x) {
    std::fill(field.begin(), field.end(), 0.0);
    for (std::size_t k = 0; k < m; ++k) field[set[k]] = x[k];
    kernel.displace(field, image, scratch);
    ++out.fft_pairs;
  };
  const auto centre = [&](std::vector<double>& x) {
    double sum = 0;
    for (double v : x) sum += v;
    for (double& v : x) v -= sum / count;
  };
  std::vector<double> c(m);
  for (std::size_t k = 0; k < m; ++k) {
    c[k] = image[set[k]] + (by_pressure.empty() ? 0 : by_pressure[set[k]]);
  }
  apply(y);
  for (std::size_t k = 0; k < m; ++k) r[k] = c[k] - image[set[k]];
  centre(r);
  double rz = 0, first = 0;
  for (out.iterations = 0; out.iterations < 400; ++out.iterations) {
    std::fill(field.begin(), field.end(), 0.0);
    for (std::size_t k = 0; k < m; ++k) field[set[k]] = r[k];
    kernel.press(field, scratch);
    ++out.fft_pairs;
    for (std::size_t k = 0; k < m; ++k) z[k] = field[set[k]];
    centre(z);
    double next = 0;
    for (std::size_t k = 0; k < m; ++k) next += r[k] * z[k];
    if (out.iterations == 0) first = next;
    if (next <= tolerance * tolerance * first) {
      out.converged = true;
      break;
    }
    const double beta = out.iterations == 0 ? 0 : next / rz;
    rz = next;
    for (std::size_t k = 0; k < m; ++k) d[k] = z[k] + beta * d[k];
    apply(d);
    double curvature = 0;
    for (std::size_t k = 0; k < m; ++k) curvature += d[k] * image[set[k]];
    if (curvature <= 0) break;
    const double alpha = rz / curvature;
    for (std::size_t k = 0; k < m; ++k) {
      y[k] += alpha * d[k];
      r[k] -= alpha * image[set[k]];
    }
    centre(r);
  }
  for (std::size_t k = 0; k < m; ++k) out.by_height[set[k]] = y[k];
  return out;
}

double smoothed_area(const ContactSolution& solution, double length, std::vector<double>* by_gap) {
  const auto n = static_cast<double>(solution.gap.size());
  if (by_gap) by_gap->assign(solution.gap.size(), 0);
  double sum = 0;
  for (std::size_t i = 0; i < solution.gap.size(); ++i) {
    const double share = std::exp(-solution.gap[i] / length) / n;
    sum += share;
    if (by_gap) (*by_gap)[i] = -share / length;
  }
  return sum;
}

}  // namespace papilla
