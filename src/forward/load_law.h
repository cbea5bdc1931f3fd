// The load law in equilibrium: where no contact is solved under tractions, how the attractions of a
// patch grow as they close its gap, measured on a few patches of the same scene.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "base/rooms.h"
#include "forward/patch_result.h"
#include "forward/patch_setup.h"
#include "forward/scale_bridge.h"

namespace papilla::forward {

// One patch by its attractions on the dry gap, and in equilibrium.
struct AttractionSample {
  PatchResult dry, settled;
};

// Attractions as powers of the total load over the nominal one, up to that of the samples: beyond
// it they stay what they are there. Eq. coupling.14
struct AttractionLaw {
  double capillary_off = 0, capillary_on = 0, pull = 0;  // exponents
  double sampled_off = 1, sampled_on = 1;                // total loads over nominal ones
  double retention_off = 1, retention_on = 1;            // factors
  ModelStatus status;  // of the first sample that has no equilibrium

  // Total load over the nominal one, by the attractions on the dry gap over the nominal load:
  // before the drive, and under it.
  double load_off(double capillary) const;
  double load_on(double capillary, double pull) const;

  // A share of the way to another law.
  AttractionLaw toward(const AttractionLaw& other, double share) const;

  // The patch by its attractions on the dry gap becomes that in equilibrium.
  void apply(PatchResult& patch) const;
};

// How many skins from the first on are solved in equilibrium for it, whether or not a set of
// patches has so many: the law of a scene is that of its first skins. None where every patch is in
// equilibrium by itself, or no patch is.
int sampled_skins(const PatchSetup& setup, const Plan& plan);

// Ratios of sums over the samples; without any the law changes nothing.
AttractionLaw attraction_law(std::span<const AttractionSample> samples);
using LoadLaws = std::vector<AttractionLaw>;  // one per patch pressure

// A skin under one patch pressure at one humidity.
struct SolvedPatch {
  PatchResult result;
  std::optional<AttractionSample> sample;
};
// A patch under its drive, and what it was before; null: nothing to settle.
struct DrivenPatch {
  PatchResult result;
  const UndrivenPatch* before = nullptr;
};
// Over the water of the skin. start: given where the first water is to be a sample: states of a
// nearby humidity, as of `settled_patch`.
SolvedPatch over_members(std::span<const WaterMember> members, const Plan& plan,
                         const Fidelity& fidelity, PatchStates* start,
                         const std::function<PatchProblem(const WaterMember&)>& problem,
                         const std::function<DrivenPatch(const PatchProblem&)>& drive);
// How many of the skins are samples of the law.
std::size_t samples_among(std::span<const std::vector<SolvedPatch>> skins);
// By the samples among the skins, at each patch pressure of the bridge.
LoadLaws load_laws(const ScaleBridge& bridge, std::span<const std::vector<SolvedPatch>> skins);
// The results without each skin; without a sample of the load law by the law that the jackknife of
// all skins takes for the law's own scatter. Empty where the law is not of two samples among the
// skins, at least.
std::vector<std::vector<PatchResult>> without_each(const ScaleBridge& bridge,
                                                   std::span<const std::vector<SolvedPatch>> skins);
// Of each skin one result over the patch pressures; laws: of them, or none.
std::vector<PatchResult> combined(const ScaleBridge& bridge, const LoadLaws& laws,
                                  std::span<const std::vector<SolvedPatch>> skins);

}  // namespace papilla::forward
