// Where the electrode lies below a textured surface: what the making of the film decides.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "geometry/heightmap.h"
#include "scene/environment.h"

namespace papilla::electrostatics {

// One layer of the film on the electrode, and how it came there.
struct FilmLayer {
  FilmProcess process = FilmProcess::Conformal;
  double step_coverage = 0;  // of a directional layer: side wall / top
  double thickness = 0;      // [m] along the normal; directional: along z; planar: at height 0
  double permittivity = 1;
};
// The layers of a finish, the one on the electrode first.
std::vector<FilmLayer> film_layers(const Surface& surface);

// The surface below a layer: eroded by an ellipsoid as high as the layer is thick and as wide as it
// covers side walls: a ball for a conformal layer, a vertical shift for one that covers none.
// Heights are those of pixels, so a wall stands a pixel wide. Cost: pixels times pixels in a disc
// of the thickness where the surface is rough, one pass where it is flat. Eq. electrostatics.2
Heightmap below_layer(const Heightmap& surface, double thickness, double side_thickness);

// A rigid finished surface and the film below it: what the field rules know of a texture, the same
// for every gap above it. Per pixel.
struct CoveredSurface {
  // layers: the one on the electrode first; none: the surface is the electrode. Planar layers have
  // a flat electrode and carry the texture, all others follow what they cover.
  CoveredSurface(Heightmap surface, const std::vector<FilmLayer>& layers);

  Heightmap height;                // [m]
  std::vector<double> film;        // dielectric of the column, along z [m]
  std::vector<double> dielectric;  // d/eps of the column [m]
  // d/eps that the rules of columns see: of the pressure half the column's, half that of the
  // nearest place of the electrode [m]. Eq. electrostatics.2
  std::vector<double> effective;
  bool walls = false;  // the electrode is not flat and has edges
  // Share of the pixels where the texture cuts through its planar film, to the electrode: next to
  // no film counts there.
  double cut_through = 0;
};

}  // namespace papilla::electrostatics
