// How a texture is looked at and how well it can be made: what only optics asks.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "config/fields.h"

namespace papilla::scene {

// A flat film between the dielectric and the glass: the electrode, what matches its index.
struct ViewFilm {
  std::string material;
  double thickness = 0;                         // [m]
  double refractive_index = 1, extinction = 0;  // n + i k; a file states n

  bool operator==(const ViewFilm&) const = default;
};
void fields(FieldVisitor& v, ViewFilm& s);

// The display below the glass; it has none where the subpixels have no width.
struct ViewPanel {
  double subpixel_width = 0, subpixel_height = 0;  // [m]
  double glass = 0.7e-3;                           // thickness of the textured glass [m]
  double gap = 0.5e-3;                             // from the glass to the subpixels [m]
  double gap_index = 1.5;
  double distance = 0.5;  // of the eye [m]
  double pupil = 4e-3;    // diameter [m]
  double wavelength = 550e-9;

  bool present() const { return subpixel_width > 0 && subpixel_height > 0; }
  bool operator==(const ViewPanel&) const = default;
};
void fields(FieldVisitor& v, ViewPanel& s);

enum class GlossBacking { Black, None };
// Which theory looks at arrays: by their period, the rigorous one wherever it can, or never.
enum class LatticeTheory { ByPeriod, Rigorous, Scalar };

struct View {
  std::vector<double> angles{0};   // of view, from the normal [rad]; what is judged is their mean
  double fill_index = 1;           // of what fills the texture
  double displacement = 5e-9;      // of features from their lattice, each coordinate [m]
  double diameter_scatter = 0.02;  // standard deviation / mean
  double cone = 0.04363323129985824;  // light beyond it is haze [rad]: 2.5 deg
  double inner_haze = 0;              // of the plate itself
  double glass_index = 0;             // of the plate; 0: surface.refractive_index
  double back_index = 1;              // behind the plate
  GlossBacking gloss_backing = GlossBacking::Black;
  LatticeTheory lattices = LatticeTheory::ByPeriod;
  std::vector<ViewFilm> films;  // the one on the glass first
  ViewPanel panel;

  bool operator==(const View&) const = default;
};
void fields(FieldVisitor& v, View& s);

}  // namespace papilla::scene
