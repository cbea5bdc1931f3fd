// A belief of a calibration: what its data leave of parameters and of choices of the model, as
// weighted members. Equations calibration.7-10: docs/theory/calibration.md.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "calibrate/calibration_file.h"
#include "calibrate/residuals.h"
#include "optim/posterior.h"
#include "scene/belief.h"

namespace papilla::calibrate {

constexpr int kEvaluationsANote = 10;  // how often a fit says how far it is

struct HypothesisFit {
  std::string name;
  Posterior posterior;
  std::vector<double> scores;  // log predictive, of each group left out
  double score = 0;            // their sum
  double score_error = 0;      // its standard deviation, by halves of the answers
  double least_effective = 0;  // samples that one of them stands on
  double weight = 0;
  std::string failed;  // why it has no posterior; then its weight is 0
};

struct BeliefFit {
  Belief belief;
  std::vector<HypothesisFit> hypotheses;  // the finger's own first
  std::vector<std::string> groups;        // what is left out together
  double variance_factor = 1;             // common to all of them
  int evaluations = 0;
  // How far members and samples agree in every row and parameter.
  double largest_mean = 0, least_spread = 1, largest_spread = 1;
};

// Evaluations of the model that `make_belief` takes at most; corrections are not among them.
int belief_evaluations(const Calibration& calibration);

// Every hypothesis is fitted from some starts and sampled by itself; weights by what each predicts
// of groups of rows left out. fit, finger, trials: of the finger's own model options. The rows of
// the residuals are left as they are.
BeliefFit make_belief(const Calibration& calibration, Residuals& residuals,
                      const LeastSquaresFit& fit, const Finger& finger,
                      const std::vector<PosteriorTrial>& trials,
                      const std::function<void(const std::string&)>& note);

}  // namespace papilla::calibrate
