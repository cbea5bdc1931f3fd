#include "geometry/io/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <sstream>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "geometry/io/mask.h"

namespace papilla::geometry {
namespace {

// --- GDSII stream: big-endian records [length, type, data] ---

using Points = std::vector<std::pair<std::int32_t, std::int32_t>>;  // nm

class GdsStream {
 public:
  void empty(int type) { record(type, {}); }
  void shorts(int type, const std::vector<int>& values) {
    std::string data;
    for (const int v : values) {
      data += static_cast<char>((v >> 8) & 0xff);
      data += static_cast<char>(v & 0xff);
    }
    record(type, data);
  }
  void text(int type, std::string value) {
    if (value.size() % 2) value += '\0';
    record(type, value);
  }
  void reals(int type, const std::vector<double>& values) {
    std::string data;
    for (const double v : values) data += real(v);
    record(type, data);
  }
  void points(const Points& points) {
    std::string data;
    for (const auto& [x, y] : points) data += word(x) + word(y);
    record(0x1003, data);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void record(int type, const std::string& data) {
    const std::size_t length = data.size() + 4;
    bytes_ += static_cast<char>(length >> 8);
    bytes_ += static_cast<char>(length & 0xff);
    bytes_ += static_cast<char>(type >> 8);
    bytes_ += static_cast<char>(type & 0xff);
    bytes_ += data;
  }
  static std::string word(std::int32_t value) {
    const auto u = static_cast<std::uint32_t>(value);
    std::string out;
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>((u >> shift) & 0xff);
    return out;
  }
  // Excess-64, base-16 exponent, 56-bit mantissa.
  static std::string real(double value) {
    int exponent = 64;
    while (value >= 1) value /= 16, ++exponent;
    while (value < 1.0 / 16) value *= 16, --exponent;
    const auto mantissa = static_cast<std::uint64_t>(std::llround(std::ldexp(value, 56)));
    std::string out(1, static_cast<char>(exponent));
    for (int shift = 48; shift >= 0; shift -= 8) {
      out += static_cast<char>((mantissa >> shift) & 0xff);
    }
    return out;
  }

  std::string bytes_;
};

std::int32_t nanometres(double metres) {
  return static_cast<std::int32_t>(std::lround(1e9 * metres));
}

void boundary(GdsStream& gds, Points points, int layer = 1) {
  points.push_back(points.front());
  gds.empty(0x0800);
  gds.shorts(0x0D02, {layer});
  gds.shorts(0x0E02, {0});
  gds.points(points);
  gds.empty(0x1100);
}

// Sides of a polygon whose middles and corners stay within `error` of the circle.
int circle_sides(double diameter, double error) {
  const double share = std::min(0.5, error / (0.5 * diameter));
  const int sides = static_cast<int>(std::ceil(kPi / std::acos(1 - share)));
  return std::clamp((sides + 3) / 4 * 4, 8, 1024);
}

Points circle(double x, double y, double diameter, int sides) {
  // The polygon has the area of the circle.
  const double step = 2 * kPi / sides;
  const double radius = 0.5 * diameter * std::sqrt(step / std::sin(step));
  Points points;
  for (int i = 0; i < sides; ++i) {
    const double angle = (i + 0.5) * step;
    points.emplace_back(nanometres(x + radius * std::cos(angle)),
                        nanometres(y + radius * std::sin(angle)));
  }
  return points;
}

// A length on the database grid; refused where it is not.
double on_grid(double period) {
  const double nm = 1e9 * period, whole = std::round(nm);
  if (std::abs(nm - whole) > 1e-4) {
    throw InputError(
        fmt::format("period {:.8g} nm is not on the 1 nm grid of GDSII; use {:.0f} nm or {:.0f} nm",
                    nm, std::floor(nm), std::ceil(nm)));
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
  Points polygon;
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
  cell.polygon = circle(0, 0, diameter, sides);
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
  cell.polygon = {{left, 0}, {right, 0}, {right, top}, {left, top}};
  return cell;
}

// References to CELL, one per row of a block, in a structure of their own.
void block_structure(GdsStream& gds, const std::string& name, const ArrayCell& cell,
                     const std::vector<int>& date, std::size_t rows) {
  gds.shorts(0x0502, date);
  gds.text(0x0606, name);
  for (std::size_t i = 0; i < rows; ++i) {
    gds.empty(0x0A00);
    gds.text(0x1206, "CELL");
    gds.points({{static_cast<std::int32_t>(std::lround(cell.shifts[i])),
                 static_cast<std::int32_t>(std::lround(cell.rows[i]))}});
    gds.empty(0x1100);
  }
  gds.empty(0x0700);
}

void array_reference(GdsStream& gds, const std::string& name, long columns, long rows,
                     std::int32_t y, std::int32_t width, std::int32_t height) {
  gds.empty(0x0B00);
  gds.text(0x1206, name);
  gds.shorts(0x1302, {static_cast<int>(columns), static_cast<int>(rows)});
  gds.points({{0, y}, {width, y}, {0, y + height}});
  gds.empty(0x1100);
}

// --- STL ---

struct Vertex {
  float x, y, z;
};

void triangle(std::string& out, const Vertex& a, const Vertex& b, const Vertex& c) {
  const float ux = b.x - a.x, uy = b.y - a.y, uz = b.z - a.z;
  const float vx = c.x - a.x, vy = c.y - a.y, vz = c.z - a.z;
  float nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const float length = std::sqrt(nx * nx + ny * ny + nz * nz);
  if (length > 0) nx /= length, ny /= length, nz /= length;
  const std::array<float, 12> values{nx, ny, nz, a.x, a.y, a.z, b.x, b.y, b.z, c.x, c.y, c.z};
  out.append(reinterpret_cast<const char*>(values.data()), sizeof(values));
  out.append(2, '\0');
}

}  // namespace

GdsArray write_gds(const std::string& path, const FeatureArray& array, double size_x, double size_y,
                   double facet_error) {
  GdsArray out;
  out.drawn = array.drawn;
  const bool lines = array.shape == FeatureArray::Shape::Line;
  if (!lines) out.sides = circle_sides(array.width, facet_error);
  const ArrayCell cell =
      lines ? line_cell(array.period, array.width, size_y)
            : round_cell(array.lattice, array.period, array.width, out.sides, size_y);
  out.columns = std::max(1L, std::lround(1e9 * size_x / cell.x));
  out.rows = std::max(1L, std::lround(1e9 * size_y / cell.y));
  if (out.columns > 32767 || out.rows > 32767 || size_x > 2.1 || size_y > 2.1) {
    throw InputError(fmt::format("{} x {} cells are more than one GDSII array holds (32767 a side)",
                                 out.columns, out.rows));
  }
  const auto block = static_cast<std::int32_t>(std::lround(cell.repeats * cell.y));
  const long blocks = out.rows / cell.repeats, left = out.rows % cell.repeats;
  out.pitch_x = 1e-9 * cell.x;
  out.pitch_y = 1e-9 * block / cell.repeats;
  out.drift = 1e-9 * std::abs(block - cell.repeats * cell.y) * static_cast<double>(blocks);
  const std::vector<int> date{2025, 1, 1, 0, 0, 0, 2025, 1, 1, 0, 0, 0};
  GdsStream gds;
  gds.shorts(0x0002, {600});
  gds.shorts(0x0102, date);
  gds.text(0x0206, "PAPILLA");
  gds.reals(0x0305, {1e-3, 1e-9});  // one database unit is 1e-3 um, 1e-9 m
  gds.shorts(0x0502, date);
  gds.text(0x0606, "CELL");
  // One row a block: its place goes into the polygon, and the array repeats the cell itself.
  const bool single = cell.rows.size() == 1;
  Points polygon = cell.polygon;
  if (single) {
    for (auto& [x, y] : polygon) {
      x += static_cast<std::int32_t>(std::lround(cell.shifts[0]));
      y += static_cast<std::int32_t>(std::lround(cell.rows[0]));
    }
  }
  boundary(gds, polygon);
  gds.empty(0x0700);
  const std::size_t rows_left =
      cell.rows.size() / static_cast<std::size_t>(cell.repeats) * static_cast<std::size_t>(left);
  if (!single) {
    block_structure(gds, "BLOCK", cell, date, cell.rows.size());
    if (rows_left > 0) block_structure(gds, "REST", cell, date, rows_left);
  }
  gds.shorts(0x0502, date);
  gds.text(0x0606, "TEXTURE");
  const auto width = static_cast<std::int32_t>(out.columns * cell.x);
  const auto height = static_cast<std::int32_t>(blocks * block);
  array_reference(gds, single ? "CELL" : "BLOCK", out.columns, blocks, 0, width, height);
  if (rows_left > 0) array_reference(gds, "REST", out.columns, 1, height, width, block);
  gds.empty(0x0700);
  gds.empty(0x0400);
  write_bytes(path, gds.bytes());
  return out;
}

std::size_t write_gds_mask(const std::string& path, const Heightmap& h, int levels) {
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  const std::vector<int> date{2025, 1, 1, 0, 0, 0, 2025, 1, 1, 0, 0, 0};
  GdsStream gds;
  gds.shorts(0x0002, {600});
  gds.shorts(0x0102, date);
  gds.text(0x0206, "PAPILLA");
  gds.reals(0x0305, {1e-3, 1e-9});
  gds.shorts(0x0502, date);
  gds.text(0x0606, "TEXTURE");
  std::size_t count = 0;
  for (int k = 1; k <= levels && *high > *low; ++k) {
    const double level = *high - (k - 0.5) / levels * (*high - *low);
    for (const Polygon& polygon : polygons_below(h, level)) {
      Points points;
      for (std::size_t i = 0; i < polygon.x.size(); ++i)
        points.emplace_back(polygon.x[i], polygon.y[i]);
      boundary(gds, points, k);
      if (++count > 2000000)
        throw InputError(path + ": more than two million polygons; fewer pixels");
    }
  }
  gds.empty(0x0700);
  gds.empty(0x0400);
  write_bytes(path, gds.bytes());
  return count;
}

DoseCurve read_dose_curve(const std::string& path) {
  std::istringstream in(read_bytes(path, 1 << 20));
  DoseCurve out;
  std::string line;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line.front() == '#') continue;
    double depth = 0, grey = 0;
    char rest = 0;
    if (std::sscanf(line.c_str(), "%lf , %lf %c", &depth, &grey, &rest) != 2) {
      const bool other_separator = line.find_first_of(";\t") != std::string::npos;
      if (number == 1 && !other_separator) continue;  // a heading
      throw InputError(
          fmt::format("{}:{}: expected depth_nm,grey{}", path, number,
                      other_separator ? "; the separator is a comma, decimals a point" : ""));
    }
    if (!(grey >= 0 && grey <= 255) || !(depth >= 0 && depth < 1e9))
      throw InputError(
          fmt::format("{}:{}: expected a depth from 0 and a grey of 0 to 255", path, number));
    out.depth.push_back(1e-9 * depth);
    out.grey.push_back(grey);
  }
  if (out.depth.size() < 2) throw InputError(path + ": expected at least two lines depth_nm,grey");
  if (out.depth.front() > out.depth.back()) {
    std::reverse(out.depth.begin(), out.depth.end());
    std::reverse(out.grey.begin(), out.grey.end());
  }
  const bool rising = out.grey.back() > out.grey.front();
  for (std::size_t i = 1; i < out.depth.size(); ++i) {
    const bool grey_moves = rising ? out.grey[i] > out.grey[i - 1] : out.grey[i] < out.grey[i - 1];
    if (out.depth[i] <= out.depth[i - 1] || !grey_moves) {
      throw InputError(fmt::format("{}: depth over grey is not monotone at {:.4g} nm, grey {:.4g}",
                                   path, 1e9 * out.depth[i], out.grey[i]));
    }
  }
  return out;
}

void write_stl(const std::string& path, const Heightmap& h, double base) {
  const Grid& grid = h.grid;
  if (grid.size() > 4000000) {
    throw InputError(
        fmt::format("{} x {} pixels are too many for STL; export fewer", grid.nx, grid.ny));
  }
  const double floor = *std::min_element(h.z.begin(), h.z.end()) - base;
  // The first row and column again at the far sides, so that tiles meet; all half a pixel nearer
  // the origin, so that the block starts there.
  const auto at = [&](int ix, int iy) {
    return Vertex{static_cast<float>(1e6 * ix * grid.dx()),
                  static_cast<float>(1e6 * iy * grid.dy()),
                  static_cast<float>(1e6 * (h(ix % grid.nx, iy % grid.ny) - floor))};
  };
  const auto below = [](Vertex v) {
    v.z = 0;
    return v;
  };
  const int nx = grid.nx + 1, ny = grid.ny + 1;
  const auto faces = static_cast<std::uint32_t>(4L * (nx - 1) * (ny - 1) + 4L * (nx - 1 + ny - 1));
  std::string out(80, '\0');
  out.replace(0, 24, "papilla heightmap in um ");
  out.append(reinterpret_cast<const char*>(&faces), 4);
  out.reserve(84 + 50 * static_cast<std::size_t>(faces));
  for (int iy = 0; iy + 1 < ny; ++iy) {
    for (int ix = 0; ix + 1 < nx; ++ix) {
      const Vertex a = at(ix, iy), b = at(ix + 1, iy), c = at(ix + 1, iy + 1), d = at(ix, iy + 1);
      triangle(out, a, b, c);
      triangle(out, a, c, d);
      triangle(out, below(a), below(c), below(b));
      triangle(out, below(a), below(d), below(c));
    }
  }
  const auto wall = [&](const Vertex& a, const Vertex& b) {  // seen from outside, a left of b
    triangle(out, below(a), below(b), b);
    triangle(out, below(a), b, a);
  };
  for (int ix = 0; ix + 1 < nx; ++ix) {
    wall(at(ix, 0), at(ix + 1, 0));
    wall(at(ix + 1, ny - 1), at(ix, ny - 1));
  }
  for (int iy = 0; iy + 1 < ny; ++iy) {
    wall(at(nx - 1, iy), at(nx - 1, iy + 1));
    wall(at(0, iy + 1), at(0, iy));
  }
  write_bytes(path, out);
}

}  // namespace papilla::geometry
