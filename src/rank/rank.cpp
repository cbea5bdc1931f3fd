#include "rank/rank.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <utility>
#include <variant>

#include "base/error.h"
#include "base/text.h"
#include "design/scans.h"
#include "estimate/belief.h"
#include "forward/plan.h"
#include "geometry/measured_map.h"
#include "numerics/statistics.h"
#include "rank/candidate.h"
#include "scene/uncertainty.h"

namespace papilla::rank {
namespace {

// The race in one finger state.
class StateRanker {
 public:
  StateRanker(const std::vector<Regions>& candidates, FingerState state, const RankOptions& options)
      : options_(options), state_(state) {
    for (const Regions& c : candidates) candidates_.emplace_back(c, state, options);
  }

  // Everyone gets a batch; then only neighbours in an order whose difference is open.
  StateRanking run() {
    const double seconds = first_batches();
    if (options_.moves_finger()) step();
    for (std::ptrdiff_t said = 0;;) {
      score();
      const std::vector<bool> open = open_candidates();
      if (said == 0 && !options_.felt()) say_price(open, seconds);
      if (!extend(open)) break;
      const auto still = std::count(open.begin(), open.end(), true);
      if (still != said)  // a batch is quick: only what is new
        note(fmt::format("{} of {} candidates still open", still, open.size()));
      said = still;
    }
    if (options_.moves_finger()) {  // more skins make nothing of it surer
      for (Board& board : boards_) add_steps(board);
    }
    return result();
  }

 private:
  // Scores of candidates and the order that they say: by one criterion, or by the sum of all.
  struct Board {
    std::vector<double> scale;  // what a unit of each criterion is worth, Eq. ranking.1
    Scores scores;
    std::vector<std::size_t> order;
  };

  // Of the clock [s], for each skin or arrangement of those that more of them may tell of.
  double first_batches() {
    double seconds = 0;
    int tried = 0;
    for (Candidate& c : candidates_) {
      const auto begin = std::chrono::steady_clock::now();
      c.extend();
      if (!c.scatters()) continue;
      seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
      tried += c.tried();
    }
    return tried > 0 ? seconds / tried : 0;
  }

  // Arrangements of a film of particles take a second each: what the open ones may take, where that
  // is long.
  void say_price(const std::vector<bool>& open, double seconds) const {
    constexpr double kLong = 5;  // [s]
    int more = 0;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (open[i] && candidates_[i].scatters()) more += options_.max_skins - candidates_[i].tried();
    }
    if (more * seconds > kLong)
      note(fmt::format(
          "up to {} arrangements more where the order is open (--max-skins {}): {} each, {} "
          "at most",
          more, options_.max_skins, duration(seconds), duration(more * seconds)));
  }

  // The difference of two that is open is over the skins that both have, so the one with more of
  // them waits.
  std::vector<bool> open_candidates() const {
    std::vector<bool> open(candidates_.size(), false);
    for (const CandidatePair& pair : open_pairs()) {
      const int a = candidates_[pair.first].skins(), b = candidates_[pair.second].skins();
      if (a <= b) open[pair.first] = true;
      if (b <= a) open[pair.second] = true;
    }
    // What is said of one of two that are equal holds of the other, which so meets the same skins.
    const std::vector<bool> by_itself = open;
    for (std::size_t i = 0; i < open.size(); ++i) {
      for (std::size_t j = 0; by_itself[i] && j < open.size(); ++j) {
        if (j != i && candidates_[j].skins() <= candidates_[i].skins() && equal(boards_, i, j))
          open[j] = true;
      }
    }
    return open;
  }

  static bool equal(const std::vector<Board>& boards, std::size_t i, std::size_t j) {
    return std::all_of(boards.begin(), boards.end(),
                       [&](const Board& board) { return board.scores.equal(i, j); });
  }

  // What more skins may tell apart.
  std::vector<CandidatePair> open_pairs() const {
    return neighbours([](const Scores& scores, std::size_t a, std::size_t b) {
      return !scores.decided(a, b) && !scores.equal(a, b);
    });
  }

  // Neighbours in the orders of all boards of which that holds.
  template <class Holds>
  std::vector<CandidatePair> neighbours(Holds&& holds) const {
    std::vector<CandidatePair> out;
    for (std::size_t k = 0; k < boards_.size(); ++k) {
      const std::vector<std::size_t>& order = boards_[k].order;
      for (std::size_t i = 0; i + 1 < order.size(); ++i) {
        if (holds(boards_[k].scores, order[i], order[i + 1]))
          out.push_back({order[i], order[i + 1], k});
      }
    }
    return out;
  }

  // A batch more for each that is open, as long as it may; false where none may.
  bool extend(const std::vector<bool>& open) {
    bool more = false;
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      Candidate& candidate = candidates_[i];
      if (!open[i] || candidate.skins() + candidate.batch() > options_.max_skins) continue;
      candidate.extend();
      more = true;
    }
    return more;
  }

  // What a unit of each criterion is worth, all criteria by themselves. Eq. ranking.1
  std::vector<double> unit_scale() const {
    std::vector<double> out;
    for (std::size_t c = 0; c < options_.criteria.size(); ++c) {
      double typical = 0;
      for (const Candidate& x : candidates_)
        typical += size_of(x, c) / static_cast<double>(candidates_.size());
      out.push_back((options_.criteria[c].high ? 1 : -1) / (typical > 0 ? typical : 1));
    }
    return out;
  }

  // A force that may change its sign may be next to nothing on every candidate, and a relative
  // advantage of that is noise: then its size is what belief says it may be.
  double size_of(const Candidate& x, std::size_t criterion) const {
    const double mean = mean_estimate(x.samples(criterion)).value;
    const MetricExpression& e = options_.criteria[criterion].expression;
    return keeps_sign(e.summary, e.metric) || !options_.moves_finger()
               ? std::abs(mean)
               : std::hypot(mean, step_error(x.steps(criterion)));
  }

  // One board a criterion, and the score's in front where there is one of several.
  std::vector<Board> empty_boards() const {
    const std::vector<double> scale = unit_scale();
    std::vector<Board> out;
    if (options_.scored()) {
      double sum = 0;
      for (std::size_t c = 0; c < scale.size(); ++c) sum += weight(c);
      out.emplace_back();
      for (std::size_t c = 0; c < scale.size(); ++c)
        out.back().scale.push_back(scale[c] * weight(c) / sum);
      return out;
    }
    for (std::size_t c = 0; c < scale.size(); ++c) out.push_back(criterion_board(scale, c));
    return out;
  }

  static Board criterion_board(const std::vector<double>& scale, std::size_t criterion) {
    Board out;
    out.scale.assign(scale.size(), 0);
    out.scale[criterion] = scale[criterion];
    return out;
  }

  double weight(std::size_t criterion) const {
    return options_.weights.empty() ? 1 : options_.weights[criterion];
  }

  // Scores per skin, and the order that they say. Eq. ranking.1
  void fill(Board& board) const {
    for (const Candidate& x : candidates_) {
      std::vector<double> s(static_cast<std::size_t>(x.skins()), 0);
      for (std::size_t c = 0; c < board.scale.size(); ++c) {
        for (std::size_t k = 0; k < s.size(); ++k) s[k] += board.scale[c] * x.samples(c)[k];
      }
      board.scores.skins.push_back(std::move(s));
    }
    board.order = board.scores.order();
  }

  void score() {
    boards_ = empty_boards();
    for (Board& board : boards_) fill(board);
  }

  // Scores over the steps of the finger, the same for all candidates. Eq. ranking.5
  void add_steps(Board& board) const {
    board.scores.member_weights = candidates_.front().member_weights();
    for (const Candidate& x : candidates_) {
      StepSamples s = x.steps(0);
      for (std::size_t k = 0; k < s.size(); ++k) {
        for (std::size_t i = 0; i < s[k].size(); ++i) {
          s[k][i] = 0;
          for (std::size_t c = 0; c < board.scale.size(); ++c)
            s[k][i] += board.scale[c] * x.steps(c)[k][i];
        }
      }
      board.scores.steps.push_back(std::move(s));
    }
  }

  void step() {
    note(candidates_.front().member_weights().empty() ? "parameters of the finger"
                                                      : "belief about finger and model");
    for (Candidate& x : candidates_) x.step();
  }

  // Each criterion alone, with the steps where they were asked for.
  std::vector<Board> criteria_boards() const {
    if (!options_.scored() || options_.criteria.size() == 1) return boards_;
    const std::vector<double> scale = unit_scale();
    std::vector<Board> out;
    for (std::size_t c = 0; c < scale.size(); ++c) {
      out.push_back(criterion_board(scale, c));
      fill(out.back());
      if (options_.moves_finger()) add_steps(out.back());
    }
    return out;
  }

  StateRanking result() const {
    StateRanking out;
    out.state = state_;
    int most = 0;
    for (const Candidate& c : candidates_) {
      out.skins += c.tried();
      most = std::max(most, c.tried());
    }
    for (const Candidate& c : candidates_) out.equal_skins += c.scatters() ? most : c.tried();
    out.open = open_pairs();
    out.equal = neighbours(
        [](const Scores& scores, std::size_t a, std::size_t b) { return scores.equal(a, b); });
    const std::vector<Board> boards = criteria_boards();
    std::vector<RankedCandidate> all;
    for (std::size_t i = 0; i < candidates_.size(); ++i) all.push_back(candidate(i, boards));
    for (std::size_t c = 0; c < boards.size(); ++c) {
      const std::vector<double> p = boards[c].scores.probabilities(stream(c));
      for (RankedCandidate& r : all) r.p_best_by.push_back(p[r.index]);
    }
    out.candidates = options_.scored() ? by_score(std::move(all)) : by_dominance(std::move(all));
    return out;
  }

  std::uint64_t stream(std::size_t criterion) const {
    return static_cast<std::uint64_t>(state_) + 16 * criterion;
  }

  RankedCandidate candidate(std::size_t i, const std::vector<Board>& boards) const {
    RankedCandidate r;
    r.index = i;
    r.skins = candidates_[i].tried();
    r.look_warning = candidates_[i].look_warning();
    r.trouble = candidates_[i].trouble();
    for (std::size_t j = 0; j < candidates_.size(); ++j) {
      bool ahead = false, behind = false;
      for (const Board& board : boards) {
        if (i == j) continue;
        const Interval d = board.scores.difference(i, j);
        ahead = ahead || d.low > 0;
        behind = behind || d.high < 0;
      }
      r.over.push_back(ahead && behind                 ? Relation::TradeOff
                       : ahead                         ? Relation::Better
                       : behind                        ? Relation::Worse
                       : i != j && equal(boards, i, j) ? Relation::Equal
                                                       : Relation::Open);
    }
    for (std::size_t c = 0; c < options_.criteria.size(); ++c) {
      std::vector<std::vector<double>> samples;
      for (const Candidate& x : candidates_) samples.push_back(x.samples(c));
      const StepSamples steps = options_.moves_finger() ? candidates_[i].steps(c) : StepSamples{};
      r.metrics.push_back(interval_of(samples[i], steps).moved(unmet(samples, i)));
    }
    return r;
  }

  // Those that nobody beats come first, then by how many do; in the order of the first criterion.
  std::vector<RankedCandidate> by_dominance(std::vector<RankedCandidate> all) const {
    std::vector<RankedCandidate> out;
    for (const std::size_t i : boards_.front().order) {
      out.push_back(std::move(all[i]));
      RankedCandidate& r = out.back();
      r.rank += static_cast<int>(std::count(r.over.begin(), r.over.end(), Relation::Worse));
    }
    std::stable_sort(out.begin(), out.end(),
                     [](const auto& a, const auto& b) { return a.rank < b.rank; });
    return out;
  }

  std::vector<RankedCandidate> by_score(std::vector<RankedCandidate> all) const {
    const auto& [scale, scores, order] = boards_.front();
    const std::vector<double> p = scores.probabilities(stream(0));
    std::vector<RankedCandidate> out;
    for (std::size_t place = 0; place < order.size(); ++place) {
      const std::size_t i = order[place];
      RankedCandidate r = std::move(all[i]);
      r.rank += static_cast<int>(
          std::count_if(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(place),
                        [&](std::size_t ahead) { return scores.decided(ahead, i); }));
      r.p_best = p[i];
      r.score = interval_of(scores.skins[i], scores.steps.empty() ? StepSamples{} : scores.steps[i])
                    .moved(unmet(scores.skins, i));
      if (place > 0) r.behind_best = scores.difference(i, order.front());
      if (place + 1 < order.size()) {
        const std::size_t next = order[place + 1];
        r.ahead_of_next = scores.difference(i, next);
        r.tied_with_next = !scores.decided(i, next);
        r.p_ahead = scores.probability_ahead(i, next);
      }
      out.push_back(std::move(r));
    }
    return out;
  }

  void note(const std::string& text) const {
    if (options_.note)
      options_.note(finger_state_names()[static_cast<std::size_t>(state_)] + ": " + text);
  }

  const RankOptions& options_;
  FingerState state_;
  std::vector<Candidate> candidates_;
  std::vector<Board> boards_;
};

// The first that stands in place of a finger; null: fingers touch all of them.
const Pin* pin_among(const std::vector<Regions>& candidates) {
  for (const Regions& regions : candidates) {
    for (const Design& d : regions) {
      if (const Pin* pin = d.counterface.in_place()) return pin;
    }
  }
  return nullptr;
}

// What touches the candidates, each once: "finger clean", the name of a pin.
std::string touching_of(const std::vector<Regions>& candidates, FingerState state,
                        const RankOptions& options) {
  if (!options.felt()) return "seen, not felt";
  std::vector<std::string> names;
  for (const Regions& regions : candidates) {
    for (const Design& d : regions) {
      const Pin* pin = d.counterface.in_place();
      std::string name =
          pin ? pin->name : "finger " + finger_state_names()[static_cast<std::size_t>(state)];
      if (std::find(names.begin(), names.end(), name) == names.end())
        names.push_back(std::move(name));
    }
  }
  return join_names(names);
}

// What the steps of the finger's parameters are run with, the same for all candidates.
void plan_steps(const std::vector<Regions>& candidates, Ranking& out) {
  if (const std::string why = parameters_unknown(candidates); !why.empty()) throw InputError(why);
  const Design& first = candidates.front().front();
  const ModelCost cost = model_cost(scene_of(first), fidelity_of(first));
  out.members = cost.members;
  if (cost.members == 0) out.directions = cost.runs / 2;
  out.step_skins = cost.fidelity.skins;
  out.step_grid = cost.fidelity.grid;
}

// A design whose texture is a map with room for more patches than one, at several places of it:
// what one place is like is not what the surface is like.
Regions places_of(const Design& design) {
  const auto* map = std::get_if<Measured3d>(&design.texture.kind);
  if (!map || map->at_x != 0 || map->at_y != 0) return {design};
  Regions out;
  for (const MapPlace& at : places_of_map(facts(design.texture).scans.front(), map->patch)) {
    out.push_back(design);
    auto& placed = std::get<Measured3d>(out.back().texture.kind);
    placed.at_x = at.x;
    placed.at_y = at.y;
  }
  return out;
}

// Every region at its places.
std::vector<Regions> at_places(const std::vector<Regions>& candidates) {
  std::vector<Regions> out;
  for (const Regions& regions : candidates) {
    out.emplace_back();
    for (const Design& region : regions) {
      const Regions places = places_of(region);
      out.back().insert(out.back().end(), places.begin(), places.end());
    }
  }
  return out;
}

// What was pressed of maps that are larger, and that they are rigid where a coating may not be.
std::vector<std::string> notes_of_maps(const std::vector<Regions>& candidates) {
  bool one_place = false, rigid = false;
  std::size_t places = 0;
  // Keys of the width of places; of parts of stacks, that choose their one place.
  std::set<std::string> widths, part_places;
  for (const Regions& regions : candidates) {
    const Design& d = regions.front();
    if (facts(d.texture).scans.empty()) continue;
    rigid = rigid || d.surface.modulus == 0;
    places = std::max(places, regions.size());
    for (const DesignScan& scan : scans_of(d)) {
      if (scan.taken == 0) continue;  // of the skin
      if (regions.size() > 1) {
        widths.insert(scan.periods ? "whole periods" : scan.section + ".patch");
      } else if (!scan.changes.as_is && !scan.changes.repeats &&
                 2 * scan.taken < scan.changes.width) {
        if (scan.section == "texture")
          one_place = true;
        else
          part_places.insert(scan.section + ".at_x");
      }
    }
  }
  std::vector<std::string> out;
  if (places > 1)
    out.push_back(fmt::format(
        "scans: skins press {} places of a map in turn ({} wide), so that ± holds how they differ",
        places, join_names({widths.begin(), widths.end()}, " or ")));
  if (one_place)
    out.emplace_back(
        "scans: one place of a map is pressed, and no ± holds what other places would say: leave "
        "out texture.at_x and at_y, or take a smaller texture.patch");
  if (!part_places.empty())
    out.push_back(fmt::format(
        "scans: of a map that is a part of a stack one place is pressed, and no ± holds what other "
        "places would say: join designs with another {} and at_y by +, as regions of one",
        join_names({part_places.begin(), part_places.end()})));
  if (rigid)
    out.emplace_back(
        "scans: surfaces without surface.modulus are rigid; what gives way under a finger, a soft "
        "coating, has another order");
  return out;
}

// What became of each map before it was pressed, and how rough it is then.
std::vector<std::string> scans_behind(const std::vector<Regions>& candidates) {
  std::vector<std::string> out;
  for (const Regions& regions : candidates) {
    for (const Design& region : regions) {
      for (const DesignScan& scan : scans_of(region)) {
        std::string line =
            fmt::format("{}; Sq {} nm", text(scan), significant(1e9 * scan.changes.rms, 3));
        if (std::find(out.begin(), out.end(), line) == out.end()) out.push_back(std::move(line));
      }
    }
  }
  return out;
}

// Of the candidates in messages: as they are called, or by their titles.
std::vector<std::string> names_of(const std::vector<Regions>& candidates,
                                  const RankOptions& options) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    out.push_back(i < options.names.size() ? options.names[i] : candidates[i].front().title);
  return out;
}

// How far looks can be trusted, as their theories say it. A look is the same in every state of the
// finger.
std::vector<std::string> notes_of_looks(const std::vector<StateRanking>& states,
                                        const std::vector<std::string>& names) {
  std::vector<std::string> out(names.size());
  for (const RankedCandidate& r : states.front().candidates) {
    if (!r.look_warning.empty())
      out[r.index] = fmt::format("look of {}: {}", names[r.index], r.look_warning);
  }
  out.erase(std::remove(out.begin(), out.end(), ""), out.end());
  return out;
}

// What the model says against the numbers of candidates, in the order of the files.
std::vector<std::string> notes_of_troubles(const StateRanking& state,
                                           const std::vector<std::string>& names) {
  std::vector<std::string> out(names.size());
  for (const RankedCandidate& r : state.candidates) {
    if (!r.trouble.empty())
      out[r.index] = fmt::format("{}, {}: {}", names[r.index], state.touching, r.trouble);
  }
  std::erase(out, "");
  return out;
}

// Surfaces without a shear strength of their own all have the finger's on glass.
std::vector<std::string> notes_of(const std::vector<Regions>& candidates,
                                  const std::vector<std::string>& names,
                                  const RankOptions& options) {
  const bool rubs =
      std::any_of(options.criteria.begin(), options.criteria.end(), [](const auto& c) {
        return metric_quantity(c.expression.metric) == &PointQuantities::friction_off ||
               metric_quantity(c.expression.metric) == &PointQuantities::friction_on;
      });
  const auto with_its_own = [&](const Design& d) {
    if (d.counterface.in_place()) return true;  // a pin brings the law of the pair
    const Surface& s = d.surface;
    return std::all_of(options.states.begin(), options.states.end(), [&](FingerState state) {
      return s.shear_strength > 0 ||
             (state == FingerState::Natural && s.shear_strength_natural > 0) ||
             (state == FingerState::Wet && s.shear_strength_wet > 0);
    });
  };
  std::vector<std::string> without;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (!std::all_of(candidates[i].begin(), candidates[i].end(), with_its_own))
      without.push_back(names[i]);
  }
  if (!rubs || without.empty()) return {};
  if (without.size() == candidates.size()) {
    return {
        "friction: no candidate has surface.shear_strength, all rub with the finger's on glass: "
        "the order of friction is that of contact area (and water) alone, whatever they are made "
        "of"};
  }
  return {fmt::format(
      "friction: {} has no surface.shear_strength and rubs with the finger's on glass, others "
      "have their own",
      join_names(without))};
}

}  // namespace

std::string parameters_unknown(const std::vector<Regions>& candidates) {
  const Design& first = candidates.front().front();
  if (const Pin* pin = pin_among(candidates))
    return fmt::format("nothing is fitted of \"{}\"", pin->name);
  const Scene with = scene_of(first);
  if (const std::string why = unknown_model(with.finger); !why.empty()) return why;
  for (const Regions& regions : candidates) {
    for (const Design& d : regions) {
      const Scene scene = scene_of(d);
      if (scene.finger.belief != with.finger.belief)
        return fmt::format("\"{}\" and \"{}\" are of fingers with other beliefs", first.title,
                           d.title);
      if (!scene.finger.belief.empty() && scene.model != scene.finger.calibrated_for)
        return fmt::format("the belief of \"{}\" is of other model options than its [model]",
                           d.title);
      if (!scene.finger.belief.empty()) continue;
      if (scene.finger.uncertainty != with.finger.uncertainty)
        return fmt::format(
            "\"{}\" and \"{}\" are of fingers with other [[uncertainty]]: what their parameters "
            "do to a difference is not known",
            first.title, d.title);
    }
  }
  return {};
}

Ranking ranking_of(const std::vector<Regions>& named, const RankOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  const std::vector<Regions> candidates = at_places(named);
  Ranking out;
  if (!options.weights.empty() && options.weights.size() != options.criteria.size())
    throw InputError(fmt::format("{} weights for {} criteria: one for each is needed",
                                 options.weights.size(), options.criteria.size()));
  for (const double w : options.weights) {
    if (!(w > 0)) throw InputError("a weight is more than 0; leave a criterion of weight 0 out");
  }
  for (std::size_t i = 0; i < options.states.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (options.states[i] != options.states[k]) continue;
      throw InputError(
          fmt::format("the finger's state \"{}\" is named twice",
                      finger_state_names()[static_cast<std::size_t>(options.states[i])]));
    }
  }
  for (const Regions& regions : candidates) out.titles.push_back(regions.front().title);
  out.scans = scans_behind(named);
  out.conditions = condition_differences(candidates, options);
  const std::vector<std::string> names = names_of(candidates, options);
  out.notes = notes_of(candidates, names, options);
  for (std::string& note : notes_of_maps(candidates)) out.notes.push_back(std::move(note));
  const Pin* pin = pin_among(candidates);
  if (const std::string unknown = parameters_unknown(candidates);
      options.felt() && !options.parameters && !unknown.empty())
    out.notes.push_back(
        "no interval and no probability holds what is not known of finger and model, which is "
        "often more than all else: " +
        unknown +
        (pin ? "" : "; [finger] base = \"fingers/reference.toml\" has it of the shipped finger"));
  if (!options.any_conditions) require_same_conditions(out.conditions);
  if (options.moves_finger()) plan_steps(candidates, out);
  if (pin && options.states.size() > 1)
    throw InputError(
        fmt::format("\"{}\" stands in place of the finger and has no states: give one "
                    "--state at most",
                    pin->name));
  for (FingerState state : options.states) {
    out.states.push_back(StateRanker(candidates, state, options).run());
    out.states.back().touching = touching_of(candidates, state, options);
    out.skins += out.states.back().skins;
    for (std::string& note : notes_of_troubles(out.states.back(), names))
      out.notes.push_back(std::move(note));
  }
  for (std::string& note : notes_of_looks(out.states, names)) out.notes.push_back(std::move(note));
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

Ranking ranking_of(const std::vector<Design>& designs, const RankOptions& options) {
  std::vector<Regions> candidates;
  for (const Design& d : designs) candidates.push_back({d});
  return ranking_of(candidates, options);
}

}  // namespace papilla::rank
