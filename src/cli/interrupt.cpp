#include "cli/interrupt.h"

#include <signal.h>
#include <unistd.h>

#include "cli/context.h"

namespace papilla::cli {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<int> interrupted_by{0};

extern "C" void on_interrupt(int signal) {
  interrupted_by = signal;
  if (interrupted.exchange(true)) ::_exit(kSignalled + signal);
}

void handle(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  ::sigaction(SIGINT, &action, nullptr);
  ::sigaction(SIGTERM, &action, nullptr);
}

}  // namespace

Interruptible::Interruptible() { handle(on_interrupt); }

Interruptible::~Interruptible() { handle(SIG_DFL); }

const std::atomic<bool>& Interruptible::asked() const { return interrupted; }

int Interruptible::status() const { return kSignalled + interrupted_by; }

}  // namespace papilla::cli
