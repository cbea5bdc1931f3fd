// Which design of a front is shown first.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/folder.h"
#include "base/rooms.h"

namespace papilla::search {

struct PickCandidate {
  std::vector<std::string> names;  // of the objectives: "mean(modulation)"
  std::vector<double> objectives;  // minimised
  // Lowest modulation over fingers and humidity; none: undriven, or of a study that asks for no
  // amplitude of its own (StudyProblem::judged_at_amplitude).
  std::optional<double> worst{};
  std::vector<double> errors{};  // one standard error of each objective; empty: not known
};

// What makes a design of a front the best.
struct PickRule {
  enum class Kind {
    Worst,      // the highest worst modulation
    Knee,       // the least sum of the objectives, each divided by its range over the front
    Objective,  // the best of one
    Number,     // the user's own choice
  };
  Kind kind = Kind::Worst;
  std::size_t index = 0;  // of the objective; of the design, from 0

  bool operator==(const PickRule&) const = default;
};
// "worst" (or empty, where designs have a worst modulation; "knee" where not), "knee", the
// beginning of one objective's name as "mean(modulation)", or "3" for front/03. Throws InputError
// for anything else, and for what begins the names of several.
PickRule read_pick_rule(const std::string& rule, const std::vector<std::string>& objectives,
                        bool has_worst);
// By what a run with that rule decides over belief: a number of a design decides nothing, and one
// objective alone decides by itself.
PickRule decided_rule(const std::string& rule, const std::vector<std::string>& objectives,
                      bool has_worst);

// Of an objective over the designs of a front: the least value, and what its values are divided by.
struct ObjectiveRange {
  double low = 0, width = 0;  // width 0: all are alike, and it does not count
};
// One per objective. What the values span and their standard error, in quadrature: where designs
// differ by less than is known of them, the difference counts for little. Eq. search.14
std::vector<ObjectiveRange> objective_ranges(const std::vector<PickCandidate>& front);
// What a design is worth to a rule: the highest is picked. ranges: for the knee. Not of a number.
double pick_worth(const PickRule& rule, const PickCandidate& design,
                  const std::vector<ObjectiveRange>& ranges);

// Index of the design of a front (in the order of its folders) by a rule; the first among equals.
// ranges: for the knee; empty: those of the front.
std::size_t pick_design(const std::string& rule, const std::vector<PickCandidate>& front,
                        std::vector<ObjectiveRange> ranges = {});

// The folder of the design picked from a folder that `papilla optimize` wrote: "best" for an empty
// rule, else "front/03". By the rule that the run decided with over belief, its choice; by another
// rule, the numbers of the fit, for the knee with the ranges of that decision. Throws InputError.
std::string picked_design(const Folder& results, const std::string& rule);
// Its design.toml.
std::string picked_design_file(const std::string& results, const std::string& rule);

}  // namespace papilla::search
