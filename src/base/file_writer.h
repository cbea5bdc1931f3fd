// A file written piece by piece: whole or not at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "base/rooms.h"

namespace papilla::base {

// Writes beside the final name; commit() reads the file back, compares it with what was appended,
// flushes it to disk and gives it its name. Without commit() the old file stays. Throws InputError.
class FileWriter {
 public:
  explicit FileWriter(std::string path);
  ~FileWriter();
  FileWriter(const FileWriter&) = delete;
  FileWriter& operator=(const FileWriter&) = delete;

  void append(const void* bytes, std::size_t size);
  void append(const std::string& bytes) { append(bytes.data(), bytes.size()); }
  void commit();

 private:
  [[noreturn]] void fail(const char* what) const;  // by errno

  std::string path_, part_;
  int fd_ = -1;
  std::uint64_t size_ = 0, sum_ = 0;
};

}  // namespace papilla::base
