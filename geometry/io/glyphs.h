// Letters that are etched beside a texture and read in a microscope, or stand in a picture: five by
// seven squares each.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "geometry/io/mask.h"

namespace papilla::geometry {

inline constexpr int kGlyphColumns = 5, kGlyphRows = 7;
inline constexpr int kGlyphAdvance = kGlyphColumns + 1;  // to the next letter, in squares

// From the top; the highest of five bits is the left one.
using GlyphRows = std::array<unsigned, kGlyphRows>;

// Of a letter of a picture: one that has a glyph, "%" and the small letters of "e", nm, um and kPa.
// Null: none.
const GlyphRows* glyph_rows(char letter);

// What can be etched: "A" to "Z", digits, blank, "-", ".", "_" and "+"; others have no glyph.
bool has_glyph(char letter);

// Rectangles that tile a letter, its lower left corner at the origin; squares of this side [nm].
// Throws InputError for a letter without a glyph.
std::vector<Polygon> glyph(char letter, std::int32_t square);

}  // namespace papilla::geometry
