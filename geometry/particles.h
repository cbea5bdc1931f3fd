// Random non-overlapping spherical caps on a film.
#pragma once

#include <vector>

#include "geometry/texture.h"

namespace papilla {

struct Particle {
  double x, y, radius;  // [m]
};

// Placed largest first by random sequential placement (Feder 1980), periodic; deterministic by
// seed. Throws InputError when the coverage cannot be reached. Projected discs do not overlap.
std::vector<Particle> place_particles(const ParticleFilm& film, const Grid& grid);
Heightmap particle_heights(const ParticleFilm& film, const Grid& grid);

}  // namespace papilla
