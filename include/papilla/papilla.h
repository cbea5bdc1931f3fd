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

const char* version();  // "0.1.0"

}  // namespace papilla::api
