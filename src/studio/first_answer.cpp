#include "studio/first_answer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "studio/form.h"

namespace papilla::studio {
namespace {

// What the ratio of two levels changes with the distance, and what of it no distance explains;
// relative, one standard error. docs/theory/studio.md
constexpr double kDrift = 0.06, kFloor = 0.012;
// Without an anchor: load law and grid of the level, relative.
constexpr double kUnanchored = 0.07;

constexpr std::array kCarried{&PointQuantities::friction_off, &PointQuantities::friction_on,
                              &PointQuantities::modulation};

double root(double a, double b) { return std::hypot(a, b); }

// By Eq. studio.1 and studio.2; true where the anchor has the number.
bool carry(const Measured& fine, const Measured& coarse, double distance, Measured& m) {
  if (coarse.value == 0 || fine.value == 0) return false;
  m.value *= fine.value / coarse.value;
  const double share = std::abs(m.value / fine.value);
  m.parts = fine.parts;
  m.parts.sampling *= share;
  for (const ErrorOrigin& origin : kErrorOrigins) {
    if (std::optional<double>& part = m.parts.*origin.part) *part *= share;
  }
  const double drift = root(kFloor, kDrift * distance) * std::abs(m.value);
  m.parts.method = root(m.parts.method.value_or(0), drift);
  return true;
}

void state_alone(const Plan& plan, bool field_known, Measured& m) {
  for (const PlanStep& step : plan.steps) {
    if (step.piece == Piece::Field && !field_known)
      m.parts.field = root(m.parts.field.value_or(0), step.error * std::abs(m.value));
  }
  m.parts.method = root(m.parts.method.value_or(0), kUnanchored * std::abs(m.value));
}

}  // namespace

std::optional<double> distance(const Design& from, const Design& to) {
  const std::vector<FormKey> a = form_keys(from), b = form_keys(to);
  if (a.size() != b.size()) return std::nullopt;
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].path != b[i].path) return std::nullopt;
    if (a[i].value == b[i].value || a[i].type == KeyType::Text) continue;
    if (a[i].type != KeyType::Number) return std::nullopt;
    const double ratio = b[i].shown / a[i].shown;
    sum += ratio > 0 && std::isfinite(ratio) ? std::abs(std::log(ratio)) : 1;
  }
  return sum;
}

Response first_answer(const Response& search, const Design& design,
                      const std::optional<Anchor>& anchor) {
  Response out = search;
  const auto away = anchor ? distance(anchor->design, design) : std::nullopt;
  const bool usable = away && anchor->refined.driven == search.driven &&
                      anchor->refined.points.size() == search.points.size() &&
                      anchor->search.points.size() == search.points.size();
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    ResponsePoint& point = out.points[i];
    for (Measured PointQuantities::*quantity : kCarried) {
      Measured& m = point.*quantity;
      if (usable &&
          carry(anchor->refined.points[i].*quantity, anchor->search.points[i].*quantity, *away, m))
        continue;
      state_alone(out.plan, point.field_error.has_value(), m);
    }
  }
  return out;
}

}  // namespace papilla::studio
