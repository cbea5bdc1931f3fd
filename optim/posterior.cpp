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
#include "optim/posterior_guess.h"
#include "optim/trust_region.h"

namespace papilla::optim {
namespace {

// Minima closer than this, squared in standard deviations of the better one, are one valley.
constexpr double kSameValley = 1;
// Samples of a stage, which are chosen by all that was answered before them: at least, and as a
// share of those before.
constexpr int kStage = 12;
constexpr double kStageShare = 1.0 / 3;
// Draws of the bells that those of a stage are chosen among, and that the posterior is made of.
constexpr int kPilot = 4000, kDraws = 20000, kHalfDraws = 5000;
// Of the draws of a stage, the share of the bells of the fits themselves, whatever is guessed; of
// the rest, the share of the posterior of all rows. Groups left out have what is left.
constexpr double kOfFits = 0.25, kOfAllRows = 0.5;
// The last samples, whose answers the guess is held against; rows that it leaves less open, squared
// in standard deviations of the data, say nothing.
constexpr double kHeldShare = 0.5, kLeastOpen = 1e-4;

// Draws of the bells within the bounds, with the densities of the guess over the bells': of all
// rows, then without each group.
struct Drawn {
  std::vector<Eigen::VectorXd> points;
  std::vector<std::vector<double>> log_over;  // [0 or 1 + group][point]
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
          take_bands_off(r, options_.bands);
          options_.common.whiten(r);
          return true;
        }) {}

  Posterior run(const LeastSquaresFit* first) {
    out_.common = options_.common;
    out_.groups = options_.groups;
    find_minima(first);
    out_.variance_factor = variance_factor(fits_.front().chi2 + fits_.front().prior_chi2);
    of_.emplace(GuessedPosterior{coordinates_, parameters_, options_, out_.variance_factor});
    place_bells();
    ask();
    // A fit of few steps may have ended above what the samples have found.
    out_.least_sum = least_sum();
    out_.variance_factor = of_->variance_factor =
        std::min(out_.variance_factor, variance_factor(out_.least_sum));
    draw();
    return std::move(out_);
  }

 private:
  void note(const std::string& text) const {
    if (options_.note) options_.note(text);
  }

  double variance_factor(double sum) const {
    if (options_.variance_factor > 0) return options_.variance_factor;
    const int freedom = fits_.front().degrees_of_freedom;
    return freedom > 0 ? std::max(1.0, sum / freedom) : 1;
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
        if (trials_.empty()) {  // the function may answer otherwise than to the fit
          std::vector<double> misses(static_cast<std::size_t>(residuals_));
          function_(first->values(), misses);
          ++out_.evaluations;
        }
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

  // The bell of a minimum: of the data's information, that of the priors, and all by the variance
  // factor, of parameters at a bound too. Eq. calibration.2, calibration.7
  Bell bell_of(const LeastSquaresFit& fit) const {
    Eigen::MatrixXd precision = information_of(fit.directions);
    for (Eigen::Index i = 0; i < precision.rows(); ++i)
      precision(i, i) += of_->prior_precision(static_cast<std::size_t>(i));
    return {of_->at(fit.values()), precision / out_.variance_factor};
  }

  // A bell's weight: the root of its volume by Laplace, so that a shallow valley is looked at too;
  // the importance weights put it right.
  void place_bells() {
    const double best = fits_.front().chi2 + fits_.front().prior_chi2;
    for (const LeastSquaresFit& fit : fits_) {
      Bell bell = bell_of(fit);
      const auto& known = valleys_.all();
      if (std::any_of(known.begin(), known.end(),
                      [&](const Bell& b) { return b.squared_distance(bell.middle) < kSameValley; }))
        continue;
      const double sum = fit.chi2 + fit.prior_chi2;
      log_shares_.push_back(-(sum - best) / (4 * out_.variance_factor) - bell.log_size / 2);
      valleys_.add(std::move(bell), log_shares_.back());
      out_.valleys.push_back({fit.values(), sum, 0});
    }
    units_ = {valleys_.all().front().middle, valleys_.all().front().root};
  }

  // Bells of the fits, and around every valley those of the guess, of all rows and without each
  // group. Eq. calibration.7
  Bells bells_by(const PosteriorGuess& guess) const {
    Bells out;
    const double all = log_sum(log_shares_);
    const std::size_t groups = options_.groups.size();
    const double of_all = groups > 0 ? kOfAllRows : 1;
    for (std::size_t v = 0; v < valleys_.all().size(); ++v) {
      const Bell& valley = valleys_.all()[v];
      const double share = log_shares_[v] - all;
      out.add(valley, share + std::log(kOfFits));
      const Bell found = guess.bell(valley.middle, PosteriorGuess::kAllRows);
      for (std::size_t g = 0; g < groups; ++g) {
        out.add(guess.bell(found.middle, g),
                share + std::log((1 - kOfFits) * (1 - of_all) / static_cast<double>(groups)));
      }
      out.add(found, share + std::log((1 - kOfFits) * of_all));
    }
    return out;
  }

  // Units that hold all of a stage's bells: the next guess is a quadratic in them.
  GuessUnits units_of(const Bells& bells) const {
    const auto n = static_cast<Eigen::Index>(parameters_.size());
    Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(n, n);
    for (const Bell& b : bells.all())
      mean += b.covariance() / static_cast<double>(bells.all().size());
    return {bells.all().back().middle, mean.inverse().llt().matrixL()};
  }

  Drawn drawn(const PosteriorGuess& guess, const Bells& bells, int count,
              RandomStream& random) const {
    Drawn out;
    out.log_over.resize(1 + options_.groups.size());
    for (int k = 0; k < count; ++k) {
      Eigen::VectorXd x = bells.draw(random);
      if (!of_->inside(x)) continue;
      const double by = bells.log_density(x);
      const std::vector<double> logs = guess.log_densities(x);
      for (std::size_t g = 0; g < logs.size(); ++g) out.log_over[g].push_back(logs[g] - by);
      out.points.push_back(std::move(x));
    }
    if (out.points.empty()) throw InputError("no draw of the posterior lies within the bounds");
    return out;
  }

  // Logarithms of what each draw is wanted by: half for the posterior of all rows, the rest for
  // what it is without each group.
  std::vector<double> wanted(const Drawn& drawn) const {
    const std::size_t groups = options_.groups.size();
    std::vector<std::vector<double>> logs(drawn.points.size());
    for (std::size_t g = 0; g < drawn.log_over.size(); ++g) {
      const double share = groups == 0 ? 1
                           : g == 0    ? kOfAllRows
                                       : (1 - kOfAllRows) / static_cast<double>(groups);
      const double all = log_sum(drawn.log_over[g]);
      for (std::size_t k = 0; k < logs.size(); ++k)
        logs[k].push_back(std::log(share) + drawn.log_over[g][k] - all);
    }
    std::vector<double> out;
    for (const std::vector<double>& of : logs) out.push_back(log_sum(of));
    return out;
  }

  // By weight and without one twice: the largest of ln w + Gumbel (Efraimidis and Spirakis 2006).
  static std::vector<std::size_t> chosen(const std::vector<double>& log_weights, std::size_t count,
                                         RandomStream& random) {
    std::vector<std::pair<double, std::size_t>> keys;
    for (std::size_t k = 0; k < log_weights.size(); ++k)
      keys.emplace_back(log_weights[k] - std::log(-std::log(1 - random.uniform())), k);
    count = std::min(count, keys.size());
    std::partial_sort(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(count), keys.end(),
                      std::greater<>());
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < count; ++k) out.push_back(keys[k].second);
    return out;
  }

  // The model is asked in stages. Eq. calibration.11
  void ask() {
    for (int stage = 0, begin = 0; begin < options_.samples; ++stage) {
      const int most = std::max(kStage, static_cast<int>(begin * kStageShare));
      const int end = std::min(begin + most, options_.samples);
      RandomStream random(options_.seed, "posterior stage", static_cast<std::uint64_t>(stage));
      const PosteriorGuess guess(*of_, trials_, units_);
      const Bells bells = bells_by(guess);
      const Drawn found = drawn(guess, bells, kPilot, random);
      for (const std::size_t k :
           chosen(wanted(found), static_cast<std::size_t>(end - begin), random))
        ask(found.points[k], guess, begin >= kHeldShare * options_.samples);
      units_ = units_of(bells);
      begin = end;
      note(fmt::format("sample {} of {}", end, options_.samples));
    }
    if (out_.asked == 0) throw InputError("no sample of the posterior has an answer of the model");
    if (held_ > 0) out_.guess_error = std::sqrt(out_.guess_error / held_);
  }

  void ask(const Eigen::VectorXd& x, const PosteriorGuess& guess, bool held) {
    std::vector<double> values, misses(static_cast<std::size_t>(residuals_));
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      values.push_back(coordinates_.from(i, x(static_cast<Eigen::Index>(i))));
    const RowQuadratics::Rows before = guess.rows(x);
    ++out_.evaluations;
    if (!function_(values, misses)) return;
    ++out_.asked;
    options_.common.colour(misses);
    for (std::size_t k = 0; held && k < misses.size(); ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      if (before.variance(row) < kLeastOpen) continue;
      out_.guess_error += square(misses[k] - before.miss(row)) / before.variance(row);
      ++held_;
    }
  }

  void draw() {
    out_.samples = samples_by(trials_, kDraws);
    if (trials_.size() > 1) {
      for (std::size_t half = 0; half < 2; ++half) {
        std::vector<PosteriorTrial> every_second;
        for (std::size_t k = half; k < trials_.size(); k += 2) every_second.push_back(trials_[k]);
        out_.halves.push_back(samples_by(every_second, kHalfDraws));
      }
    }
    reweigh(out_, out_.variance_factor);
  }

  // Draws of what these answers say, weighted by importance. Eq. calibration.8
  std::vector<PosteriorSample> samples_by(const std::vector<PosteriorTrial>& trials,
                                          int count) const {
    std::vector<PosteriorSample> out;
    RandomStream random(options_.seed, "posterior");
    const PosteriorGuess guess(*of_, trials, units_);
    const Bells bells = bells_by(guess);
    for (const Eigen::VectorXd& x : drawn(guess, bells, count, random).points) {
      PosteriorSample& s = out.emplace_back();
      for (std::size_t i = 0; i < parameters_.size(); ++i)
        s.values.push_back(coordinates_.from(i, x(static_cast<Eigen::Index>(i))));
      const RowQuadratics::Rows rows = guess.rows(x);
      s.answers.assign(rows.answer.begin(), rows.answer.end());
      s.misses.assign(rows.miss.begin(), rows.miss.end());
      s.open.assign(rows.variance.begin(), rows.variance.end());
      s.prior_sum = -2 * out_.variance_factor * of_->log_prior(x);
      s.log_proposal = bells.log_density(x);
      const std::vector<double> logs = valleys_.log_densities(x);
      for (const double v : logs) s.from.push_back(std::exp(v - log_sum(logs)));
    }
    return out;
  }

  double least_sum() const {
    double out = kInfinity;
    for (const PosteriorTrial& trial : trials_) {
      std::vector<double> misses = trial.answers;
      take_bands_off(misses, options_.bands);
      out = std::min(out, options_.common.terms(misses, {}, 1, {}).front().squares -
                              2 * out_.variance_factor * of_->log_prior(of_->at(trial.values)));
    }
    return out;
  }

  const std::vector<FitParameter>& parameters_;
  FitCoordinates coordinates_;
  int residuals_;
  const PosteriorOptions& options_;
  std::vector<PosteriorTrial> trials_;
  ResidualFunction function_;  // keeps what it is answered
  std::vector<LeastSquaresFit> fits_;
  std::optional<GuessedPosterior> of_;
  Bells valleys_;
  std::vector<double> log_shares_;  // of the valleys
  GuessUnits units_;
  int held_ = 0;  // answers that the guess was held against
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
  const auto normalised_ratios = [&](std::vector<PosteriorSample>& samples) {
    std::vector<double> logs;
    for (PosteriorSample& s : samples) {
      s.log_ratio =
          posterior.common.terms(s.misses, s.open, variance_factor, {}).front().log_likelihood() -
          s.prior_sum / (2 * variance_factor) - s.log_proposal;
      logs.push_back(s.log_ratio);
    }
    return normalised(logs);
  };
  for (std::vector<PosteriorSample>& half : posterior.halves) normalised_ratios(half);
  const std::vector<double> weights = normalised_ratios(posterior.samples);
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
