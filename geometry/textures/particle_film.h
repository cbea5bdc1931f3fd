// Random non-overlapping spheres that sit in a flat film.
#pragma once

#include "base/rooms.h"
#include "geometry/facts.h"

namespace papilla::geometry {

struct ParticleFilm {
  static constexpr std::string_view kName = "particle_film";
  static constexpr bool kNumbersAlone = true;

  double radius = 1.5e-6;      // mean [m]
  double radius_spread = 0.1;  // standard deviation / mean
  double coverage = 0.3;       // projected area of the caps / area
  double embedding = 0.5;      // share of the diameter below the film
  double clustering = 0;       // 0: uniform; 1: every particle touches another
  int seed = 1;

  bool operator==(const ParticleFilm&) const = default;
};

struct Particle {
  double x, y, radius;  // [m]
};

// Placed largest first by random sequential placement (Feder 1980), periodic; deterministic by
// seed. Throws InputError when the coverage cannot be reached. The spheres do not overlap, above
// the film or below it.
std::vector<Particle> place_particles(const ParticleFilm& film, const Grid& grid);

void fields(FieldVisitor& v, ParticleFilm& t);
Heightmap heights(const ParticleFilm& t, const Grid& grid);
TextureProblems problems(const ParticleFilm& t);
TextureFacts facts(const ParticleFilm& t);
Roles roles(ParticleFilm& t);

}  // namespace papilla::geometry
