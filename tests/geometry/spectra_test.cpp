// Spectra along a line and of several maps together.
#include "geometry/spectra.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "base/random.h"
#include "geometry/io/files.h"
#include "report/surface.h"
#include "tests/temporary.h"

namespace papilla::tests::spectra_test {
namespace {

Heightmap noise(std::uint64_t seed, double rms, const Grid& grid) {
  RandomStream random(seed, "spectra test");
  Heightmap h{grid, {}};
  for (std::size_t i = 0; i < grid.size(); ++i) h.z.push_back(rms * random.normal());
  return h;
}

KnownBand everything() { return {1, 0, false}; }

// White noise of variance s^2 has C = s^2 times the pixel at every wave number.
TEST(LineSpectrum, OfWhiteNoiseIsItsVarianceTimesThePixel) {
  const Heightmap h = noise(1, 5e-9, {512, 512, 10e-6, 10e-6});
  for (const LineRing& ring : line_spectrum(h)) {
    if (ring.wavelength > 2e-6) continue;  // few modes
    EXPECT_NEAR(ring.density, 25e-18 * h.grid.dx(), 0.06 * 25e-18 * h.grid.dx()) << ring.wavelength;
  }
}

TEST(LineSpectrum, ItsIntegralIsTheVarianceOfTheMap) {
  const Heightmap h = noise(2, 3e-9, {256, 256, 5e-6, 5e-6});
  const auto rings = joint_spectrum({{line_spectrum(h), everything()}});
  EXPECT_NEAR(joint_rms(rings), 3e-9, 0.05 * 3e-9);
}

TEST(JointSpectrum, CountsAMapWhereItKnowsAndScattersAsTheMapsDo) {
  const Heightmap fine = noise(3, 4e-9, {256, 256, 2e-6, 2e-6}),
                  wide = noise(4, 4e-9, {256, 256, 20e-6, 20e-6});
  std::vector<MapSpectrum> maps{{line_spectrum(fine), {0.5e-6, 16e-9, false}},
                                {line_spectrum(wide), {5e-6, 160e-9, false}}};
  int both = 0;
  for (const JointRing& ring : joint_spectrum(maps)) {
    const bool in_fine = ring.wavelength <= 0.5e-6 && ring.wavelength >= 16e-9,
               in_wide = ring.wavelength <= 5e-6 && ring.wavelength >= 160e-9;
    EXPECT_EQ(ring.maps, static_cast<std::size_t>(in_fine) + in_wide) << ring.wavelength;
    both += in_fine && in_wide;
    // C goes with the pixel, ten times as wide: a factor 10 is exp(2.303), and of two values the
    // standard deviation is their distance over the root of two.
    if (in_fine && in_wide) {
      EXPECT_NEAR(std::log(ring.scatter), std::log(10.0) / std::sqrt(2.0), 0.15);
    }
  }
  EXPECT_GE(both, 4);
}

TEST(Surfaces, OfOneSurfaceAreShownTogetherWithTheConsensusBesideThem) {
  std::vector<SurfaceView> maps;
  for (const std::uint64_t seed : {5u, 6u, 7u}) {
    const std::string file = temporary("scan" + std::to_string(seed) + ".gsf");
    write_gsf(file, noise(seed, 3e-9, {128, 128, 4e-6, 4e-6}), {});
    maps.push_back(view_of({file, 0}, 0));
  }
  const SurfacesView view = joint_view(maps);
  // The maps know from a quarter of their side to two pixels: 1 um to 62.5 nm.
  ASSERT_FALSE(view.joint.empty());
  EXPECT_NEAR(view.joint.front().wavelength, 1e-6, 1e-12);
  for (const JointRing& ring : view.joint) {
    EXPECT_EQ(ring.maps, 3u);
    EXPECT_LT(ring.scatter, 1.3);
  }
  EXPECT_LT(view.rms, 3e-9);
  const std::string text = surfaces_text(view), json = surfaces_json(view);
  EXPECT_NE(text.find("STC smoother"), std::string::npos);
  EXPECT_NE(text.find("scan6.gsf"), std::string::npos);
  EXPECT_NE(json.find("\"consensus_rougher\""), std::string::npos);
}

// The figure's own numbers: C of the smoother surface at 1.26e7 and 1.36e8 1/m.
TEST(Consensus, HasTheMediansOfTheChallenge) {
  EXPECT_NEAR(consensus_at(2 * kPi / 1.256637e7).smoother, 9.6e-25, 0.01 * 9.6e-25);
  EXPECT_NEAR(consensus_at(2 * kPi / 1.355704e8).smoother, 1.37e-26, 0.01 * 1.37e-26);
  EXPECT_NEAR(consensus_at(2 * kPi / 61979.02).rougher, 1.547e-17, 1e-20);
  EXPECT_EQ(consensus_at(1e-3).smoother, 0);
  EXPECT_EQ(consensus_at(1e-9).rougher, 0);
}

}  // namespace
}  // namespace papilla::tests::spectra_test
