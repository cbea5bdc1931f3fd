// What data leave of parameters, as weighted samples: a mixture of wide bells around every minimum
// found, corrected by the model itself. Equations calibration.N: docs/theory/calibration.md.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "optim/common_errors.h"
#include "optim/least_squares.h"
#include "optim/row_quadratics.h"

namespace papilla::optim {

struct PosteriorOptions {
  int starts = 3;     // fits in all: from the parameters' own start, then drawn from the priors
  int samples = 200;  // asked of the model
  // The sum of squares is divided by it: 0: the largest of 1 and chi squared per degree of freedom
  // at the best minimum.
  double variance_factor = 0;
  std::uint64_t seed = 1;
  // What the function's answers are held against, one per row; empty: against 0.
  std::vector<RowBand> bands;
  CommonErrors common;  // of the rows, beside an error of deviation 1 of each
  // Rows that are left out together, where half of the draws are to know of it; empty: none are.
  std::vector<std::vector<std::size_t>> groups;
  LeastSquaresOptions fit;  // of each start
  std::function<void(const std::string&)> note;
};

// A minimum that a start has led to, other than the better ones before it.
struct Valley {
  std::vector<double> values;  // of the parameters
  double sum = 0;              // chi squared of data and priors
  double share = 0;            // of the weight of all samples
};

// What the model has answered, in standard deviations from the data, inside of bands too.
struct PosteriorTrial {
  std::vector<double> values;
  std::vector<double> answers;
};

// A draw; its rows are the guess of Eq. calibration.11.
struct PosteriorSample {
  std::vector<double> values;
  std::vector<double> answers;  // in standard deviations from the data
  std::vector<double> misses;   // the same from the bands
  std::vector<double> open;     // variance of what the guess leaves open of each
  double prior_sum = 0;         // of the squares of the priors
  std::vector<double> from;     // how probable it is that it belongs to each valley
  double weight = 0;            // of all samples 1
  double log_proposal = 0;
  double log_ratio = 0;  // of posterior over proposal, both up to a constant of all samples
};

struct Posterior {
  std::vector<Valley> valleys;  // best first
  std::vector<PosteriorSample> samples;
  // Fewer draws, of what every second answer alone says and of what the others say: how far they
  // differ is how much chance there is in a guess.
  std::vector<std::vector<PosteriorSample>> halves;
  double effective = 0;  // (sum w)^2 / sum w^2: independent samples that these are worth
  int asked = 0;         // samples that the model has answered
  double least_sum = 0;  // chi squared of data and priors of the best answer
  // Root mean square of what the guess missed the later answers by, in its own standard deviations.
  double guess_error = 0;
  double variance_factor = 1;
  CommonErrors common;                           // of the rows
  std::vector<std::vector<std::size_t>> groups;  // of rows that are left out together
  int evaluations = 0;
};

// The rows are learnt from what the model answers where the posterior of those before is high, and
// are drawn from with what they leave open (Eq. calibration.7, calibration.8, calibration.11). The
// function answers in standard deviations from the data (`PosteriorOptions::bands`). first: a fit
// from the parameters' own start where one is at hand, with its trials. The function is called in
// one order, so the result does not depend on its threads. Throws InputError where no start has a
// minimum.
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

// Logarithmic predictive score of the posterior's groups of rows, each left out: log p(y_g | all
// others), one per group with the standard deviation that the halves leave it, and the least
// effective number of samples that one of them stands on. log_sd: the sum of the logarithms of the
// own standard deviations of each group's rows. Eq. calibration.9
struct LeftOut {
  std::vector<double> scores, errors;
  double least_effective = 0;
};
LeftOut leave_out(const Posterior& posterior, const std::vector<double>& log_sd);
// Weights of hypotheses from their scores on the same groups: the mean over resampled groups, and
// over what each score may be off, of exp(score), normalised (pseudo-BMA+, Yao et al. 2018).
// Eq. calibration.9
std::vector<double> hypothesis_weights(const std::vector<LeftOut>& of, std::uint64_t seed);

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
