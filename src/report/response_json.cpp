// A Response for programs.
#include <cmath>
#include <nlohmann/json.hpp>

#include "metrics/metrics.h"
#include "report/json.h"
#include "report/response.h"

namespace papilla::report {

bool exists(api::FingerDrive drive, const ResponsePoint& p, bool driven) {
  switch (drive) {
    case api::FingerDrive::Any:
      return true;
    case api::FingerDrive::Off:
      return p.knows_undriven();
    case api::FingerDrive::On:
      return driven && p.knows_driven();
    case api::FingerDrive::OnElseZero:
      return !driven || p.knows_driven();
  }
  return false;
}

namespace {

using Json = nlohmann::ordered_json;

// Error by origin; null where it was not measured.
Json with_parts(double value, double se, const ErrorParts& parts) {
  Json list{{"sampling", json_number(parts.sampling)}};
  for (const ErrorOrigin& origin : kErrorOrigins) {
    list[origin.name] = json_number(parts.*origin.part);
  }
  return {{"value", json_number(value)},
          {"se", json_number(se)},
          {"numerical", json_number(parts.numerical())},
          {"model", json_number(parts.model_part())},
          {"parts", list}};
}

Json measured(const Measured& m) { return with_parts(m.value, m.se(), m.parts); }

// The same with what each member of belief says, in the order of `belief.members`.
Json with_members(Json number, const std::optional<BeliefValues>& over) {
  if (!over) return number;
  Json values = Json::array();
  for (const double v : over->values) values.push_back(json_number(v));
  number["model_median"] = json_number(over->quantile(0.5));
  number["model_interval"] = {json_number(over->quantile(0.025)),
                              json_number(over->quantile(0.975))};
  number["members"] = std::move(values);
  return number;
}

// Null where a humidity has no number for it.
Json summarised(Summary kind, const Metric& metric, const Response& response) {
  if (!is_known(metric, response)) return nullptr;
  const auto value = summarise(kind, metric, response);
  if (!value) return nullptr;
  return with_members(with_parts(value->value, value->se, value->parts),
                      belief_values(kind, metric, response));
}

Json summary_json(const Response& response) {
  Json out = Json::object();
  const std::array<std::pair<const char*, Summary>, 5> kinds{{{"mean_modulation", Summary::Mean},
                                                              {"variation", Summary::Variation},
                                                              {"range", Summary::Range},
                                                              {"worst", Summary::Worst},
                                                              {"std", Summary::Std}}};
  for (const auto& [name, kind] : kinds) {
    out[name] = summarised(kind, kModulation, response);
  }
  for (const Metric& metric : {Metric{kFriction}, Metric{Adhesion{}}, Metric{Compliance{}}}) {
    out["mean_" + metric_text(metric)] = summarised(Summary::Mean, metric, response);
  }
  return out;
}

Json plan_json(const Plan& plan) {
  Json steps = Json::array(), skipped = Json::array();
  for (const PlanStep& s : plan.steps) {
    steps.push_back({{"piece", s.name()},
                     {"method", s.method},
                     {"reason", s.reason},
                     {"seconds", s.seconds},
                     {"error", s.error}});
  }
  for (const PlanSkip& s : plan.skipped) {
    skipped.push_back({{"piece", s.name()},
                       {"reason", s.reason},
                       {"bound", json_number(s.bound)},
                       {"estimate", s.estimate}});
  }
  return {
      {"grid",
       {{"nx", plan.grid.nx}, {"ny", plan.grid.ny}, {"lx", plan.grid.lx}, {"ly", plan.grid.ly}}},
      {"effective_cutoff", plan.effective_cutoff},
      {"feature_pixels", json_number(plan.feature_pixels)},
      {"warnings", plan.warnings},
      {"seconds", plan.seconds()},
      {"steps", steps},
      {"skipped", skipped}};
}

Json voltage_json(const VoltageAnswer& v) {
  return {{"modulation", v.target},
          {"amplitude", v.reached() ? measured(v.amplitude) : Json(nullptr)},
          // Reached, the modulation at the amplitude is the target, and may be higher beyond.
          {"highest_modulation", v.reached() ? Json(nullptr) : json_number(v.modulation)},
          {"limit", json_number(v.limit)},
          {"evaluations", v.evaluations},
          {"status", v.reached() ? "ok" : text(v)}};
}

Json point_json(const Response& response, std::size_t index) {
  const ResponsePoint& p = response.points[index];
  const bool driven = response.driven;
  Json point;
  point["relative_humidity"] = p.relative_humidity;
  point["weight"] = p.weight;
  point["patch_pressure"] = json_number(p.patch_pressure);
  // Null where the state does not exist; `status` says why.
  for (const auto& q : api::kQuantities<Measured>)
    point[q.key] = exists(q.drive, p, driven)
                       ? with_members(measured(p.*q.value),
                                      belief_values_at(index, QuantityMetric{q.value}, response))
                       : Json(nullptr);
  point["bridge_water_share"] = json_number(p.bridge_water_share);
  point["over_limit_area"] = json_number(p.over_limit_area);
  point["over_limit_share"] = json_number(p.over_limit_share);
  point["source_voltage"] = driven ? json_number(p.source_voltage) : Json(nullptr);
  point["capillary_gain"] =
      exists(api::FingerDrive::On, p, driven) ? json_number(p.capillary_gain) : Json(nullptr);
  point["peak_air_field"] = json_number(p.peak_air_field);
  point["peak_oxide_field"] = json_number(p.peak_oxide_field);
  point["field_correction"] = json_number(p.field_correction);
  point["field_error"] = p.field_error ? json_number(*p.field_error) : Json();
  point["oxide_margin"] = json_number(p.oxide_margin);
  point["bridged_margin"] = json_number(p.bridged_margin);
  for (const VoltageAnswer& v : p.voltages) point["voltage_for"].push_back(voltage_json(v));
  if (p.pull_in) {
    point["pull_in_margin"] = measured(p.pull_in->margin);
    point["pull_in_folds"] = json_number(p.pull_in->folds);
  }
  point["status"] = text(driven ? p.said() : p.status);
  return point;
}

// Null where the theory does not reach.
Json appearance_json(const Optics& look) {
  const bool refused = look.refused();
  const auto value = [&](double v) { return refused ? Json(nullptr) : json_number(v); };
  return {{"regime", text(look.regime)},
          {"warning", look.warning},
          {"haze", value(look.haze)},
          {"transmittance", value(look.transmittance)},
          {"gloss", value(look.gloss)},
          {"colour_shift", value(look.colour_shift)},
          {"total_transmittance", value(look.total_transmittance)},
          {"gloss_20", value(look.gloss_20)},
          {"gloss_85", value(look.gloss_85)},
          {"distinctness", value(look.distinctness)},
          {"sparkle", value(look.sparkle)}};
}

Json steps_json(const ParameterSteps& p) {
  return {{"directions", p.steps.size()},
          {"skins", p.skins},
          {"grid", p.grid},
          {"status", p.troubles.empty() ? "ok" : text(p.troubles)}};
}

Json belief_json(const BeliefRuns& b, bool with_time) {
  if (b.members.empty()) return {{"members", Json::array()}, {"status", b.absent}};
  Json members = Json::array();
  for (const BeliefRun& m : b.members)
    members.push_back({{"weight", m.weight}, {"hypothesis", m.hypothesis}});
  Json out{{"members", std::move(members)},
           {"effective_members", b.effective()},
           {"skins", b.skins},
           {"grid", b.grid},
           {"status", b.troubles.empty() ? "ok" : text(b.troubles)}};
  if (with_time) out["seconds"] = b.seconds;
  return out;
}

Json target_json(const TargetReport& a) {
  return {{"target", a.target},     {"reached", json_number(a.reached)},
          {"quantity", a.quantity}, {"parts", {"sampling", "grid", "method", "solver"}},
          {"status", text(a)},      {"steps", a.steps}};
}

Json fidelity_json(const Fidelity& f) {
  return {{"level", f.level},
          {"grid", f.grid},
          {"window", kWindow},
          {"skins", f.skins},
          {"estimator", f.estimator == Estimator::Load ? "load" : "area"},
          {"contact_tolerance", f.contact_tolerance}};
}

}  // namespace

std::string response_json(const Response& response, bool with_time, int indent) {
  Json points = Json::array();
  for (std::size_t i = 0; i < response.points.size(); ++i)
    points.push_back(point_json(response, i));
  Json out{{"schema", 1},
           {"points", points},
           {"status", response.said().empty() ? "ok" : text(response.said())},
           {"summary", summary_json(response)},
           {"plan", plan_json(response.plan)}};
  if (response.appearance) out["appearance"] = appearance_json(*response.appearance);
  if (!response.parameters.steps.empty()) out["parameters"] = steps_json(response.parameters);
  if (!response.belief.members.empty() || !response.belief.absent.empty())
    out["belief"] = belief_json(response.belief, with_time);
  if (with_time) {
    out["seconds"] = response.seconds;
    const PieceSeconds& pieces = response.piece_seconds;
    out["processor_seconds"] = {
        {"contact", pieces.contact}, {"water", pieces.water}, {"field", pieces.field}};
  }
  if (response.accuracy.target > 0) out["accuracy"] = target_json(response.accuracy);
  out["fidelity"] = fidelity_json(response.fidelity);
  out["contact_solves"] = response.contact_solves;
  out["fft_pairs"] = json_number(response.fft_pairs);
  return out.dump(indent);
}

std::string plan_document(const Plan& plan) {
  return Json{{"schema", 1}, {"plan", plan_json(plan)}}.dump(2);
}

}  // namespace papilla::report
