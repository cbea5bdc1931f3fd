#include "optim/gaussian_process.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"
#include "base/constants.h"
#include "base/random.h"

namespace papilla::optim {
namespace {

double matern(double r) {
  const double s = std::sqrt(5.0) * r;
  return (1 + s + s * s / 3) * std::exp(-s);
}

double scaled_distance(const Point& a, const Point& b, const std::vector<double>& inverse_lengths) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += square((a[k] - b[k]) * inverse_lengths[k]);
  return std::sqrt(sum);
}

std::vector<double> inverse_lengths(const std::vector<double>& parameters) {
  std::vector<double> out(parameters.size() - 1);
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = std::exp(-parameters[k]);
  return out;
}

}  // namespace

struct GaussianProcess::State {
  std::vector<Point> points;
  Eigen::VectorXd y;  // standardised
  double mean = 0, scale = 1;
  std::vector<double> parameters;
  Eigen::LLT<Eigen::MatrixXd> factor;
  Eigen::VectorXd alpha;
  double signal = 1;  // variance of the standardised process

  // Correlations plus the noise share on the diagonal.
  Eigen::MatrixXd correlations(const std::vector<double>& p) const {
    const auto n = static_cast<Eigen::Index>(points.size());
    const std::vector<double> inverse = inverse_lengths(p);
    Eigen::MatrixXd r(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      for (Eigen::Index i = j; i < n; ++i) {
        r(i, j) = r(j, i) = matern(scaled_distance(points[static_cast<std::size_t>(i)],
                                                   points[static_cast<std::size_t>(j)], inverse));
      }
      r(j, j) = 1 + std::exp(p.back()) + 1e-10;
    }
    return r;
  }

  // Negative log likelihood with the signal variance at its optimum, plus weak log-normal priors
  // (lengths near 0.5, little noise) that keep flat likelihoods from running away.
  double loss(const std::vector<double>& p) const {
    const Eigen::LLT<Eigen::MatrixXd> llt(correlations(p));
    if (llt.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
    const double n = static_cast<double>(points.size());
    const double quadratic = y.dot(llt.solve(y)) / n;
    double log_det = 0;
    for (Eigen::Index i = 0; i < y.size(); ++i) log_det += std::log(llt.matrixL()(i, i));
    double prior = 0;
    for (std::size_t k = 0; k + 1 < p.size(); ++k) prior += square((p[k] - std::log(0.5)) / 1.2);
    prior += square((p.back() - std::log(1e-3)) / 3);
    return 0.5 * n * std::log(std::max(quadratic, 1e-12)) + log_det + 0.5 * prior;
  }

  // Pattern search over each parameter: robust, deterministic, and cheap for this size.
  void fit(std::vector<double> start) {
    const auto clamp = [](std::vector<double>& p) {
      for (std::size_t k = 0; k + 1 < p.size(); ++k)
        p[k] = std::clamp(p[k], std::log(0.03), std::log(10.0));
      p.back() = std::clamp(p.back(), std::log(1e-8), std::log(0.5));
    };
    clamp(start);
    double best = loss(start);
    for (double step = 0.8; step > 0.08; step *= 0.5) {
      bool moved = true;
      for (int round = 0; round < 6 && moved; ++round) {
        moved = false;
        for (std::size_t k = 0; k < start.size(); ++k) {
          for (double sign : {1.0, -1.0}) {
            std::vector<double> trial = start;
            trial[k] += sign * step * (k + 1 == start.size() ? 2 : 1);
            clamp(trial);
            const double value = loss(trial);
            if (value < best - 1e-9) {
              best = value;
              start = trial;
              moved = true;
              break;
            }
          }
        }
      }
    }
    parameters = start;
    factor.compute(correlations(parameters));
    alpha = factor.solve(y);
    signal = std::max(y.dot(alpha) / static_cast<double>(points.size()), 1e-12);
  }
};

GaussianProcess::GaussianProcess(std::vector<Point> points, std::vector<double> values,
                                 const GaussianProcess* before)
    : state_(std::make_unique<State>()) {
  PAPILLA_CHECK(!points.empty() && points.size() == values.size(), "one value per point");
  State& s = *state_;
  s.points = std::move(points);
  const auto n = static_cast<double>(values.size());
  for (double v : values) s.mean += v / n;
  double variance = 0;
  for (double v : values) variance += square(v - s.mean) / n;
  s.scale = variance > 0 ? std::sqrt(variance) : 1;
  s.y.resize(static_cast<Eigen::Index>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i)
    s.y(static_cast<Eigen::Index>(i)) = (values[i] - s.mean) / s.scale;
  std::vector<double> start(s.points.front().size() + 1, std::log(0.5));
  start.back() = std::log(1e-3);
  if (before) start = before->state_->parameters;
  s.fit(start);
}

GaussianProcess::~GaussianProcess() = default;
GaussianProcess::GaussianProcess(GaussianProcess&&) noexcept = default;
GaussianProcess& GaussianProcess::operator=(GaussianProcess&&) noexcept = default;

Prediction GaussianProcess::predict(const Point& x) const {
  const State& s = *state_;
  const std::vector<double> inverse = inverse_lengths(s.parameters);
  Eigen::VectorXd k(s.y.size());
  for (Eigen::Index i = 0; i < k.size(); ++i)
    k(i) = matern(scaled_distance(x, s.points[static_cast<std::size_t>(i)], inverse));
  const Eigen::VectorXd v = s.factor.matrixL().solve(k);
  const double variance = s.signal * std::max(0.0, 1 - v.squaredNorm());
  return {s.mean + s.scale * k.dot(s.alpha), s.scale * std::sqrt(variance)};
}

double GaussianProcess::leave_one_out_error() const {
  const State& s = *state_;
  const Eigen::MatrixXd inverse = s.factor.solve(Eigen::MatrixXd::Identity(s.y.size(), s.y.size()));
  double sum = 0;
  for (Eigen::Index i = 0; i < s.y.size(); ++i) sum += square(s.alpha(i) / inverse(i, i));
  return s.scale * std::sqrt(sum / static_cast<double>(s.y.size()));
}

const std::vector<double>& GaussianProcess::parameters() const { return state_->parameters; }

DraftedProcess::DraftedProcess(const std::vector<Point>& points, const std::vector<double>& values,
                               const GaussianProcess* draft, const DraftedProcess* before) {
  plain_ =
      std::make_unique<GaussianProcess>(points, values, before ? before->plain_.get() : nullptr);
  if (!draft || points.size() < 4) return;
  // Eq. search.7: offset and ratio by least squares.
  const auto n = static_cast<double>(points.size());
  std::vector<double> drafts;
  double mean_draft = 0, mean_value = 0, variance = 0, covariance = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    drafts.push_back(draft->predict(points[i]).mean);
    mean_draft += drafts[i] / n;
    mean_value += values[i] / n;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    variance += square(drafts[i] - mean_draft);
    covariance += (drafts[i] - mean_draft) * (values[i] - mean_value);
  }
  if (variance <= 0) return;
  ratio_ = covariance / variance;
  offset_ = mean_value - ratio_ * mean_draft;
  std::vector<double> left;
  for (std::size_t i = 0; i < points.size(); ++i)
    left.push_back(values[i] - offset_ - ratio_ * drafts[i]);
  left_ = std::make_unique<GaussianProcess>(points, left, before ? before->left_.get() : nullptr);
  if (left_->leave_one_out_error() < plain_->leave_one_out_error()) draft_ = draft;
}

Prediction DraftedProcess::predict(const Point& x) const {
  if (!draft_) return plain_->predict(x);
  const Prediction d = draft_->predict(x), left = left_->predict(x);
  return {offset_ + ratio_ * d.mean + left.mean,  // Eq. search.8
          std::sqrt(square(ratio_ * d.sd) + square(left.sd))};
}

}  // namespace papilla::optim
