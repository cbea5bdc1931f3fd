#include "report/recommendation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "base/constants.h"
#include "base/text.h"
#include "base/units.h"
#include "design/families.h"
#include "metrics/shown.h"
#include "report/decision.h"
#include "report/grounds.h"
#include "report/limits.h"
#include "report/run_numbers.h"
#include "report/sheet.h"
#include "report/surface_changes.h"
#include "report/textures.h"
#include "report/unstable.h"
#include "report/yield.h"

namespace papilla::report {
namespace {

const FinalDesign& best_of(const ResultFiles& f) { return f.result.finalists[f.result.best]; }
Advice advice_of(const ResultFiles& f) { return search::advice_of(f.problem, f.result); }

}  // namespace

std::string finish_text(const ResultFiles& f) {
  const std::vector<double>& own = f.problem.space().own_values();
  const Point& unit = f.result.build ? f.result.build->made.unit : best_of(f).unit;
  const std::vector<double> built = f.problem.space().value(unit);
  std::vector<std::string> out;
  for (std::size_t k : changed_finish(f.problem, f.result)) {
    const Variable& v = f.study.variables[k];
    out.push_back(fmt::format("{} {} ({} in the study file)", plain_name(v.path),
                              chosen_value(v, built[k], "what is built"),
                              chosen_value(v, own[k], "the study")));
  }
  return join_names(out);
}

std::string surface_text(const ResultFiles& f, const std::string& of, const Point& unit) {
  const std::vector<double> value = f.problem.space().value(unit);
  std::vector<std::string> out;
  for (std::size_t k = 0; k < value.size(); ++k) {
    const Variable& v = f.study.variables[k];
    if (!v.path.starts_with("texture."))
      out.push_back(fmt::format("{} {}", plain_name(v.path), chosen_value(v, value[k], of)));
  }
  return join_names(out);
}

namespace {

std::vector<std::string> broken_texts(const std::vector<LimitValue>& limits) {
  std::vector<std::string> out;
  for (const LimitValue& v : limits) {
    if (!v.kept()) out.push_back(limit_broken(v));
  }
  return out;
}

std::string unstable_recommended(const ResultFiles& f) {
  const auto place = checked_place(f);
  return place ? unstable_text(f, *place) : std::string();
}

// Which numbers are not on the grid of the fab, and why.
std::string rounding_text(const ResultFiles& f) {
  if (!f.result.build) return {};
  if (f.result.build->on_grid) {
    std::vector<std::string> off;
    for (const std::string& path : off_the_grid(f)) off.push_back(plain_name(path));
    return off.empty()
               ? ""
               : fmt::format(
                     " Its {} {} off the grid of the fab ({}), which has no value within low and "
                     "high of the study: widen these, or use a finer `search.rounding`.",
                     join_names(off, " and "), off.size() == 1 ? "is" : "are", fab_grid_text(f));
  }
  if (!f.result.build->nearest)
    return fmt::format(
        " Its numbers are as searched, off the grid of the fab ({}): no design of that grid near "
        "it keeps the limits of its shape, film and look; use a finer `search.rounding`.",
        fab_grid_text(f));
  const FinalDesign& nearest = *f.result.build->nearest;
  std::vector<std::string> broken;
  if (nearest.confirmed.ok)
    broken = broken_texts(f.problem.constraints().values(nearest.design, nearest.confirmed));
  return fmt::format(
      " Its numbers are as searched, off the grid of the fab: of {} designs of the grid that were "
      "judged none keeps every limit{}; use a finer `search.rounding`.",
      judged_on_grid(*f.result.build),
      broken.empty() ? "" : " (of the nearest " + join_names(broken) + ")");
}

// Why no texture is built: of all of them where none gains, else of the best design alone.
std::string no_texture(const ResultFiles& f, const std::string& of_all, bool others_gain) {
  if (std::string unknown = textures_unknown(f); !unknown.empty()) return unknown;
  if (!others_gain) return of_all + " more than the error of the difference";
  const FinalDesign& best = best_of(f);
  return facts(best.design.texture).relief.present
             ? "the texture of " + design_name(best.folder) +
                   ", the best design, adds no more than the error of the difference"
             : design_name(best.folder) + ", the best design, has no texture";
}

// The finish and the drive as searched, where the grid of the fab moves them: "contact angle of
// water 73.27 deg"; "" where they are built so.
std::string finish_before_rounding(const ResultFiles& f) {
  const std::vector<double> searched = f.problem.space().value(best_of(f).unit),
                            built = f.problem.space().value(f.result.build->made.unit);
  std::vector<std::string> out;
  for (std::size_t k = 0; k < searched.size(); ++k) {
    const Variable& v = f.study.variables[k];
    const bool moved = std::abs(built[k] - searched[k]) > kLimitTolerance * std::abs(searched[k]);
    if (!moved || v.path.starts_with("texture.")) continue;
    out.push_back(
        plain_name(v.path) + " " +
        stated(bare_number(v.path + " as searched", searched[k] / find_unit(v.unit)->to_si, v.unit,
                           kChosen, {Stage::Confirm}),
               in_unit(searched[k], v.unit, 4)));
  }
  return join_names(out);
}

// What the built design has more or less than another surface; of numbers that the grid of the fab
// takes the gain from, what there was before.
std::string built_changes(const ResultFiles& f, const char* design, const std::string& other,
                          const Score& searched, const Score& than) {
  const auto rounded = worth_on_grid(f.problem, f.result);
  const std::string before = score_changes(f, {design, other}, searched, than);
  if (!rounded) return before;
  const std::string now = score_changes(f, {"what is built", other}, *rounded, than);
  return !now.empty() || before.empty()
             ? now
             : "changes no objective by more than the error of the difference on the grid of the "
               "fab, where before rounding it " +
                   before;
}

// The shape in the sentence is that on the grid of the fab, with the numbers of the search.
std::string not_judged_on_grid(const ResultFiles& f) {
  const bool unjudged = f.result.build && !f.result.build->made.confirmed.ok;
  return unjudged ? " These are its numbers before rounding to the grid of the fab: so rounded it "
                    "was not judged."
                  : "";
}

std::string worth_building(const ResultFiles& f) {
  const OptimiseResult& r = f.result;
  const FinalDesign& best = best_of(f);
  const auto rounded = worth_on_grid(f.problem, r);
  // The surface without texture has the finish of the search: what the texture does is of that.
  const std::string before = rounded ? finish_before_rounding(f) : "";
  std::vector<std::string> clauses;
  if (f.problem.judged_at_amplitude()) {
    const std::string over_belief = worst_over_belief(f),
                      searched =
                          worst_text("what is recommended, as searched", best.confirmed.worst),
                      flat = r.flat ? worst_text("the same surface without texture", r.flat->worst)
                                    : "",
                      fitted = over_belief.empty() ? "" : " as fitted";
    std::string said = "Its worst modulation, (F_on - F_off)/F_off, over fingers and humidity is " +
                       worst_text(scored_name(f), built_score(f).worst) + fitted;
    // Belief is judged of designs as they were searched.
    if (rounded && (!over_belief.empty() || !before.empty()))
      said += fmt::format("; before rounding{} it is {}{}",
                          before.empty() ? "" : ", with " + before + ",", searched, fitted);
    if (!over_belief.empty()) said += " and " + over_belief;
    if (r.flat)
      said += fmt::format("; without texture{} it is {}{}",
                          before.empty() ? "" : ", before rounding too,", flat, fitted);
    clauses.push_back(said + ".");
  }
  if (r.flat) {
    if (const auto broken = broken_texts(broken_without_texture(f.problem, r)); !broken.empty())
      clauses.push_back(fmt::format("Without its texture the same surface breaks a limit: {}.",
                                    join_names(broken)));
    const std::string other = "the same surface without texture",
                      same = before.empty()
                                 ? built_changes(f, "the best", other, best.confirmed, *r.flat)
                                 : score_changes(f, {"the best", other}, best.confirmed, *r.flat);
    if (!same.empty())
      clauses.push_back(fmt::format(
          "{} {}.",
          before.empty() ? "Its texture" : "Before rounding, with " + before + ", its texture",
          same));
  } else {
    clauses.push_back("The same surface without texture has no number to compare with (" +
                      r.flat_unanswered->reason + ").");
  }
  const auto flat = best_flat(f.problem, r);
  const std::string of_flat = "the best flat surface of the run";
  if (flat && surface_text(f, of_flat, flat->unit) != surface_text(f, of_flat, best.unit)) {
    const std::string both = built_changes(f, "the best", of_flat, best.confirmed, flat->confirmed);
    const std::string surface = surface_text(f, of_flat, flat->unit);
    clauses.push_back(fmt::format(
        "Against the best flat surface of this run, {}{}, it {}.", flat_name(*flat),
        surface.empty() ? "" : " (" + surface + ")",
        both.empty() ? "is no better and no worse than the error of the difference" : both));
  }
  const std::string finish = finish_text(f);
  return fmt::format("Build {} ({}){}. {}{}", design_name(best.folder), shape_text(built_design(f)),
                     finish.empty() ? "" : " with " + finish, join_names(clauses, " "),
                     not_judged_on_grid(f));
}

std::string leave_flat(const ResultFiles& f) {
  const std::string others = other_textures(f);
  std::string none = no_texture(f, "no texture or finish of this search gains", !others.empty());
  if (f.result.flat_before && !textures_unknown(f).empty())
    none += "; the finish of the best adds no more than the error of the difference";
  return fmt::format("Leave it flat: {}.{}", none, others);
}

std::string change_finish(const ResultFiles& f) {
  const OptimiseResult& r = f.result;
  const std::string others = other_textures(f),
                    none = no_texture(f, "no texture of this search adds", !others.empty());
  if (!r.flat_before) {
    return fmt::format(
        "Leave it flat: {}. What the finish does ({}) is not known: the study's own surface {}."
        "{}{}{}",
        none, finish_text(f),
        without_number(f, f.problem.space().with_own_finish(best_of(f).unit),
                       r.flat_before_unanswered),
        others, rounding_text(f), unstable_recommended(f));
  }
  std::vector<std::string> does;
  if (std::string both = built_changes(f, "the finish of the best", "that of the study",
                                       r.flat ? *r.flat : best_of(f).confirmed, *r.flat_before);
      !both.empty())
    does.push_back("that " + both);
  if (const std::vector<std::string> broken = broken_texts(broken_before(f.problem, r));
      !broken.empty())
    does.push_back("the study's own surface breaks a limit (" + join_names(broken) + ")");
  does.push_back(none);
  return fmt::format("Leave it flat and change the finish ({}): {}.{}{}{}{}", finish_text(f),
                     join_names(does, "; "), not_judged_on_grid(f), others, rounding_text(f),
                     unstable_recommended(f));
}

}  // namespace

std::string plain_name(const std::string& path) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kWords{
      {{"surface.dielectric.0.thickness", "film thickness"},
       {"surface.dielectric.1.thickness", "thickness of the second film"},
       {"surface.contact_angle", "contact angle of water"},
       {"drive.amplitude", "peak voltage"},
       {"drive.frequency", "frequency of the drive"}}};
  for (const auto& [key, words] : kWords) {
    if (path == key) return std::string(words);
  }
  constexpr std::string_view kOfTexture = "texture.";
  std::string out = path.starts_with(kOfTexture) ? path.substr(kOfTexture.size()) : path;
  if (out.size() < path.size())
    std::replace_if(
        out.begin(), out.end(), [](char c) { return c == '_' || c == '.'; }, ' ');
  return out;
}

std::string design_name(const std::string& folder) {
  constexpr std::string_view kFront = "front/";
  if (!folder.starts_with(kFront)) return folder.empty() ? "a dominated design" : folder;
  return "design " + folder.substr(kFront.size());
}

std::string flat_name(const FinalDesign& flat) {
  return flat.flat ? "that of the study file" : design_name(flat.folder);
}

FinalDesign recommended_of(const ResultFiles& f) { return recommended_design(f.problem, f.result); }

std::string judged_on_grid(const BuiltDesign& build) {
  return stated(count_number("designs of the grid that were judged", build.judged,
                             {Stage::Confirm, Stage::Rounding}),
                fmt::format("{}", build.judged));
}

std::string shape_text(const Design& design) {
  constexpr double kUpright = kPi / 2 - 1e-9;  // walls that nobody has to be told of
  Texture texture = design.texture;
  const TextureFacts of = facts(texture);
  if (!of.relief.present) return "without texture";
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
  add(role.width, array && array->deep ? "wide at the top" : "wide");
  add(role.depth, array && !array->deep ? "high" : "deep");
  add(role.period, "from one to the next");
  const double* wall = role.wall_angle;
  std::string out = measures.empty() ? kind : kind + " " + join_names(measures);
  if (role.lattice)
    out += *role.lattice == Lattice::Square ? " in a square array" : " in a hexagonal array";
  measures.clear();
  if (wall != nullptr && *wall < kUpright) add(wall, "steep");
  return measures.empty() ? out : out + ", walls " + measures.front();
}

Score built_score(const ResultFiles& f) {
  const auto rounded = worth_on_grid(f.problem, f.result);
  return rounded ? *rounded : recommended_of(f).confirmed;
}

std::string scored_name(const ResultFiles& f) {
  return worth_on_grid(f.problem, f.result) ? "what is built" : "what is recommended";
}

Design built_design(const ResultFiles& f) {
  return f.result.build ? f.result.build->made.design : recommended_of(f).design;
}

std::optional<std::size_t> recommended_place(const ResultFiles& f) {
  const FinalDesign design = recommended_of(f);
  if (search::DesignSpace::is_beside(design.unit)) return std::nullopt;
  // The surface of a textured design without its texture may be one of the finalists too, where the
  // space has surfaces without one: else it has no place among them, that of its texture least.
  Point unit = f.problem.space().snapped(design.unit);
  if (design.flat && facts(f.problem.space().design(unit).texture).relief.present) {
    const std::optional<Point> flat = f.problem.space().flattened(unit);
    if (!flat) return std::nullopt;
    unit = *flat;
  }
  for (std::size_t i = 0; i < f.result.finalists.size(); ++i) {
    if (f.result.finalists[i].unit == unit) return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> checked_place(const ResultFiles& f) {
  const auto place = recommended_place(f);
  return place && f.result.stability.judged(*place) ? place : std::nullopt;
}

std::string recommendation(const ResultFiles& f) {
  switch (advice_of(f)) {
    case Advice::Nothing:
      return "Build none of these: no design that was tried keeps every constraint.";
    case Advice::Unknown:
      return fmt::format(
          "Whether a texture is worth building is not known: the surface without it {}. What "
          "follows is of {}, the best of the front.{}",
          without_number(f, best_of(f).unit, f.result.flat_unanswered),
          design_name(best_of(f).folder),
          unsure_limits_text(f) + rounding_text(f) + unstable_recommended(f));
    case Advice::LeaveFlat:
      return leave_flat(f) + unfelt_skin_text(f);
    case Advice::Finish:
      return change_finish(f) + unfelt_skin_text(f);
    case Advice::Texture:
      break;
  }
  return worth_building(f) + unfelt_skin_text(f) + unsure_limits_text(f) + yield_sentence(f) +
         rounding_text(f) + unstable_recommended(f);
}

}  // namespace papilla::report
