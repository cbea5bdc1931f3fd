#include "search/clock.h"

#include <algorithm>
#include <numeric>

#include "base/constants.h"

namespace papilla::search {
namespace {

// Of the limit, part by part: half is the search's.
constexpr PartSeconds kShares{0.50, 0.12, 0.16, 0.03, 0.06, 0.03, 0.04, 0.02, 0.04};

}  // namespace

double part_deadline(double limit, double begin, Part part, const PartSeconds& wanted) {
  const auto at = static_cast<std::ptrdiff_t>(part);
  const double shares = std::accumulate(kShares.begin() + at, kShares.end(), 0.0);
  const double later = std::accumulate(wanted.begin() + at + 1, wanted.end(), 0.0);
  const double share = kShares[static_cast<std::size_t>(at)] / shares;
  return std::max(begin + share * (limit - begin), limit - later);
}

double RunClock::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void RunClock::enter(Part part) {
  part_ = part;
  entered_ = seconds();
}

double RunClock::left(const PartSeconds& wanted) const {
  return limited() ? part_deadline(limit_, entered_, part_, wanted) - seconds() : kInfinity;
}

}  // namespace papilla::search
