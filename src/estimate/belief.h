// Propagates the uncertainty of finger and model to the numbers of a response: by the members of
// the finger's belief or, where it has none, by the covariance of its fit.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "forward/forward.h"
#include "scene/belief.h"

namespace papilla::estimate {

// Skins per member. Few are enough, because the members differ by much more than skins and pixels
// change of these differences: the error part `model` is then accurate to a fifth
// (docs/theory/accuracy.md).
inline constexpr int kMemberSkins = 2;
// What members are run with: the load law, at most `skins` skins and 64 pixels.
Fidelity belief_fidelity(const Fidelity& fidelity, int skins = kMemberSkins);

// The scene at each member.
std::vector<Scene> belief_scenes(const Belief& belief, const Scene& scene);

// Eq. accuracy.15: runs the scene and its members on common skins, offsets and droplets. Fills
// response.belief and the error part `model` of every number. If the finger has no belief, or the
// scene has other model options than those the finger was calibrated with, it fills only
// response.belief.absent, with the reason. Cost: members + 1 evaluations at belief_fidelity. Throws
// as belief_of.
void add_belief(Response& response, const Scene& scene, const Texture& texture,
                const Fidelity& fidelity, int skins = kMemberSkins);

// Processor time of one core [s] that add_belief takes on the machine at hand, before it is begun:
// the scene as it is and three of its members are run. 0 where it fills nothing.
double measured_belief_seconds(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                               int skins = kMemberSkins);

// Fills the error part `model` of every number from response.belief, which add_belief has made for
// this response or for the same design at another fidelity, and gives its runs the response's error
// of the modulation (take_felt_errors).
void state_belief(Response& response);

// Why the uncertainty of finger and model cannot be stated, for people: the finger has neither a
// belief nor `uncertainty`. "" if it has one of them.
std::string unknown_model(const Finger& finger);
// States that uncertainty: by add_belief where the finger has a belief for the scene's model
// options, else by the steps of Eq. accuracy.11 where it has `uncertainty`, else not at all.
void add_model_errors(Response& response, const Scene& scene, const Texture& texture,
                      const Fidelity& fidelity, int member_skins = kMemberSkins);
// The cost of add_model_errors: how many evaluations, and at which fidelity.
struct ModelCost {
  int runs = 0, members = 0;  // members: of belief; 0: the steps are run, or nothing is
  Fidelity fidelity;
};
ModelCost model_cost(const Scene& scene, const Fidelity& fidelity, int member_skins = kMemberSkins);

}  // namespace papilla::estimate
