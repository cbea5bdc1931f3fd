// Levenberg and Marquardt's steps of Ceres: the module papilla_descent.so (optim/descent.h).
#include <ceres/ceres.h>

#include <cmath>

#include "optim/descent.h"

namespace papilla::optim {
namespace {

// Steps in a row that may end where the model has no answer: each is within a region at most half
// as large as that of the one before, so that the last is far below a millionth of the first.
constexpr int kMostInvalidSteps = 20;

class CeresModel final : public ceres::CostFunction {
 public:
  CeresModel(const DescentModel& model, int parameters) : model_(model) {
    set_num_residuals(model.residuals());
    *mutable_parameter_block_sizes() = {parameters};
  }

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override {
    return model_.evaluate(parameters[0], residuals, jacobians ? jacobians[0] : nullptr);
  }

 private:
  const DescentModel& model_;
};

class CeresDescent final : public Descent {
 public:
  DescentOutcome descend(const DescentModel& model, std::vector<double>& x,
                         const std::vector<double>& low, const std::vector<double>& high,
                         const DescentOptions& options) const override {
    ceres::Problem problem;
    problem.AddResidualBlock(new CeresModel(model, static_cast<int>(x.size())), nullptr,
                             x.data());  // the problem owns its model
    for (std::size_t j = 0; j < x.size(); ++j) {
      const int k = static_cast<int>(j);
      if (std::isfinite(low[j])) problem.SetParameterLowerBound(x.data(), k, low[j]);
      if (std::isfinite(high[j])) problem.SetParameterUpperBound(x.data(), k, high[j]);
    }
    ceres::Solver::Options o;
    o.linear_solver_type = ceres::DENSE_QR;
    o.trust_region_strategy_type = ceres::LEVENBERG_MARQUARDT;
    // Within bounds a step that fails is shortened along itself, by values alone: slopes there
    // would take as many evaluations as an iteration.
    o.line_search_interpolation_type = ceres::QUADRATIC;
    o.initial_trust_region_radius = options.region;
    o.max_num_iterations = options.iterations;
    o.function_tolerance = options.tolerance;
    o.parameter_tolerance = options.tolerance;
    o.gradient_tolerance = 1e-30;  // the sum of squares decides: residuals have any scale
    o.max_num_consecutive_invalid_steps = kMostInvalidSteps;
    o.num_threads = 1;
    o.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(o, &problem, &summary);
    return {summary.termination_type == ceres::CONVERGENCE, summary.message,
            summary.num_residual_evaluations + summary.num_jacobian_evaluations};
  }
};

}  // namespace
}  // namespace papilla::optim

extern "C" const papilla::optim::Descent* papilla_descent(int version) {
  static const papilla::optim::CeresDescent descent;
  return version == papilla::optim::kDescentInterface ? &descent : nullptr;
}
