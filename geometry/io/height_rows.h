// What stands in a file of heights, row by row and in the file's own words: a strip is in memory,
// whatever the size of the map. Errors: InputError.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "base/rooms.h"
#include "geometry/heightmap.h"
#include "geometry/io/files.h"

namespace papilla::geometry {

struct MapHeader {
  int nx = 0, ny = 0;
  double lx = 0, ly = 0;               // [m]; 0: the file does not say
  bool top_first = true;               // order of the rows
  double step = 0;                     // between neighbouring levels of grey [m]; 0: real numbers
  double black = 0, white = 0;         // heights of the lowest and the highest level of grey [m]
  std::optional<Polarity> polarity;    // where the file names one
  std::optional<double> tag_x, tag_y;  // sides by the file's pixels per length [m]
  // Of a TIFF, how its numbers are shown (PhotometricInterpretation): 1, black is the least of
  // them.
  std::optional<int> photometric;
  bool made = false;       // not measured: an array, or an export of this program
  std::string channel;     // of a file that names what it holds
  std::size_t marked = 0;  // pixels that a mask of the file marks
  // Of a TIFF, what ImageJ takes of its description: "unit" of the tags, heights of levels, "c0" +
  // "c1" * level in "vunit".
  std::map<std::string, std::string> imagej;
};

class HeightRows {
 public:
  virtual ~HeightRows() = default;
  const MapHeader& header() const { return header_; }
  // Pixels that a mask of the file marks are no numbers; without this they are heights: a mask may
  // mark what was not measured, or grains.
  virtual void leave_out_marked() {}
  // The next row in the order of the file [m]; at most header().ny times.
  virtual void next(double* heights) = 0;

 protected:
  MapHeader header_;
};

// Each knows its own files alone. They refuse more than 2^28 pixels unless `any_size`.
std::unique_ptr<HeightRows> open_image_rows(const std::string& path, bool any_size = false);
std::unique_ptr<HeightRows> open_gsf_rows(const std::string& path);
std::unique_ptr<HeightRows> open_npy_rows(const std::string& path);
// X3P, compressed or not, of doubles, floats or whole numbers; the sum of its heights is checked
// once the last row is read.
std::unique_ptr<HeightRows> open_x3p_rows(const std::string& path);
// Files that may hold several channels; none asked for: the one that holds heights.
std::unique_ptr<HeightRows> open_gwy_rows(const std::string& path, const std::string& channel);
std::unique_ptr<HeightRows> open_sur_rows(const std::string& path, const std::string& channel);
std::unique_ptr<HeightRows> open_sdf_rows(const std::string& path);
// By the ending: .exr .tif .tiff .png .gsf .npy .x3p .gwy .sur .sdf; others by Gwyddion.
std::unique_ptr<HeightRows> open_height_rows(const std::string& path, bool any_size = false,
                                             const std::string& channel = "");

// All rows; width [m]: where the file does not say.
Heightmap whole_map(HeightRows& rows, double width);

// Grey or colours as they stand, one byte a channel: rows from the top.
class PictureRows {
 public:
  virtual ~PictureRows() = default;
  int width = 0, height = 0, channels = 0;
  std::optional<double> tag_x, tag_y;  // sides by the file's pixels per length [m]
  virtual void next(std::uint8_t* row) = 0;
};
std::unique_ptr<PictureRows> open_picture_rows(const std::string& path);

}  // namespace papilla::geometry
