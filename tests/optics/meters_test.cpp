// Apertures: gloss, distinctness of image, the cone, films and the plate.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "base/constants.h"
#include "forward/appearance.h"
#include "physics/optics/lattice/look.h"
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
  // A film as thick is followed over its row of 20 nm: 1e-5.
  EXPECT_NEAR(phase_screen(flat_map(), m, {{550e-9}}).transmittance, 0.96 * taken, 3e-5);
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

// A film of SiO2 over 20 nm of ITO on glass, as thick as fringes are close: against sums over the
// visible in steps of 1 nm. By three wavelengths it read 49 to 145 GU.
OpticalMedia display_film(double thickness) {
  OpticalMedia m{1.46, 1};
  m.thickness = thickness, m.plate_index = 1.52;
  m.films = {{1.9, 0.01, 20e-9}};
  return m;
}
double gloss_by_sums(const OpticalMedia& m, int degrees) {
  const double sine = std::sin(degrees * kDegree);
  double sum = 0, weights = 0;
  for (int nm = 400; nm <= 720; ++nm) {
    const double weight = observer(1e-9 * nm)[1];
    for (const Polarisation p : kPolarisations) {
      weights += weight;
      sum += weight * std::norm(stack_amplitudes(plain(1),
                                                 {{plain({m.index, 0}), m.thickness},
                                                  {plain({1.9, 0.01}), 20e-9}},
                                                 plain(1.52), p, sine, 1e-9 * nm)
                                    .reflected);
    }
  }
  return 100 * sum / weights / face_reflection(kGlossStandard, sine);
}

TEST(Films, GlossOfAThickOneIsItsMeanOverTheVisible) {
  for (const double thickness : {0.3e-6, 0.7e-6, 0.9e-6, 1.1e-6, 1.5e-6, 2.5e-6, 5e-6, 12e-6}) {
    const OpticalMedia m = display_film(thickness);
    const Optics o = phase_screen(flat_map(), m);
    EXPECT_NEAR(o.gloss_20, gloss_by_sums(m, 20), 0.2) << thickness;
    EXPECT_NEAR(o.gloss, gloss_by_sums(m, 60), 0.1) << thickness;
  }
}

TEST(Films, GlossChangesGraduallyWithTheThickness) {
  double before = phase_screen(flat_map(), display_film(1e-6)).gloss_20;
  for (int nm = 1002; nm <= 1200; nm += 2) {
    const double here = phase_screen(flat_map(), display_film(1e-9 * nm)).gloss_20;
    EXPECT_NEAR(here, before, 0.5) << nm;
    before = here;
  }
}

// Fringes of the whole stack are followed within the rows of 20 nm: at the middles of the rows
// alone these stacks let 0.4 to 1.6 % more or less through than their sums over the visible, and
// had a colour of 0.003 to 0.008.
TEST(Films, ThickOnesKeepTheirMeansOverTheVisible) {
  const auto by_sums = [](const std::vector<Film>& films, bool colour) {
    double sum = 0, weights = 0;
    std::vector<double> wavelengths, through, source;
    for (int k = 0; k <= 1280; ++k) {
      const double wavelength = 400e-9 + 0.25e-9 * k, weight = observer(wavelength)[1];
      const double t = std::norm(
          stack_amplitudes(plain(1), sheets_of(films), plain(1.52), Polarisation::S, 0, wavelength)
              .transmitted);
      sum += weight * t, weights += weight;
      wavelengths.push_back(wavelength), through.push_back(t), source.push_back(1);
    }
    const auto seen = chromaticity(wavelengths, through),
               plain_light = chromaticity(wavelengths, source);
    return colour ? std::hypot(seen[0] - plain_light[0], seen[1] - plain_light[1]) : sum / weights;
  };
  const std::vector<std::vector<Film>> stacks{{{1.46, 0, 5e-6}, {1.9, 0.01, 20e-9}},
                                              {{2.2, 0, 8e-6}},
                                              {{1.46, 0, 8e-6}, {2.0, 0, 8e-6}},
                                              {{2.0, 0, 7e-6}, {1.46, 0, 7e-6}},
                                              {{2.2, 0, 6e-6}, {1.46, 0, 6e-6}, {2.2, 0, 6e-6}}};
  for (const std::vector<Film>& films : stacks) {
    OpticalMedia m{films[0].index, 1};
    m.thickness = films[0].thickness, m.plate_index = m.back = 1.52;
    m.films.assign(films.begin() + 1, films.end());
    const Optics o = phase_screen(flat_map(), m);
    EXPECT_NEAR(o.total_transmittance, by_sums(films, false), 2e-4) << films.size();
    EXPECT_NEAR(o.colour_shift, by_sums(films, true), 3e-5) << films.size();
    EXPECT_EQ(o.spectrum.size(), visible_wavelengths().size());
    EXPECT_EQ(o.spectrum[3].wavelength, visible_wavelengths()[3]);
  }
}

// The rows of a layer finer than the wavelength, too: none of it left is the film alone.
TEST(Films, ALayerOnAThickOneHasItsMean) {
  OpticalMedia m{1.46, 1};
  m.thickness = 8e-6, m.plate_index = m.back = 1.52, m.films = {{2.0, 0, 8e-6}};
  const Optics layer = effective_medium(0, 100e-9, Features::Holes, m),
               flat = phase_screen(flat_map(), m);
  EXPECT_NEAR(layer.total_transmittance, flat.total_transmittance, 1e-9);
  EXPECT_NEAR(layer.spectrum[5].total, flat.spectrum[5].total, 1e-9);
}

// The nodes stand for the fringes of the path that they were asked for.
TEST(PhotopicNodes, MeanTheFringesOfTheirPath) {
  EXPECT_EQ(photopic_nodes(0).size(), 3u);
  EXPECT_EQ(photopic_nodes(0.8e-6).size(), 3u);
  EXPECT_LE(photopic_nodes(1.5 * kLongestPath).size(), 120u);
  for (const double path : {0.3e-6, 0.79e-6, 2e-6, 6e-6, 9.9e-6, 20e-6, 60e-6}) {
    double by_nodes = 0, by_sums = 0, weights = 0, all = 0;
    for (const PhotopicNode& node : photopic_nodes(path)) {
      by_nodes += node.weight * std::cos(2 * kPi * path / node.wavelength);
      all += node.weight;
    }
    for (double nm = 400; nm <= 720; nm += 0.25) {
      const double weight = observer(1e-9 * nm)[1];
      by_sums += weight * std::cos(2 * kPi * path / (1e-9 * nm)), weights += weight;
    }
    EXPECT_NEAR(by_nodes, by_sums / weights, 4e-3) << path;
    EXPECT_NEAR(all, 1, 1e-12);
  }
}

TEST(WithinRow, IsTheWavelengthItselfUntilFringesCrowd) {
  EXPECT_EQ(within_row(550e-9, 4e-6), std::vector<double>{550e-9});
  const std::vector<double> row = within_row(550e-9, 8e-6);
  ASSERT_EQ(row.size(), 3u);
  EXPECT_NEAR(row[0], (550 - 20.0 / 3) * 1e-9, 1e-15);
  EXPECT_NEAR(row[1], 550e-9, 1e-15);
  EXPECT_EQ(within_row(550e-9, 1e-3).size(), within_row(550e-9, kLongestPath).size());
}

// Of two levels the light interferes; of heights between them it averages out.
TEST(MapScreen, HasAStepWhereItsHeightsAreTwo) {
  Heightmap map{{16, 16, 1e-6, 1e-6}, std::vector<double>(256, 0.0)};
  for (std::size_t i = 0; i < 64; ++i) map.z[i] = -200e-9;
  EXPECT_NEAR(map_screen(map)->step(), 200e-9, 1e-15);
  for (std::size_t i = 0; i < 256; ++i) map.z[i] = -1e-9 * static_cast<double>(i);
  EXPECT_EQ(map_screen(map)->step(), 0);
  EXPECT_EQ(map_screen(flat_map())->step(), 0);
}

// Without a black backing the fill's face sends back what comes from below as often as it does so,
// the back face in it: R3 + (1 - R3)^2 R/(1 - R3 R), R of the flat plate under the fill.
TEST(Fill, ReadsTheBackFaceThroughItsOwn) {
  constexpr double kFill = 1.33, kGlass = 1.9;
  const double sine = std::sin(kPi / 3);
  Light light;
  light.meters.black_back = false;
  double exact = 0;
  for (const Polarisation p : kPolarisations) {
    const double outer = boundary_reflection(plain(1), plain(kFill), p, sine),
                 face = boundary_reflection(plain(kFill), plain(kGlass), p, sine),
                 back = boundary_reflection(plain(1), plain(kGlass), p, sine);
    const double below = face + square(1 - face) * back / (1 - face * back);
    exact += 0.5 * (outer + square(1 - outer) * below / (1 - outer * below));
  }
  EXPECT_NEAR(phase_screen(flat_map(), {kGlass, kFill}, light).gloss,
              100 * exact / face_reflection(kGlossStandard, sine), 1e-9);
}

// A matched fill makes a plate of its index with two flat faces.
TEST(Fill, AMatchedOneIsAFlatPlate) {
  HoleArray t;
  t.period = 6e-6, t.diameter = 3e-6, t.depth = 300e-9, t.wall_angle = kPi / 2;
  const FeatureArray array = std::get<FeatureArray>(facts(Texture{t}).outline);
  for (const bool black : {true, false}) {
    Light light;
    light.meters.black_back = black;
    const Optics bare = phase_screen(flat_map(), {1.5, 1}, light),
                 filled = array_screen(array, {1.5, 1.5}, light);
    for (const auto number : {&Look::transmittance, &Look::total_transmittance, &Look::gloss_20,
                              &Look::gloss, &Look::gloss_85, &Look::distinctness})
      EXPECT_NEAR(filled.*number, bare.*number, 1e-9) << black;
  }
  HoleArray fine = t;
  fine.period = 0.5e-6, fine.diameter = 0.25e-6, fine.depth = 100e-9, fine.edge_radius = 0;
  const Optics lattice =
      lattice_look(std::get<FeatureArray>(facts(Texture{fine}).outline), {1.5, 1.5}, {}, 1);
  EXPECT_NEAR(lattice.total_transmittance, 0.96 / 1.04, 1e-6);
  EXPECT_NEAR(lattice.gloss, phase_screen(flat_map(), {1.5, 1}).gloss, 1e-4);
}

}  // namespace
}  // namespace papilla::tests::meters_test
