// What skipping a piece of physics can cost, computed on the patches of the scene itself.
#pragma once

#include "forward/forward.h"

namespace papilla {

// Bounds on the relative change of friction by pieces that the plan skips, from `skins` patches per
// humidity with all their fields; the largest over humidity. Eq. accuracy.7-10
struct SkipBounds {
  double van_der_waals = 0;     // Eq. accuracy.7
  double kelvin = 0;            // Eq. accuracy.8; infinite at 100 % RH
  double self_consistency = 0;  // Eq. accuracy.9, of friction under voltage; infinite: pull-in
  double retention = 0;         // Eq. accuracy.10
};
SkipBounds skip_bounds(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                       int skins = 2);

// The plan with these in place of what it states a priori. Cost: `skins` patches per humidity.
Plan measured_plan(const Scene& scene, const Texture& texture, const Fidelity& fidelity);

// Attraction [Pa] per pixel that is not in contact, of the two pieces with no model of their own.
Traction van_der_waals_traction(const Gap& gap);
Traction kelvin_traction(const Gap& gap, const Scene& scene, double relative_humidity);

}  // namespace papilla
