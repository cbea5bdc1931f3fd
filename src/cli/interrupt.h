// Ctrl-C in a command that keeps what it has done.
#pragma once

#include <atomic>

#include "base/rooms.h"

namespace papilla::cli {

// While one lives, the first SIGINT or SIGTERM asks the work to end, and is acknowledged where
// somebody sits at a terminal; a second one ends the program at once, as what is kept is whole
// either way.
class Interruptible {
 public:
  Interruptible();
  ~Interruptible();
  Interruptible(const Interruptible&) = delete;
  Interruptible& operator=(const Interruptible&) = delete;

  const std::atomic<bool>& asked() const;
  int status() const;  // for the program to leave with: 130 after Ctrl-C
};

}  // namespace papilla::cli
