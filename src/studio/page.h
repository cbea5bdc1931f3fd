// The files of the page, by their addresses below the token.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/rooms.h"

namespace papilla::studio {

struct PageFile {
  std::string type;
  std::string_view text;
};
std::optional<PageFile> page_file(const std::string& path);

}  // namespace papilla::studio
