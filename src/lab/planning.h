// From what belief says now to the batch to measure.
#pragma once

#include <optional>
#include <vector>

#include "base/rooms.h"
#include "lab/lab.h"

namespace papilla::lab {

// numbered: experiments of earlier plans, as many ids are taken.
PlanRecord plan_batch(const Standing& standing, const ResponseTable& table,
                      const std::vector<Experiment>& experiments, const LabFile& file,
                      const NextOptions& options, std::size_t numbered);

// Why more experiments are not worth it, nothing where they are. `gain` has taken the batch. A
// batch of less than ten touches may change nothing where ten would: further touches are then taken
// into `gain`, which is of no use for the batch itself afterwards. small: a regret that is not
// worth measuring.
std::optional<StopReason> reason_to_stop(const std::vector<Candidate>& candidates,
                                         const Batch& batch, const Costs& costs, double small,
                                         DecisionGain& gain);

}  // namespace papilla::lab
