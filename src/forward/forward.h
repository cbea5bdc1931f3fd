// The forward model: friction of a finger on a texture, off and on, over humidity.
#pragma once

#include "base/rooms.h"
#include "forward/errors.h"
#include "forward/patch_set.h"
#include "forward/undriven.h"

namespace papilla::forward {

// Runs the forward model: solve_patches, measure_errors, respond. Returns, at each humidity of the
// scene, the friction with the drive off and on [N, whole finger], the modulation, and the areas,
// forces and gaps that they follow from, each with the error parts that the fidelity asks for.
// Scene and texture are parameters in SI that have been checked already. Numerical trouble is a
// status of its point (`Response::troubles`), never an exception; InputError is thrown only for a
// file that a map of skin or texture names. All numbers but the times are bit-identical for any
// number of threads. Cost: that of solve_patches, and the control skins once or twice more;
// `Plan::seconds` estimates it: 0.5 to 5 min on one core at level design.
Response evaluate(const Scene& scene, const Texture& texture, const Fidelity& fidelity);

}  // namespace papilla::forward
