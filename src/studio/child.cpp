#include "studio/child.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>

#include "base/error.h"

namespace papilla::studio {
namespace {

constexpr int kChildNiceness = 19;                    // the hand comes first
constexpr std::chrono::milliseconds kPatience{1500};  // with a child that is to end

// Between fork and exec only what POSIX allows in a process of several threads.
int start_child(const std::vector<std::string>& words, const Handle& said, const Handle& noted) {
  std::vector<char*> argv;
  for (const std::string& word : words) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child != 0) return child;
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  ::setpgid(0, 0);
  ::setpriority(PRIO_PROCESS, 0, kChildNiceness);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, 0);
  ::dup2(said.get(), 1);
  ::dup2(noted.get(), 2);
  constexpr int kFirst = 3, kLast = 1024;
  for (int fd = kFirst; fd < kLast; ++fd) ::close(fd);  // sockets of the pages
  ::execv(argv[0], argv.data());
  ::_exit(127);
}

// Where the first line begins by which a program says why it ended.
std::size_t error_at(const std::string& noted) {
  constexpr std::string_view kError = "error:";
  if (noted.starts_with(kError)) return 0;
  const std::size_t at = noted.find("\n" + std::string(kError));
  return at == std::string::npos ? at : at + 1;
}

}  // namespace

Child::Child(const std::vector<std::string>& words, const Handle& said, const Handle& noted)
    : process_(start_child(words, said, noted)) {}

Child::~Child() {
  if (ended()) return;
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

void Child::ask_to_end() {
  if (asked_ || ended()) return;
  ::kill(process_, SIGTERM);
  asked_ = std::chrono::steady_clock::now();
}

std::optional<int> Child::ended() {
  if (ended_) return ended_;
  int status = 0;
  if (::waitpid(process_, &status, WNOHANG) == process_)
    ended_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  else if (asked_ && std::chrono::steady_clock::now() > *asked_ + kPatience)
    ::kill(process_, SIGKILL);
  return ended_;
}

Handle emptied(const Folder& folder, std::string_view name) {
  Handle out = folder.open_to_write(name);
  if (::ftruncate(out.get(), 0) != 0)
    throw InputError(folder.path(name) + ": " + std::strerror(errno));
  return out;
}

bool says_an_error(const std::string& noted) { return error_at(noted) != std::string::npos; }

std::string why_failed(const std::string& noted) {
  constexpr std::size_t kMost = 600;  // a line that passes it is shown to its end
  // The other mistakes of a file stand in lines of their own below the first.
  if (const std::size_t at = error_at(noted); at != std::string::npos) {
    const std::string errors = noted.substr(at);
    const std::size_t end = errors.find('\n', kMost);
    const bool more = end != std::string::npos && end + 1 < errors.size();
    return more ? errors.substr(0, end) + "\n…\n" : errors;
  }
  if (noted.size() <= kMost) return noted;
  const std::string tail = noted.substr(noted.size() - kMost);
  const std::size_t line = tail.find('\n');  // the end of a line that began before
  return line == std::string::npos || line + 1 == tail.size() ? tail : tail.substr(line + 1);
}

}  // namespace papilla::studio
