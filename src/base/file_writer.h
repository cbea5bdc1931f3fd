// A file written piece by piece: whole or not at all. Every file of the program is written so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/folder.h"
#include "base/rooms.h"

namespace papilla::base {

// The file beside its final name until it is put there: under a name that nobody guesses, new, and
// never behind a link. It has the mode of the file that it replaces; of a new one the mask of the
// process decides. A link of the final name is replaced, not followed. What a killed process left
// of the same file goes when the next one begins. Throws FailedWrite where the disk takes no more,
// InputError for a place that cannot be written to: also for a folder, a device or a pipe of the
// name, which a rename would destroy.
class PartFile {
 public:
  explicit PartFile(const std::string& path);
  // mode: of a new one, less the mask.
  PartFile(const Folder& folder, std::string_view name, unsigned mode = 0666);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  int handle() const { return file_.get(); }
  // For libraries that open by names: it has the ending of the final one.
  std::string path() const;
  // Flushed to disk, named, and its folder flushed.
  void put();
  // "cannot write PATH: WHY", a FailedWrite; "cannot write PATH: ... (AT)", one by errno.
  [[noreturn]] void fail(const std::string& why) const;
  [[noreturn]] void fail_by_errno(const char* at) const;

 private:
  [[noreturn]] void refuse(const std::string& why) const;  // of the place
  void create(unsigned mode);
  void clear_left_over() const;

  std::string final_path_, folder_path_, name_, part_;
  std::optional<unsigned> kept_mode_;  // of the file that is replaced
  Handle folder_, file_;
};

// commit() reads the file back and compares it with what was appended before it is put to its name.
// Without commit() the old file stays.
class FileWriter {
 public:
  explicit FileWriter(const std::string& path) : part_(path) {}
  FileWriter(const Folder& folder, std::string_view name, unsigned mode = 0666)
      : part_(folder, name, mode) {}

  void append(const void* bytes, std::size_t size);
  void append(std::string_view bytes) { append(bytes.data(), bytes.size()); }
  void commit();

 private:
  PartFile part_;
  std::uint64_t size_ = 0, sum_ = 0;
};

}  // namespace papilla::base
