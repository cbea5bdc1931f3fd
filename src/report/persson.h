// A mean-field case for people and programs: area, gap, pull and friction of a rough skin.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "cases/persson.h"

namespace papilla::report {

// seconds: what the solution took.
std::string mean_field_text(const MeanFieldCase& c, const MeanFieldResult& result, double seconds);
std::string mean_field_json(const MeanFieldCase& c, const MeanFieldResult& result,
                            double seconds);  // schema 1, SI

// As tables in SI, one line a point: voltage by load, and what the case's own point consists of.
std::string mean_field_grid_csv(const std::vector<MeanFieldPoint>& grid);
std::string roughness_csv(const MeanFieldCurves& curves);
std::string stress_csv(const MeanFieldCurves& curves);
std::string separation_csv(const MeanFieldCurves& curves);
std::string step_csv(const MeanFieldCurves& curves);

}  // namespace papilla::report
