// What stands in the files that go to others, as wholes: headers, keys, bytes, corners.
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "geometry/io/files.h"
#include "geometry/io/height_rows.h"
#include "geometry/io/layout.h"
#include "tests/io/address_limit.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::written_files_test {
namespace {

using namespace std::string_literals;

// Three columns and two rows: 0, 1, 2 nm below and 3, 4, 5 nm above, sides that are exact.
Heightmap six() { return {{3, 2, 6e-6, 5e-6}, {0, 1e-9, 2e-9, 3e-9, 4e-9, 5e-9}}; }

template <typename T>
std::string bytes_of(const std::vector<double>& values) {
  std::string out;
  for (const double v : values) {
    const T one = static_cast<T>(v);
    out.append(reinterpret_cast<const char*>(&one), sizeof one);
  }
  return out;
}

// The header is ended by one to four zeros, so that the numbers begin at a multiple of four.
TEST(WrittenFiles, AGsfIsItsHeaderAndItsRowsFromTheTop) {
  const std::string path = temporary("six.gsf");
  for (const std::string title : {"a", "ab", "abc", "abcd"}) {
    write_gsf(path, six(), {title, "nothing"});
    std::string header =
        "Gwyddion Simple Field 1.0\nXRes = 3\nYRes = 2\nXReal = 6e-06\nYReal = 5e-06\n"
        "XYUnits = m\nZUnits = m\nTitle = " +
        title + "\nPapillaDesign = nothing\n";
    header += std::string(4 - header.size() % 4, '\0');
    EXPECT_EQ(read_bytes(path), header + bytes_of<float>({3e-9, 4e-9, 5e-9, 0, 1e-9, 2e-9}));
  }
}

TEST(WrittenFiles, ANpyIsItsHeaderAndItsRowsFromBelow) {
  const std::string path = temporary("six.npy");
  write_npy(path, six());
  const std::string dictionary = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }";
  const std::string header =
      "\x93NUMPY\x01\x00v\x00"s + dictionary + std::string(118 - dictionary.size() - 1, ' ') + "\n";
  ASSERT_EQ(header.size(), 128u);  // 'v' is 118
  EXPECT_EQ(read_bytes(path), header + bytes_of<double>(six().z));
}

OIIO::ImageSpec spec_of(const std::string& path) {
  const auto in = OIIO::ImageInput::open(path);
  EXPECT_TRUE(in) << OIIO::geterror();
  return in ? in->spec() : OIIO::ImageSpec();
}

// Pixels of 2 x 2.5 um are 5000 and 4000 a centimetre; black and white at their own heights.
TEST(WrittenFiles, ATiffDescribesItselfAndHasItsPixelsPerCentimetre) {
  const std::string path = temporary("six.tif");
  const FileInfo info{"my title", "my comment"};
  const auto expect = [&](const std::string& polarity, const std::string& black,
                          const std::string& white, const std::string& levels) {
    const OIIO::ImageSpec spec = spec_of(path);
    EXPECT_EQ(spec.get_string_attribute("ImageDescription"),
              "ImageJ=1.53\nunit=cm\n" + levels +
                  "vunit=um\npapilla={\"papilla\":\"" PAPILLA_VERSION
                  "\",\"title\":\"my title\",\"comment\":\"my comment\",\"size_x_m\":6e-06,"
                  "\"size_y_m\":5e-06,\"polarity\":\"" +
                  polarity + "\",\"black_m\":" + black + ",\"white_m\":" + white +
                  ",\"rows\":\"top first\"}\n");
    EXPECT_EQ(spec.get_string_attribute("DateTime"), "2000:01:01 00:00:00");
    EXPECT_EQ(spec.get_string_attribute("Software"), "papilla " PAPILLA_VERSION);
    EXPECT_EQ(spec.get_string_attribute("compression"), "none");
    EXPECT_EQ(spec.get_string_attribute("ResolutionUnit"), "cm");
    EXPECT_NEAR(spec.get_float_attribute("XResolution"), 5000, 0.01);
    EXPECT_NEAR(spec.get_float_attribute("YResolution"), 4000, 0.01);
    EXPECT_NEAR(spec.get_float_attribute("PixelAspectRatio"), 0.8, 1e-6);
    EXPECT_EQ(spec.tile_width, 0);
    EXPECT_EQ(spec.nchannels, 1);
  };
  write_tiff_float(path, six(), info);
  expect("white-is-high", "0.0", "1e-06", "");  // its numbers are um
  // ImageJ: the height of a level is c0 + c1 * level um.
  const std::string up = "cf=0\nc0=0\nc1=7.62951095e-08\n",
                    down = "cf=0\nc0=0.005\nc1=-7.62951095e-08\n";
  write_tiff16(path, six(), Polarity::WhiteHigh, info);
  expect("white-is-high", "0.0", "5e-09", up);
  write_tiff16(path, six(), Polarity::WhiteDeep, info);
  expect("white-is-deep", "5e-09", "0.0", down);
  write_mask_tiff(path, six(), Polarity::WhiteDeep, info);
  expect("white-is-deep", "5e-09", "0.0", down);
}

std::vector<int> levels(const std::string& path) {
  const auto in = OIIO::ImageInput::open(path);
  EXPECT_TRUE(in) << OIIO::geterror();
  std::vector<std::uint16_t> out(6);
  if (in) in->read_image(0, 0, 0, 1, OIIO::TypeDesc::UINT16, out.data());
  return {out.begin(), out.end()};
}

// Fifths of 65535, the top row first; half the depth lies between 2 and 3 nm.
TEST(WrittenFiles, SixteenBitsAreSharesOfTheDepthAndAMaskItsHalves) {
  const std::string tif = temporary("six.tif"), png = temporary("six.png");
  write_tiff16(tif, six(), Polarity::WhiteHigh, {});
  EXPECT_EQ(levels(tif), (std::vector<int>{39321, 52428, 65535, 0, 13107, 26214}));
  write_png16(png, six());
  EXPECT_EQ(levels(png), levels(tif));
  write_tiff16(tif, six(), Polarity::WhiteDeep, {});
  EXPECT_EQ(levels(tif), (std::vector<int>{26214, 13107, 0, 65535, 52428, 39321}));
  write_mask_tiff(tif, six(), Polarity::WhiteDeep, {});
  EXPECT_EQ(levels(tif), (std::vector<int>{0, 0, 0, 65535, 65535, 65535}));
  write_mask_tiff(tif, six(), Polarity::WhiteHigh, {});
  EXPECT_EQ(levels(tif), (std::vector<int>{65535, 65535, 65535, 0, 0, 0}));
  // What is flat is all high: white, or black where white is deep.
  Heightmap flat = six();
  flat.z.assign(6, 7e-9);
  write_tiff16(tif, flat, Polarity::WhiteHigh, {});
  EXPECT_EQ(levels(tif), std::vector<int>(6, 65535));
  write_mask_tiff(tif, flat, Polarity::WhiteDeep, {});
  EXPECT_EQ(levels(tif), std::vector<int>(6, 0));
}

TEST(WrittenFiles, AnExrHasTheKeysOfGwyddionForAllItsTiles) {
  const std::string path = temporary("six.exr");
  const auto number = [&](const char* name) {
    const OIIO::ImageSpec spec = spec_of(path);
    const OIIO::ParamValue* p = spec.find_attribute(name, OIIO::TypeDesc::DOUBLE);
    return p ? *static_cast<const double*>(p->data()) : 0;
  };
  for (const int repeat : {1, 3}) {
    write_exr_repeated(path, six(), repeat, {"my title", "my comment"});
    const OIIO::ImageSpec spec = spec_of(path);
    EXPECT_EQ(spec.width, 3 * repeat);
    EXPECT_EQ(spec.height, 2 * repeat);
    EXPECT_EQ(spec.channelnames, std::vector<std::string>{"Y"});
    EXPECT_EQ(spec.format, OIIO::TypeDesc::FLOAT);
    EXPECT_EQ(spec.get_string_attribute("compression"), "zip");
    EXPECT_EQ(number("Gwy::XReal"), repeat * 6e-6);
    EXPECT_EQ(number("Gwy::YReal"), repeat * 5e-6);
    EXPECT_EQ(spec.get_string_attribute("Gwy::XYUnit"), "m");
    EXPECT_EQ(spec.get_string_attribute("Gwy::ZUnit"), "um");
    EXPECT_EQ(spec.get_string_attribute("Gwy::Title"), "my title");
    EXPECT_EQ(spec.get_string_attribute("DateTime"), "2000:01:01 00:00:00");
    std::string all;
    for (const OIIO::ParamValue& p : spec.extra_attribs) all += p.get_string() + "\n";
    EXPECT_NE(all.find("my comment"), std::string::npos) << all;
  }
}

// Its numbers are texts, to the last digit.
TEST(WrittenFiles, APngOfHeightsHasTheKeysOfGwyddion) {
  const std::string path = temporary("keys.png");
  Heightmap h = six();
  for (double& z : h.z) z -= 2e-9;
  write_png16(path, h);
  const OIIO::ImageSpec spec = spec_of(path);
  for (const auto& [name, value] : {std::pair{"Gwy::XReal", 6e-6},
                                    {"Gwy::YReal", 5e-6},
                                    {"Gwy::ZMin", -2e-9},
                                    {"Gwy::ZMax", h.z.back()}})
    EXPECT_EQ(std::stod(spec.get_string_attribute(name)), value) << name;
  EXPECT_EQ(spec.get_string_attribute("Gwy::XYUnit"), "m");
  EXPECT_EQ(spec.get_string_attribute("Gwy::ZUnit"), "m");
}

// A height below a hundred thousandth of an atom is the lowest plane, exactly zero.
TEST(WrittenFiles, TheLowestPlaneOfAnExrIsZero) {
  const std::string path = temporary("lowest.exr");
  write_exr(path, {{4, 1, 4e-6, 1e-6}, {0, 0.9e-15, 1.1e-15, 1e-9}}, {});
  const auto in = OIIO::ImageInput::open(path);
  ASSERT_TRUE(in);
  std::array<float, 4> um{};
  ASSERT_TRUE(in->read_image(0, 0, 0, 1, OIIO::TypeDesc::FLOAT, um.data()));
  EXPECT_EQ(um[0], 0);
  EXPECT_EQ(um[1], 0);
  EXPECT_FLOAT_EQ(um[2], 1.1e-9F);
  EXPECT_FLOAT_EQ(um[3], 1e-3F);
}

// --- a body of triangles ---

using Corner = std::array<float, 3>;
using Face = std::array<Corner, 4>;  // its normal, then its corners

std::vector<Face> faces(const std::string& bytes) {
  std::vector<Face> out((bytes.size() - 84) / 50);
  for (std::size_t i = 0; i < out.size(); ++i)
    std::memcpy(out[i].data(), bytes.data() + 84 + 50 * i, sizeof(Face));
  return out;
}

// One pixel of 2 x 4 um is a box, 3 um above its lowest place: twelve triangles, each seen from
// outside counterclockwise.
TEST(WrittenStl, OfOnePixelIsABox) {
  const std::string path = temporary("box.stl");
  write_stl(path, {{1, 1, 2e-6, 4e-6}, {5e-6}}, 3e-6);
  const std::string bytes = read_bytes(path);
  ASSERT_EQ(bytes.size(), 84u + 12 * 50);
  EXPECT_EQ(bytes.substr(0, 24), "papilla heightmap in um ");
  EXPECT_EQ(bytes.substr(24, 60), std::string(56, '\0') + "\x0c\0\0\0"s);
  const Corner o{0, 0, 3}, x{2, 0, 3}, xy{2, 4, 3}, y{0, 4, 3};     // above
  const Corner p{0, 0, 0}, px{2, 0, 0}, pxy{2, 4, 0}, py{0, 4, 0};  // on the base
  const Corner up{0, 0, 1}, down{0, 0, -1}, left{-1, 0, 0}, right{1, 0, 0};
  const Corner front{0, -1, 0}, back{0, 1, 0};
  const std::vector<Face> box{{up, o, x, xy},     {up, o, xy, y},     {down, p, pxy, px},
                              {down, p, py, pxy}, {front, p, px, x},  {front, p, x, o},
                              {back, pxy, py, y}, {back, pxy, y, xy}, {right, px, pxy, xy},
                              {right, px, xy, x}, {left, py, p, o},   {left, py, o, y}};
  const std::vector<Face> written = faces(bytes);
  ASSERT_EQ(written.size(), box.size());
  for (std::size_t i = 0; i < box.size(); ++i) {
    for (std::size_t k = 1; k < 4; ++k) EXPECT_EQ(written[i][k], box[i][k]) << i << " " << k;
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(written[i][0][axis], box[i][0][axis], 1e-6) << i;
  }
}

// Pixels of 1 and 3 x 2 um: the corners that each triangle has of the surface, row by row, the
// first column and row again at the far sides.
TEST(WrittenStl, HasTheHeightsOfThePixelsAtTheirCorners) {
  const std::string path = temporary("few.stl");
  const Heightmap h{{2, 3, 2e-6, 6e-6}, {0, 1e-6, 2e-6, 3e-6, 4e-6, 5e-6}};
  write_stl(path, h);  // on a base of 1 um
  const std::vector<Face> all = faces(read_bytes(path));
  ASSERT_EQ(all.size(), 4u * 6 + 4 * (2 + 3));
  const auto corner = [&](int ix, int iy) {
    return Corner{static_cast<float>(ix), static_cast<float>(2 * iy),
                  static_cast<float>(1 + (iy % 3) * 2 + ix % 2)};
  };
  std::size_t i = 0;
  for (int iy = 0; iy < 3; ++iy) {
    for (int ix = 0; ix < 2; ++ix, i += 4) {
      const Corner a = corner(ix, iy), b = corner(ix + 1, iy), c = corner(ix + 1, iy + 1),
                   d = corner(ix, iy + 1);
      const std::array<std::array<Corner, 3>, 2> upper{{{a, b, c}, {a, c, d}}};
      for (std::size_t k = 0; k < 2; ++k) {
        for (std::size_t n = 0; n < 3; ++n) {
          for (std::size_t axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(all[i + k][n + 1][axis], upper[k][n][axis], 1e-6) << i << k << n;
        }
      }
      for (std::size_t k = 2; k < 4; ++k) {
        for (std::size_t n = 1; n < 4; ++n) EXPECT_EQ(all[i + k][n][2], 0);
        EXPECT_EQ(all[i + k][0], (Corner{0, 0, -1}));
      }
    }
  }
}

TEST(WrittenStl, OfMoreThanFourMillionPixelsIsRefused) {
  const auto refusal = [](int nx, int ny) -> std::string {
    return refusal_of([&] { write_stl(temporary("large.stl"), {{nx, ny, 1e-3, 1e-3}, {}}); });
  };
  EXPECT_EQ(refusal(2000, 2001), "2000 x 2001 pixels are too many for STL; export fewer");
  EXPECT_EQ(refusal(4000001, 1), "4000001 x 1 pixels are too many for STL; export fewer");
}

// --- memory ---

std::string npy_of(int columns, int rows) {
  const std::string header = fmt::format(
      "{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}\n", rows, columns);
  const auto length = static_cast<std::uint16_t>(header.size());
  std::string out = "\x93NUMPY\x01\x00"s;
  out.append(reinterpret_cast<const char*>(&length), sizeof length);
  return out + header;
}

// Two numbers of eight bytes a pixel: 3 GiB are 12288 x 16384 pixels.
TEST(ReadFiles, WhatTheMemoryDoesNotHoldIsRefusedBeforeItIsRead) {
  if (!kAddressesAreFree) GTEST_SKIP() << "the sanitizer has the addresses";
  const std::string path = temporary("vast.npy");
  const auto refusal = [&](int columns, int rows) -> std::string {
    write_bytes(path, npy_of(columns, rows));
    const AddressLimit limit(3.0 * (1 << 30));
    return refusal_of([&] { open_height_rows(path); });
  };
  EXPECT_EQ(refusal(12288, 16384), "cannot read " + path + ": the data are cut off");
  EXPECT_EQ(refusal(12289, 16384),
            path + " (12289 x 16384 pixels) needs 3 GiB of memory; 3 GiB are there");
  EXPECT_EQ(refusal(16384, 12289),
            path + " (16384 x 12289 pixels) needs 3 GiB of memory; 3 GiB are there");
}

}  // namespace
}  // namespace papilla::tests::written_files_test
