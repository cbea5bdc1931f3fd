// What a random scene of the coverage is drawn as: its numbers from the stream of its index, one
// after the other.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "base/random.h"
#include "geometry/texture.h"
#include "measure/coverage.h"

namespace papilla::tests::drawn_scenes_test {
namespace {

// The kinds in turn; a wall is never so gentle that it meets the one across.
void expect_texture(int index, const Texture& texture, double period, double size, double depth,
                    double angle) {
  const double wall = std::max(angle, std::atan(2.2 * depth / size));
  const auto near = [index](double value, double drawn) {
    EXPECT_NEAR(value / drawn, 1, 1e-12) << index;
  };
  const auto array = [&](const auto& t, double its_size, double its_depth) {
    near(t.period, period), near(its_size, size), near(its_depth, depth), near(t.wall_angle, wall);
  };
  switch (index % 8) {
    case 0: {
      const auto& t = std::get<HoleArray>(texture.kind);
      return array(t, t.diameter, t.depth);
    }
    case 1: {
      const auto& t = std::get<PillarArray>(texture.kind);
      return array(t, t.diameter, t.height);
    }
    case 2: {
      const auto& t = std::get<Grating>(texture.kind);
      return array(t, t.width, t.depth);
    }
    case 3: {
      const auto& t = std::get<VGrooves>(texture.kind);
      near(t.period, period), near(t.width, size), near(t.depth, depth);
      return;
    }
    case 4: {
      const auto& t = std::get<Waves>(texture.kind);
      near(t.period, period), near(t.depth, depth);
      return;
    }
    case 5: {
      const auto& t = std::get<CapArray>(texture.kind);
      EXPECT_EQ(t.form, CapArray::Form::Domes);
      near(t.period, period), near(t.diameter, size), near(t.depth, std::min(depth, 0.45 * size));
      return;
    }
    case 6:
      return near(std::get<RandomRough>(texture.kind).rms, depth / 4);
    default:
      EXPECT_EQ(texture, Texture{}) << index;
  }
}

TEST(DrawnScenes, AreWhatTheStreamOfTheirIndexSays) {
  const Scene plain;
  int walls_that_meet = 0, domes_that_are_cut = 0;
  for (int i = 0; i < 64; ++i) {
    RandomStream stream(1, "accuracy scene", static_cast<std::uint64_t>(i));
    const auto next = [&](double low, double high) {
      return low + (high - low) * stream.uniform();
    };
    const auto factor = [&](double low, double high) {
      return std::exp(std::log(low) + std::log(high / low) * stream.uniform());
    };
    const double period = next(3e-6, 6e-6), size = next(0.3, 0.6) * period,
                 depth = next(50e-9, 900e-9), angle = next(kPi / 6, kPi / 2);
    walls_that_meet += i % 8 < 3 && std::tan(angle) < 2.2 * depth / size;
    domes_that_are_cut += i % 8 == 5 && depth > 0.45 * size;
    Texture texture;
    const Scene s = random_scene(i, texture);
    expect_texture(i, texture, period, size, depth, angle);
    const auto near = [i](double value, double drawn) {
      EXPECT_NEAR(value / drawn, 1, 1e-12) << i;
    };
    near(s.finger.skin.rms, next(150e-9, 350e-9));
    const double stiff = factor(0.6, 1.6), wet = factor(0.3, 3);
    near(s.finger.skin.layer_modulus, stiff * plain.finger.skin.layer_modulus);
    near(s.finger.skin.bulk_modulus, stiff * plain.finger.skin.bulk_modulus);
    ASSERT_EQ(s.finger.water.volume.size(), plain.finger.water.volume.size());
    for (std::size_t k = 0; k < s.finger.water.volume.size(); ++k)
      near(s.finger.water.volume[k], wet * plain.finger.water.volume[k]);
    near(s.surface.contact_angle, next(0.6, 1.9));
    // Alike everywhere, by the angle, level, and level below a coat; eight scenes each. No film is
    // level over a rough surface.
    const int film = i / 8 % 4;
    const bool level = film >= 2 && i % 8 != 6;
    EXPECT_EQ(s.surface.process, film == 1 ? FilmProcess::Directional
                                 : level   ? FilmProcess::Planar
                                           : FilmProcess::Conformal)
        << i;
    // A level film is as much thicker as the texture is to be deep, cut domes too.
    near(s.surface.dielectric.front().thickness,
         plain.surface.dielectric.front().thickness + (level ? depth : 0));
    ASSERT_EQ(s.surface.dielectric.size(), film == 3 ? 2u : 1u);
    if (film == 3) {
      const FilmDielectric& coat = s.surface.dielectric.back();
      EXPECT_EQ(coat.material, "Al2O3");
      near(coat.thickness, next(30e-9, 200e-9));
      near(coat.permittivity, next(6, 10));
      EXPECT_EQ(coat.process, LayerProcess::Conformal);
    }
    near(s.drive.amplitude, next(80, 220));
    const double dry = next(0.15, 0.45), wetter = dry + next(0.1, 0.3);
    ASSERT_EQ(s.environment.relative_humidity.size(), 2u);
    near(s.environment.relative_humidity[0], dry);
    near(s.environment.relative_humidity[1], wetter);
  }
  EXPECT_GT(walls_that_meet, 0);
  EXPECT_GT(domes_that_are_cut, 0);
}

}  // namespace
}  // namespace papilla::tests::drawn_scenes_test
