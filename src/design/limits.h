// Limits of a study compared with what a design has of them: the one place where that is done.
#pragma once

#include <string>

#include "base/rooms.h"
#include "design/study.h"

namespace papilla::design {

// Values this close to a limit, relative to it, are on it: 5.41 um - 5.01 um is a wall of 0.4 um.
inline constexpr double kLimitTolerance = 1e-9;

bool keeps(const Constraint& limit, double value);

// How far a value lies beyond its limit, relative to that: at most 0 where the limit is kept, above
// 0 where it is not. Bounded by -1 and 11, yet larger for more.
double violation(const Constraint& limit, double value);

// What the limit is about: of a metric expression, which no kind of constraint names, Metric.
LimitOn limit_on(const Constraint& limit);

// For people: "0.4 um", "12 %", "36.3 mN"; "none" of an infinite one.
std::string limit_value_text(const Constraint& limit, double value);
// "at least 0.4 um"
std::string limit_text(const Constraint& limit);

}  // namespace papilla::design
