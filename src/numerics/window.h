// Weighted sums over a small square window, at one place after another of two images.
#pragma once

#include <array>
#include <cstddef>

#include "base/rooms.h"
#include "numerics/loops.h"

namespace papilla::numerics {

// (2 kReach + 1)^2 weights, in single precision.
template <int kReach>
class Window {
 public:
  float& weight(int dx, int dy) { return weights_[at(dx, dy)]; }  // each within the reach
  float weight(int dx, int dy) const { return weights_[at(dx, dy)]; }

  struct Sums {
    float a, b;
  };
  // Of two images whose rows are `width` apart, the window's lower left corner at `from` in both;
  // kBeyond values after those of each row are read too, and count nothing.
  Sums sums(const float* a, const float* b, std::size_t from, std::size_t width) const {
    if (PixelByPixel::asked()) return sums_one_by_one(a, b, from, width);
    Row of_a{}, of_b{};
    for (int y = 0; y < kSide; ++y, from += width) {
      const Row w = Row::load(&weights_[static_cast<std::size_t>(y * kRow)]);
      of_a += w * Row::load(a + from);
      of_b += w * Row::load(b + from);
    }
    return {total(of_a), total(of_b)};
  }
  static constexpr int kBeyond = 16;

 private:
  using Row = Vector<float>;
  static constexpr int kSide = 2 * kReach + 1, kRow = Row::kSize;
  static_assert(kSide <= kRow && kBeyond >= kRow - kSide);

  static std::size_t at(int dx, int dy) {
    return static_cast<std::size_t>((dy + kReach) * kRow + dx + kReach);
  }
  static float total(const Row& row) {
    float part[8], sum = 0;
    for (int j = 0; j < 8; ++j) part[j] = row[j] + row[j + 8];
    for (int j = 0; j < 4; ++j) sum += part[j] + part[j + 4];
    return sum;
  }
  Sums sums_one_by_one(const float* a, const float* b, std::size_t from, std::size_t width) const {
    Sums out{0, 0};
    for (int y = -kReach; y <= kReach; ++y, from += width) {
      for (int x = 0; x < kSide; ++x) {
        const float w = weight(x - kReach, y);
        out.a += w * a[from + static_cast<std::size_t>(x)];
        out.b += w * b[from + static_cast<std::size_t>(x)];
      }
    }
    return out;
  }

  std::array<float, static_cast<std::size_t>(kRow* kSide)> weights_{};  // rows end with zeros
};

}  // namespace papilla::numerics
