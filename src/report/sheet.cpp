#include "report/sheet.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "base/units.h"
#include "design/families.h"
#include "metrics/shown.h"
#include "report/decision.h"
#include "report/json.h"
#include "report/receipts.h"
#include "report/remarks.h"
#include "report/run_numbers.h"
#include "report/shared.h"
#include "report/tables.h"
#include "report/unstable.h"
#include "report/yield.h"
#include "search/rounding.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

const FinalDesign& best_of(const ResultFiles& f) { return f.result.finalists[f.result.best]; }
FinalDesign recommended_of(const ResultFiles& f) { return recommended_design(f.problem, f.result); }
Advice advice_of(const ResultFiles& f) { return search::advice_of(f.problem, f.result); }

// Why a number has no bar.
constexpr const char* kChosen = "chosen: it is exact";
constexpr const char* kAsked = "an input";
constexpr const char* kOfALook = "by theory, without scatter";
constexpr const char* kOfACheck =
    "one of the checks: the bar is that of the design, other skins in it";
constexpr const char* kOfAStep = "read off steps of one number at a time";
constexpr const char* kOfALimit = "held against its limit as it is";
constexpr const char* kLowest = "the lowest over fingers and humidity: no bar is stated for it";

std::string in_unit(double si, const std::string& unit, int digits) {
  const double shown = si / find_unit(unit)->to_si;
  return significant(shown, digits) + (unit.empty() ? "" : " " + unit);
}

// Objectives in which a design is better (else worse) by more than the error: "mean(modulation)
// +0.031 ± 0.012". words: which design less which.
std::string changes(const ResultFiles& f, const std::string& words, const Score& design,
                    const Score& other, bool better) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < design.values.size(); ++k) {
    const StudyObjective& o = f.problem.objectives()[k];
    const double change = design.values[k] - other.values[k];
    const double error = difference_error(design, other, k);
    if ((o.maximise == better ? change : -change) <= error) continue;
    // A quantity without an error, an appearance, changes by rounding alone.
    if (shown_value(o.expression, change) == shown_value(o.expression, 0)) continue;
    const std::string unit = shown_unit(o.expression).unit;
    const std::string said =
        fmt::format("{} ± {}{}", shown_value(o.expression, change, true),
                    shown_error(o.expression, error), unit.empty() ? "" : " " + unit);
    out.push_back(o.name + " " + stated(difference_number(f, words, design, other, k), said));
  }
  return join_names(out);
}

// "gains mean(modulation) +0.031 ± 0.012 and costs ..."; "" where neither is beyond its error.
std::string gains_and_costs(const ResultFiles& f, const std::string& words, const Score& design,
                            const Score& other) {
  const std::string gain = changes(f, words, design, other, true),
                    cost = changes(f, words, design, other, false);
  if (gain.empty()) return cost.empty() ? "" : "costs " + cost;
  return "gains " + gain + (cost.empty() ? "" : " and costs " + cost);
}

// The value of a variable.
std::string chosen_value(const Variable& v, double value, const std::string& of) {
  const std::string text = variable_text(v, value);
  if (v.is_kind()) return text;
  return stated(bare_number(v.path + " of " + of, value / find_unit(v.unit)->to_si, v.unit, kChosen,
                            {Stage::Confirm}),
                text);
}

// "surface.contact_angle 60 deg to 90 deg": what of the best design is not the texture's.
std::string finish_text(const ResultFiles& f) {
  const std::vector<double> own = f.problem.space().value(f.problem.space().unit_of_study());
  const std::vector<double> best = f.problem.space().value(best_of(f).unit);
  std::vector<std::string> out;
  for (std::size_t k : changed_finish(f.problem, f.result)) {
    const Variable& v = f.study.variables[k];
    out.push_back(fmt::format("{} {} to {}", v.path, chosen_value(v, own[k], "the study"),
                              chosen_value(v, best[k], "the best")));
  }
  return join_names(out);
}

// "surface.contact_angle 63 deg, drive.amplitude 180 V": what the variables say of a surface
// besides its texture.
std::string surface_text(const ResultFiles& f, const std::string& of, const Point& unit) {
  const std::vector<double> value = f.problem.space().value(unit);
  std::vector<std::string> out;
  for (std::size_t k = 0; k < value.size(); ++k) {
    const Variable& v = f.study.variables[k];
    if (!v.path.starts_with("texture."))
      out.push_back(fmt::format("{} {}", v.path, chosen_value(v, value[k], of)));
  }
  return join_names(out);
}

std::vector<std::string> broken_texts(const std::vector<LimitValue>& limits) {
  std::vector<std::string> out;
  for (const LimitValue& v : limits) {
    if (!v.kept()) out.push_back(limit_broken(v));
  }
  return out;
}

// Of what is built, where that was judged; else as far as they are known before.
std::vector<LimitValue> built_limits(const ResultFiles& f) {
  const StudyConstraints& constraints = f.problem.constraints();
  if (!f.result.build) {
    const FinalDesign design = recommended_of(f);
    return constraints.values(design.design, design.confirmed);
  }
  const FinalDesign& made = f.result.build->made;
  if (made.confirmed.ok) return constraints.values(made.design, made.confirmed);
  std::vector<LimitValue> out = constraints.values(made.design, recommended_of(f).confirmed);
  std::erase_if(out, [](const LimitValue& v) {
    return std::holds_alternative<MetricLimit>(v.limit.on) ||
           std::holds_alternative<YieldLimit>(v.limit.on);
  });
  return out;
}

// Where the design is among those whose order was checked.
std::optional<std::size_t> checked_place(const ResultFiles& f) {
  const FinalDesign design = recommended_of(f);
  for (std::size_t i = 0; i < f.result.finalists.size(); ++i) {
    if (f.result.finalists[i].unit == design.unit && !design.flat && f.result.stability.judged(i))
      return i;
  }
  return std::nullopt;
}

std::string unstable_recommended(const ResultFiles& f) {
  const auto place = checked_place(f);
  return place ? unstable_text(f, *place) : std::string();
}

std::string judged_text(const BuiltDesign& build) {
  return stated(count_number("designs of the grid that were judged", build.judged,
                             {Stage::Confirm, Stage::Rounding}),
                fmt::format("{}", build.judged));
}

// What rounding would break, where it is not on the grid for that.
std::string rounding_text(const ResultFiles& f) {
  if (!f.result.build || f.result.build->on_grid) return {};
  const FinalDesign& nearest = f.result.build->nearest.value();
  std::vector<std::string> broken;
  if (nearest.confirmed.ok)
    broken = broken_texts(f.problem.constraints().values(nearest.design, nearest.confirmed));
  return fmt::format(
      " Its numbers are as searched, off the grid of the fab: of {} designs of the grid that were "
      "judged none keeps every limit{}; use a finer `search.rounding`.",
      judged_text(*f.result.build),
      broken.empty() ? "" : " (of the nearest " + join_names(broken) + ")");
}

std::string worth_building(const ResultFiles& f) {
  const OptimiseResult& r = f.result;
  const FinalDesign& best = best_of(f);
  std::vector<std::string> clauses;
  std::vector<std::string> broken;
  for (const LimitValue& v : broken_without_texture(f.problem, r))
    broken.push_back(limit_broken(v));
  if (!broken.empty())
    clauses.push_back(fmt::format("Without its texture the same surface breaks a limit: {}.",
                                  join_names(broken)));
  if (const std::string same = gains_and_costs(f, "the best less the same surface without texture",
                                               best.confirmed, *r.flat);
      !same.empty())
    clauses.push_back("Against the same surface without texture it " + same + ".");
  const auto flat = best_flat(f.problem, r);
  const std::string of_flat = "the best flat surface of the run";
  if (flat &&
      surface_text(f, of_flat, r.finalists[*flat].unit) != surface_text(f, of_flat, best.unit)) {
    const FinalDesign& other = r.finalists[*flat];
    const std::string both =
        gains_and_costs(f, "the best less " + of_flat, best.confirmed, other.confirmed);
    const std::string surface = surface_text(f, of_flat, other.unit);
    clauses.push_back(fmt::format(
        "Against the best flat surface of this run, {}{}, it {}.", design_name(other.folder),
        surface.empty() ? "" : " (" + surface + ")",
        both.empty() ? "is no better and no worse than the error of the difference" : both));
  }
  if (const std::string finish = finish_text(f); !finish.empty())
    clauses.push_back("The finish changes too (" + finish + ").");
  return fmt::format("Build {} ({}). {}", design_name(best.folder), shape_text(built_design(f)),
                     join_names(clauses, " "));
}

// "15 to 75 %"
std::string humidity_text(const std::vector<double>& humidities) {
  if (humidities.empty()) return "no humidity";
  const auto [low, high] = std::minmax_element(humidities.begin(), humidities.end());
  const auto said = [](const char* which, double humidity, const char* unit) {
    return stated(
        bare_number(fmt::format("{} relative humidity", which), 100 * humidity, "%", kAsked, {}),
        fmt::format("{:.0f}{}", 100 * humidity, unit));
  };
  if (*low == *high) return said("the", *low, " %");
  return said("the lowest", *low, "") + " to " + said("the highest", *high, " %");
}

const char* state_text(FingerState state) {
  switch (state) {
    case FingerState::Clean:
      return "degreased fingers (finger.state = \"clean\")";
    case FingerState::Natural:
      return "natural fingers, not degreased";
    case FingerState::Wet:
      break;
  }
  return "wet fingers";
}

// Which fingers and weathers the numbers are for.
std::string conditions_text(const ResultFiles& f) {
  std::vector<std::string> states;
  double least = kInfinity, most = 0;
  for (std::size_t t = 0; t < f.problem.nominal_tasks(); ++t) {
    const Finger& finger = f.problem.tasks()[t].finger;
    const std::string state = state_text(finger.state);
    if (std::find(states.begin(), states.end(), state) == states.end()) states.push_back(state);
    least = std::min(least, finger.load), most = std::max(most, finger.load);
  }
  const auto said = [](const char* which, double load) {
    return stated(bare_number(fmt::format("{} load", which), load, "N", kAsked, {}),
                  format_quantity(load, "N"));
  };
  const std::string load = least == most
                               ? said("the", least)
                               : said("the least", least) + " to " + said("the largest", most);
  return fmt::format("Judged for {} at {} relative humidity under {}.", join_names(states, " and "),
                     humidity_text(f.study.design.environment.relative_humidity), load);
}

// An objective in one of the checks.
std::string checked_value(const StudyObjective& o, double value, const std::string& check) {
  const ShownUnit shown = shown_unit(o.expression);
  return stated(bare_number(o.name + " under " + check, value * shown.scale, shown.unit, kOfACheck,
                            {Stage::Confirm, Stage::Stability}),
                shown_value(o.expression, value));
}

// The numbers of a design in one of the checks: "mean(modulation) 0.296 (0.608)".
std::string skin_text(const ResultFiles& f) {
  const Stability& s = f.result.stability;
  const auto place = checked_place(f);
  if (!s.other_skin || *s.other_skin >= s.variants.size() || !place)
    return "Another state of the skin (natural, not degreased) was not tried on it.";
  const StabilityVariant &other = s.variants[*s.other_skin], &own = s.variants.front();
  if (other.values[*place].empty() || own.values[*place].empty())
    return fmt::format("On {} it has no value.", other.name);
  std::vector<std::string> values;
  for (std::size_t k = 0; k < f.problem.objectives().size(); ++k) {
    const StudyObjective& o = f.problem.objectives()[k];
    values.push_back(fmt::format("{} {} where it has {}", o.name,
                                 checked_value(o, other.values[*place][k], other.name),
                                 checked_value(o, own.values[*place][k], own.name)));
  }
  const auto worst = [&](const StabilityVariant& v) {
    return stated(bare_number("worst modulation under " + v.name, v.worst[*place], "", kOfACheck,
                              {Stage::Stability}),
                  fmt::format("{:.3f}", v.worst[*place]));
  };
  if (f.problem.driven() && *place < other.worst.size())
    values.push_back(
        fmt::format("a worst modulation of {} where it has {}", worst(other), worst(own)));
  return fmt::format("On {} ({}) it has {}.", other.name, f.problem.tasks().front().name,
                     join_names(values));
}

// Choices of the model, and how far each moves the design alone. Without belief no ± holds any.
std::string model_text(const ResultFiles& f) {
  const Stability& s = f.result.stability;
  const auto place = checked_place(f);
  const std::string out =
      f.problem.has_belief() ? "Choices of the model, each alone" : "In no ±: choices of the model";
  if (!s.other_skin || !place)
    return out + " (`papilla explain` names them), which were not tried on it.";
  std::vector<std::string> names, ranges;
  std::vector<std::vector<double>> values;
  for (std::size_t v = *s.other_skin + 1; v < s.variants.size(); ++v) {
    names.push_back(s.variants[v].name);
    if (!s.variants[v].values[*place].empty()) values.push_back(s.variants[v].values[*place]);
  }
  for (std::size_t k = 0; k < f.problem.objectives().size() && !values.empty(); ++k) {
    const StudyObjective& o = f.problem.objectives()[k];
    const auto [low, high] = std::minmax_element(
        values.begin(), values.end(), [k](const auto& a, const auto& b) { return a[k] < b[k]; });
    ranges.push_back(
        fmt::format("{} {} to {}", o.name,
                    checked_value(o, (*low)[k], "the choice of the model that makes it least"),
                    checked_value(o, (*high)[k], "the choice of the model that makes it largest")));
  }
  return fmt::format("{} ({}): over these {}.", out, join_names(names),
                     ranges.empty() ? "it has no value" : "it has " + join_names(ranges));
}

std::string worst_text(const std::string& of, double worst) {
  return stated(bare_number("worst modulation of " + of, worst, "", kLowest,
                            {Stage::Confirm, Stage::Rounding}),
                fmt::format("{:.3f}", worst));
}

// A modulation that nobody feels somewhere.
std::string felt_text(const ResultFiles& f) {
  const double worst = recommended_of(f).confirmed.worst;
  if (!f.problem.driven() || worst >= kNoticed) return {};
  return fmt::format(
      "At its worst, over fingers and humidity, the modulation is {}: below {}, the least "
      "relative difference of friction that people notice (Fehlberg 2022), it is not felt there.",
      worst_text("what is recommended", worst),
      stated(bare_number("least relative difference that people notice", kNoticed, "",
                         "published (Fehlberg 2022)", {}),
             fmt::format("{:.2g}", kNoticed)));
}

// How it looks, where the study says what the glass is.
std::string look_text(const ResultFiles& f) {
  const Design built = built_design(f);
  const bool asked = f.problem.goals().looks || f.study.origins.count("surface.refractive_index");
  if (!asked || !(facts(built.texture).quick_look || f.problem.goals().looks)) return {};
  const Optics look = appearance_of(built);
  if (look.refused()) return "Its haze is not known: " + look.warning + ".";
  return fmt::format("It has {} haze{}.",
                     stated(bare_number("haze of what is built", 100 * look.haze, "%", kOfALook,
                                        {Stage::Confirm, Stage::Rounding}),
                            significant(100 * look.haze, 3) + " %"),
                     look.warning.empty() ? "" : " (" + look.warning + ")");
}

Json drift_json(const std::optional<Drift>& drift, double unit) {
  return drift && drift->judged() ? Json(drift->most / unit) : Json();
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

// Which grid the numbers are on, and what that did.
std::string grid_text(const ResultFiles& f) {
  if (!f.result.build || !(f.study.search.rounding > 0)) return {};
  const BuiltDesign& build = *f.result.build;
  const FinalDesign searched = recommended_of(f);
  const double grid = f.study.search.rounding;
  const auto length = [](const char* words, double value) {
    return stated(bare_number(words, 1e9 * value, "nm", kAsked, {}), format_quantity(value, "nm"));
  };
  std::string out = fmt::format(
      " Lengths of {} and more are on a grid of {} (`search.rounding`), shorter ones on a finer "
      "one (`best/build.toml`)",
      length("least length on the grid of the fab", finer_grid_below(grid)),
      length("grid of the fab", grid));
  if (!build.on_grid) return {};
  if (build.widened) out += "; nearer values of the grid break a limit";
  if (!build.made.confirmed.ok) return out + "; it was not judged again so.";
  if (build.judged > 1)
    out += fmt::format("; the best of {} designs of the grid that were judged", judged_text(build));
  if (build.made.unit == searched.unit) return out + ".";
  std::vector<std::string> values;
  for (std::size_t k = 0; k < f.problem.objectives().size(); ++k) {
    const StudyObjective& o = f.problem.objectives()[k];
    const auto said = [&](const char* of, const Score& score) {
      return stated(objective_number(f, of, score, k), shown_value(o.expression, score.values[k]));
    };
    values.push_back(fmt::format("{} {} where it had {}", o.name,
                                 said("what is built", build.made.confirmed),
                                 said("what is recommended, as searched", searched.confirmed)));
  }
  return out + fmt::format("; it was judged again so: {}.", join_names(values));
}

// The limit itself, as a text has it.
std::string asked_limit(const LimitValue& v, const std::string& text) {
  return stated(bare_number("limit of " + limit_name(v.limit.on), v.limit.limit, "SI", kAsked, {}),
                text);
}

std::string built_limit_text(const LimitValue& v) {
  return limit_stated(v, limit_name(v.limit.on) + " of what is built");
}

std::string limits_table(const std::vector<LimitValue>& limits) {
  if (limits.empty()) return {};
  std::string out = "\n" + markdown_head({"limit", "asked for", "as built"});
  for (const LimitValue& v : limits) {
    out += markdown_row({limit_name(v.limit.on), asked_limit(v, limit_text(v.limit)),
                         built_limit_text(v) + (v.kept() ? "" : ", **broken**")});
  }
  return out;
}

// What the page shows of the limits.
Json built_limits_json(const std::vector<LimitValue>& limits) {
  Json out = limits_json(limits);
  for (std::size_t i = 0; i < limits.size(); ++i) {
    out[i]["text"] = built_limit_text(limits[i]);
    out[i]["asked"] = asked_limit(limits[i], limit_text(limits[i].limit));
  }
  return out;
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
      out.back() += fmt::format(" (flat {})", objective_text(f, of_flat, *f.result.flat, k));
  }
  std::string said =
      (design.flat ? "The flat surface has " : "The best design has ") + join_names(out, ", ");
  if (f.problem.driven()) {
    said += ", and a worst modulation of " + worst_text(own, design.confirmed.worst);
    if (f.result.flat) said += fmt::format(" (flat {})", worst_text(of_flat, f.result.flat->worst));
    said += " over fingers and humidity";
  }
  return said + (design.feasible ? "." : ". It does not keep every constraint.");
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

}  // namespace

std::string design_name(const std::string& folder) {
  constexpr std::string_view kFront = "front/";
  if (!folder.starts_with(kFront)) return folder.empty() ? "a dominated design" : folder;
  return "design " + folder.substr(kFront.size());
}

std::string limit_stated(const LimitValue& v, const std::string& words) {
  return stated(bare_number(words, v.value, "SI", kOfALimit,
                            {Stage::Confirm, Stage::Rounding, Stage::Stability}),
                limit_value_text(v.limit, v.value));
}

std::string shape_text(const Design& design) {
  Texture texture = design.texture;
  const TextureFacts of = facts(texture);
  const auto* array = std::get_if<FeatureArray>(&of.outline);
  std::string kind =
      array ? std::string(array->drawn) : std::string(texture_kinds()[texture.kind.index()]);
  std::replace(kind.begin(), kind.end(), '_', ' ');
  const Roles role = roles(texture);
  std::vector<std::string> measures;
  const std::vector<NumberField> known = number_fields(texture, "texture");
  const auto add = [&](const double* value, const char* word) {
    for (const NumberField& field : known) {
      if (field.value == value)
        measures.push_back(
            stated(
                bare_number(field.path + " in words", *field.value / find_unit(field.unit)->to_si,
                            field.unit, kChosen, {Stage::Confirm, Stage::Rounding}),
                in_unit(*field.value, field.unit, 4)) +
            " " + word);
    }
  };
  add(role.width, "wide");
  add(role.period, "apart");
  add(role.depth, array && !array->deep ? "high" : "deep");
  return measures.empty() ? kind : kind + " " + join_names(measures);
}

std::string limit_broken(const LimitValue& v) {
  return fmt::format("{} is {}, {} your limit of {}", limit_name(v.limit.on),
                     limit_stated(v, limit_name(v.limit.on) + " where it is broken"),
                     v.limit.at_least ? "below" : "above",
                     asked_limit(v, limit_value_text(v.limit, v.limit.limit)));
}

std::string drift_text(const Drift& drift, const std::string& unit) {
  switch (drift.end) {
    case Drift::End::Loss:
      return in_unit(drift.most, unit, 2);
    case Drift::End::Limit:
      return drift.most > 0
                 ? fmt::format("{}, then {} is reached", in_unit(drift.most, unit, 2), drift.limit)
                 : fmt::format("none: {} is reached", drift.limit);
    case Drift::End::StepTried:
      return fmt::format("> {} (largest step tried)", in_unit(drift.most, unit, 2));
    case Drift::End::RangeEnds:
      return "not judged: the search range ends here";
    case Drift::End::NoShape:
      return "not judged: no such shape can be made";
    case Drift::End::Failed:
      break;
  }
  return "not judged: the evaluation failed";
}

Json limits_json(const std::vector<LimitValue>& limits) {
  Json out = Json::array();
  for (const LimitValue& v : limits) {
    out.push_back({{"name", limit_name(v.limit.on)},
                   {"at_least", v.limit.at_least},
                   {"limit", json_number(v.limit.limit)},
                   {"value", json_number(v.value)},
                   {"text", limit_value_text(v.limit, v.value)},
                   {"asked", limit_text(v.limit)},
                   {"kept", v.kept()}});
  }
  return out;
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
             "difference." +
             rounding_text(f);
    case Advice::Finish:
      if (!r.flat_before) {
        return fmt::format(
            "Leave it flat: no texture of this search adds more than the error of the difference. "
            "What the finish does ({}) is not known: the study's own surface was not computed in "
            "the time.{}{}",
            finish_text(f), rounding_text(f), unstable_recommended(f));
      }
      return fmt::format(
          "Leave it flat and change the finish ({}): that gains {}; no texture of this search adds "
          "more than the error of the difference.{}{}",
          finish_text(f),
          changes(f, "the finish of the best less that of the study",
                  r.flat ? *r.flat : best_of(f).confirmed, *r.flat_before, true),
          rounding_text(f), unstable_recommended(f));
    case Advice::Texture:
      break;
  }
  return worth_building(f) + decision_sentence(f) + yield_sentence(f) + rounding_text(f) +
         unstable_recommended(f);
}

std::vector<std::string> grounds(const ResultFiles& f) {
  std::vector<std::string> out{conditions_text(f) + " " + skin_text(f), model_text(f)};
  for (std::string said : {felt_text(f), look_text(f)}) {
    if (!said.empty()) out.push_back(std::move(said));
  }
  return out;
}

Design built_design(const ResultFiles& f) {
  return f.result.build ? f.result.build->made.design : recommended_of(f).design;
}

std::vector<SheetRow> sheet_rows(const ResultFiles& f) {
  Design searched = recommended_of(f).design, built = built_design(f);
  const bool relief = facts(built.texture).relief.present;
  const std::vector<NumberField> known = number_fields(searched), final = number_fields(built);
  std::vector<SheetRow> out;
  for (std::size_t i = 0; i < known.size(); ++i) {
    const std::string& path = known[i].path;
    const auto variable =
        std::find_if(f.study.variables.begin(), f.study.variables.end(),
                     [&](const Variable& v) { return path_in(known, v.path) == path; });
    const bool is_variable = variable != f.study.variables.end();
    const bool of_texture = path.starts_with("texture.");
    if (of_texture ? !relief : !is_variable) continue;
    SheetRow row;
    row.path = path, row.unit = known[i].unit;
    row.value = *known[i].value, row.build = *final[i].value;
    row.free = is_variable;
    if (is_variable) {
      const auto k = static_cast<std::size_t>(variable - f.study.variables.begin());
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

std::string sheet_text(const ResultFiles& f) {
  std::string out = fmt::format("\n## What to build\n\n**{}**\n", recommendation(f));
  for (const std::string& said : grounds(f)) out += "\n- " + said;
  out += "\n\n" + markdown_head({"dimension", "build", "tolerance down", "up"});
  for (const SheetRow& row : sheet_rows(f)) {
    const Json text = row_json(row)["text"];
    out += markdown_row({row.path, text["build"], text["down"], text["up"]});
  }
  out +=
      "\nTolerance: how far it may be off before an objective worsens by 5 % or a limit is "
      "reached, one dimension at a time." +
      grid_text(f) + "\n" + limits_table(built_limits(f));
  if (const std::string yield = yield_text(f); !yield.empty()) out += "\n" + yield + "\n";
  return out;
}

namespace {

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
