// The members of a belief as numbers: what each says of every measurable friction and of what every
// design is worth. Equations lab.N: docs/theory/lab.md.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::lab {

// What the model's own few skins leave open of a number, the same at all members: deviations that
// sum by squares to its variance, of the skins of the design's own level and of those that each
// member is moved on. Numbers of the same skins vary together, so the ratio of friction on and off
// is known better than either. Eq. lab.3
struct Sampling {
  std::string skins;  // which: numbers of other skins are independent
  std::vector<double> deviations;
};
double covariance(const Sampling& a, const Sampling& b);

struct Ensemble {
  std::vector<double> weights;          // of the members, all 1
  std::vector<std::size_t> hypothesis;  // of each member
  std::vector<std::string> hypotheses;  // their names
  // [row][member]: logarithm of a friction [N].
  std::vector<std::vector<double>> responses;
  std::vector<Sampling> response_sampling;  // [row]
  // [design][member]: higher is better.
  std::vector<std::vector<double>> worth;
  std::vector<Sampling> worth_sampling;  // [design]

  std::size_t members() const { return weights.size(); }
};

// The weight of each hypothesis by weights of the members.
std::vector<double> weights_by_hypothesis(const Ensemble& e, const std::vector<double>& weights);

// Members as the middles of kernels that fill what lies between them: each is drawn towards the
// mean of its hypothesis by `shrink`, and has the covariance `width`^2 times that of all members
// about the means of their hypotheses. Mean and covariance of all stay. Eq. lab.3
struct Kernels {
  double width = 0, shrink = 1;
  std::vector<std::vector<double>> responses, worth;  // of the middles
  // [row or design][member]: root of the weight times the deviation, so that the covariance of two
  // rows is the sum of products.
  std::vector<std::vector<double>> response_moves, worth_moves;
  // What a member leaves open, by its kernel and by the model's few skins: covariances [row][row],
  // [design][row], [design][design].
  std::vector<std::vector<double>> of_responses, of_worth_and_responses, of_worth;
};
Kernels kernels_of(const Ensemble& ensemble);

}  // namespace papilla::lab
