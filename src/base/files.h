// Files written whole or not at all, and read where they are regular ones: a pipe would wait for
// ever, a device never end.
#pragma once

#include <cstddef>
#include <fstream>
#include <string>
#include <string_view>

#include "base/folder.h"
#include "base/rooms.h"

namespace papilla::base {

// The end of a chain of links, which need not be there yet: where a file goes whose path the user
// gave. Other names are the program's own, and links of those names are replaced. Throws InputError
// for links that lead nowhere.
std::string end_of_links(const std::string& path);

// Writes bytes atomically (PartFile of file_writer.h). Throws InputError.
void write_bytes(const std::string& path, std::string_view bytes);

// Throws InputError when there is no such file, when it is no regular one, or larger than the
// limit.
std::string read_bytes(const std::string& path, std::size_t limit = std::size_t{1} << 31);
std::string read_bytes(const Handle& file, const std::string& path, std::size_t limit);
// To read piece by piece. Throws InputError.
std::ifstream open_regular(const std::string& path);
// For who opens by names. Throws InputError.
void require_regular(const std::string& path);
void require_regular(const Handle& file, const std::string& path);

}  // namespace papilla::base
