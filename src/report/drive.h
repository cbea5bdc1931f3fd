// A drive case for people and programs: forces over time and frequency, and what limits the drive.
#pragma once

#include <string>

#include "base/rooms.h"
#include "cases/drive.h"

namespace papilla::report {

std::string drive_text(const DriveCase& c, const DriveResult& result);
std::string drive_json(const DriveCase& c, const DriveResult& result);  // schema 1, SI
std::string swipe_text(const Swipe& swipe);

// Columns t, source voltage, current, gap voltage, pull, friction; frequency, amplitude.
std::string drive_series_csv(const DriveResult& result);
std::string drive_lines_csv(const DriveResult& result);
// Friction over time and its spectrum as a picture.
std::string drive_svg(const DriveCase& c, const DriveResult& result);

}  // namespace papilla::report
