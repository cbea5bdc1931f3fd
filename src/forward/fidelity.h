// The one home of accuracy choices: grid, samples, tolerances, method per piece.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "base/rooms.h"
#include "scene/finger.h"

namespace papilla::forward {

// How the modulation is measured.
enum class Estimator {
  Load,  // from the loads on the dry contact: no solve with tractions; ranks designs (Eq.
         // friction.3)
  Area,  // from contact areas solved with the capillary and electrostatic tractions (Eq.
         // friction.1)
};

struct Fidelity {
  std::string level = "design";
  int grid = 256;       // pixels along the window of 12 um: what sets the pixel of any patch
  int most_pixels = 0;  // a side of a patch far beyond the window; 0: 1024, or `grid` if larger
  int skins = 40;       // independent skin patches
  int first_skin = 0;   // fresh skins start beyond those of a search
  Estimator estimator = Estimator::Area;
  double contact_tolerance = 1e-4;  // Frank-Wolfe certificate (docs/theory/contact.md: its worth)
  // Residual of the potential that spreads in the dielectric, energy norm: the pull is then high by
  // at most a quarter of it, within what the error part of the solver states (Eq. accuracy.1).
  double field_tolerance = 1e-3;
  int coupling_passes = 16;          // to an equilibrium, at most
  double coupling_tolerance = 2e-3;  // distance to it, in units of the total load
  int equilibrium_skins = 3;  // by the load law: skins whose equilibrium is solved, for the others
  int bridge_nodes = 3;       // patch-pressure nodes of the Persson closure
  int balance_nodes = 2;      // of the closure balance
  int control_skins = 4;  // run again on a coarser grid and with better methods, for the errors; 0:
                          // those parts stay unknown
  int field_skins = 2;    // solved in 3-D, for what the field rule lacks; 0: not corrected
  int droplet_seeds = 1;  // placements of the droplets on each skin, averaged
  double load_exponent = 0.84;  // beta of the load-based estimator (Eq. friction.3)
  std::uint64_t seed = 1;       // of skins, offsets and droplets: common to all designs
  int threads = 0;              // 0: all

  int pixels_per_side() const { return most_pixels > 0 ? most_pixels : std::max(1024, grid); }
  int pressure_nodes(Closure closure) const {
    return closure == Closure::Uniform   ? 1
           : closure == Closure::Persson ? bridge_nodes
                                         : balance_nodes;
  }
  // Contact area under a load over that under the preload, by their ratio. Eq. friction.3
  double area_by_load(double load_ratio) const {
    return std::pow(std::max(load_ratio, 0.0), load_exponent);
  }
  bool operator==(const Fidelity&) const = default;
};

// "search", "draft", "design" or "reference"; throws InputError for another name.
Fidelity fidelity_level(const std::string& name);

}  // namespace papilla::forward
