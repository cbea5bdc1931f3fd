#include "search/clock.h"

#include <algorithm>

#include "base/constants.h"

namespace papilla::search {
namespace {

// Of the limit, part by part: half is the search's where there is no belief.
constexpr PartSeconds kShares{0.40, 0.12, 0.16, 0.10, 0.03, 0.06, 0.03, 0.04, 0.02, 0.04};

}  // namespace

double part_share(RunPart part) { return kShares[static_cast<std::size_t>(part)]; }

double part_deadline(double limit, RunPart part, const PartSeconds& wanted) {
  double out = limit;
  for (std::size_t later = static_cast<std::size_t>(part) + 1; later < kParts; ++later)
    out -= std::min(wanted[later], kShares[later] * limit);
  return out;
}

double RunClock::seconds() const {
  return spent_ + std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

double RunClock::left(const PartSeconds& wanted) const {
  return limited() ? part_deadline(limit_, part_, wanted) - seconds() : kInfinity;
}

}  // namespace papilla::search
