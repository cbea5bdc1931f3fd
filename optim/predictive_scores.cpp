// Weights of samples and of hypotheses, by what is left out. Eq. calibration.8-9
#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/random.h"
#include "numerics/statistics.h"
#include "optim/posterior.h"

namespace papilla::optim {

double log_sum(const std::vector<double>& logarithms) {
  const double largest = *std::max_element(logarithms.begin(), logarithms.end());
  double sum = 0;
  for (const double v : logarithms) sum += std::exp(v - largest);
  return largest + std::log(sum);
}

std::vector<double> normalised(const std::vector<double>& logarithms) {
  const double all = log_sum(logarithms);
  std::vector<double> out;
  for (const double v : logarithms) out.push_back(std::exp(v - all));
  return out;
}

double effective_number(const std::vector<double>& weights) {
  double sum = 0, squares = 0;
  for (const double w : weights) {
    sum += w;
    squares += w * w;
  }
  return squares > 0 ? sum * sum / squares : 0;
}

namespace {

LeftOut scores_of(const Posterior& posterior, const std::vector<PosteriorSample>& samples,
                  const std::vector<double>& log_sd) {
  const std::size_t groups = posterior.groups.size();
  LeftOut out;
  out.errors.assign(groups, 0);
  out.least_effective = static_cast<double>(samples.size());
  std::vector<double> with;
  std::vector<std::vector<double>> without(groups);
  for (const PosteriorSample& s : samples) {
    const std::vector<RowTerms> terms =
        posterior.common.terms(s.misses, s.open, posterior.variance_factor, posterior.groups);
    with.push_back(s.log_ratio);
    for (std::size_t g = 0; g < groups; ++g)
      without[g].push_back(s.log_ratio - terms.front().log_likelihood() +
                           terms[1 + g].log_likelihood());
  }
  for (std::size_t g = 0; g < groups; ++g) {
    const double size = static_cast<double>(posterior.groups[g].size()) / 2;
    out.scores.push_back(log_sum(with) - log_sum(without[g]) - log_sd[g] -
                         size * std::log(2 * kPi * posterior.variance_factor));
    out.least_effective = std::min(out.least_effective, effective_number(normalised(without[g])));
  }
  return out;
}

}  // namespace

LeftOut leave_out(const Posterior& posterior, const std::vector<double>& log_sd) {
  LeftOut out = scores_of(posterior, posterior.samples, log_sd);
  if (posterior.halves.empty()) return out;
  // A half has twice the variance of all and all have half of its answers in common with it: their
  // difference has the variance of all.
  for (const std::vector<PosteriorSample>& half : posterior.halves) {
    const LeftOut by_half = scores_of(posterior, half, log_sd);
    for (std::size_t g = 0; g < out.scores.size(); ++g)
      out.errors[g] += square(by_half.scores[g] - out.scores[g]);
  }
  for (double& error : out.errors)
    error = std::sqrt(error / static_cast<double>(posterior.halves.size()));
  return out;
}

std::vector<double> hypothesis_weights(const std::vector<LeftOut>& of, std::uint64_t seed) {
  constexpr int kResamplings = 20000;
  std::vector<double> out(of.size(), 0);
  const std::size_t groups = of.front().scores.size();
  RandomStream random(seed, "hypothesis weights");
  for (int k = 0; k < kResamplings; ++k) {
    std::vector<double> share;  // of the groups: Dirichlet(1, ..., 1)
    double sum = 0;
    for (std::size_t g = 0; g < groups; ++g) {
      share.push_back(-std::log(1 - random.uniform()));
      sum += share.back();
    }
    std::vector<double> totals;
    for (const LeftOut& h : of) {
      double total = 0;
      for (std::size_t g = 0; g < groups; ++g)
        total += static_cast<double>(groups) * share[g] / sum *
                 (h.scores[g] + (h.errors[g] > 0 ? h.errors[g] * random.normal() : 0));
      totals.push_back(total);
    }
    const std::vector<double> w = normalised(totals);
    for (std::size_t h = 0; h < w.size(); ++h) out[h] += w[h] / kResamplings;
  }
  return out;
}

}  // namespace papilla::optim
