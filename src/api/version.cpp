#include "papilla/papilla.h"

namespace papilla::api {

const char* version() { return PAPILLA_VERSION; }

}  // namespace papilla::api
