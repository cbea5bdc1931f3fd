// A folder of its own below the system's temporary one, gone at its end with all it holds.
#pragma once

#include <string>

#include "base/rooms.h"

namespace papilla::base {

class ScratchFolder {
 public:
  // Throws InputError where none can be made.
  explicit ScratchFolder(const std::string& what = "work");
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string file(const char* name) const { return path_ + "/" + name; }

 private:
  std::string path_;
};

}  // namespace papilla::base
