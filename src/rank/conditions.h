// Whether candidates are judged under the same conditions: finger, air, model, accuracy, drive,
// view.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "rank/options.h"

namespace papilla::rank {

// A key that is no part of a candidate but of what it is judged under, and that differs.
struct ConditionDifference {
  std::string key;                        // "finger.load"
  std::string first, value, other_value;  // name and value of the first candidate; of another
  std::string other;

  std::string text() const;  // "finger.load: 0.3 N in mine, 0.2 N in flat"
};

// What the criteria depend on besides texture, surface and dielectric: finger and air, model and
// accuracy where something is felt; the drive where a criterion needs one; the view where one is
// looked at. The finger's state is that of the options. Only the first difference in each key.
std::vector<ConditionDifference> condition_differences(const std::vector<Regions>& candidates,
                                                       const RankOptions& options);

// Throws InputError, with what would make them equal, unless there are none.
void require_same_conditions(const std::vector<ConditionDifference>& differences);

// The state that the fingers of all candidates are in (finger.state): where no other is asked for
// they are judged in it. Of pins alone, which have none, clean. Throws InputError where they are in
// different ones.
FingerState common_state(const std::vector<Regions>& candidates);

}  // namespace papilla::rank
