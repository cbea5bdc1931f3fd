// The forward model: friction of a finger on a texture, off and on, over humidity.
#pragma once

#include "forward/errors.h"
#include "forward/patch_set.h"
#include "forward/undriven.h"

namespace papilla {

// Friction with the drive off and on [N, whole finger], modulation and their causes at each
// humidity of the scene, with the parts of each error that the fidelity measures: solve_patches,
// measure_errors, respond. The scene and the texture are described, checked values (SI). What goes
// wrong numerically is a status per point (`Response::troubles`), never an exception; InputError
// only for a file that a map of skin or texture names. The same bytes for any number of threads.
// Cost: skins x humidities x (1 or 3) contact solves, and the control skins once or twice more;
// `Plan::seconds` estimates it, 0.5 to 5 min on one core at level design.
Response evaluate(const Scene& scene, const Texture& texture, const Fidelity& fidelity);

}  // namespace papilla
