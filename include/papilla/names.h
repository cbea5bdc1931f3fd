// The names of this library lie in papilla::api, which a program writes as papilla. Where the rooms
// inside, which have names of their own in papilla, are seen too, PAPILLA_INSIDE is defined.
#pragma once

namespace papilla {
namespace api {}
#ifndef PAPILLA_INSIDE
using namespace api;
#endif
}  // namespace papilla
