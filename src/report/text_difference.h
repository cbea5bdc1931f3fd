// Where two texts say different numbers or words.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::report {

// A word of one text in place of one of another; at: where the other's begins.
struct WordDifference {
  std::size_t at = 0;
  std::string says, expected;
};

// Word by word where both have as many, else the first one that differs. Numbers that agree to
// kSameNumber are the same. most: of them.
std::vector<WordDifference> word_differences(const std::string& says, const std::string& expected,
                                             std::size_t most = 20);

// "line 12" of the place in a text.
std::string line_text(const std::string& text, std::size_t at);

}  // namespace papilla::report
