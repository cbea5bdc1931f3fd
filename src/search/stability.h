// Does the order of the finalists survive other fingers and other choices of the model? The
// choices that move results at first order are not known well enough to trust one of them alone.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/problem.h"
#include "search/protocol.h"

namespace papilla::search {

struct StabilityVariant {
  std::string name;                         // "finger rough", "first droplet step 50 nm"
  std::vector<std::vector<double>> values;  // [design][objective], the user's sign; empty: failed
  std::vector<bool> on_front;               // of these designs, within the tolerance
};

struct Stability {
  std::vector<StabilityVariant> variants;
  std::vector<int> times_on_front;  // of a design, over the variants

  bool judged(std::size_t design) const { return design < times_on_front.size(); }
  // On the front in two thirds of the variants at least; of a judged design.
  bool stable(std::size_t design) const {
    return 3 * times_on_front[design] >= 2 * static_cast<int>(variants.size());
  }
};

// Each design on each finger of the study alone, then on its first finger with one model choice
// changed: droplet mobility, droplets per volume, the pull over droplets that do not bridge,
// breakdown cap, self-consistent coupling.
std::vector<std::string> stability_variants(const StudyProblem& problem);

// One design in one variant: the values of the objectives. Cost: one finger at this fidelity.
TaskAnswer evaluate_variant(const StudyProblem& problem, const Design& design, std::size_t variant,
                            const Fidelity& fidelity);

// From answers[design][variant]. Common random numbers throughout, so a design counts as beaten
// only by one that is better by `tolerance` (relative) in every objective.
Stability judge_stability(const StudyProblem& problem,
                          const std::vector<std::vector<TaskAnswer>>& answers,
                          double tolerance = 0.01);

}  // namespace papilla::search
