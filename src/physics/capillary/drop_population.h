// All drops of a patch: where they are, and that no two of them overlap.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "fields/gap.h"
#include "physics/capillary/drop.h"
#include "physics/capillary/drop_energy.h"
#include "physics/capillary/drop_hash.h"

namespace papilla::capillary {

class DropPopulation {
 public:
  DropPopulation(const Grid& grid, DropEnergy& energy)
      : energy_(energy), lx_(grid.lx), ly_(grid.ly), hash_(grid) {}

  // Takes the drops; those that overlap become one, at any price.
  void take(std::vector<Drop> drops);

  int size() const { return static_cast<int>(drops_.size()); }  // the dead included
  const Drop& operator[](int i) const { return drops_[i]; }
  std::vector<Drop>& drops() { return drops_; }
  double energy() const;  // [J]
  int merges() const { return merges_; }

  // Puts drop i where `trial` is. If it overlaps others there they become one drop, provided that
  // the energy falls; else nothing happens and the answer is false.
  bool move(int i, const Drop& trial);
  // Takes volume [m^3] from drop i, which gets its state anew or, where none is left, is gone.
  void drain(int i, double volume);

 private:
  Drop merged(const Drop& mover, double& before, bool best_place);
  Drop best_of_places(const Drop& mover, Drop best, const BridgeGuess& guess, bool bridged);
  void adopt(int i, const Drop& merged);

  DropEnergy& energy_;
  double lx_, ly_;
  std::vector<Drop> drops_;
  DropHash hash_;
  std::vector<int> members_;  // drops that become one; the mover first
  int merges_ = 0;
};

}  // namespace papilla::capillary
