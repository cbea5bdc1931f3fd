#include "lab/standing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

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

// Where a design is worth nothing at a member it is worth what the least is, and keeps no limit.
void set_worth(const std::vector<MemberNumbers>& designs,
               const std::vector<std::vector<bool>>& kept, double wanted, Standing& out) {
  std::vector<std::vector<double>> worth;
  for (const MemberNumbers& d : designs) {
    worth.push_back(d.at);
    out.ensemble.worth_sampling.push_back(d.sampling);
  }
  out.ensemble.worth = worth;
  out.limits.wanted = wanted;
  out.limits.kept = kept;
  if (kept.empty()) {
    for (const std::vector<double>& row : worth) out.limits.kept.emplace_back(row.size(), true);
  }
  for (std::size_t m = 0; !worth.empty() && m < worth.front().size(); ++m) {
    double least = std::nan("");
    for (const std::vector<double>& row : worth) least = std::fmin(least, row[m]);
    for (std::size_t d = 0; d < worth.size(); ++d) {
      if (!std::isnan(worth[d][m])) continue;
      out.ensemble.worth[d][m] = std::isnan(least) ? 0 : least;
      out.limits.kept[d][m] = false;
    }
  }
}

// Of a number of the readings' designs or conditions: those above its middle.
using NumberOf = std::function<double(const Experiment&)>;

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
  const WorthAfter after = worth_after(s.ensemble, s.kernels, *s.evidence);
  const MemberWorth worth = decision_worth(after, s.limits);
  s.prospects = prospects(worth, {});
  s.best = chosen(s.prospects, s.limits.wanted);
  s.best_worth = best_worth(worth);
  for (const std::vector<double>& of : after.worth) {
    std::vector<double> behind = after.worth[s.best];
    for (std::size_t k = 0; k < behind.size(); ++k) behind[k] -= of[k];
    const auto interval = [&](const std::vector<double>& values) {
      return Standing::Interval{weighted_quantile(values, after.weights, kLow),
                                weighted_quantile(values, after.weights, 0.5),
                                weighted_quantile(values, after.weights, kHigh)};
    };
    s.worth.push_back(interval(of));
    s.behind.push_back(interval(behind));
  }
}

}  // namespace

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
  set_worth(worth, kept, file.limits, s);
  for (std::size_t d = 0; d < designs.size(); ++d) {
    if (designs[d].choice) s.choices.push_back(d);
  }
  s.kernels = kernels_of(s.ensemble);
  s.gauge = gauge_of(readings);
  s.instrument = after_gauge(file.instrument, s.gauge);
  s.evidence = std::make_unique<Evidence>(s.ensemble, s.kernels, s.instrument);
  Places places(designs);
  for (const FrictionReading& r : readings) {
    const double off = r.off > 0 ? r.off_sd / r.off : -1, on = r.on > 0 ? r.on_sd / r.on : -1;
    const MeasurableCell& cell = table.cell(r.experiment);
    for (const Observation& o :
         observations_of(table, r.experiment, s.instrument, off, on, r.finger, r.day)) {
      const bool is_on = cell.on && o.row == *cell.on;
      s.evidence->add(o, std::log(is_on ? r.on : r.off));
      places.take(r, is_on);
    }
  }
  s.weights = s.evidence->weights();
  s.p_hypothesis = weights_by_hypothesis(s.ensemble, s.weights);
  s.effective_members = effective_number(s.weights);
  s.discrepancies =
      discrepancies(s.ensemble, *s.evidence, places.find(), std::log1p(file.discrepancy));
  if (s.ensemble.worth.size() > 1) decide(s);
  return out;
}

}  // namespace papilla::lab
