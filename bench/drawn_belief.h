// Beliefs whose members are drawn about a finger: numbers times exp(s normal).
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "base/random.h"
#include "config/node.h"
#include "scene/belief.h"
#include "scene/finger.h"

namespace papilla::tests {

// Members in the order in which their numbers are drawn.
class DrawnBelief {
 public:
  DrawnBelief(const std::string& by, const Finger& finger, const char* purpose)
      : finger_(finger), random_(1, purpose) {
    belief_.made_of = "drawn by " + by;
    belief_.calibrated_for = finger.calibrated_for;
  }

  // thickness: the spread of the layer's; all: its thickness at 75 % RH and the shear strength too.
  BeliefMember& add(double weight, double thickness, bool all) {
    BeliefMember& member = belief_.members.emplace_back();
    member.weight = weight;
    const auto set = [&](const char* path, double value, double spread, const char* unit) {
      member.set.push_back(
          {path,
           text_node(fmt::format("{:.6g} {}", value * std::exp(spread * random_.normal()), unit))});
    };
    set("skin.rms", 1e9 * finger_.skin.rms, 0.15, "nm");
    set("skin.layer_modulus", 1e-6 * finger_.skin.layer_modulus, 0.3, "MPa");
    set("electrical.thickness_15", 1e9 * finger_.electrical.thickness_15, thickness, "nm");
    if (all) {
      set("electrical.thickness_75", 1e9 * finger_.electrical.thickness_75, thickness, "nm");
      set("macro.shear_strength", 1e-6 * finger_.macro.shear_strength, 0.3, "MPa");
    }
    const double load = finger_.macro.load_share * std::exp(0.4 * random_.normal()),
                 water = std::exp(0.4 * random_.normal());
    member.set.push_back({"macro.load_share", number_node(load)});
    member.set.push_back({"water.scale", number_node(water)});
    return member;
  }
  Belief take() { return std::move(belief_); }

 private:
  const Finger& finger_;
  RandomStream random_;
  Belief belief_;
};

}  // namespace papilla::tests
