#include "base/memory.h"
#include "papilla/papilla.h"

namespace papilla::api {

const char* version() { return PAPILLA_VERSION; }
void keep_freed_memory() { base::keep_freed_memory(); }

}  // namespace papilla::api
