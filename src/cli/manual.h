// Manual pages made from the commands themselves.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "cli/options.h"

namespace papilla::cli {

struct ManualPage {
  std::string name;  // "papilla-optimize"
  std::string text;  // as man(7) reads it
};

// The program's page and one for each command, its pieces on it.
std::vector<ManualPage> manual_pages(Command program, const std::string& version);

}  // namespace papilla::cli
