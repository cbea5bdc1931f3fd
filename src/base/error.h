// What a user did wrong: every problem of an input at once, each with its place and the way out.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::base {

struct Problem {
  std::string file;  // empty: the command line
  int line = 0;      // 1-based; 0: not known
  int column = 0;
  std::string key;      // e.g. "texture.diameter"; empty: the file as a whole
  std::string message;  // what is wrong, what was expected, how to fix it

  std::string text() const;  // "file:line:column: key: message"
};

class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Problem> problems);
  explicit InputError(const std::string& message);  // one problem without a place

  const std::vector<Problem>& problems() const { return problems_; }

 private:
  std::vector<Problem> problems_;
};

// Of a file that could not be written though it may be: the disk is full, a device fails. Work that
// failed, not what was asked for: a command ends with 1.
class FailedWrite : public InputError {
 public:
  using InputError::InputError;
};

// Mistakes of several inputs, told together: each work is done, and what it finds wrong is kept.
class Mistakes {
 public:
  template <class Work>
  void of(Work&& work) {
    try {
      work();
    } catch (const InputError& error) {
      add(error);
    }
  }
  void add(const InputError& error);
  void tell() const;  // throws InputError with all of them, where there are any

 private:
  std::vector<Problem> problems_;
};

}  // namespace papilla::base
