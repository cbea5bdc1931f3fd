// The wall-clock limit of a run, shared out over what it does: what comes after the search shrinks
// before the search does.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>

#include "base/rooms.h"

namespace papilla::search {

// What a run does, in this order.
enum class RunPart {
  Search,
  Narrow,
  Confirm,
  Belief,
  Stability,
  Flat,
  Rounding,
  Sensitivity,
  Parameters,
  Files
};
inline constexpr std::size_t kParts = 10;

// Expected seconds of each part in full.
using PartSeconds = std::array<double, kParts>;

// Of the limit: what a part can count on, at most as long as it wants.
double part_share(RunPart part);
// Until when a part may work [s since the run began]: for each later one its share, or as long as
// it wants where that is less, is kept.
double part_deadline(double limit, RunPart part, const PartSeconds& wanted);

class RunClock {
 public:
  // limit: 0: none; spent: of it, before the run began [s].
  explicit RunClock(double limit, double spent = 0) : spent_(spent), limit_(limit) {}

  double seconds() const;  // since the run began, and what was spent before
  bool limited() const { return limit_ > 0; }
  void enter(RunPart part) { part_ = part; }
  // Seconds that the present part may still take; infinite without a limit.
  double left(const PartSeconds& wanted) const;

 private:
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double spent_ = 0, limit_ = 0;
  RunPart part_ = RunPart::Search;
};

}  // namespace papilla::search
