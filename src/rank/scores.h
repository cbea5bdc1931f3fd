// Scores of candidates on common skins: their order, differences and probabilities.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "base/rooms.h"
#include "metrics/metrics.h"

namespace papilla::rank {

struct Interval {
  double value = 0, low = 0, high = 0;  // 95 %
  // The part of the finger's fitted numbers in it, one standard error; nothing where not asked for.
  std::optional<double> parameters{};

  Interval moved(double by) const;
};
// Error of the mean of samples. steps: of the finger's parameters; empty: not asked for.
Interval interval_of(const std::vector<double>& samples, const StepSamples& steps);

// What the skins that candidate i has not met would move its mean by: as much as they move the mean
// of the candidates that have met most. Without it the luck of few skins orders the candidates.
// Eq. ranking.6
double unmet(const std::vector<std::vector<double>>& samples, std::size_t i);

// Candidates by index. Each has met the first skins of one sequence, some more of them than others.
struct Scores {
  std::vector<std::vector<double>> skins;  // [candidate][skin]; higher is better
  std::vector<StepSamples> steps;          // one per candidate; empty: not asked for
  // Of the members of belief that the steps stand for; empty: the steps are independent directions.
  std::vector<double> member_weights{};

  double mean(std::size_t i) const;  // over all skins that anyone has met, Eq. ranking.6
  // Best first: by the mean, then neighbours as their paired difference says.
  std::vector<std::size_t> order() const;
  // Score of a minus b over the skins that both have, and over the steps of the finger.
  Interval difference(std::size_t a, std::size_t b) const;
  bool decided(std::size_t a, std::size_t b) const;  // the interval of the difference leaves out 0
  // No skin that both have met, and no step, tells them apart: more of them would tell nothing.
  bool equal(std::size_t a, std::size_t b) const;
  // Probability that a is ahead of b: Student's error of the paired difference. Eq. ranking.4
  double probability_ahead(std::size_t a, std::size_t b) const;
  // Probability of each to have the highest score: scores of Student's distribution with the
  // covariance of the common skins. Eq. ranking.3; 4000 draws of stream `index`, an error of 0.8
  // points at most.
  std::vector<double> probabilities(std::uint64_t index) const;

 private:
  StepSamples step_difference(std::size_t a, std::size_t b) const;
  double probability_over_members(std::size_t a, std::size_t b) const;
  std::vector<std::vector<double>> step_moves() const;
  std::vector<std::vector<double>> skin_moves() const;
};

}  // namespace papilla::rank
