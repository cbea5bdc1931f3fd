// Folders and the files in them by the system's handles. What lies in a folder may be a stranger's:
// no link below it is followed, neither to read nor to write. Links that lead to it are the user's.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/rooms.h"

namespace papilla::base {

// A handle, closed at its end.
class Handle {
 public:
  explicit Handle(int fd = -1) : fd_(fd) {}
  ~Handle();
  Handle(Handle&& other) noexcept;
  Handle& operator=(Handle&& other) noexcept;

  int get() const { return fd_; }
  explicit operator bool() const { return fd_ >= 0; }

 private:
  int fd_;
};

// Names below a folder are relative, "front/01/design.toml", without "..".
class Folder {
 public:
  // Throws InputError where there is none.
  explicit Folder(const std::string& path);
  // Made, with those above it, where there is none.
  static Folder made(const std::string& path);

  // A folder below it. Throws InputError where there is none, or a link.
  Folder below(std::string_view name) const;
  Folder made_below(std::string_view name) const;

  // A regular file; nothing else counts.
  bool has(std::string_view name) const;
  bool has_folder(std::string_view name) const;
  // Its path, for who reads by names. Throws InputError for no regular file, or one behind a link.
  std::string file(std::string_view name) const;
  std::string read(std::string_view name, std::size_t limit = std::size_t{1} << 31) const;
  // From a place on; nothing where it is shorter.
  std::string read_from(std::string_view name, std::size_t from) const;
  // Whole or not at all; a link of this name is replaced, not followed.
  void write(std::string_view name, std::string_view bytes) const;
  // The same for its owner's eyes alone.
  void write_secret(std::string_view name, std::string_view bytes) const;
  // A file to write into from its beginning or its end on: no link, a regular file. For journals.
  Handle open_to_write(std::string_view name) const;
  // A folder with all it holds, or a file; nothing where there is none.
  void remove(std::string_view name) const;
  // Of its regular files and its folders, sorted.
  std::vector<std::string> files() const, folders() const;

  const std::string& path() const { return path_; }
  std::string path(std::string_view name) const;  // for messages
  int handle() const { return handle_->get(); }

 private:
  Folder(std::string path, Handle handle);
  // The folder that the last part of a name lies in; null where there is none.
  std::shared_ptr<const Handle> holder(std::string_view name) const;
  Handle opened(std::string_view name) const;
  std::vector<std::string> entries(unsigned kind) const;

  std::string path_;
  std::shared_ptr<const Handle> handle_;
};

// Refuses a second owner of a folder while this one lives; released by the system when the process
// ends, however it ends. Throws InputError: "FOLDER: WHO in this folder".
class FolderLock {
 public:
  FolderLock(const Folder& folder, std::string_view name, std::string_view who);

 private:
  Handle file_;
};

}  // namespace papilla::base
