#include "base/file_writer.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "base/check.h"
#include "base/error.h"

namespace papilla::base {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kRandomDigits = 16;

std::string random_digits() {
  std::uint64_t number = 0;
  PAPILLA_CHECK(::getrandom(&number, sizeof number, 0) == sizeof number, "random bytes");
  return fmt::format("{:016x}", number);
}

// A part is called BEFORE + digits + AFTER.
struct PartName {
  std::string before, after;

  // Names may be as long as the file system takes them.
  explicit PartName(const fs::path& final)
      : before(fmt::format(".{:.40}.", final.stem().string())),
        after(fmt::format(".part{:.8}", final.extension().string())) {}
  bool fits(std::string_view name) const {
    if (name.size() != before.size() + kRandomDigits + after.size()) return false;
    const std::string_view digits = name.substr(before.size(), kRandomDigits);
    return name.starts_with(before) && name.ends_with(after) &&
           digits.find_first_not_of("0123456789abcdef") == std::string_view::npos;
  }
};

// FNV-1a: it does not matter where the pieces are cut.
std::uint64_t check_sum(std::uint64_t sum, const char* bytes, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i)
    sum = (sum ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3u;
  return sum;
}

// A folder that may be written to but not listed can be used, not flushed.
Handle open_folder(int at, const char* path) {
  Handle out(::openat(at, path, O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!out && errno == EACCES) out = Handle(::openat(at, path, O_PATH | O_DIRECTORY | O_CLOEXEC));
  return out;
}

}  // namespace

PartFile::PartFile(const std::string& path) : final_path_(path) {
  const fs::path whole(path);
  folder_path_ = whole.has_parent_path() ? whole.parent_path().string() : ".";
  name_ = whole.filename().string();
  folder_ = open_folder(AT_FDCWD, folder_path_.c_str());
  if (!folder_) fail_by_errno("open");
  create(0666);
}

PartFile::PartFile(const Folder& folder, std::string_view name, unsigned mode)
    : final_path_(folder.path(name)) {
  const std::size_t last = name.rfind('/');
  const Folder holder =
      last == std::string_view::npos ? folder : folder.below(name.substr(0, last));
  folder_path_ = holder.path();
  name_ = name.substr(last == std::string_view::npos ? 0 : last + 1);
  folder_ = open_folder(holder.handle(), ".");
  if (!folder_) fail_by_errno("open");
  create(mode);
}

PartFile::~PartFile() {
  if (file_) ::unlinkat(folder_.get(), part_.c_str(), 0);
}

std::string PartFile::path() const { return folder_path_ + "/" + part_; }

void PartFile::refuse(const std::string& why) const {
  throw InputError("cannot write " + final_path_ + ": " + why);
}

void PartFile::fail(const std::string& why) const {
  throw FailedWrite("cannot write " + final_path_ + ": " + why);
}

void PartFile::fail_by_errno(const char* at) const {
  const int error = errno;
  const std::string why = fmt::format("{} ({})", std::strerror(error), at);
  if (error == ENOSPC || error == EDQUOT || error == EFBIG || error == EIO) fail(why);
  refuse(why);
}

void PartFile::create(unsigned mode) {
  struct stat there {};
  const bool replaces = ::fstatat(folder_.get(), name_.empty() ? "." : name_.c_str(), &there,
                                  AT_SYMLINK_NOFOLLOW) == 0;
  if (replaces && !S_ISREG(there.st_mode) && !S_ISLNK(there.st_mode)) {
    refuse(S_ISDIR(there.st_mode) ? "it is a folder; give the path of a file"
                                  : "it is no regular file; give the path of a file");
  }
  clear_left_over();
  if (replaces && S_ISREG(there.st_mode)) {
    kept_mode_ = there.st_mode & 0777;
    mode = 0600;  // until it is put: a file may be read only, and is written by its name too
  }
  const PartName name{fs::path(name_)};
  // Somebody who begins at the same time may take a file that is not locked yet for a left-over.
  struct stat own {};
  do {
    part_ = name.before + random_digits() + name.after;
    file_ = Handle(::openat(folder_.get(), part_.c_str(),
                            O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, mode));
    if (!file_) fail_by_errno("open");
    ::flock(file_.get(), LOCK_EX | LOCK_NB);
    if (::fstat(file_.get(), &own) != 0) fail_by_errno("open");
  } while (own.st_nlink == 0);
}

// Who writes holds a lock on its part, which goes with the process.
void PartFile::clear_left_over() const {
  const int listed = ::openat(folder_.get(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  DIR* entries = listed < 0 ? nullptr : ::fdopendir(listed);
  if (!entries) return;
  const PartName name{fs::path(name_)};
  while (const dirent* entry = ::readdir(entries)) {
    if (!name.fits(entry->d_name)) continue;
    const Handle left(
        ::openat(folder_.get(), entry->d_name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    if (left && ::flock(left.get(), LOCK_EX | LOCK_NB) == 0)
      ::unlinkat(folder_.get(), entry->d_name, 0);
  }
  ::closedir(entries);
}

void PartFile::put() {
  struct stat own {
  }, named{};
  // A library may have written another file of the name.
  if (::fstat(file_.get(), &own) != 0) fail_by_errno("look");
  if (::fstatat(folder_.get(), part_.c_str(), &named, AT_SYMLINK_NOFOLLOW) != 0)
    fail_by_errno("rename");
  if (own.st_ino != named.st_ino || own.st_dev != named.st_dev) fail("another file took its place");
  if (kept_mode_ && ::fchmod(file_.get(), *kept_mode_) != 0) fail_by_errno("set the mode");
  if (::fsync(file_.get()) != 0) fail_by_errno("flush");
  if (::renameat(folder_.get(), part_.c_str(), folder_.get(), name_.c_str()) != 0)
    fail_by_errno("rename");
  file_ = Handle();
  // Not every file system can flush a folder; an error of one that can is told.
  if (::fsync(folder_.get()) != 0 && errno != EINVAL && errno != EBADF && errno != ENOTSUP)
    fail_by_errno("flush the folder");
}

void FileWriter::append(const void* bytes, std::size_t size) {
  const char* at = static_cast<const char*>(bytes);
  sum_ = check_sum(sum_, at, size);
  size_ += size;
  while (size > 0) {
    const ssize_t n = ::write(part_.handle(), at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) part_.fail_by_errno("write");
    at += n;
    size -= static_cast<std::size_t>(n);
  }
}

void FileWriter::commit() {
  std::vector<char> block(std::min<std::uint64_t>(size_, 1 << 20));
  std::uint64_t size = 0, sum = 0;
  while (size < size_) {
    const ssize_t n = ::pread(part_.handle(), block.data(), block.size(), static_cast<off_t>(size));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) part_.fail_by_errno("read back");
    if (n == 0) break;
    sum = check_sum(sum, block.data(), static_cast<std::size_t>(n));
    size += static_cast<std::size_t>(n);
  }
  if (size != size_ || sum != sum_) part_.fail("reads back with other bytes");
  part_.put();
}

}  // namespace papilla::base
