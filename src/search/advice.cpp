#include "search/advice.h"

#include <algorithm>
#include <cmath>

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
  return flat_surface(problem, problem.space().with_own_finish(best_of(r).unit), *r.flat_before);
}

}  // namespace

std::vector<std::size_t> finish_apart(const StudyProblem& problem, const Point& a, const Point& b) {
  const std::vector<double> one = problem.space().value(a), other = problem.space().value(b);
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < one.size(); ++k) {
    // By more than the rounding of a value to the unit interval and back.
    const double rounding = kLimitTolerance * std::max(std::abs(one[k]), std::abs(other[k]));
    if (!problem.study().variables[k].path.starts_with("texture.") &&
        std::abs(one[k] - other[k]) > rounding)
      out.push_back(k);
  }
  return out;
}

std::vector<std::size_t> changed_finish(const StudyProblem& problem, const OptimiseResult& r) {
  const Point& best = best_of(r).unit;
  return finish_apart(problem, problem.space().with_own_finish(best), best);
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

std::optional<FinalDesign> best_flat(const StudyProblem& problem, const OptimiseResult& r) {
  std::vector<FinalDesign> flat;
  if (r.flat) flat.push_back(best_without_texture(problem, r));
  if (r.flat_before) flat.push_back(own_without_texture(problem, r));
  // A finalist that is one of these has numbers of another patch: one surface has one number.
  for (const FinalDesign& f : r.finalists) {
    const auto same = [&](const FinalDesign& other) {
      return finish_apart(problem, other.unit, f.unit).empty();
    };
    if (!facts(f.design.texture).relief.present && std::none_of(flat.begin(), flat.end(), same))
      flat.push_back(f);
  }
  std::erase_if(flat, [](const FinalDesign& f) { return !f.feasible; });
  if (flat.empty()) return std::nullopt;
  const bool maximise = problem.objectives().front().maximise;
  FinalDesign out =
      *std::min_element(flat.begin(), flat.end(), [&](const FinalDesign& a, const FinalDesign& b) {
        const double gain = a.confirmed.values[0] - b.confirmed.values[0];
        return maximise ? gain > 0 : gain < 0;
      });
  if (finish_apart(problem, out.unit, best_of(r).unit).empty()) return std::nullopt;
  return out;
}

}  // namespace papilla::search
