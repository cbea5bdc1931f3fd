// Bare glass, for looks.
#pragma once

#include "scene/environment.h"

namespace papilla::tests {

inline Surface glass_of(double index) {
  Surface out;
  out.refractive_index = index;
  return out;
}

}  // namespace papilla::tests
