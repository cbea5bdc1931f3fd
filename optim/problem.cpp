#include "optim/problem.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/random.h"

namespace papilla::optim {

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

Point Space::value(const Point& unit) const {
  PAPILLA_CHECK(unit.size() == size(), "one coordinate per variable");
  Point out(size());
  for (std::size_t i = 0; i < size(); ++i) {
    const Dimension& d = dimensions[i];
    const double u = std::isfinite(unit[i]) ? std::clamp(unit[i], 0.0, 1.0) : 0.5;
    if (d.choices.empty()) {
      out[i] = u >= 1 ? d.high : d.low + u * (d.high - d.low);
    } else {
      const auto n = d.choices.size();
      out[i] = d.choices[std::min(n - 1, static_cast<std::size_t>(u * static_cast<double>(n)))];
    }
  }
  return out;
}

Point Space::unit(const Point& value) const {
  PAPILLA_CHECK(value.size() == size(), "one value per variable");
  Point out(size());
  for (std::size_t i = 0; i < size(); ++i) {
    const Dimension& d = dimensions[i];
    if (d.choices.empty()) {
      out[i] = d.high > d.low ? std::clamp((value[i] - d.low) / (d.high - d.low), 0.0, 1.0) : 0.5;
    } else {
      std::size_t nearest = 0;
      for (std::size_t k = 1; k < d.choices.size(); ++k) {
        if (std::abs(d.choices[k] - value[i]) < std::abs(d.choices[nearest] - value[i]))
          nearest = k;
      }
      out[i] = (static_cast<double>(nearest) + 0.5) / static_cast<double>(d.choices.size());
    }
  }
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
