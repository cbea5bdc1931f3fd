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

// Errors of every quantity at each humidity by one origin, measured on the control skins.
struct MeasuredError {
  std::optional<double> ErrorParts::*origin = nullptr;
  std::vector<std::array<double, kPointQuantities.size()>> size;  // [humidity][quantity], relative
  PatchCosts costs{};
  double seconds = 0;                  // wall time
  std::vector<ModelStatus> pull_in{};  // [humidity] of solved areas, where the load law sees none
};

// More skins can be added later.
struct PatchSet {
  Plan plan;
  std::vector<ScaleBridge> bridges;               // one per humidity
  FieldRatios field;                              // one per humidity
  std::vector<LoadLaws> laws;                     // one per humidity; empty: of no load law
  std::vector<std::vector<PatchResult>> results;  // [humidity][skin]
  // [humidity][skin] The results of the other skins by the load law of their own samples, so that
  // its scatter is in the jackknife. Empty: no law, or what it lacks is measured on control skins.
  std::vector<std::vector<std::vector<PatchResult>>> others;
  std::vector<MeasuredError> errors;  // of measure_errors, like the next
  ControlRuns controls;
  double area_factor = 1;  // on contact areas: `resolved_areas`
  double seconds = 0;      // wall time

  int skins() const { return results.empty() ? 0 : static_cast<int>(results.front().size()); }
  // What the skins from `first` on have cost.
  PatchCosts costs(int first = 0) const;
  void add(const PatchSet& other);  // the same scene, other skins
};

// Skins first_skin ... first_skin + skins - 1 of the fidelity, at each humidity. Parallel over
// skins; the same bytes for any number of threads. field, laws: of other patches of the same scene;
// empty: measured. Cost: skins x humidities x (1 or 3) contact solves, and `field_ratios`.
PatchSet solve_patches(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                       const FieldRatios& field = {}, const std::vector<LoadLaws>& laws = {});

// Friction, modulation and their causes at each humidity, of all skins and without each.
Response respond(const Scene& scene, const Fidelity& fidelity, const PatchSet& patches);

// One patch with all its fields, for pictures: skin `index` of the fidelity at one humidity, with a
// placement of its droplets.
struct PatchPicture {
  Heightmap texture, skin;
  PatchFields fields;
};
PatchPicture picture_patch(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                           double relative_humidity, int index = 0, int placement = 0);

}  // namespace papilla::forward
