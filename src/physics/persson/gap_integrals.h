// F(x) = int_x^inf dt/t e^-t^2 [gamma + 3 (1 - gamma) erf^2 t] as a table of H(y) = F(y^-1/2)
// y^-1/2, inside this folder. Eq. persson.7
#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "base/rooms.h"

namespace papilla::persson {

// Nodes at 2^k (1 + j/128): the cell of y is read off its bits.
inline constexpr int kLowExponent = -6;  // y below 2^-6: x > 8, F = 0
inline constexpr int kHighExponent = 120;
inline constexpr int kCellsPerOctave = 128;
inline constexpr int kTableSize = (kHighExponent - kLowExponent) * kCellsPerOctave + 1;
inline constexpr double kLowestNode = 0x1p-6;

// H at the nodes for an energy factor gamma. Kept: all mean fields of one factor share it.
std::shared_ptr<const std::vector<double>> gap_integral_table(double energy_factor);

// Linear between nodes; 0 below the first, the last value above the last.
inline double look_up(const std::vector<double>& table, double y) {
  if (!(y > kLowestNode)) return 0;
  const std::uint64_t bits = std::bit_cast<std::uint64_t>(y);
  const std::uint64_t cell = (bits >> 45) - (std::uint64_t(1023 + kLowExponent) << 7);
  if (cell >= kTableSize - 1) return table.back();
  // Fraction of the cell from the remaining mantissa bits.
  const double fraction = double(bits & ((std::uint64_t(1) << 45) - 1)) * 0x1p-45;
  return table[cell] + fraction * (table[cell + 1] - table[cell]);
}

}  // namespace papilla::persson
