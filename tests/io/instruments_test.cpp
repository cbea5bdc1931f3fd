// Files of instruments: every own format by bytes that are made here, and what is refused.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "base/error.h"
#include "base/files.h"
#include "base/random.h"
#include "geometry/io/files.h"
#include "geometry/io/layout.h"
#include "geometry/scan.h"
#include "tests/io/instrument_bytes.h"
#include "tests/io/zip_file.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::instruments_test {
namespace {

Heightmap slope_and_bumps() {
  Heightmap h{{9, 6, 18e-6, 9e-6}, {}};
  for (int iy = 0; iy < 6; ++iy) {
    for (int ix = 0; ix < 9; ++ix)
      h.z.push_back(1e-9 * std::round(40.0 * ix + 90.0 * iy * iy - 300));  // whole nanometres
  }
  return h;
}

std::string written(const std::string& name, const std::string& bytes) {
  const std::string path = temporary(name);
  write_bytes(path, bytes);
  return path;
}

void expect_same(const Heightmap& read, const Heightmap& wanted, double near) {
  EXPECT_EQ(read.grid.nx, wanted.grid.nx);
  EXPECT_EQ(read.grid.ny, wanted.grid.ny);
  EXPECT_NEAR(read.grid.lx, wanted.grid.lx, 1e-7 * wanted.grid.lx);
  EXPECT_NEAR(read.grid.ly, wanted.grid.ly, 1e-7 * wanted.grid.ly);
  ASSERT_EQ(read.z.size(), wanted.z.size());
  for (std::size_t i = 0; i < wanted.z.size(); ++i) ASSERT_NEAR(read.z[i], wanted.z[i], near) << i;
}

TEST(Gwy, IsReadToTheLastDigitInAnyUnit) {
  const Heightmap h = slope_and_bumps();
  expect_same(read_heightmap(written("one.gwy", gwy_bytes({{"Height", "m", &h}}))), h, 1e-20);
  expect_same(read_heightmap(written("nm.gwy", gwy_bytes({{"Height", "nm", &h, 1e-9}}))), h, 1e-20);
}

// Whether it marks what was not measured, or grains, is for the user to say.
TEST(Gwy, APixelThatAMaskMarksIsAHeightUntilItIsToBeFilled) {
  const Heightmap h = slope_and_bumps();
  Heightmap mask{h.grid, std::vector<double>(h.z.size(), 0.0)};
  mask(2, 1) = mask(3, 1) = 1;
  const std::string path =
      written("mask.gwy", gwy_bytes({{.title = "Height", .unit = "m", .map = &h, .mask = &mask}}));
  expect_same(read_heightmap(path), h, 1e-20);
  const Heightmap kept = read_heightmap(path, 0, NotNumbers::Kept);
  for (std::size_t i = 0; i < h.z.size(); ++i)
    ASSERT_EQ(std::isnan(kept.z[i]), mask.z[i] == 1) << i;
  const Scan heights = read_scan({path, 0, false, true}), filled = read_scan({path, 0, true, true});
  EXPECT_EQ(heights.changes.filled, 0u);
  EXPECT_NE(text(path, heights.changes)
                .find("the mask of the file marks 2 of 54 pixels (3.7 %), which are taken as "
                      "heights (--fill, texture.fill = true take them as not measured"),
            std::string::npos)
      << text(path, heights.changes);
  EXPECT_EQ(filled.changes.filled, 2u);
  EXPECT_NE(text(path, filled.changes)
                .find("2 of 54 pixels (3.7 %) were no numbers or marked by the mask of the file "
                      "and were filled"),
            std::string::npos)
      << text(path, filled.changes);
}

// Grains on a third of a map: it cannot be filled, and it need not be.
TEST(Gwy, AMaskOfMoreThanAFifthIsAdvisedToBeLeftAsHeights) {
  const Heightmap h = slope_and_bumps();
  Heightmap mask{h.grid, std::vector<double>(h.z.size(), 0.0)};
  for (std::size_t i = 0; i < 18; ++i) mask.z[i] = 1;
  const std::string path = written(
      "grains.gwy", gwy_bytes({{.title = "Height", .unit = "m", .map = &h, .mask = &mask}}));
  EXPECT_EQ(
      refusal_of([&] {
        read_scan({path, 0, true, true});
      }),
      path +
          ": 18 of 54 pixels (33 %) are no numbers or marked by the mask of the file; at most "
          "a fifth can be filled: cut the map, or leave --fill (texture.fill) out to take "
          "what is marked as heights, as for a mask of grains");
  const std::string said = text(path, read_scan({path, 0, false, true}).changes);
  EXPECT_NE(
      said.find("the mask of the file marks 18 of 54 pixels (33 %), which are taken as heights"),
      std::string::npos)
      << said;
  EXPECT_EQ(said.find("--fill"), std::string::npos) << said;
}

TEST(Gwy, OfSeveralChannelsOneIsNamed) {
  const Heightmap h = slope_and_bumps();
  Heightmap back = h;
  for (double& z : back.z) z *= 2;
  const std::string path =
      written("several.gwy",
              gwy_bytes({{"Trace", "m", &h}, {"Phase", "deg", &h}, {"Retrace", "m", &back}}));
  const std::string why = refusal_of([&] { read_heightmap(path); });
  for (const char* part : {"2 of its channels hold heights", "1 \"Trace\" (m, 9 x 6)",
                           "2 \"Phase\" (deg, 9 x 6)", "3 \"Retrace\" (m, 9 x 6)", "::Trace"})
    EXPECT_NE(why.find(part), std::string::npos) << part << ": " << why;
  expect_same(read_map(path + "::Retrace").map, back, 1e-20);
  expect_same(read_map(path + "::1").map, h, 1e-20);
  EXPECT_NE(refusal_of([&] { read_map(path + "::Phase"); }).find("in deg"), std::string::npos);
  EXPECT_NE(refusal_of([&] { read_map(path + "::Foo"); }).find("no channel \"Foo\""),
            std::string::npos);
  // The only one that holds heights needs no name.
  const std::string only =
      written("only.gwy", gwy_bytes({{"Phase", "deg", &h}, {"Height", "m", &back}}));
  EXPECT_EQ(read_map(only).channel, "Height");
}

// A file that holds one map has no channel of any name.
TEST(Channels, OfFilesWithoutChannelsAreRefused) {
  const Heightmap h = slope_and_bumps();
  const std::string gsf = temporary("one.gsf"), npy = temporary("one.npy");
  write_gsf(gsf, h, {});
  write_npy(npy, h);
  for (const std::string& name : {gsf + "::nonsense", npy + "::3"}) {
    const std::string why = refusal_of([&] { read_map(name, h.grid.lx); });
    EXPECT_NE(why.find("files of its kind hold one map, and no channel"), std::string::npos)
        << name << ": " << why;
  }
}

// Half the last digit of a number of 32 bits, of the largest height: steps of SUR and heights of
// BCRF are such numbers.
constexpr double kSingle = 2.2e-6 / (1 << 24);

TEST(Sur, IsReadPackedOrNotInBothWidths) {
  const Heightmap h = slope_and_bumps();
  for (const bool packed : {false, true}) {
    expect_same(read_heightmap(written("a.sur", sur_bytes(h, {32, packed}))), h, kSingle);
    Heightmap coarse = h;
    for (double& z : coarse.z) z = 1e-8 * std::round(1e8 * z);
    expect_same(read_heightmap(written("b.sur", sur_bytes(h, {16, packed}))), coarse, kSingle);
  }
}

TEST(Sur, PointsThatWereNotMeasuredAreNoNumbers) {
  Heightmap h = slope_and_bumps();
  h(3, 2) = std::nan("");
  const std::string path = written("gap.sur", sur_bytes(h, {32, true, true}));
  EXPECT_NE(refusal_of([&] { read_heightmap(path); }).find("1 of 54 heights"), std::string::npos);
  const Heightmap kept = read_heightmap(path, 0, NotNumbers::Kept);
  EXPECT_TRUE(std::isnan(kept(3, 2)));
  EXPECT_FALSE(std::isnan(kept(4, 2)));
}

TEST(Sur, OfSeveralObjectsOneIsNamed) {
  const Heightmap h = slope_and_bumps();
  SurKind first, second;
  first.objects = 2, first.name = "Relief", second.name = "Light", second.z_unit = "V";
  const std::string path = written("two.sur", sur_bytes(h, first) + sur_bytes(h, second));
  EXPECT_EQ(read_map(path).channel, "Relief");
  second.z_unit = "nm";
  written("two.sur", sur_bytes(h, first) + sur_bytes(h, second));
  EXPECT_NE(refusal_of([&] { read_heightmap(path); }).find("2 \"Light\""), std::string::npos);
}

TEST(Sdf, IsReadAsTextAndBinary) {
  const Heightmap h = slope_and_bumps();
  expect_same(read_heightmap(written("t.sdf", sdf_text(h))), h, 1e-20);
  expect_same(read_heightmap(written("b.sdf", sdf_binary(h))), h, 1e-20);
  Heightmap gap = h;
  gap(0, 0) = std::nan("");
  EXPECT_TRUE(
      std::isnan(read_heightmap(written("g.sdf", sdf_text(gap)), 0, NotNumbers::Kept)(0, 0)));
}

// As other programs write it: no increment of an absolute axis, floats or whole numbers, bits of
// what is valid.
TEST(X3p, OfFloatsAndWholeNumbersWithPointsThatAreNotValid) {
  const Heightmap h = slope_and_bumps();
  const std::string plain = temporary("plain.x3p"), other = temporary("other.x3p");
  write_x3p(plain, h);
  for (const char type : {'F', 'I', 'L'}) {
    auto [xml, heights] = x3p_parts(plain, h.z.size());
    const std::string sum = md5_of(heights);
    heights.clear();
    for (const double z : rows_from_the_top(h)) {
      const auto nanometres = static_cast<std::int32_t>(std::lround(1e9 * z));
      heights += type == 'F'   ? raw_bytes(static_cast<float>(z))
                 : type == 'I' ? raw_bytes(static_cast<std::int16_t>(nanometres))
                               : raw_bytes(nanometres);
    }
    const auto exchange = [&, &text = xml](const std::string& from, const std::string& to) {
      ASSERT_NE(text.find(from), std::string::npos) << from;
      text.replace(text.find(from), from.size(), to);
    };
    exchange("<CZ><AxisType>A</AxisType><DataType>D</DataType><Increment>1</Increment>",
             std::string("<CZ><AxisType>A</AxisType><DataType>") + type + "</DataType>" +
                 (type == 'F' ? "" : "<Increment> 1e-9</Increment>"));
    exchange(sum, md5_of(heights));
    exchange("</DataLink>", "<ValidPointsLink>bindata/valid.bin</ValidPointsLink></DataLink>");
    std::string valid((h.z.size() + 7) / 8, '\xff');
    valid[1] = static_cast<char>(0xff & ~2);  // the tenth: second row from the top, first column
    write_zip(other, {{"main.xml", xml},
                      {"bindata/data.bin", heights},
                      {"bindata/valid.bin", valid},
                      {"md5checksum.hex", md5_of(xml) + " *main.xml\n"}});
    const Heightmap read = read_heightmap(other, 0, NotNumbers::Kept);
    for (int iy = 0; iy < 6; ++iy) {
      for (int ix = 0; ix < 9; ++ix) {
        if (ix == 0 && iy == 4) {
          EXPECT_TRUE(std::isnan(read(ix, iy))) << type;
        } else {
          EXPECT_NEAR(read(ix, iy), h(ix, iy), 1e-7 * std::abs(h(ix, iy)) + 1e-18) << type;
        }
      }
    }
  }
}

// A format that no reader of ours knows, by the converter: heights of 32 bits, in micrometres.
TEST(Instruments, OthersAreReadByGwyddionInAChild) {
  if (std::system("command -v gwyddion > /dev/null") != 0) GTEST_SKIP() << "needs gwyddion";
  const Heightmap h = slope_and_bumps();
  std::string bytes =
      "fileformat = bcrf\nheadersize = 2048\nxpixels = 9\nypixels = 6\nxlength = 18000\n"
      "ylength = 9000\nxunit = nm\nyunit = nm\nzunit = um\nintelmode = 1\nbit2nm = 1\n"
      "xoffset = 0\nyoffset = 0\nvoidpixels = 3.402823E+38\n";
  bytes.resize(2048, '\0');
  for (const double z : rows_from_the_top(h)) bytes += raw_bytes(static_cast<float>(1e6 * z));
  // A locale of commas must not reach its numbers.
  ::setenv("LC_ALL", "de_DE.UTF-8", 1);
  const Heightmap read = read_heightmap(written("scan.bcrf", bytes));
  ::unsetenv("LC_ALL");
  expect_same(read, h, kSingle);
}

TEST(Instruments, WhatNobodyReadsIsRefusedWithTheWayOut) {
  const std::string why =
      refusal_of([&] { read_heightmap(written("nothing.scan", std::string(3000, 'x'))); });
  EXPECT_NE(why.find(".x3p"), std::string::npos) << why;
  EXPECT_NE(refusal_of([&] { read_heightmap(temporary("missing.scan")); }), "");
}

// Of a damaged file an error, or heights that it can have: the right number of them.
TEST(Instruments, FiveHundredDamagedFilesAreRefusedOrRead) {
  const Heightmap h = slope_and_bumps();
  const std::vector<std::pair<std::string, std::string>> sound{
      {"gwy", gwy_bytes({{"Height", "m", &h}})},
      {"sur", sur_bytes(h, {32, false})},
      {"sur", sur_bytes(h, {32, true})},
      {"sdf", sdf_text(h)},
      {"sdf", sdf_binary(h)}};
  int refused = 0, read = 0;
  for (std::uint64_t k = 0; k < 500; ++k) {
    RandomStream random(3, "damage", k);
    auto [ending, bytes] = sound[k % sound.size()];
    const auto at = static_cast<std::size_t>(random.below(static_cast<int>(bytes.size())));
    switch (random.below(4)) {
      case 0:
        bytes.resize(at);
        break;
      case 1:
        bytes[at] = static_cast<char>(random.below(256));
        break;
      case 2:
        bytes.erase(at, static_cast<std::size_t>(1 + random.below(8)));
        break;
      default:
        bytes.insert(at, bytes.substr(0, static_cast<std::size_t>(1 + random.below(40))));
    }
    const std::string path = written("damaged." + ending, bytes);
    try {
      const Heightmap m = read_heightmap(path, 0, NotNumbers::Kept);
      ASSERT_EQ(m.z.size(), m.grid.size()) << k;
      ++read;
    } catch (const InputError& error) {
      ASSERT_NE(std::string(error.what()), "") << k;
      ++refused;
    }
  }
  EXPECT_EQ(refused + read, 500);
  EXPECT_GT(refused, 200);
}

TEST(Instruments, HeadersThatPromiseMoreThanTheFileHoldsTakeNoMemory) {
  const Heightmap h = slope_and_bumps();
  std::string sur = sur_bytes(h, {32, true});
  const std::string many = raw_bytes(std::int32_t{16000});
  sur.replace(108, 4, many);
  sur.replace(112, 4, many);
  EXPECT_NE(refusal_of([&] { read_heightmap(written("bomb.sur", sur)); }), "");
  std::string gwy = gwy_bytes({{"Height", "m", &h}});
  const std::size_t at = gwy.find(std::string("data\0D", 6)) + 6;
  gwy.replace(at, 4, raw_bytes(std::uint32_t{0xffffffff}));
  EXPECT_NE(refusal_of([&] { read_heightmap(written("bomb.gwy", gwy)); }).find("cut off"),
            std::string::npos);
  std::string sdf = sdf_binary(h);
  sdf.replace(42, 4, raw_bytes(std::uint16_t{60000}) + raw_bytes(std::uint16_t{4000}));
  EXPECT_NE(refusal_of([&] { read_heightmap(written("bomb.sdf", sdf)); }).find("cut off"),
            std::string::npos);
}

TEST(Instruments, MadeMapsKeepTheirPlaneAndSaySo) {
  Heightmap tilted = slope_and_bumps();
  const std::string npy = temporary("tilted.npy"), gsf = temporary("tilted.gsf");
  write_npy(npy, tilted);
  FileInfo design;
  design.comment = "hole_array";
  write_gsf(gsf, tilted, design);
  for (const ScanSource& source : {ScanSource{npy, 18e-6}, ScanSource{gsf, 0}}) {
    const Scan kept = read_scan(source);
    EXPECT_TRUE(kept.changes.made);
    EXPECT_EQ(kept.changes.slope_x, 0);
    EXPECT_NE(text(source.file, kept.changes).find("a made map"), std::string::npos);
    ScanSource level = source;
    level.level = true;
    const Scan levelled = read_scan(level);
    EXPECT_GT(std::abs(levelled.changes.slope_x), 1e-3);
    EXPECT_NE(text(source.file, levelled.changes).find("a plane of"), std::string::npos);
  }
  // An instrument's file of the same heights is levelled without a word.
  const Scan scan = read_scan({written("scan.gwy", gwy_bytes({{"Height", "m", &tilted}}))});
  EXPECT_GT(std::abs(scan.changes.slope_x), 1e-3);
}

}  // namespace
}  // namespace papilla::tests::instruments_test
