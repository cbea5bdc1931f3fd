// Every published claim beside the model's number, with a verdict: a closed list, one row per
// claim.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "claims/claim.h"
#include "claims/kept_results.h"
#include "published/finger_model.h"
#include "scene/finger.h"

namespace papilla::claims {

// Of a claim with all before it, where one finger answers both [s of one core of a usual machine]:
// 0 where that is not worth telling.
double usual_seconds(const Claim& claim);

struct ReproduceOptions {
  std::vector<std::string> ids;  // empty: all
  Finger finger;                 // fitted_to says which claims were fitted
  int threads = 0;
  SkinSampling sampling;
  bool one_preset = false;  // the finger's own alone, for a fit
  std::string folder;       // where judgements are kept; empty: nowhere
  // Before each claim that is not kept: what is left of `usual_seconds`, it included.
  std::function<void(const Claim&, double left)> begun;
  std::function<void(const ClaimResult&)> done;  // after each claim
};
// All that judgements depend on but their claims, the samples on disk among it: those of another
// problem are not gone on with.
std::string judged_problem(const ReproduceOptions& options);

// In the order of the list. Throws InputError for an id that is not there, WorkStopped where a
// Watch ends it: what has been judged lies in the folder, and the same call goes on there.
std::vector<ClaimResult> reproduce(const ReproduceOptions& options);

}  // namespace papilla::claims
