// Evaluations over one number of a design: a line each while they come, or one document.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "forward/response.h"

namespace papilla::report {

// What the lines show of the appearance, where it was asked for.
std::string sweep_head(const std::string& path, bool appearance);
// value: as people write it, with its unit.
std::string sweep_line(const std::string& value, const Response& response);

struct SweepRun {
  double value = 0;  // SI
  Response response;
};
std::string sweep_json(const std::string& path, const std::vector<SweepRun>& runs);  // schema 1

}  // namespace papilla::report
