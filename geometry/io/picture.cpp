#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/io/files.h"

namespace papilla::geometry {
namespace {

// Five anchors of a perceptually even map from dark blue to yellow.
constexpr std::array<std::array<double, 3>, 5> kColours{
    {{68, 1, 84}, {59, 82, 139}, {33, 145, 140}, {94, 201, 98}, {253, 231, 37}}};

// Largest of 1, 2, 5 x 10^n not above the length.
double round_length(double length) {
  const double base = std::pow(10, std::floor(std::log10(length)));
  for (double factor : {5.0, 2.0}) {
    if (factor * base <= length) return factor * base;
  }
  return base;
}

}  // namespace

double scale_bar_length(const Grid& grid) { return round_length(0.3 * grid.lx); }

std::array<std::uint8_t, 3> field_colour(double share) {
  const double position = std::clamp(share, 0.0, 1.0) * (kColours.size() - 1);
  const auto i = std::min<std::size_t>(static_cast<std::size_t>(position), kColours.size() - 2);
  const double t = position - static_cast<double>(i);
  std::array<std::uint8_t, 3> rgb{};
  for (std::size_t c = 0; c < 3; ++c) {
    rgb[c] = static_cast<std::uint8_t>(
        std::lround(kColours[i][c] + t * (kColours[i + 1][c] - kColours[i][c])));
  }
  return rgb;
}

std::vector<std::uint8_t> render_field(const Grid& grid, const std::vector<double>& values,
                                       int& width, int& height) {
  const int zoom = std::max(1, 512 / std::max(grid.nx, grid.ny));
  width = grid.nx * zoom;
  height = grid.ny * zoom;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double span = *high - *low;
  std::vector<std::uint8_t> rgb(static_cast<std::size_t>(width) * height * 3);
  const auto put = [&](int x, int y, const std::array<std::uint8_t, 3>& c) {
    std::copy(c.begin(), c.end(), rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * width + x));
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double v = values[grid.index(x / zoom, grid.ny - 1 - y / zoom)];
      put(x, y, field_colour(span > 0 ? (v - *low) / span : 1));
    }
  }
  // White bar with a black rim, a round length near a quarter of the width.
  const int bar = static_cast<int>(std::lround(scale_bar_length(grid) / grid.lx * width));
  const int thick = std::max(3, height / 80), margin = std::max(4, height / 40);
  for (int y = height - margin - thick - 1; y <= height - margin; ++y) {
    for (int x = margin - 1; x <= margin + bar; ++x) {
      if (x < 0 || x >= width || y < 0) continue;
      const bool rim = x == margin - 1 || x == margin + bar || y == height - margin - thick - 1 ||
                       y == height - margin;
      put(x, y,
          rim ? std::array<std::uint8_t, 3>{0, 0, 0} : std::array<std::uint8_t, 3>{255, 255, 255});
    }
  }
  return rgb;
}

}  // namespace papilla::geometry
