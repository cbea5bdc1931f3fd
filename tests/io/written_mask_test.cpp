// What stands in the files that masks are made from: metres by the file's own unit, and grey where
// the holes are.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "base/constants.h"
#include "fabricate/export.h"
#include "geometry/io/drawing.h"
#include "geometry/io/files.h"
#include "geometry/texture.h"
#include "tests/io/gds_file.h"
#include "tests/temporary.h"

namespace papilla::tests::written_mask_test {
namespace {

HoleArray one_hole() {
  HoleArray holes;
  holes.period = 6e-6;
  holes.diameter = 4e-6;
  holes.depth = 200e-9;
  holes.wall_angle = kPi / 2;
  return holes;
}

TEST(WrittenGds, AMaskOfAMapHasTheHoleInMetres) {
  const HoleArray holes = one_hole();
  const Heightmap h = generate(Texture{holes}, patch_grid(Texture{holes}, 128, 12e-6));
  const std::string path = temporary("mask.gds");
  write_gds(path, draw_contours(h, 1));
  const GdsFile file(path);
  EXPECT_DOUBLE_EQ(file.metre, 1e-9);
  EXPECT_DOUBLE_EQ(file.user_unit, 1e-3);  // micrometres
  const double count = h.grid.area() / square(holes.period);
  EXPECT_NEAR(file.area() / count, kPi / 4 * square(holes.diameter), 0.02 * square(holes.diameter));
  for (const GdsPolygon& p : file.polygons) {
    EXPECT_GE(*std::min_element(p.x.begin(), p.x.end()), 0);
    EXPECT_LE(*std::max_element(p.y.begin(), p.y.end()), h.grid.ly + 1e-9);
  }
}

TEST(WrittenGds, LevelsAreLayersOfWhatIsDeeper) {
  // A ramp from 0 to -1 um over x: level k of n is deeper than (k - 1/2) / n of it.
  const Grid grid{200, 4, 10e-6, 2e-6};
  Heightmap ramp{grid, std::vector<double>(grid.size())};
  for (int y = 0; y < grid.ny; ++y)
    for (int x = 0; x < grid.nx; ++x) ramp(x, y) = -1e-6 * x / (grid.nx - 1);
  const std::string path = temporary("ramp.gds");
  write_gds(path, draw_contours(ramp, 2));
  std::map<int, double> area;
  for (const GdsPolygon& p : GdsFile(path).polygons) area[p.layer] += p.area() / grid.area();
  EXPECT_NEAR(area[1], 0.75, 0.01);
  EXPECT_NEAR(area[2], 0.25, 0.01);
  write_gds(path, draw_contours(ramp, 1));
  EXPECT_NEAR(GdsFile(path).area(), 0.5 * grid.area(), 0.01 * grid.area());
}

// Seen from above the layout and the map are one: pixels inside a polygon are deep, or high where
// pillars are drawn.
TEST(WrittenGds, ALayoutLiesOnTheMapOfItsTexture) {
  HoleArray hexagons = one_hole();
  hexagons.lattice = Lattice::Hexagonal;
  PillarArray pillars;
  pillars.period = 6e-6, pillars.diameter = 2.5e-6, pillars.height = 200e-9;
  pillars.wall_angle = kPi / 2;
  Grating grooves;
  grooves.period = 6e-6, grooves.width = 2e-6, grooves.depth = 200e-9;
  grooves.wall_angle = kPi / 2;
  for (const Texture& texture :
       {Texture{one_hole()}, Texture{hexagons}, Texture{pillars}, Texture{grooves}}) {
    Design design;
    design.texture = texture;
    ExportOptions options;
    options.formats = {"gds"};
    options.size = 18e-6;
    options.pixels = 96;
    const Heightmap h = export_design(design, options, temporary("layout")).heightmap;
    const GdsFile file(temporary("layout") + "/texture.gds");
    const bool drawn_high = std::holds_alternative<PillarArray>(texture.kind);
    int other = 0, inside = 0;
    for (int iy = 0; iy < h.grid.ny; ++iy) {
      for (int ix = 0; ix < h.grid.nx; ++ix) {
        bool in = false;
        for (const GdsPolygon& p : file.polygons) in = in || p.holds(h.grid.x(ix), h.grid.y(iy));
        const bool low = h(ix, iy) < (drawn_high ? 100e-9 : -100e-9);
        inside += in;
        other += in != (low != drawn_high);
      }
    }
    EXPECT_GT(inside, 0) << texture_name(texture);
    // Pixels that the outline cuts.
    EXPECT_LT(other, 0.02 * static_cast<double>(h.grid.size())) << texture_name(texture);
    const double share = drawn_high                                      ? kPi / 4 * square(2.5 / 6)
                         : std::holds_alternative<Grating>(texture.kind) ? 2.0 / 6
                         : h.grid.nx == h.grid.ny                        ? kPi / 4 * square(4.0 / 6)
                                                  : kPi / 4 * square(4.0 / 6) * 2 / std::sqrt(3.0);
    EXPECT_NEAR(file.area() / h.grid.area(), share, 0.01 * share) << texture_name(texture);
  }
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
  // Of a design that is deeper than its pixels.
  write_mask_tiff(path, h, Polarity::WhiteDeep, {}, Planes{-210e-9, 0});
  for (const auto& [x, white] : {std::pair{1.5e-6, 0.0}, {2.5e-6, 0.0}, {3.5e-6, 1.0}})
    EXPECT_NEAR(grey(path, grid, x, 0.5e-6), white, 1e-6) << x;
}

}  // namespace
}  // namespace papilla::tests::written_mask_test
