// The reference of every key, generated from the fields() lists (`papilla describe`,
// docs/reference).
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::report {

// "texture", "surface", "finger", "environment", "drive", "model", "accuracy", "study", "metrics",
// "persson", "circuit", "export", "wafer".
std::vector<std::string> reference_sections();

enum class ReferenceFormat { Text, Markdown };

// A section, or one key of it: "texture.depth". Throws InputError, with a "did you mean", for an
// unknown one.
std::string reference_section(const std::string& section, ReferenceFormat format);

// {"schema": 1, "sections": [{"section", "about", "tables": [{"name", "keys": [...]}]}]}
std::string reference_json(const std::vector<std::string>& sections);

}  // namespace papilla::report
