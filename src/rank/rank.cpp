#include "rank/rank.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "base/constants.h"
#include "base/error.h"
#include "base/random.h"
#include "base/statistics.h"
#include "base/text.h"
#include "config/writer.h"
#include "estimate/parameters.h"
#include "forward/forward.h"

namespace papilla {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kDraws = 4000;  // of the orders, for p_best: an error of 0.8 points at most

// One candidate in one finger state, and the skins solved so far.
class Candidate {
 public:
  Candidate(const Regions& regions, FingerState state, const RankOptions& options)
      : regions_(regions),
        design_(regions.front()),
        options_(options),
        scene_(scene_of(design_)),
        fidelity_(fidelity_of(design_)) {
    scene_.finger.state = state;
    fidelity_.threads = options.threads;
    fidelity_.skins = options.batch;
    if (std::any_of(options.criteria.begin(), options.criteria.end(), [](const Criterion& c) {
          return find_metric(c.expression.metric)->appearance;
        })) {
      look_ = appearance_of(design_);
    }
  }

  int skins() const { return patches_.skins(); }

  // More skins: the next of the common sequence, shared out over the regions.
  void extend() {
    solve([](const Finger& finger) { return finger; }, fidelity_, patches_);
    // Jackknife pseudo-values: a sample a skin of any metric. Eq. ranking.2
    const int n = skins();
    Response response = respond(scene_, fidelity_, patches_);
    const auto values = [&] {
      std::vector<double> out;
      for (const Criterion& c : options_.criteria) out.push_back(value(c, response));
      return out;
    };
    const std::vector<double> all = values();
    pseudo_.assign(all.size(), std::vector<double>(static_cast<std::size_t>(n)));
    const std::vector<std::vector<ResponsePoint>> without = std::move(response.without);
    response.without.clear();
    for (int k = 0; k < n; ++k) {
      response.points = without[static_cast<std::size_t>(k)];
      const std::vector<double> rest = values();
      for (std::size_t c = 0; c < all.size(); ++c)
        pseudo_[c][static_cast<std::size_t>(k)] = n * all[c] - (n - 1) * rest[c];
    }
  }

  const std::vector<double>& samples(std::size_t criterion) const { return pseudo_[criterion]; }

  const Finger& finger() const { return scene_.finger; }
  Fidelity steps_fidelity() const { return step_fidelity(fidelity_of(design_)); }

  // What each step of the finger does to each criterion. Eq. ranking.5
  void step() {
    Fidelity few = steps_fidelity();
    few.threads = options_.threads;
    const auto moved = [&](std::size_t direction, bool up) {
      const auto move = [&](const Finger& finger) {
        const FingerStep step = finger_steps(finger)[direction];
        return up ? step.up : step.down;
      };
      Scene scene = scene_;
      scene.finger = move(scene_.finger);
      PatchSet patches;
      solve(move, few, patches);
      return Resampled(respond(scene, few, patches));
    };
    std::vector<ParameterStep> ends;
    for (std::size_t k = 0; k < finger_steps(scene_.finger).size(); ++k)
      ends.push_back({moved(k, true), moved(k, false)});
    Response there;
    there.driven = scene_.drive.driven();
    for (const Criterion& c : options_.criteria) {
      const auto samples = step_samples(ends, [&](const std::vector<ResponsePoint>& points) {
        there.points = points;
        return std::optional(value(c, there));
      });
      steps_.push_back(*samples);
    }
  }
  const StepSamples& steps(std::size_t criterion) const { return steps_[criterion]; }

 private:
  // The next skins of the common sequence, as many as the fidelity says, on the moved finger.
  void solve(const std::function<Finger(const Finger&)>& move, Fidelity fidelity,
             PatchSet& patches) const {
    const int count = static_cast<int>(regions_.size()), skins = fidelity.skins;
    for (int r = 0; r < count; ++r) {
      fidelity.first_skin = patches.skins();
      fidelity.skins = skins * (r + 1) / count - skins * r / count;
      if (fidelity.skins == 0) continue;
      Scene scene = scene_of(regions_[static_cast<std::size_t>(r)]);
      scene.finger.state = scene_.finger.state;
      scene.finger = move(scene.finger);
      PatchSet more = solve_patches(scene, regions_[static_cast<std::size_t>(r)].texture, fidelity);
      if (patches.skins() == 0) {
        patches = std::move(more);
      } else {
        patches.add(more);
      }
    }
  }

  double value(const Criterion& c, Response& response) const {
    response.appearance = look_;
    const auto v = summarise(c.expression.summary, c.expression.metric, response);
    if (!v || !std::isfinite(v->value)) {
      throw InputError(fmt::format("{} is not defined for \"{}\"{}", metric_text(c.expression),
                                   design_.title,
                                   look_ && look_->refused() ? ": " + look_->warning
                                   : response.driven         ? ""
                                                             : ": it is not driven (0 V)"));
    }
    return v->value;
  }

  const Regions& regions_;
  const Design& design_;  // the first region: what all share
  const RankOptions& options_;
  Scene scene_;
  Fidelity fidelity_;
  std::optional<Optics> look_;  // where a criterion asks for it
  PatchSet patches_;
  std::vector<std::vector<double>> pseudo_;  // [criterion][skin]
  std::vector<StepSamples> steps_;           // one a criterion
};

// steps: of the finger's parameters; empty: not asked for.
Interval interval(const std::vector<double>& samples, const StepSamples& steps) {
  const Estimate e = mean_estimate(samples);
  double half = samples.size() > 1
                    ? student_t_quantile(0.975, static_cast<int>(samples.size()) - 1) * e.se
                    : kInfinity;
  Interval out{e.value, 0, 0, std::nullopt};
  if (!steps.empty()) {
    out.parameters = step_error(steps);
    half = std::hypot(half, normal_quantile(0.975) * *out.parameters);
  }
  out.low = out.value - half;
  out.high = out.value + half;
  return out;
}

// What the skins that candidate i has not met would move its mean by: as much as they move the mean
// of the candidates that have met most. Without it the luck of few skins orders the candidates.
// Eq. ranking.6
double unmet(const std::vector<std::vector<double>>& samples, std::size_t i) {
  std::size_t most = 0;
  for (const auto& s : samples) most = std::max(most, s.size());
  const auto own = static_cast<std::ptrdiff_t>(samples[i].size());
  double sum = 0;
  int count = 0;
  for (const auto& s : samples) {
    if (s.size() != most) continue;
    sum += mean_estimate(s).value -
           mean_estimate(std::vector<double>(s.begin(), s.begin() + own)).value;
    ++count;
  }
  return sum / count;
}

class StateRanker {
 public:
  StateRanker(const std::vector<Regions>& candidates, FingerState state, const RankOptions& options)
      : options_(options), state_(state) {
    for (const Regions& c : candidates) candidates_.emplace_back(c, state, options);
  }

  // Everyone gets a batch; then only neighbours in the order whose difference is open.
  StateRanking run(int& skins) {
    for (Candidate& c : candidates_) c.extend();
    for (std::ptrdiff_t said = 0;;) {
      score();
      std::vector<bool> open(candidates_.size(), false);
      for (std::size_t i = 0; i + 1 < order_.size(); ++i) {
        if (decided(order_[i], order_[i + 1])) continue;
        // The difference is over the skins that both have: the one with more waits.
        const int a = candidates_[order_[i]].skins(), b = candidates_[order_[i + 1]].skins();
        if (a <= b) open[order_[i]] = true;
        if (b <= a) open[order_[i + 1]] = true;
      }
      bool more = false;
      for (std::size_t i = 0; i < candidates_.size(); ++i) {
        if (!open[i] || candidates_[i].skins() + options_.batch > options_.max_skins) continue;
        candidates_[i].extend();
        more = true;
      }
      if (!more) break;
      const auto still = std::count(open.begin(), open.end(), true);
      if (options_.note && still != said) {  // a batch is quick: only what is new
        options_.note(fmt::format("{}: {} of {} candidates still open",
                                  finger_state_names()[static_cast<std::size_t>(state_)], still,
                                  open.size()));
      }
      said = still;
    }
    for (const Candidate& c : candidates_) skins += c.skins();
    if (options_.parameters) step();  // more skins make nothing of it surer
    return result();
  }

 private:
  // Scores over the steps of the finger, the same for all candidates. Eq. ranking.5
  void step() {
    if (options_.note)
      options_.note(fmt::format("{}: parameters of the finger",
                                finger_state_names()[static_cast<std::size_t>(state_)]));
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
      steps_.push_back(std::move(s));
    }
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

  // Scores a skin. Eq. ranking.1
  void score() {
    const std::vector<double> scale = score_scale();
    scores_.clear();
    for (const Candidate& x : candidates_) {
      std::vector<double> s(static_cast<std::size_t>(x.skins()), 0);
      for (std::size_t c = 0; c < scale.size(); ++c) {
        for (std::size_t k = 0; k < s.size(); ++k) s[k] += scale[c] * x.samples(c)[k];
      }
      scores_.push_back(std::move(s));
    }
    order_.resize(candidates_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::vector<double> mean;
    for (std::size_t i = 0; i < scores_.size(); ++i)
      mean.push_back(mean_estimate(scores_[i]).value + unmet(scores_, i));
    std::stable_sort(order_.begin(), order_.end(),
                     [&](std::size_t a, std::size_t b) { return mean[a] > mean[b]; });
    // Neighbours stand as their paired difference says; it may go in circles, so not for ever.
    for (std::size_t pass = 0; pass < order_.size(); ++pass) {
      bool swapped = false;
      for (std::size_t i = 0; i + 1 < order_.size(); ++i) {
        if (difference(order_[i], order_[i + 1]).value >= 0) continue;
        std::swap(order_[i], order_[i + 1]);
        swapped = true;
      }
      if (!swapped) break;
    }
  }

  // Score of a minus b over the skins that both have, and over the steps of the finger.
  Interval difference(std::size_t a, std::size_t b) const {
    return interval(minus(scores_[a], scores_[b]), step_difference(a, b));
  }
  StepSamples step_difference(std::size_t a, std::size_t b) const {
    StepSamples out;
    for (std::size_t k = 0; !steps_.empty() && k < steps_[a].size(); ++k)
      out.push_back(minus(steps_[a][k], steps_[b][k]));
    return out;
  }
  // [design][direction] What a step of the finger does to a score beyond the mean over designs,
  // scaled to what is left of all of them without the scatter of the skins.
  std::vector<std::vector<double>> step_moves() const {
    std::vector<std::vector<double>> out;
    double sure = 0, all = 0;
    for (const StepSamples& own : steps_) {
      StepSamples beyond = own;
      for (std::size_t k = 0; k < beyond.size(); ++k) {
        for (std::size_t s = 0; s < beyond[k].size(); ++s) {
          for (const StepSamples& other : steps_)
            beyond[k][s] -= other[k][s] / static_cast<double>(steps_.size());
        }
      }
      out.emplace_back();
      for (const std::vector<double>& direction : beyond) {
        out.back().push_back(mean_estimate(direction).value);
        all += square(out.back().back());
      }
      sure += square(step_error(beyond));
    }
    for (std::vector<double>& moves : out) {
      for (double& v : moves) v *= all > 0 ? std::sqrt(std::min(1.0, sure / all)) : 0;
    }
    return out;
  }
  static std::vector<double> minus(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> d(std::min(a.size(), b.size()));
    for (std::size_t k = 0; k < d.size(); ++k) d[k] = a[k] - b[k];
    return d;
  }
  bool decided(std::size_t a, std::size_t b) const {
    const Interval d = difference(a, b);
    return d.low > 0 || d.high < 0;
  }

  // Eq. ranking.3: normal scores with the covariance of the common skins.
  std::vector<double> probabilities() const {
    const std::size_t m = scores_.size();
    std::size_t n = 0;
    for (const auto& s : scores_) n = std::max(n, s.size());
    std::vector<double> mean(m), best(m, 0);
    // A draw of the means is a random combination of the centred samples, a number a skin: those
    // that two scores have in common move both.
    std::vector<std::vector<double>> centred(m);
    // Of those that met all skins, a number a skin: what carries the others to all, Eq. ranking.6.
    std::vector<double> carrier(n, 0);
    const auto met_all = static_cast<double>(std::count_if(
        scores_.begin(), scores_.end(), [&](const auto& s) { return s.size() == n; }));
    for (const auto& s : scores_) {
      for (std::size_t k = 0; s.size() == n && k < n; ++k) carrier[k] += s[k] / met_all;
    }
    const auto add = [&](const std::vector<double>& samples, std::size_t count, double sign,
                         std::vector<double>& to) {
      double middle = 0;
      for (std::size_t k = 0; k < count; ++k) middle += samples[k] / static_cast<double>(count);
      const auto c = static_cast<double>(count);
      for (std::size_t k = 0; k < count; ++k)
        to[k] += sign * (samples[k] - middle) / std::sqrt(c * std::max(1.0, c - 1));
    };
    for (std::size_t i = 0; i < m; ++i) {
      const std::size_t own = scores_[i].size();
      mean[i] = mean_estimate(scores_[i]).value + unmet(scores_, i);
      centred[i].assign(n, 0);
      add(scores_[i], own, 1, centred[i]);
      if (own == n) continue;
      add(carrier, n, 1, centred[i]);
      add(carrier, own, -1, centred[i]);
    }
    RandomStream random(1, "ranking", static_cast<std::uint64_t>(state_));
    const std::vector<std::vector<double>> moves = step_moves();
    std::vector<double> z(n), finger(moves.empty() ? 0 : moves.front().size());
    std::vector<std::size_t> winners;
    for (int draw = 0; draw < kDraws; ++draw) {
      for (double& v : z) v = random.normal();
      for (double& v : finger) v = random.normal();
      double highest = -kInfinity;
      for (std::size_t i = 0; i < m; ++i) {
        double v = mean[i];
        for (std::size_t k = 0; k < centred[i].size(); ++k) v += centred[i][k] * z[k];
        for (std::size_t k = 0; k < finger.size(); ++k) v += moves[i][k] * finger[k];
        if (v < highest) continue;
        if (v > highest) winners.clear();
        highest = v;
        winners.push_back(i);
      }
      for (std::size_t i : winners)  // equal designs share the win
        best[i] += 1.0 / kDraws / static_cast<double>(winners.size());
    }
    return best;
  }

  // Eq. ranking.4: normal error of the paired difference.
  double probability_ahead(std::size_t a, std::size_t b) const {
    const Estimate e = mean_estimate(minus(scores_[a], scores_[b]));
    const double se = std::hypot(e.se, step_error(step_difference(a, b)));
    return se > 0 ? normal_cdf(e.value / se) : e.value > 0 ? 1 : 0.5;
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
    const std::vector<double> p = probabilities();
    std::vector<std::vector<std::vector<double>>> samples(options_.criteria.size());
    for (std::size_t c = 0; c < samples.size(); ++c) {
      for (const Candidate& x : candidates_) samples[c].push_back(x.samples(c));
    }
    const auto moved = [](Interval v, double by) {
      v.value += by;
      v.low += by;
      v.high += by;
      return v;
    };
    for (std::size_t place = 0; place < order_.size(); ++place) {
      const std::size_t i = order_[place];
      RankedCandidate r;
      r.index = i;
      r.score = moved(interval(scores_[i], steps_.empty() ? StepSamples{} : steps_[i]),
                      unmet(scores_, i));
      if (place > 0) r.behind_best = difference(i, order_.front());
      if (place + 1 < order_.size()) {
        r.ahead_of_next = difference(i, order_[place + 1]);
        r.tied_with_next = !decided(i, order_[place + 1]);
        r.p_ahead = probability_ahead(i, order_[place + 1]);
      }
      r.rank = static_cast<int>(place) + 1;
      if (place > 0 && out.candidates.back().tied_with_next) r.rank = out.candidates.back().rank;
      r.p_best = p[i];
      for (std::size_t c = 0; c < options_.criteria.size(); ++c)
        r.metrics.push_back(moved(
            interval(samples[c][i], options_.parameters ? candidates_[i].steps(c) : StepSamples{}),
            unmet(samples[c], i)));
      r.skins = candidates_[i].skins();
      out.candidates.push_back(std::move(r));
    }
    return out;
  }

  const RankOptions& options_;
  FingerState state_;
  std::vector<Candidate> candidates_;
  std::vector<std::vector<double>> scores_;  // [design][skin]
  std::vector<StepSamples> steps_;           // one a design; empty: not asked for
  std::vector<std::size_t> order_;
};

// Every value below a node as a file has it, by its key; a list is one value.
void leaves(const Node& node, const std::string& path,
            std::vector<std::pair<std::string, std::string>>& out) {
  if (node.is_table()) {
    for (const Node& child : node.children)
      leaves(child, path.empty() ? child.key : path + "." + child.key, out);
    return;
  }
  Node line = table_node();
  line.set("v", node);
  std::string text = write_toml(line);
  if (const std::size_t at = text.find("v = "); at != std::string::npos) text.erase(0, at + 4);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  if (node.is_text()) text = node.text;
  out.emplace_back(path, std::move(text));
}

// What all candidates have to share for these criteria, key by key.
std::vector<std::pair<std::string, std::string>> conditions_of(const Design& design,
                                                               const RankOptions& options) {
  bool felt = false, driven = false, seen = false;
  for (const Criterion& c : options.criteria) {
    const MetricInfo& info = *find_metric(c.expression.metric);
    seen = seen || info.appearance;
    felt = felt || !info.appearance;
    driven = driven || info.needs_drive;
  }
  std::vector<std::pair<std::string, std::string>> out;
  if (felt) {
    Finger finger = design.finger;
    // Names and the story of the fit move nothing; the options rule the state.
    finger.name.clear();
    finger.fitted_to.clear();
    finger.uncertainty.clear();
    finger.calibrated_for = {};
    finger.state = FingerState::Clean;
    leaves(to_table(finger), "finger", out);
    leaves(to_table(design.environment), "environment", out);
    leaves(to_table(design.model), "model", out);
    AccuracySettings accuracy = design.accuracy;
    accuracy.target = 0;  // a ranking takes the skins that its order asks for
    accuracy.parameters = false;
    leaves(to_table(accuracy), "accuracy", out);
  }
  if (driven) leaves(to_table(design.drive), "drive", out);
  if (seen) leaves(to_table(design.view), "view", out);
  return out;
}

const MetricInfo& info_of(const Criterion& c) { return *find_metric(c.expression.metric); }

// A number of a metric for people: its scale and unit.
std::pair<double, std::string> people(const Criterion& c) {
  const bool relative =
      c.expression.summary == Summary::Variation || c.expression.summary == Summary::Range;
  const std::string& unit = info_of(c).unit;
  if (relative || unit.empty()) return {1, ""};
  if (unit == "N") return {1e3, "mN"};
  if (unit == "m") return {1e9, "nm"};
  if (unit == "m/Pa") return {1e12, "um/MPa"};
  return {1, unit};
}

}  // namespace

const std::vector<std::string>& finger_state_names() {
  static const std::vector<std::string> names{"clean", "natural", "wet"};
  return names;
}

std::string Criterion::text() const { return metric_text(expression) + (high ? ":high" : ":low"); }

std::vector<Criterion> parse_criteria(const std::string& text) {
  std::vector<Criterion> out;
  for (std::string word : split(text, ',')) {
    if (word.empty()) throw InputError("\"" + text + "\": expected METRIC:low or METRIC:high");
    Criterion c;
    std::string direction;
    if (const std::size_t colon = word.rfind(':'); colon != std::string::npos) {
      direction = word.substr(colon + 1);
      word.resize(colon);
    }
    c.expression = parse_metric(word);
    if (voltage_target(c.expression.metric))
      throw InputError(
          fmt::format("\"{}\": a ranking is by forces at the designs' own drive", word));
    const Better better = better_direction(c.expression);
    if (direction.empty() && better == Better::Neither) {
      throw InputError(
          fmt::format("{0} has no better direction of its own; say {0}:low or "
                      "{0}:high",
                      word));
    }
    if (!direction.empty() && direction != "low" && direction != "high") {
      throw InputError(fmt::format("\"{}\" is no direction; use low or high", direction));
    }
    c.high = direction.empty() ? better == Better::Higher : direction == "high";
    out.push_back(c);
  }
  return out;
}

Ranking rank(const std::vector<Design>& designs, const RankOptions& options) {
  std::vector<Regions> candidates;
  for (const Design& d : designs) candidates.push_back({d});
  return rank(candidates, options);
}

std::string ConditionDifference::text() const {
  const auto cut = [](const std::string& text) {  // lists of fitted numbers are long
    constexpr std::size_t kLongest = 48;
    return text.size() > kLongest ? text.substr(0, kLongest) + "..." : text;
  };
  return fmt::format("{}: {} in {}, {} in {}", key, cut(value), first, cut(other_value), other);
}

std::vector<ConditionDifference> condition_differences(const std::vector<Regions>& candidates,
                                                       const RankOptions& options) {
  const auto name = [&](std::size_t i) {
    if (i < options.names.size()) return options.names[i];
    const std::string& title = candidates[i].front().title;
    return title.empty() ? fmt::format("candidate {}", i + 1) : "\"" + title + "\"";
  };
  std::vector<ConditionDifference> out;
  const auto first = conditions_of(candidates.front().front(), options);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    for (const Design& design : candidates[i]) {
      const auto other = conditions_of(design, options);
      const auto value = [&](const auto& list, const std::string& key) {
        const auto at = std::find_if(list.begin(), list.end(),
                                     [&](const auto& pair) { return pair.first == key; });
        return at == list.end() ? std::string("nothing") : at->second;
      };
      const auto add = [&](const std::string& key) {
        const std::string a = value(first, key), b = value(other, key);
        if (a == b || std::any_of(out.begin(), out.end(),
                                  [&](const ConditionDifference& d) { return d.key == key; }))
          return;
        out.push_back({key, name(0), a, b, name(i)});
      };
      for (const auto& pair : first) add(pair.first);
      for (const auto& pair : other) add(pair.first);
    }
  }
  return out;
}

Ranking rank(const std::vector<Regions>& candidates, const RankOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  Ranking out;
  out.conditions = condition_differences(candidates, options);
  if (!out.conditions.empty() && !options.any_conditions) {
    std::vector<std::string> texts, sets;
    for (const ConditionDifference& d : out.conditions) {
      texts.push_back(d.text());
      sets.push_back(fmt::format("--set '{}={}'", d.key, d.value));
    }
    constexpr std::size_t kShown = 6, kSettable = 3;  // other fingers differ in dozens of keys
    const std::size_t more = texts.size() > kShown ? texts.size() - kShown : 0;
    texts.resize(texts.size() - more);
    throw InputError(fmt::format(
        "the candidates are not judged under the same conditions, so that their order would say "
        "nothing about the surfaces:\n  {}{}\nmake them equal: {}; or compare them as they are: "
        "--any-conditions",
        join_names(texts, "\n  "), more ? fmt::format("\n  and {} keys more", more) : "",
        sets.size() > kSettable
            ? std::string("the same [finger] base, environment, drive and accuracy in every file")
            : join_names(sets, " ")));
  }
  if (options.parameters) {
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
  for (FingerState state : options.states)
    out.states.push_back(StateRanker(candidates, state, options).run(out.skins));
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return out;
}

std::string ranking_table(const std::vector<std::string>& names, const RankOptions& options,
                          const Ranking& ranking) {
  std::string out;
  for (const StateRanking& state : ranking.states) {
    out += "finger " + finger_state_names()[static_cast<std::size_t>(state.state)] + "\n";
    std::vector<std::vector<std::string>> rows{{"rank", "design"}};
    for (const Criterion& c : options.criteria) {
      const std::string unit = people(c).second;
      rows[0].push_back(c.text() + (unit.empty() ? "" : " " + unit));
    }
    rows[0].push_back("ahead of the next, %");
    if (options.parameters) rows[0].push_back("finger's part");
    for (const char* name : {"p(ahead)", "p(best)", "skins"}) rows[0].push_back(name);
    for (const RankedCandidate& r : state.candidates) {
      std::vector<std::string> row{fmt::format("{:>3}{}", r.rank, r.tied_with_next ? "=" : " "),
                                   names[r.index]};
      for (std::size_t c = 0; c < r.metrics.size(); ++c) {
        const double scale = people(options.criteria[c]).first;
        row.push_back(fmt::format("{:.4g} ± {:.2g}", r.metrics[c].value * scale,
                                  (r.metrics[c].high - r.metrics[c].low) / 2 * scale));
      }
      const bool last = &r == &state.candidates.back();
      row.push_back(last ? std::string("-")
                         : fmt::format("{:.1f} [{:.1f}, {:.1f}]", 100 * r.ahead_of_next.value,
                                       100 * r.ahead_of_next.low, 100 * r.ahead_of_next.high));
      if (options.parameters)
        row.push_back(last ? std::string("-")
                           : fmt::format("±{:.1f}", 100 * normal_quantile(0.975) *
                                                        r.ahead_of_next.parameters.value_or(0)));
      row.push_back(last ? std::string("-") : fmt::format("{:.3f}", r.p_ahead));
      row.push_back(fmt::format("{:.3f}", r.p_best));
      row.push_back(fmt::format("{}", r.skins));
      rows.push_back(std::move(row));
    }
    out += aligned_table(rows, 2);
    out += fmt::format("{} patches of skin tried", state.skins);
    if (state.skins < state.equal_skins)
      out += fmt::format(" (more where two designs are close; {} with as many for every design)",
                         state.equal_skins);
    out += "\n\n";
  }
  if (!ranking.conditions.empty()) {
    out +=
        "warning: the designs are not judged under the same conditions, and the order is that of "
        "surface and conditions together:\n";
    for (const ConditionDifference& d : ranking.conditions) out += "  " + d.text() + "\n";
  }
  if (ranking.directions > 0) {
    out += fmt::format(
        "parameters of the finger in every interval and probability: {} directions of its "
        "covariance, the same for all designs; {} skins, {} pixels. Finger's part: of the lead\n",
        ranking.directions, ranking.step_skins, ranking.step_grid);
  }
  if (options.criteria.size() > 1)
    out +=
        "ahead of the next: by the mean over criteria of what each is better by, in parts of the "
        "candidates' mean size\n";
  int fewest = std::numeric_limits<int>::max();
  for (const StateRanking& state : ranking.states) {
    for (const RankedCandidate& r : state.candidates) fewest = std::min(fewest, r.skins);
  }
  return out +
         fmt::format(
             "read order, leads and probabilities: they are paired, all designs meet the same "
             "skins. The values share the luck of these few ({} at least) and may all be high or "
             "low together, beyond their ±; errors that all designs share (grid, water) are not in "
             "± either: papilla evaluate gives values. ± and [ ] are 95 % intervals over skins; = "
             "marks a tie with the next. {} patches of skin in all, {:.1f} s\n",
             fewest, ranking.skins, ranking.seconds);
}

std::string ranking_json(const std::vector<std::string>& names, const RankOptions& options,
                         const Ranking& ranking) {
  const auto number = [](double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); };
  const auto interval_json = [&](const Interval& i) {
    return Json{{"value", number(i.value)},
                {"low", number(i.low)},
                {"high", number(i.high)},
                {"parameters", i.parameters ? number(*i.parameters) : Json(nullptr)}};
  };
  Json states = Json::array();
  for (const StateRanking& state : ranking.states) {
    Json list = Json::array();
    for (const RankedCandidate& r : state.candidates) {
      Json metrics = Json::object();
      for (std::size_t c = 0; c < r.metrics.size(); ++c)
        metrics[metric_text(options.criteria[c].expression)] = interval_json(r.metrics[c]);
      list.push_back({{"name", names[r.index]},
                      {"index", r.index},
                      {"rank", r.rank},
                      {"tied_with_next", r.tied_with_next},
                      {"score", interval_json(r.score)},
                      {"behind_best", interval_json(r.behind_best)},
                      {"ahead_of_next", interval_json(r.ahead_of_next)},
                      {"p_ahead", r.p_ahead},
                      {"p_best", r.p_best},
                      {"metrics", metrics},
                      {"skins", r.skins}});
    }
    states.push_back({{"state", finger_state_names()[static_cast<std::size_t>(state.state)]},
                      {"candidates", list},
                      {"skins", state.skins},
                      {"equal_skins", state.equal_skins}});
  }
  Json by = Json::array(), criteria = Json::array();
  for (const Criterion& c : options.criteria) {
    const bool relative =
        c.expression.summary == Summary::Variation || c.expression.summary == Summary::Range;
    by.push_back(c.text());
    criteria.push_back({{"metric", metric_text(c.expression)},
                        {"better", c.high ? "high" : "low"},
                        {"unit", relative ? "" : info_of(c).unit}});
  }
  Json conditions = Json::array();
  for (const ConditionDifference& d : ranking.conditions) {
    conditions.push_back(
        {{"key", d.key}, {"designs", {d.first, d.other}}, {"values", {d.value, d.other_value}}});
  }
  return Json{{"schema", 1},
              {"by", by},
              {"conditions_differ", conditions},
              {"criteria", criteria},
              {"candidates", states.front()["candidates"]},
              {"states", states},
              {"parameters", ranking.directions > 0 ? Json{{"directions", ranking.directions},
                                                           {"skins", ranking.step_skins},
                                                           {"grid", ranking.step_grid}}
                                                    : Json(nullptr)},
              {"skins", ranking.skins},
              {"seconds", ranking.seconds}}
      .dump(2);
}

std::string ranked_design_file(std::size_t candidate, std::size_t region) {
  return region == 0 ? fmt::format("designs/{:02d}.toml", candidate + 1)
                     : fmt::format("designs/{:02d}_{}.toml", candidate + 1, region + 1);
}

std::string radar_svg(const std::vector<std::string>& names, const RankOptions& options,
                      const StateRanking& state) {
  static constexpr const char* kColours[] = {"#1b6ca8", "#d1495b", "#3c8d5a", "#8a5fbf",
                                             "#c98a1b", "#4a4a4a", "#2aa9a9", "#b0467d"};
  constexpr double kCentre = 260, kRadius = 180;
  const std::size_t axes = options.criteria.size();
  const auto point = [&](std::size_t axis, double share) {
    const double angle = 2 * kPi * static_cast<double>(axis) / static_cast<double>(axes) - kPi / 2;
    return fmt::format("{:.1f},{:.1f}", kCentre + kRadius * share * std::cos(angle),
                       kCentre + kRadius * share * std::sin(angle));
  };
  std::string out =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"760\" height=\"540\" "
      "font-family=\"sans-serif\" font-size=\"13\">\n<rect width=\"760\" height=\"540\" "
      "fill=\"white\"/>\n";
  for (double ring : {0.25, 0.5, 0.75, 1.0}) {
    out += "<polygon fill=\"none\" stroke=\"#cccccc\" points=\"";
    for (std::size_t a = 0; a < axes; ++a) out += point(a, ring) + " ";
    out += "\"/>\n";
  }
  for (std::size_t a = 0; a < axes; ++a) {
    const double angle = 2 * kPi * static_cast<double>(a) / static_cast<double>(axes) - kPi / 2;
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>\n",
                       kCentre + (kRadius + 26) * std::cos(angle),
                       kCentre + (kRadius + 26) * std::sin(angle), options.criteria[a].text());
  }
  // On each axis the best candidate reaches the rim; the others the ratio to it.
  for (std::size_t i = 0; i < state.candidates.size(); ++i) {
    const RankedCandidate& r = state.candidates[i];
    const char* colour = kColours[i % std::size(kColours)];
    out += fmt::format(
        "<polygon fill=\"{0}\" fill-opacity=\"0.12\" stroke=\"{0}\" stroke-width=\"2\" points=\"",
        colour);
    for (std::size_t a = 0; a < axes; ++a) {
      double low = kInfinity, high = -kInfinity;
      for (const RankedCandidate& other : state.candidates) {
        low = std::min(low, std::abs(other.metrics[a].value));
        high = std::max(high, std::abs(other.metrics[a].value));
      }
      const double v = std::abs(r.metrics[a].value);
      const double share =
          options.criteria[a].high ? (high > 0 ? v / high : 1) : (v > 0 ? low / v : 1);
      out += point(a, share) + " ";
    }
    out += "\"/>\n";
    out += fmt::format("<text x=\"500\" y=\"{}\" fill=\"{}\">{}. {}</text>\n",
                       60 + 22 * static_cast<int>(i), colour, r.rank, names[r.index]);
  }
  return out + "</svg>\n";
}

}  // namespace papilla
