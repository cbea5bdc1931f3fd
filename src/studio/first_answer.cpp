#include "studio/first_answer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "geometry/texture.h"
#include "studio/form.h"

namespace papilla::studio {
namespace {

using Quantity = Measured PointQuantities::*;
constexpr std::array<Quantity, 3> kCarried{
    &PointQuantities::friction_off, &PointQuantities::friction_on, &PointQuantities::modulation};

// A quick level, and what a refined answer usually is of its own: of kCarried.
struct QuickLevel {
  int grid;
  std::array<double, 3> usual;
};
constexpr QuickLevel kCoarse{64, {0.69, 0.66, 0.88}};
constexpr QuickLevel kFine{128, {0.84, 0.82, 0.94}};  // where features are narrow
constexpr int kSkins = 8;
constexpr double kFewPixels = 4;  // of the smallest feature: its area is not its own below

// Relative, one standard error (docs/theory/studio.md): what the ratio changes with the distance;
// the more, the less usual it is; what of it no distance explains; how far the usual one is off.
constexpr double kDrift = 0.06, kUnusual = 0.5, kFloor = 0.012;
constexpr std::array<double, 3> kSpread{0.06, 0.07, 0.125};

double root(double a, double b) { return std::hypot(a, b); }

const QuickLevel& quick_level(const Design& design) {
  const bool narrow =
      facts(design.texture).margins.smallest() < kFewPixels * kWindow / kCoarse.grid;
  return narrow ? kFine : kCoarse;
}

// Of the ratio of two levels at this distance from where it is known.
double drift(double ratio, double usual, double distance) {
  const double unusual = ratio > 0 ? std::abs(std::log(ratio / usual)) : 1;
  return root(kFloor, (kDrift + kUnusual * unusual) * distance);
}

// By Eq. studio.1 and studio.2; true where the anchor has the number.
bool carry(const Measured& fine, const Measured& coarse, double usual, double distance,
           Measured& m) {
  if (coarse.value == 0 || fine.value == 0) return false;
  const double ratio = fine.value / coarse.value;
  m.value *= ratio;
  const double share = std::abs(m.value / fine.value);
  m.parts = fine.parts;
  m.parts.sampling *= share;
  for (const ErrorOrigin& origin : kErrorOrigins) {
    if (std::optional<double>& part = m.parts.*origin.part) *part *= share;
  }
  m.parts.method =
      root(m.parts.method.value_or(0), drift(ratio, usual, distance) * std::abs(m.value));
  return true;
}

// By Eq. studio.3.
void state_alone(const Plan& plan, bool field_known, double usual, double spread, Measured& m) {
  m.value *= usual;
  m.parts.sampling *= usual;
  for (const PlanStep& step : plan.steps) {
    if (step.piece == Piece::Field && !field_known)
      m.parts.field = root(m.parts.field.value_or(0), step.error * std::abs(m.value));
  }
  m.parts.method = root(m.parts.method.value_or(0), spread * std::abs(m.value));
}

}  // namespace

Fidelity quick_fidelity(const Design& design) {
  Fidelity out = fidelity_level("search");
  out.seed = static_cast<std::uint64_t>(design.accuracy.seed);
  out.grid = quick_level(design).grid;
  out.skins = kSkins;
  return out;
}

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

bool carries(const Anchor& anchor, const Design& design) {
  return anchor.refined.driven == design.drive.driven() &&
         quick_fidelity(design) == quick_fidelity(anchor.design) &&
         distance(anchor.design, design).has_value();
}

Response first_answer(const Response& quick, const Design& design,
                      const std::optional<Anchor>& anchor) {
  Response out = quick;
  const QuickLevel& level = quick_level(design);
  const bool carried = anchor && carries(*anchor, design);
  const double away = carried ? *distance(anchor->design, design) : 0;
  for (std::size_t i = 0; i < out.points.size(); ++i) {
    ResponsePoint& point = out.points[i];
    for (std::size_t k = 0; k < kCarried.size(); ++k) {
      const Quantity q = kCarried[k];
      const bool known = carried && carry(anchor->refined.points[i].*q, anchor->quick.points[i].*q,
                                          level.usual[k], away, point.*q);
      if (!known)
        state_alone(out.plan, point.field_error.has_value(), level.usual[k], kSpread[k], point.*q);
    }
  }
  return out;
}

double difference_drift(const Anchor& anchor, const Design& from, const Design& to) {
  const auto away = distance(from, to);
  PAPILLA_CHECK(away, "designs that one anchor carries");
  const std::size_t k = anchor.refined.driven ? kCarried.size() - 1 : 0;
  double most = 0;
  for (std::size_t i = 0; i < anchor.refined.points.size(); ++i) {
    const double fine = (anchor.refined.points[i].*kCarried[k]).value,
                 coarse = (anchor.quick.points[i].*kCarried[k]).value;
    if (coarse != 0) most = std::max(most, drift(fine / coarse, quick_level(to).usual[k], *away));
  }
  return most;
}

}  // namespace papilla::studio
