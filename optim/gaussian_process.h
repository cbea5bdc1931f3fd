// A small Gaussian process: Matern-5/2 with a length per dimension, constant mean, noise;
// parameters by maximum likelihood. For up to a few hundred points.
#pragma once

#include <memory>
#include <vector>

#include "base/rooms.h"
#include "optim/problem.h"

namespace papilla::optim {

struct Prediction {
  double mean = 0, sd = 0;  // of the function, without the noise
};

class GaussianProcess {
 public:
  // Points in the unit cube. Fits lengths, signal and noise by likelihood, started from `before`
  // when given. O(n^3) per likelihood, a few hundred of them.
  GaussianProcess(std::vector<Point> points, std::vector<double> values,
                  const GaussianProcess* before = nullptr);
  ~GaussianProcess();
  GaussianProcess(GaussianProcess&&) noexcept;
  GaussianProcess& operator=(GaussianProcess&&) noexcept;

  Prediction predict(const Point& x) const;
  // Root mean square of the errors of each value when predicted from the others, in its units.
  double leave_one_out_error() const;
  const std::vector<double>& parameters() const;  // log lengths, log noise share

 private:
  struct State;
  std::unique_ptr<State> state_;
};

// Full evaluations explained by drafts: offset + ratio x (process through the drafts) + process
// through what is left. Falls back to the full evaluations alone where drafts do not help: when
// leave-one-out errors say so. Eq. search.7-8
class DraftedProcess {
 public:
  // draft may be null and must outlive this.
  DraftedProcess(const std::vector<Point>& points, const std::vector<double>& values,
                 const GaussianProcess* draft, const DraftedProcess* before = nullptr);

  Prediction predict(const Point& x) const;
  double ratio() const { return ratio_; }

 private:
  const GaussianProcess* draft_ = nullptr;
  double offset_ = 0, ratio_ = 0;
  std::unique_ptr<GaussianProcess> plain_, left_;
};

}  // namespace papilla::optim
