// Statistics of a stated spectrum in contact for people and programs.
#pragma once

#include <string>

#include "base/rooms.h"
#include "cases/contact_statistics.h"

namespace papilla::report {

// seconds: what the solution took.
std::string statistics_text(const StatisticsCase& c, const StatisticsResult& result,
                            double seconds);
std::string statistics_json(const StatisticsCase& c, const StatisticsResult& result,
                            double seconds);  // schema 1, SI
// One line a bin: pressure, gap or pressure there, its density and that one's standard error, SI;
// of one surface that is empty.
std::string gap_distribution_csv(const StatisticsResult& result);
std::string stress_distribution_csv(const StatisticsResult& result);

}  // namespace papilla::report
