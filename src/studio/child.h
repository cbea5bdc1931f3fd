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

// Whether a child ended because of an error that it noted.
bool says_an_error(const std::string& noted);
// Why a child failed, of what it noted, for people: its errors, the first ones; the end of it where
// it names none. Lines are whole.
std::string why_failed(const std::string& noted);

}  // namespace papilla::studio
