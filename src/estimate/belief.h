// What is not known of finger and model, carried to the numbers of a response: the members of the
// finger's belief, or where it has none the covariance of its fit.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "forward/forward.h"
#include "scene/belief.h"

namespace papilla::estimate {

// Members differ by far more than skins and pixels move their differences: with so many skins model
// parts are good to a fifth (docs/theory/accuracy.md).
inline constexpr int kMemberSkins = 2;
// What members are run with: the load law, at most `skins` skins and 64 pixels.
Fidelity belief_fidelity(const Fidelity& fidelity, int skins = kMemberSkins);

// The scene at each member.
std::vector<Scene> belief_scenes(const Belief& belief, const Scene& scene);

// Eq. accuracy.15: runs the scene and its members on common skins, offsets and droplets. Fills
// response.belief and the part `model` of every number; a finger without belief, or one in other
// model options than its own, has response.belief.absent say so. Cost: members + 1 evaluations at
// belief_fidelity. Throws as belief_of.
void add_belief(Response& response, const Scene& scene, const Texture& texture,
                const Fidelity& fidelity, int skins = kMemberSkins);

// The part `model` of every number of a response whose belief has been run: by add_belief, or with
// another fidelity of the same design.
void state_belief(Response& response);

// Why a finger says nothing of what is not known of it: neither belief nor `uncertainty`; "" where
// it does.
std::string unknown_model(const Finger& finger);
// Belief where the finger has one, else the steps of Eq. accuracy.11; those need `uncertainty`.
void add_model_errors(Response& response, const Scene& scene, const Texture& texture,
                      const Fidelity& fidelity, int member_skins = kMemberSkins);
// Evaluations that it takes, and what they are run with.
struct ModelCost {
  int runs = 0;
  Fidelity fidelity;
};
ModelCost model_cost(const Finger& finger, const Fidelity& fidelity,
                     int member_skins = kMemberSkins);

}  // namespace papilla::estimate
