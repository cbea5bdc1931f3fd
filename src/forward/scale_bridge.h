// From the fingertip to its patches and back: which pressures patches are solved at, and how their
// results make up the load-carrying area. The one home of the closures.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/rooms.h"
#include "forward/balance.h"
#include "forward/coupling.h"
#include "forward/scene_terms.h"

namespace papilla::forward {

// One humidity of one scene; patches of the grid's size.
//   uniform: every load-carrying patch has the pressure F_N / (phi A_gross); soft features bring
//   more patches to the surface than a rigid one does. Eq. coupling.6
//   balance: the ridges press with a distribution of pressures over the fingertip; all gaps between
//   patches in contact pull and hold water, over this texture and film, and add to the load. Eq.
//   coupling.7 to coupling.10
//   persson: the ridges press with F_N / (phi_ridge A_gross) on a surface whose roughness above the
//   patch size lets only some patches touch, at distributed pressures; the open gaps between them
//   pull as well and add to the load. Eq. coupling.3
class ScaleBridge {
 public:
  ScaleBridge(const Scene& scene, const Fidelity& fidelity, const Grid& grid,
              double relative_humidity, const CompliantBody& body = {},
              const SurfaceLevels& levels = {});

  const std::vector<double>& pressures() const { return pressures_; }  // to solve patches at [Pa]
  double mean_pressure() const { return mean_pressure_; }              // of patches in contact [Pa]
  double carrying_share() const { return carrying_share_; }            // of the gross area
  // By how much the attraction of the open gaps brings more of the ridges into contact, before and
  // under the drive: a share that goes with the load. 1 but for the closure balance.
  double growth_off() const { return balance_.nominal > 0 ? grown(balance_.pressed_off) : 1; }
  double growth_on() const { return balance_.nominal > 0 ? grown(balance_.pressed_on) : 1; }
  // Of the closure balance; empty for others.
  const Balance& balance() const { return balance_; }

  // Results at pressures() to one result for a mean patch of the carrying area: forces and contact
  // areas are means over it, other members over its patches in contact (kPatchMembers).
  PatchResult combine(std::span<const PatchResult> patches) const;

 private:
  void note_limit(double share_of_ridges);
  double grown(double pressed) const { return pressed / balance_.nominal; }

  Closure closure_;
  double patch_area_, carrying_share_, mean_pressure_ = 0, nominal_ = 0;
  double far_pull_ = 0;  // of the gaps of patches that do not touch [Pa]
  std::vector<double> pressures_;
  PressureShares shares_;
  Balance balance_;
  ModelStatus status_;
};

}  // namespace papilla::forward
