// Preloaded into the program under test (LD_PRELOAD): one call in a sequence fails, by the environment.
//   PAPILLA_FAULT_KIND   allocation: operator new throws; file: a call on a file says EIO;
//                        disk: every write says ENOSPC once PAPILLA_FAULT_AT bytes are written
//   PAPILLA_FAULT_AT     which call of the kind, from 1; 0: none fails
//   PAPILLA_FAULT_COUNT  a file that gets the number of calls (disk: bytes) when the program ends
// Calls count from main() on and outside dlopen(): what fails there is the loader's, and the constructors of
// libraries that it runs cannot tell an error (those of the image library make 70,000 allocations). Files of the system (/proc, /usr, ...)
// and descriptors opened without a path count for nothing.
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

namespace {

enum class Kind { None, Allocation, File, Disk };

std::atomic<bool> armed{false};
std::atomic<long> calls{0};
std::atomic<int> loading{0};  // calls of dlopen() under way: libraries load others, and start threads
Kind kind = Kind::None;
long fails_at = 0;
constexpr int kMostFiles = 4096;
std::atomic<bool> counted[kMostFiles];  // descriptors of files that count

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

bool of_the_system(const char* path) {
  for (const char* folder : {"/proc/", "/sys/", "/usr/", "/etc/", "/dev/", "/lib", "/run/"}) {
    if (std::strncmp(path, folder, std::strlen(folder)) == 0) return true;
  }
  return false;
}

// Whether this call of the kind is the one to fail.
bool fails(Kind which) { return armed && loading == 0 && kind == which && ++calls == fails_at; }

// The same for a call on a file.
bool file_fails() {
  if (!fails(Kind::File)) return false;
  errno = EIO;
  return true;
}
bool file_fails(int descriptor) {
  return descriptor >= 0 && descriptor < kMostFiles && counted[descriptor] && file_fails();
}
bool file_fails(const char* path) { return !of_the_system(path) && file_fails(); }

bool disk_is_full(int descriptor, std::size_t size) {
  if (!armed || kind != Kind::Disk || descriptor < 0 || descriptor >= kMostFiles || !counted[descriptor]) return false;
  calls += static_cast<long>(size);
  if (fails_at == 0 || calls <= fails_at) return false;
  errno = ENOSPC;
  return true;
}

int opened(const char* path, int descriptor) {
  if (descriptor >= 0 && descriptor < kMostFiles) counted[descriptor] = !of_the_system(path);
  return descriptor;
}

void write_count() {
  armed = false;
  if (const char* path = std::getenv("PAPILLA_FAULT_COUNT")) {
    if (std::FILE* out = std::fopen(path, "w")) {
      std::fprintf(out, "%ld\n", calls.load());
      std::fclose(out);
    }
  }
}

using Main = int (*)(int, char**, char**);
Main program = nullptr;

int armed_main(int argc, char** argv, char** environment) {
  const char* word = std::getenv("PAPILLA_FAULT_KIND");
  const char* at = std::getenv("PAPILLA_FAULT_AT");
  if (word != nullptr && at != nullptr) {
    kind = std::strcmp(word, "allocation") == 0 ? Kind::Allocation
           : std::strcmp(word, "file") == 0     ? Kind::File
                                                : Kind::Disk;
    fails_at = std::atol(at);
    std::atexit(write_count);
    armed = true;
  }
  return program(argc, argv, environment);
}

void* allocate(std::size_t size, std::size_t alignment) {
  if (fails(Kind::Allocation)) throw std::bad_alloc();
  void* out = alignment == 0 ? std::malloc(size) : std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (out == nullptr) throw std::bad_alloc();
  return out;
}

}  // namespace

void* operator new(std::size_t size) { return allocate(size, 0); }
void* operator new[](std::size_t size) { return allocate(size, 0); }
void* operator new(std::size_t size, std::align_val_t alignment) { return allocate(size, static_cast<std::size_t>(alignment)); }
void* operator new[](std::size_t size, std::align_val_t alignment) { return allocate(size, static_cast<std::size_t>(alignment)); }
void operator delete(void* block) noexcept { std::free(block); }
void operator delete[](void* block) noexcept { std::free(block); }
void operator delete(void* block, std::size_t) noexcept { std::free(block); }
void operator delete[](void* block, std::size_t) noexcept { std::free(block); }
void operator delete(void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete[](void* block, std::align_val_t) noexcept { std::free(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { std::free(block); }
void operator delete[](void* block, std::size_t, std::align_val_t) noexcept { std::free(block); }

extern "C" {

void* dlopen(const char* path, int flags) {
  ++loading;
  void* out = next<void* (*)(const char*, int)>("dlopen")(path, flags);
  --loading;
  return out;
}

int __libc_start_main(Main main, int argc, char** argv, void (*init)(), void (*fini)(), void (*loader)(), void* stack) {
  program = main;
  using Start = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);
  return next<Start>("__libc_start_main")(armed_main, argc, argv, init, fini, loader, stack);
}

#define OPEN(name)                                                        \
  int name(const char* path, int flags, ...) {                            \
    va_list rest;                                                         \
    va_start(rest, flags);                                                \
    const mode_t mode = va_arg(rest, mode_t);                             \
    va_end(rest);                                                         \
    if (file_fails(path)) return -1;                                      \
    return opened(path, next<int (*)(const char*, int, ...)>(#name)(path, flags, mode)); \
  }
OPEN(open)
OPEN(open64)
#undef OPEN

#define OPENAT(name)                                                      \
  int name(int folder, const char* path, int flags, ...) {                \
    va_list rest;                                                         \
    va_start(rest, flags);                                                \
    const mode_t mode = va_arg(rest, mode_t);                             \
    va_end(rest);                                                         \
    if (file_fails(path)) return -1;                                      \
    return opened(path, next<int (*)(int, const char*, int, ...)>(#name)(folder, path, flags, mode)); \
  }
OPENAT(openat)
OPENAT(openat64)
#undef OPENAT

#define FOPEN(name)                                                       \
  std::FILE* name(const char* path, const char* mode) {                   \
    if (file_fails(path)) return nullptr;                                 \
    std::FILE* out = next<std::FILE* (*)(const char*, const char*)>(#name)(path, mode); \
    if (out != nullptr) opened(path, fileno(out));                        \
    return out;                                                           \
  }
FOPEN(fopen)
FOPEN(fopen64)
#undef FOPEN

ssize_t read(int descriptor, void* bytes, size_t size) {
  if (file_fails(descriptor)) return -1;
  return next<ssize_t (*)(int, void*, size_t)>("read")(descriptor, bytes, size);
}
ssize_t pread(int descriptor, void* bytes, size_t size, off_t at) {
  if (file_fails(descriptor)) return -1;
  return next<ssize_t (*)(int, void*, size_t, off_t)>("pread")(descriptor, bytes, size, at);
}
ssize_t write(int descriptor, const void* bytes, size_t size) {
  if (file_fails(descriptor) || disk_is_full(descriptor, size)) return -1;
  return next<ssize_t (*)(int, const void*, size_t)>("write")(descriptor, bytes, size);
}
ssize_t writev(int descriptor, const struct iovec* parts, int count) {
  size_t size = 0;
  for (int i = 0; i < count; ++i) size += parts[i].iov_len;
  if (file_fails(descriptor) || disk_is_full(descriptor, size)) return -1;
  return next<ssize_t (*)(int, const struct iovec*, int)>("writev")(descriptor, parts, count);
}
int fsync(int descriptor) { return file_fails(descriptor) ? -1 : next<int (*)(int)>("fsync")(descriptor); }
int fdatasync(int descriptor) { return file_fails(descriptor) ? -1 : next<int (*)(int)>("fdatasync")(descriptor); }
int rename(const char* from, const char* to) {
  return file_fails(from) ? -1 : next<int (*)(const char*, const char*)>("rename")(from, to);
}
int renameat(int from_folder, const char* from, int to_folder, const char* to) {
  if (file_fails(from)) return -1;
  return next<int (*)(int, const char*, int, const char*)>("renameat")(from_folder, from, to_folder, to);
}
int mkdir(const char* path, mode_t mode) {
  return file_fails(path) ? -1 : next<int (*)(const char*, mode_t)>("mkdir")(path, mode);
}
int close(int descriptor) {
  const bool failing = file_fails(descriptor);
  if (descriptor >= 0 && descriptor < kMostFiles) counted[descriptor] = false;
  const int out = next<int (*)(int)>("close")(descriptor);
  if (!failing) return out;
  errno = EIO;
  return -1;
}

}  // extern "C"
