#include "search/constraints.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/constants.h"
#include "design/families.h"
#include "estimate/voltage.h"

namespace papilla::search {
namespace {

constexpr const char* kFilmMargin = "oxide_breakdown_margin";

// Bounded by -1 and 11, yet larger for more: the least of large violations stays the least.
double bounded(double violation) {
  constexpr double kLarge = 10;
  if (violation > kLarge) return kLarge + 1 - kLarge / violation;
  return std::max(violation, -1.0);
}

// <= 0 when kept, relative to the limit.
double relative_violation(double value, double limit, bool at_least) {
  if (limit <= 0) return at_least ? -1 : bounded(value);
  if (!at_least) return bounded(value / limit - 1);
  return bounded(value <= 0 ? kInfinity : limit / value - 1);
}

// What a constraint of look limits.
template <class Look>
double look_value(const std::string& name, const Look& look) {
  if (name == "haze") return look.haze;
  if (name == "transmittance") return look.transmittance;
  if (name == "gloss") return look.gloss;
  return look.colour_shift;
}

// What a constraint of shape limits.
double shape_value(const std::string& name, const Design& d) {
  const FabricationMargins m = facts(d.texture).margins;
  if (name == "min_hole") return m.min_hole;
  if (name == "min_wall") return m.min_wall;
  return m.aspect_ratio;
}

// For people, and how many of it are one in SI.
std::pair<std::string, double> unit_of(const Constraint& c) {
  for (const ConstraintKind& k : constraint_kinds()) {
    if (k.name == c.name) return {k.unit, k.unit == "um" ? 1e6 : k.unit == "%" ? 100 : 1};
  }
  return {"", 1};
}

// "min_wall (at least 5.5 um)"
std::string constraint_text(const Constraint& c) {
  const auto [unit, scale] = unit_of(c);
  return fmt::format("{} (at {} {:.3g}{}{})", c.name, c.at_least ? "least" : "most",
                     c.limit * scale, unit.empty() ? "" : " ", unit);
}

std::string look_refusal(const Design& d) {
  return optics_refusal(d.texture, d.surface.refractive_index, d.view);
}

// A look that is not calculated in a millisecond, of some kind of texture.
bool slow_look(const Study& study) {
  if (!facts(study.design.texture).quick_look) return true;
  for (const Variable& v : study.variables) {
    if (!v.is_kind()) continue;
    for (double kind : v.choices) {
      if (!facts(default_texture(static_cast<std::size_t>(kind))).quick_look) return true;
    }
  }
  return false;
}

}  // namespace

StudyConstraints::StudyConstraints(const Study& study, const DesignSpace& space,
                                   const std::vector<StudyTask>& tasks, const StudyGoals& goals)
    : study_(study), space_(space), tasks_(tasks), goals_(goals), slow_look_(slow_look(study)) {}

// Why a design cannot be judged at all; "" where it can.
std::string StudyConstraints::refusal(const Design& design) const {
  const std::string trouble = shape_trouble(study_, tasks_, design);
  return trouble.empty() && goals_.looks ? look_refusal(design) : trouble;
}

double StudyConstraints::film_margin(const Design& design) const {
  if (!goals_.own_amplitude || design.drive.control != DriveControl::Voltage) return kInfinity;
  double out = bridged_margin(design.surface, design.texture, design.drive, design.drive.amplitude);
  for (const Scenario& scenario : study_.scenarios) {
    const Design d = with_settings(design, scenario.set);
    out = std::min(out, bridged_margin(d.surface, d.texture, d.drive, d.drive.amplitude));
  }
  return out;
}

std::vector<double> StudyConstraints::geometry(const Point& unit) const {
  const Design d = space_.design(unit);
  std::vector<double> out{refusal(d).empty() ? -1.0 : 1.0};
  for (const Constraint& c : study_.constraints) {
    if (needs_evaluation(c) || of_appearance(c)) continue;
    out.push_back(relative_violation(shape_value(c.name, d), c.limit, c.at_least));
  }
  if (const Constraint* film = film_limit())  // the last one: it is judged with the evaluation too
    out.push_back(relative_violation(film_margin(d), film->limit, film->at_least));
  return out;
}

bool StudyConstraints::limits_look() const {
  return std::any_of(study_.constraints.begin(), study_.constraints.end(),
                     [&](const Constraint& c) { return !needs_evaluation(c) && of_appearance(c); });
}

std::vector<double> StudyConstraints::look(const Point& unit) const {
  std::vector<double> out;
  if (!limits_look()) return out;
  const Design d = space_.design(unit);
  // A shape that cannot be judged has no numbers to compare.
  const bool judged = refusal(d).empty();
  const Optics optics = judged ? appearance_of(d) : Optics{};
  for (const Constraint& c : study_.constraints) {
    if (needs_evaluation(c) || !of_appearance(c)) continue;
    out.push_back(judged ? relative_violation(look_value(c.name, optics), c.limit, c.at_least)
                         : 1.0);
  }
  return out;
}

std::string StudyConstraints::geometry_reason(const Point& unit) const {
  const Design d = space_.design(unit);
  if (const std::string wrong = refusal(d); !wrong.empty()) return wrong;
  for (const Constraint& c : study_.constraints) {
    if (needs_evaluation(c) && &c != film_limit()) continue;
    const double value = &c == film_limit() ? film_margin(d)
                         : of_appearance(c) ? look_value(c.name, appearance_of(d))
                                            : shape_value(c.name, d);
    if (relative_violation(value, c.limit, c.at_least) <= 0) continue;
    const auto [u, scale] = unit_of(c);
    return fmt::format("{} {:.3g} {} is {} {:.3g} {}", c.name, value * scale, u,
                       c.at_least ? "below" : "above", c.limit * scale, u);
  }
  return {};
}

const Constraint* StudyConstraints::film_limit() const {
  const auto found = std::find_if(study_.constraints.begin(), study_.constraints.end(),
                                  [](const Constraint& c) { return c.name == kFilmMargin; });
  return found == study_.constraints.end() ? nullptr : &*found;
}

// Looks of arrays cost about a millisecond and steer the search itself; of others they are known
// with the evaluation.
bool StudyConstraints::needs_evaluation(const Constraint& c) const {
  return c.name == kFilmMargin || on_metric(c) || (of_appearance(c) && slow_look_);
}

// Of a refused design: the shape, its limits, the film, the look.
std::optional<std::size_t> StudyConstraints::place_refused(const Constraint& of) const {
  std::size_t place = 1;
  const auto among = [&](const auto& counts) {
    for (const Constraint& c : study_.constraints) {
      if (!counts(c)) continue;
      if (&c == &of) return true;
      ++place;
    }
    return false;
  };
  const bool found =
      among([&](const Constraint& c) { return !needs_evaluation(c) && !of_appearance(c); }) ||
      among([&](const Constraint& c) { return &c == film_limit(); }) ||
      among([&](const Constraint& c) { return !needs_evaluation(c) && of_appearance(c); });
  return found ? std::optional(place) : std::nullopt;
}

std::vector<std::string> StudyConstraints::never_kept(const std::vector<Evaluation>& tried) const {
  std::vector<std::string> out;
  std::size_t evaluated = 0;  // place in the constraints of a judged design
  for (const Constraint& c : study_.constraints) {
    const bool judged = needs_evaluation(c);
    const auto refused = place_refused(c);
    int known = 0, kept = 0;
    for (const Evaluation& e : tried) {
      const std::vector<double>& values = e.outcome.constraints;
      if (!e.outcome.ok && (!refused || *refused >= values.size())) continue;
      ++known;  // what was evaluated keeps every limit of the shape
      kept += e.outcome.ok ? !judged || values[evaluated] <= 0 : values[*refused] <= 0;
    }
    evaluated += judged;
    if (known > 0 && kept == 0) out.push_back(constraint_text(c));
  }
  return out;
}

std::size_t StudyConstraints::evaluated() const {
  return static_cast<std::size_t>(
      std::count_if(study_.constraints.begin(), study_.constraints.end(),
                    [&](const Constraint& c) { return needs_evaluation(c); }));
}

std::vector<double> StudyConstraints::violations(const Score& score) const {
  std::vector<double> out;
  std::size_t metric = 0;
  for (const Constraint& c : study_.constraints) {
    if (!needs_evaluation(c)) continue;
    const double value = on_metric(c)       ? score.limited[metric++]
                         : of_appearance(c) ? look_value(c.name, *score.look)
                                            : score.oxide_margin;
    out.push_back(relative_violation(value, c.limit, c.at_least));
  }
  return out;
}

}  // namespace papilla::search
