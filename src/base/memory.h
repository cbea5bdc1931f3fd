// Memory of the process.
#pragma once

namespace papilla {

// Freed memory stays with the process instead of going back to the system after every solve: fields
// of a few megabytes are made and dropped thousands of times, and fresh pages cost more than their
// use (a quarter of a contact solve). Called once, by a program's main.
void keep_freed_memory();

}  // namespace papilla
