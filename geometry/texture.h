// What a surface can be: the one list of texture kinds, and what all of them share.
#pragma once

#include <cstddef>
#include <string>
#include <variant>
#include <vector>

#include "base/rooms.h"
#include "geometry/facts.h"
#include "geometry/textures/cap_array.h"
#include "geometry/textures/etched_glass.h"
#include "geometry/textures/flat.h"
#include "geometry/textures/grating.h"
#include "geometry/textures/hole_array.h"
#include "geometry/textures/measured.h"
#include "geometry/textures/particle_film.h"
#include "geometry/textures/pillar_array.h"
#include "geometry/textures/random_rough.h"
#include "geometry/textures/stack.h"
#include "geometry/textures/v_grooves.h"
#include "geometry/textures/waves.h"

namespace papilla::geometry {

// The one list of kinds. The first has no relief: searches take it as the flat end of the list.
struct Texture {
  std::variant<Flat, HoleArray, PillarArray, Grating, VGrooves, Waves, CapArray, RandomRough,
               ParticleFilm, Measured3d, Stack, EtchedGlass>
      kind;

  bool operator==(const Texture&) const = default;
};

// Key `type` chooses the kind; the kind's own keys follow.
void fields(FieldVisitor& v, Texture& texture);
std::string texture_name(const Texture& texture);  // "hole_array"
const std::vector<std::string>& texture_kinds();   // every such name, in the order of the list
Texture default_texture(std::size_t kind);         // of that number in the list
bool numbers_alone(std::size_t kind);              // no file and no parts: kinds that can compete

TextureProblems problems(const Texture& texture);
TextureFacts facts(const Texture& texture);  // free but for stacks, which ask their parts
Roles roles(Texture& texture);               // pointers into the texture

inline constexpr double kWindow = 12e-6;  // side of the window of the M3 paper [m]

// Smallest rectangle with a whole number of periods, n = max(2, round(target / period)) along x,
// sampled with `pixels` along x and nearly square pixels; even counts. More periods where a film of
// particles beside them needs a longer patch (FreePatch::least). Eq. geometry.2
Grid patch_grid(const Texture& texture, int pixels, double target = kWindow);

// The patch that is simulated: whole periods on both sides, its area as near as can be to that of
// the window and not much longer than wide, sampled no coarser than window / pixels (to at
// most `most` pixels a side), so that designs of different period are compared on like patches at
// like resolution. Without relief there is no period: every flat texture has the same patch. A map
// that repeats by itself is a period. What beside a period does not repeat has the patch that it
// needs, in whole periods.
// Half of both numbers is twice the pixel on any patch. Eq. geometry.2
Grid simulated_patch(const Texture& texture, int pixels, int most = 1024);

// Heights on a grid whose sides are whole numbers of periods (patch_grid, or tiles of it). Edges
// are averaged over the pixel: volume and open area are right to second order in the pixel. Throws
// InputError for what cannot be made (impossible coverage, unreadable file).
Heightmap generate(const Texture& texture, const Grid& grid);

}  // namespace papilla::geometry
