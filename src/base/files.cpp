#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "base/error.h"

namespace papilla {

void write_bytes(const std::string& path, const std::string& bytes) {
  const std::string part = path + ".part";
  const int fd = ::open(part.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  const auto fail = [&](const char* what) {
    const int code = errno;
    if (fd >= 0) ::close(fd);
    ::unlink(part.c_str());
    throw InputError(fmt::format("cannot write {}: {} ({})", path, std::strerror(code), what));
  };
  if (fd < 0) fail("open");
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(fd, bytes.data() + done, bytes.size() - done);
    if (n < 0) {
      if (errno == EINTR) continue;
      fail("write");
    }
    done += static_cast<std::size_t>(n);
  }
  if (::fsync(fd) != 0) fail("flush");
  if (::close(fd) != 0) {
    const int code = errno;
    ::unlink(part.c_str());
    throw InputError(fmt::format("cannot write {}: {} (close)", path, std::strerror(code)));
  }
  if (std::rename(part.c_str(), path.c_str()) != 0) {
    const int code = errno;
    ::unlink(part.c_str());
    throw InputError(fmt::format("cannot write {}: {} (rename)", path, std::strerror(code)));
  }
}

std::string read_bytes(const std::string& path, std::size_t limit) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error))
    throw InputError("cannot read " + path + ": no such file");
  const auto size = std::filesystem::file_size(path, error);
  if (error || size > limit)
    throw InputError(
        fmt::format("cannot read {}: {} bytes are more than the limit of {}", path, size, limit));
  std::ifstream in(path, std::ios::binary);
  std::string bytes(size, '\0');
  if (!in.read(bytes.data(), static_cast<std::streamsize>(size)))
    throw InputError("cannot read " + path);
  return bytes;
}

}  // namespace papilla
