// A posterior in closed form, and the values and weights of samples.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/random.h"
#include "base/rooms.h"
#include "optim/posterior.h"

namespace papilla::tests {

// y = A p + noise of 1, priors of 2 around 0.5: a posterior in closed form.
struct Linear {
  Eigen::MatrixXd a = Eigen::MatrixXd(6, 3);
  Eigen::VectorXd y = Eigen::VectorXd(6);
  std::vector<FitParameter> parameters;

  explicit Linear(std::uint64_t seed) {
    a << 1, 0.5, -0.2, 0.3, 2, 0.1, -0.4, 0.2, 1.5, 1, 1, 1, 0.2, -1, 0.7, 2, 0, -1;
    RandomStream random(seed, "planted");
    truth = Eigen::VectorXd(3);
    for (Eigen::Index i = 0; i < 3; ++i) truth(i) = 0.5 + 2 * random.normal();
    y = a * truth;
    for (Eigen::Index i = 0; i < y.size(); ++i) y(i) += random.normal();
    for (const char* name : {"a", "b", "c"}) {
      parameters.push_back({.name = name,
                            .start = 0.5,
                            .low = -30,
                            .high = 30,
                            .prior = 0.5,
                            .prior_sd = 2,
                            .step = 1e-3});
    }
  }

  ResidualFunction misses() const {
    return [this](std::span<const double> p, std::span<double> r) {
      const Eigen::VectorXd miss = a * Eigen::Map<const Eigen::VectorXd>(p.data(), 3) - y;
      std::copy(miss.begin(), miss.end(), r.begin());
      return true;
    };
  }
  Eigen::MatrixXd covariance() const {
    return (a.transpose() * a + Eigen::MatrixXd::Identity(3, 3) / 4).inverse();
  }
  Eigen::VectorXd mean() const {
    return covariance() * (a.transpose() * y + Eigen::VectorXd::Constant(3, 0.5 / 4));
  }

  Eigen::VectorXd truth;
};

inline PosteriorOptions known(int samples, int starts = 1) {
  PosteriorOptions out;
  out.starts = starts;
  out.samples = samples;
  out.variance_factor = 1;
  return out;
}

inline std::vector<double> values_of(const Posterior& posterior, std::size_t i) {
  std::vector<double> out;
  for (const PosteriorSample& s : posterior.samples) out.push_back(s.values[i]);
  return out;
}
inline std::vector<double> weights_of(const Posterior& posterior) {
  std::vector<double> out;
  for (const PosteriorSample& s : posterior.samples) out.push_back(s.weight);
  return out;
}

}  // namespace papilla::tests
