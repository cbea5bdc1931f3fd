// Means with standard errors, paired differences, intervals.
#pragma once

#include <span>
#include <vector>

#include "base/rooms.h"

namespace papilla::numerics {

struct Estimate {
  double value = 0;
  double se = 0;  // one standard error of the value

  bool operator==(const Estimate&) const = default;
};

Estimate mean_estimate(std::span<const double> samples);  // se = 0 for one sample
// Ratio of sums a/b with its delta-method standard error over paired samples.
Estimate ratio_estimate(std::span<const double> a, std::span<const double> b);
// A number as the mean of samples, from its values without each of them: samples whose standard
// error is the jackknife error of the number (Tukey 1958). One sample, the number, without those.
std::vector<double> jackknife_samples(double all, std::span<const double> without_each);
// What each sample moves their mean by: the sum of the moves, each by a standard normal number of
// its own, is a draw of its error; their squares sum up to its variance. One sample moves nothing.
std::vector<double> error_moves(std::span<const double> samples);
// What part of a sum of squares is meant, the rest being scatter: k where the sum is `ratio` times
// that of its scatter, by `freedom` degrees of freedom of them, any k from 0 to 1 as likely before;
// se: one standard deviation of k. samples: from how many each scatter is known; 0: it is known.
// Never 0, where a difference of squares would be below it. Eq. search.23, accuracy.18
Estimate meant_share(double ratio, double freedom, std::size_t samples = 0);
double weighted_mean(std::span<const double> values, std::span<const double> weights);
double quantile(std::vector<double> values, double p);  // linear interpolation, p in [0, 1]
// Of weighted values: linear between the middles of their shares, the ends beyond.
double weighted_quantile(std::span<const double> values, std::span<const double> weights, double p);
// Mean and standard deviation of a normal number that is known not to lie below 0.
Estimate not_below_zero(const Estimate& e);
double normal_cdf(double x);
double normal_quantile(double p);
double student_t_quantile(double p, int degrees_of_freedom);  // two-sided intervals: p = 0.975
double student_t_cdf(double t, double degrees_of_freedom);    // to 1e-9; degrees > 0

}  // namespace papilla::numerics
