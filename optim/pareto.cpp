#include "optim/pareto.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/check.h"

namespace papilla {

bool dominates(const std::vector<double>& a, const std::vector<double>& b) {
  bool better = false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] > b[i]) return false;
    better = better || a[i] < b[i];
  }
  return better;
}

std::vector<std::size_t> pareto_front(const std::vector<Evaluation>& evaluations) {
  std::vector<std::size_t> front;
  bool any_feasible = false;
  for (const Evaluation& e : evaluations) any_feasible = any_feasible || e.outcome.feasible();
  if (!any_feasible) {
    // What was refused before an evaluation may violate more than it says.
    std::pair least{true, std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < evaluations.size(); ++i) {
      const Outcome& o = evaluations[i].outcome;
      const std::pair here{!o.ok, o.violation()};
      if ((o.ok || !o.constraints.empty()) && here < least) {
        least = here;
        front = {i};
      }
    }
    return front;
  }
  for (std::size_t i = 0; i < evaluations.size(); ++i) {
    const Outcome& a = evaluations[i].outcome;
    if (!a.feasible()) continue;
    bool beaten = false;
    for (std::size_t j = 0; j < evaluations.size() && !beaten; ++j) {
      const Outcome& b = evaluations[j].outcome;
      if (j == i || !b.feasible()) continue;
      beaten = dominates(b.objectives, a.objectives) || (j < i && b.objectives == a.objectives);
    }
    if (!beaten) front.push_back(i);
  }
  std::stable_sort(front.begin(), front.end(), [&](std::size_t a, std::size_t b) {
    return evaluations[a].outcome.objectives < evaluations[b].outcome.objectives;
  });
  return front;
}

std::vector<std::size_t> least_dominated(const std::vector<Evaluation>& evaluations,
                                         std::size_t most) {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < evaluations.size(); ++i) {
    if (evaluations[i].outcome.feasible()) out.push_back(i);
  }
  if (out.size() <= most) return out;
  std::vector<std::size_t> worse_than(evaluations.size(), 0);
  for (std::size_t i : out) {
    for (std::size_t j : out)
      worse_than[i] +=
          dominates(evaluations[j].outcome.objectives, evaluations[i].outcome.objectives);
  }
  std::stable_sort(out.begin(), out.end(),
                   [&](std::size_t i, std::size_t j) { return worse_than[i] < worse_than[j]; });
  out.resize(most);
  std::sort(out.begin(), out.end());
  return out;
}

double hypervolume(std::vector<std::vector<double>> points, const std::vector<double>& reference) {
  const std::size_t m = reference.size();
  PAPILLA_CHECK(m >= 1 && m <= 3, "one to three objectives");
  std::erase_if(points, [&](const std::vector<double>& p) {
    for (std::size_t i = 0; i < m; ++i) {
      if (!(p[i] < reference[i])) return true;
    }
    return false;
  });
  if (points.empty()) return 0;
  std::sort(points.begin(), points.end());
  if (m == 1) return reference[0] - points.front()[0];
  if (m == 2) {
    double sum = 0, level = reference[1];
    for (const auto& p : points) {
      if (p[1] >= level) continue;
      sum += (reference[0] - p[0]) * (level - p[1]);
      level = p[1];
    }
    return sum;
  }
  // Slices along the third objective.
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a[2] < b[2]; });
  double sum = 0;
  std::vector<std::vector<double>> below;
  for (std::size_t i = 0; i < points.size(); ++i) {
    below.push_back({points[i][0], points[i][1]});
    const double top = i + 1 < points.size() ? points[i + 1][2] : reference[2];
    if (top > points[i][2])
      sum += (top - points[i][2]) * hypervolume(below, {reference[0], reference[1]});
  }
  return sum;
}

std::vector<double> hypervolume_shares(const std::vector<Evaluation>& evaluations) {
  std::vector<double> worst, best;
  for (const Evaluation& e : evaluations) {
    if (!e.outcome.feasible()) continue;
    if (worst.empty()) worst = best = e.outcome.objectives;
    for (std::size_t k = 0; k < worst.size(); ++k) {
      worst[k] = std::max(worst[k], e.outcome.objectives[k]);
      best[k] = std::min(best[k], e.outcome.objectives[k]);
    }
  }
  double box = 1;
  for (std::size_t k = 0; k < worst.size(); ++k) box *= worst[k] > best[k] ? worst[k] - best[k] : 1;
  std::vector<std::vector<double>> points;
  std::vector<double> out;
  for (const Evaluation& e : evaluations) {
    if (e.outcome.feasible()) points.push_back(e.outcome.objectives);
    out.push_back(points.empty() ? 0 : hypervolume(points, worst) / box);
  }
  return out;
}

std::vector<std::size_t> spread_points(const std::vector<std::vector<double>>& points,
                                       std::size_t count, double nearest_allowed) {
  std::vector<std::size_t> chosen;
  if (points.empty() || count == 0) return chosen;
  const std::size_t m = points.front().size();
  std::vector<double> low(m, std::numeric_limits<double>::infinity()),
      high(m, -std::numeric_limits<double>::infinity());
  for (const auto& p : points) {
    for (std::size_t k = 0; k < m; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  const auto distance = [&](std::size_t a, std::size_t b) {
    double sum = 0;
    for (std::size_t k = 0; k < m; ++k) {
      const double span = high[k] > low[k] ? high[k] - low[k] : 1;
      sum += std::pow((points[a][k] - points[b][k]) / span, 2);
    }
    return sum;
  };
  for (std::size_t k = 0; k < m && chosen.size() < count; ++k) {  // the ends
    std::size_t best = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (points[i][k] < points[best][k]) best = i;
    }
    if (std::find(chosen.begin(), chosen.end(), best) == chosen.end()) chosen.push_back(best);
  }
  while (chosen.size() < std::min(count, points.size())) {
    std::size_t best = points.size();
    double farthest = -1;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (std::find(chosen.begin(), chosen.end(), i) != chosen.end()) continue;
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t c : chosen) nearest = std::min(nearest, distance(i, c));
      if (nearest > farthest) {
        farthest = nearest;
        best = i;
      }
    }
    if (farthest < nearest_allowed * nearest_allowed) break;
    chosen.push_back(best);
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace papilla
