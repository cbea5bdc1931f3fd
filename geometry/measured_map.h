// Heightmaps from files as periodic patches: of textures and of skins.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "geometry/facts.h"
#include "geometry/heightmap.h"
#include "geometry/scan.h"

namespace papilla::geometry {

struct Texture;

// When the file of a map was written and its length: where they differ, a path names another map.
// What a file that is not there has, is that of none.
struct MapVersion {
  std::filesystem::file_time_type written{};
  std::uintmax_t size = 0;

  bool operator==(const MapVersion&) const = default;
};
MapVersion map_version(const std::string& file);  // as ScanSource::file
// Of the maps that a texture is made of, in their order: what of it its keys do not say.
std::vector<MapVersion> map_versions(const Texture& texture);

// From the middle of a map to the middle of a patch of it [m].
struct MapPlace {
  double x = 0, y = 0;

  bool operator==(const MapPlace&) const = default;
};

// The band along a patch's border that is blended into what lies beyond it, of its side. Eq.
// geometry.4
inline constexpr double kSeam = 0.1;
// The side of the largest square about the middle of a map that leaves room for that, to 10 nm
// below [m]; of one that repeats by itself its shorter side.
double largest_patch(const ScanChanges& map);

// Of fewer along its side a patch has no shape.
inline constexpr double kFewestPixels = 8;
// Whether a patch [m] holds too few pixels of such a map.
bool too_coarse(const Grid& map, double patch);

// The map of the file, levelled, mended and made periodic, resampled on the grid: cut at a place.
// One that repeats by itself and is asked for other sides than its patch, as a part of a stack or
// as one of several periods, begins at its corner, as textures do, and is taken as often as it
// takes. cell: what repeats within one that is taken as it is, if it is less than the patch. Throws
// InputError for a map smaller than `patch` [m] that does not repeat to it, for one of which it
// holds fewer than kFewestPixels a side, for other sides that are no whole number of it, and for a
// place where the patch reaches beyond it.
Heightmap patch_of_map(const ScanSource& source, double patch, const MapPlace& at, const Grid& grid,
                       const std::optional<UnitCell>& cell = {});

// Places whose patches have no pixel in common and leave room for their seams: two along each side
// that is long enough, evenly. One, the middle: of a map that is no larger, or repeats by itself.
std::vector<MapPlace> places_of_map(const ScanSource& source, double patch);

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
