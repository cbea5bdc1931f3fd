// Apertures: gloss, distinctness of image, the cone, films and the plate.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "base/constants.h"
#include "forward/appearance.h"
#include "physics/optics/optics.h"
#include "physics/optics/screen.h"
#include "tests/support/glass.h"

namespace papilla::tests::meters_test {
namespace {

using Complex = std::complex<double>;
constexpr double kDegree = kPi / 180;

Heightmap flat_map() { return {{8, 8, 1e-6, 1e-6}, std::vector<double>(64, 0.0)}; }

TEST(GlossMeter, TheBlackStandardReads100AtEveryAngle) {
  const Optics o = phase_screen(flat_map(), {1.567, 1});
  EXPECT_NEAR(o.gloss_20, 100, 1e-9);
  EXPECT_NEAR(o.gloss, 100, 1e-9);
  EXPECT_NEAR(o.gloss_85, 100, 1e-9);
  EXPECT_EQ(o.distinctness, 1);
}

// ISO 2813, table of black glass: 1.52 reads 90.2 to 92 by angle; Fresnel's equations say the same.
TEST(GlossMeter, ReadsFresnelOfFlatGlass) {
  const auto fresnel = [](double n, double angle) {
    const double c = std::cos(angle), w = std::sqrt(n * n - square(std::sin(angle)));
    return 0.5 * (square((c - w) / (c + w)) + square((n * n * c - w) / (n * n * c + w)));
  };
  Light light;
  for (const double n : {1.46, 1.52, 1.7}) {
    const Optics o = phase_screen(flat_map(), {n, 1}, light);
    for (const auto& [degrees, read] : {std::pair{20, o.gloss_20}, {60, o.gloss}, {85, o.gloss_85}})
      EXPECT_NEAR(read, 100 * fresnel(n, degrees * kDegree) / fresnel(1.567, degrees * kDegree),
                  1e-9);
  }
  // Without a black backing the back face adds what passes the front twice: R + R T^2/(1 - R^2).
  light.meters.black_back = false;
  const double r = fresnel(1.52, kPi / 3);
  double both = 0;
  for (const bool s : {true, false}) {
    const double c = 0.5, w = std::sqrt(1.52 * 1.52 - 0.75);
    const double one = square(s ? (c - w) / (c + w) : (2.3104 * c - w) / (2.3104 * c + w));
    both += 0.5 * (one + square(1 - one) * one / (1 - one * one));
  }
  EXPECT_GT(both, r);
  EXPECT_NEAR(phase_screen(flat_map(), {1.52, 1}, light).gloss,
              100 * both / fresnel(1.567, kPi / 3), 1e-9);
}

// A grating whose first orders lie inside the slit across the plane of incidence (11.7 deg) and
// outside that along it (4.4 deg): half of what leaves the order 0 is read.
TEST(GlossMeter, TakesTheOrdersOfItsSolidAngle) {
  constexpr double kSine = 0.06;  // 3.4 deg across; 6.9 deg along at 60 deg
  const Receptor& meter = gloss_meter(60);
  EXPECT_NEAR(meter.accepts(0, kSine), 1, 1e-12);
  EXPECT_EQ(meter.accepts(kSine, 0), 0);
  // The rim of the slit sees half the source.
  EXPECT_NEAR(meter.accepts(0, std::sin(5.85 * kDegree)), 0.5, 1e-9);
  EXPECT_NEAR(meter.accepts(std::sin(62.2 * kDegree) - std::sin(60 * kDegree), 0), 0.5, 1e-9);
  Grating t;
  t.period = 550e-9 / kSine, t.width = 0.5 * t.period, t.depth = 100e-9, t.wall_angle = kPi / 2;
  const FeatureArray lines = std::get<FeatureArray>(facts(Texture{t}).outline);
  const auto screen = array_screen_of(lines);
  const OpticalMedia glass{1.5, 1};
  const Column column(glass, Polarisation::S, std::sin(kPi / 3), 550e-9);
  const double phase = 4 * kPi * 0.5 * t.depth / 550e-9, r = std::norm(column.back(0));
  // Orders of a half-filled grating: cos^2(phase/2), then (2/pi m)^2 sin^2(phase/2) of odd ones.
  const double first = 2 * square(2 / kPi * std::sin(0.5 * phase));
  EXPECT_NEAR(screen->received(column, 550e-9, meter) / r,
              square(std::cos(0.5 * phase)) + 0.5 * first, 1e-6);
}

// Waves of 0.3 deg at 20 deg: the slit beside the mirror direction sees the first order.
TEST(ImageMeter, ReadsTheLightBesideTheMirrorDirection) {
  Waves w;
  w.period = 555e-9 / (std::sin(20.3 * kDegree) - std::sin(20 * kDegree)), w.depth = 40e-9;
  const double rows = 64;
  Heightmap map{{256, static_cast<int>(rows), w.period, w.period}, {}};
  map = generate(Texture{w}, map.grid);
  const auto screen = map_screen(map);
  const OpticalMedia glass{1.5, 1};
  const Column column(glass, Polarisation::S, std::sin(20 * kDegree), 555e-9);
  const double r = std::norm(column.back(0));
  // Of cos(kx) by Bessel functions; the plane of incidence is along the waves in half of them.
  const double a = 0.5 * 4 * kPi * std::cos(20 * kDegree) * w.depth / 555e-9;
  EXPECT_NEAR(screen->received(column, 555e-9, image_meter(true)) / r,
              0.5 * square(std::cyl_bessel_j(1, a)), 1e-3 * square(std::cyl_bessel_j(1, a)));
  EXPECT_GT(phase_screen(map, glass).distinctness, 0.5);
  EXPECT_LT(phase_screen(map, glass).distinctness, 0.999);
}

TEST(HazeMeter, TakesTheConeAndWhatThePlateScatters) {
  HoleArray t;  // first orders at 3.15 deg, green
  t.period = 10e-6, t.diameter = 5e-6, t.depth = 100e-9, t.wall_angle = kPi / 2;
  const FeatureArray array = std::get<FeatureArray>(facts(Texture{t}).outline);
  Light green{{550e-9}};
  const double narrow = array_screen(array, {1.5, 1}, green).haze;
  green.meters.cone = 4 * kDegree;
  const double wide = array_screen(array, {1.5, 1}, green).haze;
  const double q = kPi * 0.5, fill = kPi / 16;
  const double first = 4 * square(fill * 2 * std::cyl_bessel_j(1, q) / q) * 4 *
                       square(std::sin(kPi * 0.5 * 100 / 550));
  EXPECT_NEAR(narrow - wide, first, 1e-6);
  green.meters.inner_haze = 0.02;
  const Optics inner = array_screen(array, {1.5, 1}, green);
  EXPECT_NEAR(inner.haze, 1 - 0.98 * (1 - wide), 1e-12);
  EXPECT_NEAR(inner.total_transmittance, 0.96 / 1.04, 1e-12);  // it scatters, it does not absorb
}

// A quarter wave of magnesium fluoride, index 1.38: ((1 - n^2/ng)/(1 + n^2/ng))^2 is left.
TEST(Films, AQuarterWaveCoatIsTheTextbooks) {
  OpticalMedia m{1.52, 1};
  m.coats = {{1.38, 0, 550e-9 / 4 / 1.38}};
  const double r = square((1 - square(1.38) / 1.52) / (1 + square(1.38) / 1.52)),
               back = square(0.52 / 2.52);
  const Optics o = phase_screen(flat_map(), m, {{550e-9}});
  EXPECT_NEAR(o.transmittance, (1 - r) * (1 - back) / (1 - r * back), 1e-12);
  EXPECT_NEAR(o.total_transmittance, o.transmittance, 1e-12);
  m.back = 1.52;  // bonded to the panel: one face is left
  EXPECT_NEAR(phase_screen(flat_map(), m, {{550e-9}}).transmittance, 1 - r, 1e-12);
}

// Beer and Lambert: an absorbing film between equal indices takes exp(-4 pi k d/lambda).
TEST(Films, AnAbsorbingFilmTakesItsShare) {
  OpticalMedia m{1.5, 1};
  m.films = {{1.5, 1e-4, 20e-6}};
  m.thickness = 1e-6, m.plate_index = 1.5, m.back = 1.5;
  const double taken = std::exp(-4 * kPi * 1e-4 * 20e-6 / 550e-9);
  EXPECT_NEAR(phase_screen(flat_map(), m, {{550e-9}}).transmittance, 0.96 * taken, 1e-5);
}

// Holes cut into a film that interferes: two levels, each with the transmission of its own stack.
TEST(Films, ATextureCutIntoAFilmHasTheAmplitudesOfItsLevels) {
  HoleArray t;
  t.period = 6e-6, t.diameter = 3e-6, t.depth = 300e-9, t.wall_angle = kPi / 2;
  const FeatureArray array = std::get<FeatureArray>(facts(Texture{t}).outline);
  OpticalMedia m{1.46, 1};
  m.thickness = 800e-9, m.plate_index = 1.52, m.back = 1.52;
  m.films = {{1.9, 0, 20e-9}};
  // Amplitude of film on ITO on glass by Airy's sums, from the top.
  const auto through = [&](double film) {
    const auto beta = [](double n, double d) { return 2 * kPi * n * d / 550e-9; };
    const double r1 = (1.9 - 1.52) / (1.9 + 1.52), t1 = 2 * 1.9 / (1.9 + 1.52);
    const double r2 = (1.46 - 1.9) / (1.46 + 1.9), t2 = 2 * 1.46 / (1.46 + 1.9);
    const double r3 = (1 - 1.46) / (1 + 1.46), t3 = 2 / (1 + 1.46);
    const Complex inner = std::polar(1.0, 2 * beta(1.9, 20e-9));
    const Complex r = (r2 + r1 * inner) / (1.0 + r2 * r1 * inner),
                  t_in = t2 * t1 * std::polar(1.0, beta(1.9, 20e-9)) / (1.0 + r2 * r1 * inner);
    const Complex outer = std::polar(1.0, 2 * beta(1.46, film));
    return t3 * t_in * std::polar(1.0, beta(1.46, film)) / (1.0 + r3 * r * outer) * std::sqrt(1.52);
  };
  const double fill = kPi / 16;
  const Complex land = through(800e-9),
                hole = through(500e-9) * std::polar(1.0, 2 * kPi * 300e-9 / 550e-9);
  const double straight = std::norm((1 - fill) * land + fill * hole),
               all = (1 - fill) * std::norm(land) + fill * std::norm(hole);
  const Optics o = array_screen(array, m, {{550e-9}});
  EXPECT_NEAR(o.transmittance, straight, 1e-9);
  EXPECT_NEAR(o.total_transmittance, all, 1e-9);
  EXPECT_NEAR(o.haze, 1 - straight / all, 1e-9);
  // The same of its map, whose amplitudes are tabulated.
  const Optics map =
      phase_screen(generate(Texture{t}, patch_grid(Texture{t}, 512, 6e-6)), m, {{550e-9}});
  EXPECT_NEAR(map.haze, o.haze, 0.01 * o.haze);
}

TEST(Films, OfADesignStandFromTheFingerDown) {
  Surface s = glass_of(1.52);
  s.process = FilmProcess::Planar;
  s.dielectric = {FilmDielectric{}, FilmDielectric{}, FilmDielectric{}};
  s.dielectric[0].refractive_index = 1.6, s.dielectric[0].thickness = 100e-9;  // on the electrode
  s.dielectric[1].refractive_index = 1.5, s.dielectric[1].thickness = 900e-9;  // cut
  s.dielectric[2].refractive_index = 1.3, s.dielectric[2].thickness = 10e-9;
  s.dielectric[2].process = LayerProcess::Conformal;
  View view;
  view.films = {{"match", 50e-9, 1.7, 0}, {"ITO", 20e-9, 1.9, 0.01}};
  const OpticalMedia m = media_of(s, view);
  EXPECT_EQ(m.coats, (std::vector<Film>{{1.3, 0, 10e-9}}));
  EXPECT_EQ(m.index, 1.5);
  EXPECT_EQ(m.thickness, 900e-9);
  EXPECT_EQ(m.films, (std::vector<Film>{{1.6, 0, 100e-9}, {1.9, 0.01, 20e-9}, {1.7, 0, 50e-9}}));
  EXPECT_EQ(m.glass(), 1.52);
  // Where all follow the texture, the glass itself is cut.
  s.process = FilmProcess::Conformal;
  s.dielectric[2].process = LayerProcess::Surface;
  const OpticalMedia grown = media_of(s, view);
  EXPECT_FALSE(grown.cut_into_film());
  EXPECT_EQ(grown.index, 1.52);
  EXPECT_EQ(grown.coats.size(), 5u);
  EXPECT_EQ(grown.coats.front().index, 1.3);
  EXPECT_EQ(grown.coats.back().index, 1.7);
  // Boundaries between equal indices are none.
  EXPECT_EQ(media_of(glass_of(1.52), {}), (OpticalMedia{.index = 1.52, .plate_index = 1.52}));
}

}  // namespace
}  // namespace papilla::tests::meters_test
