// The folder of a run while it is worked in.
#pragma once

#include <string>

namespace papilla {

// Refuses a second run in the same folder while this one lives (released by the system when the
// process ends, however it ends). Throws InputError.
class FolderLock {
 public:
  explicit FolderLock(const std::string& folder);  // makes the folder
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int file_ = -1;
};

// "texture.depth \"350 nm\", \"400 nm\"": what two resolved files say otherwise, three at most.
// Without the keys that a run may be continued with.
std::string differing_keys(const std::string& there, const std::string& here);

}  // namespace papilla
