// From the fingertip to its patches and back: the pressures at which patches are solved, and how
// their results combine to those of the load-carrying area. The assumption that links the two
// scales is the closure (`model.closure`); all three closures come together here.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/rooms.h"
#include "forward/balance.h"
#include "forward/coupling.h"
#include "forward/scene_terms.h"

namespace papilla::forward {

// The bridge for one humidity of one scene. Patches have the size of `grid`; body: the soft
// features of the surface, if any; levels: the heights of the texture, for `balance` alone.
//   uniform: every patch that carries load has the pressure F_N / (phi A_gross). On soft features
//   more patches carry load, each at less pressure, than on a rigid surface. Eq. coupling.6
//   balance: the ridges press with a distribution of pressures over the fingertip. The open gaps
//   between the patches in contact attract too, by the field over this texture and film and by the
//   water in them; their attraction adds to the load. Eq. coupling.7 to coupling.10
//   persson: the ridges press with F_N / (phi_ridge A_gross). Their roughness at wavelengths above
//   the patch size lets only some patches touch, at distributed pressures. The field attracts
//   across the open gaps between them too, as over a flat surface and without water, which adds to
//   the load. Eq. coupling.3
class ScaleBridge {
 public:
  ScaleBridge(const Scene& scene, const Fidelity& fidelity, const Grid& grid,
              double relative_humidity, const CompliantBody& body = {},
              const SurfaceLevels& levels = {});

  const std::vector<double>& pressures() const { return pressures_; }  // to solve patches at [Pa]
  double mean_pressure() const { return mean_pressure_; }              // of patches in contact [Pa]
  // The share of the gross area that combine() averages over: uniform: the patches in contact
  // (phi); balance, persson: all ridges, of which only some patches are in contact.
  double carrying_share() const { return carrying_share_; }
  // Factor by which the attraction of the open gaps increases the number of patches in contact,
  // with the drive off and on. That number is proportional to the load, so the factor is (load +
  // attraction)/load. 1 for the other closures.
  double growth_off() const { return balance_.nominal > 0 ? grown(balance_.pressed_off) : 1; }
  double growth_on() const { return balance_.nominal > 0 ? grown(balance_.pressed_on) : 1; }
  // Of the closure balance; empty for others.
  const Balance& balance() const { return balance_; }

  // Combines one result per pressure, in the order of pressures(), to that of a mean patch of the
  // carrying area, and adds the forces of the open gaps. Forces and contact areas are averaged over
  // the whole carrying area, most other members over its patches in contact; of peaks the largest
  // counts (kPatchMembers).
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
