// What a run knows of textures, and of surfaces without one, beside what it compared.
#pragma once

#include <optional>
#include <string>

#include "base/rooms.h"
#include "search/run.h"

namespace papilla::report {

// What designs of the front with textures gain over what is recommended without one, at which cost,
// as a sentence; "" where none gains. Of another finish the texture is held against its own surface
// without it.
std::string other_textures(const ResultFiles& files);

// Why nothing is known of what textures gain: none that keeps every limit has confirmed numbers; ""
// where one does.
std::string textures_unknown(const ResultFiles& files);

// Why a surface without texture has no number, of one that was asked or was not, and what the run
// knows of it all the same.
std::string without_number(const ResultFiles& files, const Point& surface,
                           const std::optional<Score>& asked);

}  // namespace papilla::report
