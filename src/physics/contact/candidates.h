// Which pixels of a light contact are watched: those that may touch, inside this folder.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "physics/contact/solvers.h"

namespace papilla {

// Pixels, and whether each is taken to touch at first.
using Watched = std::vector<std::pair<int, bool>>;

// What is asked for: nothing where much more than `limit` pixels are expected to touch, unless
// `demand`: then as many as are affordable.
struct WatchLimits {
  std::size_t limit;
  bool demand;
};

// From the gap function without pressure [m]: the lowest gaps, four times the contact that
// Persson's and Bush's theories expect, 2 p / (E* rms slope).
std::optional<Watched> watch_lowest(const StandardProblem& problem, std::span<const double> g0,
                                    const WatchLimits& limits);

// From the gaps and pressures of a nearby solution: three times its contact.
std::optional<Watched> watch_near(const StandardProblem& problem, const ContactSolution& start,
                                  const WatchLimits& limits);

}  // namespace papilla
