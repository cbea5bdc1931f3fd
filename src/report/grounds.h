// What a recommendation rests on.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

// In sentences: fingers and humidities, what is in no ±, a worst case that nobody feels, how it
// looks.
std::vector<std::string> grounds(const ResultFiles& files);
// A worst modulation as a stated number. of: the design, in words.
std::string worst_text(const std::string& of, double worst);

}  // namespace papilla::report
