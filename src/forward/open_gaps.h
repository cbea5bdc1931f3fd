// What the gaps between patches in contact do: their pull and their water, over this texture and
// film. Equations coupling.8 and coupling.9.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "forward/ridges.h"
#include "physics/capillary/water.h"
#include "physics/electrostatics/electrode.h"
#include "physics/electrostatics/field.h"

namespace papilla::forward {

// A textured surface as shares of its area: how far each lies below the level at which the skin
// comes to rest on the texture, and the film there. Eq. coupling.7
struct SurfaceLevels {
  std::vector<double> share, below, film;  // sum 1; [m]; d/eps [m]

  bool flat() const { return share.size() <= 1; }
};
// Levels of equal shares, heights ascending; film: as given for a surface without one of its own.
SurfaceLevels surface_levels(const CoveredSurface& surface, double flat_film);
// The same with `below` counted from the level that skin of an rms height [m] rests at with a share
// of contact, relative to the one on flat glass. Heights before: -below.
SurfaceLevels resting(SurfaceLevels levels, double skin_rms, double contact);

// Per area of the ridges.
struct OpenGapForces {
  double pull = 0;                            // [Pa] at the drive of the problem
  double capillary = 0, retention = 0;        // [Pa], of the angle at rest
  double capillary_on = 0, retention_on = 0;  // under the drive

  double off() const { return capillary; }
  double on() const { return pull + capillary_on; }
};

// Droplets of one humidity on skin and surface that do not touch.
struct FarWater {
  double per_area = 0;          // [m]
  double drops_per_volume = 0;  // before they meet [1/m^3]
  WaterProperties rest, driven;
};

// Pull of the ridges' gaps at one pressure over their area [Pa], those of patches in contact left
// out. Eq. coupling.8
double open_gap_pull(const GapShares& gaps, const SurfaceLevels& levels, const FieldProblem& field);

// Of water between a surface and skin of an rms height [m] at a mean gap [m], per area and per unit
// of the wetting gain and of the hysteresis: capillary and retention [Pa]. Eq. coupling.9
struct HeldByWater {
  double capillary = 0, retention = 0;
};
HeldByWater held_by_water(const SurfaceLevels& levels, double skin_rms, double mean_gap,
                          const FarWater& water);

// Mean gap of a patch of an area [m^2] whose highest place just touches a plane: the expected
// maximum of a Gaussian surface of that rms height [m] and slope (Adler 1981).
double touching_gap(double rms, double slope, double area);

// Water over the ridges: what patches hold that hang by h > 0 over where they just touch. The same
// for every pressure.
class HungWater {
 public:
  // levels: resting where patches just touch. Cost 1 ms.
  HungWater(const SurfaceLevels& levels, double skin_rms, double touching_gap,
            const FarWater& water);

  // hangs: of the ridges above the patch size alone, at one pressure.
  void add(const GapShares& hangs, OpenGapForces& out) const;

 private:
  double at(const std::vector<double>& values, double hang) const;

  FarWater water_;
  double step_ = 0;                            // of the hang [m]
  std::vector<double> capillary_, retention_;  // HeldByWater over the hang
};

// Volume of a droplet after those that touch have merged [m^3], and the gap that it bridges [m].
struct FarDroplet {
  double volume = 0, reach = 0;
};
FarDroplet far_droplet(const FarWater& water);

}  // namespace papilla::forward
