// Files as instruments write them, of heights that are known: bytes by the formats' descriptions,
// without our readers.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "geometry/heightmap.h"

namespace papilla::tests {

template <class T>
std::string raw_bytes(T value) {
  std::string out(sizeof value, '\0');
  std::memcpy(out.data(), &value, sizeof value);
  return out;
}

// Rows from the top, as every one of these formats has them.
inline std::vector<double> rows_from_the_top(const Heightmap& h) {
  std::vector<double> out;
  for (int iy = h.grid.ny - 1; iy >= 0; --iy) {
    for (int ix = 0; ix < h.grid.nx; ++ix) out.push_back(h(ix, iy));
  }
  return out;
}

// --- Gwyddion ---

inline std::string gwy_object(const std::string& name, const std::string& parts) {
  return name + '\0' + raw_bytes(static_cast<std::uint32_t>(parts.size())) + parts;
}
inline std::string gwy_part(const std::string& name, char type, const std::string& value) {
  return name + '\0' + type + value;
}
inline std::string gwy_unit(const std::string& unit) {
  return gwy_object("GwySIUnit", gwy_part("unitstr", 's', unit + '\0'));
}
inline std::string gwy_field(const Heightmap& h, double scale, const std::string& z_unit) {
  std::string data = raw_bytes(static_cast<std::uint32_t>(h.z.size()));
  for (const double z : rows_from_the_top(h)) data += raw_bytes(z / scale);
  return gwy_object("GwyDataField", gwy_part("xres", 'i', raw_bytes(std::int32_t{h.grid.nx})) +
                                        gwy_part("yres", 'i', raw_bytes(std::int32_t{h.grid.ny})) +
                                        gwy_part("xreal", 'd', raw_bytes(h.grid.lx)) +
                                        gwy_part("yreal", 'd', raw_bytes(h.grid.ly)) +
                                        gwy_part("si_unit_xy", 'o', gwy_unit("m")) +
                                        gwy_part("si_unit_z", 'o', gwy_unit(z_unit)) +
                                        gwy_part("data", 'D', data));
}
struct GwyMap {
  std::string title, unit;
  const Heightmap* map;
  double scale = 1;                 // of the unit
  const Heightmap* mask = nullptr;  // 1: marked
};
// With what else such files hold: flags, numbers, lists, other objects.
inline std::string gwy_bytes(const std::vector<GwyMap>& maps) {
  std::string parts =
      gwy_part("/filename", 's', std::string("instrument.dat") + '\0') +
      gwy_part("/0/data/visible", 'b', std::string(1, '\1')) +
      gwy_part("/0/base/range-type", 'i', raw_bytes(std::int32_t{2})) +
      gwy_part("/0/meta", 'o',
               gwy_object("GwyContainer", gwy_part("Speed", 's', std::string("1 Hz") + '\0'))) +
      gwy_part(
          "/0/select/list", 'I',
          raw_bytes(std::uint32_t{2}) + raw_bytes(std::int32_t{1}) + raw_bytes(std::int32_t{2}));
  for (std::size_t k = 0; k < maps.size(); ++k) {
    const std::string number = "/" + std::to_string(k) + "/";
    parts += gwy_part(number + "data", 'o', gwy_field(*maps[k].map, maps[k].scale, maps[k].unit)) +
             gwy_part(number + "data/title", 's', maps[k].title + '\0');
    if (maps[k].mask) parts += gwy_part(number + "mask", 'o', gwy_field(*maps[k].mask, 1, ""));
  }
  return "GWYP" + gwy_object("GwyContainer", parts);
}

// --- Digital Surf ---

struct SurKind {
  int bits = 32;
  bool packed = false, gaps = false;
  std::string name = "Relief", z_unit = "\xb5m";
  int objects = 1;
};
// Whole steps of 0.1 nm; of 16 bits of 10 nm.
inline double sur_step(const SurKind& kind) { return kind.bits == 32 ? 1e-10 : 1e-8; }

inline std::string sur_bytes(const Heightmap& h, const SurKind& kind) {
  const auto field = [](std::string text, std::size_t width) {
    text.resize(width, ' ');
    return text;
  };
  std::vector<std::int32_t> steps;
  std::int32_t lowest = INT32_MAX, highest = INT32_MIN;
  for (const double z : rows_from_the_top(h)) {
    const bool gap = !(z == z);
    steps.push_back(gap ? INT32_MIN : static_cast<std::int32_t>(std::lround(z / sur_step(kind))));
    if (gap) continue;
    lowest = std::min(lowest, steps.back()), highest = std::max(highest, steps.back());
  }
  std::string data;
  for (std::int32_t step : steps) {
    if (step == INT32_MIN) step = lowest - 2;
    data += kind.bits == 32 ? raw_bytes(step) : raw_bytes(static_cast<std::int16_t>(step));
  }
  if (kind.packed) {
    uLongf length = compressBound(data.size());
    std::string zipped(length, '\0');
    compress(reinterpret_cast<Bytef*>(zipped.data()), &length,
             reinterpret_cast<const Bytef*>(data.data()), data.size());
    zipped.resize(length);
    data = raw_bytes(std::uint32_t{1}) + raw_bytes(static_cast<std::uint32_t>(data.size())) +
           raw_bytes(static_cast<std::uint32_t>(zipped.size())) + zipped;
  }
  const auto i16 = [](int v) { return raw_bytes(static_cast<std::int16_t>(v)); };
  const auto f32 = [](double v) { return raw_bytes(static_cast<float>(v)); };
  const std::string comment = "by hand";
  std::string out = kind.packed ? "DSCOMPRESSED" : "DIGITAL SURF";
  out += i16(0) + i16(kind.objects) + i16(1) + i16(2) + field(kind.name, 30) + field("", 30);
  out += i16(0) + i16(0) + i16(0) + i16(kind.gaps ? 1 : 0) + i16(1) + std::string(8, '\0');
  out += i16(kind.bits) + raw_bytes(lowest) + raw_bytes(highest);
  out += raw_bytes(std::int32_t{h.grid.nx}) + raw_bytes(std::int32_t{h.grid.ny}) +
         raw_bytes(static_cast<std::int32_t>(h.z.size()));
  out += f32(1e3 * h.grid.dx()) + f32(1e3 * h.grid.dy()) + f32(1e6 * sur_step(kind));
  out += field("X", 16) + field("Y", 16) + field("Z", 16);
  out += field("mm", 16) + field("mm", 16) + field(kind.z_unit, 16);
  out += field("mm", 16) + field("mm", 16) + field(kind.z_unit, 16);
  out += f32(1) + f32(1) + f32(1);
  out.resize(324, '\0');
  out += raw_bytes(static_cast<std::uint32_t>(kind.packed ? data.size() : 0));
  out.resize(334, '\0');
  out += i16(static_cast<int>(comment.size())) + i16(0);
  out.resize(512, '\0');
  return out + comment + data;
}

// --- SDF ---

inline std::string sdf_text(const Heightmap& h) {
  std::string out =
      "aBCR-1.0\nManufacID = hand\nCreateDate = 010120251200\nModDate = 010120251200\n";
  const auto line = [&](const char* key, double value) {
    char text[64];
    std::snprintf(text, sizeof text, "%s = %.17g\n", key, value);
    out += text;
  };
  line("NumPoints", h.grid.nx);
  line("NumProfiles", h.grid.ny);
  line("Xscale", h.grid.dx());
  line("Yscale", h.grid.dy());
  line("Zscale", 1e-9);
  out += "Zresolution = 1e-12\nCompression = 0\nDataType = 7\nCheckType = 0\n*\n";
  int column = 0;
  for (const double z : rows_from_the_top(h)) {
    char text[64];
    std::snprintf(text, sizeof text, "%.17g%c", 1e9 * z, ++column % h.grid.nx == 0 ? '\n' : ' ');
    out += z == z ? text : "BAD ";
  }
  return out + "*\nby hand\n*\n";
}

// Doubles in nanometres.
inline std::string sdf_binary(const Heightmap& h) {
  std::string out = "bISO-1.0";
  out.resize(8 + 10 + 12 + 12, ' ');
  out += raw_bytes(static_cast<std::uint16_t>(h.grid.nx)) +
         raw_bytes(static_cast<std::uint16_t>(h.grid.ny)) + raw_bytes(h.grid.dx()) +
         raw_bytes(h.grid.dy()) + raw_bytes(1e-9) + raw_bytes(1e-12) + std::string(1, '\0') +
         std::string(1, '\7') + std::string(1, '\0');
  for (const double z : rows_from_the_top(h)) out += raw_bytes(1e9 * z);
  return out;
}

}  // namespace papilla::tests
