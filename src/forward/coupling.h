// Contact, water and field of one patch at one humidity: the only place that knows two pieces.
#pragma once

#include <span>
#include <string>

#include "base/constants.h"
#include "fields/gap.h"
#include "fields/wetting.h"
#include "forward/fidelity.h"
#include "forward/plan.h"
#include "forward/response.h"
#include "physics/contact/contact.h"
#include "physics/electrostatics/electrode.h"
#include "physics/electrostatics/field.h"
#include "scene/scene.h"

namespace papilla {

struct PatchProblem {
  const Scene* scene = nullptr;
  const CoveredSurface* surface = nullptr;
  std::span<const double> height;  // texture + skin [m], high touches first
  const ContactKernel* kernel =
      nullptr;  // moduli at 15 % RH; of this humidity if the surface yields
  double relative_humidity = 0;
  double pressure = 0;  // mean preload on the patch [Pa]
  std::uint64_t droplet_index = 0;
  double water_factor = 1;  // on the volume of water
};

// Forces are on the patch [N], areas are fractions of it.
struct PatchResult {
  double load = 0;  // preload
  double capillary_off = 0, capillary_on = 0, pull = 0, retention = 0;
  double area_dry = 0, area_off = 0, area_on = 0;
  double bridges = 0, wetted = 0, bridge_volume = 0, volume = 0;
  double on_its_way = 0;                 // water of bridges between disc and film [m^3]
  double mean_gap = 0, indentation = 0;  // [m]
  double over_limit_area = 0, over_limit_share = 0, peak_oxide_field = 0, peak_air_field = 0;
  double oxide_margin = kInfinity;  // strength of the dielectric over its peak field
  int contact_solves = 0;
  double fft_pairs = 0;
  double certificate = 0;  // the worst of the contact solves
  PieceSeconds seconds;
  ModelStatus status;
};

// The states behind the numbers.
struct PatchFields {
  ContactSolution off, on;  // at the moduli of that humidity; dry when no tractions are solved
  Wetting wetting_off, wetting_on;
  Traction pull;
};

// A patch before the drive: what every voltage starts from.
struct RestPatch {
  PatchResult result;  // undriven
  ContactSolution dry;
  ContactSolution off;  // with capillary tractions; empty when no tractions are solved
  Wetting water;
};

// Contact at one humidity, from which the next one starts: dry, and under the tractions solved.
// Empty where there is none.
struct PatchStates {
  ContactSolution dry, off, on;
};

// start: of a nearby humidity. A dry solution without a gap has failed; the status says why.
RestPatch rest_patch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity,
                     const PatchStates& start);
// The patch under the drive of its scene. fields: filled when not null.
PatchResult drive_patch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity,
                        const RestPatch& rest, PatchFields* fields = nullptr);
// Both. states: in: of a nearby humidity; out: of this one.
PatchResult solve_patch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity,
                        PatchStates& states, PatchFields* fields = nullptr);

// The electrical problem of the scene at a humidity.
FieldProblem field_problem(const Scene& scene, double relative_humidity);

// The pull by the scene's field rule; tolerance: of the potential that spreads in the dielectric.
FieldSolution solve_field(const Scene& scene, const Gap& gap, const CoveredSurface* surface,
                          const Wetting& wetting, const FieldProblem& problem, double tolerance);

// Contact angle of the surface under the scene's drive (electrowetting) [rad].
double driven_contact_angle(const Scene& scene, double relative_humidity);

}  // namespace papilla
