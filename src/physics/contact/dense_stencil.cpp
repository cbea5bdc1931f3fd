#include "physics/contact/dense_stencil.h"

#include <algorithm>
#include <cstring>

namespace papilla {
namespace {

// One row of the stencil in vector registers.
using Row = float __attribute__((vector_size(ContactKernel::kStencilWidth * sizeof(float))));

// By reference: without AVX-512 a returned vector of this width has no fixed calling convention.
void load_row(const float* from, Row& row) { std::memcpy(&row, from, sizeof row); }

float total(const Row& row) {
  float part[8], sum = 0;
  for (int j = 0; j < 8; ++j) part[j] = row[j] + row[j + 8];
  for (int j = 0; j < 4; ++j) sum += part[j] + part[j + 4];
  return sum;
}

}  // namespace

StencilPreconditioner::StencilPreconditioner(const ContactKernel& kernel)
    : kernel_(kernel),
      grid_(kernel.grid()),
      width_(grid_.nx + 2 * kReach + ContactKernel::kStencilWidth),
      residual_(static_cast<std::size_t>(width_) * (grid_.ny + 2 * kReach), 0.0F),
      inside_(residual_.size(), 0.0F) {}

void StencilPreconditioner::apply(const std::vector<int>& free, const std::vector<double>& residual,
                                  bool balanced, std::vector<double>& direction,
                                  std::vector<double>& ones) {
  const std::size_t m = free.size();
  direction.resize(m);
  ones.resize(m);
  for (std::size_t k = 0; k < m; ++k) spread(free[k], static_cast<float>(residual[k]), 1.0F);
  const float least_weight = 1e-3F * kernel_.stencil(kReach)[kReach];
  double sum_z = 0, sum_one = 0;
  for (std::size_t k = 0; k < m; ++k) {
    const int ix = free[k] % grid_.nx, iy = free[k] / grid_.nx;
    Row value{}, one{};
    for (int dy = 0; dy <= 2 * kReach; ++dy) {
      const std::size_t at = static_cast<std::size_t>(iy + dy) * width_ + ix;
      Row t, values, within;
      load_row(kernel_.stencil(dy), t);
      load_row(residual_.data() + at, values);
      load_row(inside_.data() + at, within);
      value += t * values;
      one += t * within;
    }
    const float half = std::max(0.5F * total(one), least_weight);
    direction[k] = total(value) - half * residual[k];
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

}  // namespace papilla
