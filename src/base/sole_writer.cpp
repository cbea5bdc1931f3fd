#include "base/sole_writer.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>

#include <cerrno>

#include "base/error.h"

namespace papilla::base {

SoleWriter::SoleWriter(const Folder& folder, std::string_view who)
    : folder_(::openat(folder.handle(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (folder_ && ::flock(folder_.get(), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
    throw InputError(fmt::format("{}: {} in this folder", folder.path(), who));
}

}  // namespace papilla::base
