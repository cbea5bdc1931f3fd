// Recordings: tables of numbers over time.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "physics/drive/signal.h"

namespace papilla::cases {

// The numbers of each line between commas, all lines alike; a head that has the word is skipped.
// Throws InputError naming `name`, the line and what was expected there.
std::vector<std::vector<double>> number_rows(const std::string& csv, const std::string& name,
                                             const std::string& word, const std::string& expected);

// The even step of a first column of times [s]. Throws InputError where it is uneven.
double even_step(const std::vector<std::vector<double>>& rows, const std::string& name);

// "time,value" as one period, straight between the lines: a power of two of samples.
Signal recorded_signal(const std::string& csv, const std::string& name);

}  // namespace papilla::cases
