// The files of the project, for tests that look at them.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/rooms.h"

namespace papilla::tests {

inline std::string read_source(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream buffer;
  buffer << stream.rdbuf();
  return buffer.str();
}

// Paths relative to the source tree, sorted, with one of the extensions.
inline std::vector<std::string> source_files(const std::vector<std::string>& folders,
                                             const std::vector<std::string>& extensions) {
  namespace fs = std::filesystem;
  const fs::path top = PAPILLA_SOURCE_DIR;
  std::vector<std::string> out;
  for (const std::string& folder : folders) {
    if (!fs::exists(top / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(top / folder)) {
      const std::string extension = entry.path().extension().string();
      for (const std::string& wanted : extensions) {
        if (entry.is_regular_file() && extension == wanted) {
          out.push_back(fs::relative(entry.path(), top).string());
        }
      }
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

// What a file includes: the bracket or quotation mark before each name, and the name.
inline std::vector<std::pair<char, std::string>> includes_of(const std::string& text) {
  constexpr std::string_view directive = "#include ";
  std::vector<std::pair<char, std::string>> out;
  for (std::size_t at = text.find(directive); at != std::string::npos;
       at = text.find(directive, at)) {
    at += directive.size();
    const char opening = at < text.size() ? text[at] : ' ';
    if (opening != '<' && opening != '"') continue;
    const std::size_t end = text.find(opening == '<' ? '>' : '"', at + 1);
    if (end == std::string::npos) break;
    out.emplace_back(opening, text.substr(at + 1, end - at - 1));
  }
  return out;
}

// The pieces of a text between ; { and } that hold a word of each list. A pattern that matches none
// of the three and needs such words finds there what it finds in the text, in a hundredth of the
// time.
inline std::vector<std::string> statements_with(
    const std::string& text, const std::vector<std::vector<std::string_view>>& lists) {
  std::vector<std::string> out;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(";{}", at), text.size());
    const std::string_view statement = std::string_view(text).substr(at, end - at);
    const bool holds = std::all_of(lists.begin(), lists.end(), [&](const auto& words) {
      return std::any_of(words.begin(), words.end(), [&](std::string_view word) {
        return statement.find(word) != std::string_view::npos;
      });
    });
    if (holds) out.emplace_back(statement);
    at = end + 1;
  }
  return out;
}

}  // namespace papilla::tests
