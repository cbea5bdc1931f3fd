// Plain sums, extremes and moments of arrays.
#pragma once

#include <span>

#include "base/rooms.h"

namespace papilla::numerics {

double sum(std::span<const double> a);
double mean(std::span<const double> a);                            // of none: 0
double dot(std::span<const double> a, std::span<const double> b);  // of equal length
double least(std::span<const double> a);                           // of none: infinity
double largest(std::span<const double> a);                         // of none: -infinity
std::size_t count_above(std::span<const double> a, double bound);
// Mean square about the mean of at least one value; NaN or infinite where a value is.
double variance(std::span<const double> a);

}  // namespace papilla::numerics
