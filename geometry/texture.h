// What a surface can be: the one list of texture kinds. Lengths in metres, angles in radians.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "config/fields.h"
#include "geometry/heightmap.h"

namespace papilla {

enum class Lattice { Square, Hexagonal };

struct Flat {
  bool operator==(const Flat&) const = default;
};

// Round holes in a flat land. The diameter is where wall and land would meet without the edge
// radius.
struct HoleArray {
  Lattice lattice = Lattice::Square;
  double period = 6e-6, diameter = 3e-6, depth = 350e-9;
  double wall_angle = 1.5358897417550099;  // 88 deg from the land
  double edge_radius = 0;

  bool operator==(const HoleArray&) const = default;
};

// Round pillars on a flat floor (z = 0); diameter at the top.
struct PillarArray {
  Lattice lattice = Lattice::Square;
  double period = 6e-6, diameter = 3e-6, height = 350e-9;
  double wall_angle = 1.5358897417550099;
  double edge_radius = 0;

  bool operator==(const PillarArray&) const = default;
};

// Straight grooves along y; width at the top.
struct Grating {
  double period = 6e-6, width = 3e-6, depth = 350e-9;
  double wall_angle = 1.5358897417550099;
  double edge_radius = 0;

  bool operator==(const Grating&) const = default;
};

struct RandomRough {
  double rms = 50e-9, roll_off = 3e-6, hurst = 0.8, cutoff = 200e-9;
  int seed = 1;

  bool operator==(const RandomRough&) const = default;
};

// Random non-overlapping spherical caps on a flat film.
struct ParticleFilm {
  double radius = 1.5e-6;
  double radius_spread = 0.1;  // standard deviation / mean
  double coverage = 0.3;       // projected area of the caps / area
  double embedding = 0.5;      // share of the diameter below the film
  double clustering = 0;       // 0: uniform; 1: every particle touches another
  int seed = 1;

  bool operator==(const ParticleFilm&) const = default;
};

struct Measured3d {
  std::string file;      // .npy .gsf .exr .tif
  double width = 0;      // lateral size where the file does not say [m]
  double patch = 12e-6;  // side of the square that is simulated, cut from the middle

  bool operator==(const Measured3d&) const = default;
};

struct Texture;
enum class Combine { Sum, Maximum };
struct Stack {
  Combine combine = Combine::Sum;
  std::vector<Texture> parts;

  bool operator==(const Stack&) const;
};

struct Texture {
  std::variant<Flat, HoleArray, PillarArray, Grating, RandomRough, ParticleFilm, Measured3d, Stack>
      kind;

  bool operator==(const Texture&) const = default;
};

inline bool Stack::operator==(const Stack& other) const {
  return combine == other.combine && parts == other.parts;
}

// Key `type` chooses the kind; the kind's own keys follow.
void fields(FieldVisitor& v, Texture& texture);
std::string texture_name(const Texture& texture);  // "hole_array"
const std::vector<std::string>& texture_kinds();   // every such name, in the order of the variant

// What a single key cannot say: (key, message) of every contradiction between keys.
std::vector<std::pair<std::string, std::string>> problems(const Texture& texture);

inline constexpr double kWindow = 12e-6;  // side of the window of the M3 paper [m]

// Smallest rectangle with a whole number of periods, n = max(2, round(target / period)) along x,
// sampled with `pixels` along x and nearly square pixels; even counts. Eq. geometry.2
Grid patch_grid(const Texture& texture, int pixels, double target = kWindow);

// The patch that is simulated: whole periods on both sides, its area as near as can be to that of
// the window and not much longer than wide, sampled no coarser than window / pixels (to at
// most `most` pixels a side), so that designs of different period are compared on like patches at
// like resolution. Without relief there is no period: every flat texture has the same patch.
// Half of both numbers is twice the pixel on any patch. Eq. geometry.2
Grid simulated_patch(const Texture& texture, int pixels, int most = 1024);

// Heights on a grid whose sides are whole numbers of periods (patch_grid, or tiles of it). Edges
// are averaged over the pixel: volume and open area are right to second order in the pixel. Throws
// InputError for what cannot be made (impossible coverage, unreadable file).
Heightmap generate(const Texture& texture, const Grid& grid);

// Closed-form margins; infinite where a texture has no such feature.
struct FabricationMargins {
  double min_hole = 0;      // smallest opening [m]
  double min_wall = 0;      // smallest land or wall [m]
  double aspect_ratio = 0;  // depth / smallest lateral feature
};
FabricationMargins fabrication_margins(const Texture& texture);

double open_fraction(const Texture& texture);   // projected share below the land (holes, grooves)
double texture_depth(const Texture& texture);   // highest minus lowest nominal plane [m]
double texture_period(const Texture& texture);  // [m]; 0: not periodic
double rim_radius(const Texture& texture);      // edge radius of convex rims [m]; infinite: no rims

}  // namespace papilla
