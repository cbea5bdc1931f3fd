// Layouts and triangles against the design: places by the lattice, outlines by the feature.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <map>
#include <tuple>
#include <unordered_map>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "fabricate/checks.h"
#include "fabricate/layers.h"
#include "geometry/io/drawing.h"

namespace papilla::fabricate {
namespace {

// --- arrays ---

// Copies of one polygon, `columns` of them a step apart [nm].
struct PolygonRow {
  const LayoutPolygon* polygon;
  double x, y;  // of the first one's cell
  long columns;
  double step;
};

// Every polygon of a layout, row by row. Throws InputError far above `most` rows.
class Rows {
 public:
  Rows(const Layout& layout, std::size_t most) : layout_(layout), most_(most) {
    place(layout.cells.back(), 0, 0, 1, 0);
  }
  const std::vector<PolygonRow>& found() const { return rows_; }

 private:
  void place(const LayoutCell& cell, double x, double y, long columns, double step) {
    // A row is placed by way of two cells at most.
    if (++placed_ > 3 * most_) throw InputError("more rows of polygons than the design has");
    for (const LayoutPolygon& polygon : cell.polygons)
      rows_.push_back({&polygon, x, y, columns, step});
    for (const LayoutReference& r : cell.references) {
      const auto named = std::find_if(layout_.cells.begin(), layout_.cells.end(),
                                      [&](const LayoutCell& c) { return c.name == r.cell; });
      const bool across = r.columns > 1;
      for (long row = 0; row < r.rows; ++row) {
        const double dy = static_cast<double>(r.step_y) * static_cast<double>(row);
        if (across && columns > 1) throw InputError("an array of columns in an array of columns");
        place(*named, x + r.x, y + r.y + dy, across ? r.columns : columns,
              across ? static_cast<double>(r.step_x) : step);
      }
    }
  }

  const Layout& layout_;
  std::size_t most_, placed_ = 0;
  std::vector<PolygonRow> rows_;
};

struct Shape {
  double area = 0, x = 0, y = 0;  // centre of area [nm]
};

Shape shape_of(const Polygon& p) {
  Shape out;
  double sx = 0, sy = 0;
  for (std::size_t i = 0, n = p.x.size(); i < n; ++i) {
    const double ax = p.x[i], ay = p.y[i], bx = p.x[(i + 1) % n], by = p.y[(i + 1) % n];
    const double cross = ax * by - bx * ay;
    out.area += 0.5 * cross;
    sx += (ax + bx) * cross / 6, sy += (ay + by) * cross / 6;
  }
  if (out.area != 0) out.x = sx / out.area, out.y = sy / out.area;
  out.area = std::abs(out.area);
  return out;
}

// Where the design has its features: first of each row and the rows, [nm].
struct LatticeRows {
  std::vector<std::pair<double, double>> first;
  long columns = 0;
};

LatticeRows lattice_rows(const FeatureArray& array, const Grid& grid) {
  const double period = 1e9 * array.period;
  LatticeRows out;
  out.columns = std::lround(grid.lx / array.period);
  if (array.shape == FeatureArray::Shape::Line) {
    out.first = {{0.5 * period, 0.5e9 * grid.ly}};
    return out;
  }
  const bool hexagons = array.lattice == Lattice::Hexagonal;
  const double height = hexagons ? 0.5 * std::sqrt(3.0) * period : period;
  const long rows = std::lround(1e9 * grid.ly / height);
  for (long k = 0; k < rows; ++k) {
    const double x = !hexagons ? 0.5 : k % 2 == 0 ? 0.25 : 0.75;
    out.first.emplace_back(x * period, (static_cast<double>(k) + 0.5) * height);
  }
  return out;
}

// Outline of one feature around its centre.
Faults check_outline(const FeatureArray& array, const Grid& grid, double facet_error,
                     const LayoutPolygon& polygon) {
  Faults out;
  const bool line = array.shape == FeatureArray::Shape::Line;
  const Shape shape = shape_of(polygon.outline);
  const double area = 1e-18 * shape.area;
  const double width = line ? area / grid.ly : std::sqrt(4 / kPi * area);
  if (!(std::abs(width - array.width) <= 1e-9)) {
    out.push_back(fmt::format("its critical dimension (width of the {}) {}", array.drawn,
                              differs(width, array.width, 1e-6, "um")));
  }
  double most = 0;
  for (std::size_t i = 0; i < polygon.outline.x.size(); ++i) {
    const double x = 1e-9 * (polygon.outline.x[i] - shape.x),
                 y = 1e-9 * (polygon.outline.y[i] - shape.y);
    const double miss = line ? std::max(std::abs(std::abs(x) - 0.5 * array.width),
                                        std::abs(std::abs(y) - 0.5 * grid.ly))
                             : std::abs(std::hypot(x, y) - 0.5 * array.width);
    most = std::max(most, miss);
  }
  if (most > (line ? 0 : facet_error) + 1.5e-9) {
    out.push_back(
        fmt::format("a corner of its {} is {:.3g} nm off the outline", array.drawn, 1e9 * most));
  }
  if (polygon.layer != 1) out.push_back(fmt::format("layer {} in place of 1", polygon.layer));
  return out;
}

Faults check_array(const ExportSource& s, const FeatureArray& array, const Layout& layout) {
  const Grid& grid = s.heightmap.grid;
  const LatticeRows wanted = lattice_rows(array, grid);
  std::vector<PolygonRow> rows = Rows(layout, 2 * wanted.first.size() + 16).found();
  Faults out;
  std::map<const LayoutPolygon*, Shape> shapes;
  for (const PolygonRow& row : rows) {
    if (!shapes.emplace(row.polygon, shape_of(row.polygon->outline)).second) continue;
    for (const std::string& fault : check_outline(array, grid, s.options.facet_error, *row.polygon))
      out.push_back(fault);
  }
  double polygons = 0;
  for (const PolygonRow& row : rows) polygons += static_cast<double>(row.columns);
  const double due = static_cast<double>(wanted.columns) * static_cast<double>(wanted.first.size());
  if (polygons != due)
    out.push_back(fmt::format("{:.0f} polygons, the design's {:.0f}", polygons, due));
  const auto centre_y = [&](const PolygonRow& r) { return r.y + shapes.at(r.polygon).y; };
  std::sort(rows.begin(), rows.end(),
            [&](const PolygonRow& a, const PolygonRow& b) { return centre_y(a) < centre_y(b); });
  double most = 0, at_x = 0, at_y = 0;
  for (std::size_t k = 0; k < std::min(rows.size(), wanted.first.size()); ++k) {
    const PolygonRow& row = rows[k];
    const auto& [x, y] = wanted.first[k];
    const double last = static_cast<double>(std::min(row.columns, wanted.columns) - 1);
    const double dx = row.x + shapes.at(row.polygon).x - x, dy = centre_y(row) - y;
    const double end = dx + last * (row.columns > 1 ? row.step - 1e9 * array.period : 0);
    const double miss = std::hypot(std::max(std::abs(dx), std::abs(end)), dy);
    if (miss > most) most = miss, at_x = x, at_y = y;
  }
  if (most > 2) {
    out.push_back(
        fmt::format("its {} are up to {:.4g} nm off their places, in the row that begins "
                    "at ({:.4g}, {:.4g}) um",
                    array.drawn, most, 1e-3 * at_x, 1e-3 * at_y));
  }
  return out;
}

// --- contours ---

auto key(const LayoutPolygon& p) { return std::tie(p.layer, p.outline.y, p.outline.x); }

bool before(const LayoutPolygon& a, const LayoutPolygon& b) { return key(a) < key(b); }

Faults check_contours(const ExportSource& s, Layout& layout) {
  if (layout.cells.size() != 1 || !layout.cells[0].references.empty())
    return {"cells and references in place of plain polygons"};
  std::vector<LayoutPolygon>& found = layout.cells[0].polygons;
  Layout drawn = draw_contours(s.heightmap, s.options.levels, edge_planes(s.texture, s.heightmap));
  std::vector<LayoutPolygon>& wanted = drawn.cells[0].polygons;
  std::sort(found.begin(), found.end(), before);
  std::sort(wanted.begin(), wanted.end(), before);
  std::vector<LayoutPolygon> missing, foreign;
  std::set_difference(wanted.begin(), wanted.end(), found.begin(), found.end(),
                      std::back_inserter(missing), before);
  std::set_difference(found.begin(), found.end(), wanted.begin(), wanted.end(),
                      std::back_inserter(foreign), before);
  if (missing.empty() && foreign.empty()) return {};
  const LayoutPolygon& first = missing.empty() ? foreign.front() : missing.front();
  return {
      fmt::format("{} of the design's {} polygons are not there and {} are there that it does "
                  "not have, the first on layer {} at ({:.4g}, {:.4g}) um",
                  missing.size(), wanted.size(), foreign.size(), first.layer,
                  1e-3 * first.outline.x.front(), 1e-3 * first.outline.y.front())};
}

// --- names and labels of layers ---

Faults check_layers(const std::vector<LayoutLayer>& wanted, const std::vector<LayoutLayer>& found) {
  Faults out;
  for (const LayoutLayer& layer : wanted) {
    const auto same = [&](const LayoutLayer& l) { return l.number == layer.number; };
    const auto at = std::find_if(found.begin(), found.end(), same);
    if (at == found.end()) {
      out.push_back(fmt::format(
          "its layer {} has no name and label, which say what its polygons are: \"{}: {}\"",
          layer.number, layer.name, layer.label));
    } else if (*at != layer) {
      out.push_back(fmt::format("its layer {} is said to be \"{}: {}\", the design's \"{}: {}\"",
                                layer.number, at->name, at->label, layer.name, layer.label));
    }
  }
  if (found.size() > wanted.size()) out.push_back("labels of layers that the design does not have");
  return out;
}

Faults check_layout(const ExportSource& s, Layout layout) {
  const TextureFacts known = facts(s.texture);
  const FeatureArray* array = array_of(known);
  Faults out = array ? check_array(s, *array, layout) : check_contours(s, layout);
  const Faults labels = check_layers(layers_of(s), layout.layers);
  out.insert(out.end(), labels.begin(), labels.end());
  return out;
}

// --- triangles ---

struct Corner {
  float x, y, z;

  bool finite() const { return std::isfinite(x) && std::isfinite(y) && std::isfinite(z); }
};
struct Triangle {
  Corner normal;
  std::array<Corner, 3> corners;
};
static_assert(sizeof(Triangle) == 48);

// Whether the normal stands on the triangle, outwards: to the rounding of 32 bits of a product.
bool stands(const Triangle& t) {
  const auto& [a, b, c] = t.corners;
  const auto d = [](float to, float from) { return double{to} - double{from}; };
  const double ux = d(b.x, a.x), uy = d(b.y, a.y), uz = d(b.z, a.z), vx = d(c.x, a.x),
               vy = d(c.y, a.y), vz = d(c.z, a.z);
  const double x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
  const double length = std::sqrt(x * x + y * y + z * z);
  if (length == 0) return true;
  const Corner& n = t.normal;
  return std::hypot(double{n.x} - x / length, double{n.y} - y / length, double{n.z} - z / length) <=
         1e-3;
}

// A binary STL, one triangle at a time.
class Triangles {
 public:
  explicit Triangles(const std::string& path) : path_(path), file_(RegularFile(path).stream()) {
    std::array<char, 84> head{};
    get(head.data(), head.size());
    std::memcpy(&count, &head[80], 4);
  }
  Triangle next() {
    std::array<char, 50> bytes{};
    get(bytes.data(), bytes.size());
    Triangle out{};
    std::memcpy(&out, bytes.data(), sizeof out);
    return out;
  }
  bool at_end() { return file_.peek() == std::ifstream::traits_type::eof(); }

  std::uint32_t count = 0;

 private:
  void get(char* to, std::size_t size) {
    if (!file_.read(to, static_cast<std::streamsize>(size)))
      throw InputError("cannot read " + path_ + ": the data are cut off");
  }
  std::string path_;
  std::ifstream file_;
};

// Whether triangles close a body: each edge of one is that of another in the other direction.
// Corners are numbers.
class EdgeCheck {
 public:
  void add(const std::array<std::uint32_t, 3>& corners) {
    for (std::size_t i = 0; i < 3; ++i) add(corners[i], corners[(i + 1) % 3]);
  }
  // Edges without one in the other direction.
  std::size_t open() const { return open_; }

 private:
  void add(std::uint32_t from, std::uint32_t to) {
    if (const auto other = edges_.find(key(to, from)); other != edges_.end()) {
      --open_;
      if (--other->second == 0) edges_.erase(other);
      return;
    }
    ++open_;
    // In the order of our files the edges of a row of pixels wait, and those of the sides; beyond
    // so many, of which a file is far from closed, the others stay open.
    constexpr std::size_t kMost = 1 << 22;
    if (edges_.size() < kMost) ++edges_[key(from, to)];
  }
  static std::uint64_t key(std::uint32_t from, std::uint32_t to) {
    return std::uint64_t{from} << 32 | to;
  }

  std::unordered_map<std::uint64_t, int> edges_;  // that wait for the other direction, how often
  std::size_t open_ = 0;
};

// Corners lie on the pixels of the surface or on the base, in um.
class BodyCheck {
 public:
  explicit BodyCheck(const Heightmap& h)
      : h_(h), low_(*std::min_element(h.z.begin(), h.z.end()) - 1e-6) {}

  Faults run(Triangles& file) {
    const Grid& grid = h_.grid;
    const std::uint64_t nx = static_cast<unsigned>(grid.nx), ny = static_cast<unsigned>(grid.ny);
    Faults out;
    if (const std::uint64_t due = 4 * nx * ny + 4 * (nx + ny); file.count != due)
      out.push_back(fmt::format("{} triangles, the design's {}", file.count, due));
    for (std::uint32_t i = 0; i < file.count; ++i) add(file.next());
    if (!file.at_end()) out.push_back("more after its last triangle");
    if (no_numbers_ > 0)
      out.push_back(
          fmt::format("{} triangles have corners that are no finite numbers", no_numbers_));
    side(out, "its width", right_, grid.lx);
    side(out, "its height", top_, grid.ly);
    double mean = 0;
    for (const double z : h_.z) mean += (z - low_) / static_cast<double>(h_.z.size());
    const double volume = 1e18 * mean * grid.area();
    if (!(std::abs(volume_ / volume - 1) <= 1e-4))
      out.push_back("its volume " + differs(volume_, volume, 1, "um3"));
    if (off_ > 0) {
      out.push_back(
          fmt::format("{} corners are off the surface, by {:.4g} nm at most, at ({:.4g}, "
                      "{:.4g}) um",
                      off_, 1e3 * most_, most_x_, most_y_));
    }
    if (turned_ > 0) {
      out.push_back(
          fmt::format("the normals of {} triangles do not stand on them, outwards", turned_));
    }
    // Corners that are off or no numbers leave edges open by themselves.
    if (off_ == 0 && no_numbers_ == 0 && edges_.open() > 0) {
      out.push_back(
          fmt::format("{} edges of triangles are those of no other one in the opposite "
                      "direction: the body is not closed",
                      edges_.open()));
    }
    return out;
  }

 private:
  static void side(Faults& out, const char* what, double is, double design) {
    if (!(std::abs(1e-6 * is / design - 1) <= 1e-6))
      out.push_back(fmt::format("{} {}", what, differs(1e-6 * is, design, 1e-6, "um")));
  }
  void add(const Triangle& t) {
    if (!std::all_of(t.corners.begin(), t.corners.end(),
                     [](const Corner& corner) { return corner.finite(); })) {
      ++no_numbers_;
      return;
    }
    const auto& [a, b, c] = t.corners;
    const auto d = [](float v) { return static_cast<double>(v); };
    volume_ += (d(a.x) * (d(b.y) * d(c.z) - d(b.z) * d(c.y)) -
                d(a.y) * (d(b.x) * d(c.z) - d(b.z) * d(c.x)) +
                d(a.z) * (d(b.x) * d(c.y) - d(b.y) * d(c.x))) /
               6;
    std::array<std::uint32_t, 3> corners{};
    const std::size_t off = off_;
    for (std::size_t i = 0; i < 3; ++i) corners[i] = judge(t.corners[i]);
    if (off_ != off) return;  // corners that are off turn it by themselves
    turned_ += !stands(t);
    edges_.add(corners);
  }
  // The number of the corner, where it is not off.
  std::uint32_t judge(const Corner& corner) {
    const Grid& grid = h_.grid;
    const double x = static_cast<double>(corner.x), y = static_cast<double>(corner.y),
                 z = static_cast<double>(corner.z);
    right_ = std::max(right_, x), top_ = std::max(top_, y);
    const double column = 1e-6 * x / grid.dx(), row = 1e-6 * y / grid.dy();
    if (!(column >= -0.5 && column <= grid.nx + 0.5 && row >= -0.5 && row <= grid.ny + 0.5)) {
      note(kInfinity, x, y);
      return 0;
    }
    const int ix = static_cast<int>(std::lround(column)), iy = static_cast<int>(std::lround(row));
    const double high = 1e6 * (h_(ix % grid.nx, iy % grid.ny) - low_);
    const double beside =
        std::max(std::abs(column - ix) * grid.dx(), std::abs(row - iy) * grid.dy());
    const double miss = std::max(z == 0 ? 0 : std::abs(z - high), 1e6 * beside);
    if (!(miss <= 2e-7 * std::max({high, x, y}))) note(miss, x, y);
    const std::size_t place =
        static_cast<std::size_t>(iy) * (static_cast<std::size_t>(grid.nx) + 1) +
        static_cast<std::size_t>(ix);
    return static_cast<std::uint32_t>(2 * place + (z == 0 ? 1 : 0));
  }
  void note(double miss, double x, double y) {
    ++off_;
    if (miss > most_) most_ = miss, most_x_ = x, most_y_ = y;
  }

  const Heightmap& h_;
  double low_;
  double right_ = 0, top_ = 0, volume_ = 0;  // um
  std::size_t off_ = 0, no_numbers_ = 0, turned_ = 0;
  EdgeCheck edges_;
  double most_ = 0, most_x_ = 0, most_y_ = 0;
};

}  // namespace

Faults check_gds(const ExportSource& s, const std::string& path) {
  return check_layout(s, read_gds(path));
}

Faults check_oasis(const ExportSource& s, const std::string& path) {
  return check_layout(s, read_oasis(path));
}

Faults check_stl(const ExportSource& s, const std::string& path) {
  Triangles file(path);
  return BodyCheck(s.heightmap).run(file);
}

}  // namespace papilla::fabricate
