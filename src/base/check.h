// CHECK: for our own bugs. Users' mistakes are InputError (error.h); numerical trouble is a status.
#pragma once

#include <stdexcept>
#include <string>

#include "base/rooms.h"

namespace papilla::base {

struct InternalError : std::logic_error {
  using std::logic_error::logic_error;
};

[[noreturn]] inline void check_failed(const char* expression, const char* file, int line,
                                      const std::string& message) {
  throw InternalError(std::string(file) + ":" + std::to_string(line) + ": check failed: " +
                      expression + (message.empty() ? "" : " (" + message + ")"));
}

}  // namespace papilla::base

#define PAPILLA_CHECK(condition, message) \
  ((condition) ? void(0) : ::papilla::base::check_failed(#condition, __FILE__, __LINE__, (message)))
