// A test wafer for people and programs: what stands where, its masks, what the process leaves.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "fabricate/wafer_files.h"

namespace papilla::report {

// The fields as a map, each with its id and design, repeats of one design in one colour.
std::string wafer_svg(const WaferPlan& plan);

// Files, fields, masks, notes, and a line for each array: made beside wanted.
std::string wafer_text(const WaferPlan& plan, const WaferDrawing& drawing,
                       const std::vector<std::string>& files, const std::vector<WaferMade>& made);
// Schema 1, SI.
std::string wafer_json(const WaferPlan& plan, const WaferDrawing& drawing,
                       const std::vector<std::string>& files, const std::vector<WaferMade>& made);

// What the process leaves otherwise than wanted, a line each: "D01: width ...".
std::vector<std::string> left_lines(const std::vector<WaferMade>& made);

std::string wafer_verdict_text(const WaferVerdict& verdict);
std::string wafer_verdict_json(const std::string& folder, const WaferVerdict& verdict);

}  // namespace papilla::report
