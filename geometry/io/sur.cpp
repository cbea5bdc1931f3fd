// SUR: the files of Digital Surf (MountainsMap), objects one after the other, each a header of 512
// bytes, zones of text, and whole numbers, packed or not.
#include <fmt/format.h>
#include <zlib.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include "base/error.h"
#include "base/files.h"
#include "base/memory.h"
#include "base/units.h"
#include "geometry/io/bytes.h"
#include "geometry/io/channels.h"
#include "geometry/io/height_rows.h"
#include "geometry/io/raw.h"

namespace papilla::geometry {
namespace {

constexpr std::size_t kHeaderOfSur = 512;

// Text in a field of fixed width: blanks and zeros at its end removed. The micro sign is one byte
// of Latin-1 there.
std::string fixed_text(std::string_view field) {
  std::string out;
  for (const char c : field.substr(0, field.find('\0')))
    out += c == '\xb5' ? std::string("u") : std::string(1, c);
  while (!out.empty() && (out.back() == ' ' || out.back() == '\r')) out.pop_back();
  return out;
}

struct SurObject {
  std::string name;
  int objects = 1;  // that the first says the file has
  bool packed = false, plain_kind = false;
  int bits = 0, nx = 0, ny = 0;
  std::int32_t lowest = 0;
  bool gaps = false;  // points that were not measured, by their value
  double dx = 0, dy = 0, dz = 0, z0 = 0;
  std::string unit_x, unit_y, unit_z;
  std::size_t data = 0, data_bytes = 0;  // in the file

  std::size_t pixels() const { return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny); }
};

SurObject read_object(ByteReader& in) {
  SurObject out;
  const std::size_t begin = in.at();
  const std::string magic(in.take(12));
  if (magic != "DIGITAL SURF" && magic != "DSCOMPRESSED") in.fail("no Digital Surf file");
  out.packed = magic == "DSCOMPRESSED";
  if (in.number<std::int16_t>() != 0) in.fail("a Digital Surf file of another byte order");
  out.objects = in.number<std::int16_t>();
  in.number<std::int16_t>();  // version
  const int kind = in.number<std::int16_t>();
  constexpr int kColours = 12;  // pictures, spectra and curves are from there on
  out.plain_kind = kind >= 0 && kind < kColours;
  out.name = fixed_text(in.take(30));
  in.take(30 + 2 + 2 + 2);  // operator, size of a profile, acquisition, range
  out.gaps = in.number<std::int16_t>() == 1;
  in.take(2 + 4 + 4);
  out.bits = in.number<std::int16_t>();
  out.lowest = in.number<std::int32_t>();
  in.number<std::int32_t>();
  out.nx = in.number<std::int32_t>();
  out.ny = in.number<std::int32_t>();
  in.number<std::int32_t>();
  const auto real = [&] { return static_cast<double>(in.number<float>()); };
  out.dx = real(), out.dy = real(), out.dz = real();
  in.take(3 * 16);  // names of axes
  out.unit_x = fixed_text(in.take(16));
  out.unit_y = fixed_text(in.take(16));
  out.unit_z = fixed_text(in.take(16));
  in.go(begin + 324);
  const auto packed_bytes = in.number<std::uint32_t>();
  in.go(begin + 334);
  const auto comment = in.number<std::uint16_t>(), own = in.number<std::uint16_t>();
  in.go(begin + 474);
  out.z0 = real();
  in.go(begin + kHeaderOfSur);
  in.take(comment);
  in.take(own);
  if (out.bits != 16 && out.bits != 32) in.fail("its heights have neither 16 nor 32 bits");
  if (out.nx < 1 || out.ny < 1) in.fail("no whole number of pixels");
  out.data = in.at();
  const std::uint64_t plain = std::uint64_t{static_cast<unsigned>(out.nx)} *
                              static_cast<unsigned>(out.ny) * static_cast<unsigned>(out.bits / 8);
  const std::uint64_t stored = out.packed ? packed_bytes : plain;
  if (stored > in.left()) in.fail("the data are cut off");
  out.data_bytes = static_cast<std::size_t>(stored);
  in.take(out.data_bytes);
  return out;
}

double length_unit(const ByteReader& in, const std::string& unit, const char* of) {
  const auto known = find_unit(unit);
  if (!known || unit.empty() || !known->same_dimension(*find_unit("m")))
    in.fail(fmt::format("its {} is in \"{}\", no length", of, unit));
  return known->to_si;
}

bool is_length(const std::string& unit) {
  const auto known = find_unit(unit);
  return known && !unit.empty() && known->same_dimension(*find_unit("m"));
}

// Streams of zlib, each with its lengths before all of them.
std::string unpacked(ByteReader in, const SurObject& object) {
  in.go(object.data);
  const auto streams = in.number<std::uint32_t>();
  constexpr std::uint32_t kMostStreams = 1 << 16;
  if (streams > kMostStreams) in.fail("more streams than any file has");
  std::vector<std::pair<std::uint32_t, std::uint32_t>> lengths;
  std::uint64_t all = 0;
  for (std::uint32_t i = 0; i < streams; ++i) {
    const auto raw = in.number<std::uint32_t>(), zipped = in.number<std::uint32_t>();
    lengths.emplace_back(raw, zipped);
    all += raw;
  }
  const std::size_t due = object.pixels() * static_cast<std::size_t>(object.bits / 8);
  if (all != due) in.fail("not as many packed heights as pixels are due");
  std::string out(due, '\0');
  std::size_t at = 0;
  for (const auto& [raw, zipped] : lengths) {
    const std::string_view from = in.take(zipped);
    uLongf length = raw;
    const int code = ::uncompress(reinterpret_cast<Bytef*>(out.data() + at), &length,
                                  reinterpret_cast<const Bytef*>(from.data()), zipped);
    if (code != Z_OK || length != raw) in.fail("its packed heights are damaged");
    at += raw;
  }
  return out;
}

class SurRows : public HeightRows {
 public:
  SurRows(const std::string& path, const std::string& channel) : bytes_(read_bytes(path)) {
    ByteReader in(bytes_, path);
    std::vector<SurObject> objects;
    std::vector<MapChannel> channels;
    while (objects.empty() || static_cast<int>(objects.size()) < objects.front().objects) {
      const SurObject object = read_object(in);
      objects.push_back(object);
      const bool map = object.plain_kind && object.nx > 1 && object.ny > 1;
      channels.push_back(
          {object.name, object.unit_z, object.nx, object.ny, map && is_length(object.unit_z)});
    }
    const std::size_t chosen = choose_channel(path, channels, channel);
    object_ = objects[chosen];
    check_size(path, object_.nx, object_.ny);
    header_.nx = object_.nx;
    header_.ny = object_.ny;
    header_.lx = object_.nx * object_.dx * length_unit(in, object_.unit_x, "width");
    header_.ly = object_.ny * object_.dy * length_unit(in, object_.unit_y, "height");
    header_.channel = object_.name;
    if (!(header_.lx > 0 && header_.ly > 0)) in.fail("its sides are not above 0");
    scale_ = length_unit(in, object_.unit_z, "relief");
    if (object_.packed) {
      const std::size_t due = object_.pixels() * static_cast<std::size_t>(object_.bits / 8);
      // Deflate packs 1032 to 1 at best.
      if (due > 1100 * object_.data_bytes) in.fail("not as many packed heights as pixels are due");
      require_memory(static_cast<double>(due), path);
      bytes_ = unpacked(in, object_);
      object_.data = 0;
    }
    at_ = object_.data;
  }

  void next(double* heights) override {
    // Two below the lowest of those that were measured.
    const std::int64_t gap = std::int64_t{object_.lowest} - 2;
    for (int ix = 0; ix < header_.nx; ++ix) {
      const std::int64_t raw = object_.bits == 16 ? std::int64_t{value<std::int16_t>()}
                                                  : std::int64_t{value<std::int32_t>()};
      heights[ix] = object_.gaps && raw == gap
                        ? std::nan("")
                        : scale_ * (static_cast<double>(raw) * object_.dz + object_.z0);
    }
  }

 private:
  template <class T>
  T value() {
    T out{};
    std::memcpy(&out, bytes_.data() + at_, sizeof out);
    at_ += sizeof out;
    return out;
  }

  std::string bytes_;
  SurObject object_;
  double scale_ = 1;
  std::size_t at_ = 0;
};

}  // namespace

std::unique_ptr<HeightRows> open_sur_rows(const std::string& path, const std::string& channel) {
  return std::make_unique<SurRows>(path, channel);
}

}  // namespace papilla::geometry
