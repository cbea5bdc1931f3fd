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
// " But on natural skin ...": that nobody feels it on skin of the other state, where that was
// tried; "" otherwise.
std::string unfelt_skin_text(const ResultFiles& files);
// "200 V (peak) at 5 kHz", of what is built; where the voltage is found, what it is; "" of a
// surface without a drive.
std::string drive_text(const ResultFiles& files);
// The least relative difference of friction that people notice, as a stated number.
std::string noticed_text();
// A worst modulation as a stated number. of: the design, in words.
std::string worst_text(const std::string& of, double worst);

}  // namespace papilla::report
