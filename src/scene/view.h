// How a texture is looked at and how well it can be made: what only optics asks.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "config/fields.h"

namespace papilla::scene {

struct View {
  std::vector<double> angles{0};   // of view, from the normal [rad]; what is judged is their mean
  double fill_index = 1;           // of what fills the texture
  double displacement = 5e-9;      // of features from their lattice, each coordinate [m]
  double diameter_scatter = 0.02;  // standard deviation / mean

  bool operator==(const View&) const = default;
};
void fields(FieldVisitor& v, View& s);

}  // namespace papilla::scene
