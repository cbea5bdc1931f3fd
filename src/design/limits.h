// Limits of a study: what each is about, made once where the study is read, and how a design's
// value compares with it. The one place where that is done.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "base/rooms.h"
#include "geometry/facts.h"
#include "metrics/metrics.h"

namespace papilla::design {

// What can be made of a shape, known from the numbers of a design.
enum class ShapeMargin { MinHole, MinWall, AspectRatio };
struct ShapeLimit {
  ShapeMargin margin = ShapeMargin::MinHole;
  bool operator==(const ShapeLimit&) const = default;
};
// Strength of the dielectric over the field in it: in part known from the numbers of a design, to
// the end with an evaluation.
struct FilmLimit {
  bool operator==(const FilmLimit&) const = default;
};
// How the texture looks, known by an optical calculation.
struct LookLimit {
  double Look::*number = &Look::haze;
  bool bad_side = true;  // of the metric; else the other: glass that must not shine
  bool operator==(const LookLimit&) const = default;
};
// A metric over humidity, known with an evaluation.
struct MetricLimit {
  MetricExpression expression;
  bool operator==(const MetricLimit&) const = default;
};
// Share of the plates that keep all other limits within the scatter, known with an evaluation.
struct YieldLimit {
  bool operator==(const YieldLimit&) const = default;
};
using Limited = std::variant<ShapeLimit, FilmLimit, LookLimit, MetricLimit, YieldLimit>;

struct Constraint {
  Limited on;
  double limit = 0;  // SI
  bool at_least = true;

  bool operator==(const Constraint&) const = default;
};

// The limits that have a key of their own, as documents list them.
struct ConstraintKind {
  Limited on;
  std::string name, unit;
  bool at_least = true;  // else at most
  std::string doc;
};
const std::vector<ConstraintKind>& constraint_kinds();

// Of a key of [constraints]: one of the kinds, or a metric expression such as "worst(modulation)",
// limited on its bad side and with no doc. Throws InputError with the way out where the key is
// none.
ConstraintKind read_constraint_kind(const std::string& key);
// The limit of that key.
Constraint read_constraint(const std::string& key, double limit);

// "min_wall", "worst(modulation)": reads back to the same limit.
std::string limit_name(const Limited& on);

double margin_of(ShapeMargin margin, const FabricationMargins& margins);

// Values this close to a limit, relative to it, are on it: 5.41 um - 5.01 um is a wall of 0.4 um.
inline constexpr double kLimitTolerance = 1e-9;

bool keeps(const Constraint& limit, double value);

// How far a value lies beyond its limit, relative to that: at most 0 where the limit is kept, above
// 0 where it is not. Bounded by -1 and 11, yet larger for more.
double violation(const Constraint& limit, double value);

// For people: "0.4 um", "12 %", "36.3 mN"; "none" of an infinite one. As few digits as tell whether
// the limit is kept, and four or more.
std::string limit_value_text(const Constraint& limit, double value);
// "at least 0.4 um"
std::string limit_text(const Constraint& limit);

}  // namespace papilla::design
