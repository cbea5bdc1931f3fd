// Pictures inside pages and of droplets, read back pixel by pixel.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "report/droplets.h"
#include "report/page_data.h"
#include "tests/report/pixels.h"
#include "tests/temporary.h"

namespace papilla::tests::picture_test {
namespace {

std::vector<int> decoded(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<int> out;
  unsigned word = 0;
  int bits = 0;
  for (char c : text) {
    if (c == '=') break;
    word = word << 6 | static_cast<unsigned>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    out.push_back(static_cast<int>(word >> bits & 255u));
  }
  return out;
}

TEST(PagePictures, AreBytesBetweenTheLowestAndTheHighestMean) {
  const Grid grid{5, 3, 10e-6, 3e-6};
  std::vector<double> values;
  for (int k = 0; k < 15; ++k) values.push_back(2 + k);
  const auto json = picture_json(grid, values);
  EXPECT_EQ(json["nx"], 5);
  EXPECT_EQ(json["ny"], 3);
  EXPECT_EQ(json["low"], 2);
  EXPECT_EQ(json["high"], 16);
  const std::vector<int> bytes = decoded(json["bytes"]);
  ASSERT_EQ(bytes.size(), 15u);
  for (int k = 0; k < 15; ++k)
    EXPECT_EQ(bytes[static_cast<std::size_t>(k)], std::lround(255 * k / 14.0)) << k;
  for (std::size_t n : {1, 2, 3}) {  // whatever is left of three bytes
    const Grid row{static_cast<int>(n) + 1, 1, 1, 1};
    EXPECT_EQ(decoded(picture_json(row, std::vector<double>(n + 1, 1.0))["bytes"]),
              std::vector<int>(n + 1, 0));
  }
}

TEST(PagePictures, LargeMapsAreAveragedDown) {
  const Grid grid{300, 130, 3e-6, 1.3e-6};  // by threes: 100 x 43, a row left over
  std::vector<double> values(grid.size());
  for (int iy = 0; iy < grid.ny; ++iy)
    for (int ix = 0; ix < grid.nx; ++ix) values[grid.index(ix, iy)] = ix + 1000.0 * iy;
  const auto json = picture_json(grid, values);
  EXPECT_EQ(json["nx"], 100);
  EXPECT_EQ(json["ny"], 43);
  EXPECT_NEAR(json["lx"].get<double>(), 3e-6, 1e-18);
  EXPECT_NEAR(json["ly"].get<double>(), 1.29e-6, 1e-18);
  EXPECT_NEAR(json["low"].get<double>(), 1001, 1e-9);  // the middle pixel of nine
  EXPECT_NEAR(json["high"].get<double>(), 298 + 127000, 1e-9);
  EXPECT_EQ(picture_json({128, 1, 1, 1}, std::vector<double>(128))["nx"], 128);
  EXPECT_EQ(picture_json({129, 2, 1, 1}, std::vector<double>(258))["nx"], 64);
}

TEST(DropletPictures, ShowEachDropletWhereItIsInTheColourOfItsState) {
  Gap gap;
  gap.grid = {64, 32, 8e-6, 4e-6};
  gap.value.assign(gap.grid.size(), 1e-7);
  gap.value[0] = 0;
  Wetting before, after;
  before.status = after.status = WettingStatus::Discs;
  const auto droplet = [](double x, double y, DropletState state) {
    Droplet d;
    d.x = x, d.y = y, d.radius = 0.5e-6, d.state = state;
    return d;
  };
  before.droplets = {droplet(2e-6, 3e-6, DropletState::OnSkin)};
  after.droplets = {droplet(6e-6, 3e-6, DropletState::Bridge),
                    droplet(3e-6, 1e-6, DropletState::OnSubstrate)};
  const std::string path = temporary("droplets.png");
  write_droplet_picture(path, gap, before, after);
  const Pixels image = pixels_of(path);
  constexpr int height = 256, panel = 512;
  ASSERT_EQ(image.width, 2 * panel + 8);
  ASSERT_EQ(image.height, height);
  // A place [um] of the left (0) or right (1) panel; rows run down, y up.
  const auto at = [&](int side, double x, double y) {
    return image.at(side * (panel + 8) + static_cast<int>(x / 8 * panel),
                    static_cast<int>((1 - y / 4) * height));
  };
  const Colour ground = at(0, 6, 3);
  EXPECT_EQ(ground[0], ground[1]);  // grey
  EXPECT_EQ(ground[0], (2 * 253 + 5 * 231 + 37) / 8);
  EXPECT_EQ(at(1, 2, 3), ground);
  EXPECT_EQ(at(1, 6, 1), ground);  // not the mirrored place
  const auto inside = [&](const Colour& c) {
    Colour out{};
    for (std::size_t i = 0; i < 3; ++i)
      out[i] = static_cast<int>(std::lround(0.55 * ground[i] + 0.45 * c[i]));
    return out;
  };
  const Colour bridge{30, 110, 255}, substrate{255, 150, 0}, skin{220, 40, 160};
  EXPECT_EQ(at(0, 2.02, 2.98), inside(skin));
  EXPECT_EQ(at(1, 6.02, 2.98), inside(bridge));
  EXPECT_EQ(at(1, 3.02, 0.98), inside(substrate));
  // The rim is in full colour, half a micrometre from the middle of the pixel of the centre.
  for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    EXPECT_EQ(at(1, 6.008 + 0.485 * dx, 3.008 + 0.485 * dy), bridge) << dx << " " << dy;
    EXPECT_EQ(at(1, 6.008 + 0.535 * dx, 3.008 + 0.535 * dy), ground) << dx << " " << dy;
  }
}

TEST(DropletPictures, AFilmCoversItsPixels) {
  Gap gap;
  gap.grid = {64, 32, 8e-6, 4e-6};
  gap.value.assign(gap.grid.size(), 1e-7);
  Wetting none, film;
  film.status = WettingStatus::Film;
  film.film.assign(gap.grid.size(), FilmPixel::None);
  film.film[gap.grid.index(40, 20)] = FilmPixel::Film;
  const std::string path = temporary("film.png");
  write_droplet_picture(path, gap, none, film);
  const Pixels image = pixels_of(path);
  ASSERT_EQ(image.height, 256);
  int coloured = 0;
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Colour p = image.at(x, y);
      if (p[0] == p[1] && p[1] == p[2]) continue;
      ++coloured;
      EXPECT_EQ((x - 520) / 8, 40);
      EXPECT_EQ((255 - y) / 8, 20);
    }
  }
  EXPECT_EQ(coloured, 64);
}

}  // namespace
}  // namespace papilla::tests::picture_test
