// Files written whole or not at all, and read where they are regular ones: a pipe would wait for
// ever, a device never end.
#pragma once

#include <cstddef>
#include <cstdint>
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
// Throws InputError.
void require_regular(const Handle& file, const std::string& path);

// A regular file that is held open, so that a library which opens by names opens this one, whatever
// its path means by then. Throws InputError where there is none.
class RegularFile {
 public:
  explicit RegularFile(const std::string& path);

  const std::string& path() const { return path_; }
  std::string name() const;  // for as long as this lives
  std::uint64_t bytes() const { return bytes_; }
  std::ifstream stream() const;  // outlives this; to read piece by piece

 private:
  std::string path_;
  Handle handle_;
  std::uint64_t bytes_ = 0;
};

}  // namespace papilla::base
