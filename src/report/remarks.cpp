#include "report/remarks.h"

#include <fmt/format.h>

#include "base/check.h"
#include "base/text.h"
#include "base/units.h"
#include "forward/plan.h"
#include "metrics/shown.h"

namespace papilla::report {
namespace {

// What a cut part did, and what is unsure without the rest.
struct CutWords {
  std::string did, unsure;
};

// textured: the best design has a texture.
CutWords words_of(const ClockCut& cut, const Study& study, bool textured) {
  const auto of = [&](const char* what) {
    return fmt::format("{} of {} {}", cut.done, cut.of, what);
  };
  switch (cut.part) {
    case RunPart::Search:
      return {of("evaluations"),
              fmt::format("the best of {} may lie where no design was tried",
                          counted(static_cast<int>(study.variables.size()), "variable"))};
    case RunPart::Narrow:
      return {of("designs judged again before the confirmation"),
              "a better design may have been passed over for one with lucky skins"};
    case RunPart::Confirm:
      return {of("finalists confirmed"), "those left out may be as good"};
    case RunPart::Belief:
      return {"the finalists not judged over belief",
              "which of them to build is by the numbers of the fit alone"};
    case RunPart::Stability:
      return {"the order under other models not checked",
              "other choices of the model may order the designs otherwise"};
    case RunPart::Flat:
      if (cut.done > 0 || !textured) {
        return {"the study's own surface without texture not computed",
                "what the finish does is not known"};
      }
      return {"the surface without texture not computed",
              "whether the texture helps at all is not known"};
    case RunPart::Rounding:
      return {"the rounded design not evaluated", "what rounding does is not known"};
    case RunPart::Sensitivity:
      return {"the sensitivity not computed", "tolerances are not known"};
    case RunPart::Parameters:
      if (cut.done > 0)
        return {of("designs with the finger's parameters varied"),
                "what they leave open of the others is not known"};
      return {"the finger's parameters not varied", "what they leave open is not known"};
    case RunPart::Files:
      break;
  }
  PAPILLA_CHECK(false, "a part without words");
  return {};
}

std::string clock_remark(const Study& study, const OptimiseResult& r) {
  if (r.cuts.empty()) return {};
  std::vector<std::string> did, unsure;
  const bool textured =
      r.finalists.empty() || facts(r.finalists[r.best].design.texture).relief.present;
  for (const ClockCut& cut : r.cuts) {
    CutWords words = words_of(cut, study, textured);
    did.push_back(std::move(words.did));
    unsure.push_back(std::move(words.unsure));
  }
  const bool searching = r.cuts.front().part == RunPart::Search;
  return fmt::format("{} by the clock ({}){} {}. Unsure: {}.", searching ? "Stopped" : "Cut short",
                     duration(study.search.time), searching ? " after" : ":", join_names(did, "; "),
                     join_names(unsure, "; "));
}

std::string few_remark(const StudyProblem& problem, const OptimiseResult& r) {
  if (r.evaluations >= r.asked) return {};
  const std::string made =
      fmt::format("{} where {} were asked for", counted(r.evaluations, "evaluation"), r.asked);
  switch (r.end) {
    case SearchEnd::Exhausted:
      return made + ": the search had nothing more to try.";
    case SearchEnd::Refusals:
      return fmt::format(
          "{}: the limits of the shape{} refused ten times as many designs; loosen them or narrow "
          "the design space.",
          made, problem.constraints().in_look().empty() ? "" : " and of its look");
    case SearchEnd::Asked:
      return made + ": the search was ended by request.";
    case SearchEnd::Before:
      return made +
             ": the search of the run that was resumed had ended. More of them are another run, in "
             "a folder of its own.";
    case SearchEnd::Budget:
    case SearchEnd::Clock:  // said by the remark on the clock
      break;
  }
  return {};
}

std::string one_value_remark(const Study& study, const OneValue& one, int evaluations) {
  const Variable& v = study.variables[one.variable];
  return fmt::format("{} took one value only, {}, in {}: what it does is not known.", v.path,
                     variable_text(v, one.value), counted(evaluations, "evaluation"));
}

std::string bound_remark(const Study& study, const StudyProblem& problem, const AtBound& at,
                         bool feasible) {
  const Variable& v = study.variables[at.variable];
  std::string out =
      fmt::format("{} has {} on its {} bound, {}",
                  feasible ? "What is recommended" : "What comes nearest to the limits", v.path,
                  at.upper ? "upper" : "lower", variable_text(v, at.bound));
  if (at.last) return out + ", the last value that the model takes.";
  std::vector<std::string> gains;
  for (std::size_t k = 0; k < at.change.size(); ++k) {
    const StudyObjective& o = problem.objectives()[k];
    const std::string unit = shown_unit(o.expression).unit;
    gains.push_back(o.name + " " + shown_change(o.expression, at.change[k]) +
                    (unit.empty() ? "" : " " + unit));
  }
  if (gains.empty()) return out + ": widen it to see whether more helps.";
  const double unit = find_unit(v.unit)->to_si;
  return out + fmt::format(". If the trend continues, {} {} {} would change {}.",
                           significant(at.step / unit, 2), v.unit, at.upper ? "more" : "less",
                           join_names(gains));
}

// Whether going on beyond a bound promises more than nobody would ask for.
bool promises(const StudyProblem& problem, const OptimiseResult& result, const AtBound& at) {
  constexpr double kLittle = 0.01;  // of an objective
  if (at.last || at.change.empty() || !result.has_best()) return true;
  const std::vector<double>& values = result.finalists[result.best].confirmed.values;
  for (std::size_t k = 0; k < at.change.size() && k < values.size(); ++k) {
    const double gain = problem.objectives()[k].maximise ? at.change[k] : -at.change[k];
    if (gain > kLittle * std::abs(values[k])) return true;
  }
  return values.empty();
}

}  // namespace

std::vector<std::string> run_remarks(const Study& study, const StudyProblem& problem,
                                     const OptimiseResult& result) {
  std::vector<std::string> out;
  const auto add = [&out](std::string text) {
    if (!text.empty()) out.push_back(std::move(text));
  };
  add(clock_remark(study, result));
  add(few_remark(problem, result));
  for (const OneValue& one : result.one_value)
    add(one_value_remark(study, one, result.evaluations));
  for (const AtBound& at : result.at_bound) {
    if (promises(problem, result, at)) add(bound_remark(study, problem, at, result.any_feasible));
  }
  return out;
}

}  // namespace papilla::report
