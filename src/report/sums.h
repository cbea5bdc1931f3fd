// The sums of what a run wrote: whoever reads its folder later sees what is not as the run left it.
#pragma once

#include <string>
#include <vector>

#include "base/folder.h"
#include "base/rooms.h"

namespace papilla::report {

inline constexpr const char* kSumsName = "SHA256SUMS";

// Of every file of the folder, and of those in it, that one run alone decides: not the page, nor
// what grows and what holds clock times. As `sha256sum -c` takes them.
void write_sums(const Folder& folder);

// Files that are not as they were summed, or are not there any more; empty where all are, or where
// the folder has no sums (of an earlier version).
std::vector<std::string> changed_files(const Folder& folder);

// All files of a folder, and of those in it, that its page lists: sorted, without hidden ones.
std::vector<std::string> lasting_files(const Folder& folder);

}  // namespace papilla::report
