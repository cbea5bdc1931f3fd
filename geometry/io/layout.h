// Files for makers of masks and for 3-D programs.
#pragma once

#include <string>

#include "geometry/heightmap.h"
#include "geometry/texture.h"

namespace papilla {

// GDSII of an array (holes, pillars, grooves): one polygon cell and one array reference over
// size_x x size_y [m], layer 1, database unit 1 nm, fixed date. Circles are polygons of 128 sides
// with the area of the circle, rounded to the database unit. Throws InputError for a texture that
// is no array or an array of more than 32767 cells a side.
void write_gds(const std::string& path, const Texture& texture, double size_x, double size_y);

// Binary STL in um: the surface on a closed block that reaches `base` [m] below its lowest point.
// Throws InputError above 4 million pixels.
void write_stl(const std::string& path, const Heightmap& h, double base = 1e-6);

}  // namespace papilla
