#include "base/bounded_child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <thread>

namespace papilla::base {
namespace {

void limit_child(int resource, std::size_t most) {
  const rlimit limit{most, most};
  ::setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

// Between fork and exec only what POSIX allows in a process of several threads.
pid_t started_child(const std::vector<char*>& words, const std::vector<char*>& environment,
                    const ChildLimits& limits) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::setpgid(0, 0);
  if (limits.memory > 0) limit_child(RLIMIT_AS, limits.memory);
  limit_child(RLIMIT_CPU, static_cast<std::size_t>(limits.seconds));
  limit_child(RLIMIT_FSIZE, limits.written);
  limit_child(RLIMIT_CORE, 0);
  const int nothing = ::open("/dev/null", O_RDWR);
  for (int fd = 0; fd < 3; ++fd) ::dup2(nothing, fd);
  constexpr int kLast = 1024;
  for (int fd = 3; fd < kLast; ++fd) ::close(fd);
  ::execve(words[0], words.data(), environment.data());
  ::_exit(127);
}

ChildEnd wait_for(pid_t child, double seconds) {
  const auto begin = std::chrono::steady_clock::now();
  int status = 0;
  while (true) {
    const pid_t done = ::waitpid(child, &status, WNOHANG);
    if (done == child) break;
    if (done < 0 && errno != EINTR) return ChildEnd::Failed;
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - begin;
    if (spent.count() > seconds) {
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

}  // namespace

std::string program_on_path(const std::vector<std::string>& names) {
  const char* path = std::getenv("PATH");
  for (const std::string& name : names) {
    std::string rest = path ? path : "/usr/bin:/bin";
    while (!rest.empty()) {
      const std::size_t colon = std::min(rest.find(':'), rest.size());
      std::string candidate = rest.substr(0, colon) + "/" + name;
      if (candidate.starts_with('/') && ::access(candidate.c_str(), X_OK) == 0) return candidate;
      rest.erase(0, colon + 1);
    }
  }
  return {};
}

ChildEnd run_bounded(std::vector<std::string> words, std::vector<std::string> environment,
                     const ChildLimits& limits) {
  const auto pointers = [](std::vector<std::string>& list) {
    std::vector<char*> out;
    for (std::string& word : list) out.push_back(word.data());
    out.push_back(nullptr);
    return out;
  };
  const std::vector<char*> argv = pointers(words), envp = pointers(environment);
  const pid_t child = started_child(argv, envp, limits);
  if (child < 0) return ChildEnd::Failed;
  return wait_for(child, limits.seconds);
}

}  // namespace papilla::base
