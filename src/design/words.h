// Words of the field for keys that have another name here: `voltage` is drive.amplitude.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::design {

struct Word {
  std::string word, key;  // "voltage", "drive.amplitude"
};
const std::vector<Word>& words();

// The key that a word in a section stands for, of this section before others; "" where none does.
std::string key_for_word(const std::string& word, const std::string& section);

}  // namespace papilla::design
