// The values of one metric over humidity, and what a summary makes of them and of their errors.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "metrics/metrics.h"

namespace papilla::metrics {

class Series {
 public:
  // Values and weights of each humidity, at least one; weights need not add up to 1.
  Series(std::vector<double> values, std::vector<double> weights, Better better);

  // False where a spread would be over a mean of zero.
  bool defined(Summary summary) const;
  // Eq. metrics.1-5
  double value(Summary summary) const;
  // Error of the summary from the errors of the values by one origin.
  double error(Summary summary, const std::vector<double>& errors) const;
  // What the summary changes by when each value does.
  double shift(Summary summary, const std::vector<double>& changes) const;

 private:
  std::size_t index(Summary summary) const;

  std::vector<double> values_, weights_;
  Better better_;
  double mean_ = 0, sd_ = 0;
  std::size_t low_ = 0, high_ = 0;
};

}  // namespace papilla::metrics
