// What belief leaves of the predictions.
#include <algorithm>

#include "claims/members.h"
#include "claims/predict.h"

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
    members.push_back(few_predictions(options, member_finger(belief, m, options.finger)));
  }
  for (Prediction& p : predictions) {
    std::vector<double> values;
    for (const std::vector<Prediction>& member : members) {
      if (const Prediction* there = same(member, p)) values.push_back(there->value.value);
    }
    if (values.size() == members.size()) p.model = deviation_over(belief, values);
  }
}

}  // namespace papilla::claims
