// Textures of several kinds, and of several levels, in one study.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "config/describe.h"
#include "geometry/texture.h"

namespace papilla::design {

// A texture of another kind (one of texture_kinds()) with the lattice and the measures of this one
// as far as that kind has them, defaults elsewhere; a width that the period has no room for is the
// share of the period that it is by default.
Texture of_kind(const Texture& texture, const std::string& kind);

// Parts of a stack, 1 for anything else; a stack with its first parts alone; whether the last part
// (the texture itself where it has none) has relief.
int texture_levels(const Texture& texture);
Texture with_levels(Texture texture, int levels);
bool last_level_has_relief(const Texture& texture);
// The part that the number at this path belongs to: texture.parts.1.depth; the texture itself where
// the path names no part.
Texture part_at(const Texture& texture, const std::string& path);

// The numbers that several kinds have, by whatever key: what Roles says of each kind.
enum class Measure { Period, Width, Depth, WallAngle, EdgeRadius };
// What stands for the number at a path, texture.depth or texture.parts.1.height; none: another
// number.
std::optional<Measure> measure_of(const std::string& path);
// Whether some kind of texture has a number of this path's key.
bool some_kind_has(const std::string& path);
// Whether some kind of texture is flat when the number at this path is 0.
bool decides_relief(const std::string& path);

// Where the measure that a path names is among these numbers: the path itself, or another kind's
// key for it (depth of a hole, height of a pillar; diameter of a hole, width of a groove); empty
// when there is none.
std::string path_in(const std::vector<NumberField>& known, const std::string& path);

}  // namespace papilla::design
