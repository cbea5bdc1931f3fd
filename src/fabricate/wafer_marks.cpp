#include "fabricate/wafer_marks.h"

#include <fmt/format.h>

#include "geometry/io/glyphs.h"

namespace papilla::fabricate {
namespace {

constexpr std::int32_t kMicrometre = 1000;

LayoutPolygon bar(int layer, std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
  return {layer, {{x0, x1, x1, x0}, {y0, y0, y1, y1}}};
}

}  // namespace

std::string glyph_cell_name(char letter) {
  return fmt::format("GLYPH_{:02X}", static_cast<unsigned>(letter));
}

LayoutCell glyph_cell(char letter, std::int32_t square) {
  LayoutCell out{glyph_cell_name(letter), {}, {}};
  for (Polygon& p : glyph(letter, square)) out.polygons.push_back({1, std::move(p)});
  return out;
}

std::vector<LayoutReference> written(const std::string& word, std::int32_t x, std::int32_t y,
                                     std::int32_t square) {
  std::vector<LayoutReference> out;
  for (const char letter : word) {
    if (letter != ' ') out.push_back({.cell = glyph_cell_name(letter), .x = x, .y = y});
    x += kGlyphAdvance * square;
  }
  return out;
}

LayoutCell pad_corners(std::int32_t width, std::int32_t height) {
  constexpr std::int32_t kLong = 200 * kMicrometre, kWide = 20 * kMicrometre;
  LayoutCell out{"PAD_CORNERS", {}, {}};
  for (const int sx : {-1, 1}) {
    for (const int sy : {-1, 1}) {
      // The inner corner of the angle, and how far its legs go back along the pad.
      const std::int32_t x = sx * (width / 2 + kCornersBegin),
                         y = sy * (height / 2 + kCornersBegin);
      const auto between = [](std::int32_t a, std::int32_t b) {
        return std::pair(std::min(a, b), std::max(a, b));
      };
      const auto [x0, x1] = between(x - sx * kLong, x + sx * kWide);
      const auto [y0, y1] = between(y, y + sy * kWide);
      out.polygons.push_back(bar(1, x0, y0, x1, y1));
      const auto [u0, u1] = between(x, x + sx * kWide);
      const auto [v0, v1] = between(y - sy * kLong, y);
      out.polygons.push_back(bar(1, u0, v0, u1, v1));
    }
  }
  return out;
}

LayoutCell alignment_mark(int level) {
  constexpr std::int32_t kHalfWide = 10 * kMicrometre, kClear = 5 * kMicrometre,
                         kSquare = 60 * kMicrometre;
  LayoutCell out{fmt::format("ALIGN_{}", level), {}, {}};
  out.polygons.push_back(bar(1, -kMarkReach, -kHalfWide, kMarkReach, kHalfWide));
  out.polygons.push_back(bar(1, -kHalfWide, kHalfWide, kHalfWide, kMarkReach));
  out.polygons.push_back(bar(1, -kHalfWide, -kMarkReach, kHalfWide, -kHalfWide));
  if (level == 1) return out;
  constexpr std::int32_t kFrom = kHalfWide + kClear, kTo = kFrom + kSquare;
  for (const auto& [x0, x1] : {std::pair{kFrom, kTo}, {-kTo, -kFrom}}) {
    for (const auto& [y0, y1] : {std::pair{kFrom, kTo}, {-kTo, -kFrom}})
      out.polygons.push_back(bar(level, x0, y0, x1, y1));
  }
  return out;
}

LayoutCell size_marks() {
  constexpr std::int32_t kHigh = 100 * kMicrometre, kBetween = 40 * kMicrometre,
                         kSquare = 4 * kMicrometre;
  constexpr std::int32_t kStep = 100 * kMicrometre, kThin = 2 * kMicrometre,
                         kShort = 50 * kMicrometre;
  constexpr int kBars = 5, kTicks = 11;
  LayoutCell out{"SIZES", {}, {}};
  std::int32_t x = kThin / 2 - kSizesReach;
  const std::int32_t left = x;
  for (const std::int32_t width : kBarWidths) {
    const std::string word = fmt::format("{}", width / kMicrometre);
    for (LayoutReference& r : written(word, x, kHigh + 2 * kSquare, kSquare))
      out.references.push_back(r);
    for (int k = 0; k < kBars; ++k)
      out.polygons.push_back(bar(1, x + 2 * k * width, 0, x + (2 * k + 1) * width, kHigh));
    x += std::max((2 * kBars - 1) * width, 2 * kGlyphAdvance * kSquare) + kBetween;
  }
  for (int k = 0; k < kTicks; ++k) {
    const bool whole = k % 5 == 0;
    // Their middles are the steps of the ruler.
    const std::int32_t middle = left + k * kStep;
    out.polygons.push_back(bar(1, middle - kThin / 2, -kBetween - (whole ? kHigh : kShort),
                               middle + kThin / 2, -kBetween));
  }
  return out;
}

}  // namespace papilla::fabricate
