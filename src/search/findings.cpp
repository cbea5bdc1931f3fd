#include "search/findings.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/units.h"
#include "design/families.h"

namespace papilla::search {
namespace {

constexpr double kAtBound = 1e-6;  // of the interval

// From the bound to the model's own limit of the number.
double room_beyond(const Design& design, const Variable& variable, bool upper) {
  Design copy = design;
  const std::vector<NumberField> known = number_fields(copy);
  const std::string path = path_in(known, variable.path);
  if (path.empty()) return kInfinity;
  const NumberField field = find_number_field(known, path);
  const double unit = find_unit(field.unit)->to_si;
  const double room = upper ? field.high * unit - variable.high : variable.low - field.low * unit;
  return room > kAtBound * (variable.high - variable.low) ? room : 0;  // units round
}

}  // namespace

std::vector<OneValue> one_value_variables(const StudyProblem& problem,
                                          const std::vector<Evaluation>& history) {
  std::vector<std::vector<double>> tried;
  for (const Evaluation& e : history) {
    if (e.outcome.ok) tried.push_back(problem.space().value(e.unit));
  }
  std::vector<OneValue> out;
  if (tried.size() < 2) return out;
  for (std::size_t k = 0; k < problem.space().size(); ++k) {
    const Dimension& d = problem.space().cube().dimensions[k];
    const bool could_move = d.choices.empty() ? d.high > d.low : d.choices.size() > 1;
    const bool moved = std::any_of(tried.begin(), tried.end(),
                                   [&](const auto& v) { return v[k] != tried.front()[k]; });
    if (could_move && !moved) out.push_back({k, tried.front()[k]});
  }
  return out;
}

TexturesTried textures_tried(const StudyProblem& problem, const std::vector<Evaluation>& history) {
  const std::vector<Constraint>& limits = problem.study().constraints;
  const Judged judged = problem.constraints().in_before_evaluation();
  TexturesTried out;
  out.breaking.resize(limits.size());
  for (const Evaluation& e : history) {
    if (!facts(problem.space().design(e.unit).texture).relief.present) continue;
    const std::vector<double>& beyond = e.outcome.constraints;
    ++out.tried;
    if (e.outcome.ok) {
      ++out.evaluated;
      out.kept += e.outcome.feasible();
    } else if (beyond.size() != judged.size() || !(e.outcome.violation() > 0)) {
      if (out.failure.empty()) out.failure = e.outcome.reason;
    } else if (++out.refused; beyond.front() > 0) {  // of no such shape the others say nothing
      if (out.impossible++ == 0) out.reason = e.outcome.reason;
    } else {
      for (std::size_t k = 1; k < judged.size(); ++k) {
        if (beyond[k] > 0) ++out.breaking[static_cast<std::size_t>(judged[k] - limits.data())];
      }
    }
  }
  return out;
}

std::vector<AtBound> variables_at_bound(const StudyProblem& problem, const Point& best,
                                        const std::vector<VariableSensitivity>& sensitivity) {
  const Study& study = problem.study();
  const Design design = problem.space().design(best);
  Design own = design;
  const std::vector<NumberField> known = number_fields(own);
  std::vector<AtBound> out;
  for (std::size_t k = 0; k < best.size(); ++k) {
    if (best[k] == DesignSpace::kBeside) continue;
    const Variable& variable = study.variables[k];
    const bool upper = best[k] >= 1 - kAtBound;
    if (!problem.space().cube().dimensions[k].choices.empty() || variable.high <= variable.low ||
        (!upper && best[k] > kAtBound))
      continue;
    // Measures of a texture that is not there lie nowhere, nor do those of another kind.
    if (!problem.space().acts(design, k) ||
        (variable.path.starts_with("texture.") &&
         !facts(part_at(design.texture, path_in(known, variable.path))).relief.present))
      continue;
    const double room = room_beyond(design, variable, upper);
    AtBound at{k, upper, upper ? variable.high : variable.low, room <= 0, 0, {}};
    for (const VariableSensitivity& s : sensitivity) {
      if (s.variable != k || s.change.empty()) continue;
      at.step = std::min(s.step, std::max(0.0, room));
      const double share = (upper ? 1 : -1) * at.step / s.step;
      for (double change : s.change) at.change.push_back(share * change);
    }
    out.push_back(std::move(at));
  }
  return out;
}

}  // namespace papilla::search
