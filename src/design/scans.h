// The measured maps behind a design, and what was changed of them.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "geometry/scan.h"

namespace papilla::design {

struct DesignScan {
  std::string file;
  ScanChanges changes;
};

// Of its texture and of its skin; reads the files. Throws InputError.
std::vector<DesignScan> scans_of(const Design& design);

}  // namespace papilla::design
