// What the field rules cost and how far each is from the 3-D potential, on solved patches.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"

namespace papilla::measure {

// One method on one patch at one humidity. A patch is solved at `pixels`, its skin is then refined
// as a smooth surface (Catmull-Rom), its texture generated anew: the same bodies on finer grids.
struct FieldAccuracyRow {
  std::string sample, method;  // "local", "screened" (local with screening), "spread", "full"
  double relative_humidity = 0;
  int pixels = 0;      // of the method's grid
  double pull = 0;     // [Pa] mean over the patch
  double error = 0;    // pull / that of the finest full field, less 1
  double seconds = 0;  // of the processor
  std::string status;  // empty: sound
};

struct FieldAccuracyOptions {
  int pixels = 128;                          // of the solved patch
  int skin = 0;                              // index of the skin
  std::vector<int> refinements = {1, 2, 4};  // of the full field, the last is the reference
};

// Local rules and full field of one design at its humidities. Cost: of the finest 3-D solve, 1 s
// per humidity at 512^2.
std::vector<FieldAccuracyRow> field_accuracy(const std::string& sample, const Design& design,
                                             const FieldAccuracyOptions& options);

}  // namespace papilla::measure
