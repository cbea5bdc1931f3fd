// Memory of the process.
#pragma once

#include <cstddef>
#include <string>

#include "base/rooms.h"

namespace papilla::base {

// Freed memory stays with the process instead of going back to the system after every solve: fields
// of a few megabytes are made and dropped thousands of times, and fresh pages cost more than their
// use (a quarter of a contact solve). Called once, by a program's main.
void keep_freed_memory();

// Bytes that a computation may ask for: the machine's memory, less where the process is limited
// (address space, control group).
double memory_limit();

// Throws InputError, before anything is allocated, when `what` needs more than memory_limit().
void require_memory(double bytes, const std::string& what);

// Whether so many bytes of address space are free in one piece: less where `ulimit -v` says so.
bool has_address_space(std::size_t bytes);

}  // namespace papilla::base
