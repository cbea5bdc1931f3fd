// What can be measured: a design under conditions. An experiment is one such cell; a reading of it
// is a friction with the drive off or on.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/design.h"
#include "scene/finger.h"

namespace papilla::lab {

// SI. voltage: peak of the drive, 0: undriven; frequency: of its carrier, 0: that of the design.
struct Conditions {
  double load = 0.2, relative_humidity = 0.15, voltage = 0, frequency = 0;
  FingerState state = FingerState::Clean;

  bool driven() const { return voltage > 0; }
  bool operator==(const Conditions&) const = default;
};

struct LabDesign {
  std::string name;
  Design design;
  bool choice = true;  // one of those that are decided among
};

// Their names, in the order of the lab's list.
std::vector<std::string> design_names(const std::vector<LabDesign>& designs);

struct Experiment {
  std::size_t design = 0;  // of the lab's list
  Conditions at;

  bool operator==(const Experiment&) const = default;
};

// "35 % RH, 0.2 N, 150 V at 5 kHz, clean"
std::string text(const Conditions& at);

}  // namespace papilla::lab
