// Textures of several kinds, and of several levels, in one study.
#pragma once

#include <string>
#include <vector>

#include "config/describe.h"
#include "geometry/texture.h"

namespace papilla {

// A texture of another kind (one of texture_kinds()) with the lattice, period, width, depth, wall
// and rim of this one as far as that kind has them, defaults elsewhere.
Texture of_kind(const Texture& texture, const std::string& kind);

// Parts of a stack, 1 for anything else; a stack with its first parts alone.
int texture_levels(const Texture& texture);
Texture with_levels(Texture texture, int levels);

// Where the measure that a path names is among these numbers: the path itself, or the other kind's
// word for it (depth of a hole, height of a pillar; diameter of a hole, width of a groove); empty
// when there is none.
std::string path_in(const std::vector<NumberField>& known, const std::string& path);

}  // namespace papilla
