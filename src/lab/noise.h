// What scatters between a measured friction and the model of it. Shares of the friction: standard
// deviations of its logarithm. Eq. lab.1
#pragma once

#include <cstddef>
#include <string>

#include "base/rooms.h"
#include "config/fields.h"

namespace papilla::lab {

// An instrument and those who work with it, as a gauge study (repeatability, reproducibility)
// parts them, and what the model leaves out of a design.
struct Instrument {
  double repeatability = 0.03;     // of one reading of the same finger on the same day
  double day_to_day = 0.04;        // common to all readings of a finger on a day
  double finger_to_finger = 0.10;  // common to all readings of a finger, beside the belief's
  double model = 0.03;             // common to all readings of a design: what no member explains

  bool operator==(const Instrument&) const = default;
};
void fields(FieldVisitor& v, Instrument& s);

// A reading, or the mean of some, as the covariance sees it.
struct Observation {
  std::size_t row = 0;   // of the ensemble's responses
  double deviation = 0;  // of its own
  std::size_t design = 0;
  std::string finger, day;
};

// Of two readings beside what belief says and what the model's skins leave open. Eq. lab.1
double covariance(const Instrument& instrument, const Observation& a, const Observation& b,
                  bool same);

}  // namespace papilla::lab
