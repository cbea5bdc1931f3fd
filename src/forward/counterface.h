// A pin in place of the finger: the facts of skin, gross contact and friction that the scene asks
// for, so that every piece of physics takes it as it takes a finger. Equations macro.N, friction.N.
#pragma once

#include <string>

#include "base/rooms.h"
#include "scene/counterface.h"
#include "scene/scene.h"

namespace papilla::forward {

// E* of the pin and what it presses on [Pa]. Eq. macro.6
double contact_modulus(const Pin& pin, const Surface& surface);
// Nominal contact area [m^2] under its load: a flat face's, or Hertz' circle. Eq. macro.6
double nominal_area(const Pin& pin, const Surface& surface);

// The scene with the pin in place of its finger. What the finger has of skin and states falls away:
// nothing of a pin moves with humidity, and there is no water but its own. Waves of its roughness
// that are longer than a patch are its ridges: with some, the closure is the balance of all its
// gaps, without, one pressure.
Scene touched_by(const Pin& pin, Scene scene);

// Why a pin cannot be modelled on this surface, for people; "" where it can.
std::string pin_refusal(const Pin& pin, const Surface& surface);

}  // namespace papilla::forward
