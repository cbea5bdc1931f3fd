// The parts that pages share, embedded at build time: the files of src/report/page/plots (ES
// modules), the style, and the two libraries that they draw with.
#pragma once

#include <string_view>

#include "base/rooms.h"

namespace papilla::report {

extern const std::string_view kLookModule, kNumbersModule, kTablesModule, kMapsModule,
    kChartsModule, kDimensionsModule, kCurvesModule, kFoundModule, kParallelModule, kSolidModule;
extern const std::string_view kPageStyle, kChartScript, kThreeScript;

}  // namespace papilla::report
