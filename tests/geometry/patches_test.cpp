// The grids that textures are sampled on, as tables worked out from their rules.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "base/error.h"
#include "geometry/areal.h"
#include "geometry/texture.h"
#include "tests/io/address_limit.h"
#include "tests/support/refusal.h"

namespace papilla::tests::patches_test {
namespace {

Texture square(double period) { return {HoleArray{.period = period, .diameter = 0.4 * period}}; }
Texture hexagonal(double period) {
  return {HoleArray{.lattice = Lattice::Hexagonal, .period = period, .diameter = 0.4 * period}};
}

void expect_grid(const Grid& is, int nx, int ny, double lx, double ly, const std::string& what) {
  EXPECT_EQ(is.nx, nx) << what;
  EXPECT_EQ(is.ny, ny) << what;
  EXPECT_NEAR(is.lx, lx, 1e-15) << what;
  EXPECT_NEAR(is.ly, ly, 1e-15) << what;
}

// A rectangle of hexagons of 6 um, 12 x 10.392 um: 0.866 of the pixels along y, to the nearest even
// count, or to the nearest sixteen where x has them.
TEST(PatchGrid, HasThePixelsOfItsSides) {
  const double row = std::sqrt(3.0) * 6e-6;
  for (const auto& [pixels, nx, ny] : {std::tuple{64, 64, 48},  // 55.4
                                       {80, 80, 64},            // 69.3
                                       {96, 96, 80},            // 83.1
                                       {66, 66, 58},            // 57.2
                                       {65, 66, 58},
                                       {70, 70, 62},  // 60.6
                                       {10, 10, 10},  // 8.66
                                       {3, 4, 4},     // 3.46
                                       {16, 16, 16},  // 13.9
                                       {1, 2, 2},
                                       {0, 2, 2}})
    expect_grid(patch_grid(hexagonal(6e-6), pixels, 12e-6), nx, ny, 12e-6, row,
                std::to_string(pixels));
  // Two periods at least, and rows for a square.
  expect_grid(patch_grid(square(6e-6), 32, 1e-6), 32, 32, 12e-6, 12e-6, "small");
  expect_grid(patch_grid(square(5e-6), 32), 32, 32, 10e-6, 10e-6, "window");
  expect_grid(patch_grid(hexagonal(6e-6), 50, 31e-6), 50, 52, 30e-6, 3 * row, "large");
}

// Flat: the window of 12 um at `pixels` along it. To 16 the next even count, to 64 the next fourth,
// above the next sixteenth, of factors 2 to 7 and one 11 or 13: not 272 = 16 17, nor 304 = 16 19.
TEST(SimulatedPatch, HasCountsThatTransformsAreFastFor) {
  for (const auto& [pixels, n] :
       {std::pair{2, 2}, {3, 4},     {9, 10},    {15, 16},   {16, 16},   {17, 20},
        {21, 24},        {41, 44},   {61, 64},   {64, 64},   {65, 80},   {81, 96},
        {128, 128},      {129, 144}, {161, 176}, {177, 192}, {193, 208}, {209, 224},
        {257, 288},      {289, 320}, {337, 352}, {400, 400}, {401, 416}})
    expect_grid(simulated_patch(Texture{}, pixels), n, n, kWindow, kWindow, std::to_string(pixels));
  expect_grid(simulated_patch(Texture{}, 200, 100), 112, 112, kWindow, kWindow, "at most 100");
  expect_grid(simulated_patch(Texture{}, 1), 2, 2, kWindow, kWindow, "one");
}

// Cells of 144 um2 as near as can be, a patch of twice the length counting as one of root two times
// the area: |ln(area / 144 um2)| + |ln(lx / ly)| / 2 is least.
TEST(SimulatedPatch, HasTheCellsThatAreMostLikeTheWindow) {
  const double root = std::sqrt(3.0);
  for (const auto& [period, lx, ly] : {std::tuple{10e-6, 10e-6, 10e-6},  // 0.36; two of them 0.68
                                       {5e-6, 10e-6, 15e-6},             // 0.24; two by two 0.36
                                       {7e-6, 14e-6, 14e-6},             // 0.31; two 0.73
                                       {4.4e-6, 13.2e-6, 13.2e-6},       // 0.19; two by three 0.42
                                       {30e-6, 30e-6, 30e-6},
                                       {12e-6, 12e-6, 12e-6},
                                       {1e-6, 12e-6, 12e-6}})
    expect_grid(simulated_patch(square(period), 8), simulated_patch(square(period), 8).nx,
                simulated_patch(square(period), 8).ny, lx, ly, std::to_string(1e6 * period));
  // 12 x 10.4 um; one cell is 0.84 + 0.27.
  const Grid two = simulated_patch(hexagonal(6e-6), 128);
  expect_grid(two, 128, 112, 12e-6, 6e-6 * root, "hexagons of 6 um");  // 110.9
  // 10 x 17.3 um: 0.46; two cells 0.95.
  expect_grid(simulated_patch(hexagonal(10e-6), 48), 40, 80, 10e-6, 10e-6 * root,
              "hexagons of 10 um");  // of 250 nm: 40, 69.3
  // No coarser than the window's pixel, and no more than `most` along the longer side.
  expect_grid(simulated_patch(square(5e-6), 128), 112, 160, 10e-6, 15e-6, "93.75 nm");  // 106.7
  expect_grid(simulated_patch(square(5e-6), 128, 60), 40, 60, 10e-6, 15e-6, "250 nm");
  expect_grid(simulated_patch(square(24e-6), 128, 512), 256, 256, 24e-6, 24e-6, "of one cell");
}

// Grooves beside finer holes: 24 x 1 um repeat, and as many of them lie side by side along y as the
// area asks for. 24 x 6 um are those of the window: 0.69; 24 x 12 um 1.04.
TEST(SimulatedPatch, TakesAsManyPeriodsAlongAShortSideAsItNeeds) {
  for (const auto& [grooves, holes, lx, ly] : {std::tuple{24e-6, 1e-6, 24e-6, 6e-6},
                                               {12e-6, 2e-6, 12e-6, 12e-6},
                                               {6e-6, 1e-6, 12e-6, 12e-6}}) {
    Stack both;
    both.parts = {Texture{Grating{.period = grooves, .width = 0.3 * grooves}}, square(holes)};
    const Grid patch = simulated_patch({both}, 128);
    EXPECT_NEAR(patch.lx, lx, 1e-15) << grooves;
    EXPECT_NEAR(patch.ly, ly, 1e-15) << grooves;
  }
}

// Holes and a map of one period of them are compared on the same patch. Of a map that does not
// repeat there is one square.
TEST(SimulatedPatch, OfAMapThatRepeatsIsThatOfAPeriod) {
  for (const double period : {0.5e-6, 1e-6, 3e-6, 5e-6, 6e-6, 7e-6, 9e-6, 10e-6, 12e-6, 20e-6}) {
    Measured3d map;
    map.file = "a.npy", map.patch = period;
    expect_grid(simulated_patch({map}, 128), simulated_patch({map}, 128).nx,
                simulated_patch({map}, 128).ny, period, period, "one square");
    map.as_is = true;
    EXPECT_EQ(simulated_patch({map}, 128), simulated_patch(square(period), 128)) << period;
    Stack stack;  // as a part beside roughness, which has no sides of its own
    stack.parts = {Texture{RandomRough{}}, Texture{map}};
    EXPECT_EQ(simulated_patch({stack}, 128), simulated_patch(square(period), 128)) << period;
    EXPECT_EQ(patch_grid({map}, 32).lx, period) << "drawn and exported once";
    map.as_is = false;
    stack.parts.push_back(Texture{map});
    EXPECT_NEAR(simulated_patch({stack}, 128).lx, period, 1e-15) << "not all of it repeats";
  }
}

// The autocorrelation of a map asks for a hundred bytes a pixel.
TEST(Areal, OfAMapThatTheMemoryDoesNotHoldIsRefused) {
  if (!kAddressesAreFree) GTEST_SKIP() << "the sanitizer has the addresses";
  const auto refusal = [](int nx, int ny) -> std::string {
    const AddressLimit limit(3.0 * (1 << 30));
    return refusal_of([&] { areal_parameters({{nx, ny, 1e-3, 1e-3}, {}}); });
  };
  EXPECT_EQ(refusal(10000, 10000),
            "the autocorrelation of a surface needs 9.3 GiB of memory; 3 GiB are there");
  EXPECT_EQ(refusal(32212255, 1),  // 1 % of it is less than the least that is refused
            "the autocorrelation of a surface needs 3 GiB of memory; 3 GiB are there");
}

}  // namespace
}  // namespace papilla::tests::patches_test
