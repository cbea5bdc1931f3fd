// From what belief says now to the batch to measure.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "lab/lab.h"

namespace papilla::lab {

// numbered: experiments of earlier plans, as many ids are taken.
PlanRecord plan_batch(const Standing& standing, const ResponseTable& table,
                      const std::vector<Experiment>& experiments, const LabFile& file,
                      const NextOptions& options, std::size_t numbered);

}  // namespace papilla::lab
