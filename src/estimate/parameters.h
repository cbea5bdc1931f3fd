// What the fit of the finger leaves open: its covariance carried to every number of a response.
#pragma once

#include "base/rooms.h"
#include "forward/forward.h"
#include "scene/uncertainty.h"

namespace papilla::estimate {

// What the steps are run with: the load law, at most 8 skins and 128 pixels.
Fidelity step_fidelity(const Fidelity& fidelity);

// Eq. accuracy.11: central differences over the steps, on common skins, offsets and droplets. Fills
// response.parameters and the part `parameters` of every number. Cost: 2 n evaluations at
// step_fidelity. Throws as finger_steps.
void add_parameter_errors(Response& response, const Scene& scene, const Texture& texture,
                          const Fidelity& fidelity);

}  // namespace papilla::estimate
