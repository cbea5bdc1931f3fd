// A mean-field case for people and programs: area, gap, pull and friction of a rough skin.
#pragma once

#include <string>

#include "base/rooms.h"
#include "cases/persson.h"

namespace papilla::report {

// seconds: what the solution took.
std::string mean_field_text(const MeanFieldCase& c, const MeanFieldResult& result, double seconds);
std::string mean_field_json(const MeanFieldCase& c, const MeanFieldResult& result,
                            double seconds);  // schema 1, SI

}  // namespace papilla::report
