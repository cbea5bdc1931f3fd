#include "optim/posterior.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/check.h"
#include "base/constants.h"
#include "base/error.h"
#include "base/random.h"
#include "optim/row_quadratics.h"
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
// Draws outside of the bounds, and those that are thinned out, are drawn again, so often at most.
constexpr int kMostRedraws = 1000000;
// Samples of a stage, which are thinned by all that was answered before them: at least, and as a
// share of those before. More samples so begin with the same ones.
constexpr int kStage = 12;
constexpr double kStageShare = 1.0 / 3;
// Draws that the thinning of a stage is set by; the share of the guess's weight that its cap
// leaves; the share of samples that no guess has thinned.
constexpr int kPilot = 20000;
constexpr double kUncapped = 0.9, kUnthinned = 0.15;
// Sums of squares above the least one, in variance factors, that double the noise of a trial.
constexpr double kFarTrial = 20;

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

// How the draws of a stage are thinned.
struct Thinning {
  RowQuadratics guess;
  double log_cap = 0;  // of guessed posterior over proposal: kept for certain from here on
  double floor = 0;    // least probability that a draw is kept
  double mean = 1;     // probability that a draw is kept
};

class Sampler {
 public:
  Sampler(const std::vector<FitParameter>& parameters, int residuals,
          const ResidualFunction& function, const PosteriorOptions& options,
          std::vector<PosteriorTrial> trials)
      : parameters_(parameters),
        coordinates_(parameters),
        residuals_(residuals),
        options_(options),
        trials_(std::move(trials)),
        function_([this, &function](std::span<const double> p, std::span<double> r) {
          if (!function(p, r)) return false;
          trials_.push_back({{p.begin(), p.end()}, {r.begin(), r.end()}});
          return true;
        }) {}

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
    const double all = log_sum(logs);
    for (Bell& b : bells_) b.log_weight -= all;
  }

  bool inside(const Eigen::VectorXd& x) const {
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      const double v = x(static_cast<Eigen::Index>(i));
      if (v < coordinates_.to(i, parameters_[i].low) || v > coordinates_.to(i, parameters_[i].high))
        return false;
    }
    return true;
  }

  double log_prior(const Eigen::VectorXd& x) const {
    double sum = 0;
    for (std::size_t i = 0; i < parameters_.size(); ++i) {
      if (coordinates_.has_prior(i))
        sum += square(coordinates_.prior_residual(i, x(static_cast<Eigen::Index>(i))));
    }
    return -sum / (2 * out_.variance_factor);
  }

  // Where a point lies from the best minimum, in standard deviations by its bell.
  Eigen::VectorXd from_best(const Eigen::VectorXd& x) const {
    return bells_.front().root.transpose() * (x - bells_.front().middle);
  }

  std::vector<double> log_proposals(const Eigen::VectorXd& x) const {
    std::vector<double> out;
    for (const Bell& b : bells_) out.push_back(b.log_weight + b.log_density(x));
    return out;
  }

  double log_proposal(const Eigen::VectorXd& x) const { return log_sum(log_proposals(x)); }

  Eigen::VectorXd propose(RandomStream& random) const {
    double left = random.uniform();
    std::size_t b = 0;
    while (b + 1 < bells_.size() && left >= std::exp(bells_[b].log_weight))
      left -= std::exp(bells_[b++].log_weight);
    return bells_[b].draw(random);
  }

  // The model's answers so far as quadratics. Eq. calibration.11
  std::optional<RowQuadratics> guess() const {
    std::vector<Eigen::VectorXd> points;
    std::vector<std::vector<double>> residuals;
    std::vector<double> sums;
    double least = kInfinity;
    for (const PosteriorTrial& trial : trials_) {
      const Eigen::VectorXd x = coordinates(trial.values);
      double sum = -2 * out_.variance_factor * log_prior(x);
      for (const double r : trial.residuals) sum += square(r);
      if (!std::isfinite(sum)) continue;
      points.push_back(from_best(x));
      residuals.push_back(trial.residuals);
      sums.push_back(sum);
      least = std::min(least, sum);
    }
    if (points.empty()) return {};
    for (double& sum : sums) sum = 1 + (sum - least) / (kFarTrial * out_.variance_factor);
    return RowQuadratics(points, residuals, sums);
  }

  // Guessed posterior over proposal.
  double log_guess(const RowQuadratics& guess, const Eigen::VectorXd& x) const {
    return guess.log_likelihood(from_best(x), out_.variance_factor) + log_prior(x) -
           log_proposal(x);
  }

  double kept(const Thinning& t, const Eigen::VectorXd& x) const {
    return std::max(t.floor, std::exp(std::min(0.0, log_guess(t.guess, x) - t.log_cap)));
  }

  std::optional<Thinning> thinning(int stage) const {
    std::optional<RowQuadratics> by = guess();
    if (!by) return {};
    RandomStream random(options_.seed, "posterior pilot", static_cast<std::uint64_t>(stage));
    std::vector<double> logs;
    for (int k = 0; k < kPilot; ++k) {
      const Eigen::VectorXd x = propose(random);
      if (inside(x)) logs.push_back(log_guess(*by, x));
    }
    if (logs.empty()) return {};
    std::sort(logs.begin(), logs.end(), std::greater<>());
    // The cap whose draws above it lose a share of all weight.
    const double largest = logs.front(), all = std::exp(log_sum(logs) - largest);
    double above = 0;
    std::size_t cut = 0;
    for (; cut + 1 < logs.size(); ++cut) {
      above += std::exp(logs[cut] - largest);
      const double lost = above - static_cast<double>(cut + 1) * std::exp(logs[cut + 1] - largest);
      if (lost > (1 - kUncapped) * all) break;
    }
    Thinning out{std::move(*by), logs[cut], 0, 0};
    const auto count = static_cast<double>(logs.size());
    for (const double v : logs) out.floor += std::exp(std::min(0.0, v - out.log_cap)) / count;
    out.floor *= kUnthinned;
    for (const double v : logs)
      out.mean += std::max(out.floor, std::exp(std::min(0.0, v - out.log_cap))) / count;
    return out;
  }

  void draw() {
    for (int stage = 0, begin = 0; begin < options_.samples; ++stage) {
      const int most = std::max(kStage, static_cast<int>(begin * kStageShare));
      const int end = std::min(begin + most, options_.samples);
      stages_.push_back({end - begin, thinning(stage)});
      for (int k = begin; k < end; ++k) draw(k, stages_.back().second);
      begin = end;
    }
    weigh();
  }

  void draw(int k, const std::optional<Thinning>& thinned) {
    RandomStream random(options_.seed, "posterior sample", static_cast<std::uint64_t>(k));
    for (int tries = 0; tries < kMostRedraws; ++tries) {
      const Eigen::VectorXd x = propose(random);
      if (!inside(x) || (thinned && random.uniform() >= kept(*thinned, x))) continue;
      add(x);
      break;
    }
    if ((k + 1) % 10 == 0) note(fmt::format("sample {} of {}", k + 1, options_.samples));
  }

  void add(const Eigen::VectorXd& x) {
    PosteriorSample s;
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      s.values.push_back(coordinates_.from(i, x(static_cast<Eigen::Index>(i))));
    s.residuals.resize(static_cast<std::size_t>(residuals_));
    ++out_.evaluations;
    if (!function_(s.values, s.residuals)) return;
    s.sum = -2 * out_.variance_factor * log_prior(x);
    for (const double r : s.residuals) s.sum += square(r);
    if (!std::isfinite(s.sum)) return;
    out_.samples.push_back(std::move(s));
    points_.push_back(x);
  }

  // Posterior over the proposals of all stages. Eq. calibration.8
  void weigh() {
    for (std::size_t k = 0; k < out_.samples.size(); ++k) {
      PosteriorSample& s = out_.samples[k];
      const Eigen::VectorXd& x = points_[k];
      const std::vector<double> logs = log_proposals(x);
      const double all = log_sum(logs);
      double thinned = 0;
      for (const double v : logs) s.from.push_back(std::exp(v - all));
      for (const auto& [count, by] : stages_) thinned += count * (by ? kept(*by, x) / by->mean : 1);
      s.log_ratio = -s.sum / (2 * out_.variance_factor) - all - std::log(thinned);
    }
  }

  const std::vector<FitParameter>& parameters_;
  FitCoordinates coordinates_;
  int residuals_;
  const PosteriorOptions& options_;
  std::vector<PosteriorTrial> trials_;
  ResidualFunction function_;  // keeps what it is answered
  std::vector<LeastSquaresFit> fits_;
  std::vector<Bell> bells_;
  std::vector<std::pair<int, std::optional<Thinning>>> stages_;  // samples of each
  std::vector<Eigen::VectorXd> points_;                          // of the samples
  Posterior out_;
};

}  // namespace

Posterior sample_posterior(const std::vector<FitParameter>& parameters, int residuals,
                           const ResidualFunction& function, const PosteriorOptions& options,
                           const LeastSquaresFit* first, std::vector<PosteriorTrial> trials) {
  PAPILLA_CHECK(options.starts > 0 && options.samples > 0, "a posterior has starts and samples");
  PAPILLA_CHECK(options.fit.threads == 1, "trials are kept in one order");
  return Sampler(parameters, residuals, function, options, std::move(trials)).run(first);
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

}  // namespace papilla::optim
