// Contact, water and field of one patch at one humidity: the only place that knows two pieces.
#pragma once

#include <span>

#include "base/rooms.h"
#include "fields/gap.h"
#include "fields/wetting.h"
#include "forward/fidelity.h"
#include "forward/patch_result.h"
#include "forward/plan.h"
#include "physics/contact/contact.h"
#include "physics/electrostatics/electrode.h"
#include "scene/scene.h"

namespace papilla::forward {

struct PatchProblem {
  const Scene* scene = nullptr;
  const CoveredSurface* surface = nullptr;
  std::span<const double> height;         // texture + skin [m], high touches first
  const ContactKernel* kernel = nullptr;  // `contact_kernel` of the humidity
  double relative_humidity = 0;
  double pressure = 0;  // mean preload on the patch [Pa]
  std::uint64_t droplet_index = 0;
  double water_factor = 1;      // on the volume of water
  double field_correction = 1;  // on the rule's pull
};

// The states behind the numbers, at the moduli of that humidity.
struct PatchFields {
  ContactSolution off, on;  // dry when no tractions are solved
  Wetting wetting_off, wetting_on;
  Traction pull;
};

// A patch before the drive: what every voltage starts from. The pressures of its states, like those
// of `PatchStates`, are at the moduli of the kernel: over `Skin::modulus_factor` where that is the
// one of 15 % RH.
struct UndrivenPatch {
  PatchResult result;   // undriven
  PatchResult dry_gap;  // the same with the attractions of the dry contact's gap
  ContactSolution dry;
  ContactSolution off;  // with capillary tractions; empty when no tractions are solved
  Wetting water;        // in the gap of the dry contact
  Wetting water_off;    // in that of `off`; empty without it
  double slope = 0;     // of its attraction over that applied (`EquilibriumSearch`)
};

// Contact at one humidity, from which the next one starts: dry, and under the tractions solved.
// Empty where there is none.
struct PatchStates {
  ContactSolution dry, off, on;
  double slope_off = 0, slope_on = 0;  // as `UndrivenPatch::slope`, before and under the drive
};

// start: of a nearby humidity. A dry solution without a gap has failed; the status says why.
UndrivenPatch undriven_patch(const PatchProblem& problem, const Plan& plan,
                             const Fidelity& fidelity, const PatchStates& start);
// The same on a dry contact that is solved already: another water on it.
UndrivenPatch wet_patch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity,
                        const ContactSolution& dry);
// The patch under the drive of its scene. fields: filled when not null.
PatchResult drive_patch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity,
                        const UndrivenPatch& undriven, PatchFields* fields = nullptr);
// Both. states: in: of a nearby humidity; out: of this one. before_drive: filled when not null.
PatchResult solve_patch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity,
                        PatchStates& states, PatchFields* fields = nullptr,
                        UndrivenPatch* before_drive = nullptr);
// A patch by its dry contact, solved under its tractions all the same: what the load law is
// measured on. states as above.
PatchResult settled_patch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity,
                          const UndrivenPatch& dry, PatchStates& states);

// A patch that any mean attraction has closed: what its gap attracts with at a voltage. The branch
// of its equilibria, whatever is stable (`forward/pull_in.h`).
class PatchBranch {
 public:
  // All must outlive it. The dry contact and its water are solved at once.
  PatchBranch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity);
  void close(double attraction);           // [Pa]; tractions of the shape last asked for
  double attraction(const Scene& driven);  // mean [Pa] of water and field of a scene

 private:
  PatchProblem problem_;
  Plan plan_;
  const Fidelity& fidelity_;
  UndrivenPatch dry_;
  ContactSolution state_;
  std::vector<double> traction_;  // [Pa], of the last gap
};

}  // namespace papilla::forward
