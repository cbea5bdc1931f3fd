// One candidate in one finger state: its criteria on the skins of the common sequence.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "forward/forward.h"
#include "rank/options.h"

namespace papilla::rank {

class Candidate {
 public:
  // Keeps references to both.
  Candidate(const Regions& regions, FingerState state, const RankOptions& options);

  int skins() const { return skins_; }
  // What was solved or seen for them: skins; of what is looked at alone the arrangements, one of a
  // surface that is not random.
  int tried() const;
  // Whether more skins may tell more of it: it is felt, or its arrangements differ.
  bool scatters() const { return random_ || options_.felt(); }
  // Solves a batch more: the next skins of the common sequence, shared out over the regions. Throws
  // InputError for a criterion that is not defined here.
  void extend();
  // A sample per skin of each criterion: jackknife pseudo-values, Eq. ranking.2
  const std::vector<double>& samples(std::size_t criterion) const { return pseudo_[criterion]; }

  // Solves what each member of the finger's belief, or without one each step of its parameters,
  // does to each criterion, from its value on the skins met so far. Eq. ranking.5, ranking.8
  void step();
  const StepSamples& steps(std::size_t criterion) const { return steps_[criterion]; }
  std::vector<double> member_weights() const;    // of belief; empty: the finger has none
  int batch() const { return fidelity_.skins; }  // skins of a step
  // How far its look can be trusted, for people: of the first arrangement that says so; "": it can,
  // or nothing is looked at.
  std::string look_warning() const;
  // What the model says against the numbers on the skins met so far, for people; "": nothing.
  const std::string& trouble() const { return trouble_; }

 private:
  // What is measured once of each region, since it is the same on all skins.
  struct RegionLaws {
    FieldRatios field;           // what its field rule lacks
    std::vector<LoadLaws> laws;  // how its load law goes
  };
  void solve(const std::function<void(Scene&)>& move, Fidelity fidelity, PatchSet& patches,
             std::vector<RegionLaws>& known) const;
  double value(const Criterion& c, Response& response, const Optics* look) const;
  void look_on();
  void move_values();

  const Regions& regions_;
  const Design& design_;  // the first region: what all share
  const RankOptions& options_;
  FingerState state_;  // of a finger; a pin has none
  Scene scene_;
  Fidelity fidelity_;
  // Where a criterion asks for it: mean over the regions, one per skin of a surface that is random,
  // each of another arrangement; else one. Eq. ranking.7
  std::vector<Optics> looks_;
  bool random_ = false;  // another arrangement of it has another look
  PatchSet patches_;     // of a candidate that is looked at alone, none
  int skins_ = 0;
  std::string trouble_;
  std::vector<RegionLaws> known_;
  std::vector<double> values_;               // [criterion] on all skins that it met
  std::vector<std::vector<double>> pseudo_;  // [criterion][skin]
  Response moved_;                           // its runs of belief or of the steps; no points
  std::vector<StepSamples> steps_;           // one per criterion
};

}  // namespace papilla::rank
