// An exported file judged as what a maker will get: read back, measured, simulated again.
#pragma once

#include <string>
#include <vector>

#include "design/study.h"
#include "geometry/io/mask.h"

namespace papilla {

struct Verification {
  PixelMargins pixels;              // smallest hole and wall of the file
  std::string merit;                // "mean(modulation)", of undriven designs "mean(friction)"
  double design = 0, file = 0;      // the merit of each, on common skins
  double loss = 0;                  // |file - design| / |design|
  std::vector<std::string> faults;  // what is beyond a limit; empty: sound
};

// File: one of exr, gsf, tiff written by export_design. Limits: the constraints min_hole and
// min_wall of the study, kept to a pixel; the loss of merit at most `tolerance`. Cost: two
// evaluations at draft level. Throws InputError for a file that cannot be read.
Verification verify_export(const Study& study, const std::string& file, double tolerance);

}  // namespace papilla
