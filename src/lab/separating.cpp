// Gains that need no decision: hypotheses told apart (Eq. lab.7), parameters shrunk (Eq. lab.8).
#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/constants.h"
#include "lab/batch.h"

namespace papilla::lab {
namespace {

// Readings made and ahead with the covariance that an aim asks for; vectors are whitened along.
class Whitened {
 public:
  using Covariance = std::function<double(std::size_t row, std::size_t other)>;
  Whitened(const Ensemble& ensemble, const Instrument& instrument, Covariance beside)
      : ensemble_(ensemble), instrument_(instrument), beside_(std::move(beside)) {}

  // Returns its own factor: the standard deviation that it has once those before are known.
  double add(const Observation& o) {
    std::vector<double> with;
    observations_.push_back(o);
    for (const Observation& other : observations_) {
      with.push_back(
          covariance(instrument_, o, other, &other == &observations_.back()) +
          covariance(ensemble_.response_sampling[o.row], ensemble_.response_sampling[other.row]) +
          beside_(o.row, other.row));
    }
    factor_.add(with);
    return factor_.row(factor_.size() - 1).back();
  }
  const GrowingFactor& factor() const { return factor_; }
  const std::vector<Observation>& observations() const { return observations_; }

 private:
  const Ensemble& ensemble_;
  const Instrument& instrument_;
  Covariance beside_;
  std::vector<Observation> observations_;
  GrowingFactor factor_;
};

// Weighted deviations of a row about some means, times the root of the weights.
std::vector<std::vector<double>> moves(const Ensemble& e, bool about_hypotheses) {
  const std::vector<double> share = weights_by_hypothesis(e, e.weights);
  std::vector<std::vector<double>> out;
  for (const std::vector<double>& row : e.responses) {
    std::vector<double> mean(e.hypotheses.size(), 0), moved;
    for (std::size_t m = 0; m < row.size(); ++m) mean[e.hypothesis[m]] += e.weights[m] * row[m];
    const double all = std::accumulate(mean.begin(), mean.end(), 0.0);
    for (std::size_t m = 0; m < row.size(); ++m) {
      const std::size_t h = e.hypothesis[m];
      moved.push_back(std::sqrt(e.weights[m]) *
                      (row[m] - (about_hypotheses ? mean[h] / share[h] : all)));
    }
    out.push_back(std::move(moved));
  }
  return out;
}

Whitened::Covariance covariance_by(const std::vector<std::vector<double>>& moves) {
  return [&moves](std::size_t row, std::size_t other) {
    return std::inner_product(moves[row].begin(), moves[row].end(), moves[other].begin(), 0.0);
  };
}

// The bound of Bhattacharyya on the chance to take the wrong one of two, summed over pairs; what a
// candidate takes from it. For two hypotheses as good as the sum of squared differences over the
// variance (T-optimal).
class HypothesesGain final : public Gain {
 public:
  HypothesesGain(const Ensemble& e, const Evidence& sofar, const Instrument& instrument)
      : ensemble_(e),
        moves_(moves(e, true)),
        share_(weights_by_hypothesis(e, sofar.weights())),
        whitened_(e, instrument, covariance_by(moves_)) {
    const std::vector<double> before = weights_by_hypothesis(e, e.weights);
    for (const std::vector<double>& row : e.responses) {
      std::vector<double>& mean = means_.emplace_back(e.hypotheses.size(), 0);
      for (std::size_t m = 0; m < row.size(); ++m)
        mean[e.hypothesis[m]] += e.weights[m] * row[m] / before[e.hypothesis[m]];
    }
    // What was measured is in the weights: the covariance of what comes is that beside it.
    for (const Observation& o : sofar.observations()) whitened_.add(o);
    made_ = sofar.size();
  }

  double of(const Candidate& candidate) const override {
    Whitened with = whitened_;
    for (const Observation& o : candidate.readings) with.add(o);
    const double now = bound(whitened_);
    return now > 0 ? std::max(0.0, (now - bound(with)) / now) : 0;
  }
  void take(const Candidate& candidate) override {
    for (const Observation& o : candidate.readings) whitened_.add(o);
  }

 private:
  double bound(const Whitened& w) const {
    double out = 0;
    for (std::size_t a = 0; a < share_.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b)
        out += std::sqrt(share_[a] * share_[b]) * std::exp(-squared_distance(w, a, b) / 8);
    }
    return out;  // Eq. lab.7
  }
  // Of the readings that are yet to be made.
  double squared_distance(const Whitened& w, std::size_t a, std::size_t b) const {
    std::vector<double> difference;
    for (const Observation& o : w.observations())
      difference.push_back(means_[o.row][a] - means_[o.row][b]);
    difference = w.factor().solved(std::move(difference));
    double sum = 0;
    for (std::size_t k = made_; k < difference.size(); ++k) sum += square(difference[k]);
    return sum;
  }

  const Ensemble& ensemble_;
  std::vector<std::vector<double>> moves_, means_;
  std::vector<double> share_;
  Whitened whitened_;
  std::size_t made_ = 0;
};

// The determinant of what is known: half the logarithm of the variance of a reading before it is
// made over that of its noise. Eq. lab.8
class ParametersGain final : public Gain {
 public:
  ParametersGain(const Ensemble& e, const Evidence& sofar, const Instrument& instrument)
      : moves_(moves(e, false)),
        noise_(e, instrument, [](std::size_t, std::size_t) { return 0.0; }),
        all_(e, instrument, covariance_by(moves_)) {
    for (const Observation& o : sofar.observations()) {
      noise_.add(o);
      all_.add(o);
    }
  }

  double of(const Candidate& candidate) const override {
    Whitened noise = noise_, all = all_;
    double out = 0;
    for (const Observation& o : candidate.readings) out += std::log(all.add(o) / noise.add(o));
    return std::max(0.0, out);
  }
  void take(const Candidate& candidate) override {
    for (const Observation& o : candidate.readings) {
      noise_.add(o);
      all_.add(o);
    }
  }

 private:
  std::vector<std::vector<double>> moves_;
  Whitened noise_, all_;
};

}  // namespace

std::unique_ptr<Gain> hypotheses_gain(const Ensemble& ensemble, const Evidence& sofar,
                                      const Instrument& instrument) {
  return std::make_unique<HypothesesGain>(ensemble, sofar, instrument);
}

std::unique_ptr<Gain> parameters_gain(const Ensemble& ensemble, const Evidence& sofar,
                                      const Instrument& instrument) {
  return std::make_unique<ParametersGain>(ensemble, sofar, instrument);
}

}  // namespace papilla::lab
