#include "lab/standing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "base/constants.h"
#include "base/text.h"
#include "base/units.h"
#include "config/describe.h"
#include "numerics/statistics.h"
#include "optim/posterior.h"

namespace papilla::lab {
namespace {

constexpr double kLow = 0.025, kHigh = 0.975;  // of a 95 % interval

void set_members(const Belief& belief, Ensemble& e) {
  for (const BeliefMember& m : belief.members) {
    auto name = std::find(e.hypotheses.begin(), e.hypotheses.end(), m.hypothesis);
    if (name == e.hypotheses.end()) name = e.hypotheses.insert(name, m.hypothesis);
    e.hypothesis.push_back(static_cast<std::size_t>(name - e.hypotheses.begin()));
    e.weights.push_back(m.weight);
  }
}

// The members at which some design has a worth; all where nothing is decided.
std::vector<std::size_t> members_that_answer(const std::vector<MemberNumbers>& designs,
                                             std::size_t members) {
  std::vector<std::size_t> out;
  for (std::size_t m = 0; m < members; ++m) {
    const bool any = std::any_of(designs.begin(), designs.end(),
                                 [&](const MemberNumbers& d) { return !std::isnan(d.at[m]); });
    if (any || designs.empty()) out.push_back(m);
  }
  return out;
}

// Some members alone, without what designs are worth.
Ensemble of_members(const Ensemble& all, const std::vector<std::size_t>& members) {
  Ensemble out;
  double sum = 0;
  for (const std::size_t m : members) sum += all.weights[m];
  for (const std::size_t m : members) {
    out.weights.push_back(all.weights[m] / sum);
    out.hypothesis.push_back(all.hypothesis[m]);
  }
  out.hypotheses = all.hypotheses;
  for (const std::vector<double>& row : all.responses) {
    std::vector<double>& some = out.responses.emplace_back();
    for (const std::size_t m : members) some.push_back(row[m]);
  }
  out.response_sampling = all.response_sampling;
  return out;
}

// Of the members of `e`, which these are. Where a design is worth nothing at one it is worth what
// the least is, and keeps no limit.
void set_worth(const std::vector<MemberNumbers>& designs,
               const std::vector<std::vector<bool>>& kept, const std::vector<std::size_t>& members,
               Ensemble& e, DecisionLimits& limits) {
  for (std::size_t d = 0; d < designs.size(); ++d) {
    e.worth_sampling.push_back(designs[d].sampling);
    std::vector<double>& worth = e.worth.emplace_back();
    std::vector<bool>& keeps = limits.kept.emplace_back();
    for (const std::size_t m : members) {
      double least = std::nan("");
      for (const MemberNumbers& other : designs) least = std::fmin(least, other.at[m]);
      const bool has = !std::isnan(designs[d].at[m]);
      worth.push_back(has ? designs[d].at[m] : least);
      keeps.push_back(has && (kept.empty() || kept[d][m]));
    }
  }
}

class Places {
 public:
  Places(const std::vector<LabDesign>& designs) : designs_(designs) {}

  void take(const FrictionReading& r, bool on) {
    experiments_.push_back(r.experiment);
    on_.push_back(on);
  }

  std::vector<Somewhere> find() {
    each("of ", [&](std::size_t k) { return designs_[experiments_[k].design].name; });
    each("at ", [&](std::size_t k) {
      return significant(100 * experiments_[k].at.relative_humidity, 3) + " % RH";
    });
    each("at ", [&](std::size_t k) { return significant(experiments_[k].at.load, 3) + " N"; });
    each("with the finger ", [&](std::size_t k) {
      return finger_state_names()[static_cast<std::size_t>(experiments_[k].at.state)];
    });
    each("", [&](std::size_t k) { return on_[k] ? std::string("under voltage") : std::string(); });
    each("under voltage of ", [&](std::size_t k) {
      return on_[k] ? designs_[experiments_[k].design].name : std::string();
    });
    numbers();
    return std::move(places_);
  }

 private:
  // Readings that share a name; "": none. A name that all have is no place.
  void each(const std::string& before, const std::function<std::string(std::size_t)>& name) {
    std::map<std::string, std::vector<std::size_t>> groups;
    for (std::size_t k = 0; k < experiments_.size(); ++k) {
      const std::string is = name(k);
      if (!is.empty()) groups[is].push_back(k);
    }
    for (auto& [is, readings] : groups) add(before + is, std::move(readings));
  }

  void add(const std::string& name, std::vector<std::size_t> readings) {
    if (readings.empty() || readings.size() == experiments_.size()) return;
    const bool known = std::any_of(places_.begin(), places_.end(),
                                   [&](const Somewhere& s) { return s.readings == readings; });
    if (!known) places_.push_back({name, std::move(readings)});
  }

  // Designs above the middle of a number of the texture.
  void numbers() {
    std::map<std::string, std::map<std::size_t, double>> values;
    std::map<std::string, const char*> units;
    for (const Experiment& e : experiments_) {
      Design design = designs_[e.design].design;
      for (const NumberField& f : number_fields(design)) {
        if (!f.path.starts_with("texture.")) continue;
        values[f.path][e.design] = *f.value;
        units[f.path] = f.unit;
      }
    }
    for (const auto& [path, of_design] : values) {
      std::vector<double> sorted;
      for (const auto& [design, value] : of_design) sorted.push_back(value);
      std::sort(sorted.begin(), sorted.end());
      const std::size_t half = sorted.size() / 2;
      if (sorted.size() < 3 || sorted[half - 1] == sorted[half]) continue;
      const double edge = (sorted[half - 1] + sorted[half]) / 2;
      std::vector<std::size_t> above;
      for (std::size_t k = 0; k < experiments_.size(); ++k) {
        const auto value = of_design.find(experiments_[k].design);
        if (value != of_design.end() && value->second > edge) above.push_back(k);
      }
      const std::string unit = units[path];
      add(fmt::format("where {} is above {}{}{}", path,
                      significant(edge / find_unit(unit)->to_si, 3), unit.empty() ? "" : " ", unit),
          std::move(above));
    }
  }

  const std::vector<LabDesign>& designs_;
  std::vector<Experiment> experiments_;
  std::vector<bool> on_;
  std::vector<Somewhere> places_;
};

void decide(Standing& s) {
  const Standing::Deciding by = s.deciding();
  const WorthAfter after = worth_after(by.ensemble, by.kernels, by.evidence);
  const MemberWorth worth = decision_worth(after, s.limits);
  s.prospects = prospects(worth, s.risk);
  s.best = chosen(s.prospects, s.limits.wanted);
  s.best_worth = best_worth(worth);
  for (const std::vector<double>& of : after.worth) {
    std::vector<double> behind = after.worth[s.best];
    for (std::size_t k = 0; k < behind.size(); ++k) behind[k] -= of[k];
    const auto interval = [&](const std::vector<double>& values) {
      return Standing::Interval{weighted_quantile(values, after.weights, kLow),
                                weighted_quantile(values, after.weights, 0.5),
                                weighted_quantile(values, after.weights, kHigh),
                                weighted_mean(values, after.weights)};
    };
    s.worth.push_back(interval(of));
    s.behind.push_back(interval(behind));
  }
}

}  // namespace

std::optional<Aim> aim_at_limits(const Standing& s) {
  const double kept = s.prospects[s.best].p_limits;
  if (s.keeps_limits() || kept <= 1 - s.limits.wanted || s.limits.kept.empty()) return std::nullopt;
  const Ensemble& e = s.deciding().ensemble;
  const std::vector<double> weights = s.deciding().evidence.weights();
  const std::vector<double> of_hypothesis = weights_by_hypothesis(e, weights);
  std::vector<double> kept_of(of_hypothesis.size(), 0);
  for (std::size_t m = 0; m < weights.size(); ++m)
    kept_of[e.hypothesis[m]] += s.limits.kept[s.best][m] ? weights[m] : 0;
  double between = 0;  // variance between hypotheses of whether the limits are kept
  for (std::size_t h = 0; h < of_hypothesis.size(); ++h) {
    if (of_hypothesis[h] > 0)
      between += of_hypothesis[h] * square(kept_of[h] / of_hypothesis[h] - kept);
  }
  return between > kept * (1 - kept) / 2 ? Aim::Hypotheses : Aim::Parameters;
}

std::vector<Observation> observations_of(const ResponseTable& table, const Experiment& experiment,
                                         const Instrument& instrument, double off_share,
                                         double on_share, const std::string& finger,
                                         const std::string& day) {
  const MeasurableCell& cell = table.cell(experiment);
  std::vector<Observation> out;
  const auto add = [&](const std::optional<std::size_t>& row, double share) {
    if (!row || share < 0) return;
    out.push_back(
        {*row, std::hypot(instrument.repeatability, share), experiment.design, finger, day});
  };
  add(cell.off, off_share);
  add(cell.on, on_share);
  return out;
}

std::unique_ptr<Standing> standing_of(const Belief& belief, const LabFile& file,
                                      const std::vector<LabDesign>& designs,
                                      const ResponseTable& table,
                                      const std::vector<FrictionReading>& readings,
                                      const std::vector<MemberNumbers>& worth,
                                      const std::vector<std::vector<bool>>& kept) {
  auto out = std::make_unique<Standing>();
  Standing& s = *out;
  set_members(belief, s.ensemble);
  s.ensemble.responses = table.responses();
  s.ensemble.response_sampling = table.sampling();
  s.limits.wanted = file.limits;
  s.risk = parse_belief_risk(file.risk);
  const std::vector<std::size_t> answer = members_that_answer(worth, s.ensemble.members());
  const bool all_answer = answer.size() == s.ensemble.members();
  if (all_answer) set_worth(worth, kept, answer, s.ensemble, s.limits);
  for (std::size_t d = 0; d < designs.size(); ++d) {
    if (designs[d].choice) s.choices.push_back(d);
  }
  s.kernels = kernels_of(s.ensemble);
  s.gauge = gauge_of(readings);
  s.instrument = after_gauge(file.instrument, s.gauge);
  s.evidence = std::make_unique<Evidence>(s.ensemble, s.kernels, s.instrument);
  if (!all_answer && !answer.empty()) {
    s.answering = std::make_unique<Standing::Answering>();
    Standing::Answering& some = *s.answering;
    some.ensemble = of_members(s.ensemble, answer);
    set_worth(worth, kept, answer, some.ensemble, s.limits);
    some.kernels = kernels_of(some.ensemble);
    some.evidence = std::make_unique<Evidence>(some.ensemble, some.kernels, s.instrument);
  }
  Places places(designs);
  for (const FrictionReading& r : readings) {
    const double off = r.off > 0 ? r.off_sd / r.off : -1, on = r.on > 0 ? r.on_sd / r.on : -1;
    const MeasurableCell& cell = table.cell(r.experiment);
    for (const Observation& o :
         observations_of(table, r.experiment, s.instrument, off, on, r.finger, r.day)) {
      const bool is_on = cell.on && o.row == *cell.on;
      s.evidence->add(o, std::log(is_on ? r.on : r.off));
      if (s.answering) s.answering->evidence->add(o, std::log(is_on ? r.on : r.off));
      places.take(r, is_on);
    }
  }
  s.weights = s.evidence->weights();
  if (!all_answer) {
    s.unanswered = 1;
    for (const std::size_t m : answer) s.unanswered -= s.weights[m];
    s.unanswered = std::max(0.0, s.unanswered);
  }
  s.p_hypothesis = weights_by_hypothesis(s.ensemble, s.weights);
  s.effective_members = effective_number(s.weights);
  s.discrepancies =
      discrepancies(s.ensemble, *s.evidence, places.find(), std::log1p(file.discrepancy));
  if (s.deciding().ensemble.worth.size() > 1) decide(s);
  return out;
}

}  // namespace papilla::lab
