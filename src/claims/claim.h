// A published claim: what the paper says, when the model agrees, and how that is judged. A claim
// that differs is shown, never tuned away; no claim has parameters of its own, they come from one
// finger file (and, for the theory papers, from the numbers that those papers print).
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "numerics/statistics.h"
#include "published/finger_model.h"

namespace papilla::claims {

enum class Verdict {
  Agrees,
  Fitted,             // agrees, but was among the residuals of the finger's fit
  Differs,            // with the reason, where it is known
  PaperInconsistent,  // the paper's own numbers contradict it
  NotTestable,        // data not published, or the model lacks the piece
};
inline constexpr std::array kVerdicts{Verdict::Agrees, Verdict::Fitted, Verdict::Differs,
                                      Verdict::PaperInconsistent, Verdict::NotTestable};
std::string verdict_name(Verdict verdict);  // "agrees", "paper inconsistent", ...

// What the model says to a claim; values in the unit of its statement.
struct Judgement {
  Verdict verdict = Verdict::NotTestable;
  double value = 0;    // the model's number; NaN where the claim has none
  double se = 0;       // its standard error; 0: no sampling
  std::string model;   // the model's answer for people: "3.16 um", "+41 +-6 %"
  std::string reason;  // how it was judged; why it differs
  // Share of single patches on which all of it holds: the paper had one patch a sample. None: the
  // claim is not about patches.
  std::optional<double> single{};
};

// Where the number of a claim comes from: what it can prove.
enum class Basis {
  Finger,    // the model of the finger
  Input,     // a number of the finger file as it stands
  Identity,  // a paper's formulas with the paper's own numbers
};
inline constexpr std::array kBases{Basis::Finger, Basis::Input, Basis::Identity};
std::string basis_name(Basis basis);  // "of the finger", "input", "identity"

struct Claim {
  std::string id;         // "M13"
  std::string source;     // the paper
  std::string statement;  // what it says, with its number
  std::string band;       // when it agrees
  bool both_presets = false;
  std::function<Judgement(FingerModel&)> judge;
  Basis basis = Basis::Identity;
};

// All claims, in the order of the papers; ids are unique.
const std::vector<Claim>& claims();
std::vector<Claim> m3_claims();  // M: the M3 model's samples and screens
std::vector<std::string> m3_claim_ids();
std::vector<Claim> theory_claims();  // P, J, B, S: mean field, impedance, modulation, stiction

inline bool within(double value, double low, double high) { return value >= low && value <= high; }

// Agrees or differs.
Judgement agrees_if(bool agrees, double value, double se, std::string model,
                    std::string reason = "");
// A claim about several numbers holds when all do; the number shown is the first that does not,
// else the first. One that is none, as a change of nothing is, leaves nothing to judge.
struct Part {
  std::string name;
  Estimate value;
  bool holds;
  std::vector<bool> single{};  // whether it holds on each patch alone; empty: not of patches
};
Judgement all_of(const std::vector<Part>& parts, const std::string& why_not = "");
// Values that must rise (or fall) along a list.
Judgement trend(const std::vector<double>& values, bool rises, std::string reason);

}  // namespace papilla::claims
