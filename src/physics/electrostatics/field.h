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
  // The film as it is on a flat surface: used for every pixel if no CoveredSurface is given, and
  // always for its permittivity, its peak field and the range of screening.
  double dielectric = 0;                // sum of d/eps on the electrode [m]
  double dielectric_thickness = 0;      // sum of d [m]
  double edge_radius = 0;               // of the electrode's edges below walls [m]; 0: none stated
  std::complex<double> skin_layer = 0;  // h_SC = d2/eps2(omega) [m]
  // The skin layer between a conducting bridge and the body, as a real d/eps: the voltage divider
  // that it forms with `dielectric` gives the bridge the magnitude of its potential (Eq. drive.21).
  // 0: the bridge is at the body's potential.
  double water_skin_layer = 0;  // [m]
  double film_phase = 1;        // |d/eps| over its real part, of a film that leaks
  // The discharge law that limits the field in the air. Eq. electrostatics.21
  AirLimit air_limit = AirLimit::None;
  // The largest field in the air that a film which saturates allows [V/m]. Eq. electrostatics.22
  double film_holds = kInfinity;
  bool steady = false;          // a voltage of one magnitude, direct or square; else a sine
  bool screening = true;        // the field fades towards a bridge
  bool even_screening = false;  // preset m3: one factor for the whole patch. Eq. electrostatics.18
  bool droplet_enhancement = true;   // droplets that do not bridge raise the pull
  bool zero_under_droplets = false;  // preset m3: no pull under any droplet
};

// Something holds the field in the air below what the voltage makes.
inline bool field_is_held(const FieldProblem& p) {
  return p.air_limit != AirLimit::None || p.film_holds < kInfinity;
}

// True if the film insulates over 100 times better than the gap (possible at direct voltage). The
// film then takes nearly all of the voltage and hardly any flux spreads in it, so
// solve_spread_field uses the local rule. Flux still spreads in the air, which the local rule
// leaves out.
bool holds_all_voltage(const FieldProblem& problem);

struct FieldSolution {
  Traction traction;            // [Pa] on the skin, attractive
  double mean_pressure = 0;     // [Pa] over the patch
  double over_limit_area = 0;   // share of the patch where the air is beyond its breakdown field
  double over_limit_share = 0;  // share of the pull from there
  double peak_air_field = 0;    // [V/m] at peak voltage
  // [V/m] The field averaged over the film's layers at peak voltage, the largest over the patch;
  // with the increase at the electrode's edges if their radius is stated (Eq. electrostatics.8).
  double peak_oxide_field = 0;
  double residual = 0;  // relative, energy norm; 0 for the local rule
  int iterations = 0;   // 0 for the local rule
  bool ok = true;
  std::string reason;  // when not ok
};

// The local rule: each pixel has the pull p = eps0/2 (V_rms / |g + D + h_SC|)^2 (Eq.
// electrostatics.1), D the d/eps of its column (Eq. electrostatics.2). The pull is zero in bridges
// and fades towards them as beside a wall of water at the bridge's potential (Eqs.
// electrostatics.3, 19); droplets that do not bridge raise it (Eq. electrostatics.4). surface: the
// rigid surface below the gap with its film; null: the flat film of the problem. Not ok: neither
// film nor skin layer, or a gap that is not finite. Cost: O(pixels), 0.3 ms at 128^2.
FieldSolution solve_local_field(const Gap& gap, const CoveredSurface* surface,
                                const Wetting& wetting, const FieldProblem& problem);

// The local rule, but flux may spread sideways in the dielectric. The potential phi on the surface
// of the dielectric solves K phi + (1/D - eps/d) phi + phi/(g + h_SC) = V/D, with
// K = eps q coth(q d) and d the mean thickness; each body of water has one phi, at which the charge
// that it takes from the film leaves through the skin layer (Eq. electrostatics.16). The pull is
// that of the local rule with the flux phi/(g + h_SC); beside water it is that next to a wall of
// water at its potential (Eq. electrostatics.20). Solved by conjugate gradients in the energy norm:
// two pairs of FFTs per iteration, about 6 iterations to 1e-4, in single precision for tolerances
// of 1e-3 and above. Without a dielectric, and where holds_all_voltage is true, the local rule is
// used. Not ok: as for the local rule, or the iteration limit was reached. Options, limits of the
// field and droplets are those of the local rule.
FieldSolution solve_spread_field(const Gap& gap, const CoveredSurface* surface,
                                 const Wetting& wetting, const FieldProblem& problem,
                                 double tolerance = 1e-4);

// Height of the water of droplets that do not bridge, per pixel [m]: spherical caps on either side.
std::vector<double> droplet_columns(const Grid& grid, const Wetting& wetting);

}  // namespace papilla::electrostatics
