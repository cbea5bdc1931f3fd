// Measured maps on the command line: which file, how it is taken, and what is said of that.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "cli/context.h"
#include "design/design.h"
#include "geometry/scan.h"

namespace papilla::cli {

struct ScanOptions {
  std::string file, size;
  bool fill = false, as_is = false, level = false;

  ScanSource source() const;  // throws InputError
};

// --size, --fill, --as-is and --level.
std::vector<Option> add_scan_options(Command command, ScanOptions& options);

// What was changed of a map, on standard error: it is no progress, --quiet keeps it.
void say_scan(const std::string& file, const ScanChanges& changes);
// Of every map behind the designs, each once.
void say_scans(const std::vector<Design>& designs);

}  // namespace papilla::cli
