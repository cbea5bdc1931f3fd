// The ridges above the patch size: their roughness, pressures and gaps, common to the closures.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "base/rooms.h"
#include "physics/macro/fingertip.h"
#include "physics/persson/persson.h"
#include "scene/scene.h"

namespace papilla::forward {

// Ridges from their longest wave to the patch's, then the skin within patches; moduli of the
// humidity. One of them at least is rough. Cost 1 ms.
MeanField ridge_field(const Finger& finger, double q_patch, double relative_humidity,
                      const MeanFieldOptions& options = {});

// Gaps [m] on a common row, and the share of the area at each: a distribution for sums over many
// surfaces. What lies between two gaps is shared out between them.
struct GapShares {
  std::size_t first = 0;     // of the row that has a share; those before and behind have none
  std::vector<float> share;  // of the gaps from there on

  static const std::vector<double>& row();  // ascending from 0
  std::span<const double> gaps() const { return std::span(row()).subspan(first, share.size()); }
};
// Of patches that do not touch; of all that do not touch where q is beyond the spectrum.
GapShares gap_shares(const GapDistribution& gaps, double q);

// All gaps of the ridges at pressures [Pa] about a mean one, ascending in equal ratios.
struct RidgeGaps {
  MeanField field;
  double q_patch = 0;
  std::vector<double> pressure;
  std::vector<GapShares> open;  // of patches that do not touch, the skin's roughness included
  // Of the ridges above the patch size alone: how far patches hang over where they just touch.
  std::vector<GapShares> hangs;
};
// Kept, as many as the members of a belief, fingers and humidities of a study have: common to the
// designs of one patch size. Cost 15 ms.
std::shared_ptr<const RidgeGaps> ridge_gaps(const Finger& finger, double q_patch,
                                            double relative_humidity, double mean_pressure);

// The gap [m] that a capacitance measurement reports under a finger whose ridges press with
// ridge_pressure [Pa] on a dielectric of equivalent thickness d/eps [m]: open gaps and patches in
// contact side by side, by the ridges' roughness; over the rings of a fingertip the mean of their
// capacitances. 0 where no spectrum is rough: a smooth pin, and one by a map. Eq. coupling.4. Cost
// 3 ms a ring.
double capacitive_gap(const Finger& finger, double ridge_pressure, double dielectric,
                      double relative_humidity, const std::vector<PressureRing>& rings = {{}});

// The share that carries on a rigid surface, its pressure, and the share that there is.
struct CarryingShare {
  double share = 0, pressure = 0, most = 1;  // pressure [Pa]
};
// The share that carries a surface which gives by compliance [m/Pa]: patches within reach of its
// compression as well, never more than there are. Eq. coupling.6. Cost 3 ms.
double compressed_share(const Finger& finger, double compliance, const CarryingShare& rigid,
                        double relative_humidity);
// `wanted` >= share where there is room for it, and smoothly at most `most`. Eq. coupling.6
double below(double most, double share, double wanted);

// Of the closure: those of the balance have a pressure each, all others one.
std::vector<PressureRing> rings_of(const ModelOptions& model, const MacroContact& macro);

}  // namespace papilla::forward
