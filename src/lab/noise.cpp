#include "lab/noise.h"

#include "base/constants.h"

namespace papilla::lab {

void fields(FieldVisitor& v, Instrument& s) {
  v.number({"repeatability", "%", 0.01, 100,
            "of one reading of the same finger on the same day, a share of the friction",
            Source::Estimate, "repeated strokes of one finger in published tribometry: 2 to 5 %"},
           s.repeatability);
  v.number({"day_to_day", "%", 0, 100, "common to all readings of a finger on a day",
            Source::Estimate, "a finger washed and dried again"},
           s.day_to_day);
  v.number({"finger_to_finger", "%", 0, 200,
            "common to all readings of a finger, beside what the belief knows", Source::Estimate,
            "friction of fingers differs by tens of percent, and the belief is about one of them"},
           s.finger_to_finger);
  v.number(
      {"model", "%", 0, 100, "common to all readings of a design: what the model leaves out of it",
       Source::Estimate, "model against published ratios after the fit"},
      s.model);
}

double covariance(const Instrument& i, const Observation& a, const Observation& b, bool same) {
  double out = same ? square(a.deviation) : 0;
  if (a.finger == b.finger) {
    out += square(i.finger_to_finger);
    if (a.day == b.day) out += square(i.day_to_day);
  }
  if (a.design == b.design) out += square(i.model);
  return out;  // Eq. lab.1
}

}  // namespace papilla::lab
