// Images as other programs write them, by OpenImageIO and by hand, and ours as OpenImageIO reads
// them: whichever codec this build has.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "geometry/io/files.h"
#include "geometry/io/height_rows.h"
#include "geometry/io/layout.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::foreign_images_test {
namespace {

constexpr int kNx = 37, kNy = 50;

// Micrometres, rows from the top, no two alike.
float height(int x, int y) {
  return 0.001f * static_cast<float>(x) + 0.07f * static_cast<float>(y);
}

template <typename T>
void write(const std::string& path, OIIO::ImageSpec spec, const std::vector<T>& pixels) {
  const auto out = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(out && out->open(path, spec)) << OIIO::geterror();
  if (spec.tile_width > 0) {
    ASSERT_TRUE(out->write_image(OIIO::TypeDescFromC<T>::value(), pixels.data()));
  } else {
    ASSERT_TRUE(out->write_scanlines(spec.y, spec.y + spec.height, 0,
                                     OIIO::TypeDescFromC<T>::value(), pixels.data()));
  }
  ASSERT_TRUE(out->close());
}

std::vector<float> heights() {
  std::vector<float> out;
  for (int y = 0; y < kNy; ++y) {
    for (int x = 0; x < kNx; ++x) out.push_back(height(x, y));
  }
  return out;
}

void expect_heights(const std::string& path, double tolerance) {
  const Heightmap h = read_heightmap(path, 3.7e-6);
  ASSERT_EQ(h.grid.nx, kNx);
  ASSERT_EQ(h.grid.ny, kNy);
  for (int y = 0; y < kNy; ++y) {
    for (int x = 0; x < kNx; ++x) {
      ASSERT_NEAR(h(x, kNy - 1 - y), 1e-6 * static_cast<double>(height(x, y)), tolerance)
          << path << " " << x << " " << y;
    }
  }
}

// Deflated floats come with differences of their bytes (predictor 3).
TEST(ForeignImages, TiffsOfFloatsAreRead) {
  for (const char* compression : {"none", "zip"}) {
    for (const int rows : {1, 7, kNy}) {
      OIIO::ImageSpec spec(kNx, kNy, 1, OIIO::TypeDesc::FLOAT);
      spec.attribute("compression", compression);
      spec.attribute("tiff:RowsPerStrip", rows);
      const std::string path = temporary("floats.tif");
      write(path, spec, heights());
      expect_heights(path, 1e-18);
    }
  }
}

TEST(ForeignImages, ExrsOfTilesAndOfHalfFloatsAreRead) {
  for (const auto& [tile, type, tolerance] :
       {std::tuple{0, OIIO::TypeDesc::FLOAT, 1e-18},
        {16, OIIO::TypeDesc::FLOAT, 1e-18},
        {0, OIIO::TypeDesc::HALF, 2e-9}}) {  // 11 bits of 3.5 um
    OIIO::ImageSpec spec(kNx, kNy, 1, OIIO::TypeDesc(type));
    spec.channelnames = {"Y"};
    spec.tile_width = spec.tile_height = tile;
    const std::string path = temporary("tiles.exr");
    write(path, spec, heights());
    expect_heights(path, tolerance);
  }
}

// The description that Papilla writes, in the byte order of other processors.
TEST(ForeignImages, ATiffOfTheOtherByteOrderIsRead) {
  const std::string json =
      R"({"size_x_m": 3e-6, "size_y_m": 2e-6, "polarity": "white-is-high", "black_m": 0, "white_m": 65535e-9})";
  std::string file("MM\0\x2a", 4);
  const auto add = [&file](std::size_t value, int size) {
    for (int i = size - 1; i >= 0; --i) file += static_cast<char>(value >> 8 * i & 255);
  };
  add(8 + 12, 4);
  for (const int level : {0, 1, 256, 513, 40000, 65535}) add(static_cast<std::size_t>(level), 2);
  const std::size_t text = 20 + 2 + 9 * 12 + 4;
  add(9, 2);
  const auto entry = [&](std::size_t tag, std::size_t type, std::size_t count, std::size_t value) {
    add(tag, 2);
    add(type, 2);
    add(count, 4);
    add(type == 3 ? value << 16 : value, 4);
  };
  entry(256, 3, 1, 3);
  entry(257, 3, 1, 2);
  entry(258, 3, 1, 16);
  entry(259, 3, 1, 1);
  entry(262, 3, 1, 1);
  entry(270, 2, json.size() + 1, text);
  entry(273, 4, 1, 8);
  entry(278, 3, 1, 2);
  entry(279, 4, 1, 12);
  add(0, 4);
  const std::string path = temporary("other.tif");
  std::ofstream(path, std::ios::binary) << file << json << '\0';
  const Heightmap h = read_heightmap(path);
  EXPECT_NEAR(h.grid.lx, 3e-6, 1e-18);
  EXPECT_NEAR(h.grid.ly, 2e-6, 1e-18);
  const double expected[2][3] = {{513e-9, 40000e-9, 65535e-9}, {0, 1e-9, 256e-9}};  // from below
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) EXPECT_NEAR(h(x, y), expected[y][x], 2e-12) << x << " " << y;
  }
}

TEST(ForeignImages, PicturesKeepTheirLevelsBothWays) {
  std::vector<std::uint8_t> rgb;
  for (int i = 0; i < 3 * kNx * kNy; ++i) rgb.push_back(static_cast<std::uint8_t>(i * i % 251));
  const std::string ours = temporary("ours.png"), theirs = temporary("theirs.png");
  write_png_rgb(ours, kNx, kNy, rgb);
  const auto in = OIIO::ImageInput::open(ours);
  ASSERT_TRUE(in);
  std::vector<std::uint8_t> back(rgb.size());
  ASSERT_TRUE(in->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, back.data()));
  EXPECT_EQ(back, rgb);

  write(theirs, OIIO::ImageSpec(kNx, kNy, 3, OIIO::TypeDesc::UINT8), rgb);
  const auto picture = open_picture_rows(theirs);
  ASSERT_EQ(picture->channels, 3);
  for (int y = 0; y < kNy; ++y)
    picture->next(back.data() + static_cast<std::ptrdiff_t>(y) * 3 * kNx);
  EXPECT_EQ(back, rgb);
}

TEST(ForeignImages, ThoseOfOursHaveTheirNumbersForOthers) {
  Heightmap h{{kNx, kNy, 3.7e-6, 10e-6}, {}};
  for (int y = kNy - 1; y >= 0; --y) {
    for (int x = 0; x < kNx; ++x) h.z.push_back(1e-6 * static_cast<double>(height(x, y)));
  }
  const std::string exr = temporary("ours.exr"), tif = temporary("ours.tif"),
                    png = temporary("ours16.png");
  write_exr(exr, h, {});
  write_tiff_float(tif, h, {});
  write_png16(png, h);
  for (const std::string& path : {exr, tif}) {
    const auto in = OIIO::ImageInput::open(path);
    ASSERT_TRUE(in) << path << OIIO::geterror();
    std::vector<float> back(static_cast<std::size_t>(kNx * kNy));
    ASSERT_TRUE(in->read_image(0, 0, 0, 1, OIIO::TypeDesc::FLOAT, back.data()));
    for (int y = 0; y < kNy; ++y) {
      for (int x = 0; x < kNx; ++x)
        ASSERT_NEAR(back[static_cast<std::size_t>(y * kNx + x)], height(x, y), 1e-6) << path;
    }
    EXPECT_EQ(in->spec().get_string_attribute("DateTime"), "2000:01:01 00:00:00") << path;
  }
  EXPECT_NEAR(OIIO::ImageInput::open(tif)->spec().get_float_attribute("XResolution"), 1e5, 0.1);
  EXPECT_NEAR(OIIO::ImageInput::open(tif)->spec().get_float_attribute("YResolution"), 5e4, 0.1);
  const auto in = OIIO::ImageInput::open(png);
  ASSERT_TRUE(in);
  EXPECT_EQ(in->spec().format, OIIO::TypeDesc::UINT16);
  EXPECT_EQ(std::stod(in->spec().get_string_attribute("Gwy::XReal")), 3.7e-6);
  std::vector<std::uint16_t> back(static_cast<std::size_t>(kNx * kNy));
  ASSERT_TRUE(in->read_image(0, 0, 0, 1, OIIO::TypeDesc::UINT16, back.data()));
  EXPECT_EQ(back.front(), 0);
  EXPECT_EQ(back.back(), 65535);
  const auto rows = open_height_rows(png);
  EXPECT_NEAR(rows->header().ly, 10e-6, 1e-18);
  std::vector<double> first(kNx);
  rows->next(first.data());
  for (int x = 0; x < kNx; ++x)
    EXPECT_NEAR(first[static_cast<std::size_t>(x)], 1e-6 * static_cast<double>(height(x, 0)),
                3e-11);
}

std::string refusal(const std::string& ending, const std::string& bytes) {
  const std::string path = temporary("damaged." + ending);
  std::ofstream(path, std::ios::binary) << bytes;
  return refusal_of([&] { read_heightmap(path, 1e-6); });
}

// A header is judged before the library makes room for what it claims.
TEST(ForeignImages, AnExrHeaderIsJudgedBeforeItIsTrusted) {
  const std::string path = temporary("head.exr");
  OIIO::ImageSpec spec(kNx, kNy, 1, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"Y"};
  spec.x = 11, spec.y = 23;  // its window begins elsewhere
  spec.full_x = 11, spec.full_y = 23;
  write(path, spec, heights());
  expect_heights(path, 1e-18);
  const std::string bytes = read_bytes(path);
  for (const std::size_t at : {0u, 1u, 2u, 3u}) {
    std::string other = bytes;
    ++other[at];
    EXPECT_NE(refusal("exr", other).find("no OpenEXR file"), std::string::npos) << at;
  }
  for (const int flag : {0x08, 0x10}) {
    std::string other = bytes;
    other[5] = static_cast<char>(other[5] | flag);
    EXPECT_NE(refusal("exr", other).find("several or deep parts"), std::string::npos) << flag;
  }
  for (const std::size_t length : {0u, 7u, 9u, 40u, 120u}) {
    const std::string why = refusal("exr", bytes.substr(0, length));
    EXPECT_NE(why.find(length < 8 ? "no OpenEXR file" : "the header is cut off"), std::string::npos)
        << length << why;
  }
  // A window of 2^28 pixels and a row, from its own corner: the least that is refused for its size.
  const std::size_t box = bytes.find("dataWindow") + std::string("dataWindow.box2i.0000").size();
  const auto window = [&](std::int32_t x0, std::int32_t y0, std::int32_t x1, std::int32_t y1) {
    std::string other = bytes;
    for (const auto& [place, value] : {std::pair{0, x0}, {4, y0}, {8, x1}, {12, y1}})
      std::memcpy(&other[box + static_cast<std::size_t>(place)], &value, 4);
    return refusal("exr", other);
  };
  EXPECT_NE(window(11, 23, 11 + 16383, 23 + 16384).find("16384 x 16385 pixels; at most 2^28"),
            std::string::npos);
  EXPECT_NE(window(-5, -7, -5 + 16384, -7 + 16383).find("16385 x 16384 pixels; at most 2^28"),
            std::string::npos);
  const std::string most = window(0, 0, 16383, 16383);  // refused for its length alone
  EXPECT_NE(most, "");
  EXPECT_EQ(most.find("at most 2^28"), std::string::npos) << most;
}

// Sides by the tags that other programs take for the size.
TEST(ForeignImages, ResolutionsAreReadInTheirUnits) {
  for (const auto& [unit, metres] : {std::pair{"cm", 1e-2}, {"in", 25.4e-3}, {"none", 0.0}}) {
    OIIO::ImageSpec spec(kNx, kNy, 1, OIIO::TypeDesc::FLOAT);
    spec.attribute("XResolution", 2000.0F);
    spec.attribute("YResolution", 500.0F);
    spec.attribute("PixelAspectRatio", 0.25F);  // else unequal ones are made equal
    spec.attribute("ResolutionUnit", unit);
    const std::string path = temporary("tags.tif");
    write(path, spec, heights());
    const auto rows = open_height_rows(path);
    EXPECT_EQ(rows->header().tag_x.has_value(), metres > 0) << unit;
    if (metres == 0) continue;
    EXPECT_NEAR(*rows->header().tag_x, kNx * metres / 2000, 1e-9 * metres) << unit;
    EXPECT_NEAR(*rows->header().tag_y, kNy * metres / 500, 1e-9 * metres) << unit;
    const auto picture = open_picture_rows(path);
    EXPECT_EQ(picture->width, kNx);
    EXPECT_EQ(picture->height, kNy);
    EXPECT_EQ(picture->channels, 1);
    EXPECT_NEAR(*picture->tag_y, kNy * metres / 500, 1e-9 * metres) << unit;
  }
}

// Of several channels the one named Y counts, else the first.
TEST(ForeignImages, TheChannelOfHeightsIsTakenByItsName) {
  for (const bool named : {true, false}) {
    OIIO::ImageSpec spec(kNx, kNy, 2, OIIO::TypeDesc::FLOAT);
    spec.channelnames = {named ? "R" : "P", named ? "Y" : "Q"};
    std::vector<float> pixels;
    for (const float z : heights()) {
      pixels.push_back(named ? 7.0F : z);
      pixels.push_back(named ? z : 7.0F);
    }
    const std::string path = temporary("channels.exr");
    write(path, spec, pixels);
    expect_heights(path, 1e-18);
  }
}

// Eight of its pixels are a byte before it is packed.
TEST(ForeignImages, ABlackMaskOfOneBitIsNotTakenForOneThatIsCutOff) {
  constexpr int kWide = 4096, kHigh = 2048;
  OIIO::ImageSpec spec(kWide, kHigh, 1, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:BitsPerSample", 1);
  spec.attribute("compression", "zip");
  spec.attribute("tiff:RowsPerStrip", kHigh);
  const std::string path = temporary("black.tif");
  write(path, spec, std::vector<std::uint8_t>(std::size_t{kWide} * kHigh));
  ASSERT_LT(std::filesystem::file_size(path), std::size_t{kWide} * kHigh / 2000);
  EXPECT_NE(refusal_of([&] { read_heightmap(path, 1e-6); }).find("without its height scale"),
            std::string::npos);
}

// Whole numbers say nothing of heights by themselves; by their description they do, black and white
// at their own heights, whichever is higher.
TEST(ForeignImages, GreyHasTheHeightsOfItsDescription) {
  std::vector<std::uint16_t> grey;
  for (int i = 0; i < kNx * kNy; ++i) grey.push_back(static_cast<std::uint16_t>(35 * i));
  OIIO::ImageSpec spec(kNx, kNy, 1, OIIO::TypeDesc::UINT16);
  const std::string path = temporary("grey.tif");
  write(path, spec, grey);
  EXPECT_NE(refusal_of([&] { read_heightmap(path, 1e-6); }).find("without its height scale"),
            std::string::npos);
  const std::string sides = R"("size_x_m": 4e-6, "size_y_m": 3e-6)";
  spec.attribute("ImageDescription", "{" + sides + R"(, "black_m": 1e-7})");
  write(path, spec, grey);
  EXPECT_THROW(read_heightmap(path), InputError);
  spec.attribute(
      "ImageDescription",
      "{" + sides + R"(, "polarity": "white-is-deep", "black_m": 1e-7, "white_m": -2e-7})");
  write(path, spec, grey);
  const auto rows = open_height_rows(path);
  EXPECT_EQ(rows->header().polarity, Polarity::WhiteDeep);
  EXPECT_NEAR(rows->header().step, 3e-7 / 65535, 1e-18);
  const Heightmap h = read_heightmap(path);
  EXPECT_NEAR(h.grid.lx, 4e-6, 1e-18);
  EXPECT_NEAR(h.grid.ly, 3e-6, 1e-18);
  for (int y = 0; y < kNy; ++y) {
    for (int x = 0; x < kNx; ++x)
      ASSERT_NEAR(h(x, kNy - 1 - y), 1e-7 - 3e-7 * 35 * (y * kNx + x) / 65535.0, 1e-13);
  }
}

}  // namespace
}  // namespace papilla::tests::foreign_images_test
