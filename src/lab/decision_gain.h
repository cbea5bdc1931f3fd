// The value of experiments for a decision: what the readings that belief expects would do to the
// choice among designs. Eq. lab.6
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "lab/batch.h"
#include "search/prospects.h"

namespace papilla::lab {

// The designs of a decision at the draws of belief after some readings; limits as of their members.
MemberWorth decision_worth(const WorthAfter& after, const DecisionLimits& limits);

// A third of the values that belief expects of a reading, and what is chosen after such a one.
struct Foreseen {
  double low = 0, high = 0;  // friction [N]
  std::size_t choice = 0;    // the design that is chosen most often
  double p_choice = 0;       // how often
  std::vector<double> p_hypothesis;
  std::string design{};  // its name; "": not known any more
};

class DecisionGain final : public Gain {
 public:
  // limits outlives this, as all but `draws`.
  DecisionGain(const Ensemble& ensemble, const Kernels& kernels, const Evidence& sofar,
               const DecisionLimits& limits, int draws);

  // Of what there is to gain: the fall of expected regret, a share of it now, and that of the
  // variance of the differences between the choice and the designs that may be better. Eq. lab.6
  double of(const Candidate& candidate) const override;
  void take(const Candidate& candidate) override;

  // The design of the least expected regret of those that may be chosen now, and expected regret:
  // now, and on average after what was taken.
  std::size_t choice() const { return choice_; }
  double regret_now() const { return regret_now_; }
  // More than now where what is told of the limits leaves worse designs to choose among.
  double regret_after() const;
  // Share of the futures in which another design is chosen after what was taken.
  double p_change() const;
  // Of each reading that was taken, low, middle and high; those of the whole batch are known as
  // well when the design is chosen.
  std::vector<std::vector<Foreseen>> outcomes() const;

 private:
  // A member that is true, and what the readings ahead do if it is.
  struct Future {
    std::size_t truth = 0;
    std::vector<double> log_weights;  // of the members, after the readings ahead
    std::vector<double> shift;        // of the worth of each design, common to the members
    std::vector<double> scatter;      // of each reading ahead, whitened
    std::vector<double> values;       // of each reading ahead: logarithm of friction
  };
  struct State {
    Evidence evidence;
    std::size_t made = 0;                    // of its readings
    std::vector<std::vector<double>> worth;  // [design][member]
    std::vector<Future> futures;
    std::vector<double> left;  // [design]: variance within kernels of its difference to the choice
  };
  struct Found {
    std::size_t choice = 0;
    double better = 0;    // expected worth of the choice over that of the choice now, both counted
                          // for no more than the best that keeps the limits
    double variance = 0;  // of contested differences
  };

  void take(State& state, const Observation& reading) const;
  void move_future(const State& state, Future& future, std::size_t index) const;
  Found found(const State& state, const Future& future) const;
  Found average(const State& state) const;
  std::vector<double> beyond_limits(const State& state, const Future& future,
                                    const std::vector<double>& weights) const;

  const Ensemble& ensemble_;
  const Kernels& kernels_;
  const DecisionLimits& limits_;
  std::vector<double> p_best_;  // of each design now
  bool limited_ = false;        // some design breaks a limit at some member
  std::size_t choice_ = 0;
  double regret_now_ = 0;
  State state_;
  Found found_, before_;
};

}  // namespace papilla::lab
