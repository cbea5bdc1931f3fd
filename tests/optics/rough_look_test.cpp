// Etched glass by its statistics: closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "forward/appearance.h"
#include "geometry/roughness.h"
#include "physics/optics/optics.h"
#include "physics/optics/sparkle.h"
#include "tests/support/glass.h"

namespace papilla::tests::rough_look_test {
namespace {

// Light beyond the cone of Gaussian heights of one scale, term by term.
double series(double rms, double length, double index, double wavelength, double cone) {
  const double s = square(2 * kPi * (index - 1) * rms / wavelength);
  double sum = 0;
  for (int k = 1; k < 400; ++k)
    sum += std::exp(-s + k * std::log(s) - std::lgamma(k + 1.0) -
                    square(kPi * length * std::sin(cone) / wavelength) / k);
  return sum;
}

TEST(RoughLook, GivesTheSeriesOfOneScale) {
  for (const double rms : {20e-9, 100e-9, 400e-9}) {
    for (const double length : {1e-6, 6e-6, 20e-6}) {
      for (const double cone : {2.5 * kPi / 180, 4 * kPi / 180}) {
        Light green{{550e-9}};
        green.meters.cone = cone;
        const Optics o = rough_look({{rms, length}}, {1.5, 1}, green);
        const double expected = series(rms, length, 1.5, 550e-9, cone);
        EXPECT_NEAR(o.haze, expected, 2e-3 * expected + 1e-9) << rms << " " << length;
        EXPECT_NEAR(o.spectrum[0].specular, std::exp(-square(2 * kPi * 0.5 * rms / 550e-9)), 1e-9);
      }
    }
  }
}

// Two scales: the fine one scatters a little, far out; the bumps much, near. Where both are weak
// the shares add up.
TEST(RoughLook, AFineScaleIsTheTailOfTheHaze) {
  const Light green{{550e-9}};
  const auto haze = [&](std::vector<RoughScale> scales) {
    return rough_look(scales, {1.5, 1}, green).haze;
  };
  const double bumps = haze({{80e-9, 20e-6}}), fine = haze({{8e-9, 0.5e-6}});
  const double both = haze({{80e-9, 20e-6}, {8e-9, 0.5e-6}});
  EXPECT_LT(bumps, 1e-6);
  EXPECT_NEAR(fine, series(8e-9, 0.5e-6, 1.5, 550e-9, kHazeAngle), 1e-6);
  EXPECT_NEAR(both, fine, 0.02 * fine);
}

// Gloss, haze and light to both sides of them against a sampled surface of 100 um.
TEST(RoughLook, IsThatOfASampledSurface) {
  const std::vector<RoughScale> scales{{60e-9, 2e-6}, {10e-9, 0.5e-6}};
  const Heightmap map = random_surface(scales, {512, 512, 100e-6, 100e-6}, 5);
  const Light light{{550e-9}, {0.0, 0.7}};
  const Optics closed = rough_look(scales, {1.5, 1}, light),
               sampled = phase_screen(map, {1.5, 1}, light);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(closed.spectrum[k].haze, sampled.spectrum[k].haze, 0.03 * sampled.spectrum[k].haze);
    EXPECT_NEAR(closed.spectrum[k].specular, sampled.spectrum[k].specular, 0.01);
  }
  EXPECT_NEAR(closed.gloss, sampled.gloss, 1.5);
  EXPECT_NEAR(closed.gloss_20, sampled.gloss_20, 1.5);
  EXPECT_NEAR(closed.gloss_85, sampled.gloss_85, 1.5);
}

TEST(EtchedGlass, LooksLikeItsStatisticsWhateverTheSeed) {
  EtchedGlass t{.rms = 120e-9, .correlation_length = 6e-6};
  const Optics a = appearance(Texture{t}, glass_of(1.5), {});
  EXPECT_EQ(a.regime, OpticsRegime::PhaseScreen);
  t.seed = 7;
  EXPECT_EQ(appearance(Texture{t}, glass_of(1.5), {}).haze, a.haze);
  EXPECT_TRUE(facts(Texture{t}).quick_look);
  t.rms = 2e-6, t.correlation_length = 3e-6;
  EXPECT_NE(appearance(Texture{t}, glass_of(1.5), {}).warning.find("too steep"), std::string::npos);
  t.length = 5e-6, t.fine_correlation_length = 4e-6;
  const TextureProblems wrong = problems(Texture{t});
  ASSERT_EQ(wrong.size(), 2u);
  EXPECT_EQ(wrong[0].first, "fine_correlation_length");
  EXPECT_EQ(wrong[1].first, "length");
}

Panel panel(double width, double height, double distance) {
  return {width, height, 1.2e-3 / 1.5, std::atan(2e-3 / distance), 550e-9};
}

// Bumps much coarser than subpixels are lenses: sparkle grows with the distance to the panel and
// falls with the square of the bumps; subpixels much coarser than bumps average them, by the root
// of their number.
TEST(Sparkle, ScalesWithPixelsAndDistance) {
  const std::vector<RoughScale> bumps{{20e-9, 40e-6}};
  const auto at = [&](double depth, double width, double height) {
    Panel p = panel(width, height, 0.5);
    p.depth = depth;
    return weak_sparkle(bumps, 0.5, p);
  };
  EXPECT_NEAR(at(0.2e-3, 5e-6, 5e-6) / at(0.1e-3, 5e-6, 5e-6), 2, 0.02);
  // Mean over width w of waves much shorter: ~ 1/w in each direction but for the longest waves.
  const double ratio = at(0.5e-3, 400e-6, 400e-6) / at(0.5e-3, 800e-6, 800e-6);
  EXPECT_GT(ratio, 2);
  EXPECT_LT(ratio, 5);
  // A pupil that sees a wider cone averages more.
  Panel far = panel(20e-6, 60e-6, 1), near = panel(20e-6, 60e-6, 0.1);
  EXPECT_GT(weak_sparkle({{20e-9, 4e-6}}, 0.5, far),
            1.2 * weak_sparkle({{20e-9, 4e-6}}, 0.5, near));
}

// A weak phase grating makes a pattern of contrast 4 a sin(q^2 z/2k): Talbot.
TEST(Sparkle, OfAGratingIsItsTalbotPattern) {
  Waves w;
  w.period = 50e-6, w.depth = 4e-9;
  const Heightmap map = generate(Texture{w}, {256, 2, w.period, w.period});
  Panel p{1e-9, 1e-9, 1e-3, 0, 550e-9};  // subpixels and a pupil like points
  const double k = 2 * kPi / 550e-9, q = 2 * kPi / w.period, a = k * 0.5 * 0.5 * w.depth;
  const double expected = 2 * a * std::abs(std::sin(0.5 * q * q * p.depth / k)) / std::sqrt(2.0);
  EXPECT_NEAR(map_sparkle(map, 0.5, p), expected, 1e-2 * expected);
  // Light of half a wave is averaged over a subpixel of one period.
  p.width = w.period;
  EXPECT_LT(map_sparkle(map, 0.5, p), 1e-3 * expected);
}

TEST(Sparkle, NeedsAPanel) {
  const EtchedGlass t;
  View view;
  EXPECT_EQ(appearance(Texture{t}, glass_of(1.5), view).sparkle, 0);
  view.panel.subpixel_width = 60e-6, view.panel.subpixel_height = 180e-6;
  const Optics seen = appearance(Texture{t}, glass_of(1.5), view);
  EXPECT_NEAR(seen.sparkle,
              rough_sparkle(facts(Texture{t}).rough, 0.5, *meters_of(glass_of(1.5), view).panel),
              1e-12);
  EXPECT_GT(seen.sparkle, 0.005);
}

// Cut into a film of another index: the film's top and what lies below scatter light differently.
// By one phase for both it read 6 GU less at 20 deg.
TEST(RoughLook, OfAFilmIsThatOfASampledSurface) {
  const std::vector<RoughScale> scales{{100e-9, 3e-6}};
  const Heightmap map = random_surface(scales, {512, 512, 100e-6, 100e-6}, 5);
  const Light light{{550e-9}};
  // Surfaces of 100 um differ from each other by 0.5 and 1.2 GU at 20 deg.
  for (const auto& [index, scatter] : {std::pair{1.46, 1.5}, {2.0, 3.0}}) {
    OpticalMedia film{index, 1};
    film.thickness = 1.5e-6, film.plate_index = 1.52, film.back = 1.52;
    film.films = {{1.9, 0.01, 20e-9}};
    const Optics closed = rough_look(scales, film, light), sampled = phase_screen(map, film, light);
    EXPECT_NEAR(closed.gloss_20, sampled.gloss_20, scatter) << index;
    EXPECT_NEAR(closed.gloss, sampled.gloss, 1.5) << index;
    // No roughness is the flat film.
    const Optics none = rough_look({{1e-12, 3e-6}}, film, light),
                 flat =
                     phase_screen({{8, 8, 1e-6, 1e-6}, std::vector<double>(64, 0.0)}, film, light);
    EXPECT_NEAR(none.gloss_20, flat.gloss_20, 1e-3) << index;
    EXPECT_NEAR(none.spectrum[0].mirror, flat.spectrum[0].mirror, 1e-6) << index;
  }
}

}  // namespace
}  // namespace papilla::tests::rough_look_test
