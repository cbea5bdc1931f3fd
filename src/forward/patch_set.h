// The solved patches of a scene: what a Response is made of.
#pragma once

#include <optional>
#include <vector>

#include "base/rooms.h"
#include "forward/coupling.h"
#include "forward/field_ratio.h"
#include "forward/load_law.h"
#include "forward/response.h"
#include "forward/scale_bridge.h"

namespace papilla::forward {

// The relative error of every quantity at each humidity from one origin (grid or method), measured
// on the control skins.
struct MeasuredError {
  std::optional<double> ErrorParts::*origin = nullptr;
  std::vector<std::array<double, kPointQuantities.size()>> size;  // [humidity][quantity], relative
  PatchCosts costs{};
  double seconds = 0;  // wall time
  // [humidity] The pull-in that the control run with solved areas found, if any: the load law can
  // miss it. Empty for other origins.
  std::vector<ModelStatus> pull_in{};
};

// The solved patches of one scene at all its humidities; add() appends skins that were solved
// later.
struct PatchSet {
  Plan plan;
  std::vector<ScaleBridge> bridges;               // one per humidity
  FieldRatios field;                              // one per humidity
  std::vector<LoadLaws> laws;                     // Eq. coupling.14, one per humidity; or empty
  std::vector<std::vector<PatchResult>> results;  // [humidity][skin]
  // [humidity][skin] What the results are of before the load law, and what the law was fitted to:
  // `respond` refits it without each skin, so that the jackknife contains the scatter of the law.
  // Empty: there is no law, or skins that it is of are not among these.
  std::vector<std::vector<std::vector<SolvedPatch>>> solved;
  std::vector<MeasuredError> errors;  // measure_errors fills this and `controls`
  ControlRuns controls;
  double area_factor = 1;  // on contact areas: `resolved_areas`
  double seconds = 0;      // wall time

  int skins() const { return results.empty() ? 0 : static_cast<int>(results.front().size()); }
  // What the skins from `first` on have cost.
  PatchCosts costs(int first = 0) const;
  void add(const PatchSet& other);  // the same scene, other skins
};

// Solves skins first_skin ... first_skin + skins - 1 of the fidelity at each humidity, in parallel
// over skins; the numbers are bit-identical for any number of threads. field, laws: taken from an
// earlier call for the same scene; empty: found here. Cost: `field_ratios`, and for each skin,
// humidity, patch pressure and water volume or placement 1 contact solve without tractions, up to
// 3 in one pass, up to 1 + 2 (coupling_passes + 1) in equilibrium, the default.
PatchSet solve_patches(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                       const FieldRatios& field = {}, const std::vector<LoadLaws>& laws = {});

// Combines the solved patches to friction, modulation and the areas, forces and gaps that they
// follow from, at each humidity: from all skins, and with each skin left out in turn.
Response respond(const Scene& scene, const Fidelity& fidelity, const PatchSet& patches);

// One patch with all its fields, for pictures: skin `index` of the fidelity at one humidity, with a
// placement of its droplets.
struct PatchPicture {
  Heightmap texture, skin;
  PatchFields fields;
  double pressure = 0;  // of the load alone, mean of the patches in contact [Pa]
};
// pressed: that pressure over the one of the scene's closure.
PatchPicture picture_patch(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                           double relative_humidity, int index = 0, int placement = 0,
                           double pressed = 1);

}  // namespace papilla::forward
