#include "report/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "base/units.h"
#include "design/families.h"
#include "metrics/shown.h"
#include "report/grounds.h"
#include "report/limits.h"
#include "report/recommendation.h"
#include "report/run_numbers.h"
#include "report/tables.h"
#include "report/yield.h"
#include "search/advice.h"
#include "search/rounding.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

// In the unit that it has few digits in: 25 um, not 25000 nm.
std::string asked_length(const char* words, double si) {
  const std::string unit = si < 1e-6 ? "nm" : si < 1e-3 ? "um" : "mm";
  return stated(bare_number(words, si / find_unit(unit)->to_si, unit, kAsked, {}),
                in_unit(si, unit, 4));
}

Json drift_json(const std::optional<Drift>& drift, double unit) {
  return drift && drift->judged() ? Json(drift->most / unit) : Json();
}

}  // namespace

std::string drift_text(const Drift& drift, const std::string& unit) {
  switch (drift.end) {
    case Drift::End::Loss:
      return at_most(drift.most, unit);
    case Drift::End::Limit:
      return drift.most > 0
                 ? fmt::format("{}, then {} is reached", at_most(drift.most, unit), drift.limit)
                 : fmt::format("none: {} is reached", drift.limit);
    case Drift::End::StepTried:
      return fmt::format("> {} (largest step tried)", at_most(drift.most, unit));
    case Drift::End::RangeEnds:
      return "not judged: the search range ends here";
    case Drift::End::NoShape:
      return "not judged: no such shape can be made";
    case Drift::End::Failed:
      break;
  }
  return "not judged: the evaluation failed";
}

std::vector<SheetRow> sheet_rows(const ResultFiles& f) {
  Design searched = recommended_of(f).design, built = built_design(f);
  const bool relief = facts(built.texture).relief.present;
  const std::vector<NumberField> known = number_fields(searched), final = number_fields(built);
  std::map<std::string, std::size_t> variables;  // by the number that each is here
  for (std::size_t k = 0; k < f.study.variables.size(); ++k) {
    if (f.problem.space().acts(searched, k))
      variables.emplace(path_in(known, f.study.variables[k].path), k);
  }
  std::vector<SheetRow> out;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const std::string& path = known[i].path;
    const auto variable = variables.find(path);
    const bool is_variable = variable != variables.end();
    const bool of_texture = path.starts_with("texture.");
    if (of_texture ? !relief : !is_variable) continue;
    SheetRow row;
    row.path = path, row.unit = known[i].unit;
    row.value = *known[i].value, row.build = *final[i].value;
    row.free = is_variable;
    if (is_variable) {
      const std::size_t k = variable->second;
      for (const VariableSensitivity& s : f.result.sensitivity) {
        if (s.variable == k) row.down = s.down, row.up = s.up;
      }
      for (const AtBound& at : f.result.at_bound) {
        if (at.variable == k) row.at_bound = at.upper;
      }
    }
    out.push_back(std::move(row));
  }
  return out;
}

Json row_json(const SheetRow& row) {
  const double unit = find_unit(row.unit)->to_si;
  const auto at_least = [](const std::optional<Drift>& d) {
    return d && d->end == Drift::End::StepTried;
  };
  const auto limit = [](const std::optional<Drift>& d) {
    return d && d->end == Drift::End::Limit ? Json(d->limit) : Json();
  };
  const auto text = [&](const char* way, const std::optional<Drift>& d) -> std::string {
    if (!row.free || !d) return row.free ? "not known" : "fixed";
    return stated(bare_number(fmt::format("tolerance {} of {}", way, row.path),
                              d->judged() ? d->most / unit : std::nan(""), row.unit, kOfAStep,
                              {Stage::Confirm, Stage::Rounding, Stage::Sensitivity}),
                  drift_text(*d, row.unit));
  };
  const auto dimension = [&](const char* of, double value) {
    return bare_number(row.path + of, value / unit, row.unit, kChosen,
                       {Stage::Confirm, Stage::Rounding});
  };
  Json out{{"name", row.path},
           {"words", plain_name(row.path)},
           {"unit", row.unit},
           {"value", stated_value(dimension(" as searched", row.value))},
           {"build", row.build / unit},
           {"free", row.free},
           {"down", drift_json(row.down, unit)},
           {"down_at_least", at_least(row.down)},
           {"down_limit", limit(row.down)},
           {"up", drift_json(row.up, unit)},
           {"up_at_least", at_least(row.up)},
           {"up_limit", limit(row.up)}};
  out["bound"] = !row.at_bound ? Json() : Json(*row.at_bound ? "upper" : "lower");
  out["text"] = {
      {"build", stated(dimension(" to build", row.build), in_unit(row.build, row.unit, 6))},
      {"down", text("down", row.down)},
      {"up", text("up", row.up)}};
  return out;
}

std::string tolerance_end_text(const ResultFiles& f) {
  const std::vector<StudyObjective>& all = f.problem.objectives();
  const bool aimed =
      std::any_of(all.begin(), all.end(), [](const StudyObjective& o) { return o.aimed; });
  return fmt::format(
      "an objective worsens by 5 %{} or a limit is reached",
      aimed ? " (a distance: by 5 % of its target, or of itself if that is more)" : "");
}

std::string fab_grid_text(const ResultFiles& f) {
  return asked_length("grid of the fab", f.study.search.rounding);
}

namespace {

// The study's own surface without a texture: nothing of it was searched, so nothing is rounded.
bool is_as_in_file(const ResultFiles& f) {
  return search::advice_of(f.problem, f.result) == Advice::LeaveFlat;
}

}  // namespace

std::vector<std::string> off_the_grid(const ResultFiles& f) {
  std::vector<std::string> out;
  if (is_as_in_file(f) || !(f.study.search.rounding > 0)) return out;
  for (const SheetRow& row : sheet_rows(f)) {
    const auto found = std::find_if(f.study.variables.begin(), f.study.variables.end(),
                                    [&](const Variable& v) { return v.path == row.path; });
    if (row.free && found != f.study.variables.end() &&
        !lies_on_grid(*found, row.build, f.study.search.rounding))
      out.push_back(row.path);
  }
  return out;
}

// Which grid the numbers are on, and what that did.
std::string grid_text(const ResultFiles& f) {
  if (!f.result.build || !(f.study.search.rounding > 0)) return {};
  const BuiltDesign& build = *f.result.build;
  const FinalDesign searched = recommended_of(f);
  if (!build.on_grid) return {};
  if (is_as_in_file(f)) return " Finish and drive are those of the study file and are not rounded.";
  std::string out = fmt::format(
      " Periods and widths that were searched are on a grid of {} (`search.rounding`), and so are "
      "other lengths of {} and more; shorter ones are on a finer one (`best/build.toml`)",
      fab_grid_text(f),
      asked_length("least length on the grid of the fab",
                   finer_grid_below(f.study.search.rounding)));
  if (const std::vector<std::string> off = off_the_grid(f); !off.empty())
    out += fmt::format("; the range of {} has no value of it", join_names(off, " and of "));
  if (build.widened) out += "; nearer values of the grid break a limit";
  if (!build.made.confirmed.ok) return out + "; it was not judged again so.";
  if (build.judged > 1)
    out +=
        fmt::format("; the best of {} designs of the grid that were judged", judged_on_grid(build));
  const auto rounded = worth_on_grid(f.problem, f.result);
  if (!rounded) return out + ".";
  std::vector<std::string> values;
  for (std::size_t k = 0; k < f.problem.objectives().size(); ++k) {
    const StudyObjective& o = f.problem.objectives()[k];
    const std::string unit = shown_unit(o.expression).unit;
    const auto said = [&](const char* of, const Score& score) {
      return stated(objective_number(f, of, score, k),
                    shown_value(o.expression, score.values[k]) + (unit.empty() ? "" : " " + unit));
    };
    values.push_back(fmt::format("{} {} where it had {}", o.name, said("what is built", *rounded),
                                 said("what is recommended, as searched", searched.confirmed)));
  }
  if (f.problem.judged_at_amplitude())
    values.push_back(fmt::format(
        "a worst modulation of {} where it had {}", worst_text("what is built", rounded->worst),
        worst_text("what is recommended, as searched", searched.confirmed.worst)));
  return out + fmt::format("; it was judged again so: {}.", join_names(values));
}

std::string sheet_text(const ResultFiles& f) {
  std::string out = fmt::format("\n## What to build\n\n**{}**\n", recommendation(f));
  for (const std::string& said : grounds(f)) out += "\n- " + said;
  out += "\n";
  // A flat surface whose finish is that of the study has no number that was searched.
  if (const std::vector<SheetRow> rows = sheet_rows(f); !rows.empty()) {
    out += "\n" + markdown_head({"dimension", "build", "tolerance down", "up"});
    for (const SheetRow& row : rows) {
      const Json text = row_json(row)["text"];
      out += markdown_row({row.path, text["build"], text["down"], text["up"]});
    }
    out += fmt::format("\nTolerance: how far it may be off before {}, one dimension at a time.",
                       tolerance_end_text(f)) +
           grid_text(f) + "\n";
  }
  out += limits_table(built_limits(f));
  if (const std::string yield = yield_text(f); !yield.empty()) out += "\n" + yield + "\n";
  return out;
}

}  // namespace papilla::report
