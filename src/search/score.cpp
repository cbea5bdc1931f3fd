#include "search/score.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/check.h"
#include "base/constants.h"
#include "estimate/parameters.h"
#include "numerics/statistics.h"

namespace papilla::search {
namespace {

using Numbers = std::vector<std::vector<double>>;  // [task][number that an objective is made of]

constexpr std::array kSampleLists{&ErrorSamples::sampling, &ErrorSamples::grid,
                                  &ErrorSamples::method};

Numbers numbers_of(const StudyGoals& goals, std::size_t k, const std::vector<TaskAnswer>& answers) {
  Numbers out;
  for (const TaskAnswer& a : answers) {
    const TaskObjective& o = a.objectives.at(k);
    out.push_back(goals.by_points(k) ? o.points : std::vector<double>{o.value});
  }
  return out;
}

// Weight of one of a task's numbers.
double weight_of(const Scoring& s, std::size_t k, std::size_t task, std::size_t number) {
  const bool weighted = s.goals.by_points(k) && !s.humidity_weights.empty();
  return s.tasks[task].weight * (weighted ? s.humidity_weights[number] : 1);
}

// Over tasks too, whatever the study's risk.
bool takes_the_worst(const StudyObjective& o) {
  return !o.aimed && o.expression.summary == Summary::Worst;
}

// An objective from the numbers of all tasks. residuals: of targets are appended; or null.
double combined(const Scoring& s, std::size_t k, const Numbers& numbers,
                std::vector<double>* residuals) {
  const StudyObjective& o = s.goals.objectives[k];
  Risk risk = s.goals.risk;
  if (takes_the_worst(o)) risk.kind = Risk::Kind::Worst;
  std::vector<double> values, weights, nominal;
  for (std::size_t t = 0; t < s.nominal; ++t) {
    for (std::size_t i = 0; i < numbers[t].size(); ++i) {
      const auto value = [&](std::size_t task) {
        return o.aimed ? square(numbers[task][i] - o.target) : numbers[task][i];
      };
      std::vector<double> lower, upper;
      for (std::size_t j = 0; j < s.law.size(); ++j) {
        const std::size_t low = s.nominal + 2 * (t * s.law.size() + j);
        lower.push_back(value(low));
        upper.push_back(value(low + 1));
      }
      const std::vector<double> all =
          scattered_values(risk, o.maximise, value(t), lower, upper, s.law);
      for (double v : all) {
        values.push_back(v);
        weights.push_back(weight_of(s, k, t, i) / static_cast<double>(all.size()));
      }
      nominal.push_back(numbers[t][i]);
    }
  }
  if (o.aimed && risk.kind == Risk::Kind::Mean && residuals) {
    // Scatter is in the squares alone: each residual keeps the sign of its nominal distance.
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (std::size_t i = 0; i < nominal.size(); ++i) {
      residuals->push_back(std::copysign(std::sqrt(std::max(0.0, values[i]) * weights[i] / sum),
                                         nominal[i] - o.target));
    }
  }
  const double value = apply_risk(risk, o.maximise, values, weights);
  return o.aimed ? std::sqrt(std::max(0.0, value)) : value;  // Eq. search.11
}

// One list of samples of an objective, followed through it: all numbers of all tasks without one
// skin, or with the change of grid or method. Nothing where tasks differ in their skins.
std::vector<double> combined_samples(const Scoring& s, std::size_t k, const Numbers& numbers,
                                     double value, std::vector<double> ErrorSamples::*list,
                                     const std::vector<TaskAnswer>& answers) {
  const std::size_t n = (answers[0].samples[k][0].*list).size();
  for (const TaskAnswer& a : answers) {
    for (const ErrorSamples& of : a.samples[k]) {
      if ((of.*list).size() != n || n < 2) return {};
    }
  }
  const bool changes = list != &ErrorSamples::sampling;
  // From all skins, or without one: the samples of a jackknife the other way round.
  const auto objective = [&](std::optional<std::size_t> skin) {
    Numbers there = numbers;
    for (std::size_t t = 0; t < there.size(); ++t) {
      for (std::size_t i = 0; i < there[t].size(); ++i) {
        const std::vector<double>& samples = answers[t].samples[k][i].*list;
        const double mean = mean_estimate(samples).value;
        const double others =
            skin ? mean - (samples[*skin] - mean) / static_cast<double>(n - 1) : mean;
        there[t][i] = (changes ? there[t][i] : 0) + others;
      }
    }
    return combined(s, k, there, nullptr) - (changes ? value : 0);
  };
  std::vector<double> without;
  for (std::size_t skin = 0; skin < n; ++skin) without.push_back(objective(skin));
  return jackknife_samples(objective(std::nullopt), without);
}

// All tasks' corrections to the 3-D field moved at once: their skins are the same.
FieldPart combined_field(const Scoring& s, std::size_t k, const Numbers& numbers, double value,
                         const std::vector<TaskAnswer>& answers) {
  FieldPart out;
  Numbers common = numbers, own = numbers;
  double squares = 0;
  for (std::size_t t = 0; t < numbers.size(); ++t) {
    for (std::size_t i = 0; i < numbers[t].size(); ++i) {
      const FieldPart& of = answers[t].samples[k][i].field;
      common[t][i] += of.common;
      own[t][i] += of.own;
      out.corrections.insert(out.corrections.end(), of.corrections.begin(), of.corrections.end());
      squares += static_cast<double>(of.corrections.size()) * square(of.of_skins);
    }
  }
  out.common = combined(s, k, common, nullptr) - value;
  out.own = combined(s, k, own, nullptr) - value;
  if (!out.corrections.empty())
    out.of_skins = std::sqrt(squares / static_cast<double>(out.corrections.size()));
  return out;
}

// Follows the objectives through the samples of confirmed tasks. Eq. accuracy.14
void add_samples(Score& score, const Scoring& s, const std::vector<TaskAnswer>& answers) {
  for (const TaskAnswer& a : answers) {
    if (a.samples.empty()) return;  // not confirmed
  }
  score.samples.resize(s.goals.objectives.size());
  for (std::size_t k = 0; k < score.samples.size(); ++k) {
    ErrorSamples& samples = score.samples[k];
    const Numbers numbers = numbers_of(s.goals, k, answers);
    for (const auto list : kSampleLists)
      samples.*list = combined_samples(s, k, numbers, score.values[k], list, answers);
    samples.field = combined_field(s, k, numbers, score.values[k], answers);
    // The tasks state the error of their own summaries, not that of a risk over them.
    const bool by_risk = s.goals.by_points(k) || s.goals.risk.kind != Risk::Kind::Mean ||
                         (s.nominal > 1 && takes_the_worst(s.goals.objectives[k]));
    if (by_risk && samples.sampling.size() > 1) {
      score.errors[k] =
          std::sqrt(square(mean_estimate(samples.sampling).se) + square(grid_error(samples.grid)) +
                    square(method_error(samples.method)) + square(samples.field.error()));
    }
  }
}

void add_objectives(Score& score, const Scoring& s, const std::vector<TaskAnswer>& answers) {
  for (std::size_t k = 0; k < s.goals.objectives.size(); ++k) {
    double error = 0, total = 0;
    for (std::size_t t = 0; t < s.nominal; ++t) {
      error += s.tasks[t].weight * answers[t].objectives[k].error;  // they share skins: linearly
      total += s.tasks[t].weight;
    }
    std::vector<double>& of_tasks = score.of_tasks.emplace_back();
    for (std::size_t t = 0; t < s.nominal; ++t) of_tasks.push_back(answers[t].objectives[k].value);
    score.values.push_back(combined(s, k, numbers_of(s.goals, k, answers), &score.residuals));
    score.errors.push_back(error / total);
  }
}

LimitedNumbers limited_numbers(const TaskAnswer& a) {
  return {a.oxide_margin, a.look ? std::vector{*a.look} : std::vector<Look>{}, a.limited,
          a.limited_errors};
}

// What constraints are about, and the worst modulation: the bad side over tasks. With a limit on
// the yield the ends of the scatter are the yield's.
void add_extremes(Score& score, const Scoring& s, const std::vector<TaskAnswer>& answers) {
  std::vector<LimitedNumbers> all;
  for (const TaskAnswer& a : answers) all.push_back(limited_numbers(a));
  if (s.law.size() > 0) score.by_task = all;
  if (s.goals.yield) all.resize(s.nominal);
  score.worst = kInfinity;
  for (std::size_t t = 0; t < all.size(); ++t) {
    if (s.tasks[t].driven) score.worst = std::min(score.worst, answers[t].worst);
  }
  if (std::isinf(score.worst)) score.worst = 0;
  LimitedNumbers bad = bad_side(s, all);
  score.oxide_margin = bad.oxide_margin;
  score.looks = std::move(bad.looks);
  score.limited = std::move(bad.limited);
}

// Of answers of a task, or of scores of a design.
template <class Numbers>
void move_limited(const StudyGoals& goals, const Numbers& confirmed, const Numbers& own,
                  const Numbers& there, Numbers& out) {
  for (std::size_t j = 0; j < goals.limited.size(); ++j) {
    const MetricExpression& e = goals.limited[j].expression;
    out.limited[j] = moved(confirmed.limited[j], own.limited[j], there.limited[j],
                           keeps_sign(e.summary, e.metric));
  }
  out.oxide_margin = moved(confirmed.oxide_margin, own.oxide_margin, there.oxide_margin, true);
}

}  // namespace

void move_limits(const StudyGoals& goals, const TaskAnswer& confirmed, const TaskAnswer& own,
                 const TaskAnswer& there, TaskAnswer& out) {
  move_limited(goals, confirmed, own, there, out);
}

void move_limits(const StudyGoals& goals, const Score& confirmed, const Score& own,
                 const Score& there, Score& out) {
  move_limited(goals, confirmed, own, there, out);
  if (confirmed.yield && own.yield && there.yield)
    out.yield->share = std::clamp(
        moved(confirmed.yield->share, own.yield->share, there.yield->share, true), 0.0, 1.0);
}

LimitedNumbers bad_side(const Scoring& s, const std::vector<LimitedNumbers>& of_tasks) {
  LimitedNumbers out;
  out.oxide_margin = kInfinity;
  for (const StudyObjective& o : s.goals.limited)
    out.limited.push_back(o.maximise ? kInfinity : -kInfinity);
  out.limited_errors.assign(out.limited.size(), 0);
  for (std::size_t t = 0; t < of_tasks.size(); ++t) {
    const LimitedNumbers& a = of_tasks[t];
    out.oxide_margin = std::min(out.oxide_margin, a.oxide_margin);
    for (std::size_t j = 0; j < out.limited.size(); ++j) {
      const bool worse = s.goals.limited[j].maximise ? a.limited[j] < out.limited[j]
                                                     : a.limited[j] > out.limited[j];
      if (!worse) continue;
      out.limited[j] = a.limited[j];
      out.limited_errors[j] = j < a.limited_errors.size() ? a.limited_errors[j] : 0;
    }
    // Which is the worst depends on the limit: gloss falls as haze rises.
    for (const Look& look : a.looks) {
      if (std::find(out.looks.begin(), out.looks.end(), look) == out.looks.end())
        out.looks.push_back(look);
    }
  }
  return out;
}

Score score_of(const Scoring& scoring, const std::vector<TaskAnswer>& answers) {
  PAPILLA_CHECK(answers.size() == scoring.tasks.size(), "one answer per task");
  Score score;
  for (std::size_t t = 0; t < answers.size(); ++t) {
    if (!answers[t].status.ok()) {
      score.reason = scoring.tasks[t].name + ": " + answers[t].status.text;
      score.kind = answers[t].status.kind;
      return score;
    }
    if (t < scoring.nominal) score.reports.push_back(answers[t].report);
  }
  add_objectives(score, scoring, answers);
  add_extremes(score, scoring, answers);
  add_samples(score, scoring, answers);
  add_steps(score, scoring, answers);
  score.ok = true;
  return score;
}

void add_steps(Score& score, const Scoring& scoring, const std::vector<TaskAnswer>& answers) {
  const std::vector<StudyTask>& tasks = scoring.tasks;
  double total = 0;
  for (std::size_t t = 0; t < scoring.nominal; ++t) {
    total += tasks[t].weight;
    if (answers.at(t).model.empty()) return;  // not asked for or not known
  }
  score.parameter_steps.assign(scoring.goals.objectives.size(), {});
  for (std::size_t k = 0; k < score.parameter_steps.size(); ++k) {
    const StudyObjective& o = scoring.goals.objectives[k];
    const bool keeps = o.aimed || keeps_sign(o.expression.summary, o.expression.metric);
    StepSamples& sums = score.parameter_steps[k];
    std::vector<std::size_t> first(scoring.nominal);  // direction of each finger
    bool known = true;
    for (std::size_t t = 0; t < scoring.nominal; ++t) {
      const StepSamples steps = answers[t].model.at(k).moves(score.of_tasks[k][t], keeps);
      std::size_t same = 0;
      const auto moved_alike = [&](const Finger& a, const Finger& b) {
        return a.belief == b.belief && (!a.belief.empty() || a.uncertainty == b.uncertainty);
      };
      while (!moved_alike(tasks[same].finger, tasks[t].finger)) ++same;
      first[t] = same < t ? first[same] : sums.size();
      known = known && !steps.empty();
      if (sums.size() < first[t] + steps.size()) sums.resize(first[t] + steps.size());
      for (std::size_t d = 0; d < steps.size(); ++d) {
        std::vector<double>& sum = sums[first[t] + d];
        sum.resize(steps[d].size(), 0);
        for (std::size_t skin = 0; skin < sum.size(); ++skin)
          sum[skin] += tasks[t].weight / total * steps[d][skin];
      }
    }
    if (!known) sums.clear();
  }
}

std::optional<double> parameter_error(const Score& score, std::size_t objective) {
  if (objective >= score.parameter_steps.size() || score.parameter_steps[objective].empty())
    return std::nullopt;
  return step_error(score.parameter_steps[objective]);
}

std::optional<double> parameter_error(const Score& score, const Score& other,
                                      std::size_t objective) {
  if (!parameter_error(score, objective) || !parameter_error(other, objective)) return std::nullopt;
  StepSamples difference = score.parameter_steps[objective];
  for (std::size_t k = 0; k < difference.size(); ++k) {
    for (std::size_t s = 0; s < difference[k].size(); ++s)
      difference[k][s] -= other.parameter_steps[objective].at(k).at(s);
  }
  return step_error(difference);
}

double difference_error(const Score& score, const Score& other, std::size_t objective) {
  if (objective < score.samples.size() && objective < other.samples.size()) {
    if (const auto error = difference_error(score.samples[objective], other.samples[objective]))
      return *error;
  }
  return std::max(score.errors[objective], other.errors[objective]);
}

bool no_better(const std::vector<StudyObjective>& objectives, const Score& design,
               const Score& other) {
  for (std::size_t k = 0; k < objectives.size(); ++k) {
    const double gain = (objectives[k].maximise ? 1 : -1) * (design.values[k] - other.values[k]);
    if (gain > difference_error(design, other, k)) return false;
  }
  return true;
}

}  // namespace papilla::search
