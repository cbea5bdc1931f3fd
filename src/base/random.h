// Reproducible random numbers: RandomStream(seed, purpose, index). Streams with different arguments
// are independent; the same arguments give the same numbers on every machine and thread count
// (own transforms: the standard library's distributions differ between implementations).
// Common random numbers = the same purpose and index for every design.
#pragma once

#include <cstdint>
#include <string_view>

#include "base/rooms.h"

namespace papilla::base {

class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view purpose, std::uint64_t index = 0);

  std::uint64_t bits();  // 64 uniform bits
  double uniform();      // [0, 1)
  double uniform(double low, double high);
  double normal();   // mean 0, standard deviation 1
  int below(int n);  // 0..n-1

 private:
  std::uint64_t state_;
  double spare_ = 0;
  bool has_spare_ = false;
};

// One uniform [0,1) number from a key, without a stream: for modes keyed by integer index.
double hash_uniform(std::uint64_t seed, std::uint64_t a, std::uint64_t b);

}  // namespace papilla::base
