// A small Gaussian process: Matern-5/2 with a length a dimension, constant mean, noise; parameters
// by maximum likelihood. For up to a few hundred points.
#pragma once

#include <memory>
#include <vector>

#include "optim/problem.h"

namespace papilla {

struct Prediction {
  double mean = 0, sd = 0;  // of the function, without the noise
};

class GaussianProcess {
 public:
  // Points in the unit cube. Fits lengths, signal and noise by likelihood, started from `before`
  // when given. O(n^3) a likelihood, a few hundred of them.
  GaussianProcess(std::vector<Point> points, std::vector<double> values,
                  const GaussianProcess* before = nullptr);
  ~GaussianProcess();
  GaussianProcess(GaussianProcess&&) noexcept;
  GaussianProcess& operator=(GaussianProcess&&) noexcept;

  Prediction predict(const Point& x) const;
  // Error of each value when predicted from the others, in predicted standard deviations.
  std::vector<double> leave_one_out() const;
  const std::vector<double>& parameters() const;  // log lengths, log noise share
  std::vector<double> lengths() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace papilla
