// One writer of a set of files at a time, without a file of its own in their folder.
#pragma once

#include <string>
#include <string_view>

#include "base/folder.h"
#include "base/rooms.h"

namespace papilla::base {

// While one lives, a second one for the folder is refused, in this process or another: throws
// InputError, "FOLDER: WHO in this folder". Released by the system when the process ends. Where the
// file system has no such locks nobody is refused.
class SoleWriter {
 public:
  SoleWriter(const Folder& folder, std::string_view who);

 private:
  Handle folder_;
};

}  // namespace papilla::base
