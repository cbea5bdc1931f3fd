// Everything the forward model needs to know besides the texture and the fidelity.
#pragma once

#include <string>

#include "base/rooms.h"
#include "scene/environment.h"
#include "scene/finger.h"

namespace papilla::scene {

// What the scene asks of what touches the surface beyond the facts that a finger has too.
struct TouchLaw {
  // F = coefficient x normal force; 0: shear strength x contact area. Eq. friction.4
  double coefficient = 0;
  bool conducts = true;  // else no drive reaches through it
  std::string name;      // of what stands in place of skin, "pin"; "": skin

  bool operator==(const TouchLaw&) const = default;
};

struct Scene {
  Surface surface;
  Finger finger;
  Environment environment;
  Drive drive;
  ModelOptions model;
  TouchLaw touch{};

  bool operator==(const Scene&) const = default;
};

}  // namespace papilla::scene
