// Everything that Papilla offers to other programs. docs/how_to/library.md
#pragma once

#include "papilla/design.h"
#include "papilla/error.h"
#include "papilla/evaluate.h"
#include "papilla/files.h"
#include "papilla/physics.h"
#include "papilla/rank.h"

namespace papilla::api {

const char* version();  // "0.1.0"

}  // namespace papilla::api
