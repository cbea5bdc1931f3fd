#include <algorithm>
#include <cmath>
#include <limits>

#include "optim/gaussian_process.h"
#include "optim/pareto.h"
#include "optim/search.h"

namespace papilla::optim {
namespace {

constexpr double kLeastGain = 0.01;  // of the hypervolume so far
// Beside a point that failed, in the unit cube: the largest difference of a variable.
constexpr double kBeside = 0.15;

double largest_difference(const Point& a, const Point& b) {
  double out = 0;
  for (std::size_t k = 0; k < a.size(); ++k) out = std::max(out, std::abs(a[k] - b[k]));
  return out;
}

// How much worse each constraint was found by a surer judgement, at worst.
std::vector<double> worsening(const std::vector<Evaluation>& evaluations,
                              const std::vector<Evaluation>& judged) {
  std::vector<double> out;
  for (const Evaluation& j : judged) {
    const auto same = std::find_if(evaluations.begin(), evaluations.end(),
                                   [&](const Evaluation& e) { return e.unit == j.unit; });
    if (same == evaluations.end() || !same->outcome.ok || !j.outcome.ok) continue;
    const std::size_t count =
        std::min(same->outcome.constraints.size(), j.outcome.constraints.size());
    out.resize(std::max(out.size(), count), 0);
    for (std::size_t k = 0; k < count; ++k)
      out[k] = std::max(out[k], j.outcome.constraints[k] - same->outcome.constraints[k]);
  }
  return out;
}

}  // namespace

Point model_coordinates(const SearchProblem& problem, const Point& unit) {
  Point out;
  for (std::size_t k = 0; k < unit.size(); ++k) {
    const Dimension& d = problem.space.dimensions[k];
    if (d.ordered) {  // as far apart as the values are, excluded ones counted
      out.push_back(d.excluded.empty() ? unit[k] : (d.value(unit[k]) - d.low) / (d.high - d.low));
      continue;
    }
    const double count = static_cast<double>(d.choices.size());
    for (double i = 0; i < count; ++i) out.push_back(std::floor(unit[k] * count) == i ? 0.5 : 0.0);
  }
  if (problem.features) {
    for (double f : problem.features(unit)) out.push_back(f);
  }
  return out;
}

std::vector<std::size_t> promising(const SearchProblem& problem,
                                   const std::vector<Evaluation>& evaluations, std::size_t count) {
  const std::vector<std::size_t> of = least_dominated(evaluations, kMostModelled);
  if (of.empty()) return pareto_front(evaluations);
  std::vector<Point> points;
  for (std::size_t i : of) points.push_back(model_coordinates(problem, evaluations[i].unit));
  std::vector<std::vector<double>> believed(of.size());
  std::vector<Evaluation> judged(of.size());
  for (std::size_t k = 0; k < problem.objectives; ++k) {
    std::vector<double> values;
    for (std::size_t i : of) values.push_back(evaluations[i].outcome.objectives[k]);
    const GaussianProcess model(points, values);
    for (std::size_t j = 0; j < of.size(); ++j)
      believed[j].push_back(model.predict(points[j]).mean);
  }
  for (std::size_t j = 0; j < of.size(); ++j) {
    judged[j].outcome.ok = true;
    judged[j].outcome.objectives = believed[j];
  }
  const std::vector<std::size_t> front = pareto_front(judged);
  // In units of the front's extent, from its best ends: the reference is a tenth beyond the far
  // ones.
  for (std::size_t k = 0; k < problem.objectives; ++k) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (std::size_t j : front) {
      low = std::min(low, believed[j][k]);
      high = std::max(high, believed[j][k]);
    }
    for (std::size_t j : front)
      believed[j][k] = high > low ? (believed[j][k] - low) / (high - low) : 0;
  }
  const Point reference(problem.objectives, 1.1);
  // Eq. search.12
  std::vector<std::size_t> chosen;
  std::vector<std::vector<double>> have;
  double total = 0;
  while (chosen.size() < std::min(count, front.size())) {
    double most = 0;
    std::size_t best = of.size();
    for (std::size_t j : front) {
      have.push_back(believed[j]);
      const double gain = hypervolume(have, reference) - total;
      have.pop_back();
      if (gain > most) most = gain, best = j;
    }
    if (best == of.size() || most < kLeastGain * total) break;
    have.push_back(believed[best]);
    total += most;
    chosen.push_back(of[best]);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

std::vector<Evaluation> tightened(std::vector<Evaluation> evaluations,
                                  const std::vector<Evaluation>& judged) {
  const std::vector<double> worse = worsening(evaluations, judged);
  for (Evaluation& e : evaluations) {
    for (std::size_t k = 0; k < std::min(worse.size(), e.outcome.constraints.size()); ++k)
      e.outcome.constraints[k] += worse[k];
  }
  for (const Evaluation& j : judged) {
    const auto same = std::find_if(evaluations.begin(), evaluations.end(),
                                   [&](const Evaluation& e) { return e.unit == j.unit; });
    if (same == evaluations.end())
      evaluations.push_back(j);
    else
      *same = j;
  }
  return evaluations;
}

std::optional<std::size_t> next_safer(const std::vector<Evaluation>& evaluations,
                                      const std::vector<Evaluation>& judged) {
  const std::vector<Evaluation> all = tightened(evaluations, judged);
  std::vector<Evaluation> left;
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < evaluations.size(); ++i) {
    const bool beside = std::any_of(judged.begin(), judged.end(), [&](const Evaluation& j) {
      return largest_difference(all[i].unit, j.unit) < (j.outcome.ok ? 1e-9 : kBeside);
    });
    if (beside || !evaluations[i].outcome.feasible() || !all[i].outcome.feasible()) continue;
    left.push_back(all[i]);
    places.push_back(i);
  }
  if (left.empty()) return std::nullopt;
  return places[pareto_front(left).front()];
}

}  // namespace papilla::optim
