// Words for people: nearest name, joined lists.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace papilla {

// The known name nearest to `name` by edit distance, or "" when none is near.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);
// Parts between separators, blanks at their ends removed: "a, b" -> {"a", "b"}.
std::vector<std::string> split(std::string_view text, char separator);
std::string join_names(const std::vector<std::string>& names, std::string_view separator = ", ");

}  // namespace papilla
