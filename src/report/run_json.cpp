#include "report/run_json.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "metrics/shown.h"
#include "report/decision.h"
#include "report/grounds.h"
#include "report/json.h"
#include "report/limits.h"
#include "report/receipts.h"
#include "report/recommendation.h"
#include "report/remarks.h"
#include "report/run_numbers.h"
#include "report/shared.h"
#include "report/sheet.h"
#include "report/yield.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

// In SI: stated numbers are in the unit that people read.
std::string score_number(const ResultFiles& f, const std::string& of, const Score& score,
                         std::size_t k) {
  StatedNumber number = objective_number(f, of, score, k);
  const double scale = shown_unit(f.problem.objectives()[k].expression).scale;
  number.value = score.values[k];
  for (StatedError* error : {&number.numerical, &number.model}) {
    if (error->size) *error->size /= scale;
  }
  if (!number.unit.empty()) number.unit = "SI";
  return stated_value(number);
}

// SI, as the tables of the page take them.
Json values_json(const ResultFiles& f, const std::string& of, const Score& score) {
  Json out = Json::object();
  for (std::size_t k = 0; k < score.values.size(); ++k)
    out[f.problem.objectives()[k].name] = {{"value", score_number(f, of, score, k)},
                                           {"se", json_number(score.errors[k])}};
  return out;
}

// The nearest design of the grid, where another is built.
Json nearest_json(const ResultFiles& f, const BuiltDesign& build) {
  if (!build.nearest || build.nearest->unit == build.made.unit) return {};
  return {
      {"objectives", values_json(f, "the nearest design of the grid", build.nearest->confirmed)},
      {"keeps_every_limit", build.nearest->feasible}};
}

const char* advice_name(Advice advice) {
  switch (advice) {
    case Advice::Nothing:
      return "nothing";
    case Advice::Unknown:
      return "unknown";
    case Advice::LeaveFlat:
      return "leave flat";
    case Advice::Finish:
      return "finish";
    case Advice::Texture:
      break;
  }
  return "texture";
}

// The objectives of what is recommended, beside those of its flat surface.
std::string facts_text(const ResultFiles& f) {
  const FinalDesign design = recommended_of(f);
  const std::string own = "what is recommended", of_flat = "the same surface without texture";
  std::vector<std::string> out;
  for (std::size_t k = 0; k < design.confirmed.values.size(); ++k) {
    out.push_back(f.problem.objectives()[k].name + " " +
                  objective_text(f, own, design.confirmed, k));
    if (f.result.flat)
      out.back() += fmt::format(" (the same without texture {})",
                                objective_text(f, of_flat, *f.result.flat, k));
  }
  std::string said =
      (design.flat ? "The flat surface has " : "The best design has ") + join_names(out, ", ");
  if (f.problem.driven()) {
    said += ", and a worst modulation of " + worst_text(own, design.confirmed.worst);
    if (f.result.flat)
      said += fmt::format(" (without texture {})", worst_text(of_flat, f.result.flat->worst));
    said += " over fingers and humidity";
  }
  said += design.feasible ? "." : ". It does not keep every constraint.";
  if (f.result.decision.made())
    said += " ± is numerical, brackets behind it hold what is not known of finger and model.";
  if (f.problem.driven()) said += " Modulation is (F_on - F_off)/F_off.";
  return said;
}

// Each as a whole: counts and trends of a search that is not made again.
Json remarks_json(const ResultFiles& f) {
  Json out = Json::array();
  for (const std::string& remark : run_remarks(f.study, f.problem, f.result))
    out.push_back(stated(whole_text(fmt::format("remark {}", out.size() + 1),
                                    "said of the run as a whole", {Stage::Sensitivity}),
                         remark));
  return out;
}

Json numbers_json(const std::vector<double>& numbers) {
  Json out = Json::array();
  for (const double number : numbers) out.push_back(json_number(number));
  return out;
}

// As a study judges: larger values are better where they are maximised; violations above 0 are
// broken limits.
Json judgement_json(const ResultFiles& f, const Score& score, bool confirmed) {
  const std::vector<double> none;
  return {{"ok", score.ok},
          {"reason", score.reason},
          {"values", numbers_json(score.values)},
          {"errors", numbers_json(score.errors)},
          {"violations",
           numbers_json(confirmed && score.ok ? f.problem.constraints().violations(score) : none)}};
}

// To the last digit, SI, in the order of the variables and objectives of resolved.toml.
Json finalists_json(const ResultFiles& f) {
  Json out = Json::array();
  for (const FinalDesign& d : f.result.finalists) {
    out.push_back({{"folder", d.folder},
                   {"values", numbers_json(f.problem.space().value(d.unit))},
                   {"searched", judgement_json(f, d.searched, false)},
                   {"confirmed", judgement_json(f, d.confirmed, true)}});
  }
  return out;
}

}  // namespace

Json run_json(const ResultFiles& f) {
  const OptimiseResult& r = f.result;
  Json out{{"schema", 1},
           {"interrupted", r.interrupted},
           {"feasible", r.any_feasible},
           {"evaluations", r.evaluations},
           {"asked", r.asked},
           {"stopped_by_the_clock", !r.cuts.empty()},
           {"driven", f.problem.driven()},
           {"remarks", remarks_json(f)},
           {"pick", f.pick},
           {"finalists", finalists_json(f)},
           {"best", r.best},
           {"shown", Json::object()}};
  for (const StudyObjective& o : f.problem.objectives()) {
    const ShownUnit shown = shown_unit(o.expression);
    out["shown"][o.name] = {{"scale", shown.scale}, {"unit", shown.unit}};
  }
  if (r.interrupted || r.finalists.empty()) return out;
  out["advice"] = advice_name(advice_of(f));
  out["recommendation"] = recommendation(f);
  out["receipts"] = r.has_best() ? Json(kReceiptsName) : Json();
  if (!r.has_best()) return out;
  const FinalDesign recommended = recommended_of(f);
  out["facts"] = facts_text(f);
  out["grounds"] = grounds(f);
  out["design"] = recommended.flat ? Json() : Json(recommended.folder);
  out["textured"] = facts(built_design(f).texture).relief.present;
  out["stable"] = Json();
  if (const auto place = checked_place(f)) out["stable"] = f.result.stability.stable(*place);
  out["decision"] = decision_json(f);
  out["finish"] = finish_text(f);
  out["sheet"] = Json::array();
  for (const SheetRow& row : sheet_rows(f)) out["sheet"].push_back(row_json(row));
  out["grid"] = f.study.search.rounding;
  out["limits"] = built_limits_json(built_limits(f));
  out["yield"] = yield_json(f);
  out["shared"] = shared_json(f);
  out["build"] = Json();
  if (r.build) {
    out["build"] = {{"judged", r.build->made.confirmed.ok},
                    {"keeps_every_limit", r.build->made.feasible},
                    {"widened", r.build->widened},
                    {"on_grid", r.build->on_grid},
                    {"designs_judged", r.build->judged},
                    {"objectives", values_json(f, "what is built", r.build->made.confirmed)},
                    {"nearest", nearest_json(f, *r.build)},
                    {"said", grid_text(f)}};
  }
  Json steps = Json::array();
  const auto step = [&](const std::string& name, const std::optional<Score>& score) {
    if (score)
      steps.push_back(
          {{"surface", name}, {"objectives", values_json(f, "the step \"" + name + "\"", *score)}});
  };
  step("flat, finish and drive of the study", r.flat_before);
  step(r.flat_before ? "flat, finish and drive of the best" : "flat", r.flat);
  const bool textured = facts(recommended.design.texture).relief.present;
  if (textured) step("best, with its texture", recommended.confirmed);
  if (r.build && r.build->made.confirmed.ok && r.build->made.unit != recommended.unit)
    step(textured ? "best, on the grid of the fab" : "flat, on the grid of the fab",
         r.build->made.confirmed);
  out["steps"] = std::move(steps);
  out["best_flat"] = Json();
  if (const auto flat = best_flat(f.problem, r)) {
    const FinalDesign& design = r.finalists[*flat];
    out["best_flat"] = {
        {"surface", "best flat surface of this run, " + design_name(design.folder)},
        {"objectives", values_json(f, "the best flat surface of the run", design.confirmed)}};
  }
  return out;
}

}  // namespace papilla::report
