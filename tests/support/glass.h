// Bare glass and how it is looked at.
#pragma once

#include <utility>
#include <vector>

#include "scene/environment.h"
#include "scene/view.h"

namespace papilla::tests {

inline Surface glass_of(double index) {
  Surface out;
  out.refractive_index = index;
  return out;
}

inline View view_from(std::vector<double> angles) {
  View out;
  out.angles = std::move(angles);
  return out;
}

inline View filled_with(double index) {
  View out;
  out.fill_index = index;
  return out;
}

}  // namespace papilla::tests
