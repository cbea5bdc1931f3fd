// A program that works for the studio: it gives way to the hand, and ends with who started it.
#pragma once

#include <string>
#include <vector>

#include "base/folder.h"
#include "base/rooms.h"

namespace papilla::studio {

// Its process. words: the program and what it is given; said, noted: its standard output and
// errors. It ends with the calling thread, however that ends.
int start_child(const std::vector<std::string>& words, const Handle& said, const Handle& noted);

// A file to hold what a child says, empty. Throws InputError.
Handle emptied(const Folder& folder, std::string_view name);

// The end of what a child noted, for people.
std::string last_lines(const std::string& text);

}  // namespace papilla::studio
