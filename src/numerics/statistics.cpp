#include "numerics/statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/check.h"
#include "base/constants.h"

namespace papilla::numerics {

Estimate mean_estimate(std::span<const double> samples) {
  const auto n = static_cast<double>(samples.size());
  if (samples.empty()) return {};
  double mean = 0;
  for (double x : samples) mean += x;
  mean /= n;
  double sum = 0;
  for (double x : samples) sum += square(x - mean);
  return {mean, samples.size() > 1 ? std::sqrt(sum / (n - 1) / n) : 0};
}

Estimate ratio_estimate(std::span<const double> a, std::span<const double> b) {
  PAPILLA_CHECK(a.size() == b.size(), "paired samples");
  double sum_a = 0, sum_b = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum_a += a[i];
    sum_b += b[i];
  }
  const double ratio = sum_a / sum_b;
  const auto n = static_cast<double>(a.size());
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += square(a[i] - ratio * b[i]);
  const double se = a.size() > 1 ? std::sqrt(sum / (n - 1) * n) / std::abs(sum_b) : 0;
  return {ratio, se};
}

std::vector<double> jackknife_samples(double all, std::span<const double> without_each) {
  if (without_each.empty()) return {all};
  const double mean = mean_estimate(without_each).value;
  std::vector<double> out;
  for (const double rest : without_each)
    out.push_back(all - (static_cast<double>(without_each.size()) - 1) * (rest - mean));
  return out;
}

std::vector<double> error_moves(std::span<const double> samples) {
  std::vector<double> out;
  const auto n = static_cast<double>(samples.size());
  double mean = 0;
  for (const double sample : samples) mean += sample / n;
  for (const double sample : samples)
    out.push_back((sample - mean) / std::sqrt(n * std::max(1.0, n - 1)));
  return out;
}

Estimate meant_share(double ratio, double freedom, std::size_t samples) {
  if (!(ratio > 0)) return {};
  constexpr int kNodes = 200;
  constexpr double kNegligible = 16;  // e^-16 of the likelihood
  // u = 1 - k goes with a power of itself below its most likely value, min(1, 1/ratio): in its
  // logarithm all scales are alike.
  const double last = std::log(std::max(1.0, ratio)) + kNegligible / (1 + freedom / 2);
  const double others = static_cast<double>(samples) - 1;
  // Its logarithm at u = exp(x), of ratio u by Fisher's distribution.
  const auto likelihood = [&](double x, double u) {
    return 0.5 * freedom *
           (x - (samples == 0 ? ratio * u
                              : static_cast<double>(samples) * std::log1p(ratio * u / others)));
  };
  const double likely = std::min(1.0, 1 / ratio), most = likelihood(std::log(likely), likely);
  double sum = 0, first = 0, second = 0;
  for (int i = 0; i <= kNodes; ++i) {  // Simpson's rule
    const double x = -last * i / kNodes, u = std::exp(x);
    const double rule = i == 0 || i == kNodes ? 1 : i % 2 == 1 ? 4 : 2;
    const double weight = rule * u * std::exp(likelihood(x, u) - most);
    sum += weight;
    first += weight * u;
    second += weight * u * u;
  }
  const double scatter = first / sum;
  return {1 - scatter, std::sqrt(std::max(0.0, second / sum - scatter * scatter))};
}

double weighted_mean(std::span<const double> values, std::span<const double> weights) {
  return std::inner_product(values.begin(), values.end(), weights.begin(), 0.0) /
         std::accumulate(weights.begin(), weights.end(), 0.0);
}

double quantile(std::vector<double> values, double p) {
  PAPILLA_CHECK(!values.empty(), "quantile of nothing");
  std::sort(values.begin(), values.end());
  const double position = std::clamp(p, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto low = static_cast<std::size_t>(position);
  const std::size_t high = std::min(low + 1, values.size() - 1);
  return values[low] + (position - static_cast<double>(low)) * (values[high] - values[low]);
}

double weighted_quantile(std::span<const double> values, std::span<const double> weights,
                         double p) {
  PAPILLA_CHECK(!values.empty() && values.size() == weights.size(), "a weight for each value");
  std::vector<std::size_t> order(values.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  double total = 0;
  for (const double w : weights) total += w;
  double below = 0, last = 0, middle_of_last = 0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const double share = weights[order[k]] / total, middle = below + share / 2,
                 value = values[order[k]];
    if (p <= middle) {
      if (k == 0 || !(middle > middle_of_last)) return value;
      return last + (value - last) * (p - middle_of_last) / (middle - middle_of_last);
    }
    below += share;
    last = value;
    middle_of_last = middle;
  }
  return last;
}

Estimate not_below_zero(const Estimate& e) {
  if (!(e.se > 0)) return {std::max(e.value, 0.0), 0};
  const double z = e.value / e.se;
  // Where nearly all would lie below 0 the rest falls off as an exponential does.
  constexpr double kFarBelow = -30;
  if (z < kFarBelow) return {-e.se / z, -e.se / z};
  const double hazard = std::exp(-z * z / 2) / std::sqrt(2 * kPi) / normal_cdf(z);
  return {e.value + e.se * hazard, e.se * std::sqrt(1 - hazard * (z + hazard))};
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

double normal_quantile(double p) {
  PAPILLA_CHECK(p > 0 && p < 1, "probability");
  double low = -40, high = 40;
  for (int i = 0; i < 200 && high - low > 1e-14 * std::max(1.0, std::abs(low)); ++i) {
    const double middle = 0.5 * (low + high);
    (normal_cdf(middle) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double student_t_quantile(double p, int degrees_of_freedom) {
  // Cornish-Fisher in 1/n from the normal quantile (Abramowitz & Stegun 26.7.5), exact for n =
  // 1, 2.
  if (degrees_of_freedom < 1) return std::numeric_limits<double>::infinity();
  if (degrees_of_freedom == 1) return std::tan(kPi * (p - 0.5));
  if (degrees_of_freedom == 2) return (2 * p - 1) / std::sqrt(2 * p * (1 - p));
  const double n = degrees_of_freedom, x = normal_quantile(p), x2 = x * x;
  return x + x * (x2 + 1) / (4 * n) + x * ((5 * x2 + 16) * x2 + 3) / (96 * n * n) +
         x * (((3 * x2 + 19) * x2 + 17) * x2 - 15) / (384 * n * n * n) +
         x * ((((79 * x2 + 776) * x2 + 1482) * x2 - 1920) * x2 - 945) / (92160 * n * n * n * n);
}

namespace {

// Regularised incomplete beta function by its continued fraction (Abramowitz & Stegun 26.5.8,
// evaluated by Lentz's method), x < (a + 1) / (a + b + 2).
double incomplete_beta(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  const double front = std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) +
                                a * std::log(x) + b * std::log1p(-x)) /
                       a;
  const auto away_from_0 = [](double v) { return std::abs(v) < kTiny ? kTiny : v; };
  double c = 1, d = 1 / away_from_0(1 - (a + b) * x / (a + 1)), sum = d;
  for (int m = 1; m < 500; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m));
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
    double change = 1;
    for (const double term : {even, odd}) {
      d = 1 / away_from_0(1 + term * d);
      c = away_from_0(1 + term / c);
      change = c * d;
      sum *= change;
    }
    if (std::abs(change - 1) < 1e-14) break;
  }
  return front * sum;
}

}  // namespace

double student_t_cdf(double t, double degrees_of_freedom) {
  const double n = degrees_of_freedom, x = n / (n + t * t);
  const double a = 0.5 * n, b = 0.5;
  if (t == 0) return 0.5;
  // Nearly normal (Abramowitz & Stegun 26.7.8, an error of order 1/n^2), where the fraction loses
  // digits.
  constexpr double kNearlyNormal = 1e5;
  if (n > kNearlyNormal) return normal_cdf(t * (1 - 0.25 / n) / std::sqrt(1 + 0.5 * t * t / n));
  // Both tails; the fraction converges on one side of the mean of the distribution.
  const double tails =
      x < (a + 1) / (a + b + 2) ? incomplete_beta(a, b, x) : 1 - incomplete_beta(b, a, 1 - x);
  return t > 0 ? 1 - 0.5 * tails : 0.5 * tails;
}

}  // namespace papilla::numerics
