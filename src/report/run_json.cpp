#include "report/run_json.h"

#include <fmt/format.h>

#include <algorithm>
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

// The values of a surface in the words of the page: "0.567 ± 0.032 (0.267)".
Json compared_row(const ResultFiles& f, const std::string& surface, const std::string& of,
                  const Score& score) {
  Json values = Json::array();
  for (std::size_t k = 0; k < score.values.size(); ++k)
    values.push_back(objective_text(f, of, score, k));
  if (f.problem.judged_at_amplitude()) values.push_back(worst_text(of, score.worst));
  return {{"surface", surface}, {"values", std::move(values)}};
}

// What is recommended beside what it was chosen against: flat surfaces, the choice of the fit
// alone, the design to measure.
Json compared_json(const ResultFiles& f) {
  const OptimiseResult& r = f.result;
  const FinalDesign recommended = recommended_of(f);
  const std::string name = recommended.flat ? "without texture" : design_name(recommended.folder);
  Json names = Json::array(), rows = Json::array();
  for (const StudyObjective& o : f.problem.objectives()) names.push_back(o.name);
  if (f.problem.judged_at_amplitude()) names.emplace_back("worst modulation");
  rows.push_back(
      compared_row(f, name + ", recommended", "what is recommended", recommended.confirmed));
  const bool textured = facts(recommended.design.texture).relief.present;
  if (r.flat && textured)
    rows.push_back(
        compared_row(f, "the same without texture", "the same surface without texture", *r.flat));
  const bool own_flat = r.flat_before && search::advice_of(f.problem, r) == Advice::Finish;
  if (own_flat)
    rows.push_back(compared_row(f, "flat, finish and drive of the study",
                                "the surface of the study without texture", *r.flat_before));
  if (recommended.flat)
    rows.push_back(compared_row(f, design_name(r.finalists[r.best].folder) + ", with its texture",
                                "the best design", r.finalists[r.best].confirmed));
  const FinalDesign& best = r.finalists[r.best];
  std::vector<Point> shown{best.unit, recommended.unit};
  if (own_flat) shown.push_back(f.problem.space().with_own_finish(best.unit));
  const auto add = [&](const FinalDesign& design, const std::string& called, const char* words,
                       const std::string& of) {
    if (std::find(shown.begin(), shown.end(), design.unit) != shown.end()) return;
    shown.push_back(design.unit);
    rows.push_back(compared_row(f, called + ", " + words, of, design.confirmed));
  };
  if (const auto flat = best_flat(f.problem, r))
    add(*flat, flat_name(*flat), "best flat surface", "the best flat surface of the run");
  const auto add_finalist = [&](std::size_t place, const char* words, const std::string& of) {
    const FinalDesign& design = r.finalists[place];
    add(design, design_name(design.folder), words, of);
  };
  if (r.decision.made())
    add_finalist(r.decision.nominal, "best by the fit alone", "the choice by the fit alone");
  if (const auto rival = design_to_measure(f))
    add_finalist(*rival, "to measure beside it", "the design to measure");
  return {{"names", std::move(names)}, {"rows", std::move(rows)}};
}

// What belongs to what is built beside the numbers of the sheet: what they leave between the
// features, materials, the drive.
Json beside_json(const ResultFiles& f) {
  const Design built = built_design(f);
  Json out = Json::array();
  const std::vector<FilmDielectric>& films = built.surface.dielectric;
  for (std::size_t i = 0; i < films.size(); ++i) {
    if (!films[i].material.empty())
      out.push_back({{"words", films.size() == 1 ? "film" : fmt::format("film {}", i + 1)},
                     {"text", films[i].material}});
  }
  const double wall = facts(built.texture).margins.min_wall;
  if (std::isfinite(wall) && facts(built.texture).relief.present)
    out.push_back({{"words", "narrowest wall"},
                   {"text", stated(bare_number("narrowest wall", 1e9 * wall, "nm", kChosen,
                                               {Stage::Confirm, Stage::Rounding}),
                                   in_unit(wall, "nm", 4))}});
  if (const std::string drive = drive_text(f); !drive.empty())
    out.push_back({{"words", "drive"}, {"text", drive}});
  return out;
}

// What the errors of that are, and what is in the names.
std::string facts_text(const ResultFiles& f) {
  std::string said = worth_on_grid(f.problem, f.result)
                         ? "Computed, not measured, before rounding to the grid of the fab."
                         : "Computed, not measured.";
  said += " ± is numerical, one standard error";
  said += f.result.decision.made() ? "; in brackets what is not known of finger and model, one "
                                     "standard deviation, common to all designs."
                                   : ".";
  if (f.problem.driven()) said += " Modulation is (F_on - F_off)/F_off.";
  said += " Variation is the standard deviation over humidity, a share of the mean.";
  if (!recommended_of(f).feasible) said += " What is recommended does not keep every constraint.";
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
    const std::optional<int> decimals = shown_decimals(o.expression);
    out["shown"][o.name] = {{"scale", shown.scale},
                            {"unit", shown.unit},
                            {"decimals", decimals ? Json(*decimals) : Json()}};
  }
  if (r.interrupted || r.finalists.empty()) return out;
  out["advice"] = advice_name(search::advice_of(f.problem, r));
  out["recommendation"] = recommendation(f);
  out["receipts"] = r.has_best() ? Json(kReceiptsName) : Json();
  if (!r.has_best()) return out;
  const FinalDesign recommended = recommended_of(f);
  out["compared"] = compared_json(f);
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
  out["beside"] = beside_json(f);
  out["grid"] = f.study.search.rounding;
  out["limits"] = built_limits_json(built_limits(f));
  out["yield"] = yield_json(f);
  out["shared"] = shared_json(f);
  out["build"] = Json();
  if (r.build) {
    out["build"] = {{"judged", r.build->made.confirmed.ok},
                    {"keeps_every_limit", r.build->made.feasible},
                    {"widened", r.build->widened},
                    {"on_grid", r.build->on_grid && off_the_grid(f).empty()},
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
  const std::optional<Score> on_grid = worth_on_grid(f.problem, r);
  step("flat, finish and drive of the study", r.flat_before);
  step(r.flat_before ? "flat, finish and drive of the best" : "flat", r.flat);
  const bool textured = facts(recommended.design.texture).relief.present;
  if (textured) step("best, with its texture", recommended.confirmed);
  step(textured ? "best, on the grid of the fab" : "flat, on the grid of the fab", on_grid);
  out["steps"] = std::move(steps);
  out["best_flat"] = Json();
  if (const auto flat = best_flat(f.problem, r)) {
    out["best_flat"] = {
        {"surface", "best flat surface of this run, " + flat_name(*flat)},
        {"objectives", values_json(f, "the best flat surface of the run", flat->confirmed)}};
  }
  return out;
}

}  // namespace papilla::report
