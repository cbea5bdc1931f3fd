// A design as files for makers and other programs, and a file judged as what a maker will get.
#pragma once

#include <string>
#include <vector>

#include "papilla/design.h"

namespace papilla::api {

struct ExportOptions {
  std::vector<std::string>
      formats;           // "exr", "tiff", "mask", "gds", ...; empty: what the texture allows
  double size = 0;       // wanted side [m], rounded to whole periods; 0: about 12 um
  int pixels = 1024;     // along x
  std::string polarity;  // "white-high", "white-deep"; needed for tiff and mask
};

struct Exported {
  std::vector<std::string> files;     // their paths
  std::vector<std::string> warnings;  // what the files hold otherwise than asked for
  Heights heights;
};

// Writes the files into a folder, which it makes. Throws InputError.
Exported export_files(const Design& design, const std::string& folder,
                      const ExportOptions& options = {});

struct Verdict {
  double min_hole = 0, min_wall = 0;  // of the file [m]
  double design = 0, file = 0;        // the merit of each, on common skins
  double loss = 0;                    // |file - design| / |design|
  std::vector<std::string> faults;    // for people; empty: sound
};

// A file of heights that export_files wrote, read back, measured and simulated again; the loss of
// merit may be `tolerance` at most. Cost: two evaluations at draft level. Throws InputError.
Verdict verify(const Design& design, const std::string& file, double tolerance = 0.05);

struct FileVerdict {
  std::string path;
  bool sound = true;
  std::vector<std::string> faults;  // for people: what is wrong and by how much
};

struct FolderVerdict {
  std::string folder;
  std::vector<FileVerdict> files;  // each against the design that it was made from
  bool felt = false;               // the heights were simulated again:
  Verdict verdict;

  bool sound() const;
};

struct VerifyOptions {
  bool geometry = false;    // what the files hold alone
  double tolerance = 0.05;  // largest loss of merit of the heights
};

// Every exported file of a folder that `papilla export` wrote, of a run of a study (its best design
// and its front), or one file of it, as `papilla verify`. Throws InputError.
std::vector<FolderVerdict> verify(const std::string& path, const VerifyOptions& options = {});

}  // namespace papilla::api
