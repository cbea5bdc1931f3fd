// Every published claim beside the model's number, with a verdict: a closed list, one row per
// claim.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "claims/claim.h"
#include "published/finger_model.h"
#include "scene/finger.h"

namespace papilla {

struct ClaimResult {
  const Claim* claim = nullptr;
  Judgement papilla, m3;  // m3 only where the claim asks for both presets
  double seconds = 0;
};

struct ReproduceOptions {
  std::vector<std::string> ids;  // empty: all
  Finger finger;                 // fitted_to says which claims were fitted
  int threads = 0;
  SkinSampling sampling;
  bool one_preset = false;                       // the finger's own alone, for a fit
  std::function<void(const ClaimResult&)> done;  // after each claim
};
// In the order of the list. Throws InputError for an id that is not there.
std::vector<ClaimResult> reproduce(const ReproduceOptions& options);

}  // namespace papilla
