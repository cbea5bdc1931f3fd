// Words for people: nearest name, joined lists.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/rooms.h"

namespace papilla::base {

// The known name nearest to `name` by edit distance, or "" when none is near.
std::string nearest_name(std::string_view name, const std::vector<std::string>& known);
// Parts between separators, blanks at their ends removed: "a, b" -> {"a", "b"}.
std::vector<std::string> split(std::string_view text, char separator);
// "1 evaluation", "2 evaluations".
std::string counted(long long count, std::string_view noun);
// "0.612"; a zero has no sign: never "-0.000".
std::string fixed(double value, int digits);
// So many digits, without an exponent where people write none: "1670", never "1.67e+03".
std::string significant(double value, int digits);
// "640 ± 130": both as far as the second digit of the error.
std::string with_error(double value, double error);
// No byte of it is anything else; names of files may be.
bool is_utf8(std::string_view text);
// As a terminal may be shown it: control characters but line ends and tabs, and bytes that are no
// UTF-8, stand as "\\x1b". What a stranger wrote would else move the cursor, or colour a lie.
std::string visible(std::string_view text);
std::string join_names(const std::vector<std::string>& names, std::string_view separator = ", ");

// Columns on a terminal, of UTF-8 text.
std::size_t text_width(std::string_view text);
// Lines of a table, columns two blanks apart and as wide as their widest cell; the first `left`
// columns begin at the left, the others end at the right.
std::string aligned_table(const std::vector<std::vector<std::string>>& rows, std::size_t left);
// A Markdown text with the columns of its tables aligned.
std::string aligned_markdown(const std::string& text);

}  // namespace papilla::base
