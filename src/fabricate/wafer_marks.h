// What a wafer carries beside its textures (internal to fabricate): letters, corners of pads,
// crosses to align masks by, bars and a ruler of known sizes.
#pragma once

#include <string>

#include "base/rooms.h"
#include "geometry/io/drawing.h"

namespace papilla::fabricate {

std::string glyph_cell_name(char letter);
LayoutCell glyph_cell(char letter, std::int32_t square);
// References that write a word, its lower left corner at (x, y) [nm].
std::vector<LayoutReference> written(const std::string& word, std::int32_t x, std::int32_t y,
                                     std::int32_t square);

// Corners around a pad of these sides, whose middle is the origin [nm].
LayoutCell pad_corners(std::int32_t width, std::int32_t height);
inline constexpr std::int32_t kCornersBegin = 50000;  // beyond the pad [nm]

// A cross on layer 1, and on layer `level` four squares that stand in its corners.
LayoutCell alignment_mark(int level);
inline constexpr std::int32_t kMarkReach = 100000;  // of all of it from its origin [nm]
inline constexpr std::int32_t kMarkPitch = 300000;  // between them [nm]

// Bars as wide as their gaps, of 1, 2, 3, 5 and 10 um, and a ruler of 1 mm in steps of 100 um.
LayoutCell size_marks();
inline constexpr std::int32_t kSizesReach = 501000;  // of all of it along x from its origin [nm]
inline constexpr std::int32_t kSizesHigh = 140000;   // the same along y [nm]
inline constexpr std::int32_t kBarWidths[]{1000, 2000, 3000, 5000, 10000};  // [nm]

}  // namespace papilla::fabricate
