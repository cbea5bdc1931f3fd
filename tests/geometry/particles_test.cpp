// Particles sit as deep as they are said to.
#include "geometry/particles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "geometry/texture.h"

namespace papilla {
namespace {

ParticleFilm equal_spheres(double embedding) {
  ParticleFilm film;
  film.radius = 1e-6;
  film.radius_spread = 0;
  film.coverage = 0.1;
  film.clustering = 0;
  film.embedding = embedding;
  return film;
}

TEST(Particles, StandOutOfTheFilmByWhatIsNotEmbedded) {
  const Grid grid{512, 512, 12e-6, 12e-6};
  for (double embedding : {0.0, 0.2, 0.5, 0.8}) {
    const ParticleFilm film = equal_spheres(embedding);
    const Heightmap h = particle_heights(film, grid);
    const double top = 2 * film.radius * (1 - embedding);
    EXPECT_NEAR(*std::max_element(h.z.begin(), h.z.end()), top, 2e-3 * film.radius) << embedding;
    EXPECT_EQ(*std::min_element(h.z.begin(), h.z.end()), 0) << embedding;
  }
}

TEST(Particles, HaveTheVolumeOfTheirCaps) {
  const Grid grid{768, 768, 12e-6, 12e-6};
  for (double embedding : {0.5, 0.8}) {
    const ParticleFilm film = equal_spheres(embedding);
    const double count = static_cast<double>(place_particles(film, grid).size());
    ASSERT_GT(count, 1);
    double volume = 0;
    for (double z : particle_heights(film, grid).z) volume += z * grid.pixel_area();
    const double cap = 2 * film.radius * (1 - embedding);  // its height
    const double expected = count * kPi / 3 * cap * cap * (3 * film.radius - cap);
    EXPECT_NEAR(volume, expected, 0.01 * expected) << embedding;
  }
}

}  // namespace
}  // namespace papilla
