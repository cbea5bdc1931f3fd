#include "report/grounds.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "base/units.h"
#include "metrics/shown.h"
#include "report/decision.h"
#include "report/limits.h"
#include "report/recommendation.h"
#include "report/run_numbers.h"
#include "report/sheet.h"
#include "report/unstable.h"
#include "search/levels.h"

namespace papilla::report {
namespace {

// Why a number has no bar.
constexpr const char* kOfALook = "by theory, without scatter";
constexpr const char* kOfACheck =
    "one of the checks: the bar is that of the design, other skins in it";
constexpr const char* kLowest = "the lowest over fingers and humidity: no bar is stated for it";

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

// " (worst(voltage_for(modulation = 0.3)) 147.5 ± 2.1 V)": what was found of what is built; ""
// where a limit alone asks for it.
std::string found_voltages(const ResultFiles& f) {
  const Score score = built_score(f);
  std::vector<std::string> out;
  for (std::size_t k = 0; k < score.values.size(); ++k) {
    const StudyObjective& o = f.problem.objectives()[k];
    if (!o.aimed && std::holds_alternative<VoltageFor>(o.expression.metric))
      out.push_back(o.name + " " + objective_text(f, scored_name(f), score, k));
  }
  return out.empty() ? "" : " (" + join_names(out) + ")";
}

// What is built under each finger and scenario of the study.
std::vector<Design> judged_designs(const ResultFiles& f) {
  const Design built = built_design(f);
  std::vector<Design> out;
  for (std::size_t t = 0; t < f.problem.nominal_tasks(); ++t)
    out.push_back(search::task_design(f.study, built, f.problem.tasks()[t]));
  return out;
}

std::string one_drive(const ResultFiles& f, const Drive& drive) {
  if (!drive.driven()) return "no voltage";
  const auto said = [](const char* what, double value, const char* unit) {
    return stated(bare_number(what, value / find_unit(unit)->to_si, unit, kAsked, {}),
                  in_unit(value, unit, 4));
  };
  const bool direct = drive.waveform == Waveform::Dc;
  std::string source;
  if (!f.problem.goals().own_amplitude) {
    source = "the voltage that is asked for" + found_voltages(f);
  } else if (drive.control == DriveControl::Voltage) {
    source = said("amplitude of the drive", drive.amplitude, "V") + (direct ? "" : " (peak)");
  } else {
    source = said("current of the drive", drive.current, "mA");
  }
  if (direct) return source + ", a direct voltage";
  return fmt::format("{} at {}", source, said("frequency of the drive", drive.frequency, "kHz"));
}

// Which fingers, weathers and pen the numbers are for.
std::string conditions_text(const ResultFiles& f) {
  std::vector<std::string> states;
  std::vector<double> humidities;
  double least = kInfinity, most = 0;
  for (const Design& design : judged_designs(f)) {
    const std::vector<double>& air = design.environment.relative_humidity;
    humidities.insert(humidities.end(), air.begin(), air.end());
    const Finger finger = scene_of(design).finger;
    const std::string state = f.study.design.counterface.in_place()
                                  ? "the pin \"" + finger.name + "\" in place of a finger"
                                  : state_text(finger.state);
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
  const std::string drive = drive_text(f);
  const Pin& pen = f.study.design.counterface.pen;
  return fmt::format(
      "Judged for {} at {} relative humidity under {}{}{}.", join_names(states, " and "),
      humidity_text(humidities), load, drive.empty() ? "" : ", driven with " + drive,
      f.problem.goals().pen
          ? fmt::format(", and for the pen \"{}\" under {}", pen.name, said("the pen's", pen.load))
          : "");
}

// An objective in one of the checks.
std::string checked_value(const StudyObjective& o, double value, const std::string& check) {
  const ShownUnit shown = shown_unit(o.expression);
  return stated(bare_number(o.name + " under " + check, value * shown.scale, shown.unit, kOfACheck,
                            {Stage::Confirm, Stage::Stability}),
                shown_value(o.expression, value)) +
         (shown.unit.empty() ? "" : " " + shown.unit);
}

std::string checked_worst(const StabilityVariant& v, std::size_t place) {
  return stated(bare_number("worst modulation under " + v.name, v.worst[place], "", kOfACheck,
                            {Stage::Stability}),
                fmt::format("{:.3f}", v.worst[place]));
}

// "at the coarser level of the checks": they are of fewer pixels or skins than the other numbers.
std::string checks_level(const ResultFiles& f) {
  const Fidelity level = search::stage_fidelity(f.problem, Stage::Stability),
                 &others = f.result.confirmed_with;
  const bool coarser = level.grid < others.grid || level.skins < others.skins;
  return fmt::format("at the {}level of the checks", coarser ? "coarser " : "");
}

// "64 pixels, 8 skins"
std::string checks_pixels(const ResultFiles& f) {
  const Fidelity level = search::stage_fidelity(f.problem, Stage::Stability);
  const auto said = [](const char* what, int count) {
    return stated(
        count_number(fmt::format("{} of the checks", what), static_cast<std::size_t>(count), {}),
        fmt::format("{} {}", count, what));
  };
  return said("pixels", level.grid) + ", " + said("skins", level.skins);
}

// The numbers of a design in one of the checks: "mean(modulation) 0.296 (0.608)".
std::string skin_text(const ResultFiles& f) {
  const Stability& s = f.result.stability;
  const auto place = checked_place(f);
  if (f.study.design.counterface.in_place()) return {};
  if (!s.other_skin || *s.other_skin >= s.variants.size() || !place) {
    const bool clean =
        search::task_design(f.study, f.study.design, f.problem.tasks().front()).finger.state ==
        FingerState::Clean;
    return fmt::format(" Another state of the skin ({}) was not tried on it.",
                       clean ? "natural, not degreased" : "degreased");
  }
  const StabilityVariant &other = s.variants[*s.other_skin], &own = s.variants.front();
  if (other.values[*place].empty() || own.values[*place].empty())
    return fmt::format(" On {} {}.", other.name, no_value_text(other, *place));
  std::vector<std::string> values;
  for (std::size_t k = 0; k < f.problem.objectives().size(); ++k) {
    const StudyObjective& o = f.problem.objectives()[k];
    values.push_back(fmt::format("{} {} in place of {}", o.name,
                                 checked_value(o, other.values[*place][k], other.name),
                                 checked_value(o, own.values[*place][k], own.name)));
  }
  if (f.problem.judged_at_amplitude() && *place < other.worst.size())
    values.push_back(fmt::format("a worst modulation of {} in place of {}",
                                 checked_worst(other, *place), checked_worst(own, *place)));
  return fmt::format(" On {}, with finger \"{}\" alone and {} ({}), it has {}.", other.name,
                     f.problem.tasks().front().name, checks_level(f), checks_pixels(f),
                     join_names(values));
}

// Choices of the model, and how far each moves the design alone. Without belief no ± holds any.
std::string model_text(const ResultFiles& f) {
  const Stability& s = f.result.stability;
  const auto place = checked_place(f);
  const std::string out =
      f.problem.has_belief() ? "Choices of the model, each alone" : "In no ±: choices of the model";
  if (s.first_choice == 0 || !place)
    return out + " (`papilla explain` names them), which were not tried on it.";
  std::vector<std::string> ranges;
  std::vector<std::vector<double>> values;
  const std::size_t tried = s.variants.size() - std::min(s.variants.size(), s.first_choice);
  for (std::size_t v = s.first_choice; v < s.variants.size(); ++v) {
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
  return fmt::format(
      "{} ({} of them, on {} \"{}\" {}{}): over these {}.", out,
      stated(count_number("choices of the model that were tried", tried, {Stage::Stability}),
             fmt::format("{}", tried)),
      f.study.design.counterface.in_place() ? "the pin" : "finger", f.problem.tasks().front().name,
      checks_level(f), s.has_order() ? "; the table \"Does the order hold?\" has each" : "",
      ranges.empty() ? "it has no value" : "it has " + join_names(ranges));
}

// A modulation that nobody feels somewhere.
std::string felt_text(const ResultFiles& f) {
  const double worst = built_score(f).worst;
  if (!f.problem.judged_at_amplitude() || worst >= kNoticed) return {};
  return fmt::format(
      "At its worst, over fingers and humidity, the modulation is {}: below {}, the least "
      "relative difference of friction that people notice (Fehlberg 2022), it is not felt there.",
      worst_text(scored_name(f), worst), noticed_text());
}

// How it looks, where the study says what the glass is.
std::string look_text(const ResultFiles& f) {
  const Design built = built_design(f);
  const bool asked = f.problem.goals().looks || f.study.origins.count("surface.refractive_index");
  if (!asked || !(facts(built.texture).quick_look || f.problem.goals().looks)) return {};
  const Optics look = appearance_of(built);
  if (look.refused()) return "Its haze is not known: " + look.warning + ".";
  return fmt::format(
      "It has {} haze{}.",
      stated(bare_number("haze of what is built", 100 * look.haze, "%", kOfALook,
                         {Stage::Confirm, Stage::Rounding}),
             significant(100 * without_noise(parse_metric("haze"), look.haze), 3) + " %"),
      look.warning.empty() ? "" : " (" + look.warning + ")");
}

// How a film lies on a texture.
const char* process_text(FilmProcess process) {
  switch (process) {
    case FilmProcess::Conformal:
      return ", grown equally thick on every wall (conformal)";
    case FilmProcess::Directional:
      return ", laid from above, thin on steep walls (directional)";
    case FilmProcess::Planar:
      return ", on a flat electrode, with the texture cut into it (planar)";
  }
  return "";
}

// What the fab lays, takes away and leaves of a film that the texture is cut into; of others how
// thick they are.
std::string film_text(const ResultFiles& f) {
  const Design built = built_design(f);
  const std::optional<Planes> planes = facts(built.texture).relief.planes;
  const std::vector<FilmDielectric>& films = built.surface.dielectric;
  const auto said = [](const char* what, double length, const std::string& of = "") {
    return stated(bare_number(what, 1e9 * length, "nm", kChosen, {Stage::Confirm, Stage::Rounding}),
                  in_unit(length, "nm", 4) + (of.empty() ? "" : " of " + of));
  };
  const bool cut = planes && planes->high > planes->low;
  const auto made = [&](const FilmDielectric& layer) {
    return layer.made_by(built.surface.process);
  };
  if (!cut || films.size() != 1 || made(films[0]) != FilmProcess::Planar) {
    if (!f.problem.driven() || films.empty()) return {};
    const bool alike = std::all_of(films.begin(), films.end(), [&](const FilmDielectric& layer) {
      return made(layer) == made(films[0]);
    });
    std::vector<std::string> layers;
    for (const FilmDielectric& layer : films) {
      layers.push_back(
          said("film", layer.thickness, layer.material.empty() ? "a dielectric" : layer.material) +
          (cut && !alike ? process_text(made(layer)) : ""));
    }
    return "Film: " + join_names(layers, alike || !cut ? " and " : "; ") +
           (cut && alike ? process_text(made(films[0])) : "") + ".";
  }
  return fmt::format(
      "Film: {} are laid, {} are taken away where the texture is deep, {} remain there.",
      said("film as laid", films[0].thickness + planes->high,
           films[0].material.empty() ? "it" : films[0].material),
      said("film taken away", planes->high - planes->low),
      said("film that stays", films[0].thickness + planes->low));
}

// A film that holds the field which was solved and not that of a short through a bridge. Where the
// study has such a limit, that says so.
std::string at_risk_text(const ResultFiles& f) {
  const double margin = built_score(f).oxide_margin;
  if (!f.problem.judged_at_amplitude() || f.problem.goals().film || margin >= 1) return {};
  return fmt::format(
      "Its oxide_breakdown_margin is {}: below 1, a bridge or a contact on the thinnest place of "
      "its film breaks it down. `oxide_breakdown_margin = 1` in [constraints] asks for designs "
      "that hold.",
      stated(bare_number("oxide_breakdown_margin of " + scored_name(f), margin, "", kLowest,
                         {Stage::Confirm, Stage::Rounding}),
             fmt::format("{:.3g}", margin)));
}

// "min_wall at least 0.4 um": the limit of that name.
std::string limit_of_name(const ResultFiles& f, const std::string& name) {
  for (const Constraint& limit : f.study.constraints) {
    if (limit_name(limit.on) == name) return limit_asked(limit);
  }
  return name;
}

// What another rule would build, where the worst modulation or one objective decides: objectives
// that do not, as haze beside touch, are paid for without a word else.
std::string other_rule_text(const ResultFiles& f) {
  const std::vector<StudyObjective>& objectives = f.problem.objectives();
  const Decision& decision = f.result.decision;
  std::vector<PickCandidate> front;  // the first of the finalists
  for (const FinalDesign& d : f.result.finalists) {
    if (d.on_front) front.push_back(search::pick_candidate(f.problem, d.confirmed));
  }
  const bool usual_knee = f.pick.empty() && !f.problem.judged_at_amplitude();
  const bool by_knee = f.pick == "knee" || usual_knee ||
                       (decision.made() && decision.rule.kind == PickRule::Kind::Knee);
  if (objectives.size() < 2 || front.size() < 2 || !f.problem.driven() || by_knee) return {};
  const std::size_t other = decision.made() ? decision.by_knee : search::pick_design("knee", front);
  if (other == f.result.best || f.result.best >= front.size()) return {};
  const std::string name = design_name(f.result.finalists[other].folder);
  const Score &there = f.result.finalists[other].confirmed,
              &here = f.result.finalists[f.result.best].confirmed;
  std::vector<std::string> values;
  for (std::size_t k = 0; k < objectives.size(); ++k) {
    const std::string unit = shown_unit(objectives[k].expression).unit;
    const auto said = [&](const std::string& of, const Score& score) {
      return stated(objective_number(f, of, score, k),
                    shown_value(objectives[k].expression, score.values[k]) +
                        (unit.empty() ? "" : " " + unit));
    };
    values.push_back(fmt::format("{} {} in place of {}", objectives[k].name, said(name, there),
                                 said("what is recommended", here)));
  }
  if (f.problem.judged_at_amplitude())
    values.push_back(fmt::format("a worst modulation of {} in place of {}",
                                 worst_text(name, there.worst),
                                 worst_text("what is recommended", here.worst)));
  // The lead has the numbers on the grid of the fab where there are any; another front design has
  // none there.
  return fmt::format(
      "By the rule \"knee\", which weighs all objectives alike, {} would be built: {}{}.", name,
      join_names(values),
      worth_on_grid(f.problem, f.result) ? " (both before rounding to the grid of the fab)" : "");
}

// Dimensions that a limit leaves nothing or little: what the fab has to know first.
std::string room_text(const ResultFiles& f) {
  std::vector<std::string> none;
  for (const SheetRow& row : sheet_rows(f)) {
    const auto add = [&](const std::optional<Drift>& drift, const char* way) {
      if (!drift || drift->end != Drift::End::Limit) return;
      const double unit = find_unit(row.unit)->to_si;
      none.push_back(fmt::format(
          "{} {} {} ({})", plain_name(row.path),
          drift->most > 0
              ? "at most " +
                    stated(bare_number(fmt::format("room {} of {}", way, row.path),
                                       drift->most / unit, row.unit, kOfAStep,
                                       {Stage::Confirm, Stage::Rounding, Stage::Sensitivity}),
                           at_most(drift->most, row.unit))
              : std::string("not at all"),
          way,
          limit_of_name(f, drift->limit) +
              (drift->limit == "yield" ? ", the scatter on top of it" : "")));
    };
    add(row.down, "down");
    add(row.up, "up");
  }
  if (none.empty()) return {};
  return "The limits leave these tolerances, one dimension at a time: " + join_names(none, "; ") +
         ".";
}

}  // namespace

std::string drive_text(const ResultFiles& f) {
  std::vector<std::string> drives;
  bool driven = false;
  for (const Design& design : judged_designs(f)) {
    driven = driven || design.drive.driven();
    const std::string drive = one_drive(f, design.drive);
    if (std::find(drives.begin(), drives.end(), drive) == drives.end()) drives.push_back(drive);
  }
  return driven ? join_names(drives, " and ") : std::string();
}

std::string noticed_text() {
  return stated(bare_number("least relative difference that people notice", kNoticed, "",
                            "published (Fehlberg 2022)", {}),
                fmt::format("{:.2g}", kNoticed));
}

std::string worst_text(const std::string& of, double worst) {
  return stated(bare_number("worst modulation of " + of, worst, "", kLowest,
                            {Stage::Confirm, Stage::Rounding}),
                fmt::format("{:.3f}", worst));
}

std::string unfelt_skin_text(const ResultFiles& f) {
  const Stability& s = f.result.stability;
  const auto place = checked_place(f);
  if (!f.problem.judged_at_amplitude() || !place || !s.other_skin ||
      *s.other_skin >= s.variants.size())
    return {};
  const StabilityVariant& other = s.variants[*s.other_skin];
  if (*place >= other.worst.size() || !(other.worst[*place] < kNoticed)) return {};
  const auto best = static_cast<std::size_t>(
      std::max_element(other.worst.begin(), other.worst.end()) - other.worst.begin());
  const std::string others =
      other.worst[best] < kNoticed
          ? "nor do they that of any other design here"
          : fmt::format("{} has {} there", design_name(f.result.finalists[best].folder),
                        checked_worst(other, best));
  return fmt::format(
      " But on {} (finger \"{}\" alone, {}) its worst modulation is {}, which people do not "
      "notice, {}.",
      other.name, f.problem.tasks().front().name, checks_level(f), checked_worst(other, *place),
      others);
}

std::vector<std::string> grounds(const ResultFiles& f) {
  std::vector<std::string> out;
  const Advice advice = search::advice_of(f.problem, f.result);
  if (advice != Advice::Nothing) out = decision_grounds(f);
  if (advice == Advice::Texture) {
    if (std::string other = other_rule_text(f); !other.empty()) out.push_back(std::move(other));
  }
  for (std::string said : {film_text(f), at_risk_text(f)}) {
    if (!said.empty()) out.push_back(std::move(said));
  }
  out.push_back(conditions_text(f) + skin_text(f));
  out.push_back(model_text(f));
  // What keeps no limit is not built: limits leave it nothing.
  const std::string room = advice == Advice::Nothing ? "" : room_text(f);
  for (std::string said : {room, felt_text(f), look_text(f)}) {
    if (!said.empty()) out.push_back(std::move(said));
  }
  return out;
}

}  // namespace papilla::report
