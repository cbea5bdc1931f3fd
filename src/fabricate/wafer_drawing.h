// A planned wafer as a layout: one cell a design, fields, letters and marks by reference.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "fabricate/wafer.h"
#include "geometry/io/drawing.h"

namespace papilla::fabricate {

// A mask: everything on it is etched as deep.
struct WaferLevel {
  int number = 1;                    // of its layer
  double etch = 0;                   // [m] into the master; 0: labels and marks alone
  std::vector<std::string> designs;  // names of those that it shapes
};

// One array of a design, in the cell of this name.
struct DrawnArray {
  std::string design, cell;
  MaskedArray masked;
};

struct WaferDrawing {
  Layout layout;
  std::vector<WaferLevel> levels;
  std::vector<DrawnArray> arrays;
  std::vector<std::string> notes;  // what is drawn otherwise than designed
};

// Deep polygons on every layer, whatever a design draws; labels and marks on the first. A stack of
// arrays that adds up takes a mask for each. Throws InputError with what cannot be drawn, every
// design at once, and for more than eight masks.
WaferDrawing draw_wafer(const WaferPlan& plan);

// The polygons of a drawn array's cell around the middle of their feature [nm]; of lines as high as
// a period.
std::vector<Polygon> around_centre(const DrawnArray& array, const LayoutCell& cell);

}  // namespace papilla::fabricate
