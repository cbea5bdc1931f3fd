#include "published/finger_model.h"

#include <algorithm>

namespace papilla::published {

Fidelity SkinSampling::fidelity(int threads) const {
  Fidelity f = fidelity_level(level);
  f.skins = skins;
  f.first_skin = first_skin;
  if (grid > 0) f.grid = grid;
  f.threads = threads;
  // Claims and fits look at small differences on common skins, and at their derivatives: the
  // solver's own noise has to stay far below them.
  f.contact_tolerance = std::min(f.contact_tolerance, 1e-5);
  // The 3-D field of a few skins moves with their droplets. A fit descends on the rule alone; what
  // it lacks is in its factors to the level of the check.
  if (f.estimator == Estimator::Load) {
    f.field_skins = 0;
    f.control_skins = 0;  // errors that no fit reads
  }
  return f;
}

}  // namespace papilla::published
