// What a folder of files was made from, so that any of them can be judged later: kept in its
// export.json.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/folder.h"
#include "base/rooms.h"
#include "design/study.h"
#include "fabricate/export.h"
#include "geometry/io/mask.h"

namespace papilla::fabricate {

inline constexpr const char* kRecordName = "export.json";
// Among the files of a record: the design itself, beside those of the table of formats.
inline constexpr const char* kDesignFormat = "design";

struct ExportRecord {
  // As asked for: the process is undone in the files alone. Without the belief of its finger.
  Design design;
  ExportOptions options;  // formats: those of the files
  std::vector<ExportedFile> files;
  std::vector<Constraint> limits;  // of the study, as far as files show them
  std::string version;             // that made the files; "": of 0.2.2 or earlier
};

// What the pixels of a file show of a limit; nothing of one that they do not tell.
std::optional<double> in_pixels(const Limited& on, const PixelMargins& pixels);

// The design with the measured maps that it is made of copied into a folder, and named there: a
// record that has it is read wherever the folder lies. Throws InputError.
Design with_own_maps(const Design& design, const Folder& folder);

ExportRecord record_of(const Study& study, const ExportOptions& options, const Export& result);

// The member "made_from" of export.json.
std::string record_json(const ExportRecord& record);
// The record of a folder. Throws InputError where there is none or it cannot be read.
ExportRecord read_record(const std::string& folder);

}  // namespace papilla::fabricate
