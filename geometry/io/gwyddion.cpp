// Files of instruments that no reader of ours knows, by Gwyddion's converter in a child process: it
// reads some 170 formats, and what it does with a damaged one stays in the child.
#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "base/folder.h"
#include "base/scratch_folder.h"
#include "geometry/io/gwy.h"

namespace papilla::geometry {
namespace {

namespace fs = std::filesystem;

constexpr double kLongest = 60;                   // [s] of one conversion
constexpr rlim_t kMostMemory = rlim_t{4} << 30;   // addresses
constexpr rlim_t kMostWritten = rlim_t{1} << 31;  // of a file
constexpr std::size_t kMostRead = (std::size_t{1} << 31) - 1;

enum class ChildEnd { Done, Failed, TooLong };

void limit_child(int resource, rlim_t most) {
  const rlimit limit{most, most};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

// Between fork and exec only what POSIX allows in a process of several threads.
pid_t started_child(const std::vector<char*>& words, const std::vector<char*>& environment) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::setpgid(0, 0);
  limit_child(RLIMIT_AS, kMostMemory);
  limit_child(RLIMIT_CPU, static_cast<rlim_t>(kLongest));
  limit_child(RLIMIT_FSIZE, kMostWritten);
  limit_child(RLIMIT_CORE, 0);
  const int nothing = ::open("/dev/null", O_RDWR);
  for (int fd = 0; fd < 3; ++fd) ::dup2(nothing, fd);
  constexpr int kLast = 1024;
  for (int fd = 3; fd < kLast; ++fd) ::close(fd);
  ::execve(words[0], words.data(), environment.data());
  ::_exit(127);
}

// Its whole group ends with it: nothing that it started goes on.
ChildEnd wait_for(pid_t child) {
  const auto begin = std::chrono::steady_clock::now();
  int status = 0;
  while (true) {
    const pid_t done = ::waitpid(child, &status, WNOHANG);
    if (done == child) break;
    if (done < 0 && errno != EINTR) return ChildEnd::Failed;
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    if (spent.count() > kLongest) {
      ::kill(-child, SIGKILL);
      ::kill(child, SIGKILL);
      ::waitpid(child, &status, 0);
      return ChildEnd::TooLong;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  ::kill(-child, SIGKILL);
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? ChildEnd::Done : ChildEnd::Failed;
}

// The program on the path; "" where it is not installed.
std::string find_gwyddion() {
  const char* path = std::getenv("PATH");
  std::string rest = path ? path : "/usr/bin:/bin";
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    const std::string candidate = rest.substr(0, colon) + "/gwyddion";
    if (candidate.starts_with('/') && ::access(candidate.c_str(), X_OK) == 0) return candidate;
    rest.erase(0, colon + 1);
  }
  return {};
}

ChildEnd convert(const std::string& program, const ScratchFolder& scratch, const std::string& from,
                 const std::string& to) {
  std::vector<std::string> words{program, "--convert-to-gwy=" + to, from};
  // Its numbers follow the locale, and its settings the home: neither is the user's here.
  std::vector<std::string> environment{"LC_ALL=C", "HOME=" + scratch.file(""), "PATH=/usr/bin:/bin",
                                       "TMPDIR=" + scratch.file("")};
  const auto pointers = [](std::vector<std::string>& list) {
    std::vector<char*> out;
    for (std::string& word : list) out.push_back(word.data());
    out.push_back(nullptr);
    return out;
  };
  const std::vector<char*> argv = pointers(words), envp = pointers(environment);
  const pid_t child = started_child(argv, envp);
  if (child < 0) return ChildEnd::Failed;
  return wait_for(child);
}

}  // namespace

std::unique_ptr<HeightRows> open_by_gwyddion(const std::string& path, const std::string& channel) {
  const RegularFile file(path);  // throws where that is what is wrong
  const auto fail = [&](const std::string& why) -> InputError {
    return InputError("cannot read " + path + ": " + why);
  };
  const std::string program = find_gwyddion();
  if (program.empty()) {
    throw fail(
        "use .npy, .gsf, .exr, .tif, .x3p, .gwy, .sur or .sdf; other instruments' files are read "
        "by Gwyddion, which is not installed here (apt install gwyddion)");
  }
  const ScratchFolder scratch("gwyddion");
  const std::string first = scratch.file("first.gwy"), second = scratch.file("second.gwy");
  const ChildEnd end = convert(program, scratch, fs::absolute(path).string(), first);
  if (end == ChildEnd::TooLong)
    throw fail(fmt::format("Gwyddion took longer than {:.0f} s and was ended", kLongest));
  std::error_code missing;
  if (end == ChildEnd::Failed || !fs::exists(first, missing)) {
    throw fail(
        "Gwyddion finds no map in it; save it in the instrument's program as .gwy, .x3p or .sur");
  }
  std::string bytes = read_bytes(first, kMostRead);
  const std::size_t maps = count_of_gwy_maps(path, bytes);
  if (maps == 0) throw fail("Gwyddion finds no map in it (curves and volumes are not read)");
  if (convert(program, scratch, first, second) != ChildEnd::Done)
    throw fail("Gwyddion does not read again what it made of it");
  const std::size_t again = count_of_gwy_maps(path, read_bytes(second, kMostRead));
  if (again != maps) {
    throw fail(
        fmt::format("Gwyddion lost channels of it: {} of {} are left after a second "
                    "conversion; save it in the instrument's program as .gwy, .x3p or .sur",
                    again, maps));
  }
  return converted_gwy_rows(path, std::move(bytes), channel);
}

}  // namespace papilla::geometry
