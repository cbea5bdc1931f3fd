// A measured map as every command takes it: levelled, mended, filled where that is asked for; and
// what was changed, in numbers and in the words that every command says.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "base/rooms.h"
#include "geometry/heightmap.h"

namespace papilla::geometry {

struct ScanSource {
  std::string file;    // as read_map takes it: "scan.gwy", "scan.gwy::Height"
  double width = 0;    // where the file does not say [m]
  bool fill = false;   // heights that are no numbers get those around them; else they are refused
  bool as_is = false;  // neither levelled nor mended: a surface that is known and repeats
  bool level = false;  // the plane is taken away of made and periodic maps too

  auto operator<=>(const ScanSource&) const = default;
};

// A rectangle and what lies in it [m].
struct ScanPlace {
  double x0 = 0, x1 = 0, y0 = 0, y1 = 0;
};

// Eq. geometry.4
struct ScanChanges {
  bool as_is = false;
  bool repeats = false;                 // its borders meet: a plane taken away would part them
  bool made = false;                    // an array or an export: its plane belongs to it
  double width = 0, height = 0;         // sides of the map [m]
  double slope_x = 0, slope_y = 0;      // of the plane that was taken away
  double kept_tilt = 0, kept_rise = 0;  // of the plane that a made map keeps [rad, m]
  double rise = 0;                      // its highest less its lowest place over the map [m]
  std::size_t pixels = 0;               // of the map
  std::size_t replaced = 0;  // further than 8 median deviations from the median: in no plane
  double furthest = 0;       // of them from the median [m]
  ScanPlace where;           // that holds all of them
  std::size_t filled = 0;    // were no numbers
  // By a mask of a .gwy: among those that were filled, else taken as heights.
  std::size_t marked = 0;
  double highest = 0;  // place of the map as it is taken [m]
  double rms = 0;      // about its mean, as it is taken [m]

  double tilt() const;  // angle of the plane [rad]
};

// Heights that no surface of this size has, in words; empty: possible. They are most likely in
// another unit, and a simulation of them would take memory without end.
std::string impossible(const Heightmap& h);

// Root mean square steps of a map that is laid side by side [m]: over the border, from its last
// column or row to its first, and between the neighbours beside it.
struct BorderSteps {
  double over = 0, beside = 0;

  bool alike() const;  // to the scatter of two steps of one surface
};
// Along x and along y, of four pixels or more a side.
std::array<BorderSteps, 2> border_steps(const Heightmap& h);

struct Scan {
  Heightmap map;
  ScanChanges changes;
};

// Throws InputError for a file that cannot be read, that holds no size, or heights that are no
// numbers and are not to be filled; for more than a fifth of those in any case; for impossible
// heights.
Scan read_scan(const ScanSource& source);

// "scan.gsf: a plane of 0.31 deg (540 nm over the map) was taken away; 1 of 160000 pixels
// (0.00062 %) was replaced, ..."
std::string text(const std::string& file, const ScanChanges& changes);

}  // namespace papilla::geometry
