// The M3 paper's figures as tables.
#pragma once

#include <string>

#include "base/rooms.h"
#include "claims/figures.h"

namespace papilla::report {

// One line per surface, humidity and preset, each number with its standard error and its limits.
std::string figures_csv(const FigureTables& tables);
// A table per quantity and the printed numbers with the model's deviation.
std::string figures_markdown(const FigureTables& tables, const std::string& finger);

}  // namespace papilla::report
