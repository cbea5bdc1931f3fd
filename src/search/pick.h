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

// Index of the design of a front (in the order of its folders) by a rule: "worst" (or empty, where
// there is a drive; "knee" where not) has
// the highest worst modulation; "knee" the least sum of objectives, each
// scaled to the front's extent; "mean(modulation)", or the beginning of an objective's name, the
// best of that objective; "3" is front/03. Throws InputError for anything else.
std::size_t pick_design(const std::string& rule, const std::vector<PickCandidate>& front);

// The folder of the design picked from a folder that `papilla optimize` wrote: "best" for an empty
// rule, else "front/03". Throws InputError.
std::string picked_design(const Folder& results, const std::string& rule);
// Its design.toml.
std::string picked_design_file(const std::string& results, const std::string& rule);

}  // namespace papilla::search
