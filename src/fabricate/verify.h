// Exported files judged as what a maker will get: each against the design that it was made from,
// and one of them measured and simulated again.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/study.h"
#include "fabricate/record.h"
#include "geometry/io/mask.h"

namespace papilla::fabricate {

// --- against the design ---

enum class FileState { Sound, Differs, Missing, Unreadable };

struct FileVerdict {
  std::string path;
  FileState state = FileState::Sound;
  std::vector<std::string> faults;  // what is wrong and by how much
};

// The files of a record against what the design has in their place: sides, pixels, polarity, depth,
// critical dimension, polygons, every height to the rounding of the format. Cost: about that of
// writing them; a strip of each is in memory.
std::vector<FileVerdict> verify_files(const ExportRecord& record, const Export& made,
                                      const FileProgress& progress = {});

// The same of a folder that `papilla export` or a search wrote: made again from its record. Files
// of a known name that the record does not have are judged too. file: of that name alone; empty:
// all. Throws InputError where the folder has no record.
std::vector<FileVerdict> verify_folder(const std::string& folder, const std::string& file = "",
                                       const FileProgress& progress = {});

// --- as a surface that is felt ---

struct Verification {
  PixelMargins pixels;               // smallest hole and wall of the file
  std::string merit;                 // "mean(modulation)", of undriven designs "mean(friction)"
  double design = 0, file = 0;       // the merit of each, on common skins
  double loss = 0;                   // |file - design| / |design|
  std::vector<std::string> faults;   // what is beyond a limit; empty: sound
  std::vector<std::string> notes{};  // what no limit speaks of, and a maker should know
  // What `design` is of: files that undo a process hold another texture than is to be made.
  std::string against = "the design";
};

// File: heights written by export_design. Limits: the constraints min_hole and
// min_wall of the study, kept to a pixel (of a stack each part by itself: a place between the
// features of two parts is noted); the loss of merit at most `tolerance`. Cost: two
// evaluations at draft level. width [m]: where the file does not say. Throws InputError for a file
// that cannot be read, and for a design that cannot be simulated.
Verification verify_export(const Study& study, const std::string& file, double tolerance,
                           double width = 0);
// The same of a record's most exact file of heights, against the design as the files have it: with
// the process undone. Throws InputError where there is none.
Verification verify_export(const ExportRecord& record, double tolerance);

}  // namespace papilla::fabricate
