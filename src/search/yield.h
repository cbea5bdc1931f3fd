// The yield of a design: the share of plates, as fabrication scatters them, that keep every limit
// of the study. Eq. search.19-20
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "base/rooms.h"
#include "search/constraints.h"

namespace papilla::search {

inline constexpr std::size_t kPlates = 10000, kFewPlates = 1000;
// Plates of a design: few below the confirmation, and where a limit is on the look, which takes a
// millisecond a plate.
std::size_t plates_of(const Study& study, bool confirmed);
// Processor time of the yields of a study [s], of so many designs below the confirmation and
// confirmed ones. looks: that are calculated of a plate, one in each scenario that shows another
// (StudyConstraints::looked_at); 0: they are known from evaluations.
double yield_price(const Study& study, std::size_t looks, std::size_t searched,
                   std::size_t confirmed);

struct Yield {
  YieldShare now;
  std::size_t plates = 0;
  std::vector<double> broken;      // share of plates that break each limit, as the study lists them
  double not_makeable = 0;         // share of plates whose shape cannot be made
  std::vector<YieldShare> halved;  // what half of each tolerance gains, in the order of the scatter

  // The tolerance that costs most; nothing where half of none gains more than its error.
  std::optional<std::size_t> costliest() const;
};

class YieldModel {
 public:
  // Refers to all of them.
  YieldModel(const Study& study, const StudyConstraints& constraints, const Scoring& scoring)
      : study_(study), constraints_(constraints), scoring_(scoring) {}

  // Numbers scatter, and there is a limit that they may break.
  static bool exists(const Study& study);
  // The score: of an evaluation that has not failed.
  YieldShare share(const Design& design, const Score& score, std::size_t plates) const;
  Yield yield(const Design& design, const Score& score, std::size_t plates) const;

 private:
  const Study& study_;
  const StudyConstraints& constraints_;
  const Scoring& scoring_;
};

}  // namespace papilla::search
