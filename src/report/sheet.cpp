#include "report/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "base/units.h"
#include "design/families.h"
#include "metrics/shown.h"
#include "report/json.h"
#include "report/remarks.h"
#include "report/tables.h"
#include "search/rounding.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

const FinalDesign& best_of(const ResultFiles& f) { return f.result.finalists[f.result.best]; }

// Objectives in which a design is better (else worse) by more than the error: "mean(modulation)
// +0.031 ± 0.012".
std::string changes(const ResultFiles& f, const Score& design, const Score& other, bool better) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < design.values.size(); ++k) {
    const StudyObjective& o = f.problem.objectives()[k];
    const double change = design.values[k] - other.values[k];
    const double error = difference_error(design, other, k);
    if ((o.maximise == better ? change : -change) <= error) continue;
    // A quantity without an error, an appearance, changes by rounding alone.
    if (shown_value(o.expression, change) == shown_value(o.expression, 0)) continue;
    const std::string unit = shown_unit(o.expression).unit;
    out.push_back(fmt::format("{} {} ± {}{}", o.name, shown_value(o.expression, change, true),
                              shown_error(o.expression, error), unit.empty() ? "" : " " + unit));
  }
  return join_names(out);
}

// "surface.contact_angle 60 deg to 90 deg": what of the best design is not the texture's.
std::string finish_text(const ResultFiles& f) {
  const std::vector<double> own = f.problem.space().value(f.problem.space().unit_of_study());
  const std::vector<double> best = f.problem.space().value(best_of(f).unit);
  std::vector<std::string> out;
  for (std::size_t k = 0; k < own.size(); ++k) {
    const Variable& v = f.study.variables[k];
    if (v.path.starts_with("texture.") || own[k] == best[k]) continue;
    out.push_back(
        fmt::format("{} {} to {}", v.path, variable_text(v, own[k]), variable_text(v, best[k])));
  }
  return join_names(out);
}

std::string in_unit(double si, const std::string& unit, int digits) {
  const double shown = si / find_unit(unit)->to_si;
  return significant(shown, digits) + (unit.empty() ? "" : " " + unit);
}

std::string tolerance_text(const SheetRow& row, const std::optional<double>& drift, bool at_least) {
  if (!row.free) return "fixed";
  if (!drift) return "not known";
  if (!(*drift > 0)) return "its bound is near";
  return fmt::format("{}{}", at_least ? "at least " : "", in_unit(*drift, row.unit, 2));
}

Json row_json(const SheetRow& row) {
  const double unit = find_unit(row.unit)->to_si;
  const auto drift = [&](const std::optional<double>& d) { return d ? Json(*d / unit) : Json(); };
  Json out{{"name", row.path},
           {"unit", row.unit},
           {"value", row.value / unit},
           {"build", row.build / unit},
           {"free", row.free},
           {"down", drift(row.down)},
           {"down_at_least", row.down_at_least},
           {"up", drift(row.up)},
           {"up_at_least", row.up_at_least}};
  out["bound"] = !row.at_bound ? Json() : Json(*row.at_bound ? "upper" : "lower");
  out["text"] = {{"build", in_unit(row.build, row.unit, 6)},
                 {"down", tolerance_text(row, row.down, row.down_at_least)},
                 {"up", tolerance_text(row, row.up, row.up_at_least)}};
  return out;
}

Json values_json(const ResultFiles& f, const Score& score) {
  Json out = Json::object();
  for (std::size_t k = 0; k < score.values.size(); ++k)
    out[f.problem.objectives()[k].name] = {{"value", json_number(score.values[k])},
                                           {"se", json_number(score.errors[k])}};
  return out;
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

// The constraints that a surface beside the best design breaks: "worst(modulation) (at least 0.3)".
std::string broken_by(const ResultFiles& f, const Score& other) {
  return join_names(f.problem.constraints().never_kept({{{}, f.problem.outcome(other)}}));
}

}  // namespace

Advice advice_of(const ResultFiles& f) {
  if (!f.result.has_best() || !best_of(f).feasible) return Advice::Nothing;
  const OptimiseResult& r = f.result;
  const Score& best = best_of(f).confirmed;
  const auto& objectives = f.problem.objectives();
  const bool textured = facts(best_of(f).design.texture).relief.present;
  if (textured && !r.flat) return Advice::Unknown;
  const auto beats = [&](const Score& design, const Score& other) {
    return !no_better(objectives, design, other) || !broken_by(f, other).empty();
  };
  if (textured && beats(best, *r.flat)) return Advice::Texture;
  if (!r.flat_before) return finish_text(f).empty() ? Advice::LeaveFlat : Advice::Finish;
  return beats(r.flat ? *r.flat : best, *r.flat_before) ? Advice::Finish : Advice::LeaveFlat;
}

std::string recommendation(const ResultFiles& f) {
  const OptimiseResult& r = f.result;
  switch (advice_of(f)) {
    case Advice::Nothing:
      return "Build none of these: no design that was tried keeps every constraint.";
    case Advice::Unknown:
      return "Whether a texture is worth building is not known: the surface without it was not "
             "computed in the time.";
    case Advice::LeaveFlat:
      return "Leave it flat: no texture or finish of this search gains more than the error of the "
             "difference.";
    case Advice::Finish:
      if (!r.flat_before) {
        return fmt::format(
            "Leave it flat: no texture of this search adds more than the error of the difference. "
            "What the finish does ({}) is not known: the study's own surface was not computed in "
            "the time.",
            finish_text(f));
      }
      return fmt::format(
          "Leave it flat and change the finish ({}): {}; no texture of this search adds more than "
          "the error of the difference.",
          finish_text(f),
          changes(f, r.flat ? *r.flat : best_of(f).confirmed, *r.flat_before, true));
    case Advice::Texture:
      break;
  }
  const std::string finish = finish_text(f), broken = broken_by(f, *r.flat);
  const std::string gain = changes(f, best_of(f).confirmed, *r.flat, true);
  const std::string cost = changes(f, best_of(f).confirmed, *r.flat, false);
  std::vector<std::string> clauses;
  if (!broken.empty())
    clauses.push_back(fmt::format("the same surface without its texture breaks {}", broken));
  if (!gain.empty())
    clauses.push_back(fmt::format("{}its texture gains {}{}",
                                  broken.empty() ? "beside the same surface without it, " : "",
                                  gain, cost.empty() ? "" : fmt::format(" and costs {}", cost)));
  if (!finish.empty()) clauses.push_back(fmt::format("the finish changes too ({})", finish));
  return fmt::format("Build {}: {}.", best_of(f).folder, fmt::join(clauses, "; "));
}

Design built_design(const ResultFiles& f) {
  Design out = f.result.rounded ? f.result.rounded->design : best_of(f).design;
  const std::vector<NumberField> known = number_fields(out);
  for (const Variable& v : f.study.variables) {
    const std::string path = path_in(known, v.path);
    if (path.empty()) continue;
    double& value = *find_number_field(known, path).value;
    if (f.result.rounded) value = on_grid(v, value, f.study.search.rounding);
  }
  return out;
}

std::vector<SheetRow> sheet_rows(const ResultFiles& f) {
  Design best = best_of(f).design, built = built_design(f);
  const bool relief = facts(best.texture).relief.present;
  const std::vector<NumberField> known = number_fields(best), final = number_fields(built);
  std::vector<SheetRow> out;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const std::string& path = known[i].path;
    const auto variable =
        std::find_if(f.study.variables.begin(), f.study.variables.end(),
                     [&](const Variable& v) { return path_in(known, v.path) == path; });
    const bool is_variable = variable != f.study.variables.end();
    const bool of_texture = path.starts_with("texture.");
    if (of_texture ? !relief : !is_variable) continue;
    SheetRow row{
        path, known[i].unit, *known[i].value, *final[i].value, is_variable, {}, {}, false, false,
        {}};
    if (is_variable) {
      const auto k = static_cast<std::size_t>(variable - f.study.variables.begin());
      for (const VariableSensitivity& s : f.result.sensitivity) {
        if (s.variable != k) continue;
        row.down = s.down;
        row.up = s.up;
        row.down_at_least = s.down_beyond;
        row.up_at_least = s.up_beyond;
      }
      for (const AtBound& at : f.result.at_bound) {
        if (at.variable == k) row.at_bound = at.upper;
      }
    }
    out.push_back(std::move(row));
  }
  return out;
}

std::string sheet_text(const ResultFiles& f) {
  std::string out = fmt::format("\n## What to build\n\n**{}**\n\n", recommendation(f));
  out += markdown_head({"dimension", "build", "tolerance down", "up"});
  for (const SheetRow& row : sheet_rows(f)) {
    out += markdown_row({row.path, in_unit(row.build, row.unit, 6),
                         tolerance_text(row, row.down, row.down_at_least),
                         tolerance_text(row, row.up, row.up_at_least)});
  }
  out +=
      "\nTolerance: the drift that costs no objective more than 5 % of its value, one dimension "
      "at a time.";
  if (f.result.rounded) {
    std::vector<std::string> values;
    for (std::size_t k = 0; k < f.problem.objectives().size(); ++k) {
      const StudyObjective& o = f.problem.objectives()[k];
      if (!f.result.rounded->confirmed.ok) continue;
      values.push_back(fmt::format("{} {} where it had {}", o.name,
                                   shown_value(o.expression, f.result.rounded->confirmed.values[k]),
                                   shown_value(o.expression, best_of(f).confirmed.values[k])));
    }
    out += fmt::format(
        " Lengths are on a grid of {} (`search.rounding`), and the design was judged "
        "again so: {}{} (`best/build.toml`).",
        format_quantity(f.study.search.rounding, "nm"), join_names(values),
        f.result.rounded->feasible ? "" : "; **so it does not keep every constraint**");
  }
  return out + "\n";
}

std::string run_json(const ResultFiles& f) {
  const OptimiseResult& r = f.result;
  Json out{{"schema", 1},
           {"evaluations", r.evaluations},
           {"asked", r.asked},
           {"stopped_by_the_clock", !r.cuts.empty()},
           {"driven", f.problem.driven()},
           {"remarks", run_remarks(f.study, f.problem, r)},
           {"shown", Json::object()}};
  for (const StudyObjective& o : f.problem.objectives()) {
    const ShownUnit shown = shown_unit(o.expression);
    out["shown"][o.name] = {{"scale", shown.scale}, {"unit", shown.unit}};
  }
  if (r.interrupted || r.finalists.empty()) return out.dump(1) + "\n";
  out["advice"] = advice_name(advice_of(f));
  out["recommendation"] = recommendation(f);
  if (!r.has_best()) return out.dump(1) + "\n";
  out["finish"] = finish_text(f);
  out["sheet"] = Json::array();
  for (const SheetRow& row : sheet_rows(f)) out["sheet"].push_back(row_json(row));
  out["grid"] = f.study.search.rounding;
  Json steps = Json::array();
  const auto step = [&](const char* name, const std::optional<Score>& score) {
    if (score) steps.push_back({{"surface", name}, {"objectives", values_json(f, *score)}});
  };
  step("flat, finish and drive of the study", r.flat_before);
  step(r.flat_before ? "flat, finish and drive of the best" : "flat", r.flat);
  if (facts(best_of(f).design.texture).relief.present)
    step("best, with its texture", best_of(f).confirmed);
  if (r.rounded && r.rounded->confirmed.ok)
    step("best, on the grid of the fab", r.rounded->confirmed);
  out["steps"] = std::move(steps);
  return out.dump(1) + "\n";
}

}  // namespace papilla::report
