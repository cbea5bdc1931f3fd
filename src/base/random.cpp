#include "base/random.h"

#include <cmath>

#include "base/constants.h"

namespace papilla::base {
namespace {
// splitmix64 finaliser (Steele, Lea, Flood 2014): a bijection that scatters every bit.
std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}
constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
double to_unit(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1.0p-53; }
}  // namespace

RandomStream::RandomStream(std::uint64_t seed, std::string_view purpose, std::uint64_t index)
    : state_(mix(seed + kGolden)) {
  for (char c : purpose) state_ = mix(state_ + kGolden + static_cast<unsigned char>(c));
  state_ = mix(state_ + kGolden * (index + 1));
}

std::uint64_t RandomStream::bits() { return mix(state_ += kGolden); }
double RandomStream::uniform() { return to_unit(bits()); }
double RandomStream::uniform(double low, double high) { return low + (high - low) * uniform(); }
int RandomStream::below(int n) { return static_cast<int>(uniform() * n); }

double RandomStream::normal() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  // Box-Muller; 1 - uniform() is in (0, 1].
  const double radius = std::sqrt(-2 * std::log(1 - uniform()));
  const double angle = 2 * kPi * uniform();
  spare_ = radius * std::sin(angle);
  has_spare_ = true;
  return radius * std::cos(angle);
}

double hash_uniform(std::uint64_t seed, std::uint64_t a, std::uint64_t b) {
  return to_unit(mix(mix(mix(seed + kGolden) + kGolden * (a + 1)) + kGolden * (b + 1)));
}

}  // namespace papilla::base
