#include "base/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/file_writer.h"

namespace papilla::base {

namespace {

// FNV-1a: it does not matter where the pieces are cut.
std::uint64_t check_sum(std::uint64_t sum, const char* bytes, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i)
    sum = (sum ^ static_cast<unsigned char>(bytes[i])) * 0x100000001b3u;
  return sum;
}

}  // namespace

std::string replaceable(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status there = fs::status(path, error);
  if (fs::exists(there) && !fs::is_regular_file(there)) {
    throw InputError("cannot write " + path + ": " +
                     (fs::is_directory(there) ? "it is a folder" : "it is no regular file") +
                     "; give the path of a file");
  }
  // The end of a chain of links, which need not be there yet.
  constexpr int kMostLinks = 40;
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

void cannot_write(const std::string& path, const std::string& why, int error) {
  const std::string text = "cannot write " + path + ": " + why;
  if (error == ENOSPC || error == EDQUOT || error == EFBIG || error == EIO) throw FailedWrite(text);
  throw InputError(text);
}

FileWriter::FileWriter(std::string path) : path_(replaceable(path)), part_(path_ + ".part") {
  fd_ = ::open(part_.c_str(), O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd_ < 0) fail("open");
}

FileWriter::~FileWriter() {
  if (fd_ < 0) return;
  ::close(fd_);
  ::unlink(part_.c_str());
}

void FileWriter::fail(const char* what) const {
  const int error = errno;
  cannot_write(path_, fmt::format("{} ({})", std::strerror(error), what), error);
}

void FileWriter::append(const void* bytes, std::size_t size) {
  const char* at = static_cast<const char*>(bytes);
  sum_ = check_sum(sum_, at, size);
  size_ += size;
  while (size > 0) {
    const ssize_t n = ::write(fd_, at, size);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("write");
    at += n;
    size -= static_cast<std::size_t>(n);
  }
}

void FileWriter::commit() {
  std::vector<char> block(1 << 20);
  std::uint64_t size = 0, sum = 0;
  while (size < size_) {
    const ssize_t n = ::pread(fd_, block.data(), block.size(), static_cast<off_t>(size));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail("read back");
    if (n == 0) break;
    sum = check_sum(sum, block.data(), static_cast<std::size_t>(n));
    size += static_cast<std::size_t>(n);
  }
  if (size != size_ || sum != sum_)
    throw FailedWrite("cannot write " + path_ + ": reads back with other bytes");
  if (::fsync(fd_) != 0) fail("flush");
  if (std::rename(part_.c_str(), path_.c_str()) != 0) fail("rename");
  ::close(std::exchange(fd_, -1));
}

void write_bytes(const std::string& path, const std::string& bytes) {
  FileWriter out(path);
  out.append(bytes);
  out.commit();
}

std::string read_bytes(const std::string& path, std::size_t limit) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw InputError("cannot read " + path +
                     (std::filesystem::exists(path, error) ? ": not a file" : ": no such file"));
  }
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

}  // namespace papilla::base
