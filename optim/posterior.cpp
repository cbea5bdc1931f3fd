#include "optim/posterior.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/constants.h"
#include "base/error.h"
#include "base/random.h"
#include "optim/trust_region.h"

namespace papilla::optim {
namespace {

// Tails of the proposal: wider than the bell that they stand around, so that no weight is far above
// the others (Geweke 1989).
constexpr int kFreedom = 7;
// Precision that a parameter without a prior gets beside its data, per square of a quarter of its
// range: the whole range lies within one standard deviation.
constexpr double kFlatPrecision = 0.25;
// Minima closer than this, squared in standard deviations of the better one, are one valley.
constexpr double kSameValley = 1;
// Draws outside of the bounds are drawn again, so often at most.
constexpr int kMostRedraws = 1000;

// A Student distribution around a minimum, in the coordinates of the fit.
struct Bell {
  Eigen::VectorXd middle;
  Eigen::MatrixXd root;  // lower triangle: precision = root root'
  double log_size = 0;   // log of the root's determinant
  double log_weight = 0;

  double squared_distance(const Eigen::VectorXd& x) const {
    return (root.transpose() * (x - middle)).squaredNorm();
  }
  double log_density(const Eigen::VectorXd& x) const {
    const auto n = static_cast<double>(x.size());
    return log_size - (kFreedom + n) / 2 * std::log1p(squared_distance(x) / kFreedom);
  }
  Eigen::VectorXd draw(RandomStream& random) const {
    Eigen::VectorXd z(middle.size());
    for (Eigen::Index i = 0; i < z.size(); ++i) z(i) = random.normal();
    double squares = 0;
    for (int k = 0; k < kFreedom; ++k) squares += square(random.normal());
    return middle +
           root.transpose().triangularView<Eigen::Upper>().solve(z) * std::sqrt(kFreedom / squares);
  }
};

double sum_exp(const std::vector<double>& logarithms, double& largest) {
  largest = -kInfinity;
  for (const double v : logarithms) largest = std::max(largest, v);
  double sum = 0;
  for (const double v : logarithms) sum += std::exp(v - largest);
  return sum;
}

class Sampler {
 public:
  Sampler(const std::vector<FitParameter>& parameters, int residuals,
          const ResidualFunction& function, const PosteriorOptions& options)
      : parameters_(parameters),
        coordinates_(parameters),
        residuals_(residuals),
        function_(function),
        options_(options) {}

  Posterior run(const LeastSquaresFit* first) {
    find_minima(first);
    out_.variance_factor = options_.variance_factor;
    if (!(out_.variance_factor > 0)) {
      const LeastSquaresFit& best = fits_.front();
      out_.variance_factor =
          best.degrees_of_freedom > 0
              ? std::max(1.0, (best.chi2 + best.prior_chi2) / best.degrees_of_freedom)
              : 1;
    }
    place_bells();
    draw();
    if (out_.samples.empty())
      throw InputError("no sample of the posterior has an answer of the model");
    reweigh(out_, out_.variance_factor);
    return std::move(out_);
  }

 private:
  void note(const std::string& text) const {
    if (options_.note) options_.note(text);
  }

  // A start from the priors; from the whole range without one.
  std::vector<FitParameter> start(int k) const {
    std::vector<FitParameter> out = parameters_;
    RandomStream random(options_.seed, "posterior start", static_cast<std::uint64_t>(k));
    for (std::size_t i = 0; i < out.size(); ++i) {
      const FitParameter& p = parameters_[i];
      const double low = coordinates_.to(i, p.low), high = coordinates_.to(i, p.high);
      double x = 0;
      if (coordinates_.has_prior(i))
        x = coordinates_.to(i, p.prior) + random.normal() / coordinates_.prior_slope(i);
      else if (std::isfinite(low) && std::isfinite(high))
        x = random.uniform(low, high);
      else
        x = coordinates_.to(i, p.start) + random.normal();
      out[i].start = coordinates_.from(i, std::clamp(x, low, high));
    }
    return out;
  }

  void find_minima(const LeastSquaresFit* first) {
    for (int k = 0; k < options_.starts; ++k) {
      if (k == 0 && first) {
        fits_.push_back(*first);
        continue;
      }
      note(fmt::format("start {} of {}", k + 1, options_.starts));
      fits_.push_back(
          least_squares(k == 0 ? parameters_ : start(k), residuals_, function_, options_.fit));
      out_.evaluations += fits_.back().evaluations;
    }
    std::erase_if(fits_, [](const LeastSquaresFit& f) {
      return !std::isfinite(f.chi2 + f.prior_chi2) || f.directions.empty();
    });
    if (fits_.empty()) throw InputError("no start of the fit has an answer of the model");
    std::stable_sort(fits_.begin(), fits_.end(), [](const auto& a, const auto& b) {
      return a.chi2 + a.prior_chi2 < b.chi2 + b.prior_chi2;
    });
  }

  Eigen::VectorXd coordinates(const std::vector<double>& values) const {
    Eigen::VectorXd x(static_cast<Eigen::Index>(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i)
      x(static_cast<Eigen::Index>(i)) = coordinates_.to(i, values[i]);
    return x;
  }

  // The bell of a minimum: of the data's information, that of the priors, and all by the variance
  // factor, of parameters at a bound too. Eq. calibration.2, calibration.7
  Bell bell_of(const LeastSquaresFit& fit) const {
    const auto n = static_cast<Eigen::Index>(parameters_.size());
    Eigen::MatrixXd precision = Eigen::MatrixXd::Zero(n, n);
    for (const FitDirection& d : fit.directions) {
      const Eigen::Map<const Eigen::VectorXd> v(d.weights.data(), n);
      precision += square(d.singular_value) * v * v.transpose();
    }
    for (Eigen::Index i = 0; i < n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      precision(i, i) +=
          coordinates_.has_prior(k) ? square(coordinates_.prior_slope(k)) : kFlatPrecision;
    }
    Bell out{coordinates(fit.values()), {}, 0, 0};
    out.root = (precision / out_.variance_factor).llt().matrixL();
    out.log_size = out.root.diagonal().array().log().sum();
    return out;
  }

  // A bell's weight: the root of its volume by Laplace, so that a shallow valley is looked at too;
  // the importance weights put it right.
  void place_bells() {
    const double best = fits_.front().chi2 + fits_.front().prior_chi2;
    for (const LeastSquaresFit& fit : fits_) {
      Bell bell = bell_of(fit);
      const bool known = std::any_of(bells_.begin(), bells_.end(), [&](const Bell& b) {
        return b.squared_distance(bell.middle) < kSameValley;
      });
      if (known) continue;
      const double sum = fit.chi2 + fit.prior_chi2;
      bell.log_weight = -(sum - best) / (4 * out_.variance_factor) - bell.log_size / 2;
      bells_.push_back(std::move(bell));
      out_.valleys.push_back({fit.values(), sum, 0});
    }
    std::vector<double> logs;
    for (const Bell& b : bells_) logs.push_back(b.log_weight);
    double largest = 0;
    const double sum = sum_exp(logs, largest);
    for (Bell& b : bells_) b.log_weight -= largest + std::log(sum);
  }

  bool inside(const Eigen::VectorXd& x) const {
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      const double v = x(static_cast<Eigen::Index>(i));
      if (v < coordinates_.to(i, parameters_[i].low) || v > coordinates_.to(i, parameters_[i].high))
        return false;
    }
    return true;
  }

  void draw() {
    for (int k = 0; k < options_.samples; ++k) {
      RandomStream random(options_.seed, "posterior sample", static_cast<std::uint64_t>(k));
      Eigen::VectorXd x;
      int tries = 0;
      do {
        double left = random.uniform();
        std::size_t b = 0;
        while (b + 1 < bells_.size() && left >= std::exp(bells_[b].log_weight))
          left -= std::exp(bells_[b++].log_weight);
        x = bells_[b].draw(random);
      } while (!inside(x) && ++tries < kMostRedraws);
      if (!inside(x)) continue;
      add(x);
      if ((k + 1) % 10 == 0) note(fmt::format("sample {} of {}", k + 1, options_.samples));
    }
  }

  // Posterior over proposal. Eq. calibration.8
  void add(const Eigen::VectorXd& x) {
    PosteriorSample s;
    double sum = 0;
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      const double v = x(static_cast<Eigen::Index>(i));
      s.values.push_back(coordinates_.from(i, v));
      if (coordinates_.has_prior(i)) sum += square(coordinates_.prior_residual(i, v));
    }
    s.residuals.resize(static_cast<std::size_t>(residuals_));
    ++out_.evaluations;
    if (!function_(s.values, s.residuals)) return;
    for (const double r : s.residuals) sum += square(r);
    if (!std::isfinite(sum)) return;
    std::vector<double> logs;
    for (const Bell& b : bells_) logs.push_back(b.log_weight + b.log_density(x));
    double largest = 0;
    const double all = sum_exp(logs, largest);
    s.log_ratio = -sum / (2 * out_.variance_factor) - largest - std::log(all);
    s.sum = sum;
    for (const double v : logs) s.from.push_back(std::exp(v - largest) / all);
    out_.samples.push_back(std::move(s));
  }

  const std::vector<FitParameter>& parameters_;
  FitCoordinates coordinates_;
  int residuals_;
  const ResidualFunction& function_;
  const PosteriorOptions& options_;
  std::vector<LeastSquaresFit> fits_;
  std::vector<Bell> bells_;
  Posterior out_;
};

}  // namespace

Posterior sample_posterior(const std::vector<FitParameter>& parameters, int residuals,
                           const ResidualFunction& function, const PosteriorOptions& options,
                           const LeastSquaresFit* first) {
  PAPILLA_CHECK(options.starts > 0 && options.samples > 0, "a posterior has starts and samples");
  return Sampler(parameters, residuals, function, options).run(first);
}

void reweigh(Posterior& posterior, double variance_factor) {
  const double change = 1 / posterior.variance_factor - 1 / variance_factor;
  std::vector<double> logs;
  for (PosteriorSample& s : posterior.samples) {
    s.log_ratio += s.sum / 2 * change;
    logs.push_back(s.log_ratio);
  }
  const std::vector<double> weights = normalised(logs);
  for (Valley& v : posterior.valleys) v.share = 0;
  for (std::size_t k = 0; k < weights.size(); ++k) {
    posterior.samples[k].weight = weights[k];
    for (std::size_t b = 0; b < posterior.valleys.size(); ++b)
      posterior.valleys[b].share += weights[k] * posterior.samples[k].from[b];
  }
  posterior.effective = effective_number(weights);
  posterior.variance_factor = variance_factor;
}

std::vector<double> normalised(const std::vector<double>& logarithms) {
  double largest = 0;
  const double sum = sum_exp(logarithms, largest);
  std::vector<double> out;
  for (const double v : logarithms) out.push_back(std::exp(v - largest) / sum);
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

LeftOut leave_out(const std::vector<PosteriorSample>& samples, double variance_factor,
                  const std::vector<std::vector<std::size_t>>& groups,
                  const std::vector<double>& log_sd) {
  LeftOut out;
  out.least_effective = static_cast<double>(samples.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    std::vector<double> with, without;
    for (const PosteriorSample& s : samples) {
      double sum = 0;
      for (const std::size_t row : groups[g]) sum += square(s.residuals[row]);
      with.push_back(s.log_ratio);
      without.push_back(s.log_ratio + sum / (2 * variance_factor));
    }
    double largest_with = 0, largest_without = 0;
    const double all = sum_exp(with, largest_with), others = sum_exp(without, largest_without);
    const double size = static_cast<double>(groups[g].size()) / 2;
    out.scores.push_back(largest_with + std::log(all) - largest_without - std::log(others) -
                         log_sd[g] - size * std::log(2 * kPi * variance_factor));
    out.least_effective = std::min(out.least_effective, effective_number(normalised(without)));
  }
  return out;
}

std::vector<double> hypothesis_weights(const std::vector<std::vector<double>>& scores,
                                       std::uint64_t seed) {
  constexpr int kResamplings = 2000;
  std::vector<double> out(scores.size(), 0);
  const std::size_t groups = scores.front().size();
  RandomStream random(seed, "hypothesis weights");
  for (int k = 0; k < kResamplings; ++k) {
    std::vector<double> share;  // of the groups: Dirichlet(1, ..., 1)
    double sum = 0;
    for (std::size_t g = 0; g < groups; ++g) {
      share.push_back(-std::log(1 - random.uniform()));
      sum += share.back();
    }
    std::vector<double> totals;
    for (const std::vector<double>& s : scores) {
      double total = 0;
      for (std::size_t g = 0; g < groups; ++g)
        total += static_cast<double>(groups) * share[g] / sum * s[g];
      totals.push_back(total);
    }
    const std::vector<double> w = normalised(totals);
    for (std::size_t h = 0; h < w.size(); ++h) out[h] += w[h] / kResamplings;
  }
  return out;
}

}  // namespace papilla::optim
