// What `papilla verify` judges: a folder of exported files, those of a run, or one file.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "report/export.h"

namespace papilla::report {

// A folder with a record, and one file of it or all.
struct ExportPlace {
  std::string folder, file;  // file: empty, all of them
};
// The folder itself, or best/ and those of the front of a run. Throws InputError for nothing there.
std::vector<ExportPlace> export_places(const std::string& path);

struct JudgeOptions {
  bool geometry = false;    // what the files hold alone
  double tolerance = 0.05;  // largest loss of merit of the heights
};
// Throws InputError.
ExportVerdict judge_export(const ExportPlace& place, const JudgeOptions& options,
                           const FileProgress& progress = {});

}  // namespace papilla::report
