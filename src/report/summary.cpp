#include "report/summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/text.h"
#include "base/units.h"
#include "metrics/shown.h"
#include "report/decision.h"
#include "report/grounds.h"
#include "report/recommendation.h"
#include "report/remarks.h"
#include "report/shared.h"
#include "report/sheet.h"
#include "report/tables.h"
#include "report/unstable.h"
#include "search/levels.h"

namespace papilla::report {
namespace {

// "0.612 ± 0.014 (0.051)": its own error, in brackets the model part.
std::string with_errors(const StudyObjective& o, const Score& score, std::size_t k) {
  std::string out = shown_with_error(o.expression, score.values[k], score.errors[k]);
  if (const auto parameters = parameter_error(score, k))
    out += fmt::format(" ({})", shown_error(o.expression, *parameters));
  return out;
}

// Of an objective: "mean(adhesion) [mN]", "distance(modulation)" as it is named.
std::string heading(const StudyObjective& o) {
  return name_with_unit(o.name, shown_unit(o.expression).unit);
}

// What decides which of the front is the best, in words.
std::string rule_text(const ResultFiles& f) {
  const Decision& d = f.result.decision;
  if (d.made() && d.designs.size() == 1) return "the one design on the front";
  if (d.made() && f.result.best == d.best) {
    return (f.problem.belief_risk().regret
                ? "the least expected regret over belief"
                : "the best over belief by \"" + f.study.risk.belief + "\"") +
           of_the_sure_text(f);
  }
  if (!f.pick.empty() && f.pick != "worst") return "picked by \"" + f.pick + "\"";
  if (f.problem.judged_at_amplitude())
    return "the highest worst modulation over fingers and humidity";
  return f.problem.driven() && f.problem.objectives().size() == 1
             ? "the best in " + f.problem.objectives().front().name
             : "the knee of the front: the least sum of its scaled objectives";
}

// Which design best/ has, and why.
std::string best_text(const ResultFiles& f) {
  const FinalDesign recommended = recommended_design(f.problem, f.result);
  const FinalDesign& best = f.result.finalists[f.result.best];
  if (recommended.flat) {
    return fmt::format(
        "\n`best/` is the flat surface that is recommended. Of the front, {} is {}; it gains no "
        "more "
        "than the error of the difference.\n",
        best.folder, rule_text(f));
  }
  return fmt::format("\n`best/` is {}: {}.\n", best.folder, rule_text(f));
}

// The step from the study's own flat surface to the best design, split into the part of the
// finish (and drive) and the part of the texture, where it has one.
std::string gain_text(const ResultFiles& f, const FinalDesign& best) {
  const OptimiseResult& r = f.result;
  const auto& objectives = f.problem.objectives();
  const bool flat_best = recommended_design(f.problem, r).flat,
             textured = facts(best.design.texture).relief.present;
  if (!textured && !r.flat_before) return {};
  std::string out = fmt::format("\n## What {}the finish does\n\n| surface |",
                                textured ? "the texture does, and what " : "");
  std::string rule = "|---|";
  for (const auto& o : objectives) {
    out += fmt::format(" {} |", heading(o));
    rule += "---|";
  }
  const bool with_worst = f.problem.judged_at_amplitude();
  out += (with_worst ? " worst modulation |\n" : "\n") + rule + (with_worst ? "---|\n" : "\n");
  const auto row = [&](const char* name, const Score& s) {
    out += fmt::format("| {} |", name);
    for (std::size_t k = 0; k < objectives.size(); ++k)
      out += fmt::format(" {} |", with_errors(objectives[k], s, k));
    out += with_worst ? fmt::format(" {:.3f} |\n", s.worst) : "\n";
  };
  if (flat_best && textured) out = "\n**" + std::string(kNoBetter) + "**\n" + out;
  if (r.flat_before) row("flat, finish and drive of the study file", *r.flat_before);
  row(r.flat_before ? "flat, finish and drive of the best design" : "flat", *r.flat);
  if (textured) row(flat_best ? "best of the front" : "best design", best.confirmed);
  bool compared = false;
  const auto difference = [&](const std::string& name, const Score& other) {
    compared = true;
    out += "| " + name + " |";
    for (std::size_t k = 0; k < objectives.size(); ++k) {
      const MetricExpression& e = objectives[k].expression;
      out += " " + shown_with_error(e, best.confirmed.values[k] - other.values[k],
                                    difference_error(best.confirmed, other, k), true);
      if (const auto part = parameter_error(best.confirmed, other, k))
        out += fmt::format(" ({})", shown_error(e, *part));
      out += " |";
    }
    out += with_worst ? " |\n" : "\n";
  };
  if (textured) difference("difference made by the texture", *r.flat);
  if (const auto rounded = worth_on_grid(f.problem, r))
    row(flat_best ? "the flat surface, rounded to the grid of the fab"
                  : "best design, rounded to the grid of the fab",
        *rounded);
  if (const auto flat = best_flat(f.problem, r)) {
    // That of the study file is the first row.
    if (!flat->flat)
      row(("best flat surface of this run, " + flat_name(*flat)).c_str(), flat->confirmed);
    difference("difference from the best flat surface, " + flat_name(*flat), flat->confirmed);
  }
  if (compared)
    out +=
        "\n± of the difference is from both on the same skins, droplets and grid, skin by "
        "skin: what moves both alike is not in it (the larger of both where their numbers of skins "
        "differ).\n";
  if (r.flat_before) {
    out += "\nFrom the first row to the second is the finish (and drive)";
    out += textured ? ", from the second to the third the texture.\n" : ".\n";
  }
  return out;
}

// Whether the accuracy asked for was reached, of each finger of the best design.
std::string target_text(const ResultFiles& f, const FinalDesign& best) {
  if (!(f.study.design.accuracy.target > 0)) return {};
  std::string out =
      fmt::format("\nAccuracy asked for (`accuracy.target`): {:.3g} %. Of the best design",
                  100 * f.study.design.accuracy.target);
  for (std::size_t t = 0; t < best.confirmed.reports.size(); ++t) {
    const auto response = nlohmann::json::parse(best.confirmed.reports[t]);
    const auto found = response.find("accuracy");
    if (found == response.end() || !found->at("reached").is_number()) continue;
    out += fmt::format("{} {}: {:.2g} % of {}, {}", t > 0 ? ";" : "", f.problem.tasks()[t].name,
                       100 * found->at("reached").get<double>(),
                       found->at("quantity").get<std::string>(),
                       found->at("status").get<std::string>());
  }
  return out + ".\n";
}

// Of one finger, of one choice of the model and of one step.
std::string level_of_checks(const ResultFiles& f) {
  const Fidelity level = stage_fidelity(f.problem, Stage::Stability);
  return fmt::format("{} pixels, {} skins, common random numbers", level.grid, level.skins);
}

std::string sensitivity_text(const ResultFiles& f) {
  if (f.result.sensitivity.empty()) return {};
  const auto& objectives = f.problem.objectives();
  std::string out =
      "\n## What the best design is sensitive to\n\nEach continuous variable alone, by 5 % of "
      "its "
      "range (" +
      level_of_checks(f) +
      "). Share: of the objective's variance "
      "if every "
      "variable scattered so. Tolerance: how far it may be off before " +
      tolerance_end_text(f) + ".\n\n| variable | step";
  for (const StudyObjective& o : objectives) out += fmt::format(" | {}, share", heading(o));
  out += " | tolerance down | up |\n|---|---";
  for (std::size_t k = 0; k < objectives.size(); ++k) out += "|---";
  out += "|---|---|\n";
  for (const VariableSensitivity& s : f.result.sensitivity) {
    const Variable& v = f.study.variables[s.variable];
    const double unit = find_unit(v.unit)->to_si;
    out += fmt::format("| {} | {} {}", v.path, significant(s.step / unit, 3), v.unit);
    for (std::size_t k = 0; k < objectives.size(); ++k) {
      out += k < s.change.size() ? fmt::format(" | {}, {:.0f} %",
                                               shown_change(objectives[k].expression, s.change[k]),
                                               100 * s.share[k])
                                 : std::string(" | -");
    }
    out += " | " + drift_text(s.down, v.unit) + " | " + drift_text(s.up, v.unit) + " |\n";
  }
  return out;
}

// How the finalists fare on each finger alone and under other choices of the model.
std::string stability_text(const ResultFiles& f) {
  const Stability& s = f.result.stability;
  const auto& objectives = f.problem.objectives();
  const std::size_t judged = s.times_on_front.size();
  if (!s.has_order()) return {};
  std::string out =
      "\n## Does the order hold?\n\nEach design of the front on each finger alone, then on the "
      "first finger "
      "with another state of its skin or one choice of the model changed (" +
      level_of_checks(f) + "; " + objectives.front().name +
      (objectives.size() > 1 ? ", " + objectives[1].name : "") +
      "; * on the front of these designs: it keeps every limit, and none is better in all "
      "objectives by more than the error of their difference" +
      (f.problem.constraints().evaluated() == 0
           ? ""
           : "; a limit is judged by its confirmed number, moved as the change moves that of this "
             "level, so that it may differ from an objective beside it") +
      "):\n\n|";
  for (std::size_t i = 0; i < judged; ++i)
    out += " | " +
           (f.result.finalists[i].folder.empty() ? "(dominated)" : f.result.finalists[i].folder);
  out += " |\n|---";
  for (std::size_t i = 0; i < judged; ++i) out += "|---";
  out += "|\n";
  for (const StabilityVariant& v : s.variants) {
    out += "| " + v.name;
    for (std::size_t i = 0; i < v.values.size(); ++i) {
      out += " |";
      for (std::size_t k = 0; k < std::min<std::size_t>(2, v.values[i].size()); ++k) {
        out += k == 0 ? " " : ", ";
        out += shown_value(objectives[k].expression, v.values[i][k]);
      }
      if (v.values[i].empty()) out += " no value";
      if (i < v.broken.size()) {
        for (const LimitValue& limit : v.broken[i]) {
          out += fmt::format(", breaks {} ({})", limit_name(limit.limit.on),
                             limit_value_text(limit.limit, limit.value));
        }
      }
      out += v.on_front[i] ? " *" : "";
    }
    out += " |\n";
  }
  out += "| **on the front** |";
  for (std::size_t i = 0; i < judged; ++i) {
    out += fmt::format(" {} of {}{} |", s.times_on_front[i], s.variants.size(),
                       s.stable(i) ? "" : ", **unstable**");
  }
  out += "\n";
  for (std::size_t i = 0; i < judged; ++i) {
    if (const std::string why = unstable_text(f, i); !why.empty())
      out += "\n- " + design_name(f.result.finalists[i].folder) + ":" + why;
  }
  return out + "\n";
}

}  // namespace

std::string run_summary(const ResultFiles& f) {
  const OptimiseResult& r = f.result;
  std::string out =
      "# " + (f.study.design.title.empty() ? f.study.name : f.study.design.title) + "\n\n";
  if (r.interrupted) {
    return out + fmt::format("Interrupted after {}; continue with --resume.\n",
                             counted(r.evaluations, "evaluation"));
  }
  for (const std::string& remark : run_remarks(f.study, f.problem, r))
    out.append("**").append(remark).append("**\n\n");
  out += fmt::format("Search: {} ({}). {}", r.method, r.why, counted(r.evaluations, "evaluation"));
  if (r.refused) out += fmt::format(", {} refused by the fabrication limits", r.refused);
  if (r.failures) out += fmt::format(", **{} failed** (history.csv says why)", r.failures);
  out += ".\n\n";
  if (r.finalists.empty()) {
    return out +
           "**No design could be evaluated**: every one failed; history.csv says why for each.\n";
  }
  if (!r.any_feasible) {
    out += "**No design keeps every constraint**: " + infeasible_text(r) +
           ". The one that violates them least is shown; loosen a constraint or widen the design "
           "space.\n\n";
  }
  if (r.has_best()) out += sheet_text(f) + "\n";
  out += result_table(f.study, r);
  const FinalDesign& best = r.finalists[r.best];
  out += target_text(f, best);
  if (best.on_front) out += best_text(f);
  if (r.flat && best.confirmed.ok) out += gain_text(f, best);
  out += decision_text(f);
  out += stability_text(f);
  out += sensitivity_text(f);
  out += shared_text(f);
  out += r.has_best()
             ? "\nFiles: report.html (all of this with charts), pareto.csv (finalists), "
               "history.csv (every evaluation), run.json (how it ended, what to build), front/ and "
               "best/, what is recommended (design.toml, metrics.json, heightmap.exr, "
               "heightmap.gsf, preview.png, of textures with an outline mask.tif "
               "(white is deep), export.json for `papilla verify`; in best/ also build.toml, on "
               "the grid of the fab, which its maps and its mask are of), "
               "sensitivity.json, "
               "resolved.toml (every value and where it came from), plan.txt, journal.\n"
             : "\nFiles: pareto.csv (finalists), history.csv (every evaluation), resolved.toml "
               "(every value and where it came from), plan.txt, journal.\n";
  return out;
}

std::string result_table(const Study& study, const OptimiseResult& result) {
  const StudyProblem problem(study);
  const auto& objectives = problem.objectives();
  std::string out = "Finalists, confirmed on fresh skins at level \"" +
                    study.design.accuracy.level_name() + "\":\n\n| design";
  for (const Variable& v : study.variables) out += " | " + v.path;
  for (const StudyObjective& o : objectives)
    out += fmt::format(" | {} {}", o.maximise ? "max" : "min", heading(o));
  const bool with_worst = problem.judged_at_amplitude();
  if (with_worst) out += " | worst modulation";
  for (const Constraint& c : study.constraints)
    out += fmt::format(" | {} {}", limit_name(c.on), limit_text(c));
  out += " |\n|";
  const std::size_t columns =
      study.variables.size() + objectives.size() + (with_worst ? 2 : 1) + study.constraints.size();
  for (std::size_t i = 0; i < columns; ++i) out += "---|";
  out += "\n";
  for (const FinalDesign& d : result.finalists) {
    out += "| " + (!d.folder.empty() ? d.folder : d.feasible ? "(dominated)" : "(infeasible)");
    if (!d.folder.empty() && !d.feasible) out += " (infeasible)";
    const std::vector<double> values = problem.space().value(d.unit);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const Variable& v = study.variables[i];
      out += " | " + (is_shown(problem, d.design, i) ? variable_text(v, values[i]) : std::string());
    }
    for (std::size_t k = 0; k < objectives.size(); ++k) {
      out += fmt::format(" | {}",
                         d.confirmed.ok ? with_errors(objectives[k], d.confirmed, k) : "failed");
    }
    if (with_worst) out += d.confirmed.ok ? fmt::format(" | {:.3f}", d.confirmed.worst) : " |";
    for (const LimitValue& v : limit_values(problem, d))
      out += " | " + limit_value_text(v.limit, v.value) + (v.kept() ? "" : ", **broken**");
    for (std::size_t i = 0; i < study.constraints.size() && !d.confirmed.ok; ++i) out += " |";
    out += " |\n";
  }
  const std::string unknown = problem.parameters_unknown();
  if (!unknown.empty())
    return out + fmt::format("\nWhat is not known of finger and model is in no ±: {}.\n", unknown);
  constexpr const char* kNumerical =
      "\n± is numerical: one standard error of skins, droplets, grid and method";
  const auto has_model_part = [&](const FinalDesign& d) {
    for (std::size_t k = 0; d.confirmed.ok && k < objectives.size(); ++k) {
      if (parameter_error(d.confirmed, k)) return true;
    }
    return false;
  };
  if (std::none_of(result.finalists.begin(), result.finalists.end(), has_model_part))
    return out + kNumerical +
           ". What is not known of finger and model was judged of no design here.\n";
  out += fmt::format(
      "{}. In brackets{} the "
      "model part, what {} leaves open, one standard deviation, common to all designs",
      kNumerical,
      study.design.accuracy.parameters || problem.has_belief()
          ? ""
          : ", of the best design (all: `[accuracy] parameters = true`),",
      problem.model_source());
  // Common is not cancelled: a design may answer to the finger as its flat surface does not.
  std::vector<std::string> better, worse;
  for (std::size_t k = 0; result.has_best() && result.flat && k < objectives.size(); ++k) {
    const Score& best = result.finalists[result.best].confirmed;
    const auto own = parameter_error(best, k), flat = parameter_error(*result.flat, k),
               both = parameter_error(best, *result.flat, k);
    if (both) (*both < std::min(*own, *flat) ? better : worse).push_back(objectives[k].name);
  }
  if (!better.empty())
    out += "; the gain over flat is less uncertain by it than the values in " + join_names(better);
  if (!worse.empty())
    out += "; the gain over flat is as uncertain by it as the values in " + join_names(worse);
  return out + ".\n";
}

bool is_shown(const StudyProblem& problem, const Design& design, std::size_t variable) {
  const Variable& v = problem.study().variables[variable];
  if (!v.path.starts_with("texture.") || v.is_kind()) return true;
  return facts(design.texture).relief.present && problem.space().acts(design, variable);
}

std::vector<LimitValue> limit_values(const StudyProblem& problem, const FinalDesign& design) {
  if (!design.confirmed.ok) return {};
  return problem.constraints().values(design.design, design.confirmed);
}

std::string infeasible_text(const OptimiseResult& result) {
  std::string names;
  for (const std::string& name : result.never_kept) names += (names.empty() ? "" : ", nor ") + name;
  return names.empty() ? "each is kept by some design that was tried, but not all by one"
                       : "no design of the space that was tried keeps " + names;
}

}  // namespace papilla::report
