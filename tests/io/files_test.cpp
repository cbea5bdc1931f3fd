#include "geometry/io/files.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "base/error.h"
#include "geometry/io/height_rows.h"
#include "geometry/io/layout.h"
#include "geometry/texture.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::files_test {
namespace {

class Files : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return folder_.path() / name; }

  const TemporaryFolder folder_;
};

Heightmap holes() {
  const Texture t{HoleArray{}};
  return generate(t, patch_grid(t, 96));
}

void expect_equal(const Heightmap& a, const Heightmap& b, double tolerance, double offset = 0) {
  EXPECT_EQ(a.grid.nx, b.grid.nx);
  EXPECT_NEAR(a.grid.lx, b.grid.lx, 1e-12 * a.grid.lx);
  EXPECT_NEAR(a.grid.ly, b.grid.ly, 1e-12 * a.grid.ly);
  for (std::size_t i = 0; i < a.z.size(); ++i) ASSERT_NEAR(a.z[i] + offset, b.z[i], tolerance);
}

TEST_F(Files, NpyKeepsEveryBit) {
  const Heightmap h = holes();
  write_npy(path("h.npy"), h);
  const Heightmap back = read_heightmap(path("h.npy"), h.grid.lx);
  for (std::size_t i = 0; i < h.z.size(); ++i) EXPECT_EQ(h.z[i], back.z[i]);
  EXPECT_THROW(read_heightmap(path("h.npy")), InputError);  // no size in the file
}

TEST_F(Files, ABrokenHeightIsNamedByItsPixelAndASizeByItsKey) {
  const auto message = [](const std::string& file, double width) -> std::string {
    return refusal_of([&] { read_heightmap(file, width); });
  };
  Heightmap h = holes();
  write_npy(path("h.npy"), h);
  EXPECT_NE(message(path("h.npy"), 0).find("texture.width"), std::string::npos);
  const auto nx = static_cast<std::size_t>(h.grid.nx);
  h.z[3 * nx + 5] = h.z[7 * nx + 2] = std::numeric_limits<double>::quiet_NaN();
  write_npy(path("n.npy"), h);
  const std::string broken = message(path("n.npy"), 12e-6);
  EXPECT_NE(broken.find("2 of "), std::string::npos) << broken;
  EXPECT_NE(broken.find("column 5 of row 3"), std::string::npos) << broken;
}

TEST_F(Files, GsfExrAndTiffKeepSizeAndHeights) {
  const Heightmap h = holes();
  const double depth = 350e-9;
  write_gsf(path("h.gsf"), h, {});
  expect_equal(h, read_heightmap(path("h.gsf")), 1e-7 * depth);
  write_exr(path("h.exr"), h, {});
  expect_equal(h, read_heightmap(path("h.exr")), 1e-6 * depth, depth);  // lowest plane is 0
  write_tiff_float(path("f.tif"), h, {});
  expect_equal(h, read_heightmap(path("f.tif")), 1e-6 * depth, depth);
  for (Polarity polarity : {Polarity::WhiteHigh, Polarity::WhiteDeep}) {
    write_tiff16(path("h.tif"), h, polarity, {});
    expect_equal(h, read_heightmap(path("h.tif")), depth / 65535);
  }
}

// Sides, pixels and heights that differ along x and y: nothing is turned, mirrored or swapped.
TEST_F(Files, AnObliqueMapOnOblongPixelsComesBackInEveryFormat) {
  Heightmap h{{48, 30, 9e-6, 5e-6}, std::vector<double>(48 * 30)};
  for (int iy = 0; iy < 30; ++iy) {
    for (int ix = 0; ix < 48; ++ix) h(ix, iy) = 1e-9 * (3 * ix + 11 * iy + (ix == 7 ? 40 : 0));
  }
  const double span = 1e-9 * (3 * 47 + 11 * 29);
  write_npy(path("h.npy"), h);
  write_gsf(path("h.gsf"), h, {});
  write_exr(path("h.exr"), h, {});
  write_tiff_float(path("f.tif"), h, {});
  write_tiff16(path("high.tif"), h, Polarity::WhiteHigh, {});
  write_tiff16(path("deep.tif"), h, Polarity::WhiteDeep, {});
  write_png16(path("h.png"), h);
  write_x3p(path("h.x3p"), h);
  for (const char* name :
       {"h.npy", "h.gsf", "h.exr", "f.tif", "high.tif", "deep.tif", "h.png", "h.x3p"}) {
    const bool sized = std::string(name) != "h.npy";
    const auto rows = open_height_rows(path(name));
    EXPECT_EQ(rows->header().lx > 0, sized);
    const bool grey = std::string(name).ends_with("h.tif") || std::string(name) == "deep.tif" ||
                      std::string(name) == "h.png";
    EXPECT_NEAR(rows->header().step, grey ? span / 65535 : 0, 1e-6 * span / 65535) << name;
    const Heightmap back = whole_map(*rows, h.grid.lx);
    ASSERT_EQ(back.grid.nx, 48) << name;
    ASSERT_EQ(back.grid.ny, 30) << name;
    EXPECT_NEAR(back.grid.lx, 9e-6, 1e-11) << name;
    // NPY holds no size: its pixels are taken for square.
    EXPECT_NEAR(back.grid.ly, sized ? 5e-6 : 30 * 9e-6 / 48, 1e-11) << name;
    for (int iy = 0; iy < 30; ++iy) {
      for (int ix = 0; ix < 48; ++ix) {
        ASSERT_NEAR(back(ix, iy) - back(0, 0), h(ix, iy) - h(0, 0), span / 65535)
            << name << " " << ix << " " << iy;
      }
    }
  }
}

// What is told while many tiles are written: once a row of them, the share that is done.
TEST_F(Files, ProgressIsTheShareOfTheRowsOfTiles) {
  std::vector<double> told;
  write_exr_repeated(path("tiles.exr"), holes(), 4, {},
                     [&](double share) { told.push_back(share); });
  EXPECT_EQ(told, (std::vector<double>{0, 0.25, 0.5, 0.75}));
}

TEST_F(Files, TheSameHeightmapGivesTheSameBytes) {
  const Heightmap h = holes();
  for (const char* name : {"a.exr", "a.tif", "a.gsf", "a.png"}) {
    const auto write = [&] {
      const std::string p = path(name);
      if (p.ends_with("exr")) write_exr(p, h, {});
      if (p.ends_with("tif")) write_tiff16(p, h, Polarity::WhiteHigh, {});
      if (p.ends_with("gsf")) write_gsf(p, h, {});
      if (p.ends_with("png")) write_png(p, h);
      return read_bytes(p);
    };
    EXPECT_EQ(write(), write()) << name;
  }
}

TEST_F(Files, AnExrHasTheSameBytesForAnyNumberOfThreads) {
  HoleArray array;
  array.wall_angle = 1.2;
  const Texture t{array};
  const Heightmap h = generate(t, patch_grid(t, 420));
  for (const int threads : {1, 5}) {
    OIIO::attribute("threads", threads);
    OIIO::attribute("exr_threads", threads);
    write_exr_repeated(path(std::to_string(threads) + ".exr"), h, 10, {});  // read back in part
  }
  OIIO::attribute("threads", 0);
  OIIO::attribute("exr_threads", 0);
  EXPECT_TRUE(read_bytes(path("1.exr")) == read_bytes(path("5.exr")));
  // Every copy is the tile, and the lowest plane is zero without the rounding of its heights.
  const Heightmap all = read_heightmap(path("5.exr"));
  ASSERT_EQ(all.grid.nx, 4200);
  const double low = *std::min_element(h.z.begin(), h.z.end());
  int floor = 0;
  for (int iy = 0; iy < 420; ++iy) {
    for (int ix = 0; ix < 420; ++ix) {
      const double expected = h(ix, iy) - low;
      ASSERT_NEAR(all(ix + 420 * (iy % 10), iy + 420 * (ix % 10)), expected, 1e-13);
      if (expected < 1e-15) {
        ASSERT_EQ(all(ix, iy), 0);
        ++floor;
      }
    }
  }
  EXPECT_GT(floor, 10000);
}

TEST_F(Files, MaskPolarityIsWhatWasAskedFor) {
  const Heightmap h = holes();
  write_mask_tiff(path("m.tif"), h, Polarity::WhiteDeep, {});
  const std::string bytes = read_bytes(path("m.tif"));
  EXPECT_NE(bytes.find("white-is-deep"), std::string::npos);
}

TEST_F(Files, AFailedWriteLeavesTheOldFile) {
  write_bytes(path("x.txt"), "old");
  EXPECT_THROW(write_bytes(path("missing/x.txt"), "new"), InputError);
  // What a rename would destroy is refused, a link is replaced.
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_THROW(write_bytes(path("pipe"), "new"), InputError);
  EXPECT_THROW(write_exr(path("pipe"), holes(), {}), InputError);
  EXPECT_TRUE(std::filesystem::is_fifo(path("pipe")));
  EXPECT_THROW(write_bytes(folder_.path().string(), "new"), InputError);
  std::filesystem::create_symlink(path("x.txt"), path("link.txt"));
  write_bytes(path("link.txt"), "beside");
  EXPECT_FALSE(std::filesystem::is_symlink(path("link.txt")));
  EXPECT_EQ(read_bytes(path("x.txt")), "old");
  std::filesystem::create_symlink(path("x.txt"), path("link.exr"));
  write_exr(path("link.exr"), holes(), {});
  EXPECT_FALSE(std::filesystem::is_symlink(path("link.exr")));
  EXPECT_EQ(read_bytes(path("x.txt")), "old");
  Heightmap broken = holes();
  write_exr(path("x.exr"), holes(), {});
  const std::string before = read_bytes(path("x.exr"));
  broken.z[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_exr(path("x.exr"), broken, {}), InputError);
  EXPECT_EQ(read_bytes(path("x.exr")), before);
  EXPECT_THROW(write_exr(path("missing/x.exr"), holes(), {}), InputError);
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
}

TEST_F(Files, HostileFilesAreRefused) {
  const auto file = [&](const std::string& name, const std::string& bytes) {
    std::ofstream(path(name), std::ios::binary) << bytes;
    return path(name);
  };
  EXPECT_THROW(
      read_heightmap(file(
          "a.gsf",
          "Gwyddion Simple Field 1.0\nXRes = 1000000\nYRes = 1000000\nXReal = 1\nYReal = 1\n\0\0")),
      InputError);
  EXPECT_THROW(read_heightmap(file("b.gsf", "Gwyddion Simple Field 1.0\nXRes = nan\nYRes = 4\n")),
               InputError);
  EXPECT_THROW(read_heightmap(file("c.npy", "\x93NUMPY\x01")), InputError);
  EXPECT_THROW(
      read_heightmap(
          file("d.npy", std::string("\x93NUMPY\x01\x00\x40\x00", 10) +
                            "{'descr': '<f8', 'fortran_order': False, 'shape': (-3, 99999999), }"),
          1),
      InputError);
  EXPECT_THROW(read_heightmap(file("e.exr", "not an image")), InputError);
  EXPECT_THROW(read_heightmap(file("f.tif", "II*\0garbage")), InputError);
  EXPECT_THROW(read_heightmap(path("absent.gsf")), InputError);
  EXPECT_THROW(read_heightmap(file("g.xyz", "1 2 3")), InputError);
}

}  // namespace
}  // namespace papilla::tests::files_test
