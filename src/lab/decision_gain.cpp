#include "lab/decision_gain.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/check.h"
#include "base/constants.h"
#include "base/random.h"
#include "optim/posterior.h"

namespace papilla::lab {
namespace {

// What the fall of the contested variance counts beside that of the regret: of many experiments
// none changes a choice alone, and then this alone says which of them lead there.
constexpr double kVarianceShare = 1;
constexpr std::size_t kThirds = 3;

// Members, systematically by their weights: every truth as often as it is probable.
std::vector<std::size_t> truths(const std::vector<double>& weights, int draws) {
  std::vector<std::size_t> out;
  double sum = 0;
  std::size_t m = 0;
  for (int k = 0; k < draws; ++k) {
    const double wanted = (k + 0.5) / draws;
    while (m + 1 < weights.size() && sum + weights[m] < wanted) sum += weights[m++];
    out.push_back(m);
  }
  return out;
}

}  // namespace

MemberWorth decision_worth(const WorthAfter& after, const DecisionLimits& limits) {
  MemberWorth out{after.weights, after.worth, {}};
  for (std::size_t d = 0; d < after.worth.size(); ++d) {
    std::vector<std::vector<bool>>& kept = out.kept.emplace_back();
    if (limits.kept.empty()) continue;
    std::vector<bool>& all = kept.emplace_back();
    for (const std::size_t m : after.member) all.push_back(limits.kept[d][m]);
  }
  out.draw_of = after.member;
  return out;
}

DecisionGain::DecisionGain(const Ensemble& ensemble, const Kernels& kernels, const Evidence& sofar,
                           const DecisionLimits& limits, int draws)
    : ensemble_(ensemble),
      kernels_(kernels),
      limits_(limits),
      state_{sofar, sofar.size(), kernels.worth, {}, {}} {
  PAPILLA_CHECK(kernels.worth.size() > 1, "a choice among designs");
  // Whatever else decides in the lab: a measurement is valued by what it saves of expected regret.
  const auto now = prospects(decision_worth(worth_after(ensemble, kernels, sofar), limits), {});
  choice_ = chosen(now, limits.wanted);
  regret_now_ = now[choice_].regret;
  for (const Prospect& p : now) p_best_.push_back(p.p_best);
  for (const std::vector<bool>& kept : limits.kept)
    limited_ |= std::find(kept.begin(), kept.end(), false) != kept.end();
  const std::vector<double> weights = sofar.weights();
  std::vector<double> logs;
  for (const double w : weights) logs.push_back(std::log(std::max(w, 1e-300)));
  for (const std::size_t t : truths(weights, draws))
    state_.futures.push_back({t, logs, std::vector<double>(kernels.worth.size(), 0), {}, {}});
  for (std::size_t d = 0; d < kernels.worth.size(); ++d) {
    const auto& of = kernels.of_worth;
    double own = of[d][d] - 2 * of[d][choice_] + of[choice_][choice_];
    for (std::size_t k = 0; k < sofar.size(); ++k) {
      own -= square(sofar.gain(d, k) - sofar.gain(choice_, k));
      for (std::size_t m = 0; m < weights.size(); ++m)
        state_.worth[d][m] += sofar.gain(d, k) * sofar.residuals(k)[m];
    }
    state_.left.push_back(own);
  }
  before_ = found_ = average(state_);
}

void DecisionGain::move_future(const State& state, Future& future, std::size_t index) const {
  const std::size_t k = state.evidence.size() - 1;
  const std::vector<double>& ahead = state.evidence.residuals(k);
  const std::vector<double>& row = state.evidence.factor().row(k);
  // A stream per reading ahead and future: candidates are compared under the same scatter.
  RandomStream random(1 + k - state.made, "lab future", index);
  const double z = random.normal(), at = ahead[future.truth];
  double value = kernels_.responses[state.evidence.observations()[k].row][future.truth];
  for (std::size_t j = 0; j < k; ++j)
    value += row[j] * (j < state.made ? state.evidence.residuals(j)[future.truth]
                                      : future.scatter[j - state.made]);
  future.values.push_back(value + row[k] * z);
  future.scatter.push_back(z);
  for (std::size_t m = 0; m < ahead.size(); ++m)
    future.log_weights[m] -= square(z + ahead[m] - at) / 2;
  for (std::size_t d = 0; d < future.shift.size(); ++d)
    future.shift[d] += state.evidence.gain(d, k) * (z - at);
}

void DecisionGain::take(State& state, const Observation& reading) const {
  const std::vector<double> ahead = state.evidence.add_ahead(reading);
  const std::size_t k = state.evidence.size() - 1;
  for (std::size_t d = 0; d < state.worth.size(); ++d) {
    const double gain = state.evidence.gain(d, k);
    state.left[d] -= square(gain - state.evidence.gain(choice_, k));
    for (std::size_t m = 0; m < ahead.size(); ++m) state.worth[d][m] += gain * ahead[m];
  }
  for (std::size_t j = 0; j < state.futures.size(); ++j) move_future(state, state.futures[j], j);
}

// What each design is expected to be worth beyond the best that keeps the limits, where one does:
// nothing is lost or won by it, as prospects() counts regret. Eq. search.16
std::vector<double> DecisionGain::beyond_limits(const State& state, const Future& future,
                                                const std::vector<double>& weights) const {
  std::vector<double> out(state.worth.size(), 0);
  if (!limited_) return out;
  for (std::size_t m = 0; m < weights.size(); ++m) {
    double best = -kInfinity;
    for (std::size_t d = 0; d < out.size(); ++d) {
      if (limits_.kept[d][m]) best = std::max(best, state.worth[d][m] + future.shift[d]);
    }
    if (std::isinf(best)) continue;  // all are allowed alike
    for (std::size_t d = 0; d < out.size(); ++d)
      out[d] += weights[m] * std::max(0.0, state.worth[d][m] + future.shift[d] - best);
  }
  return out;
}

DecisionGain::Found DecisionGain::found(const State& state, const Future& future) const {
  const std::vector<double> w = normalised(future.log_weights);
  const std::size_t designs = state.worth.size();
  std::vector<Prospect> there(designs);
  if (limited_) {
    const std::vector<double> unsure = less_sure(w, limits_.kept);
    for (std::size_t d = 0; d < designs; ++d) there[d].less_sure = unsure[d];
  }
  const std::vector<double>& of_choice = state.worth[choice_];
  const std::vector<double> beyond = beyond_limits(state, future, w);
  Found out{choice_, 0, 0};
  for (std::size_t d = 0; d < designs; ++d) {
    double mean = 0, squares = 0, kept = 0;
    for (std::size_t m = 0; m < w.size(); ++m) {
      const double difference = state.worth[d][m] - of_choice[m];
      mean += w[m] * difference;
      squares += w[m] * square(difference);
      if (!limits_.kept.empty() && limits_.kept[d][m]) kept += w[m];
    }
    if (!limits_.kept.empty()) there[d].p_limits = kept;
    there[d].merit = mean + future.shift[d] - future.shift[choice_] - (beyond[d] - beyond[choice_]);
    out.variance += p_best_[d] * (std::max(0.0, squares - square(mean)) + state.left[d]);
  }
  // By the rule of the choice now, so that what tells nothing changes no choice. Eq. search.17
  out.choice = chosen(there, limits_.wanted);
  out.better = there[out.choice].merit;
  return out;
}

DecisionGain::Found DecisionGain::average(const State& state) const {
  Found out;
  for (const Future& future : state.futures) {
    const Found one = found(state, future);
    out.better += one.better;
    out.variance += one.variance;
  }
  out.better /= static_cast<double>(state.futures.size());
  out.variance /= static_cast<double>(state.futures.size());
  return out;
}

double DecisionGain::of(const Candidate& candidate) const {
  State with = state_;
  for (const Observation& reading : candidate.readings) take(with, reading);
  const Found then = average(with);
  const double regret = regret_now_ > 0 ? (then.better - found_.better) / regret_now_ : 0;
  const double variance =
      before_.variance > 0 ? (found_.variance - then.variance) / before_.variance : 0;
  return std::max(0.0, std::max(0.0, regret) + kVarianceShare * variance);  // Eq. lab.6
}

void DecisionGain::take(const Candidate& candidate) {
  for (const Observation& reading : candidate.readings) take(state_, reading);
  found_ = average(state_);
}

double DecisionGain::regret_after() const {
  return std::max(0.0, regret_now_ - (found_.better - before_.better));
}

double DecisionGain::p_change() const {
  double changed = 0;
  for (const Future& future : state_.futures) changed += found(state_, future).choice != choice_;
  return changed / static_cast<double>(state_.futures.size());
}

std::vector<std::vector<Foreseen>> DecisionGain::outcomes() const {
  std::vector<std::size_t> choices;
  std::vector<std::vector<double>> hypotheses;
  for (const Future& future : state_.futures) {
    choices.push_back(found(state_, future).choice);
    hypotheses.push_back(weights_by_hypothesis(ensemble_, normalised(future.log_weights)));
  }
  std::vector<std::vector<Foreseen>> out;
  const std::size_t futures = choices.size();
  for (std::size_t k = 0; k + state_.made < state_.evidence.size(); ++k) {
    std::vector<std::size_t> order(futures);
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return state_.futures[a].values[k] < state_.futures[b].values[k];
    });
    std::vector<Foreseen>& thirds = out.emplace_back();
    for (std::size_t third = 0; third < kThirds; ++third) {
      const std::size_t from = third * futures / kThirds, to = (third + 1) * futures / kThirds;
      std::vector<int> count(state_.worth.size(), 0);
      Foreseen o;
      o.low = std::exp(state_.futures[order[from]].values[k]);
      o.high = std::exp(state_.futures[order[to - 1]].values[k]);
      o.p_hypothesis.assign(ensemble_.hypotheses.size(), 0);
      for (std::size_t i = from; i < to; ++i) {
        ++count[choices[order[i]]];
        for (std::size_t h = 0; h < o.p_hypothesis.size(); ++h)
          o.p_hypothesis[h] += hypotheses[order[i]][h] / static_cast<double>(to - from);
      }
      const auto most = std::max_element(count.begin(), count.end());
      o.choice = static_cast<std::size_t>(most - count.begin());
      o.p_choice = static_cast<double>(*most) / static_cast<double>(to - from);
      thirds.push_back(std::move(o));
    }
  }
  return out;
}

}  // namespace papilla::lab
