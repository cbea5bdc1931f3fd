// Where features lie on a patch: at their lattice points, whatever the sides of pixels and patch.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "geometry/profile.h"
#include "geometry/roughness.h"
#include "geometry/texture.h"
#include "geometry/textures/particle_film.h"
#include "tests/temporary.h"

namespace papilla::tests::places_test {
namespace {

// Height of the pixel that holds (x, y) [m].
double height_at(const Heightmap& h, double x, double y) {
  return h(static_cast<int>(x / h.grid.dx()), static_cast<int>(y / h.grid.dy()));
}

TEST(Places, FeaturesOfASquareLatticeLieInTheMiddleOfTheirCells) {
  const Grid grid{120, 100, 12e-6, 16e-6};  // 3 x 4 cells of 4 um, oblong pixels
  const HoleArray holes{.period = 4e-6, .diameter = 2e-6, .depth = 3e-7, .wall_angle = kPi / 2};
  const PillarArray pillars{
      .period = 4e-6, .diameter = 2e-6, .height = 3e-7, .wall_angle = kPi / 2};
  const CapArray caps{.period = 4e-6, .diameter = 2e-6, .depth = 3e-7};
  for (const auto& [texture, centre, land] : {std::tuple{Texture{holes}, -3e-7, 0.0},
                                              {Texture{pillars}, 3e-7, 0.0},
                                              {Texture{caps}, -3e-7, 0.0}}) {
    const Heightmap h = generate(texture, grid);
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 3; ++i) {
        const double x = (i + 0.5) * 4e-6, y = (j + 0.5) * 4e-6;
        EXPECT_NEAR(height_at(h, x, y), centre, 0.03 * 3e-7) << texture_name(texture);
        EXPECT_NEAR(height_at(h, x - 0.8e-6, y), centre, 0.75 * 3e-7);  // still in it
        EXPECT_NE(height_at(h, x - 0.8e-6, y), land);
        EXPECT_NEAR(height_at(h, x - 1.3e-6, y), land, 1e-15) << texture_name(texture);
        EXPECT_NEAR(height_at(h, x, y + 1.3e-6), land, 1e-15) << texture_name(texture);
        EXPECT_NEAR(height_at(h, x + 1.9e-6, y + 1.9e-6), land, 1e-15);
      }
    }
  }
}

TEST(Places, FeaturesOfAHexagonalLatticeLieAQuarterAndThreeQuartersIn) {
  const double period = 4e-6, row = std::sqrt(3.0) * period;
  const Grid grid{200, 260, 2 * period, row};
  for (const bool deep : {true, false}) {
    const Texture texture = deep ? Texture{HoleArray{.lattice = Lattice::Hexagonal,
                                                     .period = period,
                                                     .diameter = 2e-6,
                                                     .depth = 3e-7,
                                                     .wall_angle = kPi / 2}}
                                 : Texture{CapArray{.form = CapArray::Form::Domes,
                                                    .lattice = Lattice::Hexagonal,
                                                    .period = period,
                                                    .diameter = 2e-6,
                                                    .depth = 3e-7}};
    const Heightmap h = generate(texture, grid);
    const double centre = deep ? -3e-7 : 3e-7;
    for (const double x : {0.25 * period, 1.25 * period}) {
      for (const double y : {0.25 * row, 0.75 * row}) {
        const double at = y > 0.5 * row ? x + 0.5 * period : x;
        EXPECT_NEAR(height_at(h, at, y), centre, 0.01 * 3e-7) << deep;
        for (int k = 0; k < 12; ++k) {  // land all around, within the patch
          const double angle = kPi / 6 * k, u = at + 1.2e-6 * std::cos(angle);
          const double v = y + 1.2e-6 * std::sin(angle);
          if (u > 0 && u < grid.lx) {
            EXPECT_NEAR(height_at(h, u, v), 0, 1e-15) << deep << " " << k;
          }
        }
      }
    }
  }
}

TEST(Places, GroovesLieInTheMiddleOfTheirPeriods) {
  const Grid grid{160, 3, 8e-6, 1e-6};
  const Heightmap grooves = generate(
      Texture{Grating{.period = 4e-6, .width = 1e-6, .depth = 2e-7, .wall_angle = kPi / 2}}, grid);
  const Heightmap vees =
      generate(Texture{VGrooves{.period = 4e-6, .width = 1e-6, .depth = 2e-7}}, grid);
  for (int ix = 0; ix < grid.nx; ++ix) {
    const double off = std::abs(std::fmod(grid.x(ix), 4e-6) - 2e-6);  // from the middle
    const double wall = 0.5 * grid.dx();
    EXPECT_NEAR(grooves(ix, 1), off < 0.5e-6 ? -2e-7 : 0, 1e-15) << ix;
    if (off > wall) {
      EXPECT_NEAR(vees(ix, 1), off < 0.5e-6 ? -2e-7 * (1 - off / 0.5e-6) : 0, 1e-14) << ix;
    }
    EXPECT_EQ(grooves(ix, 0), grooves(ix, 2));
  }
}

TEST(PatchGrid, HoldsWholeCellsNearTheWantedSideInCountsThatHalve) {
  const Texture square{HoleArray{.period = 5e-6}},
      hexagonal{HoleArray{.lattice = Lattice::Hexagonal, .period = 5e-6}};
  const double row = std::sqrt(3.0) * 5e-6;
  for (const auto& [texture, wanted, columns, lx, ly] : {std::tuple{square, 23e-6, 5, 25e-6, 25e-6},
                                                         {square, 1e-6, 2, 10e-6, 10e-6},
                                                         {hexagonal, 23e-6, 5, 25e-6, 3 * row},
                                                         {hexagonal, 1e-6, 2, 10e-6, row}}) {
    for (const int pixels : {64, 100, 101}) {
      const Grid g = patch_grid(texture, pixels, wanted);
      EXPECT_NEAR(g.lx, lx, 1e-15) << columns;
      EXPECT_NEAR(g.ly, ly, 1e-15) << columns;
      EXPECT_EQ(g.nx, pixels + pixels % 2);
      const int multiple = pixels % 16 == 0 ? 16 : 2;
      EXPECT_EQ(g.ny % multiple, 0) << g.ny;
      EXPECT_LE(std::abs(g.ny - g.nx * ly / lx), 0.5 * multiple + 0.5) << g.ny;
    }
  }
  EXPECT_EQ(patch_grid(Texture{}, 64, 7e-6), (Grid{64, 64, 7e-6, 7e-6}));
  // Particles need eight of their radii.
  EXPECT_EQ(patch_grid(Texture{ParticleFilm{.radius = 3e-6}}, 64, 7e-6),
            (Grid{64, 64, 24e-6, 24e-6}));
}

// The same particles on a longer patch: what a search over the coverage sees has no step.
TEST(Particles, OfAThinFilmKeepTheCoverageOnALongerPatch) {
  std::vector<double> radii;
  for (const double coverage : {0.006, 0.01, 0.03, 0.1}) {
    const ParticleFilm film{.coverage = coverage};
    const Grid patch = patch_grid(Texture{film}, 64);
    const std::vector<Particle> all = place_particles(film, patch);
    ASSERT_EQ(all.size(), 4u) << coverage;
    double covered = 0;
    std::vector<double> own;
    for (const Particle& p : all) {
      covered += kPi * square(p.radius);
      own.push_back(p.radius);
    }
    EXPECT_NEAR(covered, coverage * patch.area(), 1e-9 * covered) << coverage;
    if (radii.empty()) radii = own;
    EXPECT_EQ(own, radii) << coverage;
  }
  EXPECT_EQ(patch_grid(Texture{ParticleFilm{.coverage = 0.3}}, 64).lx, 12e-6);
  EXPECT_EQ(patch_grid(Texture{ParticleFilm{.radius = 9e-6, .coverage = 0}}, 64).lx, 12e-6);
}

// Beside a lattice too, in whole periods: on 12 um one particle of 1.5 um would be 5 % of it, not
// the 1 % asked for.
TEST(Particles, OfAThinFilmBesideALatticeHaveAPatchThatHoldsThem) {
  const ParticleFilm film{.coverage = 0.01};
  const Texture holes{HoleArray{.period = 6e-6, .diameter = 3e-6}};
  const double least = facts(Texture{film}).free_patch.least;
  const double side = 6e-6 * std::ceil(least / 6e-6);
  const Texture both{Stack{.parts = {holes, Texture{film}}}};
  for (const Grid& patch : {simulated_patch(both, 64), patch_grid(both, 64)}) {
    EXPECT_NEAR(patch.lx, side, 1e-12);
    EXPECT_NEAR(patch.ly, side, 1e-12);
    double covered = 0;
    for (const Particle& p : place_particles(film, patch)) covered += kPi * square(p.radius);
    EXPECT_NEAR(covered, 0.01 * patch.area(), 0.5 * kPi * square(1.7 * film.radius));
  }
  EXPECT_EQ(simulated_patch(Texture{Stack{.parts = {holes}}}, 64), simulated_patch(holes, 64));
  const Texture none{Stack{.parts = {holes, Texture{ParticleFilm{.radius = 9e-6, .coverage = 0}}}}};
  EXPECT_EQ(simulated_patch(none, 64), simulated_patch(holes, 64));
}

TEST(Particles, OfAFilmTooThinForAPatchAreRefused) {
  EXPECT_TRUE(problems(Texture{ParticleFilm{.coverage = 0}}).empty());
  EXPECT_TRUE(problems(Texture{ParticleFilm{.coverage = 0.006}}).empty());
  EXPECT_TRUE(problems(Texture{ParticleFilm{.radius = 0.05e-6, .coverage = 0.001}}).empty());
  const auto said = problems(Texture{ParticleFilm{.radius_spread = 0, .coverage = 0.001}});
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said.front().first, "coverage");
  EXPECT_EQ(said.front().second,
            "so few particles that 4 of them need a patch of 168 um, which is more than the 75 um "
            "that are simulated; use at least 0.53 %, or 0 % for none");
  EXPECT_TRUE(problems(Texture{ParticleFilm{.radius_spread = 0, .coverage = 0.0053}}).empty());
}

TEST(Particles, OfAClusterTouchOneAnotherAndStayOnTheirPatch) {
  const ParticleFilm film{
      .radius = 0.5e-6, .radius_spread = 0.1, .coverage = 0.1, .embedding = 0.7, .clustering = 1};
  const Grid grid{128, 64, 24e-6, 8e-6};
  const std::vector<Particle> all = place_particles(film, grid);
  ASSERT_GT(all.size(), 10u);
  const auto disc = [](const Particle& p) {  // of a cap of 0.6 radii
    return p.radius * std::sqrt(0.6 * 1.4);
  };
  double covered = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Particle& p = all[i];
    EXPECT_TRUE(p.x >= 0 && p.x <= grid.lx && p.y >= 0 && p.y <= grid.ly) << p.x << " " << p.y;
    covered += kPi * square(disc(p));
    double nearest = kInfinity;
    for (std::size_t j = 0; j < all.size(); ++j) {
      if (j == i) continue;
      const double dx = p.x - all[j].x, dy = p.y - all[j].y;
      const double way = std::hypot(dx - grid.lx * std::round(dx / grid.lx),
                                    dy - grid.ly * std::round(dy / grid.ly));
      nearest = std::min(nearest, way - p.radius - all[j].radius);  // below the film
    }
    EXPECT_NEAR(nearest, 0, 1e-12) << i;
  }
  EXPECT_NEAR(covered / grid.area(), 0.1, 0.5 * kPi * square(0.5e-6) / grid.area());
  // One that is as wide as the patch has no place.
  try {
    place_particles({.radius = 4.1e-6, .radius_spread = 0, .coverage = 0.3, .embedding = 0}, grid);
    FAIL() << "placed";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("30 % with particles of 4.1 um radius"),
              std::string::npos)
        << error.what();
  }
  EXPECT_NO_THROW(place_particles(
      {.radius = 3.9e-6, .radius_spread = 0, .coverage = 0.3, .embedding = 0}, grid));
}

TEST(Stacks, TakeTheHigherOrTheSumAndTheWorstOfTheirParts) {
  const HoleArray holes{.period = 6e-6, .diameter = 4e-6, .depth = 3e-7};
  const PillarArray pillars{.period = 3e-6, .diameter = 1e-6, .height = 4e-7};
  Stack stack;
  stack.parts = {Texture{holes}, Texture{pillars}};
  stack.combine = Combine::Maximum;
  const Grid grid{48, 48, 6e-6, 6e-6};
  const Heightmap h = generate(Texture{stack}, grid), a = generate(stack.parts[0], grid),
                  b = generate(stack.parts[1], grid);
  for (std::size_t i = 0; i < h.z.size(); ++i) ASSERT_EQ(h.z[i], std::max(a.z[i], b.z[i]));
  const TextureFacts of = facts(Texture{stack}), one = facts(stack.parts[0]),
                     two = facts(stack.parts[1]);
  EXPECT_EQ(of.period(), 6e-6);
  EXPECT_EQ(of.relief.planes->low, 0);  // the floor between pillars is above that of holes
  EXPECT_EQ(of.relief.planes->high, 4e-7);
  EXPECT_EQ(of.margins.min_hole, std::min(one.margins.min_hole, two.margins.min_hole));
  EXPECT_EQ(of.margins.min_wall, std::min(one.margins.min_wall, two.margins.min_wall));
  EXPECT_EQ(of.margins.aspect_ratio, std::max(one.margins.aspect_ratio, two.margins.aspect_ratio));
  stack.combine = Combine::Sum;
  EXPECT_EQ(facts(Texture{stack}).relief.planes->low, -3e-7);
  EXPECT_EQ(facts(Texture{stack}).relief.planes->high, 4e-7);
  EXPECT_TRUE(problems(Texture{stack}).empty());
  // A period that does not divide the longest, and a part that contradicts itself, by their places.
  stack.parts.push_back(Texture{HoleArray{.period = 2.5e-6, .diameter = 2.6e-6}});
  std::vector<std::string> keys;
  for (const auto& [key, message] : problems(Texture{stack})) keys.push_back(key);
  EXPECT_EQ(keys, (std::vector<std::string>{"parts.2.diameter", "parts.2.period"}));
  EXPECT_EQ(problems(Texture{Stack{}}).front().first, "parts");
}

// Walls of 45 degrees around a flat floor, each pixel against 32 x 32 places in it.
TEST(Places, PixelsOfASlantedWallAreAveragesOverTheirSquares) {
  const HoleArray holes{.period = 6e-6, .diameter = 4e-6, .depth = 1e-6, .wall_angle = kPi / 4};
  const Grid grid{60, 60, 6e-6, 6e-6};
  const Heightmap h = generate(Texture{holes}, grid);
  constexpr int kParts = 32;
  for (int iy = 0; iy < 30; ++iy) {  // a quarter: the hole is the same all round
    for (int ix = 0; ix < 30; ++ix) {
      double sum = 0;
      for (int k = 0; k < kParts * kParts; ++k) {
        const double x = (ix + (k % kParts + 0.5) / kParts) * grid.dx() - 3e-6,
                     y = (iy + (k / kParts + 0.5) / kParts) * grid.dy() - 3e-6;
        sum += std::clamp(2e-6 - std::hypot(x, y), 0.0, 1e-6);
      }
      // At a bend of 45 degrees an average along the radius alone is off by 0.7 % of a pixel.
      EXPECT_NEAR(h(ix, iy), -sum / (kParts * kParts), 1.5e-3 * grid.dx()) << ix << " " << iy;
    }
  }
}

// The margins of an array by hand: walls of 60 degrees narrow a hole of 4 um by twice 0.3 um / tan.
// A hole shallower than the radius of its rim: the floor cuts the arc, which begins a radius before
// the edge of an upright wall.
TEST(WallProfile, OfAShallowHoleIsTheArcDownToItsFloor) {
  const double radius = 200e-9, depth = 50e-9, pixel = 0.01e-9;
  const WallProfile wall(depth, kPi / 2, radius);
  for (const double t : {-20e-9, 10e-9, 60e-9, 130e-9, 134e-9, 180e-9, 300e-9}) {
    const double arc = t <= 0       ? 0
                       : t < radius ? radius - std::sqrt(radius * radius - t * t)
                                    : radius;
    EXPECT_NEAR(wall.mean_drop(t - radius, pixel), std::min(arc, depth), 1e-12) << t;
  }
}

TEST(WallProfile, IsAsDeepAsAskedWhereItIsSaidToBe) {
  const double depth = 300e-9;
  for (const double angle : {kPi / 6, kPi / 3, 1.5}) {
    for (const double rim : {0.0, 80e-9, 5e-6}) {
      const WallProfile wall(depth, angle, rim);
      for (const double share : {0.05, 0.5, 0.999})
        EXPECT_NEAR(wall.drop(wall.inside(share * depth)), share * depth, 1e-15) << angle << rim;
    }
  }
}

// Straight walls take half of their run a side, and rims that end above the middle nothing.
TEST(Widths, AtHalfTheDepthAreThoseOfTheStraightWall) {
  const double run = 3e-7 / std::tan(kPi / 3);
  for (const double rim : {0.0, 50e-9}) {
    const WallSection wall{3e-7, kPi / 3, rim};
    const FeatureArray holes{FeatureArray::Shape::Disc, true, Lattice::Square, 6e-6, 4e-6, "holes"},
        pillars{FeatureArray::Shape::Disc, false, Lattice::Square, 6e-6, 2e-6, "pillars"};
    EXPECT_NEAR(width_at_half_depth(holes, wall), 4e-6 - run, 1e-15);
    EXPECT_NEAR(width_at_half_depth(pillars, wall), 2e-6 + run, 1e-15);
  }
}

TEST(Margins, AreThoseOfTheFloorAndTheLand) {
  const double run = 3e-7 / std::tan(kPi / 3);
  const HoleArray holes{.period = 6e-6, .diameter = 4e-6, .depth = 3e-7, .wall_angle = kPi / 3};
  const PillarArray pillars{
      .period = 6e-6, .diameter = 2e-6, .height = 3e-7, .wall_angle = kPi / 3};
  const FabricationMargins of_holes = facts(Texture{holes}).margins,
                           of_pillars = facts(Texture{pillars}).margins;
  EXPECT_NEAR(of_holes.min_hole, 4e-6 - 2 * run, 1e-15);
  EXPECT_NEAR(of_holes.min_wall, 2e-6, 1e-15);
  EXPECT_NEAR(of_holes.aspect_ratio, 3e-7 / 2e-6, 1e-9);
  EXPECT_NEAR(of_pillars.min_hole, 4e-6 - 2 * run, 1e-15);
  EXPECT_NEAR(of_pillars.min_wall, 2e-6, 1e-15);
  EXPECT_NEAR(of_holes.smallest(), 2e-6, 1e-15);
  const VGrooves vees{.period = 5e-6, .width = 3e-6, .depth = 4e-7};
  EXPECT_NEAR(*facts(Texture{vees}).relief.height(), 4e-7, 1e-15);
  EXPECT_NEAR(facts(Texture{vees}).cell->x, 5e-6, 1e-15);
}

TEST(Problems, SayWhatContradictsWhatWithItsNumbers) {
  const auto first = [](const Texture& t) { return problems(t).at(0); };
  EXPECT_EQ(first(Texture{HoleArray{.period = 3e-6, .diameter = 3.25e-6}}).second,
            "3.25 um is not smaller than the period 3 um; features would overlap");
  // Walls that just do not meet, and such that do.
  EXPECT_TRUE(
      problems(Texture{Grating{.width = 2e-6, .depth = 0.99e-6, .wall_angle = kPi / 4}}).empty());
  const auto steep =
      first(Texture{Grating{.width = 2e-6, .depth = 1.01e-6, .wall_angle = kPi / 4}});
  EXPECT_EQ(steep.first, "wall_angle");
  EXPECT_NE(steep.second.find("walls of 45 deg meet before the depth of 1010 nm"),
            std::string::npos)
      << steep.second;
  EXPECT_NE(first(Texture{CapArray{.diameter = 2e-6, .depth = 1.1e-6}}).second.find("1100 nm"),
            std::string::npos);
  EXPECT_TRUE(problems(Texture{ParticleFilm{.coverage = 0.52}}).empty());
  EXPECT_EQ(first(Texture{ParticleFilm{.coverage = 0.521}}).first, "coverage");
}

// Committed results and journals of searches name a skin by its seed alone: in every version it is
// the same one.
TEST(RandomSurface, OfASeedIsTheSameOneInEveryVersion) {
  const Spectrum s{.rms = 100e-9, .roll_off = 2e-6, .hurst = 0.8, .cutoff = 0.5e-6};
  const Heightmap h = random_surface(s, {32, 24, 6e-6, 6e-6}, 7, 3);
  std::vector<double> some;
  for (const std::size_t i : {0u, 100u, 333u}) some.push_back(1e9 * h.z[i]);
  EXPECT_NEAR(some[0], -282.350156991284, 1e-9);
  EXPECT_NEAR(some[1], -11.3125973766058, 1e-9);
  EXPECT_NEAR(some[2], 88.8001451401623, 1e-9);
}

}  // namespace
}  // namespace papilla::tests::places_test
