// Checksums of files, as sha256sum prints them.
#pragma once

#include <string>

#include "base/rooms.h"

namespace papilla::base {

// 64 hexadecimal digits (FIPS 180-4).
std::string sha256(const std::string& bytes);

}  // namespace papilla::base
