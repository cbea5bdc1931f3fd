#include "cli/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <string_view>

#include "cli/context.h"

namespace papilla::cli {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<int> interrupted_by{0};
std::atomic<bool> on_terminal{false};

// What is being worked on may take a minute more.
constexpr std::string_view kHeard =
    "\nending when what is being worked on is done; Ctrl-C again ends at once\n";

extern "C" void on_interrupt(int signal) {
  interrupted_by = signal;
  if (interrupted.exchange(true)) ::_exit(kSignalled + signal);
  if (!on_terminal) return;
  const int before = errno;
  if (::write(STDERR_FILENO, kHeard.data(), kHeard.size()) < 0) errno = before;
}

void handle(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

Interruptible::Interruptible() {
  on_terminal = ::isatty(STDERR_FILENO) == 1;
  handle(on_interrupt);
}

Interruptible::~Interruptible() { handle(SIG_DFL); }

const std::atomic<bool>& Interruptible::asked() const { return interrupted; }

int Interruptible::status() const { return kSignalled + interrupted_by; }

}  // namespace papilla::cli
