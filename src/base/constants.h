// Physical constants and water at 24 degrees C, SI.
#pragma once

#include <limits>
#include <numbers>

#include "base/rooms.h"

namespace papilla::base {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kVacuumPermittivity = 8.8541878128e-12;  // F/m, CODATA 2018
inline constexpr double kWaterSurfaceTension = 0.072126;         // N/m, 24 C, IAPWS R1-76(2014)
inline constexpr double kWaterPermittivity = 80.0;               // relative, below 1 GHz

constexpr double square(double x) { return x * x; }
constexpr double cube(double x) { return x * x * x; }

}  // namespace papilla::base
