#include "rank/rank.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/statistics.h"
#include "estimate/parameters.h"
#include "rank/candidate.h"

namespace papilla::rank {
namespace {

// The race in one finger state.
class StateRanker {
 public:
  StateRanker(const std::vector<Regions>& candidates, FingerState state, const RankOptions& options)
      : options_(options), state_(state) {
    for (const Regions& c : candidates) candidates_.emplace_back(c, state, options);
  }

  // Everyone gets a batch; then only neighbours in the order whose difference is open.
  StateRanking run() {
    for (Candidate& c : candidates_) c.extend();
    for (std::ptrdiff_t said = 0;;) {
      score();
      const std::vector<bool> open = open_candidates();
      if (!extend(open)) break;
      const auto still = std::count(open.begin(), open.end(), true);
      if (still != said)  // a batch is quick: only what is new
        note(fmt::format("{} of {} candidates still open", still, open.size()));
      said = still;
    }
    if (options_.parameters) step();  // more skins make nothing of it surer
    return result();
  }

 private:
  // The difference of two that is open is over the skins that both have, so the one with more of
  // them waits.
  std::vector<bool> open_candidates() const {
    std::vector<bool> open(candidates_.size(), false);
    for (std::size_t i = 0; i + 1 < order_.size(); ++i) {
      if (scores_.decided(order_[i], order_[i + 1])) continue;
      const int a = candidates_[order_[i]].skins(), b = candidates_[order_[i + 1]].skins();
      if (a <= b) open[order_[i]] = true;
      if (b <= a) open[order_[i + 1]] = true;
    }
    return open;
  }

  // A batch more for each that is open, as long as it may; false where none may.
  bool extend(const std::vector<bool>& open) {
    bool more = false;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (!open[i] || candidates_[i].skins() + options_.batch > options_.max_skins) continue;
      candidates_[i].extend();
      more = true;
    }
    return more;
  }

  // What a unit of each criterion is worth in the score. Eq. ranking.1
  std::vector<double> score_scale() const {
    const std::size_t criteria = options_.criteria.size();
    std::vector<double> out;
    for (std::size_t c = 0; c < criteria; ++c) {
      double typical = 0;
      for (const Candidate& x : candidates_)
        typical +=
            std::abs(mean_estimate(x.samples(c)).value) / static_cast<double>(candidates_.size());
      out.push_back((options_.criteria[c].high ? 1 : -1) / (typical > 0 ? typical : 1) /
                    static_cast<double>(criteria));
    }
    return out;
  }

  // Scores per skin, and the order that they say. Eq. ranking.1
  void score() {
    const std::vector<double> scale = score_scale();
    scores_.skins.clear();
    for (const Candidate& x : candidates_) {
      std::vector<double> s(static_cast<std::size_t>(x.skins()), 0);
      for (std::size_t c = 0; c < scale.size(); ++c) {
        for (std::size_t k = 0; k < s.size(); ++k) s[k] += scale[c] * x.samples(c)[k];
      }
      scores_.skins.push_back(std::move(s));
    }
    order_ = scores_.order();
  }

  // Scores over the steps of the finger, the same for all candidates. Eq. ranking.5
  void step() {
    note("parameters of the finger");
    const std::vector<double> scale = score_scale();
    for (Candidate& x : candidates_) {
      x.step();
      StepSamples s = x.steps(0);
      for (std::size_t k = 0; k < s.size(); ++k) {
        for (std::size_t i = 0; i < s[k].size(); ++i) {
          s[k][i] = 0;
          for (std::size_t c = 0; c < scale.size(); ++c) s[k][i] += scale[c] * x.steps(c)[k][i];
        }
      }
      scores_.steps.push_back(std::move(s));
    }
  }

  StateRanking result() const {
    StateRanking out;
    out.state = state_;
    int most = 0;
    for (const Candidate& c : candidates_) {
      out.skins += c.skins();
      most = std::max(most, c.skins());
    }
    out.equal_skins = most * static_cast<int>(candidates_.size());
    const std::vector<double> p = scores_.probabilities(static_cast<std::uint64_t>(state_));
    for (std::size_t place = 0; place < order_.size(); ++place) {
      RankedCandidate r = at_place(place);
      if (place > 0 && out.candidates.back().tied_with_next) r.rank = out.candidates.back().rank;
      r.p_best = p[r.index];
      out.candidates.push_back(std::move(r));
    }
    return out;
  }

  RankedCandidate at_place(std::size_t place) const {
    const std::size_t i = order_[place];
    RankedCandidate r;
    r.index = i;
    r.rank = static_cast<int>(place) + 1;
    r.skins = candidates_[i].skins();
    r.score =
        interval_of(scores_.skins[i], scores_.steps.empty() ? StepSamples{} : scores_.steps[i])
            .moved(unmet(scores_.skins, i));
    if (place > 0) r.behind_best = scores_.difference(i, order_.front());
    if (place + 1 < order_.size()) {
      const std::size_t next = order_[place + 1];
      r.ahead_of_next = scores_.difference(i, next);
      r.tied_with_next = !scores_.decided(i, next);
      r.p_ahead = scores_.probability_ahead(i, next);
    }
    for (std::size_t c = 0; c < options_.criteria.size(); ++c) {
      std::vector<std::vector<double>> samples;
      for (const Candidate& x : candidates_) samples.push_back(x.samples(c));
      const StepSamples steps = options_.parameters ? candidates_[i].steps(c) : StepSamples{};
      r.metrics.push_back(interval_of(samples[i], steps).moved(unmet(samples, i)));
    }
    return r;
  }

  void note(const std::string& text) const {
    if (options_.note)
      options_.note(finger_state_names()[static_cast<std::size_t>(state_)] + ": " + text);
  }

  const RankOptions& options_;
  FingerState state_;
  std::vector<Candidate> candidates_;
  Scores scores_;
  std::vector<std::size_t> order_;
};

// What the steps of the finger's parameters are run with, the same for all candidates.
void plan_steps(const std::vector<Regions>& candidates, Ranking& out) {
  const Design& first = candidates.front().front();
  out.directions = static_cast<int>(finger_steps(first.finger).size());
  const Fidelity few = step_fidelity(fidelity_of(first));
  out.step_skins = few.skins;
  out.step_grid = few.grid;
  for (const Regions& regions : candidates) {
    for (const Design& d : regions) {
      if (d.finger.uncertainty != first.finger.uncertainty)
        throw InputError(fmt::format(
            "\"{}\" and \"{}\" are of fingers with other [[uncertainty]]: what their parameters "
            "do to a difference is not known",
            first.title, d.title));
    }
  }
}

}  // namespace

Ranking ranking_of(const std::vector<Regions>& candidates, const RankOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  Ranking out;
  out.conditions = condition_differences(candidates, options);
  if (!options.any_conditions) require_same_conditions(out.conditions);
  if (options.parameters) plan_steps(candidates, out);
  for (FingerState state : options.states) {
    out.states.push_back(StateRanker(candidates, state, options).run());
    out.skins += out.states.back().skins;
  }
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

Ranking ranking_of(const std::vector<Design>& designs, const RankOptions& options) {
  std::vector<Regions> candidates;
  for (const Design& d : designs) candidates.push_back({d});
  return ranking_of(candidates, options);
}

}  // namespace papilla::rank
