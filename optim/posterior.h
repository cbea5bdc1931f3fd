// What data leave of parameters, as weighted samples: a mixture of wide bells around every minimum
// found, corrected by the model itself. Equations calibration.N: docs/theory/calibration.md.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "optim/least_squares.h"

namespace papilla::optim {

struct PosteriorOptions {
  int starts = 3;     // fits in all: from the parameters' own start, then drawn from the priors
  int samples = 200;  // evaluated with the model
  // The sum of squares is divided by it: 0: the largest of 1 and chi squared per degree of freedom
  // at the best minimum.
  double variance_factor = 0;
  std::uint64_t seed = 1;
  LeastSquaresOptions fit;  // of each start
  std::function<void(const std::string&)> note;
};

// A minimum that a start has led to, other than the better ones before it.
struct Valley {
  std::vector<double> values;  // of the parameters
  double sum = 0;              // chi squared of data and priors
  double share = 0;            // of the weight of all samples
};

// What the model has answered.
struct PosteriorTrial {
  std::vector<double> values;
  std::vector<double> residuals;
};

struct PosteriorSample {
  std::vector<double> values;
  std::vector<double> residuals;
  double sum = 0;            // of their squares and those of the priors
  std::vector<double> from;  // how probable it is that each valley has drawn it
  double weight = 0;         // of all samples 1
  // Logarithm of posterior over proposal, both up to a constant of all samples.
  double log_ratio = 0;
};

struct Posterior {
  std::vector<Valley> valleys;  // best first
  std::vector<PosteriorSample> samples;
  double effective = 0;  // (sum w)^2 / sum w^2: independent samples that these are worth
  double variance_factor = 1;
  int evaluations = 0;
};

// Draws of a mixture of Student distributions, one per valley, whose covariance is that of
// Eq. calibration.2, thinned by what the model has answered before and weighted by importance
// (Eq. calibration.7, calibration.8, calibration.11). first: a fit from the parameters' own start
// where one is at hand, with its trials. The function is called in one order, so the result does
// not depend on its threads. Throws InputError where no start has a minimum.
Posterior sample_posterior(const std::vector<FitParameter>& parameters, int residuals,
                           const ResidualFunction& function, const PosteriorOptions& options,
                           const LeastSquaresFit* first = nullptr,
                           std::vector<PosteriorTrial> trials = {});

// The same samples with the sum of squares divided by another factor.
void reweigh(Posterior& posterior, double variance_factor);

// The logarithm of the sum of what has these logarithms; weights that sum to 1 from them, and the
// effective number of weights.
double log_sum(const std::vector<double>& logarithms);
std::vector<double> normalised(const std::vector<double>& logarithms);
double effective_number(const std::vector<double>& weights);

// Logarithmic predictive score of groups of residuals, each left out: log p(y_g | all others),
// one per group, and the least effective number of samples that one of them stands on. Residuals
// are whitened; log_sd: the sum of the logarithms of the standard deviations of each group.
// Eq. calibration.9
struct LeftOut {
  std::vector<double> scores;
  double least_effective = 0;
};
LeftOut leave_out(const std::vector<PosteriorSample>& samples, double variance_factor,
                  const std::vector<std::vector<std::size_t>>& groups,
                  const std::vector<double>& log_sd);
// Weights of hypotheses from their scores on the same groups: the mean over resampled groups of
// exp(score), normalised (pseudo-BMA+, Yao et al. 2018). Eq. calibration.9
std::vector<double> hypothesis_weights(const std::vector<std::vector<double>>& scores,
                                       std::uint64_t seed);

// A few of many weighted points with weights of their own, whose weighted means and standard
// deviations of every feature are those of all, the deviations widened for the effective number of
// these. Strata: points of one never stand for another; each
// keeps its weight. Eq. calibration.10
struct ChosenPoints {
  std::vector<std::size_t> index;
  std::vector<double> weight;  // of all 1
  double largest_mean = 0;     // difference of a mean, in standard deviations of all
  double least_spread = 1, largest_spread = 1;  // standard deviation over the widened one
};
ChosenPoints choose_points(const std::vector<std::vector<double>>& features,
                           const std::vector<double>& weights, const std::vector<int>& stratum,
                           int count, std::uint64_t seed);

}  // namespace papilla::optim
