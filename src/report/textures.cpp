#include "report/textures.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/text.h"
#include "design/families.h"
#include "metrics/shown.h"
#include "report/limits.h"
#include "report/recommendation.h"
#include "report/run_numbers.h"
#include "report/surface_changes.h"
#include "search/advice.h"
#include "search/findings.h"

namespace papilla::report {
namespace {

bool has_texture(const Design& design) { return facts(design.texture).relief.present; }

// A finalist that is a surface's finish and drive without a texture.
const FinalDesign* flat_finalist(const ResultFiles& f, const Point& surface) {
  for (const FinalDesign& d : f.result.finalists) {
    if (!has_texture(d.design) && d.confirmed.ok &&
        search::finish_apart(f.problem, d.unit, surface).empty())
      return &d;
  }
  return nullptr;
}

// A surface's confirmed numbers without its texture, where the run has them.
const Score* without_texture(const ResultFiles& f, const Point& surface) {
  const OptimiseResult& r = f.result;
  if (r.flat && search::finish_apart(f.problem, r.finalists[r.best].unit, surface).empty())
    return &*r.flat;
  if (r.flat_before &&
      search::finish_apart(f.problem, f.problem.space().with_own_finish(r.finalists[r.best].unit),
                           surface)
          .empty())
    return &*r.flat_before;
  const FinalDesign* flat = flat_finalist(f, surface);
  return flat ? &flat->confirmed : nullptr;
}

std::string count_text(const std::string& words, std::size_t count) {
  return stated(count_number(words, count, {}), fmt::format("{}", count));
}

// "min_wall at least 0.4 um by 4, aspect_ratio at most 1 by 1": how many designs break each limit
// of the study, the one that most do first.
std::string breaking_text(const ResultFiles& f, const std::vector<std::size_t>& breaking) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < breaking.size(); ++k) {
    if (breaking[k] > 0) order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return breaking[a] > breaking[b]; });
  std::vector<std::string> out;
  for (const std::size_t k : order) {
    const Constraint& limit = f.study.constraints[k];
    out.push_back(
        limit_asked(limit) + " by " +
        count_text("textures of the run that break " + limit_name(limit.on), breaking[k]));
  }
  return join_names(out);
}

// "of 4 that were tried 3 break a limit: min_wall at least 0.4 um by 3; 1 has no answer: ..."
std::string none_evaluated_text(const ResultFiles& f, const TexturesTried& t) {
  std::vector<std::string> out;
  const auto add = [&](std::size_t count, const char* one, const char* more,
                       const std::string& why) {
    if (count > 0)
      out.push_back(
          count_text(fmt::format("textures of the search, of which each {}", one), count) + " " +
          (count == 1 ? one : more) + why);
  };
  const auto first = [](std::size_t count, const std::string& reason) {
    return (count == 1 ? ": " : ", the first: ") + reason;
  };
  const std::size_t failed = t.tried - t.refused - t.evaluated;
  add(t.refused - t.impossible, "breaks a limit", "break a limit",
      ": " + breaking_text(f, t.breaking));
  add(t.impossible, "cannot be made or judged", "cannot be made or judged",
      first(t.impossible, t.reason));
  add(failed, "has no answer", "have no answer", first(failed, t.failure));
  return fmt::format("of {} that {} tried {}", count_text("textures of the search", t.tried),
                     t.tried == 1 ? "was" : "were", join_names(out, "; "));
}

// Each objective of a surface, and of the best design beside it: "mean(modulation) 0.301 where
// design 02 has 0.312".
std::string beside_best(const ResultFiles& f, const std::vector<std::string>& flat,
                        const std::vector<std::string>& best) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < flat.size(); ++k) {
    std::string& one = out.emplace_back(f.problem.objectives()[k].name + " " + flat[k]);
    if (k < best.size())
      one += fmt::format(
          " where {} has {}",
          k == 0 ? design_name(f.result.finalists[f.result.best].folder) : std::string("that"),
          best[k]);
  }
  return join_names(out);
}

// The values of the search's level, which states no error.
std::vector<std::string> searched_values(const ResultFiles& f, const std::string& of,
                                         const std::vector<double>& values) {
  std::vector<std::string> out;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const StudyObjective& o = f.problem.objectives()[k];
    const ShownUnit shown = shown_unit(o.expression);
    out.push_back(stated(
        bare_number(o.name + " of " + of + " in the search", values[k] * shown.scale, shown.unit,
                    "of the search's level, which states no error", {}),
        shown_value(o.expression, values[k]) + (shown.unit.empty() ? "" : " " + shown.unit)));
  }
  return out;
}

// What the run knows beside the comparison, for which there was no time, of a surface without
// texture: as a design of its own, else in the search.
std::string known_beside(const ResultFiles& f, const Point& surface) {
  const FinalDesign& best = f.result.finalists[f.result.best];
  const std::string name = "the surface without texture";
  if (const FinalDesign* flat = flat_finalist(f, surface)) {
    std::vector<std::string> own, others;
    for (std::size_t k = 0; k < flat->confirmed.values.size(); ++k) {
      own.push_back(objective_text(f, name, flat->confirmed, k));
      others.push_back(objective_text(f, "the best", best.confirmed, k));
    }
    return ", though as a design of its own, not on the skins of the other, it has " +
           beside_best(f, own, others);
  }
  bool another = false;
  for (const Evaluation& e : f.history.evaluations) {
    if (!e.outcome.ok || has_texture(f.problem.space().design(e.unit))) continue;
    another = true;
    if (!search::finish_apart(f.problem, e.unit, surface).empty()) continue;
    std::vector<double> values = e.outcome.objectives;
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (f.problem.objectives()[k].maximise) values[k] = -values[k];
    }
    return ", though at the coarser level of the search it has " +
           beside_best(f, searched_values(f, name, values),
                       searched_values(f, "the best", best.searched.values));
  }
  return another ? " (the flat surfaces of the search have another finish or drive)" : "";
}

}  // namespace

std::string other_textures(const ResultFiles& f) {
  const FinalDesign recommended = recommended_of(f);
  const Score& flat = recommended.confirmed;
  std::vector<std::string> out;
  bool textures_alone = true;
  for (std::size_t i = 0; i < f.result.finalists.size(); ++i) {
    const FinalDesign& d = f.result.finalists[i];
    if (!d.on_front || i == f.result.best || !has_texture(d.design)) continue;
    if (search::no_better(f.problem.objectives(), d.confirmed, flat)) continue;
    const std::string name = design_name(d.folder);
    const std::string all =
        score_changes(f, {name, "what is recommended without texture"}, d.confirmed, flat);
    if (all.empty()) continue;  // it gains no more than instruments resolve
    std::vector<std::string> finish;
    const std::vector<double> values = f.problem.space().value(d.unit);
    for (const std::size_t k : search::finish_apart(f.problem, d.unit, recommended.unit)) {
      const Variable& v = f.study.variables[k];
      finish.push_back(plain_name(v.path) + " " + chosen_value(v, values[k], name));
    }
    const Score* own = without_texture(f, d.unit);
    if (finish.empty()) {
      out.push_back(name + " " + all);
    } else if (own && !search::no_better(f.problem.objectives(), d.confirmed, *own)) {
      out.push_back(
          name + " " +
          score_changes(f, {name, "the same surface without texture"}, d.confirmed, *own) +
          " against the same surface without it");
    } else {
      textures_alone = false;
      const std::string what = "finish (" + join_names(finish) + ")";
      out.push_back(name + " " + all +
                    (own ? " by its " + what +
                               ", to which its texture adds no more than the error of the "
                               "difference"
                         : " by texture and " + what + " together"));
    }
  }
  return out.empty() ? ""
                     : fmt::format(" What other {} of the front change: {}.",
                                   textures_alone ? "textures" : "designs", join_names(out, "; "));
}

std::string textures_unknown(const ResultFiles& f) {
  std::size_t confirmed = 0;
  std::vector<std::size_t> breaking(f.study.constraints.size());
  for (const FinalDesign& d : f.result.finalists) {
    if (!has_texture(d.design) || !d.confirmed.ok) continue;
    if (d.feasible) return {};
    ++confirmed;
    const std::vector<LimitValue> values = f.problem.constraints().values(d.design, d.confirmed);
    for (std::size_t k = 0; k < values.size() && k < breaking.size(); ++k)
      breaking[k] += !values[k].kept();
  }
  if (confirmed > 0)
    return fmt::format(
        "none of the textures that were confirmed ({}) keeps every limit, broken: {}",
        count_text("textures that were confirmed", confirmed), breaking_text(f, breaking));
  const TexturesTried t = search::textures_tried(f.problem, f.history.evaluations);
  if (t.tried == 0) return "no texture was tried, so what one would gain is not known";
  if (t.evaluated == 0)
    return "no texture was evaluated, so what one would gain is not known (" +
           none_evaluated_text(f, t) + ")";
  return fmt::format(
      "no texture has confirmed numbers ({} of the {} that were evaluated in the search {} every "
      "limit at its coarser level), so what one would gain is not known at the accuracy of the "
      "study",
      count_text("textures that keep every limit in the search", t.kept),
      count_text("textures that were evaluated in the search", t.evaluated),
      t.kept == 1 ? "keeps" : "keep");
}

std::string without_number(const ResultFiles& f, const Point& surface,
                           const std::optional<Score>& asked) {
  return asked ? "has no number (" + asked->reason + ")"
               : "was not computed in the time" + known_beside(f, surface);
}

}  // namespace papilla::report
