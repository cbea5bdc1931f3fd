// A journal by its path, as tests name their files.
#pragma once

#include <filesystem>
#include <string>

#include "base/rooms.h"
#include "optim/journal.h"

namespace papilla::tests {

inline Journal journal_at(const std::filesystem::path& path, const std::string& key, bool resume) {
  return Journal(Folder(path.parent_path()), path.filename(), key, resume);
}

}  // namespace papilla::tests
