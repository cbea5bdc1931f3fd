// A drive case for people and programs: forces over time and frequency, and what limits the drive.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "cases/drive.h"

namespace papilla::report {

std::string drive_text(const DriveCase& c, const DriveResult& result);
std::string drive_json(const DriveCase& c, const DriveResult& result,
                       const std::vector<Swipe>& swipes = {});  // schema 1, SI
std::string swipe_text(const Swipe& swipe);
std::string swipe_csv(const Swipe& swipe);  // time, place, lateral force, state, current

// Columns t, source voltage, current, gap voltage, pull, friction; frequency, amplitude.
std::string drive_series_csv(const DriveResult& result);
std::string drive_lines_csv(const DriveResult& result);
// Friction over time and its spectrum as a picture.
std::string drive_svg(const DriveCase& c, const DriveResult& result);

}  // namespace papilla::report
