// A page as PDF, printed by Chromium where it is installed.
#pragma once

#include <string>

#include "base/rooms.h"

namespace papilla::report {

// The bytes of the file. Throws InputError where there is no Chromium or it prints nothing in time.
std::string page_as_pdf(const std::string& html);

}  // namespace papilla::report
