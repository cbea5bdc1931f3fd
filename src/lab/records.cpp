#include "lab/records.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>

#include "base/error.h"

namespace papilla::lab {
namespace {

using Json = nlohmann::ordered_json;

using Names = std::vector<std::string>;  // of the lab's designs

Json json_of(const Experiment& e, const Names& designs) {
  return {{"design", designs.at(e.design)},
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

[[noreturn]] void refuse_list(const std::string& message) {
  throw InputError({Problem{"lab.toml", 0, 0, "design", message}});
}

[[noreturn]] void refuse_places() {
  refuse_list(
      "the list is another one than when its designs were planned and measured, and an older "
      "program has told them apart by their places: put back what was taken off, under its name "
      "and in its place; choice = false leaves a design out of the decision");
}

const std::string& name_at(std::size_t place, const Names& designs) {
  if (place >= designs.size()) refuse_places();
  return designs[place];
}

std::size_t place_of(const std::string& name, const Names& designs) {
  const auto found = std::find(designs.begin(), designs.end(), name);
  if (found == designs.end())
    refuse_list(fmt::format(
        "\"{}\" was planned or measured and is not in the list any more: put it back under its "
        "name; choice = false leaves it out of the decision",
        name));
  return static_cast<std::size_t>(found - designs.begin());
}

std::size_t design_of(const Json& j, const Names& designs) {
  if (!j.is_number_unsigned()) return place_of(j.get<std::string>(), designs);
  const auto place = j.get<std::size_t>();
  name_at(place, designs);
  return place;
}

// That of an older program begins with the place of the design.
std::string key_of_name(const std::string& key, const Names& designs) {
  std::size_t place = 0;
  const char* const end = key.data() + key.size();
  const auto [rest, error] = std::from_chars(key.data(), end, place);
  if (error != std::errc()) return key;
  return fmt::format("\"{}\"{}", name_at(place, designs), std::string(rest, end));
}

Experiment experiment_of(const Json& j, const Names& designs) {
  Experiment e;
  e.design = design_of(j.at("design"), designs);
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

Json json_of(const PlannedExperiment& p, const Names& designs) {
  return {{"id", p.id},
          {"field", p.field},
          {"experiment", json_of(p.experiment, designs)},
          {"repeats", p.repeats},
          {"gain", p.gain},
          {"off", json_of(p.off)},
          {"on", json_of(p.on)},
          {"expected_off", p.expected_off},
          {"expected_on", p.expected_on}};
}

Json json_of(const PlanRecord& p, const Names& designs) {
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
  if (p.best_worth != 0) out["best_worth"] = p.best_worth;
  for (const PlannedExperiment& e : p.experiments)
    out["experiments"].push_back(json_of(e, designs));
  return out;
}

PlanRecord plan_of(const Json& j, const Names& designs) {
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
  p.best_worth = j.value("best_worth", 0.0);
  for (const Json& e : j.at("experiments"))
    p.experiments.push_back({e.at("id"), e.at("field"), experiment_of(e.at("experiment"), designs),
                             e.at("repeats"), e.at("gain"), outcomes_of(e.at("off")),
                             outcomes_of(e.at("on")),
                             e.at("expected_off").get<std::vector<double>>(),
                             e.at("expected_on").get<std::vector<double>>()});
  return p;
}

Json json_of(const TellRecord& t, const Names& designs) {
  Json out{{"date", t.date},   {"file", t.file},   {"sha256", t.sha256},
           {"trace", t.trace}, {"notes", t.notes}, {"readings", Json::array()}};
  for (const FrictionReading& r : t.readings)
    out["readings"].push_back({{"experiment", json_of(r.experiment, designs)},
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

TellRecord tell_of(const Json& j, const Names& designs) {
  TellRecord t{j.at("date"), j.at("file"), j.at("sha256"), j.at("trace"), {}, j.at("notes")};
  for (const std::string& key : j.value("replaced", t.replaced))
    t.replaced.push_back(key_of_name(key, designs));
  for (const Json& r : j.at("readings")) {
    FrictionReading one{experiment_of(r.at("experiment"), designs),
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
                        key_of_name(r.at("key").get<std::string>(), designs),
                        {}};
    t.readings.push_back(std::move(one));
  }
  return t;
}

// Whether a record has its designs by their places.
bool by_places(const Json& entry) {
  const auto first_of = [&](const char* record, const char* list) {
    if (!entry.contains(record) || entry.at(record).at(list).empty()) return false;
    return entry.at(record).at(list).at(0).at("experiment").at("design").is_number();
  };
  return first_of("plan", "experiments") || first_of("tell", "readings");
}

// The places of then are those of now only where the choices of then, whose names are known, still
// stand in their order.
void check_places(const DecisionRecord& d, const Names& designs) {
  auto from = designs.begin();
  for (const std::string& name : d.designs) {
    from = std::find(from, designs.end(), name);
    if (from == designs.end()) refuse_places();
    ++from;
  }
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

std::string entry_text(const JournalEntry& entry, const std::vector<std::string>& designs) {
  Json out = Json::object();
  if (entry.plan) out["plan"] = json_of(*entry.plan, designs);
  if (entry.tell) out["tell"] = json_of(*entry.tell, designs);
  if (entry.decision) out["decision"] = json_of(*entry.decision);
  return out.dump(-1, ' ', false, Json::error_handler_t::replace);
}

JournalEntry read_entry(const std::string& text, const std::vector<std::string>& designs) {
  JournalEntry out;
  try {
    const Json j = Json::parse(text);
    if (j.contains("plan")) out.plan = plan_of(j.at("plan"), designs);
    if (j.contains("tell")) out.tell = tell_of(j.at("tell"), designs);
    if (j.contains("decision")) out.decision = decision_of(j.at("decision"));
    if (out.decision && by_places(j)) check_places(*out.decision, designs);
  } catch (const Json::exception&) {
    throw InputError("a record of the journal that this program has not written");
  }
  return out;
}

}  // namespace papilla::lab
