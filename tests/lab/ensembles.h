// Small ensembles whose answers are known.
#pragma once

#include <string>
#include <vector>

#include "base/random.h"
#include "lab/ensemble.h"
#include "lab/noise.h"

namespace papilla::tests {

// Equal members: responses and worth are linear in standard normal numbers of each member.
// response[i] and worth[d]: their coefficients.
inline Ensemble linear_ensemble(int members, const std::vector<std::vector<double>>& responses,
                                const std::vector<std::vector<double>>& worth) {
  Ensemble e;
  e.hypotheses = {"one"};
  RandomStream random(5, "linear ensemble");
  const std::size_t numbers = responses.front().size();
  e.responses.resize(responses.size());
  e.worth.resize(worth.size());
  for (int m = 0; m < members; ++m) {
    e.weights.push_back(1.0 / members);
    e.hypothesis.push_back(0);
    std::vector<double> x;
    for (std::size_t k = 0; k < numbers; ++k) x.push_back(random.normal());
    const auto dot = [&](const std::vector<double>& a) {
      double sum = 0;
      for (std::size_t k = 0; k < numbers; ++k) sum += a[k] * x[k];
      return sum;
    };
    for (std::size_t i = 0; i < responses.size(); ++i) e.responses[i].push_back(dot(responses[i]));
    for (std::size_t d = 0; d < worth.size(); ++d) e.worth[d].push_back(dot(worth[d]));
  }
  e.response_sampling.resize(responses.size());  // none
  e.worth_sampling.resize(worth.size());
  return e;
}

// Of its own scatter alone.
inline Instrument plain_instrument(double repeatability) { return {repeatability, 0, 0, 0}; }

inline Observation observation(std::size_t row, double deviation, std::size_t design = 0) {
  return {row, deviation, design, "1", "1"};
}

}  // namespace papilla::tests
