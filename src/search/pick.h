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
  std::optional<double> worst{};   // lowest modulation over fingers and humidity; none: undriven
};

// What makes a design of a front the best.
struct PickRule {
  enum class Kind {
    Worst,      // the highest worst modulation
    Knee,       // the least sum of the objectives, each scaled to the front's extent
    Objective,  // the best of one
    Number,     // the user's own choice
  };
  Kind kind = Kind::Worst;
  std::size_t index = 0;  // of the objective; of the design, from 0
};
// "worst" (or empty, where there is a drive; "knee" where not), "knee", the beginning of an
// objective's name as "mean(modulation)", or "3" for front/03. Throws InputError for anything else.
PickRule read_pick_rule(const std::string& rule, const std::vector<std::string>& objectives,
                        bool driven);

// Of an objective, over the designs of a front.
struct Extent {
  double low = 0, high = 0;
};
std::vector<Extent> extents(const std::vector<PickCandidate>& front);
// What a design is worth to a rule: the highest is picked. extents: of the front, for the knee; not
// of a number. Eq. search.14
double pick_worth(const PickRule& rule, const PickCandidate& design,
                  const std::vector<Extent>& extents);

// Index of the design of a front (in the order of its folders) by a rule; the first among equals.
std::size_t pick_design(const std::string& rule, const std::vector<PickCandidate>& front);

// The folder of the design picked from a folder that `papilla optimize` wrote: "best" for an empty
// rule, else "front/03". Throws InputError.
std::string picked_design(const Folder& results, const std::string& rule);
// Its design.toml.
std::string picked_design_file(const std::string& results, const std::string& rule);

}  // namespace papilla::search
