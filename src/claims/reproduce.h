// Every published claim beside the model's number, with a verdict: a closed list, one row a claim.
// A claim that differs is shown, never tuned away; no claim has parameters of its own, they come
// from one finger file (and, for the theory papers, from the numbers those papers print).
#pragma once

#include <any>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "base/statistics.h"
#include "forward/fidelity.h"
#include "scene/finger.h"

namespace papilla {

enum class Verdict {
  Agrees,
  Fitted,             // agrees, but was among the residuals of the finger's fit
  Differs,            // with the reason, where it is known
  PaperInconsistent,  // the paper's own numbers contradict it
  NotTestable,        // data not published, or the model lacks the piece
};
std::string verdict_name(Verdict verdict);  // "agrees", "paper inconsistent", ...

// What a claim gives. Values in the unit of the statement.
struct Judgement {
  Verdict verdict = Verdict::NotTestable;
  double value = 0;    // the model's number; NaN where the claim has none
  double se = 0;       // its standard error; 0: no sampling
  std::string model;   // the model's answer for people: "3.16 um", "+41 +-6 %"
  std::string reason;  // how it was judged; why it differs
};
Judgement agrees_if(bool agrees, double value, double se, std::string model,
                    std::string reason = "");

// Where the skins of the judgement come from: by default 40 that no fit has seen.
struct ClaimSampling {
  std::string level = "design";  // of accuracy
  int skins = 40, first_skin = 5000;
  int grid = 0;  // pixels along a patch; 0: the level's

  Fidelity fidelity(int threads) const;
};

// What a claim may use; results that several claims share are made once.
class ClaimInputs {
 public:
  ClaimInputs(Finger finger, Preset preset, int threads, ClaimSampling sampling = {})
      : finger_(std::move(finger)),
        preset_(preset),
        threads_(threads),
        sampling_(std::move(sampling)) {}

  const Finger& finger() const { return finger_; }
  Preset preset() const { return preset_; }
  const ClaimSampling& sampling() const { return sampling_; }
  int threads() const { return threads_; }  // 0: all

  // The value made by `make` at the first call with this key.
  template <class T>
  const T& once(const std::string& key, const std::function<T()>& make) {
    auto found = shared_.find(key);
    if (found == shared_.end()) found = shared_.emplace(key, make()).first;
    return std::any_cast<const T&>(found->second);
  }

 private:
  Finger finger_;
  Preset preset_;
  int threads_;
  ClaimSampling sampling_;
  std::map<std::string, std::any> shared_;
};

struct Claim {
  std::string id;         // "M13"
  std::string source;     // the paper
  std::string statement;  // what it says, with its number
  std::string band;       // when it agrees
  bool both_presets = false;
  std::function<Judgement(ClaimInputs&)> judge;
};

// All claims, in the order of the papers; ids are unique.
const std::vector<Claim>& claims();
std::vector<Claim> m3_claims();      // M: the M3 model's samples and screens
std::vector<Claim> theory_claims();  // P, J, B, S: mean field, impedance, modulation, stiction

struct ClaimResult {
  const Claim* claim = nullptr;
  Judgement papilla, m3;  // m3 only where the claim asks for both presets
  double seconds = 0;
};

// A number of a claim that a fit can use: its residual is the distance from [low, high] over sd.
// Ratios and trends, because the papers print no curves; sd is the width that the words leave.
struct ClaimTarget {
  std::string claim;  // id; "C_gap" is the published capacitance of the gap under a sliding finger
  std::string what;   // with its unit
  double low = 0, high = 0, sd = 1;
  std::function<Estimate(ClaimInputs&)> model;
};
std::vector<ClaimTarget> m3_targets();

struct ReproduceOptions {
  std::vector<std::string> ids;  // empty: all
  Finger finger;                 // fitted_to says which claims were fitted
  int threads = 0;
  ClaimSampling sampling;
  bool one_preset = false;                       // the finger's own alone, for a fit
  std::function<void(const ClaimResult&)> done;  // after each claim
};
// In the order of the list. Throws InputError for an id that is not there.
std::vector<ClaimResult> reproduce(const ReproduceOptions& options);

// One line a claim and the counts by verdict; for people, Markdown, CSV; JSON as
// {"schema": 1, "claims": [{"id", "paper", "model", "se", "verdict", "reason", ...}], "counts"}.
std::string claims_text(const std::vector<ClaimResult>& results);
std::string claims_markdown(const std::vector<ClaimResult>& results, const std::string& finger);
std::string claims_csv(const std::vector<ClaimResult>& results);
std::string claims_json(const std::vector<ClaimResult>& results);

}  // namespace papilla
