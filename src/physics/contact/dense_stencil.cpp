#include "physics/contact/dense_stencil.h"

#include <algorithm>

namespace papilla::contact {

StencilPreconditioner::StencilPreconditioner(const ContactKernel& kernel)
    : kernel_(kernel),
      grid_(kernel.grid()),
      width_(grid_.nx + 2 * kReach + Window<kReach>::kBeyond),
      residual_(static_cast<std::size_t>(width_) * (grid_.ny + 2 * kReach), 0.0F),
      inside_(residual_.size(), 0.0F) {}

void StencilPreconditioner::apply(const std::vector<int>& free, const std::vector<double>& residual,
                                  bool balanced, std::vector<double>& direction,
                                  std::vector<double>& ones) {
  const std::size_t m = free.size();
  direction.resize(m);
  ones.resize(m);
  for (std::size_t k = 0; k < m; ++k) spread(free[k], static_cast<float>(residual[k]), 1.0F);
  const float least_weight = 1e-3F * kernel_.stencil().weight(0, 0);
  double sum_z = 0, sum_one = 0;
  for (std::size_t k = 0; k < m; ++k) {
    const int ix = free[k] % grid_.nx, iy = free[k] / grid_.nx;
    const auto [value, one] = kernel_.stencil().sums(
        residual_.data(), inside_.data(), static_cast<std::size_t>(iy) * width_ + ix, width_);
    const float half = std::max(0.5F * one, least_weight);
    direction[k] = value - half * residual[k];
    ones[k] = half;
    sum_z += direction[k];
    sum_one += ones[k];
  }
  for (int i : free) spread(i, 0, 0);
  if (sum_one > 0 && balanced) {
    for (std::size_t k = 0; k < m; ++k) direction[k] -= sum_z / sum_one * ones[k];
  }
}

// A pixel and its periodic images within the margin.
void StencilPreconditioner::spread(int i, float value, float one) {
  const int ix = i % grid_.nx, iy = i / grid_.nx;
  for (int y = iy - grid_.ny; y < grid_.ny + kReach; y += grid_.ny) {
    if (y < -kReach) continue;
    for (int x = ix - grid_.nx; x < grid_.nx + kReach; x += grid_.nx) {
      if (x < -kReach) continue;
      const std::size_t at = static_cast<std::size_t>(y + kReach) * width_ + (x + kReach);
      residual_[at] = value;
      inside_[at] = one;
    }
  }
}

}  // namespace papilla::contact
