// Electrostatic pull of a driven surface on the skin, by the local rule.
#pragma once

#include <complex>
#include <string>

#include "base/constants.h"
#include "base/rooms.h"
#include "fields/gap.h"
#include "fields/wetting.h"
#include "physics/electrostatics/electrode.h"
#include "scene/finger.h"

namespace papilla::electrostatics {

struct FieldProblem {
  double v_rms = 0, v_peak = 0;  // [V] across electrode and body
  // Of the film on a flat surface, and of one whose columns `CoveredSurface` does not tell:
  double dielectric = 0;                // sum of d/eps on the electrode [m]
  double dielectric_thickness = 0;      // sum of d [m]
  double edge_radius = 0;               // of the electrode's edges below walls [m]; 0: none stated
  std::complex<double> skin_layer = 0;  // h_SC = d2/eps2(omega) [m]
  // The same layer between water that leads and the body, beside a film that counts as above: the
  // divider of both has the magnitude of the water's potential. 0: water at the body's potential.
  double water_skin_layer = 0;          // [m]
  double film_phase = 1;                // |d/eps| over its real part, of a film that leaks
  AirLimit air_limit = AirLimit::None;  // what holds the field in the air. Eq. electrostatics.21
  double film_holds = kInfinity;        // field in the air that a film's charge makes at most [V/m]
  bool steady = false;                  // a voltage of one magnitude, direct or square; else a sine
  bool screening = true;                // the field fades towards a bridge
  bool even_screening = false;          // preset m3: that as one factor. Eq. electrostatics.18
  bool droplet_enhancement = true;      // droplets that do not bridge raise the pull
  bool zero_under_droplets = false;     // preset m3: no pull under any droplet
};

// Something holds the field in the air below what the voltage makes.
inline bool field_is_held(const FieldProblem& p) {
  return p.air_limit != AirLimit::None || p.film_holds < kInfinity;
}

// Whether the film insulates so much better than the gap that next to nothing of the voltage is
// left to the gap, and hardly any flux spreads in the film: columns are the rule with spreading
// flux then. In the air flux spreads all the same.
bool holds_all_voltage(const FieldProblem& problem);

struct FieldSolution {
  Traction traction;            // [Pa] on the skin, attractive
  double mean_pressure = 0;     // [Pa] over the patch
  double over_limit_area = 0;   // share of the patch where the air is beyond its breakdown field
  double over_limit_share = 0;  // share of the pull from there
  double peak_air_field = 0;    // [V/m] at peak voltage
  double peak_oxide_field = 0;  // [V/m] at peak voltage, mean over the layers, edges of the radius
                                // stated included (Eq. electrostatics.8)
  double residual = 0;          // relative, energy norm; 0 for the local rule
  int iterations = 0;           // 0 for the local rule
  bool ok = true;
  std::string reason;  // when not ok
};

// p = eps0/2 (V_rms / |g + D + h_SC|)^2 per pixel (Eq. electrostatics.1), D the d/eps of the column
// (Eq. electrostatics.2), zero in bridges, faded around them to what a wall of water at its own
// potential leaves (Eqs. electrostatics.3, 19), raised over droplets that do not bridge (Eq.
// electrostatics.4). surface: the rigid one below the gap, for its
// film; null: the flat film of the problem. Not ok: a bare electrode, or a gap that is not finite.
// Cost: O(pixels), 0.3 ms at 128^2.
FieldSolution solve_local_field(const Gap& gap, const CoveredSurface* surface,
                                const Wetting& wetting, const FieldProblem& problem);

// The local rule with the flux free to spread sideways in the dielectric: the potential phi on its
// surface solves K phi + (1/D - eps/d) phi + phi/(g + h_SC) = V/D, K = eps q coth(q d), d the mean
// thickness, under each body of water one phi that charges it through the skin's layer (Eq.
// electrostatics.16); the pull is the local one with the flux phi/(g + h_SC), beside water that of
// the air at its wall. Conjugate gradients in the
// energy norm, two FFT pairs an iteration, about 6 iterations to 1e-4; in single precision from a
// tolerance of 1e-3 on. Without a dielectric: the
// local rule. Not ok: as the local rule, or the iteration limit. Options, caps and droplets as
// there.
FieldSolution solve_spread_field(const Gap& gap, const CoveredSurface* surface,
                                 const Wetting& wetting, const FieldProblem& problem,
                                 double tolerance = 1e-4);

// Height of the water of droplets that do not bridge, per pixel [m]: spherical caps on either side.
std::vector<double> droplet_columns(const Grid& grid, const Wetting& wetting);

}  // namespace papilla::electrostatics
