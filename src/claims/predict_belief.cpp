// What belief leaves of the predictions.
#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "claims/predict.h"
#include "scene/belief.h"

namespace papilla::claims {
namespace {

constexpr int kMemberSkins = 4, kMemberGrid = 64;

std::vector<Prediction> few_predictions(const PredictOptions& options, const Finger& finger) {
  PredictOptions few = options;
  few.finger = finger;
  few.skins = kMemberSkins;
  few.grid = kMemberGrid;
  few.few = true;
  few.started = {};
  return predictions(few);
}

const Prediction* same(const std::vector<Prediction>& list, const Prediction& p) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const Prediction& other) {
    return other.id == p.id && other.condition == p.condition && other.quantity == p.quantity;
  });
  return found == list.end() ? nullptr : &*found;
}

}  // namespace

void add_model_parts(std::vector<Prediction>& predictions, const PredictOptions& options) {
  if (options.finger.belief.empty()) return;
  const Belief belief = belief_of(options.finger);
  std::vector<std::vector<Prediction>> members;
  for (const BeliefMember& m : belief.members) {
    if (options.started) options.started("belief, a member of " + m.hypothesis);
    const MemberScene at = with_member(belief, m, options.finger, options.finger.calibrated_for);
    Finger finger = at.finger;
    finger.calibrated_for = at.model;
    members.push_back(few_predictions(options, finger));
  }
  for (Prediction& p : predictions) {
    double mean = 0, squares = 0;
    bool known = true;
    for (std::size_t k = 0; k < members.size(); ++k) {
      const Prediction* there = same(members[k], p);
      known = known && there;
      if (!there) break;
      mean += belief.members[k].weight * there->value.value;
      squares += belief.members[k].weight * square(there->value.value);
    }
    if (known) p.model = std::sqrt(std::max(0.0, squares - square(mean)));
  }
}

}  // namespace papilla::claims
