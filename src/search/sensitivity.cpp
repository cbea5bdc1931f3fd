#include "search/sensitivity.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "metrics/shown.h"

namespace papilla::search {
namespace {

constexpr double kStep = 0.05;  // of a variable's range
// Of a step: where not even this makes a shape, none is tried. Room below it is none to any fab.
constexpr double kLeastPart = 1.0 / 32, kLeastRoom = 1e-3;

Point moved_point(const Point& centre, std::size_t variable, double by) {
  Point out = centre;
  out[variable] += by;
  return out;
}

// Where it may be off at most, as a share of the step, and the limit that is reached there.
struct Room {
  double share = kInfinity;
  std::string limit{};

  void end(double at, const std::string& by) {
    if (at < share) share = at, limit = by;
  }
};

// To the first of the limits that are known without an evaluation.
Room room_before_evaluation(const StudyProblem& problem, const MovedDesign& centre,
                            const SensitivityMove& move) {
  constexpr int kHalvings = 30;
  const StudyConstraints& constraints = problem.constraints();
  const auto at = [&](double share) {
    Design d = problem.space().design(
        moved_point(centre.unit, move.variable, share * move.part * move.sign * kStep));
    if (centre.flat) d.texture = Texture{};
    return constraints.before_evaluation(d);
  };
  const Judged limits = constraints.in_before_evaluation();
  const std::vector<double> here = at(0), there = at(1);
  Room out;
  for (std::size_t k = 0; k < limits.size(); ++k) {
    if (!limits[k] || here[k] > 0 || there[k] <= 0) continue;
    double kept = 0, broken = 1;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (kept + broken);
      (at(middle)[k] <= 0 ? kept : broken) = middle;
    }
    out.end(kept > kLeastRoom ? kept : 0, limit_name(limits[k]->on));
  }
  return out;
}

// To the first of those that an evaluation judges, linear between both.
Room room_with_evaluation(const StudyProblem& problem, const Score& centre, const Score& moved) {
  const std::vector<LimitValue> here = problem.constraints().evaluated(centre),
                                there = problem.constraints().evaluated(moved);
  Room out;
  for (std::size_t k = 0; k < here.size(); ++k) {
    if (there[k].kept()) continue;
    const Constraint& limit = here[k].limit;
    if (!here[k].kept()) {
      out.end(0, limit_name(limit.on));
      continue;
    }
    // Of the number itself, as a yield of 0 is infinitely off; a margin without a field is
    // infinite.
    const double from = std::isfinite(here[k].value) ? here[k].value - limit.limit
                                                     : violation(limit, here[k].value),
                 to = std::isfinite(here[k].value) ? there[k].value - limit.limit
                                                   : violation(limit, there[k].value);
    out.end(from / (from - to), limit_name(limit.on));
  }
  return out;
}

// To where an objective has lost what is tolerated, linear between both.
Room room_to_loss(const std::vector<StudyObjective>& objectives, const Score& centre,
                  const Score& moved) {
  Room out;
  for (std::size_t o = 0; o < objectives.size(); ++o) {
    const double loss = (objectives[o].maximise ? -1 : 1) * (moved.values[o] - centre.values[o]);
    const double most = tolerated_loss(objectives[o], centre.values[o]);
    if (loss > most) out.end(most / loss, "");
  }
  return out;
}

Drift drift_of(double step, Room loss, const std::vector<Room>& limits) {
  for (const Room& room : limits) loss.end(room.share, room.limit);
  if (!std::isfinite(loss.share)) return {step, Drift::End::StepTried};
  return {step * loss.share, loss.limit.empty() ? Drift::End::Loss : Drift::End::Limit, loss.limit};
}

void share_out(std::vector<VariableSensitivity>& all, std::size_t objective) {
  double sum = 0;
  for (const VariableSensitivity& s : all)
    sum += s.change.empty() ? 0 : square(s.change[objective]);
  for (VariableSensitivity& s : all)
    s.share[objective] = sum > 0 && !s.change.empty() ? square(s.change[objective]) / sum : 0;
}

// The part of a step that the space leaves this way.
double part_in_space(const Point& centre, std::size_t variable, int sign) {
  const double room = sign > 0 ? 1 - centre[variable] : centre[variable];
  return std::min(1.0, room / kStep);
}

// Why a number was not moved this way.
Drift::End not_moved(const Point& centre, std::size_t variable, int sign) {
  return part_in_space(centre, variable, sign) < kLeastPart ? Drift::End::RangeEnds
                                                            : Drift::End::NoShape;
}

}  // namespace

std::vector<SensitivityMove> sensitivity_moves(const StudyProblem& problem,
                                               const MovedDesign& centre) {
  const DesignSpace& space = problem.space();
  std::vector<SensitivityMove> out;
  if (DesignSpace::is_beside(centre.unit)) return out;
  const Point here = space.snapped(centre.unit);
  for (std::size_t k = 0; k < centre.unit.size(); ++k) {
    if (!space.cube().dimensions[k].choices.empty() ||
        (centre.flat && problem.study().variables[k].path.starts_with("texture.")))
      continue;
    for (int sign : {-1, 1}) {
      for (double part = part_in_space(centre.unit, k, sign); part >= kLeastPart; part /= 2) {
        Point u = moved_point(centre.unit, k, part * sign * kStep);
        u[k] = std::clamp(u[k], 0.0, 1.0);  // a bound that rounding would pass
        if (!problem.constraints().possible(space.design(u))) continue;
        if (space.snapped(u) != here) out.push_back({k, sign, u, part});
        break;
      }
    }
  }
  return out;
}

void set_confirmed_limits(const StudyProblem& problem, const Score& confirmed, Score& at_centre,
                          std::vector<Score>& moved) {
  if (!at_centre.ok) return;
  const Score own = at_centre;
  move_limits(problem.goals(), confirmed, own, own, at_centre);
  for (Score& there : moved) {
    if (there.ok) move_limits(problem.goals(), confirmed, own, there, there);
  }
}

std::vector<VariableSensitivity> sensitivity(const StudyProblem& problem, const MovedDesign& centre,
                                             const std::vector<SensitivityMove>& moves,
                                             const Score& at_centre,
                                             const std::vector<Score>& moved) {
  std::vector<VariableSensitivity> out;
  if (!at_centre.ok) return out;
  const auto& objectives = problem.objectives();
  const std::vector<double> centre_values = problem.space().value(centre.unit);
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const auto& [k, sign, unit, part] = moves[i];
    if (out.empty() || out.back().variable != k) {
      VariableSensitivity& added = out.emplace_back();
      added.variable = k;
      added.share.assign(objectives.size(), 0);
      added.down.end = not_moved(centre.unit, k, -1);
      added.up.end = not_moved(centre.unit, k, 1);
    }
    VariableSensitivity& s = out.back();
    Drift& drift = sign < 0 ? s.down : s.up;
    if (!moved[i].ok) {
      drift.end = Drift::End::Failed;
      continue;
    }
    const double tried = std::abs(problem.space().value(unit)[k] - centre_values[k]);
    s.step = tried / part;
    // Between both ends where there are two, so that a short part on one side tells little.
    const double before = s.change.empty() ? 0 : moves[i - 1].part;
    if (s.change.empty()) s.change.assign(objectives.size(), 0);
    for (std::size_t o = 0; o < objectives.size(); ++o) {
      const double up = sign * (moved[i].values[o] - at_centre.values[o]);
      s.change[o] = (s.change[o] * before + up) / (before + part);
    }
    drift = drift_of(tried, room_to_loss(objectives, at_centre, moved[i]),
                     {room_before_evaluation(problem, centre, moves[i]),
                      room_with_evaluation(problem, at_centre, moved[i])});
  }
  for (std::size_t o = 0; o < objectives.size(); ++o) {
    for (VariableSensitivity& s : out) {
      if (!s.change.empty()) s.change[o] = without_noise(objectives[o].expression, s.change[o]);
    }
    share_out(out, o);
  }
  return out;
}

}  // namespace papilla::search
