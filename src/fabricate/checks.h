// A file of an export against what it should hold: one function a kind of file (internal to
// fabricate). Each says what is wrong and by how much; empty: sound to the rounding of its format.
// Throws InputError for a file that cannot be read.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "fabricate/formats.h"

namespace papilla::fabricate {

using Faults = std::vector<std::string>;

// Heights: sides, pixels, polarity, depth, critical dimension, every height.
Faults check_exr(const ExportSource& source, const std::string& path);
Faults check_tiff(const ExportSource& source, const std::string& path);
Faults check_tiff32(const ExportSource& source, const std::string& path);
Faults check_mask(const ExportSource& source, const std::string& path);
Faults check_gsf(const ExportSource& source, const std::string& path);
Faults check_doubles(const ExportSource& source, const std::string& path);  // npy, x3p
Faults check_png16(const ExportSource& source, const std::string& path);

// Pictures: every pixel.
Faults check_preview(const ExportSource& source, const std::string& path);
Faults check_dose(const ExportSource& source, const std::string& path);

// Triangles: sides, every corner on the surface, a closed body of its volume.
Faults check_stl(const ExportSource& source, const std::string& path);

// Polygons: of an array the outline and the place of every one, of contours every polygon.
Faults check_gds(const ExportSource& source, const std::string& path);
Faults check_oasis(const ExportSource& source, const std::string& path);

// "is 101 nm, the design's 100 nm: 1 % more"
std::string differs(double is, double design, double unit, const char* name);

}  // namespace papilla::fabricate
