// How a texture is looked at and how well it can be made: what only optics asks.
#pragma once

#include "config/fields.h"

namespace papilla {

struct View {
  double fill_index = 1;           // of what fills the texture
  double displacement = 5e-9;      // of features from their lattice, each coordinate [m]
  double diameter_scatter = 0.02;  // standard deviation / mean

  bool operator==(const View&) const = default;
};
void fields(FieldVisitor& v, View& s);

}  // namespace papilla
