// What has been judged of a reproduction, on disk: one that was interrupted goes on where it
// stopped.
#pragma once

#include <string>

#include "base/rooms.h"
#include "claims/claim.h"
#include "optim/unfinished.h"

namespace papilla::claims {

struct ClaimResult {
  const Claim* claim = nullptr;
  Judgement papilla, m3;  // m3 only where the claim asks for both presets
  double seconds = 0;
};

class KeptResults {
 public:
  KeptResults() = default;  // keeps nothing
  // The folder must exist. `problem`: all that a judgement depends on but its claim; judgements of
  // another problem lie in another file. Throws InputError where the file cannot be written.
  KeptResults(const std::string& folder, const std::string& problem)
      : unfinished_(folder, problem) {}

  // Whether the judgement of result.claim is kept; then the result is filled in. Anybody can have
  // written the file: what is no judgement in every letter is none.
  bool find(ClaimResult& result) const;
  void keep(const ClaimResult& result);
  void remove() { unfinished_.remove(); }  // all has been judged

 private:
  Unfinished unfinished_;  // by the claim's id
};

}  // namespace papilla::claims
