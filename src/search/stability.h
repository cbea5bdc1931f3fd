// Does the order of the finalists survive other fingers and other choices of the model? The
// choices that move results at first order are not known well enough to trust one of them alone.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/problem.h"
#include "search/protocol.h"

namespace papilla::search {

// One variant, of each design.
struct StabilityVariant {
  std::string name;                         // "finger rough", "first droplet step 50 nm"
  std::vector<std::vector<double>> values;  // [design][objective], the user's sign; empty: failed
  std::vector<bool> on_front{};             // it keeps every limit, and none beats it
  std::vector<std::optional<std::size_t>>
      beaten_by{};  // a design that is better in everything that is compared
  std::vector<std::vector<LimitValue>> broken{};  // limits of the study that it does not keep
  std::vector<double> worst{};                    // lowest modulation over humidity
  std::vector<std::string> unanswered{};          // why a design has no values; "": it has
};

struct Stability {
  std::vector<StabilityVariant> variants;
  std::vector<int> times_on_front;  // of a design, over the variants
  std::optional<std::size_t>
      other_skin;                // the variant of another state of the skin; a pin has none
  std::size_t first_choice = 0;  // of the variants that are choices of the model

  bool judged(std::size_t design) const { return design < times_on_front.size(); }
  bool has_order() const { return !variants.empty() && times_on_front.size() > 1; }
  // On the front in two thirds of the variants at least; of a judged design.
  bool stable(std::size_t design) const {
    return 3 * times_on_front[design] >= 2 * static_cast<int>(variants.size());
  }
};

// Each design on each finger of the study alone, then on its first finger with one thing changed:
// the state of the skin (natural where the study has degreased fingers, else degreased), then a
// choice of the model: droplet mobility, droplets per volume, the pull over droplets that do not
// bridge, what the air withstands, equilibrium or one pass.
std::vector<std::string> stability_variants(const StudyProblem& problem);
// The one of another state of the skin; nothing where a pin touches in place of a finger.
std::optional<std::size_t> skin_variant(const StudyProblem& problem);

// One design in one variant, with the samples behind its errors. Cost: one finger at this fidelity.
TaskAnswer evaluate_variant(const StudyProblem& problem, const Design& design, std::size_t variant,
                            const Fidelity& fidelity);

// Limits are judged as confirmed: what a variant changes is told apart from what the level of the
// checks is off by. confirmed: answers of a design's tasks; answers: of its variants, changed.
void set_confirmed_limits(const StudyProblem& problem, const std::vector<TaskAnswer>& confirmed,
                          std::vector<TaskAnswer>& answers);

// From answers[design][variant]. All designs meet the same skins: one counts as beaten only where
// another is better in every objective by more than the error of their difference, skin by skin
// (Eq. accuracy.14), and, where belief decides on the front, in the worst modulation.
Stability judge_stability(const StudyProblem& problem, const std::vector<Point>& designs,
                          const std::vector<std::vector<TaskAnswer>>& answers);

}  // namespace papilla::search
