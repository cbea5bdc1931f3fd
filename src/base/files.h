// Files written whole or not at all.
#pragma once

#include <cstddef>
#include <string>

#include "base/rooms.h"

namespace papilla::base {

// Where a file of this name is written beside and renamed to: a link's target. Throws InputError
// for what a rename would destroy: a device, a pipe, a folder.
std::string replaceable(const std::string& path);

// "cannot write PATH: WHY": FailedWrite where errno says that the disk is full or fails, InputError
// for a place that cannot be written to.
[[noreturn]] void cannot_write(const std::string& path, const std::string& why, int error);

// Writes bytes atomically: temporary file beside it, flushed to disk, renamed. Throws InputError.
void write_bytes(const std::string& path, const std::string& bytes);
// Throws InputError when there is no such file or it is larger than the limit.
std::string read_bytes(const std::string& path, std::size_t limit = std::size_t{1} << 31);

}  // namespace papilla::base
