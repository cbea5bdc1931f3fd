// Pictures of fields with a legend below: colours from least to most, numbers, a scale bar.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "geometry/heightmap.h"

namespace papilla::geometry {

struct FieldPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  // rows, top first
};

// What a field is shown as.
struct FieldScale {
  double scale = 1;   // shown = value * scale
  std::string unit;   // of what is shown: of digits, e . + - % and the letters of nm, um, kPa, MPa
  bool root = false;  // colours by the square root above the least value: fields that are mostly 0
};

FieldPicture picture_with_legend(const Grid& grid, const std::vector<double>& values,
                                 const FieldScale& shown);

// Heights of a preview, in nm from the map's own zero.
FieldPicture picture_of_heights(const Heightmap& h);

}  // namespace papilla::geometry
