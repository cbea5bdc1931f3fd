// What the fit of the finger leaves open: its covariance carried to every number of a response.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "forward/forward.h"
#include "scene/uncertainty.h"

namespace papilla::estimate {

// What the steps are run with: the load law, at most 8 skins and 128 pixels.
Fidelity step_fidelity(const Fidelity& fidelity);

// A run on few skins, without control or field skins, is as well known as the response that it is
// moved from: `felt` there takes the response's own numerical error of the modulation, as a share
// of the ratio F_on/F_off that it is of. Eq. metrics.7
void take_felt_errors(Resampled& run, const std::vector<ResponsePoint>& response);

// Eq. accuracy.11: central differences over the steps, on common skins, offsets and droplets. Fills
// response.parameters and the part `parameters` of every number. Cost: 2 n evaluations at
// step_fidelity. Throws as finger_steps.
void add_parameter_errors(Response& response, const Scene& scene, const Texture& texture,
                          const Fidelity& fidelity);

}  // namespace papilla::estimate
