// The look of rough glass, of measured surfaces and of stacks beside that of their maps.
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "forward/appearance.h"
#include "geometry/io/files.h"
#include "geometry/roughness.h"
#include "tests/support/glass.h"
#include "tests/temporary.h"

namespace papilla::tests::appearance_slow_test {
namespace {

// What a design shows is what its exported map shows.
TEST(Appearance, OfRoughGlassIsThatOfItsMap) {
  const Texture rough{RandomRough{.rms = 60e-9}};
  const Optics own = appearance(rough, glass_of(1.46), {});
  EXPECT_EQ(own.regime, OpticsRegime::PhaseScreen);
  for (const double side : {48e-6, 100e-6}) {
    const Heightmap map = generate(rough, patch_grid(rough, 1024, side));
    const Optics seen = phase_screen(map, {1.46, 1});
    EXPECT_NEAR(own.haze, seen.haze, 0.05 * seen.haze) << side;
    EXPECT_NEAR(own.gloss, seen.gloss, 0.05 * seen.gloss) << side;
  }
  // Specular light of Gaussian heights, Eq. optics.2.
  const Heightmap map = generate(rough, patch_grid(rough, 1024, 100e-6));
  const double rms = roughness_parameters(map).sq;
  for (const SpectrumPoint& p : own.spectrum) {
    EXPECT_NEAR(p.specular, std::exp(-square(2 * kPi * 0.46 * rms / p.wavelength)),
                0.01 * p.specular);
  }
  EXPECT_EQ(appearance(Texture{RandomRough{.rms = 0}}, glass_of(1.46), {}).regime,
            OpticsRegime::Flat);
}

// Grooves below holes are no lines.
TEST(Appearance, OfGroovesAndHolesIsThatOfTheirMap) {
  Grating grooves;
  grooves.period = 10e-6, grooves.width = 3e-6, grooves.depth = 20e-9;
  HoleArray holes;
  holes.period = 10e-6, holes.diameter = 4.8e-6, holes.depth = 300e-9;
  Stack stack;
  stack.parts = {Texture{grooves}, Texture{holes}};
  EXPECT_FALSE(sections(Texture{stack}));
  const double own = appearance(Texture{stack}, glass_of(1.46), {}).haze;
  const Heightmap map = generate(Texture{stack}, {480, 480, 40e-6, 40e-6});
  EXPECT_NEAR(own, phase_screen(map, {1.46, 1}).haze, 0.05 * own);
  stack.parts[1] = Texture{grooves};
  EXPECT_TRUE(sections(Texture{stack}));
}

TEST(Appearance, OfAMeasuredSurfaceAndOfAStackIsThatOfTheirMaps) {
  const Texture rough{RandomRough{.rms = 60e-9}};
  const Heightmap map = generate(rough, patch_grid(rough, 256, 60e-6));
  Measured3d measured;
  measured.file = temporary("look.npy");
  measured.width = map.grid.lx;
  measured.patch = 50e-6;
  write_npy(measured.file, map);
  Stack stack;
  stack.parts = {Texture{}, rough};
  const double whole = phase_screen(map, {1.46, 1}).haze;
  EXPECT_NEAR(appearance(Texture{measured}, glass_of(1.46), {}).haze, whole, 0.1 * whole);
  EXPECT_EQ(appearance(Texture{measured}, glass_of(1.46), {}).warning, "");
  EXPECT_EQ(appearance(Texture{stack}, glass_of(1.46), {}).haze,
            appearance(rough, glass_of(1.46), {}).haze);
  measured.patch = 12e-6;
  EXPECT_NE(appearance(Texture{measured}, glass_of(1.46), {}).warning.find("is short"),
            std::string::npos);
  View wide;
  wide.cone = 10 * kPi / 180;  // which 12 um resolve
  EXPECT_EQ(appearance(Texture{measured}, glass_of(1.46), wide).warning, "");
}

}  // namespace
}  // namespace papilla::tests::appearance_slow_test
