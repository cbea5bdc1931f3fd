// GWY: the files of Gwyddion, a tree of named components; and what its converter makes of other
// instruments' files.
#include "geometry/io/gwy.h"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/units.h"
#include "geometry/io/bytes.h"
#include "geometry/io/channels.h"
#include "geometry/io/raw.h"

namespace papilla::geometry {
namespace {

constexpr std::string_view kMagicOfGwy = "GWYP";
constexpr int kDeepest = 16;             // trees within trees
constexpr std::size_t kMostMaps = 4096;  // of one file

// Where an array of doubles stands in the file.
struct Doubles {
  std::size_t at = 0, count = 0;
};

// A map of the file. Sizes and units as they stand there.
struct GwyField {
  int nx = 0, ny = 0;
  double lx = 0, ly = 0;
  std::string xy_unit, z_unit;
  Doubles data;
};

class GwyTree {
 public:
  GwyTree(std::string_view bytes, const std::string& path) : in_(bytes, path) {
    if (!bytes.starts_with(kMagicOfGwy)) in_.fail("no Gwyddion file");
    in_.go(kMagicOfGwy.size());
    const std::string_view name = in_.until('\0');
    if (name != "GwyContainer") in_.fail("no container of maps");
    const std::size_t end = object_end();
    while (in_.at() < end) read_entry();
    if (in_.at() != end) in_.fail("its parts are longer than their whole");
  }

  std::map<long, GwyField> fields, masks;  // by their number in the file
  std::map<long, std::string> titles;

 private:
  std::size_t object_end() {
    const auto size = in_.number<std::uint32_t>();
    if (size > in_.left()) in_.fail("the data are cut off");
    return in_.at() + size;
  }
  // "/3/data" -> 3, "data".
  static std::pair<long, std::string_view> key_of(std::string_view key) {
    if (!key.starts_with('/')) return {-1, key};
    long number = 0;
    std::size_t at = 1;
    for (; at < key.size() && key[at] >= '0' && key[at] <= '9' && number < 1000000; ++at)
      number = 10 * number + (key[at] - '0');
    if (at == 1 || at >= key.size() || key[at] != '/') return {-1, key};
    return {number, key.substr(at + 1)};
  }
  void read_entry() {
    const auto [number, name] = key_of(in_.until('\0'));
    const char type = in_.number<char>();
    if (number >= 0 && type == 'o' && (name == "data" || name == "mask")) {
      if (fields.size() + masks.size() > kMostMaps) in_.fail("more maps than any file has");
      const std::string_view kind = in_.until('\0');
      const std::size_t end = object_end();
      if (kind == "GwyDataField") (name == "data" ? fields : masks)[number] = field(end);
      in_.go(end);
    } else if (number >= 0 && type == 's' && name == "data/title") {
      titles[number] = std::string(in_.until('\0'));
    } else {
      skip(type, 0);
    }
  }
  GwyField field(std::size_t end) {
    GwyField out;
    while (in_.at() < end) {
      const std::string_view name = in_.until('\0');
      const char type = in_.number<char>();
      if (type == 'i' && (name == "xres" || name == "yres")) {
        (name == "xres" ? out.nx : out.ny) = in_.number<std::int32_t>();
      } else if (type == 'd' && (name == "xreal" || name == "yreal")) {
        (name == "xreal" ? out.lx : out.ly) = in_.number<double>();
      } else if (type == 'o' && (name == "si_unit_xy" || name == "si_unit_z")) {
        (name == "si_unit_xy" ? out.xy_unit : out.z_unit) = unit();
      } else if (type == 'D' && name == "data") {
        out.data.count = in_.number<std::uint32_t>();
        out.data.at = in_.at();
        in_.take(out.data.count * sizeof(double));
      } else {
        skip(type, 0);
      }
    }
    return out;
  }
  std::string unit() {
    in_.until('\0');
    const std::size_t end = object_end();
    std::string out;
    while (in_.at() < end) {
      const std::string_view name = in_.until('\0');
      const char type = in_.number<char>();
      if (type == 's' && name == "unitstr") {
        out = std::string(in_.until('\0'));
      } else {
        skip(type, 0);
      }
    }
    return out;
  }
  static std::size_t size_of(char type) {
    switch (type) {
      case 'b':
      case 'c':
      case 'C':
        return 1;
      case 'i':
      case 'I':
        return 4;
      default:
        return 8;  // of q, Q, d and D
    }
  }
  void skip(char type, int depth) {
    if (depth > kDeepest) in_.fail("trees within trees without end");
    const auto object = [&] {
      in_.until('\0');
      in_.go(object_end());
    };
    const auto times = [&](const auto& work) {
      const auto count = in_.number<std::uint32_t>();
      for (std::uint32_t i = 0; i < count; ++i) work();
    };
    if (std::strchr("bciqd", type) && type != '\0') {
      in_.take(size_of(type));
    } else if (std::strchr("CIQD", type) && type != '\0') {
      const std::size_t count = in_.number<std::uint32_t>();
      in_.take(count * size_of(type));
    } else if (type == 's') {
      in_.until('\0');
    } else if (type == 'S') {
      times([&] { in_.until('\0'); });
    } else if (type == 'o') {
      object();
    } else if (type == 'O') {
      times(object);
    } else {
      in_.fail("a component of a kind that no Gwyddion file has");
    }
  }

  ByteReader in_;
};

// A factor to SI; nothing for what is no length.
std::optional<double> metres_per(const std::string& unit) {
  const auto known = find_unit(unit);
  if (!known || unit.empty() || !known->same_dimension(*find_unit("m"))) return std::nullopt;
  return known->to_si;
}

class GwyRows : public HeightRows {
 public:
  GwyRows(const std::string& path, std::string bytes, const std::string& channel)
      : bytes_(std::move(bytes)) {
    const GwyTree tree(bytes_, path);
    std::vector<MapChannel> channels;
    std::vector<long> numbers;
    for (const auto& [number, field] : tree.fields) {
      const auto title = tree.titles.find(number);
      channels.push_back(
          {title == tree.titles.end() ? fmt::format("map {}", number) : title->second, field.z_unit,
           field.nx, field.ny, metres_per(field.z_unit).has_value()});
      numbers.push_back(number);
    }
    const std::size_t chosen = choose_channel(path, channels, channel);
    const GwyField& field = tree.fields.at(numbers[chosen]);
    const ByteReader problem({}, path);
    check_size(path, field.nx, field.ny);
    const auto pixels = static_cast<std::size_t>(field.nx) * static_cast<std::size_t>(field.ny);
    if (field.data.count != pixels) problem.fail("not as many heights as pixels");
    const auto xy = metres_per(field.xy_unit);
    if (!xy) problem.fail("its sides are in \"" + field.xy_unit + "\", no length");
    header_.nx = field.nx;
    header_.ny = field.ny;
    header_.lx = *xy * field.lx;
    header_.ly = *xy * field.ly;
    header_.channel = channels[chosen].name;
    if (!(header_.lx > 0 && header_.ly > 0)) problem.fail("its sides are not above 0");
    scale_ = *metres_per(field.z_unit);
    at_ = field.data.at;
    const auto mask = tree.masks.find(numbers[chosen]);
    if (mask == tree.masks.end() || mask->second.data.count != pixels) return;
    mask_at_ = mask->second.data.at;
    for (std::size_t i = 0; i < pixels; ++i) header_.marked += is_marked(i);
  }

  void leave_out_marked() override { leaves_out_ = true; }
  void next(double* heights) override {
    const std::size_t row = static_cast<std::size_t>(header_.nx) * sizeof(double);
    std::memcpy(heights, bytes_.data() + at_, row);
    at_ += row;
    for (int ix = 0; ix < header_.nx; ++ix, ++pixel_) {
      const bool missing = leaves_out_ && header_.marked > 0 && is_marked(pixel_);
      heights[ix] = missing ? std::nan("") : scale_ * heights[ix];
    }
  }

 private:
  bool is_marked(std::size_t pixel) const {
    double marked = 0;
    std::memcpy(&marked, bytes_.data() + mask_at_ + pixel * sizeof marked, sizeof marked);
    return marked >= 0.5;
  }

  std::string bytes_;
  double scale_ = 1;
  std::size_t at_ = 0, mask_at_ = 0, pixel_ = 0;
  bool leaves_out_ = false;
};

}  // namespace

std::unique_ptr<HeightRows> open_gwy_rows(const std::string& path, const std::string& channel) {
  return std::make_unique<GwyRows>(path, read_bytes(path), channel);
}

std::unique_ptr<HeightRows> converted_gwy_rows(const std::string& path, std::string bytes,
                                               const std::string& channel) {
  auto rows = std::make_unique<GwyRows>(path, std::move(bytes), channel);
  rows->leave_out_marked();
  return rows;
}

std::size_t count_of_gwy_maps(const std::string& path, std::string_view bytes) {
  return GwyTree(bytes, path).fields.size();
}

}  // namespace papilla::geometry
