// Files that tests write. Folders run side by side, each in a process of its own: a name below the
// common temporary folder would be shared by all that write it.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>

#include "base/rooms.h"

namespace papilla::tests {

// A folder that nobody else has, removed with all it holds.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = std::filesystem::temp_directory_path() / ("papilla-" + std::string(6, 'X'));
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder " + name);
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// A path in the folder of this process.
inline std::string temporary(const std::string& name) {
  static const TemporaryFolder folder;
  return folder.path() / name;
}

}  // namespace papilla::tests
