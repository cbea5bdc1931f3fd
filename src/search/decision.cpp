#include "search/decision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "config/describe.h"
#include "numerics/statistics.h"
#include "search/run.h"

namespace papilla::search {
namespace {

// A task's confirmed answer at a member; the first that is refused of those that it is made of.
TaskAnswer moved_answer(const StudyGoals& goals, const TaskAnswer& confirmed, const TaskAnswer& own,
                        const TaskAnswer& there) {
  if (!confirmed.status.ok()) return confirmed;
  if (!own.status.ok()) return own;
  if (!there.status.ok()) return there;
  TaskAnswer out = confirmed;
  out.samples.clear();
  out.model.clear();
  for (std::size_t k = 0; k < goals.objectives.size(); ++k) {
    const StudyObjective& o = goals.objectives[k];
    TaskObjective& number = out.objectives[k];
    const TaskObjective &from = own.objectives[k], &to = there.objectives[k];
    number.value = moved(number.value, from.value, to.value,
                         o.aimed || keeps_sign(o.expression.summary, o.expression.metric));
    const bool keeps = keeps_sign(Summary::Mean, o.expression.metric);
    for (std::size_t i = 0; i < number.points.size(); ++i)
      number.points[i] = moved(number.points[i], from.points[i], to.points[i], keeps);
  }
  move_limits(goals, confirmed, own, there, out);
  out.worst = moved(out.worst, own.worst, there.worst, true);
  return out;
}

// What one of the skins behind a number moves it by.
double skin_move(const std::vector<double>& samples, std::size_t skin) {
  return skin < samples.size() ? error_moves(samples)[skin] : 0;
}

// The answer with each of its numbers moved by what `move` says of the samples behind it.
template <class Move>
TaskAnswer moved_by(const StudyGoals& goals, const TaskAnswer& answer, const Move& move) {
  TaskAnswer out = answer;
  for (std::size_t k = 0; k < answer.samples.size(); ++k) {
    TaskObjective& o = out.objectives[k];
    if (goals.by_points(k)) {
      for (std::size_t i = 0; i < o.points.size(); ++i) o.points[i] += move(answer.samples[k][i]);
    } else {
      o.value += move(answer.samples[k][0]);
    }
  }
  out.worst += move(answer.worst_samples);
  out.samples.clear();
  return out;
}

TaskAnswer by_skin(const StudyGoals& goals, const TaskAnswer& answer, std::size_t skin) {
  return moved_by(goals, answer,
                  [&](const ErrorSamples& of) { return skin_move(of.sampling, skin); });
}

// By a standard error of what few skins say of the correction to the 3-D field.
TaskAnswer by_own_field(const StudyGoals& goals, const TaskAnswer& answer) {
  return moved_by(goals, answer, [](const ErrorSamples& of) { return of.field.own; });
}

// How far the corrections of two confirmed designs are off alike: by the first objective that has
// some, over all tasks and humidities.
double field_correlation(const Score& a, const Score& b) {
  for (std::size_t k = 0; k < std::min(a.samples.size(), b.samples.size()); ++k) {
    if (!a.samples[k].field.corrections.empty())
      return metrics::field_correlation(a.samples[k].field, b.samples[k].field);
  }
  return 0;
}

// As members move the number that a rule goes by. Eq. accuracy.15
bool moves_in_proportion(const StudyProblem& problem, const PickRule& rule) {
  if (rule.kind != PickRule::Kind::Objective) return rule.kind == PickRule::Kind::Worst;
  const StudyObjective& o = problem.objectives()[rule.index];
  return o.aimed || keeps_sign(o.expression.summary, o.expression.metric);
}

std::size_t skins_behind(const TaskAnswer& answer) {
  std::size_t out = answer.worst_samples.sampling.size();
  for (const std::vector<ErrorSamples>& objective : answer.samples) {
    for (const ErrorSamples& number : objective) out = std::max(out, number.sampling.size());
  }
  return out;
}

// Of a limit on the shape or its look: finger and model change nothing of them.
bool is_of_the_surface(const Constraint& limit) {
  return std::holds_alternative<ShapeLimit>(limit.on) ||
         std::holds_alternative<LookLimit>(limit.on);
}

bool keeps_limits(const StudyProblem& problem, const FinalDesign& design, const Score& there) {
  return problem.feasible(there, design.design);
}

// Better in every objective and, where it counts, in the worst modulation, of two that are judged;
// what breaks a limit beats none that keeps all.
bool beats(const StudyProblem& problem, const FinalDesign& a, const Score& of_a,
           const FinalDesign& b, const Score& of_b) {
  if (!of_a.ok || !of_b.ok) return of_a.ok;
  if (!keeps_limits(problem, a, of_a) && keeps_limits(problem, b, of_b)) return false;
  const Outcome better = problem.outcome(of_a), worse = problem.outcome(of_b);
  for (std::size_t k = 0; k < better.objectives.size(); ++k) {
    if (better.objectives[k] >= worse.objectives[k]) return false;
  }
  return !problem.judged_at_amplitude() || of_a.worst > of_b.worst;
}

// Whether b is better than a at a member in something that designs are compared in, or keeps limits
// that a breaks there. Where neither has an answer the member tells them not apart, Eq. search.15.
// in: worth by everything that designs are compared in.
bool holds_against(const std::vector<MemberWorth>& in, std::size_t b, std::size_t a,
                   std::size_t m) {
  const auto known = [&](std::size_t i) { return !std::isnan(in.front().worth[i][m]); };
  if (!known(a) || !known(b)) return known(b);
  if (!in.front().keeps(a, m) && in.front().keeps(b, m)) return true;
  return std::any_of(in.begin(), in.end(),
                     [&](const MemberWorth& of) { return of.worth[a][m] <= of.worth[b][m]; });
}

std::vector<MemberGroup> hypotheses_of(const Belief& belief) {
  std::vector<MemberGroup> out;
  for (std::size_t m = 0; m < belief.members.size(); ++m) {
    const std::string& name = belief.members[m].hypothesis;
    auto group =
        std::find_if(out.begin(), out.end(), [&](const MemberGroup& g) { return g.name == name; });
    if (group == out.end()) group = out.insert(out.end(), {name, {}});
    group->members.push_back(m);
  }
  return out.size() > 1 ? out : std::vector<MemberGroup>{};
}

// Why a design of the front has no members, and what to do about it.
std::string unjudged_text(const FinalDesign& f) {
  if (f.unjudged.empty())
    return "the members of belief were not evaluated in the time: give the search more time "
           "(`search.time`), or less to evaluate";
  return fmt::format(
      "{} has no answer at the members of belief ({}), and --resume asks no task again: give each "
      "task less to evaluate (`accuracy.level`), or memory for fewer at a time (`search.jobs`), "
      "with another --out folder",
      f.folder, f.unjudged);
}

// Of the finger, those that are not the same in all members; of a list its first that moves.
std::vector<MemberNumber> numbers_of(const Belief& belief, const Scene& scene) {
  std::vector<MemberNumber> all;
  for (const BeliefMember& member : belief.members) {
    MemberScene moved = with_member(belief, member, scene.finger, scene.model);
    for (const NumberField& field : number_fields(moved.finger)) {
      auto known = std::find_if(all.begin(), all.end(),
                                [&](const MemberNumber& n) { return n.path == field.path; });
      if (known == all.end()) known = all.insert(all.end(), {field.path, {}});
      known->values.push_back(*field.value);
    }
  }
  std::erase_if(all, [&](const MemberNumber& n) {
    return n.values.size() < belief.members.size() ||
           std::all_of(n.values.begin(), n.values.end(),
                       [&](double v) { return v == n.values.front(); });
  });
  return all;
}

}  // namespace

MemberWorth member_worth(const StudyProblem& problem, const std::vector<FinalDesign>& designs,
                         const PickRule& rule, const std::vector<ObjectiveRange>& ranges) {
  MemberWorth out;
  for (const BeliefMember& m : problem.belief()->members) out.weights.push_back(m.weight);
  const auto worth_of = [&](const Score& score) {
    return score.ok ? pick_worth(rule, pick_candidate(problem, score), ranges) : std::nan("");
  };
  const auto skinned = [&](const Score& score, const std::vector<Score>& by_skin) {
    WorthBySkin of{worth_of(score)};
    for (const Score& moved : by_skin) of.by_skin.push_back(worth_of(moved) - of.worth);
    return of;
  };
  std::vector<WorthBySkin> confirmed, few;
  for (const FinalDesign& f : designs) {
    confirmed.push_back(skinned(f.confirmed, f.confirmed_by_skin));
    few.push_back(skinned(f.few.back().score, f.few.back().by_skin));
    std::vector<double>& values = out.worth.emplace_back();
    std::vector<std::vector<double>>& by_skin = out.by_skin.emplace_back();
    std::vector<std::vector<bool>>& kept = out.kept.emplace_back(
        problem.study().constraints.size(), std::vector<bool>(f.members.size(), false));
    for (std::size_t m = 0; m < f.members.size(); ++m) {
      const Score& there = f.members[m];
      const WorthBySkin alone = skinned(f.few[m].score, f.few[m].by_skin);
      values.push_back(there.ok ? alone.worth : std::nan(""));
      by_skin.push_back(alone.by_skin);
      // Where there is no answer, a limit that needs one is not kept.
      const Score& known = there.ok ? there : f.confirmed;
      if (!known.ok) continue;
      const std::vector<LimitValue> limits = problem.constraints().values(f.design, known);
      for (std::size_t k = 0; k < kept.size(); ++k)
        kept[k][m] = (there.ok || is_of_the_surface(limits[k].limit)) && limits[k].kept();
    }
  }
  const bool in_proportion = moves_in_proportion(problem, rule);
  combine_levels(confirmed, few, in_proportion, out);
  shrink_moves(confirmed, in_proportion, out);
  std::vector<double> own;  // of the worth
  std::vector<std::vector<double>> alike(designs.size());
  for (std::size_t i = 0; i < designs.size(); ++i) {
    const double move = worth_of(designs[i].confirmed_by_field) - confirmed[i].worth;
    own.push_back(std::isfinite(move) ? move : 0);
    for (const FinalDesign& other : designs)
      alike[i].push_back(field_correlation(designs[i].confirmed, other.confirmed));
  }
  add_field_moves(confirmed, own, alike, in_proportion, out);
  return out;
}

PickCandidate pick_candidate(const StudyProblem& problem, const Score& score) {
  PickCandidate out;
  for (const StudyObjective& o : problem.objectives()) out.names.push_back(o.name);
  out.objectives = problem.minimised(score);
  if (problem.judged_at_amplitude()) out.worst = score.worst;
  out.errors = score.errors;
  return out;
}

std::vector<ObjectiveRange> ranges_over_belief(const std::vector<PickCandidate>& front,
                                               const std::vector<MemberWorth>& by_objective) {
  std::vector<ObjectiveRange> out;
  for (std::size_t k = 0; k < by_objective.size(); ++k) {
    const MemberWorth& of = by_objective[k];
    std::vector<PickCandidate> there;  // in this objective alone
    for (const PickCandidate& c : front) {
      there.push_back({{c.names[k]}, {c.objectives[k]}});
      if (k < c.errors.size()) there.back().errors = {c.errors[k]};
    }
    double width = 0, weight = 0;
    for (std::size_t m = 0; m < of.weights.size(); ++m) {
      std::vector<PickCandidate> known;
      for (std::size_t i = 0; i < there.size(); ++i) {
        if (std::isnan(of.worth[i][m])) continue;
        known.push_back(there[i]);
        known.back().objectives = {-of.worth[i][m]};
      }
      if (known.empty()) continue;
      width += of.weights[m] * objective_ranges(known)[0].width;
      weight += of.weights[m];
    }
    out.push_back(objective_ranges(there)[0]);
    if (weight > 0) out.back().width = width / weight;
  }
  return out;
}

void add_members(const StudyProblem& problem, const std::vector<TaskAnswer>& answers,
                 FinalDesign& design) {
  const std::size_t nominal = problem.nominal_tasks(), scatter = problem.study().scatter.size();
  const std::size_t members = problem.belief()->members.size(), tasks = design.answers.size();
  const StudyGoals& goals = problem.goals();
  const std::vector<TaskAnswer>& confirmed = design.answers;
  const auto nominal_of = [&](std::size_t t) {
    return t < nominal ? t : (t - nominal) / (2 * scatter);
  };
  const auto as_it_is = [&](std::size_t t) { return answers[nominal_of(t)].members.back(); };
  const auto at_member = [&](std::size_t t, std::size_t member) {
    const std::vector<TaskAnswer>& of = answers[nominal_of(t)].members;
    return member + 1 < of.size() ? of[member]
                                  : TaskAnswer::refused(TaskStatus::Kind::NotDefined, "no answer");
  };
  // there: the answer of a task, once each of the skins has moved it.
  const auto skinned = [&](auto&& there) {
    const auto score = [&](auto&& by) {
      std::vector<TaskAnswer> all;
      for (std::size_t t = 0; t < tasks; ++t) all.push_back(there(t, by));
      return problem.score_without_yield(all);
    };
    ScoreBySkin out{score([](const TaskAnswer& a) { return a; }), {}};
    std::size_t skins = 0;
    for (std::size_t t = 0; t < nominal; ++t) {
      there(t, [&](const TaskAnswer& a) {
        skins = std::max(skins, skins_behind(a));
        return a;
      });
    }
    for (std::size_t skin = 0; skin < skins && out.score.ok; ++skin)
      out.by_skin.push_back(score([&](const TaskAnswer& a) { return by_skin(goals, a, skin); }));
    return out;
  };
  design.confirmed_by_skin =
      skinned([&](std::size_t t, auto&& by) { return by(confirmed[t]); }).by_skin;
  std::vector<TaskAnswer> by_field;
  for (const TaskAnswer& a : confirmed) by_field.push_back(by_own_field(goals, a));
  design.confirmed_by_field = problem.score_without_yield(by_field);
  for (std::size_t m = 0; m < members; ++m) {
    std::vector<TaskAnswer> moved;
    for (std::size_t t = 0; t < tasks; ++t)
      moved.push_back(moved_answer(goals, confirmed[t], as_it_is(t), at_member(t, m)));
    design.members.push_back(problem.score(design.design, moved));
  }
  for (std::size_t m = 0; m <= members; ++m) {
    design.few.push_back(skinned([&](std::size_t t, auto&& by) {
      const TaskAnswer there = by(m < members ? at_member(t, m) : as_it_is(t));
      // Scatter of fabrication moves a member as it moves what is designed.
      return t < nominal ? there
                         : moved_answer(goals, there, confirmed[nominal_of(t)], confirmed[t]);
    }));
  }
}

std::vector<bool> on_front_of_belief(const StudyProblem& problem,
                                     const std::vector<FinalDesign>& finalists) {
  std::vector<bool> out(finalists.size(), false);
  std::vector<std::size_t> place;
  std::vector<FinalDesign> asked;
  for (std::size_t i = 0; i < finalists.size(); ++i) {
    if (finalists[i].members.empty()) {
      out[i] = finalists[i].on_front;
      continue;
    }
    place.push_back(i);
    asked.push_back(finalists[i]);
  }
  if (asked.empty()) return out;
  std::vector<PickRule> rules;
  for (std::size_t k = 0; k < problem.objectives().size(); ++k)
    rules.push_back({PickRule::Kind::Objective, k});
  if (problem.judged_at_amplitude()) rules.push_back({PickRule::Kind::Worst});
  std::vector<MemberWorth> worth;
  for (const PickRule& rule : rules) worth.push_back(member_worth(problem, asked, rule, {}));
  const auto beaten_by = [&](std::size_t b, std::size_t a) {
    if (!beats(problem, asked[a], asked[a].confirmed, asked[b], asked[b].confirmed)) return false;
    for (std::size_t m = 0; m < worth.front().weights.size(); ++m) {
      if (holds_against(worth, b, a, m)) return false;
    }
    return true;
  };
  for (std::size_t b = 0; b < asked.size(); ++b) {
    bool beaten = false;
    for (std::size_t a = 0; a < asked.size() && !beaten; ++a) beaten = a != b && beaten_by(b, a);
    out[place[b]] = !beaten;
  }
  return out;
}

PickRule decision_rule(const StudyProblem& problem, const std::string& rule) {
  std::vector<std::string> names;
  for (const StudyObjective& o : problem.objectives()) names.push_back(o.name);
  return decided_rule(rule, names, problem.judged_at_amplitude());
}

ShownUnit unit_of_worth(const StudyProblem& problem, const PickRule& rule) {
  if (rule.kind != PickRule::Kind::Objective) return {};
  return shown_unit(problem.objectives()[rule.index].expression);
}

Decision decide(const StudyProblem& problem, const std::vector<FinalDesign>& finalists,
                const std::string& rule) {
  Decision out;
  out.absent = problem.belief_absent();
  if (!out.absent.empty()) return out;
  std::vector<FinalDesign> front;
  std::vector<PickCandidate> candidates;
  for (const FinalDesign& f : finalists) {
    if (!f.on_front) break;
    front.push_back(f);
    candidates.push_back(pick_candidate(problem, f.confirmed));
    if (f.members.empty() && out.absent.empty()) out.absent = unjudged_text(f);
  }
  if (front.empty()) out.absent = "no finalist keeps every limit";
  if (!out.absent.empty()) return out;
  const Belief& belief = *problem.belief();
  out.members = belief.members.size();
  out.effective_members = belief.effective_members();
  out.rule = decision_rule(problem, rule);
  std::vector<MemberWorth> by_objective;
  for (std::size_t k = 0; k < problem.objectives().size(); ++k)
    by_objective.push_back(member_worth(problem, front, {PickRule::Kind::Objective, k}, {}));
  out.ranges = ranges_over_belief(candidates, by_objective);
  for (std::size_t i = 1; i < front.size(); ++i) {
    if (pick_worth(out.rule, candidates[i], out.ranges) >
        pick_worth(out.rule, candidates[out.nominal], out.ranges))
      out.nominal = i;
  }
  out.worth = member_worth(problem, front, out.rule, out.ranges);
  const MemberWorth& worth = out.worth;
  const double limits = problem.study().risk.limits;
  out.designs = prospects(worth, problem.belief_risk());
  out.best = chosen(out.designs, limits);
  out.by_knee =
      out.rule.kind == PickRule::Kind::Knee
          ? out.best
          : chosen(prospects(member_worth(problem, front, {PickRule::Kind::Knee}, out.ranges),
                             problem.belief_risk()),
                   limits);
  out.settled = settled_skins(worth, problem.belief_risk(), limits);
  out.best_worth = best_worth(worth);
  for (const MemberWorth& of : by_objective) {
    std::vector<double>& p = out.p_best_by.emplace_back();
    for (const Prospect& design : prospects(of, {})) p.push_back(design.p_best);
  }
  out.hypotheses = by_group(worth, problem.belief_risk(), limits, hypotheses_of(belief));
  const Scene scene =
      scene_of(task_design(problem.study(), problem.study().design, problem.tasks().front()));
  out.parameter = by_half(worth, problem.belief_risk(), limits, numbers_of(belief, scene));
  return out;
}

}  // namespace papilla::search
