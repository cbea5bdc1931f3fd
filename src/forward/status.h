// What can go wrong with the answer of a patch or of a humidity, and in which words people read it.
// Code asks for the state; nobody reads the words.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::forward {

enum class Trouble {
  None,
  WaterMoves,        // droplets not at rest; number: moves allowed to one of them
  ContactUnsolved,   // reason: of the contact solver
  FieldUnsolved,     // reason: of the field rule
  Flooded,           // more water than gap
  SecondPassPullIn,  // the gap closes under one pass; number: rise of the pull by a second,
                     // relative
  ClosedPullIn,      // no equilibrium short of a closed gap
  GrowingPullIn,     // the pull grows from pass to pass
  FarGapPullIn,      // the gaps between patches in contact close
  UndrivenPullIn,    // the gap closes before the drive, by load and water alone
  PassesUsedUp,      // coupling not settled; number: passes
  FullContact,       // number: area estimate over the patch
  NearlyFlooded,     // number: share of the patch that neither water nor contact covers
  WaterBeyondFit,    // number: the nearest humidity that the water volumes were fitted at
  Breakdown,         // of the dielectric; number: its field over its strength
  RidgesCarry,       // nearly all of the ridges carry; number: their share
};

struct ModelStatus {
  Trouble trouble = Trouble::None;
  double number = 0;   // what it is, the trouble says
  std::string reason;  // of a solver, where the trouble has one

  bool sound() const { return trouble == Trouble::None; }
  // No equilibrium under this voltage.
  bool pull_in() const;
  // Nor without one.
  bool pull_in_undriven() const { return trouble == Trouble::UndrivenPullIn; }
  // Keeps the first trouble, as what follows from it is no news; but for a pull-in, which no other
  // trouble hides, and of these one that needs no drive.
  void note(const ModelStatus& next) {
    if (sound() || (next.pull_in() && !pull_in()) ||
        (next.pull_in_undriven() && !pull_in_undriven()))
      *this = next;
  }
  bool operator==(const ModelStatus&) const = default;
};
// "ok", "flooded: more water than gap, ...", "pull-in: ..."
std::string text(const ModelStatus& status);

// The trouble of one humidity.
struct PointTrouble {
  double relative_humidity = 0;
  ModelStatus status;

  bool operator==(const PointTrouble&) const = default;
};
// "15, 35 % RH: flooded: ...; 75 % RH: pull-in: ...": each trouble once, with its humidities; empty
// for none.
std::string text(const std::vector<PointTrouble>& troubles);
// Decimals of humidities as per cent: none, or as few as unlike ones read unlike with.
int humidity_decimals(std::vector<double> humidities);

// How a search for the voltage of a modulation ended: `voltage_for`.
enum class VoltageEnd {
  Reached,
  NoField,       // what touches does not conduct
  NoDielectric,  // the electrode is bare, be it on its steepest walls alone
  Breakdown,     // of the dielectric, below the voltage
  SourceEnds,    // its compliance is below the voltage
  ModelEnds,     // no friction is known above the limit: pull-in, full contact
  Unsound,       // the model has a trouble that no voltage cures
  NotConverged,  // the search itself
};

// How [accuracy] target ended.
enum class TargetEnd {
  Reached,
  NoRelativeError,  // the quantity is zero
  PlanUnsettled,    // each plan, once measured, asks for another
  LimitsReached,    // of pixels and skins
  TimeSpent,        // what the run could afford
};

}  // namespace papilla::forward
