// A measured map as a texture: where its cut lies, that it is level, mended and without a step.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <filesystem>
#include <functional>
#include <string>
#include <tuple>
#include <vector>

#include "base/constants.h"
#include "geometry/io/files.h"
#include "geometry/measured_map.h"
#include "geometry/texture.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::measured_test {
namespace {

constexpr double kWidth = 20e-6, kHeight = 16e-6, kPatch = 12e-6;

// Waves of 5 um along x and 4 um along y, whole ones on the map: their least-squares plane is flat.
double wave(double x, double y) {
  return 100e-9 * std::cos(2 * kPi * x / 5e-6) + 60e-9 * std::cos(2 * kPi * y / 4e-6);
}

// The highest pixel of the map, which becomes the untouched land of the texture.
double top() { return wave(0.025e-6, 0.025e-6); }

// The cut of a map that a file holds, `change` made to it before.
Heightmap cut_of(const std::string& name,
                 const std::function<double(double x, double y, double z)>& change,
                 bool level = false, const MapPlace& at = {}) {
  const Grid whole{400, 320, kWidth, kHeight};
  Heightmap map{whole, std::vector<double>(whole.size())};
  for (int iy = 0; iy < whole.ny; ++iy) {
    for (int ix = 0; ix < whole.nx; ++ix) {
      const double x = whole.x(ix), y = whole.y(iy);
      map(ix, iy) = change(x, y, wave(x, y));
    }
  }
  const std::string file = temporary(name + ".npy");
  write_npy(file, map);
  Measured3d measured;
  measured.file = file;
  measured.width = kWidth;
  measured.patch = kPatch;
  measured.level = level;
  measured.at_x = at.x, measured.at_y = at.y;
  return generate(Texture{measured}, Grid{96, 96, kPatch, kPatch});
}

double as_it_is(double, double, double z) { return z; }

double largest_difference(const Heightmap& a, const Heightmap& b) {
  double out = 0;
  for (std::size_t i = 0; i < a.z.size(); ++i) out = std::max(out, std::abs(a.z[i] - b.z[i]));
  return out;
}

TEST(MeasuredMap, TheCutIsFromTheMiddle) {
  const Heightmap h = cut_of("plain", as_it_is);
  const double x0 = 0.5 * (kWidth - kPatch), y0 = 0.5 * (kHeight - kPatch);
  // Below the bands that are blended over the border.
  for (int iy = 0; iy < 84; ++iy) {
    for (int ix = 0; ix < 84; ++ix)
      ASSERT_NEAR(h(ix, iy) + top(), wave(x0 + h.grid.x(ix), y0 + h.grid.y(iy)), 2e-9)
          << ix << " " << iy;
  }
}

TEST(MeasuredMap, TheCutIsWhereItIsAskedForAndNotBeyondTheMap) {
  const MapPlace at{3e-6, -1.5e-6};
  const Heightmap h = cut_of("placed", as_it_is, false, at);
  const double x0 = 0.5 * (kWidth - kPatch) + at.x, y0 = 0.5 * (kHeight - kPatch) + at.y;
  for (int iy = 0; iy < 84; ++iy) {
    for (int ix = 0; ix < 84; ++ix)
      ASSERT_NEAR(h(ix, iy) + top(), wave(x0 + h.grid.x(ix), y0 + h.grid.y(iy)), 2e-9)
          << ix << " " << iy;
  }
  EXPECT_NE(refusal_of([] {
              cut_of("beyond", as_it_is, false, {0, 2.5e-6});
            }).find("reaches 0.5 um beyond the map"),
            std::string::npos);
  // Also where the map is taken pixel by pixel, or as often as a stack is long.
  const ScanSource repeats{temporary("placed.npy"), kWidth, false, true};
  const auto refused = [&](double patch, const MapPlace& place, const Grid& grid) {
    return refusal_of([&] { patch_of_map(repeats, patch, place, grid); });
  };
  EXPECT_NE(refused(kHeight, {3e-6, 0}, {400, 320, kWidth, kHeight}).find("beyond the map"),
            std::string::npos);
  EXPECT_NE(refused(kPatch, {1e-6, 0}, {96, 96, 2 * kPatch, kPatch}).find("leave them out"),
            std::string::npos);
  EXPECT_EQ(refused(kPatch, {}, {96, 96, 2 * kPatch, kPatch}), "");
}

// 20 x 16 um: patches of 8 um have two places along x, one along y.
TEST(MeasuredMap, HasTwoPlacesAlongASideThatLeavesRoomForTheirSeams) {
  cut_of("places", [](double x, double y, double z) { return z + 0.05 * x + 0.02 * y; });
  const ScanSource source{temporary("places.npy"), kWidth};
  EXPECT_EQ(places_of_map(source, 12e-6), (std::vector<MapPlace>{{0, 0}}));
  EXPECT_EQ(places_of_map(source, 8e-6), (std::vector<MapPlace>{{-5e-6, 0}, {5e-6, 0}}));
  EXPECT_EQ(places_of_map(source, 6e-6).size(), 4u);
  ScanSource repeats = source;
  repeats.as_is = true;
  EXPECT_EQ(places_of_map(repeats, 6e-6).size(), 1u);
}

TEST(MeasuredMap, ATiltOfAnArrayIsTakenAwayWhereThatIsAskedFor) {
  const auto tilt = [](double x, double y, double z) { return z + 2e-6 + 0.05 * x - 0.03 * y; };
  const Heightmap plain = cut_of("plain", as_it_is, true);
  EXPECT_LT(largest_difference(cut_of("tilted", tilt, true), plain), 1e-12);
  EXPECT_GT(largest_difference(cut_of("tilted", tilt), plain), 1e-7);  // an array keeps it
}

// A map has no zero of its own: whatever is added to it, its highest place is the untouched land,
// or as high above it as `top` says.
TEST(MeasuredMap, ItsHighestPlaceIsTheUntouchedLand) {
  const Heightmap plain = cut_of("plain", as_it_is);
  for (const double offset : {-1e-6, 100e-9, 3e-3}) {
    const Heightmap moved = cut_of("moved", [&](double, double, double z) { return z + offset; });
    EXPECT_LT(largest_difference(moved, plain), 1e-15) << offset;
  }
  const Grid grid{40, 40, 4e-6, 4e-6};
  Heightmap holes{grid, std::vector<double>(grid.size(), 0)};
  for (std::size_t i = 0; i < 300; ++i) holes.z[i] = -200e-9;
  const std::string file = temporary("zero.gsf");
  for (const double offset : {0.0, 250e-9, -2e-6}) {
    Heightmap moved = holes;
    for (double& z : moved.z) z += offset;
    write_gsf(file, moved, {});
    for (const double high : {0.0, 350e-9}) {
      for (const bool as_is : {true, false}) {
        Measured3d map;
        map.file = file, map.as_is = as_is, map.patch = 4e-6, map.top = high;
        const Heightmap h = generate(Texture{map}, grid);
        EXPECT_NEAR(*std::max_element(h.z.begin(), h.z.end()), high, as_is ? 1e-13 : 60e-9);
        EXPECT_NEAR(h.z[0], high - 200e-9, as_is ? 1e-13 : 1e-6);
      }
    }
  }
}

TEST(MeasuredMap, ASpikeIsMendedByItsNeighboursUpAndDown) {
  for (double spike : {5e-6, -5e-6}) {
    const Heightmap h = cut_of(spike > 0 ? "up" : "down", [&](double x, double y, double z) {
      return std::hypot(x - 9.025e-6, y - 8.025e-6) < 30e-9 ? spike : z;
    });
    EXPECT_LT(largest_difference(h, cut_of("plain", as_it_is)), 1e-9) << spike;
  }
}

// Eq. geometry.4 where it can be known: a wave that fits the patch meets itself in the band, and
// two equal waves are as much higher as two strange ones need for their variance.
TEST(MeasuredMap, BandsMixBothEndsAndKeepTheVarianceOfStrangers) {
  const Heightmap h = cut_of("plain", as_it_is);
  const double x0 = 0.5 * (kWidth - kPatch), y0 = 0.5 * (kHeight - kPatch), band = 0.1 * kPatch;
  int mixed = 0;
  for (int iy = 0; iy < 96; ++iy) {
    const double b = (h.grid.y(iy) - (kPatch - band)) / band;
    if (b <= 0) continue;
    ++mixed;
    for (int ix = 0; ix < 84; ++ix) {
      const double expected = wave(x0 + h.grid.x(ix), y0 + h.grid.y(iy)) / std::hypot(b, 1 - b);
      ASSERT_NEAR(h(ix, iy) + top(), expected, 3e-9) << ix << " " << iy;
    }
  }
  EXPECT_GE(mixed, 9);
}

// Every cut of a map as skin lies somewhere in it, as it is or mirrored along a side, its sides
// never swapped: an oblique wave keeps both of its lengths, and its hand half of the time.
TEST(MeasuredMap, CutsOfASkinAreOfTheMapAndAnywhereInIt) {
  const Grid whole{300, 240, 30e-6, 24e-6}, grid{100, 100, 10e-6, 10e-6};
  Heightmap map{whole, std::vector<double>(whole.size())};
  for (int iy = 0; iy < whole.ny; ++iy) {
    for (int ix = 0; ix < whole.nx; ++ix)
      map(ix, iy) = 1e-7 * std::cos(2 * kPi * (whole.x(ix) / 2e-6 + whole.y(iy) / 1.6e-6));
  }
  const std::string file = temporary("ridges.npy");
  write_npy(file, map);
  int rising = 0, falling = 0;
  std::vector<double> phases;
  for (std::uint64_t k = 0; k < 40; ++k) {
    const Heightmap h = measured_skin(file, whole.lx, grid, 5, k);
    // Between the bands that may be blended: the share of either hand, and where its crest lies.
    std::complex<double> down = 0, up = 0;
    for (int iy = 10; iy < 90; ++iy) {
      for (int ix = 10; ix < 90; ++ix) {
        const double x = 2 * kPi * grid.x(ix) / 2e-6, y = 2 * kPi * grid.y(iy) / 1.6e-6;
        down += h(ix, iy) * std::polar(1.0, x + y);
        up += h(ix, iy) * std::polar(1.0, x - y);
      }
    }
    const bool is_down = std::abs(down) > std::abs(up);
    const double amplitude = 2 * std::max(std::abs(down), std::abs(up)) / 6400;
    EXPECT_NEAR(amplitude, 1e-7, 5e-9) << k;  // a cut of the map, nothing beyond its border
    (is_down ? falling : rising) += 1;
    phases.push_back(std::arg(is_down ? down : up));
  }
  EXPECT_GT(falling, 8);  // mirrored along one side as often as not
  EXPECT_GT(rising, 8);
  std::sort(phases.begin(), phases.end());
  for (std::size_t i = 1; i < phases.size(); ++i) EXPECT_LT(phases[i] - phases[i - 1], 1.5);
}

// Beside holes a map that is taken as it is is pressed in whole periods: the patch grows to them,
// or the map is refused. Cut at 1.2 of them it would step by all that its waves are high.
TEST(MeasuredMap, InAStackIsTakenInWholePeriods) {
  const Grid own{80, 80, 20e-6, 20e-6};
  Heightmap ramp{own, {}};
  for (std::size_t i = 0; i < own.size(); ++i)  // steps wherever it is cut but for its border
    ramp.z.push_back(1e-7 * std::cos(2 * kPi * (static_cast<double>(i % 80) + 0.5) / 80));
  const std::string file = temporary("whole.npy");
  write_npy(file, ramp);
  const auto beside = [&](double period, double side) {
    Measured3d map;
    map.file = file, map.width = map.patch = side, map.as_is = true;
    Stack out;
    out.parts = {Texture{HoleArray{.period = period, .diameter = 1e-6}}, Texture{map}};
    return Texture{out};
  };
  const auto refused = [](const Texture& texture) {
    return refusal_of([&] { generate(texture, simulated_patch(texture, 64)); });
  };
  EXPECT_NE(refused(beside(6e-6, 10e-6))
                .find("texture.parts.1.patch: " + file +
                      ": as_is says that it repeats after 10 x 10 um, and the 12 x 12 um of the "
                      "stack that it is a part of are no whole number of them: a step would be "
                      "left at the border; give the period of the map as its patch"),
            std::string::npos)
      << refused(beside(6e-6, 10e-6));
  for (const auto& [period, side, patch] :
       {std::tuple{6e-6, 18e-6, 18e-6}, {5e-6, 10e-6, 10e-6}, {6e-6, 3e-6, 12e-6}}) {
    const Texture texture = beside(period, side);
    EXPECT_EQ(refused(texture), "");
    EXPECT_NEAR(simulated_patch(texture, 64).lx, patch, 1e-15);
    EXPECT_NEAR(simulated_patch(texture, 64).ly, patch, 1e-15);
  }
  // Along either side of its own: three by two of a map on grooves of 18 um and holes of 2 um.
  Stack grooves = std::get<Stack>(beside(2e-6, 6e-6).kind);
  grooves.parts.push_back(Texture{Grating{.period = 18e-6, .width = 6e-6}});
  EXPECT_EQ(refused({grooves}), "");
  EXPECT_NEAR(simulated_patch({grooves}, 64).lx, 18e-6, 1e-15);
  EXPECT_NEAR(simulated_patch({grooves}, 64).ly, 12e-6, 1e-15);
  // No period helps a square beside hexagons, whether it is longer than theirs or not.
  for (const double side : {6e-6, 18e-6}) {
    Stack hexagons = std::get<Stack>(beside(6e-6, side).kind);
    std::get<HoleArray>(hexagons.parts[0].kind).lattice = Lattice::Hexagonal;
    EXPECT_NE(refused({hexagons})
                  .find("a square patch fits no hexagonal lattice: take a square "
                        "lattice, or a map whose own sides are whole cells of it"),
              std::string::npos)
        << refused({hexagons});
  }
  // The whole of it, where the patch is a square and the lattice beside it is none.
  EXPECT_EQ(refusal_of([&] {
              patch_of_map({file, 10e-6, false, true}, 6e-6, {}, {80, 80, 20e-6, 10e-6});
            }),
            "");
  // Two maps: the longer, of which the other is whole times.
  Stack both = std::get<Stack>(beside(5e-6, 10e-6).kind);
  both.parts[0] = both.parts[1];
  std::get<Measured3d>(both.parts[0].kind).patch = 5e-6;
  EXPECT_NEAR(simulated_patch({both}, 64).lx, 10e-6, 1e-15);
}

// What repeats within a map, where it is known, is laid on any whole number of it, from its corner:
// one column of three rows of hexagons on two by two.
TEST(MeasuredMap, OfAKnownCellCoversTheCellsOfAnyPatch) {
  const HoleArray holes{.lattice = Lattice::Hexagonal, .period = 4e-6, .diameter = 2e-6};
  const double row = std::sqrt(3.0) * 4e-6;
  Measured3d map;
  map.file = temporary("cells.gsf");
  map.patch = 4e-6, map.as_is = true;
  write_gsf(map.file, generate(Texture{holes}, {80, 3 * 138, 4e-6, 3 * row}), {});
  const Grid patch{160, 2 * 138, 8e-6, 2 * row};
  EXPECT_NE(refusal_of([&] { generate(Texture{map}, patch); }), "");  // two of three
  map.cell = UnitCell{4e-6, row};
  EXPECT_EQ(simulated_patch({map}, 64), simulated_patch({holes}, 64));
  EXPECT_LT(largest_difference(generate(Texture{map}, patch), generate(Texture{holes}, patch)),
            1e-12);
}

TEST(MeasuredMap, RepeatsWithoutAStep) {
  const Heightmap h = cut_of("plain", as_it_is);
  double inside = 0, across = 0;
  for (int i = 0; i < 96; ++i) {
    for (int k = 1; k < 96; ++k) {
      inside = std::max({inside, std::abs(h(k, i) - h(k - 1, i)), std::abs(h(i, k) - h(i, k - 1))});
    }
    across = std::max({across, std::abs(h(0, i) - h(95, i)), std::abs(h(i, 0) - h(i, 95))});
  }
  EXPECT_LT(across, 1.2 * inside);
}

// Of a file that changes behind its time and size what was read of it is told, for as long as that
// is kept: memory does not grow with every map that a program draws.
TEST(MeasuredMaps, AreKeptUntilManyOthersWereRead) {
  const TemporaryFolder folder;
  const Grid grid{8, 8, 4e-6, 4e-6};
  const auto flat = [&](const std::string& name, double height) {
    const std::string file = (folder.path() / name).string();
    write_npy(file, {grid, std::vector<double>(grid.size(), height)});
    return file;
  };
  const auto height = [&](const std::string& file) {
    return patch_of_map({.file = file, .width = grid.lx, .as_is = true}, grid.lx, {}, grid).z[0];
  };
  const std::string first = flat("first.npy", 0);
  const double before = height(first);
  const auto time = std::filesystem::last_write_time(first);
  flat("first.npy", 1e-7);
  std::filesystem::last_write_time(first, time);
  EXPECT_EQ(height(first), before);
  for (int i = 0; i < 300; ++i) height(flat(std::to_string(i) + ".npy", 0));
  EXPECT_EQ(height(first), 1e-7);
}

}  // namespace
}  // namespace papilla::tests::measured_test
