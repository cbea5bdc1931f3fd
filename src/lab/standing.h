// What belief says after the readings: of the designs, of its hypotheses, and of what no member
// explains.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "lab/decision_gain.h"
#include "lab/discrepancy.h"
#include "lab/gauge.h"
#include "lab/lab_file.h"
#include "lab/response_table.h"

namespace papilla::lab {

// Below it a belief is to be made again of all data: a few members stand for it.
inline constexpr double kFewMembers = 10;

// Numbers behind a state of a lab; they refer to one another, so they stay where they are.
struct Standing {
  Ensemble ensemble;  // without worth where some member has no answer
  Kernels kernels;
  Gauge gauge;
  Instrument instrument;             // after its own readings
  DecisionLimits limits;             // of the members that decide
  BeliefRisk risk;                   // that decides among the choices
  std::vector<std::size_t> choices;  // designs that are decided among
  std::unique_ptr<Evidence> evidence;
  // The members at which some choice has a worth, where there are others: they alone decide.
  struct Answering {
    Ensemble ensemble;
    Kernels kernels;
    std::unique_ptr<Evidence> evidence;
  };
  std::unique_ptr<Answering> answering;
  double unanswered = 0;            // share of belief, after the readings, of the others
  std::vector<Prospect> prospects;  // of the choices; empty: nothing is decided
  std::size_t best = 0;             // of the choices
  double best_worth = 0;            // what the best at each member is worth, on average over belief
  // Over belief: the worth of each choice, and how much better the best is than it. The mean of a
  // worth and its median are two numbers where belief is skewed: differences of means are regrets.
  struct Interval {
    double low = 0, median = 0, high = 0;  // 95 % between low and high
    double mean = 0;
    Interval times(double sign) const {
      return sign < 0 ? Interval{-high, -median, -low, -mean} : *this;
    }
  };
  std::vector<Interval> worth, behind;
  std::vector<double> weights, p_hypothesis;
  double effective_members = 0;
  Discrepancies discrepancies;

  Standing() = default;
  Standing(const Standing&) = delete;
  Standing& operator=(const Standing&) = delete;
  bool decided() const { return !prospects.empty(); }
  // Whether the best of the choices keeps every limit as surely as is wanted; if not, none does.
  bool keeps_limits() const { return prospects[best].p_limits >= limits.wanted - 1e-9; }
  struct Deciding {
    const Ensemble& ensemble;
    const Kernels& kernels;
    const Evidence& evidence;
  };
  Deciding deciding() const {
    if (answering) return {answering->ensemble, answering->kernels, *answering->evidence};
    return {ensemble, kernels, *evidence};
  }
};

// What to measure for where it is not known whether the best of the choices keeps its limits: this
// may depend on the hypothesis or, within hypotheses, on the parameters of the finger. Nothing
// where it is known: the limits are kept as surely as is wanted, or broken as surely.
std::optional<Aim> aim_at_limits(const Standing& standing);

// Of which row, by whom and when.
std::vector<Observation> observations_of(const ResponseTable& table, const Experiment& experiment,
                                         const Instrument& instrument, double off_share,
                                         double on_share, const std::string& finger,
                                         const std::string& day);

// worth: of the choices at each member, NaN where there is none; kept: their limits, may be empty.
std::unique_ptr<Standing> standing_of(const Belief& belief, const LabFile& file,
                                      const std::vector<LabDesign>& designs,
                                      const ResponseTable& table,
                                      const std::vector<FrictionReading>& readings,
                                      const std::vector<MemberNumbers>& worth,
                                      const std::vector<std::vector<bool>>& kept);

}  // namespace papilla::lab
