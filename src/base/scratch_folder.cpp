#include "base/scratch_folder.h"

#include <cstdlib>
#include <filesystem>

#include "base/error.h"

namespace papilla::base {

namespace fs = std::filesystem;

ScratchFolder::ScratchFolder(const std::string& what) {
  path_ = (fs::temp_directory_path() / ("papilla-" + what + "-" + std::string(6, 'X'))).string();
  if (::mkdtemp(path_.data()) == nullptr)
    throw InputError("cannot make a temporary folder " + path_);
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace papilla::base
