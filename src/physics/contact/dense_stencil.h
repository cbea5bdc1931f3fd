// The inverse kernel between nearby contact pixels: the dense solver's preconditioner where few
// touch.
#pragma once

#include <vector>

#include "physics/contact/contact.h"

namespace papilla {

class StencilPreconditioner {
 public:
  explicit StencilPreconditioner(const ContactKernel& kernel);

  // direction = inverse-kernel stencil on the residual [m] of the free pixels (single precision
  // suffices for a direction), less half of its row sums, which go to `ones` [Pa/m]. The inverse of
  // the kernel between the free pixels alone is softer at their edges than the plane's, whose rows
  // sum to zero: the row sum is what an edge cuts off. balanced: projected to zero mean in its
  // metric.
  void apply(const std::vector<int>& free, const std::vector<double>& residual, bool balanced,
             std::vector<double>& direction, std::vector<double>& ones);

 private:
  static constexpr int kReach = ContactKernel::kReach;

  void spread(int i, float value, float one);

  const ContactKernel& kernel_;
  const Grid& grid_;
  int width_;                             // of the padded images below
  std::vector<float> residual_, inside_;  // of the free pixels; zero between uses
};

}  // namespace papilla
