// A program of others in a process of its own, within limits: what it does with a damaged file, or
// with its time, stays there.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::base {

struct ChildLimits {
  double seconds = 60;                         // of the clock, and of the processor
  std::size_t memory = 0;                      // addresses [B]; 0: no limit
  std::size_t written = std::size_t{1} << 31;  // of a file [B]
};

enum class ChildEnd { Done, Failed, TooLong };

// Of these names the first that is a program on the path, whole; "" where none is.
std::string program_on_path(const std::vector<std::string>& names);

// words: the whole path first; environment: "NAME=value", all that it gets. It reads and prints
// nothing. Its whole group ends with it: nothing that it started goes on.
ChildEnd run_bounded(std::vector<std::string> words, std::vector<std::string> environment,
                     const ChildLimits& limits);

}  // namespace papilla::base
