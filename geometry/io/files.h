// Heightmap files: written whole or not at all, read back and compared. Every writer puts the file
// beside its final name first, checks every error that the library can tell, reads it back,
// compares (of an EXR or PNG above 2^24 pixels a sixteenth, spread over its height, and its end),
// flushes to disk, and renames: an interrupted run leaves the old file. Errors: InputError.
//
// Formats. EXR: one float channel Y in um, lowest plane 0, high is bright, Gwy:: size keys as
// doubles, ZIP, fixed date. TIFF: 16-bit or float, uncompressed, untiled, pixels per cm, JSON in
// ImageDescription. GSF: float32 metres with size. NPY: float64 metres. PNG: coloured preview.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/files.h"
#include "base/rooms.h"
#include "geometry/facts.h"
#include "geometry/heightmap.h"

namespace papilla::geometry {

// Which grey is deep; masks and 16-bit images need the user's word, there is no usual choice.
enum class Polarity { WhiteHigh, WhiteDeep };

struct FileInfo {
  std::string title = "papilla heightmap";
  std::string comment;  // one line, e.g. the design's hash
};

// Loads what image files need, for work that ends with one. Throws std::runtime_error where it is
// missing.
void require_images();

void write_exr(const std::string& path, const Heightmap& h, const FileInfo& info);
void write_tiff16(const std::string& path, const Heightmap& h, Polarity polarity,
                  const FileInfo& info);
void write_tiff_float(const std::string& path, const Heightmap& h,
                      const FileInfo& info);  // um, as EXR
void write_gsf(const std::string& path, const Heightmap& h, const FileInfo& info);
void write_npy(const std::string& path, const Heightmap& h);
// Binary mask, 0 or 65535: where the surface is below half its depth, which is that between two
// planes; without them from the highest pixel to the lowest.
void write_mask_tiff(const std::string& path, const Heightmap& h, Polarity polarity,
                     const FileInfo& info, const std::optional<Planes>& between = std::nullopt);
// Preview: colours from low (dark) to high (bright) with a scale bar, and below it the colour scale
// with its heights and the length of the bar.
void write_png(const std::string& path, const Heightmap& h);

// Reads .npy (float64 or float32, either order, metres), .gsf, .exr (channel Y, um with Gwy keys),
// .tif (float: um; 8 or 16 bits: needs our JSON; other whole numbers are refused), .png (grey,
// needs Gwyddion's keys), .x3p, .gwy, .sur, .sdf, and what Gwyddion reads of other instruments
// where it is installed. width: lateral size in x [m] where the file does not say; 0: the file must
// say; one that contradicts it is refused. Refuses more than 2^28 pixels, sides out of 1 pm to 1
// km, broken files, and heights that are no finite numbers unless they are to be kept; where they
// are, those that a mask of a .gwy marks are none either.
enum class NotNumbers { Refused, Kept };
struct MapAnswer {
  Heightmap map;
  bool made = false;       // not measured: an array, or an export of this program
  std::string channel;     // "": the file names none
  std::size_t marked = 0;  // pixels that a mask of a .gwy marks
};
MapAnswer read_map(const std::string& name, double width = 0,
                   NotNumbers not_numbers = NotNumbers::Refused);
std::string lower_ending(const std::string& path);  // ".exr"
// The file of a map and its channel, by name or number: "scan.gwy::Height" is that channel of
// scan.gwy. Without one the channel that holds heights is read; of several one must be named.
struct MapName {
  std::string file, channel;
};
MapName map_name(const std::string& name);
Heightmap read_heightmap(const std::string& path, double width = 0,
                         NotNumbers not_numbers = NotNumbers::Refused);

// RGB rows, top first, 3 bytes per pixel.
void write_png_rgb(const std::string& path, int width, int height,
                   const std::vector<std::uint8_t>& rgb);
// Field as colours (viridis-like), low to high, with a scale bar of a round length.
std::vector<std::uint8_t> render_field(const Grid& grid, const std::vector<double>& values,
                                       int& width, int& height);
// Its colours, 0 low to 1 high, and the length of its scale bar [m].
std::array<std::uint8_t, 3> field_colour(double share);
double scale_bar_length(const Grid& grid);

}  // namespace papilla::geometry
