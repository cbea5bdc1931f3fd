// A program that works for the studio: it gives way to the hand, and ends with who started it.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "base/folder.h"
#include "base/rooms.h"

namespace papilla::studio {

inline constexpr std::chrono::milliseconds kLook{300};  // between two looks at a child

class Child {
 public:
  // words: the program and what it is given; said, noted: its standard output and errors.
  Child(const std::vector<std::string>& words, const Handle& said, const Handle& noted);
  ~Child();  // killed where it works still, as at the end of the thread that began it
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // It may finish what it is at; some time after that it is killed. Once is enough.
  void ask_to_end();
  bool asked_to_end() const { return asked_.has_value(); }
  // The exit code, or minus the signal that ended it; nothing while it works.
  std::optional<int> ended();

 private:
  int process_;
  std::optional<std::chrono::steady_clock::time_point> asked_;
  std::optional<int> ended_;
};

// A file to hold what a child says, empty. Throws InputError.
Handle emptied(const Folder& folder, std::string_view name);

// The end of what a child noted, for people.
std::string last_lines(const std::string& text);

}  // namespace papilla::studio
