// papilla explain FILE: what would be modelled, what not, why, at which cost and error.
#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/text.h"
#include "base/watch.h"
#include "cli/commands.h"
#include "cli/look_time.h"
#include "cli/scan_options.h"
#include "design/study.h"
#include "estimate/belief.h"
#include "estimate/target.h"
#include "forward/price.h"
#include "forward/skips.h"
#include "geometry/arrays.h"
#include "geometry/texture.h"
#include "report/response.h"
#include "search/levels.h"
#include "search/tasks.h"

namespace papilla::cli {
namespace {

// "texture.period 4 um to 12 um", "texture.type flat, grating, hole_array".
std::string range_text(const Variable& v) {
  if (v.choices.empty())
    return fmt::format("{} {} to {}", v.path, variable_text(v, v.low), variable_text(v, v.high));
  std::vector<std::string> choices;
  for (const double choice : v.choices) choices.push_back(variable_text(v, choice));
  return v.path + " " + join_names(choices);
}

// The look of the study's own design: by which theory, and what it takes in all scenarios [s].
struct LookTime {
  std::string theory;  // "": nothing asks for a look
  double each = 0;
};

// What a study varies, wants and keeps: much of it may be its base's.
std::string aims_text(const Study& study) {
  std::vector<std::string> varied, wanted, kept, fingers;
  for (const Variable& v : study.variables) varied.push_back(range_text(v));
  for (const MetricExpression& e : study.objective.maximise)
    wanted.push_back("maximise " + metric_text(e));
  for (const MetricExpression& e : study.objective.minimise)
    wanted.push_back("minimise " + metric_text(e));
  for (const Target& t : study.objective.targets)
    wanted.push_back("a target for " + metric_text(t.metric));
  for (const Constraint& c : study.constraints)
    kept.push_back(limit_name(c.on) + " " + limit_text(c));
  for (const Finger& finger : study.population) fingers.push_back(finger.name);
  std::string out = "it varies " + join_names(varied, "; ") + "\n";
  out += "it wants: " + join_names(wanted) + (kept.empty() ? "" : "; limits: " + join_names(kept)) +
         "\n";
  if (!fingers.empty()) out += "for fingers " + join_names(fingers) + "\n";
  return out +
         "everything else stays as in the file and its bases (papilla evaluate --out writes "
         "all of it: resolved.toml)\n";
}

// What `papilla optimize` would take.
std::string study_text(const StudyProblem& problem, const LookTime& look,
                       const std::vector<std::string>& warnings) {
  const Study& study = problem.study();
  const StudyCost cost = study_cost(problem);
  const int processors = processors_for(study);
  const double clock = search_pace(problem) / processors,
               looks = look.each * static_cast<double>(cost.looked_at) / processors;
  std::string out =
      aims_text(study) +
      fmt::format(
          "as a study: {} of {} each, then {} designs judged again, {} finalists and checks: {} "
          "to {} on {} as busy as this machine is now, and about {:.0f} MB a worker\n",
          counted(cost.evaluations, "evaluation"), counted(cost.tasks, "task"), cost.narrowed,
          cost.finalists, duration(kLeastOfPrice * clock * cost.seconds + looks),
          duration(kMostOfPrice * clock * cost.seconds + looks), counted(processors, "processor"),
          std::ceil(1e-6 * cost.bytes));
  if (cost.looked_at > 0)
    out += fmt::format(
        "of that the looks of {} designs take {}, if each takes what the study's own does ({} by "
        "the theory \"{}\")\n",
        cost.looked_at, duration(looks), duration(look.each), look.theory);
  if (cost.members > 0)
    out += fmt::format("of that the finalists at {} of belief take up to {}\n",
                       counted(static_cast<int>(cost.members), "member"),
                       duration(clock * cost.belief_seconds));
  out += fmt::format("it searches on {0} x {0} pixels along 12 um", cost.pixels);
  if (std::isfinite(cost.feature))
    out += fmt::format(", the smallest feature of its space, {} nm, is {:.2g} of them wide",
                       significant(1e9 * cost.feature, 3), cost.feature_pixels);
  out += '\n';
  if (cost.plates > 0)
    out += fmt::format(
        "the yield of what is built is that of {} plates within the tolerances of [scatter], by "
        "the "
        "evaluations of the design and of both ends of each tolerance: no other is made\n",
        cost.plates);
  if (study.search.time > 0)
    out += fmt::format("search.time ends it after {}: what follows the search shrinks first\n",
                       duration(study.search.time));
  for (const std::string& said : warnings) out += "warning: " + said + "\n";
  return out;
}

// What `papilla evaluate` would take here; not of designs whose skins take minutes each.
std::string time_text(const Design& design, const Fidelity& fidelity, const LookTime& look) {
  constexpr double kPatience = 20;  // [s]
  const Scene scene = scene_of(design);
  double seconds = 0;
  if (!done_within(kPatience, [&] { seconds = measured_seconds(scene, design.texture, fidelity); }))
    return fmt::format(
        "not measured on this machine: two of its skins take more than {}; the time above is that "
        "of the plan\n",
        duration(kPatience));
  std::string out = fmt::format("on this machine about {} of one core, as two of the skins tell",
                                duration(seconds));
  if (!look.theory.empty())
    out += fmt::format(", {} for the look (--appearance: with)", duration(look.each));
  if (const ModelCost cost = model_cost(scene, fidelity); cost.members > 0) {
    const auto measure = [&] {
      seconds = measured_belief_seconds(scene, design.texture, fidelity);
    };
    out += done_within(kPatience, measure) ? fmt::format(", and {}", duration(seconds))
                                           : fmt::format(", and more than {}", duration(kPatience));
    out += fmt::format(" for the {} members of the finger's belief (--no-model: without)",
                       cost.members);
  }
  return out + '\n';
}

// Rims so large that the floor cuts them: what the walls lose by it, where it moves an edge by more
// than a per cent of the features; "" elsewhere. Eq. geometry.1
std::string cut_rims(Texture texture) {
  const Outline outline = facts(texture).outline;
  const Roles role = roles(texture);
  const auto* array = std::get_if<FeatureArray>(&outline);
  if (!array || !role.depth || !role.wall_angle || !role.edge_radius) return {};
  const double depth = *role.depth, angle = *role.wall_angle, radius = *role.edge_radius;
  const double largest = depth / (1 - std::cos(angle));
  if (!(depth > 0) || radius <= largest) return {};
  const double is = width_at_half_depth(*array, {depth, angle, radius}),
               sharp = width_at_half_depth(*array, {depth, angle, 0});
  if (std::abs(is - sharp) <= 0.01 * array->width) return {};
  return fmt::format(
      "rims of {:.4g} nm end at the depth of {:.4g} nm before the wall is {:.4g} deg steep: {} are "
      "{:.3g} um wide half-way down, {:.3g} um with sharp rims; below {:.3g} nm the wall has its "
      "angle",
      1e9 * radius, 1e9 * depth, angle * 180 / kPi, array->drawn, 1e6 * is, 1e6 * sharp,
      1e9 * largest);
}

// Of a texture, or of each part of it by its section: "texture.parts.1: rims of ...".
std::vector<std::string> cut_rims_of(const Texture& texture, const std::string& section) {
  std::vector<std::string> out;
  Texture copy = texture;
  if (const std::vector<Texture>* parts = roles(copy).parts) {
    for (std::size_t i = 0; i < parts->size(); ++i) {
      for (std::string& said : cut_rims_of((*parts)[i], fmt::format("{}.parts.{}", section, i)))
        out.push_back(std::move(said));
    }
    return out;
  }
  const std::string said = cut_rims(texture);
  if (!said.empty()) out.push_back(section == "texture" ? said : section + ": " + said);
  return out;
}

int explain(const Context& context, const DesignOptions& options, bool measure) {
  const Study study = options.study();
  const Design& design = study.design;
  say_scans({design});
  const TargetOptions target{.target = design.accuracy.target,
                             .droplet_seeds = design.accuracy.droplet_seeds};
  const Fidelity fidelity = target.target > 0 ? pilot_fidelity(target) : fidelity_of(design);
  std::optional<StudyProblem> problem;
  std::vector<std::string> warnings = unused_of(study);
  LookTime look;
  if (study.is_study()) {
    problem.emplace(study);
    for (std::string& said : study_warnings(*problem)) warnings.push_back(std::move(said));
    look.theory = look_theory(*problem);
  }
  Plan plan = measure ? measured_plan(scene_of(design), design.texture, fidelity)
                      : make_plan(scene_of(design), design.texture, fidelity);
  if (!look.theory.empty()) plan = with_look(std::move(plan), look.theory);
  if (options.json) {
    std::cout << plan_document(plan) << '\n';
    return kSuccess;
  }
  if (problem) look.each = timed_look(context, *problem);
  std::string text = (design.title.empty() ? study.name : design.title) + '\n';
  if (target.target > 0) {
    text += fmt::format(
        "accuracy.target = {:.3g} %: what follows is the pilot that measures the errors; from them "
        "`evaluate` chooses load law or solved areas, at most {} pixels along 12 um and {} skins\n",
        100 * target.target, target.largest_grid, target.most_skins);
    if (study.origins.count("accuracy.level") || study.origins.count("accuracy.grid"))
      text +=
          "accuracy.level and accuracy.grid count for --sweep, --voltage-for and pictures only\n";
  }
  context.print(text + plan.text());  // before what takes its time
  text = time_text(design, fidelity, look);
  for (const std::string& line : calibration_mismatch(design)) text += "warning: " + line + '\n';
  for (const std::string& rims : cut_rims_of(design.texture, "texture"))
    text += "warning: " + rims + '\n';
  if (const std::string why = frequency_not_felt(design); design.drive.driven() && !why.empty())
    text += "frequency not felt: " + why + '\n';
  if (problem) text += study_text(*problem, look, warnings);
  context.print(text);
  return kSuccess;
}

}  // namespace

void add_explain(Command app, Context& context) {
  Command command = app.add_command(
      "explain", "The plan: what is modelled or skipped, why, expected cost and error");
  auto options = std::make_shared<DesignOptions>();
  add_design_options(command, *options);
  auto measure = std::make_shared<bool>(false);
  command.add_flag("--measure", *measure,
                   "Bounds of what is skipped from patches of this scene (seconds)");
  command.document(
      {"Prints the plan of an evaluation: which pieces of physics are modelled and by which "
       "method, "
       "which are skipped and how much that can move the result, the grid, the expected time and "
       "error. "
       "Of a study also what the search costs.",
       {{"papilla explain m3_samples/a3h600.toml", "the plan of a design"},
        {"papilla explain electroadhesive_glass/study.toml", "what a search takes"}}});
  command.on_chosen([&context, options, measure] {
    context.action = [&context, options, measure] { return explain(context, *options, *measure); };
  });
}

}  // namespace papilla::cli
