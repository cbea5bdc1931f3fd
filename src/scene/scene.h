// Everything the forward model needs to know besides the texture and the fidelity.
#pragma once

#include "base/rooms.h"
#include "scene/environment.h"
#include "scene/finger.h"

namespace papilla::scene {

struct Scene {
  Surface surface;
  Finger finger;
  Environment environment;
  Drive drive;
  ModelOptions model;

  bool operator==(const Scene&) const = default;
};

}  // namespace papilla::scene
