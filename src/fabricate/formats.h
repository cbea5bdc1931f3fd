// The kinds of files that an export writes: the one table that the writer, the command's help, its
// messages and the reference read.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "fabricate/export.h"

namespace papilla::fabricate {

// What a writer gets.
struct ExportSource {
  const Heightmap& heightmap;
  const Texture& texture;  // as drawn
  const ExportOptions& options;
  const FileInfo& info;
  const std::function<void(double)>& progress;  // the share of a long file; may be empty
};

struct ExportFormat {
  const char* name;   // as --format has it: "exr"
  const char* file;   // in the folder of the export: "heightmap.exr"
  const char* holds;  // for people: "heights in um, 32-bit float"
  // What it cannot be written without.
  bool needs_polarity = false;    // which grey is deep
  bool needs_outline = false;     // edges that polygons follow
  bool follows_outline = false;   // of a relief; what is flat has none and is drawn all the same
  bool needs_dose_curve = false;  // depth over grey
  bool repeated = false;          // its map stands there so many times: ExportOptions::repeat
  bool asked_only = false;        // not among the files of an export that names no formats
  // Pixels of the map that a byte of it can hold, packed as well as can be; 0: none.
  double pixels_per_byte = 0;
  int judged = 0;  // when its heights are simulated again, 1 first; 0: never
  void (*write)(const ExportSource& source, const std::string& path, Export& out) = nullptr;
  // What of a file is not as the source has it. Throws InputError for one that cannot be read.
  std::vector<std::string> (*check)(const ExportSource& source, const std::string& path) = nullptr;

  bool has_pixels() const { return !needs_outline; }
};

std::span<const ExportFormat> export_format_table();
// Throws InputError, with the names that are known.
const ExportFormat& find_export_format(const std::string& name);

// The formats that an export writes: those that its options name, or all that the texture and the
// polarity allow. Throws InputError for one that cannot be written.
std::vector<ExportFormat> chosen_formats(const Texture& texture, const ExportOptions& options);

// Why a setting has no effect on the files that are written; empty: one of them depends on it.
// setting, formats: their names as the user knows them; depends: whether a format does; of_no_file:
// why none does of this texture, where that may be.
std::string without_effect(std::span<const ExportFormat> written, const std::string& setting,
                           const std::string& formats,
                           const std::function<bool(const ExportFormat&)>& depends,
                           const std::string& of_no_file = "");

// "exr", "tiff" and so on, in the order of the table.
const std::vector<std::string>& export_formats();
// The first file that holds heights to be read back. Throws InputError where there is none.
std::string heights_file(const std::vector<ExportedFile>& files);

}  // namespace papilla::fabricate
