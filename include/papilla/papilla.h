// Everything that Papilla offers to other programs. docs/how_to/library.md
#pragma once

#include "papilla/calibrate.h"
#include "papilla/cases.h"
#include "papilla/design.h"
#include "papilla/differences.h"
#include "papilla/error.h"
#include "papilla/evaluate.h"
#include "papilla/files.h"
#include "papilla/lab.h"
#include "papilla/physics.h"
#include "papilla/rank.h"
#include "papilla/scan.h"
#include "papilla/study.h"
#include "papilla/units.h"

namespace papilla::api {

const char* version();  // "0.2.7"

// For a program's main: freed memory stays with the process instead of going back to the system
// after every solve, which takes a fifth less time (glibc). The program and the Python module do
// it; the library leaves it to its caller, as it is of the whole process.
void keep_freed_memory();

}  // namespace papilla::api
