// A lab as JSON. Declared in report/lab_words.h.
#include <nlohmann/json.hpp>

#include "report/json.h"
#include "report/lab_words.h"

namespace papilla::report {
namespace {

using LabJson = nlohmann::ordered_json;

LabJson conditions_json(const Conditions& at) {
  return {{"load", at.load},
          {"relative_humidity", at.relative_humidity},
          {"voltage", at.voltage},
          {"frequency", at.frequency},
          {"state", finger_state_names()[static_cast<std::size_t>(at.state)]}};
}

LabJson outcomes_json(const std::vector<Foreseen>& thirds) {
  LabJson out = LabJson::array();
  for (const Foreseen& o : thirds)
    out.push_back({{"low", json_number(o.low)},
                   {"high", json_number(o.high)},
                   {"choice", o.design.empty() ? LabJson(nullptr) : LabJson(o.design)},
                   {"p_choice", json_number(o.p_choice)},
                   {"p_hypothesis", o.p_hypothesis}});
  return out;
}

LabJson standing_json(Lab& lab) {
  const Standing& s = lab.standing();
  const auto name = [&](std::size_t choice) { return lab.designs()[s.choices[choice]].name; };
  const double sign = worth_sign(lab.file(), s);
  LabJson designs = LabJson::array(), hypotheses = LabJson::object(), found = LabJson::array();
  for (std::size_t i = 0; i < s.prospects.size(); ++i) {
    const Standing::Interval worth = s.worth[i].times(sign);
    designs.push_back({{"name", name(i)},
                       {"p_best", json_number(s.prospects[i].p_best)},
                       {"regret", json_number(s.prospects[i].regret)},
                       {"p_every_limit", json_number(s.prospects[i].p_limits)},
                       {"worth", json_number(worth.median)},
                       {"worth_mean", json_number(worth.mean)},
                       {"worth_low", json_number(worth.low)},
                       {"worth_high", json_number(worth.high)}});
  }
  for (std::size_t h = 0; h < s.p_hypothesis.size(); ++h)
    hypotheses[s.ensemble.hypotheses[h]] = json_number(s.p_hypothesis[h]);
  for (const Discrepancy& d : s.discrepancies.found)
    found.push_back({{"where", d.where},
                     {"probability", json_number(d.probability)},
                     {"shift", json_number(d.change())},
                     {"deviation", json_number(d.change_deviation())}});
  return {{"readings", lab.readings().size()},
          {"worth", lab.file().worth},
          {"best", s.decided() ? LabJson(name(s.best)) : LabJson(nullptr)},
          {"best_worth", json_number(sign * s.best_worth)},
          {"unanswered", json_number(s.unanswered)},
          {"risk", lab.file().risk},
          {"limits_wanted", json_number(s.limits.wanted)},
          {"keeps_limits", s.decided() ? LabJson(s.keeps_limits()) : LabJson(nullptr)},
          {"designs", std::move(designs)},
          {"hypotheses", std::move(hypotheses)},
          {"effective_members", json_number(s.effective_members)},
          {"refit", s.effective_members < kFewMembers},
          {"explained", json_number(s.discrepancies.none)},
          {"discrepancies", std::move(found)}};
}

LabJson plan_json(const Lab& lab, const PlanRecord& plan) {
  LabJson experiments = LabJson::array();
  for (const PlannedExperiment& e : plan.experiments)
    experiments.push_back({{"id", e.id},
                           {"field", e.field},
                           {"design", lab.designs()[e.experiment.design].name},
                           {"conditions", conditions_json(e.experiment.at)},
                           {"repeats", e.repeats},
                           {"gain", json_number(e.gain)},
                           {"F_off", e.expected_off},
                           {"F_on", e.expected_on},
                           {"outcomes_off", outcomes_json(e.off)},
                           {"outcomes_on", outcomes_json(e.on)}});
  return {
      {"date", plan.date},
      {"for", aim_names()[static_cast<std::size_t>(plan.aim)]},
      {"seconds", plan.seconds},
      {"regret_now", json_number(plan.regret_now)},
      {"regret_after", json_number(plan.regret_after)},
      {"p_change", json_number(plan.p_change)},
      {"stop", plan.stop},
      {"stop_reason",
       plan.stop_reason ? LabJson(stop_reason_names()[static_cast<std::size_t>(*plan.stop_reason)])
                        : LabJson(nullptr)},
      {"ended", plan.ended ? LabJson(batch_end_names()[static_cast<std::size_t>(*plan.ended)])
                           : LabJson(nullptr)},
      {"experiments", std::move(experiments)}};
}

LabJson decision_record_json(const DecisionRecord& d) {
  return {{"date", d.date},
          {"readings", d.readings},
          {"best", d.best.empty() ? LabJson(nullptr) : LabJson(d.best)},
          {"p_best", json_number(d.p_best)},
          {"regret", json_number(d.regret)},
          {"designs", d.designs},
          {"p_designs", d.p_designs},
          {"p_hypothesis", d.p_hypothesis},
          {"effective_members", json_number(d.effective_members)},
          {"explained", json_number(d.explained)},
          {"discrepancy", d.discrepancy}};
}

LabJson tell_json(const Lab& lab, const TellRecord& record) {
  LabJson readings = LabJson::array();
  for (const FrictionReading& r : record.readings) {
    const auto force = [](double f) { return f > 0 ? LabJson(f) : LabJson(nullptr); };
    readings.push_back({{"experiment", r.id},
                        {"field", r.field},
                        {"design", lab.designs()[r.experiment.design].name},
                        {"conditions", conditions_json(r.experiment.at)},
                        {"finger", r.finger},
                        {"day", r.day},
                        {"repeat", r.repeat},
                        {"F_off", force(r.off)},
                        {"F_off_sd", force(r.off_sd)},
                        {"F_on", force(r.on)},
                        {"F_on_sd", force(r.on_sd)}});
  }
  return {{"date", record.date},   {"file", record.file},   {"sha256", record.sha256},
          {"trace", record.trace}, {"notes", record.notes}, {"readings", std::move(readings)}};
}

std::string dumped(const LabJson& json) {
  return json.dump(1, ' ', false, LabJson::error_handler_t::replace);
}

}  // namespace

std::string lab_plan_json(Lab& lab, const PlanRecord& plan) {
  return dumped({{"schema", 1}, {"plan", plan_json(lab, plan)}, {"standing", standing_json(lab)}});
}

std::string lab_told_json(const Lab& lab, const Told& told) {
  LabJson out{{"schema", 1},
              {"told", tell_json(lab, told.record)},
              {"already", told.already},
              {"already_of", told.already_of},
              {"fitted", told.fitted},
              {"empty", told.empty},
              {"before", nullptr},
              {"after", nullptr}};
  if (told.before) out["before"] = decision_record_json(*told.before);
  if (told.after) out["after"] = decision_record_json(*told.after);
  return dumped(out);
}

std::string lab_state_json(Lab& lab) {
  LabJson plans = LabJson::array(), told = LabJson::array(), decisions = LabJson::array();
  std::string why;  // the newest plan
  for (const JournalEntry& e : lab.entries()) {
    if (e.plan) {
      plans.push_back(plan_json(lab, *e.plan));
      why = e.plan->experiments.empty() ? "" : lab_plan_reason(lab, *e.plan);
    }
    if (e.tell) told.push_back(tell_json(lab, *e.tell));
    if (e.decision) decisions.push_back(decision_record_json(*e.decision));
  }
  return dumped({{"schema", 1},
                 {"source", lab.file().source},
                 {"standing", standing_json(lab)},
                 {"summary", lab_summary_text(lab)},
                 {"plans", std::move(plans)},
                 {"why", why},
                 {"told", std::move(told)},
                 {"decisions", std::move(decisions)}});
}

}  // namespace papilla::report
