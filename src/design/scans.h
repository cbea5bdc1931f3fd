// The measured maps behind a design, and what was changed of them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "geometry/facts.h"
#include "geometry/scan.h"

namespace papilla::design {

struct DesignScan {
  std::string file;
  ScanChanges changes;
  double taken = 0;                 // side of the square of the map that the texture is [m]
  std::string section = "texture";  // whose `patch`, `at_x` and `at_y` choose it: or a part's of it
  // Sides of what is taken where they are whole periods, of another part of a stack or of the map
  // itself [m]; `taken` is the longer one.
  std::optional<UnitCell> periods{};
  // Over the border of what is taken, where that is another step than between neighbours: the patch
  // left no room for the seam that is blended, or the map does not repeat as it is said to.
  std::optional<BorderSteps> step{};
  // Of a map that is taken as it is: side of the square of it that is said to be a period [m]; 0:
  // all of it is.
  double period = 0;
};

// What was changed of it, and where a part alone is taken.
std::string text(const DesignScan& scan);

// Overrides that put a scan into a design as its texture, before others.
std::vector<std::string> scan_as_texture(const std::string& scan,
                                         const std::vector<std::string>& others);

// Of its texture and of its skin; reads the files. Throws InputError.
std::vector<DesignScan> scans_of(const Design& design);

}  // namespace papilla::design
