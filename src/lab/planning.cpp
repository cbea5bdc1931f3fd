#include "lab/planning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"

namespace papilla::lab {
namespace {

// Futures that the value of a candidate is taken over: a share of 1 % is then seen by 4 of them.
constexpr int kDraws = 384;
// Readings that change the choice with less than this probability are said not to change it.
constexpr double kNoChange = 0.05;
// That is judged by as many touches as this, also where the user asked for a smaller batch.
constexpr std::size_t kJudgedBy = 10;

std::vector<Candidate> candidates_of(const Standing& s, const ResponseTable& table,
                                     const std::vector<Experiment>& experiments,
                                     const NextOptions& options) {
  std::vector<Candidate> out;
  const std::string day = options.day.empty() ? options.date : options.day;
  for (const Experiment& e : experiments) {
    // With a voltage friction is read off and on: where a member has no friction under it, for
    // example because its film breaks down, the reading cannot be compared with that member.
    if (e.at.driven() && !table.cell(e).on) continue;
    Candidate c{e, observations_of(table, e, s.instrument, 0, 0, options.finger, day)};
    if (!c.readings.empty()) out.push_back(std::move(c));
  }
  if (out.empty())
    throw InputError(
        "no experiment can be compared with every member of the belief: under each of the "
        "conditions of lab.toml some member has no friction, for example because its film does not "
        "withstand the voltage");
  return out;
}

Aim aim_of(const Standing& s, const NextOptions& options) {
  if (options.aim == Aim::Decision && !s.decided())
    throw InputError(
        "--for decision: nothing is decided in this lab: `worth` is empty in lab.toml, only one "
        "design can be chosen, or no design has a value at any member of the belief");
  if (options.aim == Aim::Hypotheses && s.ensemble.hypotheses.size() < 2)
    throw InputError("--for hypotheses: the belief has one hypothesis");
  if (options.aim) return *options.aim;
  if (s.decided()) return Aim::Decision;
  return s.ensemble.hypotheses.size() > 1 ? Aim::Hypotheses : Aim::Parameters;
}

// Median and 95 % of what belief expects of a reading [N].
std::vector<double> expected(const Evidence& evidence, const Observation& reading) {
  const ExpectedReading of = evidence.expected(reading);
  std::vector<double> out;
  for (const double p : {0.5, 0.025, 0.975}) out.push_back(std::exp(of.quantile(p)));
  return out;
}

// What each reading of the batch would change, at the first touch of each experiment.
void add_outcomes(const Standing& s, const LabFile& file, const std::vector<Candidate>& candidates,
                  const std::vector<Chosen>& batch, const DecisionGain& gain,
                  const ResponseTable& table, std::vector<PlannedExperiment>& plan) {
  const auto outcomes = gain.outcomes();
  std::size_t k = 0;
  for (const Chosen& c : batch) {
    const Candidate& candidate = candidates[c.candidate];
    const auto planned = std::find_if(plan.begin(), plan.end(), [&](const PlannedExperiment& p) {
      return p.experiment == candidate.experiment;
    });
    for (const Observation& o : candidate.readings) {
      const MeasurableCell& cell = table.cell(candidate.experiment);
      auto& thirds = cell.on && o.row == *cell.on ? planned->on : planned->off;
      if (thirds.empty()) {
        thirds = outcomes[k];
        for (Foreseen& third : thirds) third.design = file.designs[s.choices[third.choice]].name;
      }
      ++k;
    }
  }
}

std::vector<PlannedExperiment> planned_of(const Standing& s, const ResponseTable& table,
                                          const std::vector<Candidate>& candidates,
                                          const std::vector<Chosen>& batch, const LabFile& file,
                                          std::size_t numbered) {
  std::vector<PlannedExperiment> out;
  for (const Chosen& c : batch) {
    const Experiment& e = candidates[c.candidate].experiment;
    const auto known = std::find_if(out.begin(), out.end(),
                                    [&](const PlannedExperiment& p) { return p.experiment == e; });
    if (known != out.end()) {
      ++known->repeats;
      known->gain += c.gain;
      continue;
    }
    PlannedExperiment p;
    p.id = fmt::format("E{:02}", numbered + out.size() + 1);
    p.experiment = e;
    p.gain = c.gain;
    const MeasurableCell& cell = table.cell(e);
    for (const Observation& o : candidates[c.candidate].readings) {
      const bool on = cell.on && o.row == *cell.on;
      (on ? p.expected_on : p.expected_off) = expected(*s.evidence, o);
    }
    for (const FieldEntry& f : file.fields) {
      const Conditions at{f.load, f.humidity, f.voltage, f.voltage > 0 ? f.frequency : 0, f.state};
      if (at == e.at && file.designs[e.design].name == f.design && p.field.empty())
        p.field = f.field;
    }
    out.push_back(std::move(p));
  }
  return out;
}

}  // namespace

std::optional<StopReason> reason_to_stop(const std::vector<Candidate>& candidates,
                                         const Batch& batch, const Costs& costs, double small,
                                         DecisionGain& gain) {
  if (gain.regret_now() < small) return StopReason::Regret;
  const auto changes_nothing = [&] {
    return gain.p_change() < kNoChange && gain.regret_now() - gain.regret_after() < small;
  };
  const std::size_t count = batch.chosen.size();
  if (changes_nothing() && batch.end != BatchEnd::Nothing && count < kJudgedBy)
    choose_batch(candidates, gain, {static_cast<int>(kJudgedBy - count), 0, costs, 0});
  if (changes_nothing()) return StopReason::NoChange;
  return std::nullopt;
}

PlanRecord plan_batch(const Standing& s, const ResponseTable& table,
                      const std::vector<Experiment>& experiments, const LabFile& file,
                      const NextOptions& options, std::size_t numbered) {
  PlanRecord plan;
  plan.date = options.date;
  plan.aim = aim_of(s, options);
  const std::vector<Candidate> candidates = candidates_of(s, table, experiments, options);
  std::unique_ptr<Gain> gain;
  DecisionGain* decision = nullptr;
  if (plan.aim == Aim::Decision) {
    const Standing::Deciding by = s.deciding();
    auto own =
        std::make_unique<DecisionGain>(by.ensemble, by.kernels, by.evidence, s.limits, kDraws);
    decision = own.get();
    gain = std::move(own);
  } else if (plan.aim == Aim::Hypotheses) {
    gain = hypotheses_gain(s.ensemble, *s.evidence, s.instrument);
  } else {
    gain = parameters_gain(s.ensemble, *s.evidence, s.instrument);
  }
  const Batch batch =
      choose_batch(candidates, *gain, {options.count, options.seconds, file.costs, 0});
  plan.ended = batch.end;
  plan.shortest = batch.shortest;
  plan.experiments = planned_of(s, table, candidates, batch.chosen, file, numbered);
  for (const Chosen& c : batch.chosen) plan.seconds += c.seconds;
  if (!decision) return plan;
  // What is said of the batch comes first: reason_to_stop takes further touches into the gain.
  plan.regret_now = decision->regret_now();
  plan.regret_after = decision->regret_after();
  plan.best_worth = s.best_worth;
  plan.p_change = decision->p_change();
  add_outcomes(s, file, candidates, batch.chosen, *decision, table, plan.experiments);
  plan.stop_reason =
      reason_to_stop(candidates, batch, file.costs, file.stop * std::abs(s.best_worth), *decision);
  plan.stop = plan.stop_reason.has_value();
  return plan;
}

}  // namespace papilla::lab
