// What belief leaves of the predictions.
#include <algorithm>
#include <cmath>
#include <utility>

#include "claims/members.h"
#include "claims/predict.h"
#include "metrics/metrics.h"

namespace papilla::claims {
namespace {

constexpr int kMemberSkins = 4, kMemberGrid = 64;
// Members with an answer from which on their spread is told.
constexpr std::size_t kLeastMembers = 5;

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
  take_model_parts(predictions, belief, members);
}

void take_model_parts(std::vector<Prediction>& predictions, const Belief& belief,
                      const std::vector<std::vector<Prediction>>& members) {
  for (Prediction& p : predictions) {
    p.members = static_cast<int>(members.size());
    if (!p.of_finger) continue;
    std::vector<double> values, weights;
    StepSamples samples;
    for (std::size_t k = 0; k < members.size(); ++k) {
      const Prediction* there = same(members[k], p);
      if (!there) continue;
      values.push_back(there->value.value);
      weights.push_back(belief.members[k].weight);
      samples.push_back(there->samples);
    }
    p.silent = p.members - static_cast<int>(values.size());
    if (p.silent == 0 || values.size() >= kLeastMembers)
      p.model = deviation_over(weights, values) *
                meant_part(moves_from_mean(weights, std::move(samples)));
  }
}

}  // namespace papilla::claims
