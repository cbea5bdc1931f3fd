#include "metrics/series.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace papilla::metrics {

Series::Series(std::vector<double> values, std::vector<double> weights, Better better)
    : values_(std::move(values)), weights_(std::move(weights)), better_(better) {
  double total = 0;
  for (double w : weights_) total += w;
  for (double& w : weights_) w /= total;
  for (std::size_t i = 0; i < values_.size(); ++i) mean_ += weights_[i] * values_[i];
  double variance = 0;
  for (std::size_t i = 0; i < values_.size(); ++i)
    variance += weights_[i] * square(values_[i] - mean_);
  sd_ = std::sqrt(variance);
  const auto [low, high] = std::minmax_element(values_.begin(), values_.end());
  low_ = static_cast<std::size_t>(low - values_.begin());
  high_ = static_cast<std::size_t>(high - values_.begin());
}

bool Series::defined(Summary summary) const {
  return mean_ != 0 || (summary != Summary::Variation && summary != Summary::Range);
}

double Series::value(Summary summary) const {
  switch (summary) {
    case Summary::Mean:
      return mean_;
    case Summary::Std:
      return sd_;
    case Summary::Variation:
      return sd_ / std::abs(mean_);
    case Summary::Range:
      return (values_[high_] - values_[low_]) / std::abs(mean_);
    default:
      return values_[index(summary)];
  }
}

double Series::error(Summary summary, const std::vector<double>& errors) const {
  double mean_error = 0, sd_error = 0;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    mean_error += weights_[i] * errors[i];
    // d(sd)/d(value_i) = w_i (value_i - mean) / sd
    if (sd_ > 0) sd_error += square(weights_[i] * (values_[i] - mean_) / sd_ * errors[i]);
  }
  sd_error = std::sqrt(sd_error);
  switch (summary) {
    case Summary::Mean:
      return mean_error;
    case Summary::Std:
      return sd_error;
    case Summary::Variation:
      return std::hypot(sd_error, sd_ / mean_ * mean_error) / std::abs(mean_);
    case Summary::Range:
      // A single value is no distance from itself, whatever it is off by.
      return low_ == high_ ? 0 : std::hypot(errors[high_], errors[low_]) / std::abs(mean_);
    default:
      return errors[index(summary)];
  }
}

double Series::shift(Summary summary, const std::vector<double>& changes) const {
  std::vector<double> changed = values_;
  for (std::size_t i = 0; i < changed.size(); ++i) changed[i] += changes[i];
  const Series other(changed, weights_, better_);
  return other.defined(summary) ? other.value(summary) - value(summary) : 0;
}

std::size_t Series::index(Summary summary) const {
  const bool low_is_better = better_ == Better::Lower;
  if (summary == Summary::First) return 0;
  if (summary == Summary::Last) return values_.size() - 1;
  return (summary == Summary::Worst) == low_is_better ? high_ : low_;
}

}  // namespace papilla::metrics
