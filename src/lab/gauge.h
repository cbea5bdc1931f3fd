// How readings scatter, from those that repeat one another: a gauge study. Eq. lab.14
#pragma once

#include <vector>

#include "base/rooms.h"
#include "lab/records.h"

namespace papilla::lab {

// A standard deviation of the logarithm of friction, and the independent differences that it
// stands on; 0: none.
struct GaugeSpread {
  double deviation = 0;
  int freedom = 0;
};

struct Gauge {
  GaugeSpread repeatability, day_to_day, finger_to_finger;
};

// Of readings of the same experiment: within a finger and day, between days, between fingers.
Gauge gauge_of(const std::vector<FrictionReading>& readings);

// What is thought of an instrument after its own readings: where these show more scatter than was
// stated, by ten differences at least, that is believed.
Instrument after_gauge(const Instrument& stated, const Gauge& gauge);

}  // namespace papilla::lab
