// A design as files for makers and for other programs.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "geometry/io/drawing.h"
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

inline constexpr int kMostLevels = 64;

struct ExportOptions {
  // Names of fabricate/formats.h; empty: all that the texture and the polarity allow.
  std::vector<std::string> formats;
  // Wanted side [m], rounded to whole periods; 0: the window, two periods at least.
  double size = 0;
  double size_y = 0;                 // of a rectangle; 0: as wide as high
  int pixels = 1024;                 // along x
  std::optional<Polarity> polarity;  // needed for tiff and mask
  int repeat = 1;                    // EXR alone: times in x and y, streamed
  int levels = 1;             // layouts of textures that are no arrays: masks, kMostLevels at most
  double facet_error = 2e-9;  // layouts: of circles [m]
  ProcessBias bias;
  std::optional<DoseCurve> dose_curve;  // needed for dose
};

struct ExportedFile {
  std::string format, path;
};

// What a texture that is no array became in a layout: polygons, one layer per level.
struct LayoutContours {
  std::size_t polygons = 0;
  int levels = 1;
};

struct Export {
  std::vector<ExportedFile> files;
  Texture texture;  // as drawn: the process undone, with a layout the period on its grid
  Heightmap heightmap;
  int cells_x = 0, cells_y = 0;  // unit cells along either side; 0: nothing repeats within
  int repeat = 1;                // times that the EXR holds the map along x and along y
  // What a layout holds, one of both; what a dose map holds.
  std::optional<LayoutArray> array;
  std::optional<LayoutContours> contours;
  std::optional<DoseMap> dose;
  std::vector<std::string> warnings;  // what the files hold otherwise than asked for
};

// Equal features that a layout repeats; null: none.
const FeatureArray* array_of(const TextureFacts& known);
// The arrays that a texture is a sum of, one alone or all deep: what a mask each makes. Empty: it
// is no such sum, or flat.
std::vector<Texture> arrays_of(const Texture& texture);

// Width [m] of such features that leave this share of the area below half their depth; none: of no
// array.
std::optional<double> width_by_area(const Texture& texture, double share);

// The planes at shares of whose distance masks and contours of a map have their edges [m]: those
// that the texture states and reaches, whose sharp ends pixels cut off; else the highest and the
// lowest pixel. Of a stack the latter: where its parts do not meet, nothing is as deep as the sum.
Planes edge_planes(const Texture& texture, const Heightmap& h);

// Whether a mask of such pixels shows the texture: it has an outline, or is flat, and no pixel is
// wider than half its smallest hole or wall.
bool mask_shows(const Texture& texture, const ExportOptions& options);

// Why a map of such pixels does not show the texture, one being wider than half its smallest hole
// or wall; empty: it does.
std::string lost_between_pixels(const Texture& texture, const Grid& grid);

// All that an export is but its files: the texture as drawn on its grid. options.formats names the
// files that are meant. With a layout of an array the period of all files is the nearest whole
// nanometre, with a warning; so there is one where a pixel is more than a quarter of the smallest
// hole or wall. Throws InputError, also above so many pixels: before memory is taken for them.
inline constexpr double kMostPixels = 1 << 28;
Export prepare_export(const Design& design, const ExportOptions& options,
                      double most_pixels = kMostPixels);

// What the files say of themselves.
FileInfo info_of(const Design& design);

// Told before each file, and during a long one: its name and the share that is done.
using FileProgress = std::function<void(const std::string& file, double share)>;

// Writes heightmap.exr, heightmap.tif, mask.tif and so on of what was prepared of a design into a
// folder that there is. Throws InputError; then files of the formats before stay.
void write_files(const Design& design, const ExportOptions& options, const std::string& folder,
                 const FileProgress& progress, Export& prepared);

// Both; makes the folder.
Export export_design(const Design& design, const ExportOptions& options, const std::string& folder,
                     const FileProgress& progress = {});

}  // namespace papilla::fabricate
