#include "search/sensitivity.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace papilla {
namespace {

constexpr double kStep = 0.05;           // of a variable's range
constexpr double kToleratedLoss = 0.05;  // of an objective's value

// One move's part in its variable: the change, halved with that of the opposite move, and the drift
// that may be tolerated this way.
void add_move(VariableSensitivity& s, const std::vector<StudyObjective>& objectives, int sign,
              bool second, const Score& centre, const Score& moved) {
  double allowed = kInfinity;
  if (s.change.empty()) s.change.assign(objectives.size(), 0);
  for (std::size_t o = 0; o < objectives.size(); ++o) {
    const double gain = moved.values[o] - centre.values[o];
    const double up = sign * gain;
    s.change[o] = second ? 0.5 * (s.change[o] + up) : up;
    const double loss = (objectives[o].maximise ? -1 : 1) * gain;
    const double most = kToleratedLoss * std::abs(centre.values[o]);
    if (loss > most) allowed = std::min(allowed, s.step * most / loss);
  }
  const bool beyond = !std::isfinite(allowed);
  (sign < 0 ? s.down : s.up) = beyond ? s.step : allowed;
  (sign < 0 ? s.down_beyond : s.up_beyond) = beyond;
}

void share_out(std::vector<VariableSensitivity>& all, std::size_t objective) {
  double sum = 0;
  for (const VariableSensitivity& s : all)
    sum += s.change.empty() ? 0 : square(s.change[objective]);
  for (VariableSensitivity& s : all)
    s.share[objective] = sum > 0 && !s.change.empty() ? square(s.change[objective]) / sum : 0;
}

}  // namespace

std::vector<SensitivityMove> sensitivity_moves(const StudyProblem& problem, const Point& centre) {
  const DesignSpace& space = problem.space();
  std::vector<SensitivityMove> out;
  for (std::size_t k = 0; k < centre.size(); ++k) {
    if (!space.cube().dimensions[k].choices.empty()) continue;
    for (int sign : {-1, 1}) {
      Point u = centre;
      u[k] += sign * kStep;
      const bool possible =
          u[k] >= 0 && u[k] <= 1 && problem.constraints().geometry(u).front() <= 0;
      if (possible && space.snapped(u) != centre) out.push_back({k, sign, u});
    }
  }
  return out;
}

std::vector<VariableSensitivity> sensitivity(const StudyProblem& problem, const Point& centre,
                                             const std::vector<SensitivityMove>& moves,
                                             const Score& at_centre,
                                             const std::vector<Score>& moved) {
  std::vector<VariableSensitivity> out;
  if (!at_centre.ok) return out;
  const auto& objectives = problem.objectives();
  const std::vector<double> centre_values = problem.space().value(centre);
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const auto& [k, sign, unit] = moves[i];
    if (out.empty() || out.back().variable != k) {
      out.emplace_back().variable = k;
      out.back().share.assign(objectives.size(), 0);
    }
    if (!moved[i].ok) continue;
    out.back().step = std::abs(problem.space().value(unit)[k] - centre_values[k]);
    const bool second = sign > 0 && i > 0 && moves[i - 1].variable == k && moved[i - 1].ok;
    add_move(out.back(), objectives, sign, second, at_centre, moved[i]);
  }
  for (std::size_t o = 0; o < objectives.size(); ++o) share_out(out, o);
  return out;
}

}  // namespace papilla
