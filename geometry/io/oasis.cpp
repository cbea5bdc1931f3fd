// OASIS (SEMI P39): records of variable-length integers, repetitions in place of arrays.
#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "geometry/io/drawing.h"
#include "geometry/io/raw.h"

namespace papilla::geometry {
namespace {

constexpr std::string_view kMagic = "%SEMI-OASIS\r\n";
constexpr std::size_t kEndLength = 256;  // of the last record
constexpr std::uint64_t kGridPerMicrometre = 1000;

enum Record : std::uint64_t {
  kStart = 1,
  kEnd = 2,
  kLayerName = 11,
  kCell = 14,
  kPlacement = 17,
  kText = 19,
  kPolygon = 21,
};
constexpr std::uint64_t kOneNumber = 3;  // a range of layers: this one
enum Repetition : std::uint64_t { kColumnsAndRows = 1, kColumns = 2, kRows = 3 };
// Bits of the byte that says what of an element is given.
constexpr unsigned kHasLayer = 1, kHasType = 2, kHasRepetition = 4, kHasY = 8, kHasX = 16,
                   kHasPoints = 32;
constexpr unsigned kPlacedRepeats = 8, kPlacedY = 16, kPlacedX = 32, kNamesCell = 128;
constexpr unsigned kHasText = 64;
constexpr std::uint64_t kAnyAngle = 4;  // list of points: a pair of numbers each

class OasisStream {
 public:
  OasisStream() : bytes_(kMagic) {}
  void number(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>((value & 0x7f) | 0x80);
    bytes_ += static_cast<char>(value);
  }
  void whole(std::int64_t value) { number((magnitude(value) << 1) | (value < 0 ? 1 : 0)); }
  // A step that goes anywhere.
  void step(std::int64_t dx, std::int64_t dy) {
    number((magnitude(dx) << 2) | (dx < 0 ? 2 : 0) | 1);
    whole(dy);
  }
  void text(std::string_view value) {
    number(value.size());
    bytes_ += value;
  }
  void byte(unsigned value) { bytes_ += static_cast<char>(value); }
  const std::string& bytes() const { return bytes_; }

 private:
  static std::uint64_t magnitude(std::int64_t value) {
    return value < 0 ? -static_cast<std::uint64_t>(value) : static_cast<std::uint64_t>(value);
  }
  std::string bytes_;
};

void polygon(OasisStream& out, const LayoutPolygon& p, std::optional<int>& layer) {
  const bool new_layer = layer != p.layer;
  out.number(kPolygon);
  out.byte(kHasPoints | kHasX | kHasY | (new_layer ? kHasLayer | kHasType : 0));
  if (new_layer) {
    out.number(static_cast<std::uint64_t>(p.layer));
    out.number(0);
    layer = p.layer;
  }
  const Polygon& o = p.outline;
  out.number(kAnyAngle);
  out.number(o.x.size() - 1);
  for (std::size_t i = 1; i < o.x.size(); ++i)
    out.step(std::int64_t{o.x[i]} - o.x[i - 1], std::int64_t{o.y[i]} - o.y[i - 1]);
  out.whole(o.x[0]);
  out.whole(o.y[0]);
}

void placement(OasisStream& out, const LayoutReference& r) {
  const bool columns = r.columns > 1, rows = r.rows > 1;
  out.number(kPlacement);
  out.byte(kNamesCell | kPlacedX | kPlacedY | (columns || rows ? kPlacedRepeats : 0));
  out.text(r.cell);
  out.whole(r.x);
  out.whole(r.y);
  if (!columns && !rows) return;
  out.number(columns && rows ? kColumnsAndRows : columns ? kColumns : kRows);
  if (columns) out.number(static_cast<std::uint64_t>(r.columns) - 2);
  if (rows) out.number(static_cast<std::uint64_t>(r.rows) - 2);
  if (columns) out.number(static_cast<std::uint64_t>(r.step_x));
  if (rows) out.number(static_cast<std::uint64_t>(r.step_y));
}

void layer_name(OasisStream& out, const LayoutLayer& layer) {
  out.number(kLayerName);
  out.text(layer.name);
  out.number(kOneNumber);
  out.number(static_cast<std::uint64_t>(layer.number));
  out.number(kOneNumber);
  out.number(0);
}

void label(OasisStream& out, const LayoutLayer& layer) {
  out.number(kText);
  out.byte(kHasText | kHasX | kHasY | kHasLayer | kHasType);
  out.text(layer.label);
  out.number(static_cast<std::uint64_t>(layer.number));
  out.number(0);
  out.whole(0);
  out.whole(0);
}

std::string sum_of(std::string_view bytes) {
  return little(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()), 4);
}

class OasisReader {
 public:
  explicit OasisReader(const std::string& path) : path_(path), bytes_(read_bytes(path)) {}

  Layout read() {
    if (!bytes_.starts_with(kMagic)) fail("no OASIS file");
    if (bytes_.size() < kMagic.size() + kEndLength ||
        bytes_.substr(bytes_.size() - 4) !=
            sum_of(std::string_view(bytes_).substr(0, bytes_.size() - 4)))
      fail("the data are cut off or changed: the sum at its end is another");
    at_ = kMagic.size();
    read_start();
    std::optional<int> layer;
    for (std::uint64_t record = number(); record != kEnd; record = number()) {
      if (record == kCell) {
        layout_.cells.push_back({text(), {}, {}});
        layer.reset();
        if (!names_.insert(layout_.cells.back().name).second)
          fail("two cells \"" + layout_.cells.back().name + "\"");
      } else if (record == kLayerName) {
        layout_.layers.push_back(named());
      } else if (layout_.cells.empty()) {
        fail("an element outside of any cell");
      } else if (record == kText) {
        take_label();
      } else if (record == kPolygon) {
        layout_.cells.back().polygons.push_back(polygon(layer));
      } else if (record == kPlacement) {
        layout_.cells.back().references.push_back(placement());
      } else {
        fail(fmt::format("a record {} that no layout of ours has", record));
      }
    }
    if (layout_.cells.empty()) fail("no cell");
    return std::move(layout_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw InputError("cannot read " + path_ + ": " + why);
  }
  unsigned byte() {
    if (at_ >= bytes_.size()) fail("the data are cut off");
    return static_cast<unsigned char>(bytes_[at_++]);
  }
  std::uint64_t number() {
    std::uint64_t out = 0;
    for (int shift = 0;; shift += 7) {
      const unsigned b = byte();
      if (shift > 56) fail("a number of more than 63 bits");
      out |= static_cast<std::uint64_t>(b & 0x7f) << shift;
      if (b < 0x80) return out;
    }
  }
  std::int64_t whole() {
    const std::uint64_t n = number();
    const auto size = static_cast<std::int64_t>(n >> 1);
    return n & 1 ? -size : size;
  }
  std::int32_t coordinate(std::int64_t value) const {
    if (value < INT32_MIN || value > INT32_MAX) fail("a coordinate beyond 2.1 m");
    return static_cast<std::int32_t>(value);
  }
  std::string text() {
    const std::uint64_t length = number();
    if (length > bytes_.size() - at_) fail("the data are cut off");
    const std::string out = bytes_.substr(at_, length);
    at_ += length;
    return out;
  }
  void read_start() {
    if (number() != kStart || text() != "1.0") fail("no OASIS of version 1.0");
    if (number() != 0 || number() != kGridPerMicrometre) fail("the database unit is not 1 nm");
    if (number() != 0) fail("tables at its end, which no layout of ours has");
    for (int i = 0; i < 12; ++i) number();
  }
  LayoutLayer named() {
    LayoutLayer out;
    out.name = text();
    if (number() != kOneNumber) fail("a name of several layers");
    out.number = static_cast<int>(number() & 0xffff);
    if (number() != kOneNumber || number() != 0) fail("a name of several data types");
    return out;
  }
  void take_label() {
    if (byte() != (kHasText | kHasX | kHasY | kHasLayer | kHasType))
      fail("a text that no layout of ours has");
    const std::string label = text();
    const std::uint64_t layer = number();
    number();
    coordinate(whole());
    coordinate(whole());
    for (LayoutLayer& known : layout_.layers) {
      if (static_cast<std::uint64_t>(known.number) == layer) known.label = label;
    }
  }
  LayoutPolygon polygon(std::optional<int>& layer) {
    const unsigned given = byte();
    if ((given & ~(kHasLayer | kHasType)) != (kHasPoints | kHasX | kHasY))
      fail("a polygon that no layout of ours has");
    if (given & kHasLayer) layer = static_cast<int>(number() & 0xffff);
    if (given & kHasType) {
      if (const std::uint64_t type = number(); type != 0)
        fail(fmt::format("a polygon of data type {}, of a layout of ours 0", type));
    }
    if (!layer) fail("a polygon on no layer");
    LayoutPolygon out{*layer, {}};
    if (number() != kAnyAngle) fail("a list of points that no layout of ours has");
    const std::uint64_t count = number();
    if (count < 2 || count > bytes_.size()) fail("a polygon of less than three points");
    std::int64_t x = 0, y = 0;
    std::vector<std::pair<std::int64_t, std::int64_t>> points{{0, 0}};
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t n = number();
      if (!(n & 1)) fail("a list of points that no layout of ours has");
      const auto size = static_cast<std::int64_t>(n >> 2);
      x = coordinate(x + (n & 2 ? -size : size));
      y = coordinate(y + whole());
      points.emplace_back(x, y);
    }
    const std::int64_t x0 = whole(), y0 = whole();
    for (const auto& [px, py] : points) {
      out.outline.x.push_back(coordinate(x0 + px));
      out.outline.y.push_back(coordinate(y0 + py));
    }
    return out;
  }
  LayoutReference placement() {
    const unsigned given = byte();
    if ((given & ~kPlacedRepeats) != (kNamesCell | kPlacedX | kPlacedY))
      fail("a placement that no layout of ours has");
    LayoutReference out;
    out.cell = text();
    if (!names_.contains(out.cell)) fail("a reference to \"" + out.cell + "\", which is no cell");
    out.x = coordinate(whole());
    out.y = coordinate(whole());
    if (!(given & kPlacedRepeats)) return out;
    out.array = true;
    const std::uint64_t kind = number();
    if (kind < kColumnsAndRows || kind > kRows) fail("a repetition that no layout of ours has");
    constexpr std::uint64_t kMost = std::uint64_t{1} << 31;
    const auto count = [&] {
      const std::uint64_t n = number();
      if (n > kMost) fail("a repetition of more than 2^31");
      return static_cast<long>(n) + 2;
    };
    if (kind != kRows) out.columns = count();
    if (kind != kColumns) out.rows = count();
    if (kind != kRows) out.step_x = coordinate(static_cast<std::int64_t>(number()));
    if (kind != kColumns) out.step_y = coordinate(static_cast<std::int64_t>(number()));
    return out;
  }

  std::string path_, bytes_;
  std::size_t at_ = 0;
  std::set<std::string> names_;
  Layout layout_;
};

}  // namespace

void write_oasis(const std::string& path, const Layout& layout) {
  OasisStream out;
  out.number(kStart);
  out.text("1.0");
  out.number(0);  // the unit is a positive whole number of steps per micrometre
  out.number(kGridPerMicrometre);
  out.number(0);  // the places of the tables follow, none
  for (int i = 0; i < 12; ++i) out.number(0);
  for (const LayoutLayer& layer : layout.layers) layer_name(out, layer);
  for (const LayoutCell& cell : layout.cells) {
    out.number(kCell);
    out.text(cell.name);
    std::optional<int> layer;
    for (const LayoutPolygon& p : cell.polygons) polygon(out, p, layer);
    for (const LayoutReference& r : cell.references) placement(out, r);
    if (&cell == &layout.cells.back()) {
      for (const LayoutLayer& l : layout.layers) label(out, l);
    }
  }
  // The last record has 256 bytes: its number, a padding of 248 with its length in 2, the kind of
  // sum, and the sum of all before in 4.
  constexpr std::uint64_t kCrc = 1;
  out.number(kEnd);
  out.text(std::string(kEndLength - 8, '\0'));
  out.number(kCrc);
  write_bytes(path, out.bytes() + sum_of(out.bytes()));
}

Layout read_oasis(const std::string& path) { return OasisReader(path).read(); }

}  // namespace papilla::geometry
