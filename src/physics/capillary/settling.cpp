#include "physics/capillary/settling.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/watch.h"

namespace papilla::capillary {
namespace {

// A move must gain this share of the drop's energy: beyond the rounding of a footprint.
constexpr double kLeastGain = 1e-9;

class Walker {
 public:
  Walker(const Gap& gap, const WaterProperties& water, const DropletOptions& options,
         DropEnergy& energy, DropPopulation& drops, SettleReport& report)
      : gap_(gap),
        water_(water),
        options_(options),
        energy_(energy),
        drops_(drops),
        report_(report) {}

  // Drop i, with steps of first_step / 2^level, until nothing around it is lower.
  void walk(int i, int level, double step) {
    int moves = 0;
    Known known;
    for (;;) {
      if (moves >= options_.max_moves) {
        report_.converged = false;
        return;
      }
      const Downhill ways = downhill(i, step, known);
      Onward onward = Onward::Stuck;
      for (int c = 0; c < ways.count && onward == Onward::Stuck; ++c) {
        onward = go(i, ways.direction[c], step, moves, known);
      }
      if (onward == Onward::Merged &&
          level > 0) {  // a larger drop starts from the first step again
        double s = options_.first_step;
        for (int l = 0; l < level; ++l, s *= 0.5) walk(i, 0, s);
      }
      if (onward == Onward::Stuck) return;
    }
  }

 private:
  struct Downhill {  // directions of lower energy, lowest first
    std::array<int, 8> direction;
    std::array<double, 8> energy;
    int count = 0;
  };
  enum class Onward { Stuck, Moved, Merged };
  struct Known {  // directions that lead nowhere, as the last moves have shown; -1: none
    int ahead = -1, back = -1;
  };
  static int opposite(int direction) { return (direction + 4) % 8; }

  Downhill downhill(int i, double step, const Known& known) {
    Watch::look();
    Downhill out;
    const Drop& d = drops_[i];
    if (!d.bridge && energy_.floats_around(d)) return out;
    const double margin = kLeastGain * std::abs(d.energy);
    std::array<double, 8> gaps{};
    if (!d.bridge) gaps = energy_.gaps_around(d, step);
    for (int k = 0; k < 8; ++k) {
      if (k == known.ahead || k == known.back) continue;
      if (!d.bridge && !energy_.reaches(d.volume, gaps[k])) continue;
      const double x = into_period(d.x + step * kDirections.x[k], gap_.grid.lx);
      const double y = into_period(d.y + step * kDirections.y[k], gap_.grid.ly);
      double e;
      if (d.bridge) {
        e = energy_.estimated(d, x, y);
      } else {
        const Drop trial = energy_.placed(x, y, d.volume, 0, false);
        if (!trial.bridge) continue;
        e = trial.energy;
      }
      if (e >= d.energy - margin) continue;
      int at = out.count++;
      for (; at > 0 && out.energy[at - 1] > e; --at) {
        out.energy[at] = out.energy[at - 1];
        out.direction[at] = out.direction[at - 1];
      }
      out.energy[at] = e;
      out.direction[at] = k;
    }
    return out;
  }

  // Onward the same way while it helps, until the drop merges with another.
  Onward go(int i, int direction, double step, int& moves, Known& known) {
    const double way_x = kDirections.x[direction], way_y = kDirections.y[direction];
    Onward out = Onward::Stuck;
    while (moves < options_.max_moves) {
      const Drop& d = drops_[i];
      const BridgeGuess guess = d.bridge ? BridgeGuess(d.radius, d.edge_gap) : BridgeGuess();
      const Drop trial =
          energy_.placed(d.x + step * way_x, d.y + step * way_y, d.volume, guess, d.bridge);
      if (trial.energy >= d.energy - kLeastGain * std::abs(d.energy)) break;
      const bool was_bridge = d.bridge;
      const int merges = drops_.merges();
      if (held(d, trial) || !drops_.move(i, trial)) break;
      ++moves;
      ++report_.moves;
      if (drops_.merges() != merges) {
        known = {};
        return Onward::Merged;
      }
      out = Onward::Moved;
      // A bridge came from a place of higher energy.
      known = {direction, was_bridge && trial.bridge ? opposite(direction) : -1};
    }
    return out;
  }

  // Eq. capillary.16: whether an edge of the texture that `from` has not reached keeps it from
  // moving to `to`. A drop on the skin has no line on the texture.
  bool held(const Drop& from, const Drop& to) const {
    if (!options_.rims || !options_.rim_pinning) return false;
    const RimMap& rims = *options_.rims;
    if (!rims.valid() || (!from.bridge && energy_.cap_state() == DropletState::OnSkin)) {
      return false;
    }
    const Grid& g = gap_.grid;
    bool found = false;
    for_pixels(g, disc_of(to), [&](std::size_t k) {
      if (found || !rims.edge(k)) return;
      if (square_distance(g, k, from.x, from.y) <= square(from.radius)) return;
      found = !passes_edge(water_.theta_skin, water_.theta_substrate, rims.turn(),
                           std::max(to.edge_gap, options_.gap_floor),
                           std::max(gap_.value[k], options_.gap_floor));
    });
    return found;
  }

  const Gap& gap_;
  const WaterProperties& water_;
  const DropletOptions& options_;
  DropEnergy& energy_;
  DropPopulation& drops_;
  SettleReport& report_;
};

}  // namespace

double wick_into_corners(const Grid& grid, const RimMap& rims, const WaterProperties& water,
                         DropletState cap_state, DropPopulation& drops) {
  if (!rims.valid() || cap_state == DropletState::OnSkin) return 0;
  std::vector<double> room;
  for (const RimMap::Hole& hole : rims.holes()) {
    room.push_back(rims.capacity(hole, water.theta_substrate));
  }
  double wicked = 0;
  for (int i = 0; i < drops.size(); ++i) {
    const Drop& d = drops[i];
    const int hole = rims.hole_of(pixel_of(grid, d.x, d.y));
    if (!d.alive || d.bridge || hole < 0 || room[hole] <= 0) continue;
    bool touches = false;
    for_pixels(grid, disc_of(d), [&](std::size_t k) { touches = touches || rims.edge(k); });
    if (!touches) continue;
    const double taken = std::min(d.volume, room[hole]);
    room[hole] -= taken;
    wicked += taken;
    drops.drain(i, taken);
  }
  return wicked;
}

void settle(const Gap& gap, const WaterProperties& water, const DropletOptions& options,
            DropEnergy& energy, DropPopulation& drops, SettleReport& report) {
  Walker walker(gap, water, options, energy, drops, report);
  double last = drops.energy();
  double step = options.first_step;
  for (int level = 0; level <= options.halvings; ++level, step *= 0.5) {
    for (int i = 0; i < drops.size(); ++i) {
      if (drops[i].alive) walker.walk(i, level, step);
    }
    const double now = drops.energy();
    if (now > last + 1e-12 * std::abs(last)) report.energy_rose = true;
    last = now;
  }
  report.final_energy = last;
}

}  // namespace papilla::capillary
