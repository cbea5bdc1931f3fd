// Which theory looks at a texture, and with which of its numbers.
#include "forward/appearance.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "base/constants.h"
#include "geometry/io/files.h"
#include "tests/support/glass.h"
#include "tests/temporary.h"

namespace papilla::tests::appearance_test {
namespace {

constexpr double kIndex = 1.46;

void expect_look(const Optics& a, const Optics& b) {
  EXPECT_EQ(a.regime, b.regime);
  EXPECT_DOUBLE_EQ(a.haze, b.haze);
  EXPECT_DOUBLE_EQ(a.transmittance, b.transmittance);
  EXPECT_DOUBLE_EQ(a.gloss, b.gloss);
  EXPECT_DOUBLE_EQ(a.colour_shift, b.colour_shift);
}

// Finer than the wavelength: a layer of the open share and the depth, with the disorder of the
// view.
TEST(Appearance, OfAFineArrayIsThatOfItsLayer) {
  View view = view_from({0, 0.3});
  view.displacement = 4e-9, view.diameter_scatter = 0.03;
  HoleArray holes;
  holes.period = 200e-9, holes.diameter = 120e-9, holes.depth = 90e-9;
  PillarArray pillars;
  pillars.period = 200e-9, pillars.diameter = 120e-9, pillars.height = 90e-9;
  Grating grooves;
  grooves.period = 200e-9, grooves.width = 120e-9, grooves.depth = 90e-9;
  for (const auto& [texture, features] : {std::pair{Texture{holes}, Features::Holes},
                                          {Texture{pillars}, Features::Pillars},
                                          {Texture{grooves}, Features::Lines}}) {
    const Optics seen = appearance(texture, glass_of(kIndex), view);
    EXPECT_EQ(seen.regime, OpticsRegime::EffectiveMedium);
    expect_look(seen,
                effective_medium(facts(texture).open_share.value(), 90e-9, features, {kIndex, 1},
                                 {120e-9, 4e-9, 0.03}, {visible_wavelengths(), view.angles}));
  }
}

// Coarser than twice the longest wavelength: a screen of one period.
TEST(Appearance, OfACoarseArrayIsThatOfItsOutlines) {
  HoleArray holes;
  holes.period = 6e-6, holes.diameter = 3e-6, holes.depth = 150e-9, holes.wall_angle = kPi / 2;
  const Texture texture{holes};
  const View view = view_from({0, 0.5});
  const Optics whole = array_screen(std::get<FeatureArray>(facts(texture).outline), {kIndex, 1},
                                    {visible_wavelengths(), view.angles});
  const Optics seen = appearance(texture, glass_of(kIndex), view);
  EXPECT_EQ(seen.haze, whole.haze);
  EXPECT_EQ(seen.transmittance, whole.transmittance);
  EXPECT_EQ(seen.warning, "");
}

// Between, along the normal, the rigorous theory answers; asked for scalar theories alone, or seen
// obliquely, such a period is refused with its band.
TEST(Appearance, BetweenBothItIsRigorousOrRefusedWithTheBand) {
  HoleArray holes;
  holes.diameter = 100e-9, holes.depth = 50e-9, holes.edge_radius = 0;
  View scalar;
  scalar.lattices = LatticeTheory::Scalar;
  const auto refusal = [&](double period, const View& view) {
    holes.period = period;
    return optics_refusal(Texture{holes}, glass_of(1.5), view);
  };
  EXPECT_EQ(refusal(600e-9, scalar),
            "period 600 nm is neither below 267 nm (effective medium) nor above 1440 nm (phase "
            "screen), and view.lattices is \"scalar\"");
  EXPECT_EQ(refusal(600e-9, {}), "");
  EXPECT_EQ(refusal(266e-9, scalar), "");  // 400 nm in glass
  EXPECT_NE(refusal(268e-9, scalar), "");
  EXPECT_NE(refusal(1439e-9, scalar), "");
  EXPECT_EQ(refusal(1441e-9, scalar), "");                  // twice 720 nm
  EXPECT_NE(refusal(266e-9, view_from({0, kPi / 6})), "");  // 400 nm / (1.5 + 0.5)
  EXPECT_EQ(refusal(199e-9, view_from({0, kPi / 6})), "");
  EXPECT_NE(refusal(600e-9, view_from({0, 0.1})).find("along the normal alone"), std::string::npos);
  // The theory has its name before anything is computed.
  const auto theory = [&](double period, const View& view) {
    holes.period = period;
    return optics_theory(Texture{holes}, glass_of(1.5), view);
  };
  EXPECT_EQ(theory(600e-9, {}), "rigorous");
  EXPECT_EQ(theory(266e-9, scalar), "effective medium");
  EXPECT_EQ(theory(1441e-9, {}), "phase screen");
  EXPECT_EQ(theory(600e-9, scalar), refusal(600e-9, scalar));
  // Films that follow a fine texture, and kinds without outlines.
  Surface coated = glass_of(1.5);
  coated.dielectric[0].refractive_index = 1.38;
  EXPECT_NE(optics_refusal(Texture{holes}, coated, {}).find("flat films alone"), std::string::npos);
  CapArray caps;
  caps.period = 600e-9, caps.diameter = 300e-9, caps.depth = 50e-9;
  EXPECT_NE(optics_refusal(Texture{caps}, glass_of(1.5), {}).find("holes, pillars and lines alone"),
            std::string::npos);
}

// A plate that scatters does so once: of a lattice below the finest period, too, whose disorder is
// that of its layer at every wavelength.
TEST(Appearance, OfAFineLatticeCountsInnerHazeOnceAndItsDisorderEverywhere) {
  Grating grooves;
  grooves.period = 200e-9, grooves.width = 120e-9, grooves.depth = 90e-9;
  grooves.wall_angle = kPi / 2, grooves.edge_radius = 0;
  const Texture texture{grooves};
  View view;
  view.lattices = LatticeTheory::Rigorous;
  view.displacement = 0, view.diameter_scatter = 0;
  const Optics perfect = appearance(texture, glass_of(kIndex), view);
  ASSERT_EQ(perfect.regime, OpticsRegime::Rigorous);
  EXPECT_NEAR(perfect.haze, 0, 1e-9);
  view.displacement = 10e-9, view.diameter_scatter = 0.1, view.inner_haze = 0.3;
  const Optics seen = appearance(texture, glass_of(kIndex), view);
  const Optics layer =
      effective_medium(facts(texture).open_share.value(), 90e-9, Features::Lines, {kIndex, 1},
                       {120e-9, 10e-9, 0.1}, {visible_wavelengths(), {0}});
  EXPECT_GT(layer.haze, 1e-4);
  EXPECT_NEAR(seen.haze, 1 - 0.7 * (1 - layer.haze), 1e-9);
  for (std::size_t k = 0; k < seen.spectrum.size(); ++k) {
    const double kept = 1 - layer.spectrum[k].haze;
    EXPECT_NEAR(seen.spectrum[k].haze, 1 - 0.7 * kept, 1e-9) << k;
    EXPECT_NEAR(seen.spectrum[k].specular, kept, 1e-9) << k;
    EXPECT_NEAR(seen.spectrum[k].transmitted, 0.7 * kept * perfect.spectrum[k].transmitted, 1e-9)
        << k;
  }
  EXPECT_LT(seen.transmittance, 0.7 * perfect.transmittance);
}

TEST(Appearance, WarnsWhereTheScreenIsRough) {
  const auto warning = [](double diameter, double depth) {
    HoleArray holes;
    holes.period = 2.5 * diameter, holes.diameter = diameter, holes.depth = depth;
    return appearance(Texture{holes}, glass_of(kIndex), {}).warning;
  };
  EXPECT_EQ(warning(2.1e-6, 0.5e-6), "");
  EXPECT_NE(warning(1.9e-6, 0.5e-6).find("features of 1.9 um are few wavelengths"),
            std::string::npos);
  EXPECT_NE(warning(2.1e-6, 1.1e-6).find("deep against its width"), std::string::npos);
  HoleArray wide{.period = 2.5e-6, .diameter = 1.2e-6, .depth = 100e-9};
  View asked;
  asked.lattices = LatticeTheory::Rigorous;
  EXPECT_NE(appearance(Texture{wide}, glass_of(kIndex), asked).warning.find("is not followed"),
            std::string::npos);
  EXPECT_NE(appearance(Texture{RandomRough{.rms = 300e-9, .roll_off = 1e-6}}, glass_of(kIndex), {})
                .warning.find("too steep for a thin screen"),
            std::string::npos);
}

// A map that is written anew under its name is another surface.
TEST(Appearance, OfAMapIsThatOfItsFileAsItIs) {
  const Grid grid{64, 64, 20e-6, 20e-6};
  const auto written = [&](const std::string& name, double height) {
    Heightmap map{grid, std::vector<double>(grid.size())};
    for (int iy = 0; iy < grid.ny; ++iy)
      for (int ix = 0; ix < grid.nx; ++ix)
        map(ix, iy) = height * std::cos(2 * kPi * ix / 16) * std::cos(2 * kPi * iy / 16);
    write_npy(temporary(name), map);
    Measured3d measured;
    measured.file = temporary(name), measured.width = 20e-6, measured.patch = 12e-6;
    return Texture{measured};
  };
  const View view = view_from({0, 0.3});
  const Optics low = appearance(written("seen.npy", 20e-9), glass_of(kIndex), view);
  ASSERT_NE(low.regime, OpticsRegime::Refused) << low.warning;
  const auto before = std::filesystem::last_write_time(temporary("seen.npy"));
  const Texture anew = written("seen.npy", 60e-9);
  std::filesystem::last_write_time(temporary("seen.npy"), before + std::chrono::seconds(1));
  const Optics high = appearance(anew, glass_of(kIndex), view);
  EXPECT_GT(high.haze, 1.5 * low.haze);
  expect_look(high, appearance(written("other.npy", 60e-9), glass_of(kIndex), view));
}

// The haze of disorder goes on where the layer ends: 267 nm in glass of 1.5.
TEST(Appearance, KeepsTheHazeOfDisorderAcrossTheBorderOfTheLayer) {
  Grating lines;
  lines.width = 130e-9, lines.depth = 100e-9, lines.wall_angle = kPi / 2, lines.edge_radius = 0;
  View view;
  view.displacement = 20e-9, view.diameter_scatter = 0.1;
  const auto haze = [&](double period) {
    lines.period = period;
    return appearance(Texture{lines}, glass_of(1.5), view).haze;
  };
  const double below = haze(266e-9), above = haze(268e-9);
  EXPECT_GT(below, 1e-3);
  EXPECT_NEAR(above, below, 0.05 * below);
  EXPECT_GT(haze(300e-9), 0.5 * below);
}

TEST(Appearance, SaysThatAScreenLeavesStatedDisorderOut) {
  const HoleArray holes{.period = 6e-6, .diameter = 3e-6, .depth = 150e-9};
  View view;
  EXPECT_EQ(appearance(Texture{holes}, glass_of(kIndex), view).warning, "");
  view.displacement = 20e-9;
  EXPECT_NE(appearance(Texture{holes}, glass_of(kIndex), view)
                .warning.find("not counted above periods of 1440 nm"),
            std::string::npos);
  // Less than usual asks for the perfect array, which is what it is.
  view.displacement = 0, view.diameter_scatter = 0;
  EXPECT_EQ(appearance(Texture{holes}, glass_of(kIndex), view).warning, "");
}

TEST(Appearance, SaysThatGradualHeightsBelowTheWavelengthAreNoLayer) {
  Waves waves;
  waves.period = 200e-9, waves.depth = 100e-9, waves.directions = Waves::Directions::Both;
  EXPECT_EQ(optics_refusal(Texture{waves}, glass_of(1.5), {}),
            "period 200 nm is below 267 nm, where holes, pillars and gratings alone are layers "
            "(effective medium): gradual heights have no index of one layer; take 1440 nm or more "
            "(phase screen)");
  VGrooves grooves;
  grooves.period = 200e-9, grooves.width = 150e-9, grooves.depth = 100e-9;
  EXPECT_EQ(optics_refusal(Texture{grooves}, glass_of(1.5), {}), "");
  EXPECT_NE(optics_refusal(Texture{grooves}, glass_of(1.5), view_from({0.1}))
                .find("seen along the normal alone"),
            std::string::npos);
}

TEST(Appearance, SaysWhichFringesAreNotFollowed) {
  Surface hard_coat = glass_of(1.52);
  hard_coat.process = FilmProcess::Planar;
  hard_coat.dielectric[0].refractive_index = 1.46, hard_coat.dielectric[0].thickness = 10e-6;
  EXPECT_EQ(appearance(Texture{}, hard_coat, {}).warning, "");
  hard_coat.dielectric[0].thickness = 20e-6;
  EXPECT_NE(appearance(Texture{}, hard_coat, {}).warning.find("not followed beyond 40 um"),
            std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::appearance_test
