// A design as files for makers and for other programs.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/io/files.h"
#include "study/design.h"

namespace papilla {

// "exr", "tiff" (16-bit heights), "mask" (binary), "gsf", "npy", "png", "gds", "stl".
const std::vector<std::string>& export_formats();

struct ExportOptions {
  std::vector<std::string> formats;  // empty: all that the texture and the polarity allow
  double size = 12e-6;               // wanted side [m], rounded to whole periods
  int pixels = 1024;                 // along x
  std::optional<Polarity> polarity;  // needed for tiff and mask
};

struct ExportedFile {
  std::string format, path;
};

struct Export {
  std::vector<ExportedFile> files;
  Heightmap heightmap;
};

// Writes heightmap.exr, heightmap.tif, mask.tif, ... and export.json (sizes, polarity, margins)
// into a folder, which it makes. Throws InputError; then files of the formats before stay.
Export export_design(const Design& design, const ExportOptions& options, const std::string& folder);

}  // namespace papilla
