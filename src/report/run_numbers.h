// Claims about the designs of a run.
#pragma once

#include <string>

#include "base/rooms.h"
#include "report/stated_number.h"
#include "search/run.h"

namespace papilla::report {

// An objective of a confirmed design, in the unit that people read.
StatedNumber objective_number(const ResultFiles& files, const std::string& of, const Score& score,
                              std::size_t objective);
// Whether a number has an error to speak of: that of a look that nothing scatters is its last bits.
bool scatters(double value, double error);
// The same as a text: "0.612 ± 0.014 (0.051)", in brackets the model part; of what does not scatter
// the value alone.
std::string objective_text(const ResultFiles& files, const std::string& of, const Score& score,
                           std::size_t objective);
// A share with its standard error: "12.1 ± 0.4 %"; where that would pass 0 or 100 %, what it
// leaves: "60.4 to 100 %".
std::string share_text(double share, double error);
// What a design has more than another.
StatedNumber difference_number(const ResultFiles& files, const std::string& words,
                               const Score& design, const Score& other, std::size_t objective);
// Why a number has no bar.
constexpr const char* kChosen = "chosen: it is exact";
constexpr const char* kAsked = "an input";
constexpr const char* kOfAStep = "read off steps of one number at a time";
// A number that has no bar, and why.
StatedNumber bare_number(const std::string& words, double value, const std::string& unit,
                         const std::string& no_bar, std::vector<Stage> rests_on);
StatedNumber count_number(const std::string& words, std::size_t count, std::vector<Stage> rests_on);
// "207 nm": of so many digits in a unit.
std::string in_unit(double si, const std::string& unit, int digits);
// Two digits that are not beyond it: what was tried, or where a limit is reached.
std::string at_most(double si, const std::string& unit);
// A text with several numbers in it, or none: what it says as a whole.
StatedNumber whole_text(const std::string& words, const std::string& no_value,
                        std::vector<Stage> rests_on);

}  // namespace papilla::report
