#include "search/shared.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "design/families.h"

namespace papilla::search {
namespace {

// Better in every objective by more than it may lose. Eq. search.22
bool far_better(const std::vector<StudyObjective>& objectives, const std::vector<double>& a,
                const std::vector<double>& b) {
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (b[k] - a[k] <= tolerated_loss(objectives[k], a[k])) return false;
  }
  return true;
}

std::vector<const Evaluation*> good_of(const std::vector<StudyObjective>& objectives,
                                       const std::vector<const Evaluation*>& feasible) {
  std::vector<const Evaluation*> out;
  for (const Evaluation* e : feasible) {
    if (std::none_of(feasible.begin(), feasible.end(), [&](const Evaluation* other) {
          return far_better(objectives, other->outcome.objectives, e->outcome.objectives);
        }))
      out.push_back(e);
  }
  return out;
}

// A number of a design; nothing where it has none.
using Number = std::function<std::optional<double>(const Evaluation&)>;

Number variable(const StudyProblem& problem, std::size_t k) {
  return [&problem, k](const Evaluation& e) -> std::optional<double> {
    const Variable& v = problem.study().variables[k];
    const double value = problem.space().value(e.unit)[k];
    if (v.is_kind() || v.is_levels()) return value;
    Design design = problem.space().design(e.unit);
    const std::string path = path_in(number_fields(design), v.path);
    const bool absent =
        !problem.space().acts(design, k) ||
        (path.starts_with("texture.") && !facts(part_at(design.texture, path)).relief.present);
    return absent ? std::nullopt : std::optional(value);
  };
}

std::optional<double> wall(const Design& design) {
  const double width = facts(design.texture).margins.min_wall;
  return std::isfinite(width) ? std::optional(width) : std::nullopt;
}

std::optional<double> depth_over_period(const Design& design) {
  Texture texture = design.texture;
  const Roles role = roles(texture);
  if (!facts(texture).relief.present || !role.depth || !role.period) return std::nullopt;
  return *role.depth / *role.period;
}

Number derived(const StudyProblem& problem, std::optional<double> (*of)(const Design&)) {
  return [&problem, of](const Evaluation& e) { return of(problem.space().design(e.unit)); };
}

// Over designs; nothing where none of them has it.
std::optional<SharedRange> range_of(const std::vector<const Evaluation*>& designs,
                                    const Number& number) {
  SharedRange out;
  for (const Evaluation* e : designs) {
    const auto value = number(*e);
    if (!value) continue;
    out.low = out.designs == 0 ? *value : std::min(out.low, *value);
    out.high = out.designs == 0 ? *value : std::max(out.high, *value);
    ++out.designs;
    if (std::find(out.choices.begin(), out.choices.end(), *value) == out.choices.end())
      out.choices.push_back(*value);
  }
  std::sort(out.choices.begin(), out.choices.end());
  return out.designs > 0 ? std::optional(std::move(out)) : std::nullopt;
}

}  // namespace

SharedRanges shared_ranges(const StudyProblem& problem, const JudgedDesigns& history) {
  std::vector<const Evaluation*> feasible;
  for (const Evaluation& e : history.evaluations) {
    if (e.outcome.feasible()) feasible.push_back(&e);
  }
  const std::vector<const Evaluation*> good = good_of(problem.objectives(), feasible);
  SharedRanges out{good.size(), feasible.size(), {}};
  const std::vector<Variable>& variables = problem.study().variables;
  for (std::size_t k = 0; k < variables.size(); ++k) {
    auto range = range_of(good, variable(problem, k));
    if (!range) continue;
    range->name = variables[k].path, range->unit = variables[k].unit;
    range->from = variables[k].low, range->to = variables[k].high;
    if (variables[k].choices.empty()) range->choices.clear();
    out.ranges.push_back(*std::move(range));
  }
  const auto add = [&](const char* name, const char* unit, const Number& number) {
    auto range = range_of(good, number);
    const auto all = range_of(feasible, number);
    if (!range || !(all->high > all->low)) return;
    range->name = name, range->unit = unit;
    range->from = all->low, range->to = all->high;
    range->choices.clear();
    out.ranges.push_back(*std::move(range));
  };
  add("min_wall", "um", derived(problem, wall));
  add("depth / period", "", derived(problem, depth_over_period));
  return out;
}

}  // namespace papilla::search
