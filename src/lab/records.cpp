#include "lab/records.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace papilla::lab {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Experiment& e) {
  return {{"design", e.design},
          {"load", e.at.load},
          {"humidity", e.at.relative_humidity},
          {"voltage", e.at.voltage},
          {"frequency", e.at.frequency},
          {"state", finger_state_names()[static_cast<std::size_t>(e.at.state)]}};
}

// The one of these names that stands there.
template <class Named>
Named named(const Json& j, const std::vector<std::string>& names, const char* none) {
  const auto found = std::find(names.begin(), names.end(), j.get<std::string>());
  if (found == names.end()) throw InputError(none);
  return static_cast<Named>(found - names.begin());
}

Experiment experiment_of(const Json& j) {
  Experiment e;
  e.design = j.at("design");
  e.at.load = j.at("load");
  e.at.relative_humidity = j.at("humidity");
  e.at.voltage = j.at("voltage");
  e.at.frequency = j.at("frequency");
  e.at.state = named<FingerState>(j.at("state"), finger_state_names(), "a state that is none");
  return e;
}

Json json_of(const std::vector<Foreseen>& thirds) {
  Json out = Json::array();
  for (const Foreseen& o : thirds)
    out.push_back({{"low", o.low},
                   {"high", o.high},
                   {"choice", o.choice},
                   {"p_choice", o.p_choice},
                   {"p_hypothesis", o.p_hypothesis},
                   {"design", o.design}});
  return out;
}

std::vector<Foreseen> outcomes_of(const Json& j) {
  std::vector<Foreseen> out;
  for (const Json& o : j)
    out.push_back({o.at("low"), o.at("high"), o.at("choice"), o.at("p_choice"),
                   o.at("p_hypothesis").get<std::vector<double>>(),
                   o.value("design", std::string())});
  return out;
}

Json json_of(const PlannedExperiment& p) {
  return {{"id", p.id},
          {"field", p.field},
          {"experiment", json_of(p.experiment)},
          {"repeats", p.repeats},
          {"gain", p.gain},
          {"off", json_of(p.off)},
          {"on", json_of(p.on)},
          {"expected_off", p.expected_off},
          {"expected_on", p.expected_on}};
}

Json json_of(const PlanRecord& p) {
  Json out{{"date", p.date},
           {"aim", aim_names()[static_cast<std::size_t>(p.aim)]},
           {"experiments", Json::array()},
           {"seconds", p.seconds},
           {"regret_now", p.regret_now},
           {"regret_after", p.regret_after},
           {"p_change", p.p_change},
           {"stop", p.stop}};
  if (p.stop_reason)
    out["stop_reason"] = stop_reason_names()[static_cast<std::size_t>(*p.stop_reason)];
  if (p.ended) out["ended"] = batch_end_names()[static_cast<std::size_t>(*p.ended)];
  if (p.shortest > 0) out["shortest"] = p.shortest;
  for (const PlannedExperiment& e : p.experiments) out["experiments"].push_back(json_of(e));
  return out;
}

PlanRecord plan_of(const Json& j) {
  PlanRecord p;
  p.date = j.at("date");
  p.aim = named<Aim>(j.at("aim"), aim_names(), "an aim that is none");
  p.seconds = j.at("seconds");
  p.regret_now = j.at("regret_now");
  p.regret_after = j.at("regret_after");
  p.p_change = j.at("p_change");
  p.stop = j.at("stop");
  if (j.contains("stop_reason"))
    p.stop_reason = named<StopReason>(j.at("stop_reason"), stop_reason_names(),
                                      "a reason to stop that is none");
  if (j.contains("ended"))
    p.ended = named<BatchEnd>(j.at("ended"), batch_end_names(), "an end of a batch that is none");
  p.shortest = j.value("shortest", 0.0);
  for (const Json& e : j.at("experiments"))
    p.experiments.push_back({e.at("id"), e.at("field"), experiment_of(e.at("experiment")),
                             e.at("repeats"), e.at("gain"), outcomes_of(e.at("off")),
                             outcomes_of(e.at("on")),
                             e.at("expected_off").get<std::vector<double>>(),
                             e.at("expected_on").get<std::vector<double>>()});
  return p;
}

Json json_of(const TellRecord& t) {
  Json out{{"date", t.date},   {"file", t.file},   {"sha256", t.sha256},
           {"trace", t.trace}, {"notes", t.notes}, {"readings", Json::array()}};
  for (const FrictionReading& r : t.readings)
    out["readings"].push_back({{"experiment", json_of(r.experiment)},
                               {"id", r.id},
                               {"field", r.field},
                               {"finger", r.finger},
                               {"day", r.day},
                               {"repeat", r.repeat},
                               {"off", r.off},
                               {"off_sd", r.off_sd},
                               {"on", r.on},
                               {"on_sd", r.on_sd},
                               {"line", r.line},
                               {"key", r.key}});
  if (!t.replaced.empty()) out["replaced"] = t.replaced;
  return out;
}

TellRecord tell_of(const Json& j) {
  TellRecord t{j.at("date"), j.at("file"), j.at("sha256"), j.at("trace"), {}, j.at("notes")};
  t.replaced = j.value("replaced", t.replaced);
  for (const Json& r : j.at("readings")) {
    FrictionReading one{experiment_of(r.at("experiment")),
                        r.at("id"),
                        r.at("field"),
                        r.at("finger"),
                        r.at("day"),
                        r.at("repeat"),
                        r.at("off"),
                        r.at("off_sd"),
                        r.at("on"),
                        r.at("on_sd"),
                        r.at("line"),
                        r.at("key"),
                        {}};
    t.readings.push_back(std::move(one));
  }
  return t;
}

Json json_of(const DecisionRecord& d) {
  return {{"date", d.date},
          {"readings", d.readings},
          {"best", d.best},
          {"p_best", d.p_best},
          {"regret", d.regret},
          {"p_designs", d.p_designs},
          {"p_hypothesis", d.p_hypothesis},
          {"effective_members", d.effective_members},
          {"explained", d.explained},
          {"discrepancy", d.discrepancy},
          {"designs", d.designs}};
}

DecisionRecord decision_of(const Json& j) {
  return {j.at("date"),
          j.at("readings"),
          j.at("best"),
          j.at("p_best"),
          j.at("regret"),
          j.at("p_designs").get<std::vector<double>>(),
          j.at("p_hypothesis").get<std::vector<double>>(),
          j.at("effective_members"),
          j.at("explained"),
          j.at("discrepancy"),
          j.value("designs", std::vector<std::string>())};
}

}  // namespace

const std::vector<std::string>& stop_reason_names() {
  static const std::vector<std::string> names{"regret", "no change"};
  return names;
}

std::string entry_text(const JournalEntry& entry) {
  Json out = Json::object();
  if (entry.plan) out["plan"] = json_of(*entry.plan);
  if (entry.tell) out["tell"] = json_of(*entry.tell);
  if (entry.decision) out["decision"] = json_of(*entry.decision);
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

JournalEntry read_entry(const std::string& text) {
  JournalEntry out;
  try {
    const Json j = Json::parse(text);
    if (j.contains("plan")) out.plan = plan_of(j.at("plan"));
    if (j.contains("tell")) out.tell = tell_of(j.at("tell"));
    if (j.contains("decision")) out.decision = decision_of(j.at("decision"));
  } catch (const Json::exception&) {
    throw InputError("a record of the journal that this program has not written");
  }
  return out;
}

}  // namespace papilla::lab
