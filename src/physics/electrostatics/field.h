// Electrostatic pull of a driven surface on the skin.
#pragma once

#include <complex>
#include <string>

#include "fields/gap.h"
#include "fields/wetting.h"
#include "geometry/heightmap.h"

namespace papilla {

struct FieldProblem {
  double v_rms = 0, v_peak = 0;         // [V] across electrode and body
  double dielectric = 0;                // sum of d/eps on the electrode [m]
  double dielectric_thickness = 0;      // sum of d [m]
  double oxide_strength = 1e9;          // breakdown field of the weakest layer [V/m]
  std::complex<double> skin_layer = 0;  // h_SC = d2/eps2(omega) [m]
  bool breakdown_cap = false;           // gap pressure at most eps0/2 (350 V/um)^2
  bool screening = true;                // the field fades towards a bridge
  bool droplet_enhancement = true;      // droplets that do not bridge raise the pull
  bool zero_under_droplets = false;     // preset m3: no pull under any droplet
};

struct FieldSolution {
  Traction traction;            // [Pa] on the skin, attractive
  double mean_pressure = 0;     // [Pa] over the patch
  double over_limit_area = 0;   // share of the patch where the air is beyond its breakdown field
  double over_limit_share = 0;  // share of the pull from there
  double peak_air_field = 0;    // [V/m] at peak voltage
  double peak_oxide_field = 0;  // [V/m] at peak voltage, flat electrode
  bool ok = true;
  std::string reason;  // when not ok
};

// p = eps0/2 (V_rms / |g + sum d/eps + h_SC|)^2 a pixel (Eq. electrostatics.1), with water by
// Eq. electrostatics.3-4 and textured walls by the mean of the two local rules (Eq.
// electrostatics.2). texture: the rigid surface below the gap, for the walls; may be null. Cost
// O(pixels).
FieldSolution solve_local_field(const Gap& gap, const Heightmap* texture, const Wetting& wetting,
                                const FieldProblem& problem);

// Largest gap voltage that air of a width g [m] withstands [V]: 350 V/um below 1 um, at least the
// Paschen minimum of 327 V above. Eq. electrostatics.7
double air_breakdown_voltage(double gap);

// How much a convex rim of radius r raises the field in a dielectric of thickness d:
// (d/r)/ln(1 + d/r); 1 for a flat, infinite for a sharp rim. Eq. electrostatics.8
double corner_factor(double thickness, double rim_radius);

// Planar deficit length of the field beside a water wall [m]: lost pull = p_inf times this strip.
// gap g, dielectric thickness d, both [m]. Eq. electrostatics.3
double screening_length(double gap, double dielectric_thickness);
// Radius of the zero-pressure disc beyond a bridge of radius a [m]: a + L. Eq. electrostatics.3
double screening_reach(double gap, double dielectric_thickness, double bridge_radius);

}  // namespace papilla
