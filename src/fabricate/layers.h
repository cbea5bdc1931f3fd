// What a layout says of itself: names and labels of its layers.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "fabricate/formats.h"
#include "geometry/io/drawing.h"

namespace papilla::fabricate {

// One layer of an array, one per level of contours. The label says which side of an edge is deep,
// what the polygons are, how deep the texture is and how it repeats.
std::vector<LayoutLayer> layers_of(const ExportSource& source);

}  // namespace papilla::fabricate
