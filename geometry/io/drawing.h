// Layouts as values: cells of polygons and of references to other cells, as GDSII and OASIS have
// them. Lengths in whole nanometres.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "geometry/facts.h"
#include "geometry/heightmap.h"
#include "geometry/io/mask.h"

namespace papilla::geometry {

struct LayoutPolygon {
  int layer = 1;
  Polygon outline;  // [nm], without the closing point

  bool operator==(const LayoutPolygon&) const = default;
};

// A cell placed once, or columns x rows times along x and y.
struct LayoutReference {
  std::string cell;
  std::int32_t x = 0, y = 0;  // of the first [nm]
  long columns = 1, rows = 1;
  std::int64_t step_x = 0, step_y = 0;  // [nm]
  bool array = false;                   // written as an array, even of one
};

struct LayoutCell {
  std::string name;
  std::vector<LayoutPolygon> polygons;
  std::vector<LayoutReference> references;
};

// What the polygons of a layer are, in the file itself: without it holes and pillars of one size
// are the same file, and a wrong tone inverts the plate.
struct LayoutLayer {
  int number = 1;
  std::string name;   // "HOLES_DEEP": no spaces
  std::string label;  // a text in the top cell: tone, kind, depth, pitch

  bool operator==(const LayoutLayer&) const = default;
};

struct Layout {
  std::vector<LayoutCell> cells;  // each after those that it refers to; the last is the top
  std::vector<LayoutLayer> layers;
};

// What an array became.
struct LayoutArray {
  long columns = 0, rows = 0;
  double pitch_x = 0, pitch_y = 0;  // [m]; y of hexagons: of two rows, mean over a block
  double drift = 0;   // of the last rows from their exact place [m]; 0 but for hexagons
  int sides = 0;      // of a circle
  std::string drawn;  // "holes", "pillars", "grooves": what the polygons are
};

struct ArrayDrawing {
  Layout layout;
  LayoutArray array;
};

// An array (facts(texture).outline): one polygon cell, referred to over size_x x size_y [m], layer
// 1. Circles are polygons with the area of the circle, at most facet_error [m] off it, rounded to
// the nanometre. The row pitch of hexagons is on no grid: a block of rows, each rounded alone, is
// repeated, so that over the whole array no hole is more than 1 nm off its place along y. Throws
// InputError for a period that is not whole nanometres.
ArrayDrawing draw_array(const FeatureArray& array, double size_x, double size_y,
                        double facet_error = 2e-9);

// Any heightmap as masks: layer k of `levels` holds the contour polygons of what is deeper than
// (k - 1/2)/levels of the whole depth; one level is a binary mask. The depth is that between two
// planes, of which the pixels may cut sharp ends off; without them from the highest pixel to the
// lowest. Throws InputError above two million polygons.
Layout draw_contours(const Heightmap& h, int levels,
                     const std::optional<Planes>& between = std::nullopt);

// Files, the same bytes on every run: GDSII with a database unit of 1 nm (arrays of more than 32767
// cells a side in parts), OASIS with its repetitions and a sum over all of it. Labels are texts at
// the origin of the top cell. GDSII has no names of layers: there the name stands before the label.
void write_gds(const std::string& path, const Layout& layout);
void write_oasis(const std::string& path, const Layout& layout);

// What those two write, read back; polygons, references and labels alone, an array that GDSII has
// in parts as the one that was drawn. Throws InputError for anything else, for files that are cut
// off or changed, and for units other than 1 nm.
Layout read_gds(const std::string& path);
Layout read_oasis(const std::string& path);

}  // namespace papilla::geometry
