// Potential in the whole gap between electrode and skin: holes, oxide, water, rough skin.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "fields/gap.h"
#include "fields/wetting.h"
#include "geometry/heightmap.h"
#include "physics/electrostatics/field.h"

namespace papilla::electrostatics {

struct PotentialOptions {
  // Of a column, smaller towards the dielectric's surface; 0: as many as its thickness has in half
  // pixels and two, from 4 to 8.
  int dielectric_cells = 0;
  int air_cells = 4;
  double tolerance = 1e-3;  // on the relative error in energy norm
  int max_iterations = 60;
};

// Bodies as heights over a periodic grid [m]: electrode <= surface <= skin.
struct PotentialProblem {
  Grid grid;
  std::vector<double> electrode, surface, skin;
  std::vector<double> water_below, water_above;  // of droplets that do not bridge [m]; may be empty
  std::vector<std::uint8_t> bridged;             // water that leads fills the gap; may be empty
  std::vector<double> dielectric;  // d/eps between electrode and surface [m]; empty: air
  double skin_layer = 0;           // d/eps between skin surface and body [m]
  double water_skin_layer = 0;     // between water and body [m]; 0: water at its potential
};

// For one volt between electrode and body.
struct PotentialSolution {
  // Twice the stress on the skin over eps0, along z, per pixel of the projection [1/m^2]; 0 in
  // bridges. A little below zero where a pixel's share of the energy is small.
  std::vector<double> square_field;
  std::vector<double>
      surface_potential;   // on the dielectric, per pixel; in water that of the water
  double capacitance = 0;  // over eps0 [m]
  double peak_air = 0;     // largest field at the skin [1/m]
  double residual = 0;     // relative, energy norm, estimated
  int iterations = 0;
  bool ok = true;
  std::string reason;  // when not ok
};

// div(eps grad phi) = 0, phi = 1 on the electrode, 0 behind the skin's layer, periodic. Every pixel
// is a column of nodes at heights of its own, on all interfaces; neighbours exchange flux at equal
// heights, through half a pixel of either medium, and with the straight line between their
// surfaces where one of them is a body. Each body of water floats at the potential at which as much
// charge comes to it as its contact with the skin's layer passes on. A flat stack and tilted
// parallel plates are exact. The stress on the skin is the derivative of that energy, so it is
// consistent with the capacitance. Conjugate gradients with one multigrid cycle (semi-coarsened in
// x and y, columns solved exactly). Eq. electrostatics.13, 14. Not ok: no dielectric somewhere,
// values that are not finite, or the iteration limit. Cost: 0.6 kB a pixel, 3 to 5 iterations, up
// to 9 around water, 5 us a pixel.
PotentialSolution solve_potential(const PotentialProblem& problem, const PotentialOptions& options);

// Price of one solve on one core of a usual machine [s].
double full_field_seconds(const Grid& grid);

// Whether the skin's layer is thin enough to stand above the skin as air: from a tenth of the patch
// on flux spreads in that air which the layer does not let spread (at 2 um of d/eps on 24 um of
// patch the pull is 2 % off, at 10 um by half, at 100 um it is negative).
bool knows_skin_layer(const Grid& grid, const FieldProblem& problem);

// The pull by the 3-D potential: p = eps0/2 E_n^2 on the skin's surface (Eq. electrostatics.14),
// water bridges as conductors behind the skin's layer, droplets that do not bridge as dielectric
// caps; options of the problem as in the local rule (water without screening: pull zero in bridges
// only). A lossy layer: the potential sees its real part, and the imaginary part lowers the pull as
// in Eq. electrostatics.1. surface as in solve_local_field. The peak field in the dielectric is
// that of the voltage over the whole of it, as in the other rules: at the contact line of water and
// at sharp edges the field itself has no largest value (Eq. electrostatics.9). Not ok: as the
// potential, a layer of the skin that is too thick (knows_skin_layer). The pull may lie below 0
// where water covers most of the patch: walls of water take more off on finer pixels, and no grid
// was found on which they have taken all (Eq. electrostatics.17).
FieldSolution solve_full_field(const Gap& gap, const CoveredSurface* surface,
                               const Wetting& wetting, const FieldProblem& problem,
                               const PotentialOptions& options = {});

}  // namespace papilla::electrostatics
