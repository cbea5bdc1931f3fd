// GDSII: big-endian records [length, type, data].
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "geometry/io/drawing.h"

namespace papilla::geometry {
namespace {

enum Record {
  kHeader = 0x0002,
  kLibrary = 0x0102,
  kLibraryName = 0x0206,
  kUnits = 0x0305,
  kLibraryEnd = 0x0400,
  kCell = 0x0502,
  kCellName = 0x0606,
  kCellEnd = 0x0700,
  kBoundary = 0x0800,
  kReference = 0x0A00,
  kArray = 0x0B00,
  kText = 0x0C00,
  kLayer = 0x0D02,
  kDataType = 0x0E02,
  kPoints = 0x1003,
  kElementEnd = 0x1100,
  kTarget = 0x1206,
  kColumnsRows = 0x1302,
  kTextType = 0x1602,
  kString = 0x1906,
};

using Points = std::vector<std::pair<std::int32_t, std::int32_t>>;  // [nm]

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
    record(kPoints, data);
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

void boundary(GdsStream& gds, const LayoutPolygon& polygon) {
  Points points;
  const Polygon& outline = polygon.outline;
  for (std::size_t i = 0; i <= outline.x.size(); ++i)  // closed
    points.emplace_back(outline.x[i % outline.x.size()], outline.y[i % outline.x.size()]);
  gds.empty(kBoundary);
  gds.shorts(kLayer, {polygon.layer});
  gds.shorts(kDataType, {0});
  gds.points(points);
  gds.empty(kElementEnd);
}

void reference(GdsStream& gds, const LayoutReference& r) {
  gds.empty(r.array ? kArray : kReference);
  gds.text(kTarget, r.cell);
  if (r.array) {
    const auto width = static_cast<std::int32_t>(r.columns * r.step_x),
               height = static_cast<std::int32_t>(r.rows * r.step_y);
    gds.shorts(kColumnsRows, {static_cast<int>(r.columns), static_cast<int>(r.rows)});
    gds.points({{r.x, r.y}, {r.x + width, r.y}, {r.x, r.y + height}});
  } else {
    gds.points({{r.x, r.y}});
  }
  gds.empty(kElementEnd);
}

constexpr long kMostInRecord = 32767;  // columns, and rows, of an array in one record

// An array in pieces that one record holds.
std::vector<LayoutReference> parts_of(const LayoutReference& whole) {
  std::vector<LayoutReference> out;
  for (long row = 0; row < whole.rows; row += kMostInRecord) {
    for (long column = 0; column < whole.columns; column += kMostInRecord) {
      LayoutReference part = whole;
      part.x = static_cast<std::int32_t>(whole.x + column * whole.step_x);
      part.y = static_cast<std::int32_t>(whole.y + row * whole.step_y);
      part.columns = std::min(kMostInRecord, whole.columns - column);
      part.rows = std::min(kMostInRecord, whole.rows - row);
      out.push_back(part);
    }
  }
  return out;
}

constexpr std::string_view kAfterName = ": ";  // of a layer, before its label

void label(GdsStream& gds, const LayoutLayer& layer) {
  gds.empty(kText);
  gds.shorts(kLayer, {layer.number});
  gds.shorts(kTextType, {0});
  gds.points({{0, 0}});
  gds.text(kString, layer.name + std::string(kAfterName) + layer.label);
  gds.empty(kElementEnd);
}

// --- reading ---

// One more piece of an array at the end of `to`, along x or along y; otherwise false. The pieces
// before the last are full.
bool join_part(LayoutReference& to, const LayoutReference& next, bool along_x) {
  const long count = along_x ? to.columns : to.rows;
  const bool alike = to.array && next.array && to.cell == next.cell && to.step_x == next.step_x &&
                     to.step_y == next.step_y &&
                     (along_x ? to.rows == next.rows : to.columns == next.columns);
  if (!alike || count % kMostInRecord != 0) return false;
  if (next.x != to.x + (along_x ? count * to.step_x : 0) ||
      next.y != to.y + (along_x ? 0 : count * to.step_y))
    return false;
  (along_x ? to.columns : to.rows) += along_x ? next.columns : next.rows;
  return true;
}

// The arrays that parts_of() wrote in pieces: those of a row of pieces first, then the rows.
std::vector<LayoutReference> wholes_of(std::vector<LayoutReference> parts) {
  for (const bool along_x : {true, false}) {
    std::vector<LayoutReference> out;
    for (LayoutReference& part : parts) {
      if (out.empty() || !join_part(out.back(), part, along_x)) out.push_back(std::move(part));
    }
    parts = std::move(out);
  }
  return parts;
}

struct GdsRecord {
  int type = 0;
  std::string_view data;

  std::uint64_t word(std::size_t at, std::size_t size) const {
    std::uint64_t out = 0;
    for (std::size_t i = 0; i < size; ++i)
      out = (out << 8) | static_cast<unsigned char>(data[at + i]);
    return out;
  }
  int number(std::size_t i) const { return static_cast<std::int16_t>(word(2 * i, 2)); }
  std::int32_t coordinate(std::size_t i) const { return static_cast<std::int32_t>(word(4 * i, 4)); }
  // Excess-64 exponent of 16 and a mantissa of 56 bits.
  double real(std::size_t i) const {
    const std::uint64_t bits = word(8 * i, 8);
    return std::ldexp(static_cast<double>(bits & 0x00ffffffffffffff),
                      4 * (static_cast<int>(bits >> 56 & 0x7f) - 64) - 56);
  }
  std::string text() const { return std::string(data.substr(0, data.find('\0'))); }
};

class GdsReader {
 public:
  explicit GdsReader(const std::string& path) : path_(path), bytes_(read_bytes(path)) {}

  Layout read() {
    if (next().type != kHeader) fail("no GDSII file");
    for (GdsRecord r = next(); r.type != kLibraryEnd; r = next()) {
      if (r.type == kCell) {
        read_cell();
      } else if (r.type == kUnits) {
        if (r.data.size() != 16 || std::abs(r.real(1) / 1e-9 - 1) > 1e-12 ||
            std::abs(r.real(0) / 1e-3 - 1) > 1e-12)
          fail("the database unit is not 1 nm");
        units_ = true;
      } else if (r.type != kLibrary && r.type != kLibraryName) {
        fail(fmt::format("a record 0x{:04x} that no layout of ours has", r.type));
      }
    }
    if (!units_) fail("no database unit");
    if (layout_.cells.empty()) fail("no cell");
    return std::move(layout_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError("cannot read " + path_ + ": " + why);
  }
  GdsRecord next() {
    if (at_ + 4 > bytes_.size()) fail("the data are cut off");
    GdsRecord out;
    const auto head = GdsRecord{0, std::string_view(bytes_).substr(at_, 4)};
    const auto length = static_cast<std::size_t>(head.word(0, 2));
    out.type = static_cast<int>(head.word(2, 2));
    if (length < 4 || at_ + length > bytes_.size()) fail("the data are cut off");
    out.data = std::string_view(bytes_).substr(at_ + 4, length - 4);
    at_ += length;
    return out;
  }
  GdsRecord expect(int type, std::size_t least) {
    const GdsRecord out = next();
    if (out.type != type || out.data.size() < least)
      fail(fmt::format("a record 0x{:04x} where 0x{:04x} is due", out.type, type));
    return out;
  }
  void read_cell() {
    LayoutCell cell{expect(kCellName, 1).text(), {}, {}};
    for (GdsRecord r = next(); r.type != kCellEnd; r = next()) {
      if (r.type == kBoundary) {
        cell.polygons.push_back(polygon());
      } else if (r.type == kReference || r.type == kArray) {
        cell.references.push_back(placed(r.type == kArray));
      } else if (r.type == kText) {
        layout_.layers.push_back(labelled());
      } else {
        fail(fmt::format("a record 0x{:04x} that no layout of ours has", r.type));
      }
    }
    cell.references = wholes_of(std::move(cell.references));
    if (!names_.insert(cell.name).second) fail("two cells \"" + cell.name + "\"");
    layout_.cells.push_back(std::move(cell));
  }
  LayoutPolygon polygon() {
    LayoutPolygon out;
    out.layer = expect(kLayer, 2).number(0);
    if (const int type = expect(kDataType, 2).number(0); type != 0)
      fail(fmt::format("a polygon of data type {}, of a layout of ours 0", type));
    const GdsRecord points = expect(kPoints, 32);
    const std::size_t count = points.data.size() / 8 - 1;
    if (points.coordinate(2 * count) != points.coordinate(0) ||
        points.coordinate(2 * count + 1) != points.coordinate(1))
      fail("a polygon that is open: its last point is not its first");
    for (std::size_t i = 0; i < count; ++i) {
      out.outline.x.push_back(points.coordinate(2 * i));
      out.outline.y.push_back(points.coordinate(2 * i + 1));
    }
    expect(kElementEnd, 0);
    return out;
  }
  LayoutLayer labelled() {
    LayoutLayer out;
    out.number = expect(kLayer, 2).number(0);
    expect(kTextType, 2);
    expect(kPoints, 8);
    const std::string text = expect(kString, 1).text();
    const std::size_t name = std::min(text.find(kAfterName), text.size());
    out.name = text.substr(0, name);
    out.label = text.substr(std::min(name + kAfterName.size(), text.size()));
    expect(kElementEnd, 0);
    return out;
  }
  LayoutReference placed(bool array) {
    LayoutReference out;
    out.array = array;
    out.cell = expect(kTarget, 1).text();
    if (!names_.contains(out.cell)) fail("a reference to \"" + out.cell + "\", which is no cell");
    if (array) {
      const GdsRecord counts = expect(kColumnsRows, 4);
      out.columns = counts.number(0);
      out.rows = counts.number(1);
      if (out.columns < 1 || out.rows < 1) fail("an array of no columns or rows");
    }
    const GdsRecord points = expect(kPoints, array ? 24 : 8);
    out.x = points.coordinate(0);
    out.y = points.coordinate(1);
    if (array) {
      const std::int64_t width = std::int64_t{points.coordinate(2)} - out.x,
                         height = std::int64_t{points.coordinate(5)} - out.y;
      if (points.coordinate(3) != out.y || points.coordinate(4) != out.x)
        fail("an array that is turned");
      if (width % out.columns != 0 || height % out.rows != 0)
        fail("an array whose pitch is not whole nanometres");
      out.step_x = width / out.columns;
      out.step_y = height / out.rows;
    }
    expect(kElementEnd, 0);
    return out;
  }

  std::string path_, bytes_;
  std::size_t at_ = 0;
  bool units_ = false;
  std::set<std::string> names_;
  Layout layout_;
};

}  // namespace

void write_gds(const std::string& path, const Layout& layout) {
  const std::vector<int> date{2025, 1, 1, 0, 0, 0, 2025, 1, 1, 0, 0, 0};
  GdsStream gds;
  gds.shorts(kHeader, {600});
  gds.shorts(kLibrary, date);
  gds.text(kLibraryName, "PAPILLA");
  gds.reals(kUnits, {1e-3, 1e-9});  // one database unit is 1e-3 um, 1e-9 m
  for (const LayoutCell& cell : layout.cells) {
    gds.shorts(kCell, date);
    gds.text(kCellName, cell.name);
    for (const LayoutPolygon& polygon : cell.polygons) boundary(gds, polygon);
    for (const LayoutReference& r : cell.references) {
      for (const LayoutReference& part : parts_of(r)) reference(gds, part);
    }
    if (&cell == &layout.cells.back()) {
      for (const LayoutLayer& layer : layout.layers) label(gds, layer);
    }
    gds.empty(kCellEnd);
  }
  gds.empty(kLibraryEnd);
  write_bytes(path, gds.bytes());
}

Layout read_gds(const std::string& path) { return GdsReader(path).read(); }

}  // namespace papilla::geometry
