// The files of the project, for tests that look at them.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
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

}  // namespace papilla::tests
