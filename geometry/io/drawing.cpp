#include "geometry/io/drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "base/error.h"

namespace papilla::geometry {
namespace {

std::int32_t nanometres(double metres) {
  return static_cast<std::int32_t>(std::lround(1e9 * metres));
}

// Sides of a polygon whose middles and corners stay within `error` of the circle.
int circle_sides(double diameter, double error) {
  const double share = std::min(0.5, error / (0.5 * diameter));
  const int sides = static_cast<int>(std::ceil(kPi / std::acos(1 - share)));
  return std::clamp((sides + 3) / 4 * 4, 8, 1024);
}

Polygon circle(double diameter, int sides) {
  // The polygon has the area of the circle.
  const double step = 2 * kPi / sides;
  const double radius = 0.5 * diameter * std::sqrt(step / std::sin(step));
  Polygon points;
  for (int i = 0; i < sides; ++i) {
    const double angle = (i + 0.5) * step;
    points.x.push_back(nanometres(radius * std::cos(angle)));
    points.y.push_back(nanometres(radius * std::sin(angle)));
  }
  return points;
}

// A length on the database grid; refused where it is not.
double on_grid(double period) {
  const double nm = 1e9 * period, whole = std::round(nm);
  if (std::abs(nm - whole) > 1e-4) {
    throw InputError(fmt::format(
        "period {:.8g} nm is not on the 1 nm grid of layouts; use {:.0f} nm or {:.0f} nm", nm,
        std::floor(nm), std::ceil(nm)));
  }
  return 1e-9 * whole;
}

// What is repeated: polygons of a cell around its origin, placed at `places` along a block that the
// array repeats. A square array has one place; hexagons have a row pitch of sqrt(3) periods, on no
// grid, so a block holds as many rows as come back to the grid.
struct ArrayCell {
  std::int32_t x = 0;             // pitch [nm]
  std::vector<double> rows{0};    // heights of the rows in a block [nm]
  std::vector<double> shifts{0};  // of each row along x [nm]
  double y = 0;                   // exact height of one repeat of rows [nm]
  int repeats = 1;                // repeats in a block
  Polygon polygon;
};

// The block of m repeats that ends nearest to the grid: over `count` repeats its rounding adds up
// to half a nanometre at most (m grows to about the root of 2 count).
int block_of(double pitch, long count) {
  for (int m = 1; m < 4096; ++m) {
    const double miss = std::abs(m * pitch - std::round(m * pitch));
    if (m >= count || miss * static_cast<double>(count) / m <= 0.5) return m;
  }
  return 4096;
}

ArrayCell round_cell(Lattice lattice, double period, double diameter, int sides, double size_y) {
  const double p = on_grid(period);
  ArrayCell cell;
  cell.x = nanometres(p);
  cell.y = 1e9 * p;
  cell.polygon = circle(diameter, sides);
  cell.rows = {0.5 * cell.y};
  cell.shifts = {0.5 * cell.x};
  if (lattice == Lattice::Square) return cell;
  cell.y = std::sqrt(3.0) * 1e9 * p;
  cell.repeats = block_of(cell.y, std::max(1L, std::lround(1e9 * size_y / cell.y)));
  cell.rows.clear();
  cell.shifts.clear();
  for (int k = 0; k < 2 * cell.repeats; ++k) {
    cell.rows.push_back((0.25 + 0.5 * k) * cell.y);
    cell.shifts.push_back((k % 2 == 0 ? 0.25 : 0.75) * cell.x);
  }
  return cell;
}

// Lines run over the whole height.
ArrayCell line_cell(double period, double width, double size_y) {
  const std::int32_t left = nanometres(0.5 * (period - width));
  const std::int32_t right = nanometres(0.5 * (period + width));
  const std::int32_t top = nanometres(size_y);
  ArrayCell cell;
  cell.x = nanometres(on_grid(period));
  cell.y = top;
  cell.polygon = {{left, right, right, left}, {0, 0, top, top}};
  return cell;
}

// References to CELL, one per row of a block, in a cell of their own.
LayoutCell block_of_rows(const std::string& name, const ArrayCell& cell, std::size_t rows) {
  LayoutCell out{name, {}, {}};
  for (std::size_t i = 0; i < rows; ++i) {
    out.references.push_back({.cell = "CELL",
                              .x = static_cast<std::int32_t>(std::lround(cell.shifts[i])),
                              .y = static_cast<std::int32_t>(std::lround(cell.rows[i]))});
  }
  return out;
}

}  // namespace

ArrayDrawing draw_array(const FeatureArray& array, double size_x, double size_y,
                        double facet_error) {
  ArrayDrawing drawing;
  LayoutArray& out = drawing.array;
  out.drawn = array.drawn;
  const bool lines = array.shape == FeatureArray::Shape::Line;
  if (!lines) out.sides = circle_sides(array.width, facet_error);
  const ArrayCell cell =
      lines ? line_cell(array.period, array.width, size_y)
            : round_cell(array.lattice, array.period, array.width, out.sides, size_y);
  if (size_x > 2.1 || size_y > 2.1)
    throw InputError("a layout reaches 2.1 m at most: its unit is 1 nm in 32 bits");
  out.columns = std::max(1L, std::lround(1e9 * size_x / cell.x));
  out.rows = std::max(1L, std::lround(1e9 * size_y / cell.y));
  const auto block = static_cast<std::int32_t>(std::lround(cell.repeats * cell.y));
  const long blocks = out.rows / cell.repeats, left = out.rows % cell.repeats;
  out.pitch_x = 1e-9 * cell.x;
  out.pitch_y = 1e-9 * block / cell.repeats;
  out.drift = 1e-9 * std::abs(block - cell.repeats * cell.y) * static_cast<double>(blocks);
  // One row a block: its place goes into the polygon, and the array repeats the cell itself.
  const bool single = cell.rows.size() == 1;
  Polygon polygon = cell.polygon;
  if (single) {
    for (auto& x : polygon.x) x += static_cast<std::int32_t>(std::lround(cell.shifts[0]));
    for (auto& y : polygon.y) y += static_cast<std::int32_t>(std::lround(cell.rows[0]));
  }
  std::vector<LayoutCell>& cells = drawing.layout.cells;
  cells.push_back({"CELL", {{1, polygon}}, {}});
  const std::size_t rows_left =
      cell.rows.size() / static_cast<std::size_t>(cell.repeats) * static_cast<std::size_t>(left);
  if (!single) {
    cells.push_back(block_of_rows("BLOCK", cell, cell.rows.size()));
    if (rows_left > 0) cells.push_back(block_of_rows("REST", cell, rows_left));
  }
  LayoutCell top{"TEXTURE", {}, {}};
  const auto repeated = [&](const char* name, std::int32_t y, long rows) {
    top.references.push_back({.cell = name,
                              .x = 0,
                              .y = y,
                              .columns = out.columns,
                              .rows = rows,
                              .step_x = cell.x,
                              .step_y = block,
                              .array = true});
  };
  repeated(single ? "CELL" : "BLOCK", 0, blocks);
  if (rows_left > 0) repeated("REST", static_cast<std::int32_t>(blocks * block), 1);
  cells.push_back(std::move(top));
  return drawing;
}

Layout draw_contours(const Heightmap& h, int levels, const std::optional<Planes>& between) {
  const auto [low, high] = between ? *between : planes_of(h);
  LayoutCell top{"TEXTURE", {}, {}};
  for (int k = 1; k <= levels && high > low; ++k) {
    const double level = high - (k - 0.5) / levels * (high - low);
    for (Polygon& polygon : polygons_below(h, level)) {
      top.polygons.push_back({k, std::move(polygon)});
      if (top.polygons.size() > 2000000)
        throw InputError("more than two million polygons; fewer pixels");
    }
  }
  return {{std::move(top)}, {}};
}

}  // namespace papilla::geometry
