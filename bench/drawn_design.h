// Designs of every kind that numbers alone describe, drawn by a seed.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "base/random.h"
#include "config/describe.h"
#include "design/design.h"
#include "estimate/difference.h"
#include "geometry/texture.h"

namespace papilla::tests {

// One of the numbers that a hand is at, as far as the design goes.
inline std::string moved_by_hand(RandomStream& random, Design& design) {
  std::vector<std::string> paths = texture_numbers(design);
  paths.insert(paths.end(), {"drive.amplitude", "finger.load"});
  const std::string path = paths[static_cast<std::size_t>(random.below(int(paths.size())))];
  constexpr double kLeast = 0.6, kMost = 1.6;  // times the value before
  const double share = std::exp(random.uniform(std::log(kLeast), std::log(kMost)));
  const DesignStep step = design_step(design, path, std::abs(share - 1));
  set_number(design, path, share > 1 ? step.up : step.down);
  return path;
}

inline std::vector<std::size_t> kinds() {
  std::vector<std::size_t> out;
  for (std::size_t kind = 0; kind < texture_kinds().size(); ++kind) {
    if (numbers_alone(kind)) out.push_back(kind);
  }
  return out;
}

// Bare and under a film, wide and narrow in turns.
inline Design drawn_design(RandomStream& random, const std::string& designs, std::size_t group) {
  const std::vector<std::size_t> all = kinds();
  const bool film = group / all.size() % 2 == 1;
  Design out =
      read_design(designs + (film ? "/m3_glass/directional.toml" : "/m3_samples/a3h600.toml"));
  const Texture texture = default_texture(all[group % all.size()]);
  if (texture_name(texture) != texture_name(out.texture)) out.texture = texture;
  if (group % 3 == 2) {  // narrow
    for (const std::string& path : texture_numbers(out)) {
      const DesignStep step = design_step(out, path, 0.7);
      if (step.unit == "um") set_number(out, path, step.down);
    }
  }
  for (int n = 0; n < 3; ++n) moved_by_hand(random, out);
  return out;
}

}  // namespace papilla::tests
