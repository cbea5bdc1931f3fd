#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "base/error.h"
#include "base/file_writer.h"

namespace papilla::base {

namespace {

[[noreturn]] void unreadable(const std::string& path, const std::string& why) {
  throw InputError("cannot read " + path + ": " + why);
}

// At once, whatever is there: without O_NONBLOCK a pipe would wait for somebody to write.
Handle opened(const std::string& path) {
  Handle out(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  if (!out && errno == ENXIO) unreadable(path, "not a file");  // a socket
  if (!out) unreadable(path, errno == ENOENT ? "no such file" : std::strerror(errno));
  return out;
}

std::uint64_t regular_size(const Handle& file, const std::string& path) {
  struct stat there {};
  if (::fstat(file.get(), &there) != 0) unreadable(path, std::strerror(errno));
  if (!S_ISREG(there.st_mode)) unreadable(path, "not a file");
  return static_cast<std::uint64_t>(there.st_size);
}

}  // namespace

std::string end_of_links(const std::string& path) {
  namespace fs = std::filesystem;
  constexpr int kMostLinks = 40;
  std::error_code error;
  fs::path target = path;
  for (int k = 0; fs::is_symlink(fs::symlink_status(target, error)); ++k) {
    const fs::path next = fs::read_symlink(target, error);
    if (error || k == kMostLinks) {
      throw InputError("cannot write " + path +
                       ": its links lead nowhere; give the path of a file");
    }
    target = target.parent_path() / next;
  }
  return target.string();
}

void write_bytes(const std::string& path, std::string_view bytes) {
  FileWriter out(path);
  out.append(bytes);
  out.commit();
}

void require_regular(const Handle& file, const std::string& path) { regular_size(file, path); }

RegularFile::RegularFile(const std::string& path)
    : path_(path), handle_(opened(path)), bytes_(regular_size(handle_, path)) {}

std::string RegularFile::name() const { return fmt::format("/proc/self/fd/{}", handle_.get()); }

std::ifstream RegularFile::stream() const {
  std::ifstream out(name(), std::ios::binary);
  if (!out) unreadable(path_, "it does not open");
  return out;
}

std::string read_bytes(const Handle& file, const std::string& path, std::size_t limit) {
  const auto size = static_cast<std::size_t>(regular_size(file, path));
  if (size > limit)
    unreadable(path, fmt::format("{} bytes are more than the limit of {}", size, limit));
  std::string bytes(size, '\0');
  std::size_t done = 0;
  while (done < size) {
    const ssize_t n = ::read(file.get(), bytes.data() + done, size - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) unreadable(path, std::strerror(errno));
    if (n == 0) unreadable(path, "it became shorter meanwhile");
    done += static_cast<std::size_t>(n);
  }
  return bytes;
}

std::string read_bytes(const std::string& path, std::size_t limit) {
  return read_bytes(opened(path), path, limit);
}

}  // namespace papilla::base
