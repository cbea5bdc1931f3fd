// Shape, energy and force of one drop at one place of the gap.
#pragma once

#include <array>
#include <memory>

#include "base/rooms.h"
#include "fields/gap.h"
#include "fields/wetting.h"
#include "physics/capillary/bridge_table.h"
#include "physics/capillary/drop.h"
#include "physics/capillary/footprint.h"
#include "physics/capillary/gap_table.h"
#include "physics/capillary/water.h"

namespace papilla::capillary {

// Eqs. capillary.4-6. Counts how often it was asked for a bridge: one object a solve and thread.
class DropEnergy {
 public:
  // gap_floor [m]: smaller gaps count as this. largest_step [m]: of a drop's search around it.
  DropEnergy(const Gap& gap, const WaterProperties& water, double gap_floor,
             double largest_step = 0);

  // The state of lowest energy of `volume` [m^3] at a place [m], which may lie outside the period;
  // a cap taller than the gap must bridge (snap-in). guess: radius of a nearby bridge [m], or 0.
  // was_bridge: tried as a bridge at any gap. Cost: about 1 us.
  Drop placed(double x, double y, double volume, const BridgeGuess& guess, bool was_bridge);
  // A bridge that exists: it stays one until it ruptures, even where a cap has the lower energy.
  Drop kept(double x, double y, double volume, double radius);
  // Energy of the same bridge at another place [J], to first order in the change of its radius.
  double estimated(const Drop& bridge, double x, double y);

  // That a drop which does not bridge would do so nowhere within the largest step.
  bool floats_around(const Drop& drop) const;

  // Eq. capillary.6: dE/dh [N] of a bridge when the whole gap opens, at fixed volume and place.
  double force(const Drop& bridge) const;
  double retention(const Drop& bridge) const;  // lateral [N], Eq. capillary.14

  double gap_at(double x, double y) const { return table_.at(x, y); }  // [m]
  // Whether a drop whose centre sees this gap [m] is tried as a bridge there.
  bool reaches(double volume, double gap) const { return cube(gap) < cube(reach_) * volume; }
  std::array<double, 8> gaps_around(const Drop& drop, double step) const {  // [m], kDirections
    return table_.around(drop.x, drop.y, step);
  }
  DropletState cap_state() const { return cap_state_; }  // on which side caps sit
  long evaluations() const { return evaluations_; }      // of a bridge's energy

 private:
  void fit_meniscus();
  Drop placed(double x, double y, double volume, const BridgeGuess& guess, bool was_bridge,
              bool stays);
  void bridge_over(Drop& d, const BridgeGuess& guess);
  double meniscus_at(double angle) const;  // factor, by the angle of the rim's slope [rad]
  double slab_energy(double radius, const GapTable::Rim& rim, double angle) const;
  BridgeTable::Value beyond_slab(double volume, double radius) const;
  GapTable::Rule rule(double radius) const;
  double bridge_energy(double volume, double radius, const GapTable::Rim& rim) const;
  double cap_energy(double volume) const;
  double size_of(double volume) const;  // cube root [m]

  Grid grid_;
  GapTable table_;
  WaterProperties water_;
  double gain_, cos_skin_;
  std::shared_ptr<const BridgeTable> exact_;
  CapShape cap_;  // of volume 1
  DropletState cap_state_;
  double meniscus_ = 0;                 // factor of a level gap
  std::array<double, 4> tilt_terms_{};  // its powers of the slope angle over kLargestTilt
  double rupture_ = 0;  // gap per volume^(1/3) beyond which no flat bridge is stable; 0: none is
  double reach_ = 0;    // and beyond which none is worth trying
  long evaluations_ = 0;
  // Of the last volume, bridge and radius: the same drop is asked for at many places.
  mutable struct { double volume = 0, size = 0; } sized_;
  mutable struct {
    double volume = 0, radius = 0;
    BridgeTable::Value beyond{};
  } bridge_;
  mutable struct {
    double radius = 0;
    GapTable::Rule rule{};
  } sampled_;
};

}  // namespace papilla::capillary
