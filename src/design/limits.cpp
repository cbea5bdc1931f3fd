#include "design/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/constants.h"
#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "metrics/shown.h"

namespace papilla::design {
namespace {

constexpr int kDigits = 4;      // of a value for people
constexpr int kAllDigits = 12;  // of a limit: all that somebody writes

double bounded(double violation) {
  constexpr double kLarge = 10;
  if (violation > kLarge) return kLarge + 1 - kLarge / violation;
  return std::max(violation, -1.0);
}

const ConstraintKind& listed_kind(const Limited& on) {
  const auto& kinds = constraint_kinds();
  const auto found =
      std::find_if(kinds.begin(), kinds.end(), [&](const ConstraintKind& k) { return k.on == on; });
  PAPILLA_CHECK(found != kinds.end(), "a limit with a key of its own is in the list");
  return *found;
}

// A metric is limited on its bad side.
ConstraintKind metric_kind(const std::string& key) {
  const MetricExpression expression = parse_metric(key);
  const Better better = better_direction(expression);
  if (better == Better::Neither)
    throw InputError("\"" + key + "\" has no better direction to be limited in");
  const bool relative =
      expression.summary == Summary::Variation || expression.summary == Summary::Range;
  return {MetricLimit{expression}, metric_text(expression),
          relative ? "" : info_of(expression.metric).unit, better == Better::Higher, ""};
}

// A value in the unit that people read it in.
struct Shown {
  double value = 0;
  std::string unit;
};
Shown shown(const Limited& on, double si) {
  if (const auto* metric = std::get_if<MetricLimit>(&on)) {
    const ShownUnit unit = shown_unit(metric->expression);
    return {si * unit.scale, unit.unit};
  }
  const std::string& unit = listed_kind(on).unit;
  return {si / find_unit(unit)->to_si, unit};
}

// As instruments would read it.
double without_noise(const Limited& on, double value) {
  if (const auto* metric = std::get_if<MetricLimit>(&on))
    return metrics::without_noise(metric->expression, value);
  if (const auto* look = std::get_if<LookLimit>(&on))
    return metrics::without_noise({Summary::Mean, LookMetric{look->number}}, value);
  return value;
}

}  // namespace

const std::vector<ConstraintKind>& constraint_kinds() {
  static const std::vector<ConstraintKind> kinds{
      {ShapeLimit{ShapeMargin::MinHole}, "min_hole", "um", true,
       "smallest hole or gap between features, at its floor; of gradual profiles at half the "
       "depth"},
      {ShapeLimit{ShapeMargin::MinWall}, "min_wall", "um", true,
       "smallest wall or feature; of a stack this, min_hole and aspect_ratio are of each part "
       "alone"},
      {ShapeLimit{ShapeMargin::AspectRatio}, "aspect_ratio", "", false,
       "largest depth / smallest hole or wall: both collapse or do not release where they are "
       "slim"},
      {FilmLimit{}, "oxide_breakdown_margin", "", true,
       "breakdown field of the dielectric / largest field in it, at the drive's amplitude and at "
       "the voltages that voltage_for asks for; a bridge or a contact at the thinnest place "
       "counted"},
      {LookLimit{&Look::haze}, "haze", "%", false,
       "share of the transmitted light beyond the cone of the view"},
      {LookLimit{&Look::transmittance}, "transmittance", "%", true,
       "undeviated share of the light on the plate"},
      {LookLimit{&Look::total_transmittance}, "total_transmittance", "%", true,
       "all of the light through the plate over that on it (ISO 13468)"},
      {LookLimit{&Look::gloss}, "gloss", "", true, "gloss units at 60 deg (ISO 2813)"},
      {LookLimit{&Look::gloss_20}, "gloss_20", "", true, "gloss units at 20 deg"},
      {LookLimit{&Look::gloss_85}, "gloss_85", "", true, "gloss units at 85 deg"},
      {LookLimit{&Look::gloss, false}, "most_gloss", "", false,
       "gloss units at 60 deg that are not exceeded: against glare"},
      {LookLimit{&Look::distinctness}, "distinctness", "%", true,
       "distinctness of the reflected image at 20 deg"},
      {LookLimit{&Look::sparkle}, "sparkle", "%", false,
       "deviation of the light of equal subpixels of view.panel"},
      {LookLimit{&Look::colour_shift}, "colour_shift", "", false,
       "CIE 1976 u'v' distance of the undeviated light"},
      {YieldLimit{}, "yield", "%", true,
       "share of the plates that keep every other limit within the tolerances of [scatter]; the "
       "other limits are then asked of the design as drawn"},
  };
  return kinds;
}

ConstraintKind read_constraint_kind(const std::string& key) {
  for (const ConstraintKind& kind : constraint_kinds()) {
    if (kind.name == key) return kind;
  }
  return metric_kind(key);
}

Constraint read_constraint(const std::string& key, double limit) {
  const ConstraintKind kind = read_constraint_kind(key);
  return {kind.on, limit, kind.at_least};
}

std::string limit_name(const Limited& on) {
  if (const auto* metric = std::get_if<MetricLimit>(&on)) return metric_text(metric->expression);
  return listed_kind(on).name;
}

double margin_of(ShapeMargin margin, const FabricationMargins& margins) {
  switch (margin) {
    case ShapeMargin::MinHole:
      return margins.min_hole;
    case ShapeMargin::MinWall:
      return margins.min_wall;
    case ShapeMargin::AspectRatio:
      return margins.aspect_ratio;
  }
  return kInfinity;
}

double violation(const Constraint& limit, double value) {
  if (limit.limit <= 0) return limit.at_least ? -1 : bounded(value);
  const double beyond = !limit.at_least ? value / limit.limit - 1
                        : value > 0     ? limit.limit / value - 1
                                        : kInfinity;
  return std::abs(beyond) <= kLimitTolerance ? 0 : bounded(beyond);
}

bool keeps(const Constraint& limit, double value) { return violation(limit, value) <= 0; }

std::string limit_value_text(const Constraint& limit, double value) {
  if (!std::isfinite(value)) return "none";
  const double quiet = without_noise(limit.on, value);
  if (value != limit.limit && keeps(limit, quiet) == keeps(limit, value)) value = quiet;
  const auto [number, unit] = shown(limit.on, value);
  const double asked = shown(limit.on, limit.limit).value;
  // What is read keeps the limit where the value does, and breaks it where that does.
  const double bound = std::stod(significant(asked, kAllDigits));
  const auto reads_kept = [&](int digits) {
    const double read = std::stod(significant(number, digits));
    return !limit.at_least ? read <= bound : read >= bound || bound <= 0;
  };
  int digits = value == limit.limit ? kAllDigits : kDigits;
  while (digits < kAllDigits && reads_kept(digits) != keeps(limit, value)) ++digits;
  return significant(number, digits) + (unit.empty() ? "" : " " + unit);
}

std::string limit_text(const Constraint& limit) {
  return fmt::format("at {} {}", limit.at_least ? "least" : "most",
                     limit_value_text(limit, limit.limit));
}

}  // namespace papilla::design
