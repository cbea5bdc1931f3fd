// Pictures of droplets pixel by pixel: which pixels a disc, its rim and a film take, worked out by
// whole numbers.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "geometry/io/files.h"
#include "report/droplets.h"
#include "tests/report/pixels.h"
#include "tests/temporary.h"

namespace papilla::tests::droplet_pixels_test {
namespace {

constexpr Colour kBridge{30, 110, 255}, kFilm{0, 190, 200}, kSubstrate{255, 150, 0},
    kOnSkin{220, 40, 160};
constexpr int kGrey = (2 * 253 + 5 * 231 + 37) / 8;  // of a gap that is the same everywhere

Colour mixed(const Colour& c, double share) {
  Colour out{};
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = static_cast<int>(std::lround((1 - share) * kGrey + share * c[i]));
  return out;
}

Pixels drawn(const Gap& gap, const Wetting& before, const Wetting& after) {
  const std::string path = temporary("pixels.png");
  write_droplet_picture(path, gap, before, after);
  return pixels_of(path);
}

Gap even_gap(const Grid& grid) {
  Gap gap;
  gap.grid = grid;
  gap.value.assign(grid.size(), 1e-7);
  return gap;
}

// A colour for a pixel of a panel, or the ground where it gives none.
using Rule = std::function<Colour(int x, int y)>;
constexpr Colour kGround{kGrey, kGrey, kGrey};

// Both panels, eight white columns between them; the scale bar over all.
void expect_panels(const Pixels& image, const Gap& gap, const Rule& left, const Rule& right) {
  int width = 0, height = 0;
  const std::vector<std::uint8_t> field = render_field(gap.grid, gap.value, width, height);
  ASSERT_EQ(image.width, 2 * width + 8);
  ASSERT_EQ(image.height, height);
  int bar = 0, wrong = 0;
  for (int y = 0; y < height; ++y) {
    const int row = height - 1 - y;
    for (int x = 0; x < width; ++x) {
      const std::size_t k = 3 * (static_cast<std::size_t>(row) * width + x);
      const bool of_bar = field[k] == field[k + 1] && field[k] == field[k + 2];
      bar += of_bar;
      const Colour grey{field[k], field[k], field[k]};
      wrong += image.at(x, row) != (of_bar ? grey : left(x, y));
      wrong += image.at(width + 8 + x, row) != (of_bar ? grey : right(x, y));
    }
    for (int x = width; x < width + 8; ++x) wrong += image.at(x, row) != Colour{255, 255, 255};
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(bar, 0);
}

Droplet droplet(double x, double y, double radius, DropletState state) {
  Droplet d;
  d.x = x, d.y = y, d.radius = radius, d.state = state;
  return d;
}

Wetting discs(std::vector<Droplet> droplets) {
  Wetting out;
  out.status = WettingStatus::Discs;
  out.droplets = std::move(droplets);
  return out;
}

Colour nothing(int, int) { return kGround; }

// 64 px to the um: a radius of 6.05 px takes what is at most 36 px^2 away; its rim is of 1.5 px,
// from 4.55 px on. The place is that of the pixel below it.
TEST(DropletPixels, ADiscIsItsRimAroundItsPaleInside) {
  const Gap gap = even_gap({64, 32, 8e-6, 4e-6});
  const double px = 8e-6 / 512;
  const auto disc = [](int dx, int dy, const Colour& c) {
    const int away = dx * dx + dy * dy;
    return away > 36 ? kGround : away > 20 ? c : mixed(c, 0.45);
  };
  expect_panels(
      drawn(gap, discs({droplet(100.7 * px, 200.4 * px, 6.05 * px, DropletState::OnSkin)}),
            discs({droplet(300.2 * px, 100.9 * px, 6.05 * px, DropletState::OnSubstrate)})),
      gap, [&](int x, int y) { return disc(x - 100, y - 200, kOnSkin); },
      [&](int x, int y) { return disc(x - 300, y - 100, kSubstrate); });
  // Over the edge it goes on at the other side, over the scale bar nowhere.
  expect_panels(
      drawn(gap, discs({droplet(0.5 * px, 1.5 * px, 6.05 * px, DropletState::Bridge)}),
            discs({droplet(60.5 * px, 8.5 * px, 6.05 * px, DropletState::Bridge),
                   droplet(510.5 * px, 255.5 * px, 6.05 * px, DropletState::OnSkin)})),
      gap,
      [&](int x, int y) {
        return disc(x < 256 ? x : x - 512, (y < 128 ? y : y - 256) - 1, kBridge);
      },
      [&](int x, int y) {
        const Colour first = disc(x - 60, y - 8, kBridge);
        return first != kGround
                   ? first
                   : disc((x < 256 ? x + 512 : x) - 510, (y < 128 ? y + 256 : y) - 255, kOnSkin);
      });
}

// 64 px to the um along x, 32 along y: half axes of 8.2 and 4.1 px, the rim by the shorter one.
TEST(DropletPixels, OnPixelsThatAreNoSquaresADiscIsAnEllipse) {
  const Gap gap = even_gap({64, 32, 8e-6, 8e-6});
  const double px = 8e-6 / 512, py = 8e-6 / 256;
  const auto ellipse = [](int dx, int dy) {
    const int away = dx * dx + 4 * dy * dy;  // 67.2 at the end, 27.04 where the rim begins
    return away > 67 ? kGround : away > 27 ? kBridge : mixed(kBridge, 0.45);
  };
  expect_panels(
      drawn(gap, {}, discs({droplet(200.5 * px, 100.5 * py, 8.2 * px, DropletState::Bridge)})), gap,
      nothing, [&](int x, int y) { return ellipse(x - 200, y - 100); });
}

// The smallest that can be seen: a cross of five pixels, whatever its radius.
TEST(DropletPixels, AnyDropletIsSeen) {
  const Gap gap = even_gap({64, 32, 8e-6, 4e-6});
  const double px = 8e-6 / 512;
  for (const double radius : {0.1, 0.4, 0.9}) {
    expect_panels(
        drawn(gap, discs({droplet(200.5 * px, 100.5 * px, radius * px, DropletState::OnSkin)}), {}),
        gap,
        [](int x, int y) { return std::abs(x - 200) + std::abs(y - 100) <= 1 ? kOnSkin : kGround; },
        nothing);
  }
}

// By its own map, or by that of all bridges where it has none; droplets in it are not drawn.
TEST(DropletPixels, AFilmIsWhereItsMapSaysAndAFloodWhereWaterBridges) {
  const Gap gap = even_gap({64, 32, 8e-6, 4e-6});
  Wetting film;
  film.status = WettingStatus::Film;
  film.film.assign(gap.grid.size(), FilmPixel::None);
  film.bridged.assign(gap.grid.size(), 0);
  film.film[gap.grid.index(40, 20)] = film.film[gap.grid.index(63, 31)] = FilmPixel::Film;
  film.bridged[gap.grid.index(10, 5)] = 1;
  film.droplets = {droplet(1e-6, 3e-6, 0.5e-6, DropletState::Bridge)};
  film.droplets[0].film = 0.25;
  Wetting flood = film;
  flood.status = WettingStatus::Flooded;
  flood.film.clear();
  const Colour wet = mixed(kFilm, 0.6);
  EXPECT_EQ(wet, (Colour{85, 199, 205}));
  expect_panels(
      drawn(gap, film, flood), gap,
      [&](int x, int y) {
        return (x / 8 == 40 && y / 8 == 20) || (x / 8 == 63 && y / 8 == 31) ? wet : kGround;
      },
      [&](int x, int y) { return x / 8 == 10 && y / 8 == 5 ? wet : kGround; });
  // Where water lies in discs a map of bridges draws nothing.
  film.status = WettingStatus::Discs;
  flood.status = WettingStatus::Dry;
  expect_panels(drawn(gap, film, flood), gap, nothing, nothing);
}

// A grid of more than 512 pixels is drawn pixel by pixel.
TEST(DropletPixels, OfALargeGridAreItsOwn) {
  const Gap gap = even_gap({600, 40, 6e-6, 0.4e-6});
  Wetting film;
  film.status = WettingStatus::Film;
  film.film.assign(gap.grid.size(), FilmPixel::None);
  film.film[gap.grid.index(555, 33)] = FilmPixel::Film;
  expect_panels(
      drawn(gap, film, {}), gap,
      [](int x, int y) { return x == 555 && y == 33 ? mixed(kFilm, 0.6) : kGround; }, nothing);
}

}  // namespace
}  // namespace papilla::tests::droplet_pixels_test
