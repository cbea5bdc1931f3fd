// What stands in the files that masks are made from: metres by the file's own unit, and grey where
// the holes are.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/constants.h"
#include "base/files.h"
#include "geometry/io/files.h"
#include "geometry/io/layout.h"
#include "geometry/texture.h"

namespace papilla {
namespace {

std::string temporary(const std::string& name) {
  return testing::TempDir() + "papilla_written_" + name;
}

HoleArray one_hole() {
  HoleArray holes;
  holes.period = 6e-6;
  holes.diameter = 4e-6;
  holes.depth = 200e-9;
  holes.wall_angle = kPi / 2;
  return holes;
}

// GDSII as its definition has it: records of length, type and big-endian data.
struct GdsFile {
  double user_unit = 0, metre = 0;  // of a database unit
  double area = 0;                  // [m^2], of all polygons
  double least = 0, most = 0;       // [m], of all coordinates

  explicit GdsFile(const std::string& path) {
    const std::string bytes = read_bytes(path);
    for (std::size_t at = 0; at + 4 <= bytes.size();) {
      const std::size_t length = number(bytes, at, 2);
      const std::size_t type = number(bytes, at + 2, 2);
      if (type == 0x0305) {
        user_unit = real(bytes, at + 4);
        metre = real(bytes, at + 12);
      }
      if (type == 0x1003) polygon(bytes, at + 4, (length - 4) / 8);
      if (length < 4) break;
      at += length;
    }
  }

 private:
  static std::uint64_t number(const std::string& bytes, std::size_t at, std::size_t size) {
    std::uint64_t out = 0;
    for (std::size_t i = 0; i < size; ++i)
      out = out << 8 | static_cast<unsigned char>(bytes.at(at + i));
    return out;
  }
  // Excess-64 exponent of 16 and a mantissa of 56 bits.
  static double real(const std::string& bytes, std::size_t at) {
    const std::uint64_t word = number(bytes, at, 8);
    return std::ldexp(static_cast<double>(word & 0x00ffffffffffffff),
                      4 * (static_cast<int>(word >> 56 & 0x7f) - 64) - 56);
  }
  void polygon(const std::string& bytes, std::size_t at, std::size_t points) {
    std::vector<double> x, y;
    for (std::size_t i = 0; i < points; ++i) {
      for (auto* to : {&x, &y}) {
        const auto value = static_cast<std::int32_t>(number(bytes, at, 4));
        to->push_back(metre * value);
        least = std::min(least, to->back());
        most = std::max(most, to->back());
        at += 4;
      }
    }
    double sum = 0;
    for (std::size_t i = 0; i + 1 < points; ++i) sum += x[i] * y[i + 1] - x[i + 1] * y[i];
    area += 0.5 * std::abs(sum);
  }
};

TEST(WrittenGds, AMaskOfAMapHasTheHoleInMetres) {
  const HoleArray holes = one_hole();
  const Heightmap h = generate(Texture{holes}, patch_grid(Texture{holes}, 128, 12e-6));
  const std::string path = temporary("mask.gds");
  ASSERT_GT(write_gds_mask(path, h, 1), 0u);
  const GdsFile file(path);
  EXPECT_DOUBLE_EQ(file.metre, 1e-9);
  EXPECT_DOUBLE_EQ(file.user_unit, 1e-3);  // micrometres
  const double count = h.grid.area() / square(holes.period);
  EXPECT_NEAR(file.area / count, kPi / 4 * square(holes.diameter), 0.02 * square(holes.diameter));
  EXPECT_GE(file.least, 0);
  EXPECT_LE(file.most, h.grid.lx + 1e-9);
  EXPECT_GT(file.most, 0.5 * h.grid.lx);
}

TEST(WrittenGds, LevelsAreLayersOfWhatIsDeeper) {
  // A ramp from 0 to -1 um over x: level k of n is deeper than (k - 1/2) / n of it.
  const Grid grid{200, 4, 10e-6, 2e-6};
  Heightmap ramp{grid, std::vector<double>(grid.size())};
  for (int y = 0; y < grid.ny; ++y)
    for (int x = 0; x < grid.nx; ++x) ramp(x, y) = -1e-6 * x / (grid.nx - 1);
  const std::string path = temporary("ramp.gds");
  write_gds_mask(path, ramp, 2);
  // Three quarters of the area on layer 1, one quarter on layer 2.
  EXPECT_NEAR(GdsFile(path).area, 1.0 * grid.area(), 0.01 * grid.area());
  write_gds_mask(path, ramp, 1);
  EXPECT_NEAR(GdsFile(path).area, 0.5 * grid.area(), 0.01 * grid.area());
}

// Grey of 16 bits at a place, as a program sees it that knows nothing of our descriptions.
double grey(const std::string& path, const Grid& grid, double x, double y) {
  const auto image = OIIO::ImageInput::open(path);
  EXPECT_TRUE(image) << path;
  if (!image) return -1;
  std::vector<float> pixels(grid.size());
  EXPECT_TRUE(image->read_image(0, 0, 0, 1, OIIO::TypeDesc::FLOAT, pixels.data()));
  const int column = static_cast<int>(x / grid.dx()), row = static_cast<int>(y / grid.dy());
  return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid.nx) +
                static_cast<std::size_t>(column)];
}

TEST(WrittenMask, AHoleIsBlackWhereWhiteIsHighAndWhiteWhereWhiteIsDeep) {
  const HoleArray holes = one_hole();
  const Heightmap h = generate(Texture{holes}, patch_grid(Texture{holes}, 64, 12e-6));
  const auto deep =
      static_cast<std::size_t>(std::min_element(h.z.begin(), h.z.end()) - h.z.begin());
  const auto land =
      static_cast<std::size_t>(std::max_element(h.z.begin(), h.z.end()) - h.z.begin());
  const auto nx = static_cast<std::size_t>(h.grid.nx);
  // Holes mirror about the middle of the map: rows may run up or down.
  const auto grey_at = [&](const std::string& path, std::size_t pixel) {
    return grey(path, h.grid, h.grid.x(static_cast<int>(pixel % nx)),
                h.grid.y(static_cast<int>(pixel / nx)));
  };
  for (const auto& [polarity, hole, top] :
       {std::tuple{Polarity::WhiteHigh, 0.0, 1.0}, {Polarity::WhiteDeep, 1.0, 0.0}}) {
    for (const char* name : {"mask.tif", "heights.tif"}) {
      const std::string path = temporary(name);
      if (std::string(name) == "mask.tif") {
        write_mask_tiff(path, h, polarity, {});
      } else {
        write_tiff16(path, h, polarity, {});
      }
      EXPECT_NEAR(grey_at(path, deep), hole, 1e-4) << name;
      EXPECT_NEAR(grey_at(path, land), top, 1e-4) << name;
    }
  }
}

TEST(WrittenMask, DeeperIsWhiteFromHalfTheDepthOn) {
  const Grid grid{4, 1, 4e-6, 1e-6};
  const Heightmap h{grid, {0, -99e-9, -101e-9, -200e-9}};
  const std::string path = temporary("half.tif");
  write_mask_tiff(path, h, Polarity::WhiteDeep, {});
  for (const auto& [x, white] :
       {std::pair{0.5e-6, 0.0}, {1.5e-6, 0.0}, {2.5e-6, 1.0}, {3.5e-6, 1.0}})
    EXPECT_NEAR(grey(path, grid, x, 0.5e-6), white, 1e-6) << x;
}

}  // namespace
}  // namespace papilla
