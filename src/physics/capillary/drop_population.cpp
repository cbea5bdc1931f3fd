#include "physics/capillary/drop_population.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace papilla::capillary {
namespace {

// Members at whose centres a merged drop is tried, the mover among them.
constexpr std::size_t kMembersTried = 5;

}  // namespace

void DropPopulation::take(std::vector<Drop> drops) {
  drops_ = std::move(drops);
  hash_.build(drops_);
  for (int i = 0; i < size(); ++i) {
    int from = i + 1;  // those before have looked, until this one grows
    while (drops_[i].alive && drops_[i].film < 1) {
      members_.assign(1, i);
      hash_.collect_overlaps(drops_[i], members_, from);
      if (members_.size() == 1) break;
      double before = 0;
      const Drop mover = drops_[i];
      adopt(i, merged(mover, before, false));
      from = 0;
    }
  }
}

double DropPopulation::energy() const {
  double sum = 0;
  for (const Drop& d : drops_) sum += d.alive ? d.energy : 0;
  return sum;
}

bool DropPopulation::move(int i, const Drop& trial) {
  members_.assign(1, i);
  hash_.collect_overlaps(trial, members_);
  if (members_.size() == 1) {
    hash_.unlink(i, drops_[i]);
    drops_[i] = trial;
    hash_.link(i, trial);
    return true;
  }
  double before = 0;
  const Drop one = merged(trial, before, true);
  if (one.energy >= before) return false;
  adopt(i, one);
  return true;
}

void DropPopulation::drain(int i, double volume) {
  const Drop d = drops_[i];
  hash_.unlink(i, d);
  if (volume < d.volume) {
    drops_[i] = energy_.placed(d.x, d.y, d.volume - volume, 0, false);
    hash_.link(i, drops_[i]);
  } else {
    drops_[i].alive = false;
  }
}

// members_ (closed under overlap) as one drop: at the centroid, or, when it must pay, at the best
// of that, where the mover is, and the others' centres. before: what they had [J].
Drop DropPopulation::merged(const Drop& mover, double& before, bool best_place) {
  std::size_t known = 0;
  Drop best;
  while (known != members_.size()) {
    known = members_.size();
    before = 0;
    double volume = 0, cx = 0, cy = 0, largest = 0;
    BridgeGuess guess;
    for (std::size_t m = 0; m < members_.size(); ++m) {
      const Drop& d = drops_[members_[m]];
      before += d.energy;
      volume += d.volume;
      if (d.bridge && d.volume > largest) {
        largest = d.volume;
        guess = {d.radius, d.edge_gap};
      }
      if (m == 0) continue;  // the mover itself is the origin
      cx += d.volume * nearest_image(d.x - mover.x, lx_);
      cy += d.volume * nearest_image(d.y - mover.y, ly_);
    }
    const bool bridged = largest > 0;
    if (bridged) guess.radius *= std::sqrt(volume / largest);
    best = energy_.placed(mover.x + cx / volume, mover.y + cy / volume, volume, guess, bridged);
    if (best_place) best = best_of_places(mover, best, guess, bridged);
    hash_.collect_overlaps(best, members_);
  }
  return best;
}

Drop DropPopulation::best_of_places(const Drop& mover, Drop best, const BridgeGuess& guess,
                                    bool bridged) {
  const double volume = best.volume;
  const Drop there = energy_.placed(mover.x, mover.y, volume, guess, bridged);
  if (there.energy < best.energy) best = there;
  for (std::size_t m = 1; m < std::min(members_.size(), kMembersTried); ++m) {
    const Drop& d = drops_[members_[m]];
    const Drop at = energy_.placed(d.x, d.y, volume, guess, bridged);
    if (at.energy < best.energy) best = at;
  }
  return best;
}

void DropPopulation::adopt(int i, const Drop& merged) {
  for (int m : members_) {
    hash_.unlink(m, drops_[m]);
    drops_[m].alive = false;
  }
  merges_ += static_cast<int>(members_.size()) - 1;
  drops_[i] = merged;
  hash_.link(i, merged);
}

}  // namespace papilla::capillary
