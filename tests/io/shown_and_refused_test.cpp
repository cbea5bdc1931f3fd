// Pictures as wholes, to the pixel, and files that are heights for other commands alone.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "geometry/io/files.h"
#include "geometry/io/height_rows.h"
#include "geometry/io/layout.h"
#include "tests/io/zip_file.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::shown_and_refused_test {
namespace {

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kHigh{253, 231, 37}, kWhite{255, 255, 255}, kBlack{0, 0, 0};

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;

  explicit Picture(const Grid& grid)
      : rgb(render_field(grid, std::vector<double>(grid.size()), width, height)) {}
  Colour at(int x, int y) const {
    const std::size_t k = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(x));
    return {rgb.at(k), rgb.at(k + 1), rgb.at(k + 2)};
  }
};

// Of 512 x 320 pixels: a bar of 3 um in 10, 2 um or 102 pixels, 4 high and 8 from the border, in a
// rim of a pixel.
TEST(ShownFields, HaveTheirBarToThePixel) {
  const Picture p({512, 320, 10e-6, 6.25e-6});
  ASSERT_EQ(p.width, 512);
  ASSERT_EQ(p.height, 320);
  for (int y = 0; y < 320; ++y) {
    for (int x = 0; x < 512; ++x) {
      const bool framed = x >= 7 && x <= 110 && y >= 307 && y <= 312;
      const bool rim = x == 7 || x == 110 || y == 307 || y == 312;
      ASSERT_EQ(p.at(x, y), !framed ? kHigh : rim ? kBlack : kWhite) << x << " " << y;
    }
  }
}

// A picture that is narrower than the distance of the bar from its border has none of it.
TEST(ShownFields, ThatAreNarrowerThanTheBarsBorderHaveNone) {
  const Picture p({4, 512, 4e-6, 512e-6});
  ASSERT_EQ(p.width, 4);
  for (int y = 0; y < 512; ++y) {
    for (int x = 0; x < 4; ++x) ASSERT_EQ(p.at(x, y), kHigh) << x << " " << y;
  }
}

TEST(ShownFields, HaveABarOfTheLargestRoundLengthBelowThreeTenths) {
  for (const auto& [width, bar] : {std::pair{10e-6, 2e-6},
                                   {16.6e-6, 2e-6},
                                   {16.7e-6, 5e-6},
                                   {33.3e-6, 5e-6},
                                   {33.4e-6, 10e-6},
                                   {6.7e-6, 2e-6},
                                   {6.6e-6, 1e-6},
                                   {1e-3, 2e-4},
                                   {0.5, 0.1}})
    EXPECT_NEAR(scale_bar_length({8, 8, width, 1}) / bar, 1, 1e-12) << width;
}

// Five anchors, between them by straight lines; beyond the ends theirs.
TEST(ShownFields, HaveTheColoursOfTheirShares) {
  for (const auto& [share, colour] : {std::pair{-1.0, Colour{68, 1, 84}},
                                      {0.0, Colour{68, 1, 84}},
                                      {0.125, Colour{64, 42, 112}},  // 63.5, 41.5, 111.5
                                      {0.25, Colour{59, 82, 139}},
                                      {0.3, Colour{54, 95, 139}},  // a fifth of the way
                                      {0.5, Colour{33, 145, 140}},
                                      {0.75, Colour{94, 201, 98}},
                                      {0.9, Colour{189, 219, 61}},  // three fifths
                                      {1.0, Colour{253, 231, 37}},
                                      {2.0, Colour{253, 231, 37}}})
    EXPECT_EQ(field_colour(share), colour) << share;
}

TEST(ReadHeights, OfPicturesAndArchivesAreThoseThatSayTheirScale) {
  const Heightmap h{{4, 3, 4e-6, 3e-6},
                    {1e-9, 2e-9, 3e-9, 4e-9, 5e-9, 6e-9, 7e-9, 8e-9, 9e-9, 1e-8, 1.1e-8, 1.2e-8}};
  const auto refusal = [](const std::string& path) -> std::string {
    return refusal_of([&] { read_heightmap(path); });
  };
  const std::string png = temporary("h.png"), upper = temporary("h.PNG"), x3p = temporary("h.x3p"),
                    gsf = temporary("h.GSF"), other = temporary("h.txt");
  write_png16(png, h);
  write_x3p(x3p, h);
  write_gsf(gsf, h, {});
  write_bytes(other, "no map of anything");
  write_gsf(upper, h, {});
  EXPECT_TRUE(refusal(upper).starts_with("cannot read " + upper)) << refusal(upper);
  const std::string shown = temporary("shown.png");
  write_png(shown, h);  // colours
  EXPECT_EQ(refusal(shown),
            "cannot read " + shown +
                ": an integer image without its height scale; multiply its levels by the height "
                "of one, and save a float image in um, a .gsf, or a .npy in m");
  // To half a level of grey, as high as it was.
  const Heightmap back = read_heightmap(png);
  EXPECT_NEAR(back.grid.lx, 4e-6, 1e-15);
  EXPECT_NEAR(back.grid.ly, 3e-6, 1e-15);
  ASSERT_EQ(back.z.size(), h.z.size());
  for (std::size_t i = 0; i < h.z.size(); ++i)
    EXPECT_NEAR(back.z[i], h.z[i], 0.51 * 11e-9 / 65535 + 1e-15) << i;
  // By Gwyddion, where it is there: it finds none.
  EXPECT_NE(refusal(other).find(".x3p"), std::string::npos);
  EXPECT_EQ(refusal(gsf), "");
  EXPECT_EQ(refusal(x3p), "");
  EXPECT_EQ(refusal(temporary("none.gsf")),
            "cannot read " + temporary("none.gsf") + ": no such file");
  EXPECT_EQ(refusal(temporary("")), "cannot read " + temporary("") + ": not a file");
  // By rows they are read.
  EXPECT_EQ(open_height_rows(png)->header().nx, 4);
  EXPECT_EQ(open_height_rows(x3p)->header().ny, 3);
}

TEST(ReadHeights, WithoutASideSayHowToGiveIt) {
  const std::string npy = temporary("side.npy");
  write_npy(npy, {{4, 2, 4e-6, 2e-6}, {1, 2, 3, 4, 5, 6, 7, 8}});
  const auto refusal = [&](double width) -> std::string {
    try {
      read_heightmap(npy, width);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(("cannot read " + npy + ": ").size());
    }
    return "";
  };
  const std::string needed =
      "the file holds no lateral size; give it (texture.width of a measured texture, the size "
      "option of a command)";
  EXPECT_EQ(refusal(0), needed);
  EXPECT_EQ(refusal(-1), needed);
  // 1 pm to 1 km, of both sides: half as high as wide.
  EXPECT_EQ(refusal(2.1e-12), "");
  EXPECT_EQ(refusal(1.9e-12), "a lateral size of 1.9e-12 x 9.5e-13 m; expected 1 pm to 1 km");
  EXPECT_EQ(refusal(999), "");
  EXPECT_EQ(refusal(1001), "a lateral size of 1e+03 x 500 m; expected 1 pm to 1 km");
}

// Row by row, each into a buffer that held nothing of it.
TEST(ShownFields, OfAPictureAreReadRowByRow) {
  constexpr int kWidth = 5, kHeight = 7;
  std::vector<std::uint8_t> rgb(3 * kWidth * kHeight);
  for (std::size_t i = 0; i < rgb.size(); ++i) rgb[i] = static_cast<std::uint8_t>(2 * i + 1);
  const std::string path = temporary("rows.png");
  write_png_rgb(path, kWidth, kHeight, rgb);
  const auto rows = open_picture_rows(path);
  EXPECT_EQ(rows->width, kWidth);
  EXPECT_EQ(rows->height, kHeight);
  EXPECT_EQ(rows->channels, 3);
  EXPECT_FALSE(rows->tag_x);
  std::vector<std::uint8_t> back;
  for (int y = 0; y < kHeight; ++y) {
    std::vector<std::uint8_t> row(3 * kWidth);
    rows->next(row.data());
    back.insert(back.end(), row.begin(), row.end());
  }
  EXPECT_EQ(back, rgb);
}

// X3P of another program: heights in steps of three metres.
TEST(ReadHeights, OfAnX3pAreInTheStepsOfTheirAxis) {
  const std::string path = temporary("steps.x3p");
  write_x3p(path, {{3, 2, 6e-6, 5e-6}, {1, 2, 3, 4, 5, 6}});
  auto [xml, heights] = x3p_parts(path, 6);
  const std::size_t axis = xml.find("<Increment>1</Increment>");
  ASSERT_NE(axis, std::string::npos);
  xml[axis + 11] = '3';
  write_zip(path, {{"main.xml", xml},
                   {"bindata/data.bin", heights},
                   {"md5checksum.hex", md5_of(xml) + " *main.xml\n"}});
  const Heightmap h = whole_map(*open_height_rows(path), 0);
  EXPECT_NEAR(h.grid.lx, 6e-6, 1e-18);
  EXPECT_NEAR(h.grid.ly, 5e-6, 1e-18);
  EXPECT_EQ(h.z, (std::vector<double>{3, 6, 9, 12, 15, 18}));
}

}  // namespace
}  // namespace papilla::tests::shown_and_refused_test
