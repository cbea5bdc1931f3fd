// Contact angle of water under voltage, with saturation.
#pragma once

#include "base/rooms.h"

namespace papilla::electrostatics {

// eta = eps0 V^2 / (2 gamma sum d/eps). v [V], dielectric_equivalent = sum of d/eps [m], gamma
// [N/m]. Infinite for a bare electrode under voltage. Eq. electrostatics.5
double electrowetting_number(double v, double dielectric_equivalent, double surface_tension);

// cos theta = c0 + dC tanh(eta/dC), dC = c_sat - c0; the right slope at 0 (Lippmann-Young), c_sat
// at infinity. eta_peak is that of the peak voltage; for a sine the cosine is averaged over the
// cycle (droplets of micrometres follow 5 kHz quasi-statically). No effect where c_sat <= c0. Eq.
// electrostatics.6
// held: voltage over the peak from which a film that saturates takes no more charge; eta_peak is
// that of a film without one. Eq. electrostatics.22
double electrowetted_cosine(double cos_rest, double cos_saturated, double eta_peak, bool sine,
                            double held = 1);

}  // namespace papilla::electrostatics
