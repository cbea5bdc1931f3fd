// What a lab is opened with: a run and its finalists, a wafer's manifest, designs by name, a
// calibration.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "lab/lab.h"

namespace papilla::report {

struct LabSource {
  // A folder that `papilla optimize` wrote, a manifest.csv or its folder, design files, a
  // calibration. Beside a run all others are measured, and its own designs alone are chosen among.
  std::vector<std::string> paths;
  std::string belief;  // a file; "": that of the designs' finger, or of the calibration
  std::string worth;   // a metric; "": that of the run, else worst(modulation) of driven designs
  std::string load, humidity, voltage, frequency, states;  // lists, "0 V,100 V"; "": the designs'
  std::vector<std::string> values;  // of lab.toml: "instrument.repeatability=2 %"

  bool operator==(const LabSource&) const = default;
};

// What the lab will hold, and for people what was taken where nothing was said. Throws InputError.
struct LabOpening {
  Opening opening;
  std::vector<std::string> notes;
};
LabOpening lab_opening(const LabSource& source);

}  // namespace papilla::report
