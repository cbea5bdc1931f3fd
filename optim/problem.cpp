#include "optim/problem.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/random.h"

namespace papilla::optim {
namespace {

// The two ends of what is excluded are one place on the unit interval: so much of that belongs to
// the upper one.
constexpr double kUpperEnd = 1e-9;

double free_length(const Dimension& d) {
  double out = d.high - d.low;
  for (const Excluded& e : d.excluded) out -= e.to - e.from;
  return out;
}

}  // namespace

Point low_discrepancy(std::size_t dimensions, std::uint64_t seed, std::uint64_t i) {
  // Roberts' generalised golden ratio: phi solves x^(d+1) = x + 1; a random shift scrambles.
  double phi = 2;
  for (int k = 0; k < 60; ++k) phi = std::pow(1 + phi, 1.0 / (static_cast<double>(dimensions) + 1));
  Point u(dimensions);
  for (std::size_t k = 0; k < dimensions; ++k) {
    const double step = std::pow(1 / phi, static_cast<double>(k + 1));
    u[k] = std::fmod(hash_uniform(seed, 77, k) + step * static_cast<double>(i + 1), 1.0);
  }
  return u;
}

double Dimension::value(double u) const {
  if (!choices.empty()) {
    const auto n = choices.size();
    return choices[std::min(n - 1, static_cast<std::size_t>(u * static_cast<double>(n)))];
  }
  if (u >= 1) return high;
  const double length = free_length(*this);
  double out = low + u * length;
  for (const Excluded& e : excluded) {
    if (out <= e.from) break;
    out = std::max(out + e.to - e.from, e.to);
    if (out - e.to < kUpperEnd * length) out = e.to;
  }
  return out;
}

double Dimension::unit(double value) const {
  if (!choices.empty()) {
    std::size_t nearest = 0;
    for (std::size_t k = 1; k < choices.size(); ++k) {
      if (std::abs(choices[k] - value) < std::abs(choices[nearest] - value)) nearest = k;
    }
    return (static_cast<double>(nearest) + 0.5) / static_cast<double>(choices.size());
  }
  const double length = free_length(*this);
  double at = value;
  for (const Excluded& e : excluded) {
    if (e.holds(at)) at = at - e.from < e.to - at ? e.from : e.to;
  }
  double before = at - low;  // of what is not excluded
  for (const Excluded& e : excluded) {
    if (at < e.to) break;
    before -= e.to - e.from;
    if (at == e.to) before += 0.5 * kUpperEnd * length;
  }
  return length > 0 ? std::clamp(before / length, 0.0, 1.0) : 0.5;
}

Point Space::value(const Point& unit) const {
  PAPILLA_CHECK(unit.size() == size(), "one coordinate per variable");
  Point out(size());
  for (std::size_t i = 0; i < size(); ++i)
    out[i] = dimensions[i].value(std::isfinite(unit[i]) ? std::clamp(unit[i], 0.0, 1.0) : 0.5);
  return out;
}

Point Space::unit(const Point& value) const {
  PAPILLA_CHECK(value.size() == size(), "one value per variable");
  Point out(size());
  for (std::size_t i = 0; i < size(); ++i) out[i] = dimensions[i].unit(value[i]);
  return out;
}

Point Space::snapped(const Point& u) const {
  const Point point = unit(value(u));
  return collapse ? collapse(point) : point;
}

bool Space::single_point() const {
  return std::all_of(dimensions.begin(), dimensions.end(), [](const Dimension& d) {
    return d.choices.empty() ? d.high <= d.low : d.choices.size() == 1;
  });
}

double Outcome::violation() const {
  double sum = 0;
  for (double c : constraints) sum += std::max(0.0, c);
  return sum;
}

Outcome guarded(Outcome outcome, std::size_t objectives, std::size_t constraints) {
  const auto fail = [&](const std::string& why) {
    outcome.ok = false;
    if (outcome.reason.empty()) outcome.reason = why;
    outcome.objectives.clear();
    outcome.constraints.clear();
    return outcome;
  };
  if (!outcome.ok) return fail("the evaluation failed");
  if (outcome.objectives.size() != objectives || outcome.constraints.size() != constraints) {
    return fail("the evaluation returned the wrong number of values");
  }
  const auto finite = [](double v) { return std::isfinite(v); };
  if (!std::all_of(outcome.objectives.begin(), outcome.objectives.end(), finite))
    return fail("an objective is not a finite number");
  if (!std::all_of(outcome.constraints.begin(), outcome.constraints.end(), finite))
    return fail("a constraint is not a finite number");
  return outcome;
}

}  // namespace papilla::optim
