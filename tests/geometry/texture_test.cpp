#include "geometry/texture.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/constants.h"
#include "base/error.h"
#include "geometry/io/files.h"
#include "geometry/roughness.h"
#include "geometry/textures/particle_film.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::texture_test {
namespace {

double mean(const Heightmap& h) {
  return std::accumulate(h.z.begin(), h.z.end(), 0.0) / static_cast<double>(h.z.size());
}

TEST(HoleArray, RemovesThePublishedVolume) {
  // Vertical walls: mean height is -depth x pi a^2 / (4 period^2), also at 8 pixels a diameter.
  for (double diameter : {3e-6, 4e-6}) {
    Texture t{HoleArray{.diameter = diameter, .depth = 350e-9, .wall_angle = kPi / 2}};
    for (int pixels : {32, 128, 256}) {
      const Grid grid = patch_grid(t, pixels);
      const double expected = -350e-9 * kPi / 4 * square(diameter / 6e-6);
      EXPECT_NEAR(mean(generate(t, grid)), expected, 2e-3 * std::abs(expected)) << pixels;
    }
  }
}

TEST(HoleArray, HexagonalPatchHoldsWholePeriods) {
  Texture t{HoleArray{.lattice = Lattice::Hexagonal,
                      .period = 3e-6,
                      .diameter = 2e-6,
                      .depth = 1e-7,
                      .wall_angle = kPi / 2}};
  const Grid grid = patch_grid(t, 128);
  EXPECT_NEAR(std::fmod(grid.lx / 3e-6 + 1e-9, 1), 0, 1e-6);
  EXPECT_NEAR(std::fmod(grid.ly / (std::sqrt(3.0) * 3e-6) + 1e-9, 1), 0, 1e-6);
  EXPECT_NEAR(mean(generate(t, grid)), -1e-7 * facts(t).open_share.value(), 3e-3 * 1e-7);
}

TEST(SimulatedPatch, IsAlikeForEveryPeriod) {
  for (Lattice lattice : {Lattice::Square, Lattice::Hexagonal}) {
    for (double period = 0.5e-6; period < kWindow; period *= 1.07) {
      const Grid g =
          simulated_patch({HoleArray{.lattice = lattice, .period = period, .depth = 1e-7}}, 128);
      EXPECT_LT(std::abs(std::log(g.lx * g.ly / square(kWindow))), 0.7) << period;
      EXPECT_LE(std::max(g.lx / g.ly, g.ly / g.lx), 2.01) << period;
      EXPECT_LE(std::max(g.dx(), g.dy()), kWindow / 128 * (1 + 1e-9)) << period;
      EXPECT_GE(std::min(g.dx(), g.dy()), 0.8 * kWindow / 128) << period;
      EXPECT_NEAR(g.lx / period, std::round(g.lx / period), 1e-9);
    }
  }
  const Grid window{128, 128, kWindow, kWindow};
  EXPECT_EQ(simulated_patch({HoleArray{.period = 10e-6, .depth = 0}}, 128), window);
  EXPECT_EQ(simulated_patch({HoleArray{.period = 6e-6}}, 128), window);
  // A period far beyond the window is simulated whole, at the resolution that can be afforded.
  const Grid wide = simulated_patch({HoleArray{.period = 80e-6, .diameter = 40e-6}}, 256);
  EXPECT_EQ(wide.nx, 1024);
  EXPECT_DOUBLE_EQ(wide.lx, 80e-6);
  for (const double period : {6e-6, 80e-6, 900e-6}) {  // half of both numbers: twice the pixel
    const Texture t{HoleArray{.period = period, .diameter = period / 2}};
    const Grid fine = simulated_patch(t, 256, 1024), half = simulated_patch(t, 128, 512);
    EXPECT_NEAR(half.dx() / fine.dx(), 2, 0.05) << period;
  }
}

TEST(HoleArray, SlopedWallsRemoveAFrustum) {
  const double r = 1.5e-6, depth = 600e-9, angle = 70 * kPi / 180;
  Texture t{HoleArray{.depth = depth, .wall_angle = angle}};
  const double floor = r - depth / std::tan(angle);
  const double volume = kPi * depth / 3 * (r * r + r * floor + floor * floor);
  const Grid grid = patch_grid(t, 256);
  EXPECT_NEAR(mean(generate(t, grid)), -volume / 36e-12, 1e-3 * volume / 36e-12);
  EXPECT_NEAR(facts(t).margins.min_hole, 2 * floor, 1e-15);
}

TEST(HoleArray, ZeroDepthIsFlat) {
  Texture t{HoleArray{.depth = 0}};
  for (double z : generate(t, patch_grid(t, 64)).z) EXPECT_EQ(z, 0);
  EXPECT_TRUE(std::isinf(facts(t).margins.min_hole));
}

TEST(HoleArray, RimRadiusTakesAwayMaterialAtTheEdgeOnly) {
  Texture sharp{HoleArray{.depth = 600e-9, .wall_angle = kPi / 2}};
  Texture round{HoleArray{.depth = 600e-9, .wall_angle = kPi / 2, .edge_radius = 250e-9}};
  const Grid grid = patch_grid(sharp, 256);
  const Heightmap a = generate(sharp, grid), b = generate(round, grid);
  for (std::size_t i = 0; i < a.z.size(); ++i) EXPECT_LE(b.z[i], a.z[i] + 1e-15);
  // Pappus: the corner r^2 (1 - pi/4) swept round the hole at its centroid.
  // The spandrel's centroid lies (10 - 3 pi)/(12 - 3 pi) r = 0.2234 r from the wall.
  const double r = 250e-9;
  const double corner = r * r * (1 - kPi / 4);
  const double removed = (mean(a) - mean(b)) * grid.area() / 4;
  EXPECT_NEAR(removed, 2 * kPi * (1.5e-6 + 0.2234 * r) * corner, 0.02 * removed);
}

TEST(PillarArray, IsTheHoleArrayUpsideDown) {
  Texture pillars{PillarArray{.height = 3e-7, .wall_angle = kPi / 2}};
  const Heightmap h = generate(pillars, patch_grid(pillars, 128));
  EXPECT_NEAR(mean(h), 3e-7 * kPi / 16, 1e-3 * 3e-7);
  EXPECT_GE(*std::min_element(h.z.begin(), h.z.end()), -1e-20);
}

double mean_height(const Heightmap& h) {
  return std::accumulate(h.z.begin(), h.z.end(), 0.0) / static_cast<double>(h.z.size());
}

double share_below(const Heightmap& h, double level) {
  return static_cast<double>(
             std::count_if(h.z.begin(), h.z.end(), [&](double z) { return z < level; })) /
         static_cast<double>(h.z.size());
}

// Pixels that do not divide the period, and grooves from narrow ones to sharp ridges.
TEST(VGrooves, RemoveTheirTriangles) {
  for (const double width : {0.7e-6, 2e-6, 3e-6}) {
    const VGrooves grooves{.period = 3e-6, .width = width, .depth = 400e-9};
    const Heightmap h = generate(Texture{grooves}, Grid{130, 4, 12e-6, 1e-6});
    EXPECT_NEAR(mean_height(h), -400e-9 * width / (2 * 3e-6), 1e-15);
    EXPECT_NEAR(share_below(h, -200e-9), 0.5 * width / 3e-6, 2.0 / 130 * 4);
  }
  // Along a wall the height falls by the slope.
  const Heightmap h = generate(Texture{VGrooves{.period = 3e-6, .width = 3e-6, .depth = 600e-9}},
                               Grid{300, 4, 3e-6, 1e-6});
  EXPECT_NEAR(h(60, 0) - h(50, 0), -0.4 * 10 * h.grid.dx(), 1e-15);
  EXPECT_NEAR(h(240, 0) - h(250, 0), -0.4 * 10 * h.grid.dx(), 1e-15);
}

TEST(Waves, HaveTheRmsOfCosines) {
  for (const auto directions : {Waves::Directions::One, Waves::Directions::Both}) {
    const Waves waves{.directions = directions, .period = 4e-6, .depth = 300e-9};
    const Heightmap h = generate(Texture{waves}, Grid{256, 256, 12e-6, 12e-6});
    const double rms = 300e-9 / (directions == Waves::Directions::One ? std::sqrt(8.0) : 4.0);
    double square_sum = 0;
    for (double z : h.z) square_sum += square(z + 150e-9);
    EXPECT_NEAR(mean_height(h), -150e-9, 1e-15);
    EXPECT_NEAR(std::sqrt(square_sum / static_cast<double>(h.z.size())), rms, 1e-3 * rms);
    EXPECT_NEAR(share_below(h, -150e-9), 0.5, 0.02);
    EXPECT_EQ(directions == Waves::Directions::Both, h(5, 7) != h(5, 40));
    // The radius of a crest, from its second difference.
    const double step = h.grid.dx();
    const double bend = (h(255, 255) + h(1, 255) - 2 * h(0, 255)) / square(step);
    EXPECT_NEAR(-bend * *facts(Texture{waves}).rim_radius, 1, 0.01);
  }
}

TEST(CapArray, HasTheVolumeOfItsSpheres) {
  for (const Lattice lattice : {Lattice::Square, Lattice::Hexagonal}) {
    for (const double depth : {100e-9, 1e-6}) {  // shallow ones, half spheres
      CapArray caps{.lattice = lattice, .period = 3e-6, .diameter = 2e-6, .depth = depth};
      const double cap = kPi / 6 * depth * (3 * square(1e-6) + square(depth));
      const double cell = 9e-12 * (lattice == Lattice::Square ? 1 : std::sqrt(0.75));
      const Heightmap dimples = generate(Texture{caps}, patch_grid(Texture{caps}, 256));
      EXPECT_NEAR(mean_height(dimples), -cap / cell, 0.005 * cap / cell);
      caps.form = CapArray::Form::Domes;
      const Heightmap domes = generate(Texture{caps}, patch_grid(Texture{caps}, 256));
      for (std::size_t i = 0; i < domes.z.size(); ++i) ASSERT_EQ(domes.z[i], -dimples.z[i]);
      // What lies above half the height is discs of the width that the facts state.
      const double above = 1 - share_below(domes, 0.5 * depth);
      const double width = facts(Texture{caps}).margins.min_wall;
      EXPECT_NEAR(above, kPi / 4 * square(width) / cell, 0.03 * above);
    }
  }
}

TEST(CapArray, ContradictionsAreNamed) {
  const auto keys = [](const CapArray& caps) {
    std::vector<std::string> out;
    for (const auto& [key, message] : problems(Texture{caps})) out.push_back(key);
    return out;
  };
  EXPECT_EQ(keys({.period = 3e-6, .diameter = 2e-6, .depth = 1.1e-6}),
            (std::vector<std::string>{"depth"}));
  EXPECT_EQ(keys({.period = 2e-6, .diameter = 2.5e-6, .depth = 0.1e-6}),
            (std::vector<std::string>{"diameter"}));
  EXPECT_TRUE(keys({}).empty());
}

TEST(Grating, HasItsFill) {
  Texture t{Grating{.period = 4e-6, .width = 1.3e-6, .depth = 2e-7, .wall_angle = kPi / 2}};
  EXPECT_NEAR(mean(generate(t, patch_grid(t, 128))), -2e-7 * 1.3 / 4, 1e-12);
}

TEST(Texture, ContradictionsAreNamed) {
  EXPECT_EQ(problems(Texture{HoleArray{.period = 3e-6, .diameter = 3e-6}}).front().first,
            "diameter");
  EXPECT_EQ(problems(Texture{HoleArray{.depth = 1e-6, .wall_angle = 20 * kPi / 180}}).front().first,
            "wall_angle");
  EXPECT_EQ(problems(Texture{ParticleFilm{.coverage = 0.6}}).front().first, "coverage");
  EXPECT_TRUE(problems(Texture{HoleArray{}}).empty());
}

TEST(ParticleFilm, CoversItsShareWithoutOverlap) {
  const ParticleFilm film{.radius = 1e-6, .radius_spread = 0.1, .coverage = 0.35, .embedding = 0.5};
  const Grid grid{128, 128, 24e-6, 24e-6};
  const auto particles = place_particles(film, grid);
  double covered = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    covered += kPi * square(particles[i].radius);
    for (std::size_t j = 0; j < i; ++j) {
      double dx = particles[i].x - particles[j].x, dy = particles[i].y - particles[j].y;
      dx -= 24e-6 * std::round(dx / 24e-6);
      dy -= 24e-6 * std::round(dy / 24e-6);
      EXPECT_GE(std::hypot(dx, dy), (particles[i].radius + particles[j].radius) * (1 - 1e-12));
    }
  }
  EXPECT_NEAR(covered / grid.area(), 0.35, 0.005);
  EXPECT_THROW(
      place_particles(ParticleFilm{.radius = 7e-6, .coverage = 0.5}, {64, 64, 12e-6, 12e-6}),
      InputError);
}

TEST(Stack, SumsItsParts) {
  Stack stack;
  stack.parts = {Texture{HoleArray{}}, Texture{RandomRough{}}};
  const Texture t{stack};
  const Grid grid = patch_grid(t, 64);
  const Heightmap sum = generate(t, grid), a = generate(stack.parts[0], grid),
                  b = generate(stack.parts[1], grid);
  for (std::size_t i = 0; i < sum.z.size(); ++i) EXPECT_DOUBLE_EQ(sum.z[i], a.z[i] + b.z[i]);
}

TEST(RandomSurface, HasItsRmsAndIsTheSameOnFinerGrids) {
  const Spectrum s{256e-9, 3.7e-6, 0.8, 400e-9};
  const Heightmap coarse = random_surface(s, {64, 64, 12e-6, 12e-6}, 1, 2);
  const Heightmap fine = random_surface(s, {192, 192, 12e-6, 12e-6}, 1, 2);
  EXPECT_NEAR(roughness_parameters(fine).sq, 256e-9, 1e-12);
  // Pixel centres coincide for an odd ratio.
  for (int iy = 0; iy < 64; ++iy) {
    for (int ix = 0; ix < 64; ++ix)
      EXPECT_NEAR(coarse(ix, iy), fine(3 * ix + 1, 3 * iy + 1), 1e-18);
  }
}

TEST(RandomSurface, OffsetMovesIt) {
  const Spectrum s{1e-7, 3e-6, 0.8, 5e-7};
  const Grid grid{64, 64, 12e-6, 12e-6};
  const Heightmap a = random_surface(s, grid, 1, 0),
                  b = random_surface(s, grid, 1, 0, 3 * grid.dx(), 5 * grid.dy());
  for (int iy = 0; iy < 64; ++iy) {
    for (int ix = 0; ix < 64; ++ix)
      EXPECT_NEAR(a(ix, iy), b(wrap(ix + 3, 64), wrap(iy + 5, 64)), 1e-18);
  }
}

TEST(Roughness, CosineHasItsClosedForms) {
  const double amplitude = 0.3e-6, period = 6e-6;
  Heightmap h{{256, 4, period, period / 64}, {}};
  h.z.resize(h.grid.size());
  for (int iy = 0; iy < 4; ++iy) {
    for (int ix = 0; ix < 256; ++ix)
      h(ix, iy) = amplitude * std::cos(2 * kPi * h.grid.x(ix) / period);
  }
  const RoughnessParameters r = roughness_parameters(h);
  EXPECT_NEAR(r.sa, 2 * amplitude / kPi, 1e-4 * amplitude);
  EXPECT_NEAR(r.sq, amplitude / std::sqrt(2.0), 1e-10 * amplitude);
  EXPECT_NEAR(r.ssk, 0, 1e-10);
  EXPECT_NEAR(r.sku, 1.5, 1e-10);
  EXPECT_NEAR(r.sdq, std::sqrt(2.0) * kPi * amplitude / period, 2e-4);
  EXPECT_NEAR(r.sdr, 0.0242352, 1e-4 * 0.0242);
  EXPECT_FALSE(r.slopes_sampling_limited);
}

TEST(Roughness, HolesHaveTheirMomentsAndFlagTheirSlopes) {
  Texture t{HoleArray{.diameter = 4e-6, .depth = 350e-9, .wall_angle = kPi / 2}};
  const RoughnessParameters r = roughness_parameters(generate(t, patch_grid(t, 512)));
  const double f = facts(t).open_share.value();
  EXPECT_NEAR(r.sq, 350e-9 * std::sqrt(f * (1 - f)), 0.01 * r.sq);
  EXPECT_NEAR(r.ssk, -(1 - 2 * f) / std::sqrt(f * (1 - f)), 0.03);
  EXPECT_TRUE(r.slopes_sampling_limited);
}

TEST(Measured, HeightsInAnotherUnitAreRefused) {
  const Grid grid{32, 32, 20e-6, 20e-6};
  Heightmap map{grid, std::vector<double>(grid.size())};
  for (std::size_t i = 0; i < map.z.size(); ++i)
    map.z[i] = static_cast<double>(i % 7);  // um, not m
  const std::string path = temporary("unit.npy");
  write_npy(path, map);
  Measured3d measured;
  measured.file = path;
  measured.width = grid.lx;
  measured.patch = 12e-6;
  EXPECT_NE(refusal_of([&] {
              generate(Texture{measured}, {32, 32, 12e-6, 12e-6});
            }).find("another unit"),
            std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::texture_test
