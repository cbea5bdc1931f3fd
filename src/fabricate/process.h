// What making a surface from a mask does to it: exposure, resist, etch, imprint; and the mask that
// undoes it. docs/theory/fabrication.md
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "config/fields.h"
#include "geometry/arrays.h"
#include "geometry/texture.h"

namespace papilla::fabricate {

struct Process {
  double corner_radius = 0;     // to which the exposure rounds a square corner [m]
  double resist_bias = 0;       // each edge of an opening in the resist moves outward by this [m]
  double undercut = 0;          // of the etch below the resist, at each edge, over its depth
  double wall_angle = 0;        // that the etch leaves, from the land [rad]; 0: as each design says
  double edge_radius = 0;       // of the rims that the process leaves [m]; 0: as each design says
  double shrinkage = 0;         // of an imprint along the surface: share of every length
  double height_shrinkage = 0;  // and of its heights
  bool compensate = true;       // the mask is drawn so that the made surface is the wanted one

  bool none() const;  // a mask is the surface
  // Of the Gaussian that blurs the exposure [m]. Eq. fabrication.2
  double blur() const;

  bool operator==(const Process&) const = default;
};
void fields(FieldVisitor& v, Process& s);

// An array of features that is wanted, and how it is made: drawn on the 1 nm grid of layouts.
struct MaskedArray {
  FeatureArray wanted;  // its outline
  WallSection wall;     // its walls
  FeatureArray mask;    // as drawn
  double etch = 0;      // depth to etch [m]
  WallSection etched;   // the walls that the etch leaves
};

// The walls of an array of features.
WallSection wall_of(Texture texture);

// The width of a mask's features in the resist, after the blur of the exposure: where the light is
// 1/2; of discs by their area. 0 where nothing opens, the period where all of it does. Eq.
// fabrication.3
double exposed_width(const FeatureArray& mask, double blur);

// The mask of one array texture (holes, pillars, grooves). Throws InputError where no mask makes
// it: nothing is left of the features, or of what is between them; and where the rims of the etch
// leave nothing of the land.
MaskedArray masked(const Texture& texture, const Process& process);
// Those of the arrays that a surface is the sum of. The periods drawn are whole fractions of the
// longest, as those of the surface are, so that the masks stay in register over a whole pad. Throws
// InputError where whole nanometres make no such periods near the wanted ones.
std::vector<MaskedArray> masked(const std::vector<Texture>& arrays, const Process& process);

}  // namespace papilla::fabricate
