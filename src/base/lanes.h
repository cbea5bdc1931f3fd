// Numbers side by side, as many as 64 bytes hold: the same sums on every machine, whatever its
// registers hold.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>

#include "base/rooms.h"

namespace papilla::base {

template <class Real>
struct Pack {
  static constexpr std::size_t kCount = 64 / sizeof(Real);
  using Type __attribute__((vector_size(64))) = Real;
};
using Lanes = Pack<double>::Type;
constexpr std::size_t kLanes = Pack<double>::kCount;

inline Lanes all_lanes(double value) { return Lanes{} + value; }

// What a comparison gives: all bits where it holds, none elsewhere.
using LaneMask = decltype(Lanes{} < Lanes{});

// By bits: of `?` with a mask put together from others the compiler makes eight branches.
inline Lanes chosen(const LaneMask& where, const Lanes& then, const Lanes& otherwise) {
  LaneMask a, b;
  std::memcpy(&a, &then, sizeof a);
  std::memcpy(&b, &otherwise, sizeof b);
  const LaneMask bits = (a & where) | (b & ~where);
  Lanes out;
  std::memcpy(&out, &bits, sizeof out);
  return out;
}

// The same of one number: for what is written for both.
inline double chosen(bool where, double then, double otherwise) { return where ? then : otherwise; }

inline Lanes root(const Lanes& v) {
  Lanes out;
  for (std::size_t k = 0; k < kLanes; ++k) out[k] = std::sqrt(v[k]);
  return out;
}

// values[i] to values[i + 7]; `otherwise` beyond the end.
inline Lanes lanes_at(std::span<const double> values, std::size_t i, double otherwise = 0) {
  Lanes out = all_lanes(otherwise);
  if (i + kLanes <= values.size()) {
    std::memcpy(&out, values.data() + i, sizeof out);
  } else if (i < values.size()) {
    std::memcpy(&out, values.data() + i, (values.size() - i) * sizeof(double));
  }
  return out;
}

inline void store_lanes(const Lanes& lanes, std::span<double> values, std::size_t i) {
  if (i + kLanes <= values.size()) {  // of a known length, the copy is one instruction
    std::memcpy(values.data() + i, &lanes, sizeof lanes);
  } else {
    std::memcpy(values.data() + i, &lanes, (values.size() - i) * sizeof(double));
  }
}

template <class Lanes>
double total(const Lanes& lanes) {
  double out = 0;
  for (std::size_t k = 0; k < sizeof lanes / sizeof lanes[0]; ++k) out += lanes[k];
  return out;
}

inline double least(const Lanes& lanes) {
  double out = lanes[0];
  for (std::size_t k = 1; k < kLanes; ++k) out = std::min(out, lanes[k]);
  return out;
}

inline double largest(const Lanes& lanes) { return -least(-lanes); }

inline double sum(std::span<const double> a) {
  Lanes sums{};
  for (std::size_t i = 0; i < a.size(); i += kLanes) sums += lanes_at(a, i);
  return total(sums);
}

inline double dot(std::span<const double> a, std::span<const double> b) {
  Lanes sums{};
  for (std::size_t i = 0; i < a.size(); i += kLanes) sums += lanes_at(a, i) * lanes_at(b, i);
  return total(sums);
}

}  // namespace papilla::base
