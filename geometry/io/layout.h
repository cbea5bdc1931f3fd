// Files for makers of masks and for 3-D programs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "geometry/facts.h"
#include "geometry/heightmap.h"
#include "geometry/io/files.h"

namespace papilla {

// What an array became in the file.
struct GdsArray {
  long columns = 0, rows = 0;
  double pitch_x = 0, pitch_y = 0;  // [m]; y of hexagons: of two rows, mean over a block
  double drift = 0;   // of the last rows from their exact place [m]; 0 but for hexagons
  int sides = 0;      // of a circle
  std::string drawn;  // "holes", "pillars", "grooves": what the polygons are
};

// GDSII of an array (facts(texture).outline): one polygon cell and one array reference over
// size_x x size_y [m], layer 1, database unit 1 nm, fixed date. Circles are polygons with the area
// of the circle, at most facet_error [m] off it, rounded to the database unit. The row pitch of
// hexagons is on no grid: a block of rows, each rounded alone, is repeated, so that over the whole
// array no hole is more than 1 nm off its place along y. Throws InputError for a period
// that is not whole nanometres, or an array of more than 32767 cells a side.
GdsArray write_gds(const std::string& path, const FeatureArray& array, double size_x, double size_y,
                   double facet_error = 2e-9);

// GDSII of any heightmap as masks: layer k of `levels` holds the contour polygons of what is deeper
// than (k - 1/2)/levels of the whole depth; one level is a binary mask. Returns the number of
// polygons; throws InputError above two million.
std::size_t write_gds_mask(const std::string& path, const Heightmap& h, int levels);

// X3P (ISO 25178-72): zip of XML and doubles, metres, with its MD5 sums.
void write_x3p(const std::string& path, const Heightmap& h);

// 16-bit grey PNG, bright is high, with the size and height keys that Gwyddion reads.
void write_png16(const std::string& path, const Heightmap& h);

// EXR of the map repeated repeat x repeat times, written and read back in strips of at most 256
// rows: memory is the map and a strip, whatever the area.
void write_exr_repeated(const std::string& path, const Heightmap& h, int repeat,
                        const FileInfo& info);

// Dose of each pixel through a table of depth [m] over grey (0 to 255): monotone, inverted by
// linear interpolation. 8-bit PNG.
struct DoseCurve {
  std::vector<double> depth, grey;
};
struct DoseMap {
  double lowest = 0, highest = 0;     // grey written
  std::size_t shallow = 0, deep = 0;  // pixels clipped at either end of the table
};
DoseCurve read_dose_curve(const std::string& path);  // CSV depth_nm,grey; throws InputError
DoseMap write_dose(const std::string& path, const Heightmap& h, const DoseCurve& curve);

// Binary STL in um: one whole period of the surface, 0 to lx and ly, on a closed block that reaches
// `base` [m] below its lowest point.
// Throws InputError above 4 million pixels.
void write_stl(const std::string& path, const Heightmap& h, double base = 1e-6);

}  // namespace papilla
