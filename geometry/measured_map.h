// Heightmaps from files as periodic patches: of textures and of skins.
#pragma once

#include <cstdint>
#include <string>

#include "base/rooms.h"
#include "geometry/heightmap.h"
#include "geometry/scan.h"

namespace papilla::geometry {

// The map of the file, levelled, mended and made periodic, resampled on the grid: cut from the
// middle. One that repeats by itself and is asked for other sides than its patch, as a part of a
// stack, begins at its corner, as textures do. Throws InputError for a map smaller than `patch`
// [m].
Heightmap middle_of_map(const ScanSource& source, double patch, const Grid& grid);

// What was changed of the map before that. Read once, whoever asks.
ScanChanges changes_of_map(const ScanSource& source);

// A patch of a measured skin (Eq. geometry.5): a cut of the map at a random place, mirrored at
// random, levelled and made periodic. Independent patches are cuts of the same map: they know no
// more of the skin than it does. width [m]: where the file does not say. Throws InputError for a
// map that is smaller than the patch and a tenth.
Heightmap measured_skin(const std::string& file, double width, const Grid& grid, std::uint64_t seed,
                        std::uint64_t index);
// The shortest wavelength that the map holds [m].
double measured_skin_cutoff(const std::string& file, double width);

}  // namespace papilla::geometry
