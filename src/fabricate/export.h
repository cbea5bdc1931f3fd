// A design as files for makers and for other programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "geometry/io/files.h"
#include "geometry/io/layout.h"

namespace papilla::fabricate {

// What the process moves: undone in the files, so that the made texture is the design.
struct ProcessBias {
  double shrink = 0;       // each wall moves into the hole by this (oxide growth) [m]
  double edge_radius = 0;  // the process rounds rims by this: left out of the design's own [m]
};
// Throws InputError for textures without holes, pillars or grooves, and where nothing is left.
Texture compensated(const Texture& texture, const ProcessBias& bias);

struct ExportOptions {
  // Names of fabricate/formats.h; empty: all that the texture and the polarity allow.
  std::vector<std::string> formats;
  // Wanted side [m], rounded to whole periods; 0: the window, two periods at least.
  double size = 0;
  int pixels = 1024;                 // along x
  std::optional<Polarity> polarity;  // needed for tiff and mask
  int repeat = 1;                    // EXR: times in x and y, streamed
  int levels = 1;                    // GDSII of textures that are no arrays: masks
  double facet_error = 2e-9;         // GDSII: of circles [m]
  ProcessBias bias;
  std::string dose_curve;  // CSV depth_nm,grey: needed for dose
};

struct ExportedFile {
  std::string format, path;
};

// What a texture that is no array became in a layout: polygons, one layer per level.
struct GdsContours {
  std::size_t polygons = 0;
  int levels = 1;
};

struct Export {
  std::vector<ExportedFile> files;
  Texture texture;  // as drawn: the process undone, with a layout the period on its grid
  Heightmap heightmap;
  int cells_x = 0, cells_y = 0;  // unit cells along either side; 0: nothing repeats within
  // What a GDSII layout holds, one of both; what a dose map holds.
  std::optional<GdsArray> array;
  std::optional<GdsContours> contours;
  std::optional<DoseMap> dose;
  std::vector<std::string> warnings;  // what the files hold otherwise than asked for
};

// Equal features that a layout repeats; null: none.
const FeatureArray* array_of(const TextureFacts& known);

// Writes heightmap.exr, heightmap.tif, mask.tif and so on into a folder, which it makes. With a
// GDSII layout of an array the period of all files is the nearest whole nanometre, with a warning;
// so there is one where a pixel is more than a quarter of the smallest hole or wall. Throws
// InputError; then files of the formats before stay.
Export export_design(const Design& design, const ExportOptions& options, const std::string& folder);

}  // namespace papilla::fabricate
