// One balance over all gaps of the ridges: load, open gaps, patches in contact. Closure "balance".
#pragma once

#include <vector>

#include "base/constants.h"
#include "base/rooms.h"
#include "forward/open_gaps.h"
#include "forward/patch_result.h"
#include "forward/ridges.h"
#include "scene/scene.h"

namespace papilla::forward {

// Mean over the ridges of one humidity. Eq. coupling.10: each ring of the fingertip is at rest at
// the least pressure p = p_ring + attraction of its open gaps at p.
struct Balance {
  double nominal = 0;                        // load over the ridges' area [Pa]
  double pressed_off = 0, pressed_on = 0;    // with the open gaps' attraction [Pa]
  OpenGapForces far;                         // what the open gaps add
  double touching_off = 0, touching_on = 0;  // shares of the ridges in patches in contact
  // 1 - d(attraction)/d(pressure), the least of the rings under the drive: 0 at a fold.
  double stability = 1;
  // Of the voltage, by the least of the rings: that at which the equilibrium ends at a fold, over
  // the one applied; infinite where gaps close without one.
  double to_fold = kInfinity;
  // The gaps close: beyond a fold, with nearly all that the load leaves open pulled into contact
  // (is_pulled_shut), or without any equilibrium; the open gaps are left out then.
  bool pull_in = false;
  bool pull_in_undriven = false;  // without the drive already
  std::vector<double> pressures;  // of patches to solve [Pa]
  PressureShares shares;
};

// nodes: patch pressures. levels: of the surface, heights not yet resting; without shares: flat.
// Cost: 10 ms, once per finger and humidity 30 ms more.
Balance solve_balance(const Scene& scene, double q_patch, double relative_humidity, int nodes,
                      const SurfaceLevels& levels);

}  // namespace papilla::forward
