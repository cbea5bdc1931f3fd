// Which experiment a told row or record is of: by the plan, the wafer's field, or design and
// conditions.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "lab/lab_file.h"
#include "lab/records.h"
#include "lab/response_table.h"
#include "lab/trace_reading.h"
#include "scene/measured_table.h"

namespace papilla::lab {

// What rows are held against. All outlive this.
struct MatchContext {
  const LabFile& file;
  const std::vector<LabDesign>& designs;
  const std::vector<PlannedExperiment>& planned;
};

// What the user says of a file as a whole; "": nothing.
struct TellOptions {
  std::string experiment, field, design, finger, day;
  std::string date;      // of today, "2026-03-01"; the day where nothing else says it
  bool replace = false;  // readings take the place of earlier ones that they contradict, and of
                         // what the same file was told as before
};

struct Matched {
  // In the order of the rows; the day "" where the row itself does not say it.
  std::vector<FrictionReading> readings;
  int empty = 0;  // rows that are not measured yet
  std::vector<std::string> notes;
};

// Throws InputError with every row that is of no known experiment, or could be of several, each
// with its line.
Matched match_table(const MeasuredTable& table, const MatchContext& context,
                    const TellOptions& options, const std::string& file);
Matched match_trace(const Trace& trace, const TraceReading& reading, const MatchContext& context,
                    const TellOptions& options, const std::string& file);

// The same reading as of another day, "": as if none were said. Its key follows.
FrictionReading as_of_day(FrictionReading reading, const std::string& day,
                          const std::vector<LabDesign>& designs);

}  // namespace papilla::lab
