#include "search/advice.h"

namespace papilla::search {
namespace {

const FinalDesign& best_of(const OptimiseResult& r) { return r.finalists[r.best]; }

FinalDesign flat_surface(const StudyProblem& problem, const Point& unit, const Score& score) {
  FinalDesign out;
  out.unit = unit;
  out.flat = true;
  out.design = problem.space().design(unit);
  out.design.texture = Texture{};
  out.confirmed = score;
  out.feasible = problem.feasible(score, out.design);
  return out;
}

std::vector<LimitValue> broken(const StudyProblem& problem, const FinalDesign& design) {
  std::vector<LimitValue> out = problem.constraints().values(design.design, design.confirmed);
  std::erase_if(out, [](const LimitValue& v) { return v.kept(); });
  return out;
}

FinalDesign best_without_texture(const StudyProblem& problem, const OptimiseResult& r) {
  return flat_surface(problem, best_of(r).unit, *r.flat);
}

FinalDesign own_without_texture(const StudyProblem& problem, const OptimiseResult& r) {
  return flat_surface(problem, problem.space().own_surface(), *r.flat_before);
}

}  // namespace

std::vector<std::size_t> changed_finish(const StudyProblem& problem, const OptimiseResult& r) {
  const std::vector<double>& own = problem.space().own_values();
  const std::vector<double> best = problem.space().value(best_of(r).unit);
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < own.size(); ++k) {
    if (!problem.study().variables[k].path.starts_with("texture.") && own[k] != best[k])
      out.push_back(k);
  }
  return out;
}

std::vector<LimitValue> broken_without_texture(const StudyProblem& problem,
                                               const OptimiseResult& r) {
  return broken(problem, best_without_texture(problem, r));
}

std::vector<LimitValue> broken_before(const StudyProblem& problem, const OptimiseResult& r) {
  return broken(problem, own_without_texture(problem, r));
}

Advice advice_of(const StudyProblem& problem, const OptimiseResult& r) {
  if (!r.has_best() || !best_of(r).feasible) return Advice::Nothing;
  const bool textured = facts(best_of(r).design.texture).relief.present;
  if (textured && !r.flat) {
    // Pulled in, or without what is asked for, as a film that breaks down before the modulation is
    // reached: the texture is what has it. What ran out of time or failed says nothing.
    using Kind = TaskStatus::Kind;
    const bool cannot = r.flat_unanswered && (r.flat_unanswered->kind == Kind::NoEquilibrium ||
                                              r.flat_unanswered->kind == Kind::NotDefined);
    return cannot ? Advice::Texture : Advice::Unknown;
  }
  const auto beats = [&](const Score& design, const FinalDesign& other) {
    return !no_better(problem.objectives(), design, other.confirmed) ||
           !broken(problem, other).empty();
  };
  if (textured && beats(best_of(r).confirmed, best_without_texture(problem, r)))
    return Advice::Texture;
  if (!r.flat_before)
    return changed_finish(problem, r).empty() ? Advice::LeaveFlat : Advice::Finish;
  return beats(r.flat ? *r.flat : best_of(r).confirmed, own_without_texture(problem, r))
             ? Advice::Finish
             : Advice::LeaveFlat;
}

FinalDesign recommended_design(const StudyProblem& problem, const OptimiseResult& r) {
  switch (advice_of(problem, r)) {
    case Advice::Nothing:
    case Advice::Unknown:
    case Advice::Texture:
      return best_of(r);
    case Advice::LeaveFlat:
      if (r.flat_before) return own_without_texture(problem, r);
      break;
    case Advice::Finish:
      break;
  }
  const bool textured = facts(best_of(r).design.texture).relief.present;
  return textured ? best_without_texture(problem, r) : best_of(r);
}

std::optional<Score> worth_on_grid(const StudyProblem& problem, const OptimiseResult& r) {
  if (!r.build || !r.build->made.confirmed.ok ||
      r.build->made.unit == recommended_design(problem, r).unit)
    return std::nullopt;
  return r.build->made.confirmed;
}

std::optional<std::size_t> best_flat(const StudyProblem& problem, const OptimiseResult& r) {
  std::optional<std::size_t> out;
  const bool maximise = problem.objectives().front().maximise;
  for (std::size_t i = 0; i < r.finalists.size(); ++i) {
    const FinalDesign& f = r.finalists[i];
    if (!f.feasible || facts(f.design.texture).relief.present) continue;
    const double gain = out ? f.confirmed.values[0] - r.finalists[*out].confirmed.values[0] : 0;
    if (!out || (maximise ? gain > 0 : gain < 0)) out = i;
  }
  return out;
}

}  // namespace papilla::search
