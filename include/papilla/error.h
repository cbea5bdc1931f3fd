// What a caller did wrong: every problem of an input at once, each with its place and the way out.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "papilla/names.h"

namespace papilla::api {

struct Problem {
  std::string file;  // empty: not from a file
  int line = 0;      // 1-based; 0: not known
  int column = 0;
  std::string key;      // "texture.diameter"; empty: the file as a whole
  std::string message;  // what is wrong, what was expected, how to fix it

  std::string text() const;  // "file:line:column: key: message"
};

// Any function of this library throws it; what() has one line per problem.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);

  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

// Work that was stopped on the caller's wish.
class Stopped : public std::runtime_error {
 public:
  Stopped() : std::runtime_error("stopped") {}
};

}  // namespace papilla::api
