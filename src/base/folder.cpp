#include "base/folder.h"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <utility>

#include "base/error.h"
#include "base/file_writer.h"
#include "base/files.h"

namespace papilla::base {
namespace {

namespace fs = std::filesystem;

constexpr int kFolder = O_PATH | O_DIRECTORY | O_CLOEXEC;

[[noreturn]] void refuse(const std::string& path, const std::string& why) {
  throw InputError({Problem{path, 0, 0, "", why}});
}

// Why the last call failed, of a name whose links are not followed.
std::string reason(int at, const std::string& name) {
  const int error = errno;
  struct stat there {};
  if (::fstatat(at, name.c_str(), &there, AT_SYMLINK_NOFOLLOW) == 0 && S_ISLNK(there.st_mode))
    return "is a link, which is not followed here; put what it leads to in its place";
  return std::strerror(error);
}

// The parts of a name; throws for what could lead out of the folder.
std::vector<std::string> parts_of(std::string_view name) {
  std::vector<std::string> out;
  for (const fs::path& part : fs::path(name)) {
    if (part.empty() || part == "." || part == ".." || part == "/")
      refuse(std::string(name), "expected a name inside the folder");
    out.push_back(part.string());
  }
  if (out.empty()) refuse(std::string(name), "expected a name inside the folder");
  return out;
}

}  // namespace

Handle::~Handle() {
  if (fd_ >= 0) ::close(fd_);
}
Handle::Handle(Handle&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
Handle& Handle::operator=(Handle&& other) noexcept {
  if (this != &other && fd_ >= 0) ::close(fd_);
  fd_ = std::exchange(other.fd_, -1);
  return *this;
}

Folder::Folder(std::string path, Handle handle)
    : path_(std::move(path)), handle_(std::make_shared<const Handle>(std::move(handle))) {}

Folder::Folder(const std::string& path)
    : Folder(path, Handle(::open(path.empty() ? "." : path.c_str(), kFolder))) {
  if (!*handle_) refuse(path, errno == ENOTDIR ? "not a folder" : std::strerror(errno));
}

Folder Folder::made(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (error) refuse(path, "no such folder can be made: " + error.message());
  return Folder(path);
}

Folder Folder::below(std::string_view name) const {
  Folder out = *this;
  for (const std::string& part : parts_of(name)) {
    Handle next(::openat(out.handle(), part.c_str(), kFolder | O_NOFOLLOW));
    if (!next) refuse(out.path(part), reason(out.handle(), part));
    out = Folder(out.path(part), std::move(next));
  }
  return out;
}

Folder Folder::made_below(std::string_view name) const {
  Folder out = *this;
  for (const std::string& part : parts_of(name)) {
    if (::mkdirat(out.handle(), part.c_str(), 0777) != 0 && errno != EEXIST)
      refuse(out.path(part), std::string("no such folder can be made: ") + std::strerror(errno));
    out = out.below(part);
  }
  return out;
}

std::shared_ptr<const Handle> Folder::holder(std::string_view name) const {
  std::shared_ptr<const Handle> out = handle_;
  std::vector<std::string> parts = parts_of(name);
  parts.pop_back();
  for (const std::string& part : parts) {
    Handle next(::openat(out->get(), part.c_str(), kFolder | O_NOFOLLOW));
    if (!next) return nullptr;
    out = std::make_shared<const Handle>(std::move(next));
  }
  return out;
}

namespace {

bool is_kind(const std::shared_ptr<const Handle>& in, std::string_view name, mode_t kind) {
  struct stat there {};
  const std::string last = parts_of(name).back();
  return in && ::fstatat(in->get(), last.c_str(), &there, AT_SYMLINK_NOFOLLOW) == 0 &&
         (there.st_mode & S_IFMT) == kind;
}

}  // namespace

bool Folder::has(std::string_view name) const { return is_kind(holder(name), name, S_IFREG); }
bool Folder::has_folder(std::string_view name) const {
  return is_kind(holder(name), name, S_IFDIR);
}

Handle Folder::opened(std::string_view name) const {
  const std::vector<std::string> parts = parts_of(name);
  const std::size_t last = name.rfind('/');
  const Folder in = parts.size() > 1 ? below(name.substr(0, last)) : *this;
  Handle out(
      ::openat(in.handle(), parts.back().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  if (!out)
    throw InputError("cannot read " + path(name) + ": " +
                     (errno == ENOENT ? "no such file" : reason(in.handle(), parts.back())));
  return out;
}

std::string Folder::file(std::string_view name) const {
  require_regular(opened(name), path(name));
  return path(name);
}

std::string Folder::read(std::string_view name, std::size_t limit) const {
  return read_bytes(opened(name), path(name), limit);
}

std::string Folder::read_from(std::string_view name, std::size_t from) const {
  const Handle file = opened(name);
  require_regular(file, path(name));
  std::string out;
  char block[1 << 16];
  for (;;) {
    const ssize_t n =
        ::pread(file.get(), block, sizeof block, static_cast<off_t>(from + out.size()));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw InputError("cannot read " + path(name) + ": " + std::strerror(errno));
    if (n == 0) return out;
    out.append(block, static_cast<std::size_t>(n));
  }
}

void Folder::write(std::string_view name, std::string_view bytes) const {
  FileWriter out(*this, name);
  out.append(bytes);
  out.commit();
}

void Folder::write_secret(std::string_view name, std::string_view bytes) const {
  remove(name);  // whose mode it would have
  FileWriter out(*this, name, 0600);
  out.append(bytes);
  out.commit();
}

Handle Folder::open_to_write(std::string_view name) const {
  const std::vector<std::string> parts = parts_of(name);
  const Folder in = parts.size() > 1 ? below(name.substr(0, name.rfind('/'))) : *this;
  Handle out(::openat(in.handle(), parts.back().c_str(),
                      O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666));
  if (!out)
    throw InputError("cannot write " + path(name) + ": " + reason(in.handle(), parts.back()));
  struct stat there {};
  if (::fstat(out.get(), &there) != 0 || !S_ISREG(there.st_mode))
    throw InputError("cannot write " + path(name) + ": it is no regular file");
  return out;
}

void Folder::remove(std::string_view name) const {
  const std::shared_ptr<const Handle> in = holder(name);
  if (!in) return;
  const std::string last = parts_of(name).back();
  if (::unlinkat(in->get(), last.c_str(), 0) == 0 || errno == ENOENT) return;
  if (!has_folder(name))
    refuse(path(name), std::string("cannot be removed: ") + std::strerror(errno));
  const Folder own = below(name);
  for (const std::string& child : own.entries(0)) own.remove(child);
  if (::unlinkat(in->get(), last.c_str(), AT_REMOVEDIR) != 0)
    refuse(path(name), std::string("cannot be removed: ") + std::strerror(errno));
}

// Names, sorted; kind 0: of all kinds.
std::vector<std::string> Folder::entries(unsigned kind) const {
  std::vector<std::string> out;
  const int listed = ::openat(handle(), ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  DIR* all = listed < 0 ? nullptr : ::fdopendir(listed);
  if (!all) refuse(path_, std::strerror(errno));
  while (const dirent* entry = ::readdir(all)) {
    const std::string name = entry->d_name;
    if (name == "." || name == "..") continue;
    struct stat there {};
    if (::fstatat(handle(), name.c_str(), &there, AT_SYMLINK_NOFOLLOW) != 0) continue;
    if (kind == 0 || (there.st_mode & S_IFMT) == kind) out.push_back(name);
  }
  ::closedir(all);
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::string> Folder::files() const { return entries(S_IFREG); }
std::vector<std::string> Folder::folders() const { return entries(S_IFDIR); }

std::string Folder::path(std::string_view name) const { return (fs::path(path_) / name).string(); }

FolderLock::FolderLock(const Folder& folder, std::string_view name, std::string_view who)
    : file_(folder.open_to_write(name)) {
  // A record lock belongs to this process alone: workers that outlive it do not hold it.
  struct flock lock {};
  lock.l_type = F_WRLCK;
  lock.l_whence = SEEK_SET;
  if (::fcntl(file_.get(), F_SETLK, &lock) != 0) {
    if (errno == EACCES || errno == EAGAIN)
      throw InputError(fmt::format("{}: {} in this folder", folder.path(), who));
    throw InputError(fmt::format("cannot lock {}: {}", folder.path(name), std::strerror(errno)));
  }
}

}  // namespace papilla::base
