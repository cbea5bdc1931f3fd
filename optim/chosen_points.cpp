// A few weighted points in the place of many. Eq. calibration.10
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.h"
#include "base/constants.h"
#include "base/random.h"
#include "numerics/statistics.h"
#include "optim/posterior.h"

namespace papilla::optim {
namespace {

constexpr int kExchanges = 20000;  // proposals; a good set is found in some thousands

struct Moments {
  std::vector<double> mean, deviation;
};

// What the deviation of points that are worth few is widened by, so that 1.96 of it hold 95 % of
// what they are drawn from. Eq. calibration.10
double widening(const std::vector<double>& weights) {
  const double n = std::max(2.0, effective_number(weights));
  return student_t_quantile(0.975, static_cast<int>(n) - 1) / normal_quantile(0.975) *
         std::sqrt((n + 1) / (n - 1));
}

Moments moments_of(const std::vector<std::vector<double>>& features,
                   const std::vector<std::size_t>& index, const std::vector<double>& weight) {
  const std::size_t n = features.front().size();
  Moments out{std::vector<double>(n, 0), std::vector<double>(n, 0)};
  for (std::size_t k = 0; k < index.size(); ++k) {
    for (std::size_t f = 0; f < n; ++f) out.mean[f] += weight[k] * features[index[k]][f];
  }
  for (std::size_t k = 0; k < index.size(); ++k) {
    for (std::size_t f = 0; f < n; ++f)
      out.deviation[f] += weight[k] * square(features[index[k]][f] - out.mean[f]);
  }
  for (double& d : out.deviation) d = std::sqrt(d);
  return out;
}

// Sum over features of the squared difference of the means, in standard deviations, and of the
// squared logarithm of the ratio of these.
double distance(const Moments& a, const Moments& all) {
  constexpr double kLostSpread = 1e-3;  // of a spread that is lost
  double out = 0;
  for (std::size_t f = 0; f < all.mean.size(); ++f) {
    if (!(all.deviation[f] > 0)) continue;
    out += square((a.mean[f] - all.mean[f]) / all.deviation[f]) +
           square(std::log(std::max(a.deviation[f] / all.deviation[f], kLostSpread)));
  }
  return out;
}

class Chooser {
 public:
  Chooser(const std::vector<std::vector<double>>& features, const std::vector<double>& weights,
          const std::vector<int>& stratum, int count, std::uint64_t seed)
      : features_(features), weights_(weights), stratum_(stratum), random_(seed, "members") {
    std::vector<std::size_t> every(features.size());
    std::iota(every.begin(), every.end(), std::size_t{0});
    all_ = moments_of(features, every, weights);
    const double wider = widening(weights);
    for (double& d : all_.deviation) d *= wider;
    share(count);
  }

  ChosenPoints choose() {
    for (std::size_t s = 0; s < counts_.size(); ++s) start(s);
    exchange();
    return result();
  }

 private:
  // Points of each stratum: by its weight, one at least of each that has any.
  void share(int count) {
    const int strata = 1 + *std::max_element(stratum_.begin(), stratum_.end());
    totals_.assign(static_cast<std::size_t>(strata), 0);
    for (std::size_t k = 0; k < weights_.size(); ++k)
      totals_[static_cast<std::size_t>(stratum_[k])] += weights_[k];
    counts_.assign(totals_.size(), 0);
    for (std::size_t s = 0; s < totals_.size(); ++s) counts_[s] = totals_[s] > 0 ? 1 : 0;
    int left = count - std::accumulate(counts_.begin(), counts_.end(), 0);
    for (; left > 0; --left) {  // the next one where a point stands for most
      std::size_t most = totals_.size();
      for (std::size_t s = 0; s < totals_.size(); ++s) {
        if (counts_[s] == 0) continue;
        if (most == totals_.size() || totals_[s] / counts_[s] > totals_[most] / counts_[most])
          most = s;
      }
      if (most == totals_.size()) break;
      ++counts_[most];
    }
  }

  // Systematic resampling in the order of the first feature: a heavy point more than once.
  void start(std::size_t s) {
    std::vector<std::size_t> own;
    for (std::size_t k = 0; k < stratum_.size(); ++k) {
      if (static_cast<std::size_t>(stratum_[k]) == s && weights_[k] > 0) own.push_back(k);
    }
    std::stable_sort(own.begin(), own.end(), [&](std::size_t a, std::size_t b) {
      return features_[a].front() < features_[b].front();
    });
    double passed = 0;
    std::size_t at = 0;
    for (int k = 0; k < counts_[s]; ++k) {
      const double goal = totals_[s] * (k + 0.5) / counts_[s];
      while (at + 1 < own.size() && passed + weights_[own[at]] < goal)
        passed += weights_[own[at++]];
      out_.index.push_back(own[at]);
      out_.weight.push_back(totals_[s] / counts_[s]);
    }
  }

  // A point for another of its stratum wherever that brings the moments nearer.
  void exchange() {
    double now = distance(moments_of(features_, out_.index, out_.weight), all_);
    for (int n = 0; n < kExchanges; ++n) {
      const auto place =
          static_cast<std::size_t>(random_.below(static_cast<int>(out_.index.size())));
      const auto other =
          static_cast<std::size_t>(random_.below(static_cast<int>(features_.size())));
      const std::size_t old = out_.index[place];
      if (!(weights_[other] > 0) || stratum_[other] != stratum_[old]) continue;
      out_.index[place] = other;
      const double then = distance(moments_of(features_, out_.index, out_.weight), all_);
      if (then < now)
        now = then;
      else
        out_.index[place] = old;
    }
  }

  // A point that was taken more than once counts so often.
  void merge() {
    ChosenPoints once;
    for (std::size_t k = 0; k < out_.index.size(); ++k) {
      const auto same = std::find(once.index.begin(), once.index.end(), out_.index[k]);
      if (same != once.index.end()) {
        once.weight[static_cast<std::size_t>(same - once.index.begin())] += out_.weight[k];
      } else {
        once.index.push_back(out_.index[k]);
        once.weight.push_back(out_.weight[k]);
      }
    }
    out_ = std::move(once);
  }

  ChosenPoints result() {
    merge();
    const Moments own = moments_of(features_, out_.index, out_.weight);
    out_.least_spread = kInfinity;
    out_.largest_spread = 0;
    for (std::size_t f = 0; f < all_.mean.size(); ++f) {
      if (!(all_.deviation[f] > 0)) continue;
      out_.largest_mean =
          std::max(out_.largest_mean, std::abs(own.mean[f] - all_.mean[f]) / all_.deviation[f]);
      const double ratio = own.deviation[f] / all_.deviation[f];
      out_.least_spread = std::min(out_.least_spread, ratio);
      out_.largest_spread = std::max(out_.largest_spread, ratio);
    }
    if (out_.largest_spread == 0) out_.least_spread = out_.largest_spread = 1;
    return std::move(out_);
  }

  const std::vector<std::vector<double>>& features_;
  const std::vector<double>& weights_;
  const std::vector<int>& stratum_;
  RandomStream random_;
  Moments all_;  // widened
  std::vector<double> totals_;
  std::vector<int> counts_;
  ChosenPoints out_;
};

}  // namespace

ChosenPoints choose_points(const std::vector<std::vector<double>>& features,
                           const std::vector<double>& weights, const std::vector<int>& stratum,
                           int count, std::uint64_t seed) {
  PAPILLA_CHECK(!features.empty() && features.size() == weights.size() &&
                    features.size() == stratum.size() && count > 0,
                "points with features, weights and strata");
  return Chooser(features, weights, stratum, count, seed).choose();
}

}  // namespace papilla::optim
