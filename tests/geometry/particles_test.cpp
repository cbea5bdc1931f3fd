// Particles sit as deep as they are said to.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "geometry/texture.h"
#include "geometry/textures/particle_film.h"

namespace papilla::tests::particles_test {
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
    const Heightmap h = generate(Texture{film}, grid);
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
    for (double z : generate(Texture{film}, grid).z) volume += z * grid.pixel_area();
    const double cap = 2 * film.radius * (1 - embedding);  // its height
    const double expected = count * kPi / 3 * cap * cap * (3 * film.radius - cap);
    EXPECT_NEAR(volume, expected, 0.01 * expected) << embedding;
  }
}

// Against every pixel asked of every particle and its images: clustered ones of several sizes
// across the edges of an oblong patch of oblong pixels.
TEST(Particles, AreTheHighestSphereOverEveryPixel) {
  const Grid grid{96, 72, 12e-6, 15e-6};
  for (double embedding : {0.1, 0.7}) {
    ParticleFilm film = equal_spheres(embedding);
    film.radius_spread = 0.3, film.coverage = 0.3, film.clustering = 0.6;
    const std::vector<Particle> particles = place_particles(film, grid);
    const Heightmap h = generate(Texture{film}, grid);
    int raised = 0;
    for (int iy = 0; iy < grid.ny; ++iy) {
      for (int ix = 0; ix < grid.nx; ++ix) {
        double expected = 0;
        for (const Particle& p : particles) {
          const double dx = std::remainder((ix + 0.5) * grid.dx() - p.x, grid.lx);
          const double dy = std::remainder((iy + 0.5) * grid.dy() - p.y, grid.ly);
          const double above2 = p.radius * p.radius - dx * dx - dy * dy;
          if (above2 > 0)
            expected = std::max(expected, p.radius * (1 - 2 * embedding) + std::sqrt(above2));
        }
        raised += expected > 0;
        ASSERT_NEAR(h(ix, iy), expected, 1e-12 * film.radius) << ix << " " << iy;
      }
    }
    EXPECT_GT(raised, grid.nx * grid.ny / 5);
  }
}

// Thousands of clustered particles asked each other: minutes.
TEST(Particles, OfManySmallOnesNoTwoOverlap) {
  ParticleFilm film = equal_spheres(0.2);
  film.radius = 0.05e-6, film.radius_spread = 0.3, film.coverage = 0.4, film.clustering = 0.7;
  const Grid grid{64, 64, 12e-6, 9e-6};
  const std::vector<Particle> particles = place_particles(film, grid);
  ASSERT_GT(particles.size(), 4000u);
  double worst = 1;  // distance over what two need
  for (std::size_t i = 0; i < particles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double dx = std::remainder(particles[i].x - particles[j].x, grid.lx),
                   dy = std::remainder(particles[i].y - particles[j].y, grid.ly);
      worst = std::min(worst, std::hypot(dx, dy) / (particles[i].radius + particles[j].radius));
    }
  }
  EXPECT_GT(worst, 1 - 1e-12);
}

// Spheres that sit deep are widest below the film, where nothing is seen of it.
TEST(Particles, ThatSitDeepDoNotRunThroughEachOtherBelowTheFilm) {
  ParticleFilm film = equal_spheres(0.8);
  film.coverage = 0.3, film.clustering = 0.5;
  const Grid grid{64, 64, 24e-6, 24e-6};
  const std::vector<Particle> particles = place_particles(film, grid);
  ASSERT_GT(particles.size(), 60u);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double dx = std::remainder(particles[i].x - particles[j].x, grid.lx),
                   dy = std::remainder(particles[i].y - particles[j].y, grid.ly);
      EXPECT_GT(std::hypot(dx, dy), (2 - 1e-9) * film.radius) << i << " " << j;
    }
  }
}

// Their widest circles jam: of 80 % embedded ones 1/(4 x .8 x .2) of what is seen.
TEST(Particles, JamByTheirWidestCircles) {
  ParticleFilm film = equal_spheres(0.8);
  film.coverage = 0.33;
  EXPECT_TRUE(problems(Texture{film}).empty());
  film.coverage = 0.34;
  const TextureProblems said = problems(Texture{film});
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said.front().second,
            "random non-overlapping particles jam near 35.2 % where 80 % of their diameter lies "
            "below the film; use at most 33.3 %");
}

}  // namespace
}  // namespace papilla::tests::particles_test
