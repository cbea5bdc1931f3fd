// The performance targets, measured here: the page docs/measured/performance.md.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::measure {

struct BenchRow {
  std::string what, unit;
  double measured = 0, target = 0;
  bool at_most = true;  // else at least
  bool exact = false;   // a count, the same on every machine; else a time or what depends on one

  bool met() const { return at_most ? measured <= target : measured >= target; }
};

struct BenchOptions {
  bool large = false;  // contact at 4096 x 4096 too: 2.5 GB
  std::function<void(const std::string&)> note;
};

// A minute. Times on a machine with other load are upper bounds, ratios less so.
std::vector<BenchRow> bench(const BenchOptions& options);

}  // namespace papilla::measure
