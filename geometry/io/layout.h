// Files for makers and for 3-D programs.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "geometry/heightmap.h"
#include "geometry/io/files.h"

namespace papilla::geometry {

// X3P (ISO 25178-72): zip of XML and doubles, metres, with its MD5 sums.
void write_x3p(const std::string& path, const Heightmap& h);

// 16-bit grey PNG, bright is high, with the size and height keys that Gwyddion reads.
void write_png16(const std::string& path, const Heightmap& h);

// EXR of the map repeated repeat x repeat times, written and read back in strips of at most 256
// rows: memory is the map and a strip, whatever the area. progress: the share that is written.
void write_exr_repeated(const std::string& path, const Heightmap& h, int repeat,
                        const FileInfo& info, const std::function<void(double)>& progress = {});

// Dose of each pixel through a table of depth [m] over grey (0 to 255): monotone, inverted by
// linear interpolation. 8-bit PNG.
struct DoseCurve {
  std::vector<double> depth, grey;
};
struct DoseMap {
  double lowest = 0, highest = 0;     // grey written
  std::size_t shallow = 0, deep = 0;  // pixels clipped at either end of the table
};
// CSV depth_nm,grey; a heading may name them in the other order, and another unit. Throws
// InputError.
DoseCurve read_dose_curve(const std::string& path);
// Grey of each pixel, rows from the top.
std::vector<std::uint8_t> dose_levels(const Heightmap& h, const DoseCurve& curve, DoseMap& out);
DoseMap write_dose(const std::string& path, const Heightmap& h, const DoseCurve& curve);

// Binary STL in um: the whole map, 0 to lx and ly, on a closed block that reaches `base` [m] below
// its lowest point.
// Throws InputError above 4 million pixels.
void write_stl(const std::string& path, const Heightmap& h, double base = 1e-6);

}  // namespace papilla::geometry
