// Sides of maps that were written or come from elsewhere, on oblong grids so that x is no y.
#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "geometry/io/files.h"
#include "geometry/io/layout.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::sizes_test {
namespace {

Heightmap oblong() {
  const Grid grid{24, 10, 6e-6, 4e-6};
  Heightmap h{grid, std::vector<double>(grid.size())};
  for (int iy = 0; iy < grid.ny; ++iy)
    for (int ix = 0; ix < grid.nx; ++ix) h(ix, iy) = 1e-9 * (ix + 100 * iy);
  return h;
}

TEST(Sizes, ARepeatedMapHasAllItsTilesAndTheirSides) {
  const Heightmap h = oblong();
  const std::string path = temporary("tiles.exr");
  write_exr_repeated(path, h, 3, {});
  const Heightmap back = read_heightmap(path);
  EXPECT_EQ(back.grid.nx, 72);
  EXPECT_EQ(back.grid.ny, 30);
  EXPECT_NEAR(back.grid.lx, 18e-6, 1e-15);
  EXPECT_NEAR(back.grid.ly, 12e-6, 1e-15);
  for (int iy = 0; iy < back.grid.ny; ++iy) {
    for (int ix = 0; ix < back.grid.nx; ++ix)
      ASSERT_NEAR(back(ix, iy), h(ix % 24, iy % 10), 1e-12) << ix << " " << iy;
  }
}

// As other programs may write it, in micrometres and nanometres, with these sides [um].
void write_in_other_units(const std::string& path, const Heightmap& h, double x, double y) {
  OIIO::ImageSpec spec(h.grid.nx, h.grid.ny, 1, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"Y"};
  spec.attribute("Gwy::XReal", OIIO::TypeDesc::DOUBLE, &x);
  spec.attribute("Gwy::YReal", OIIO::TypeDesc::DOUBLE, &y);
  spec.attribute("Gwy::XYUnit", "um");
  spec.attribute("Gwy::ZUnit", "nm");
  std::vector<float> pixels(h.grid.size());
  for (int iy = 0; iy < h.grid.ny; ++iy) {
    for (int ix = 0; ix < h.grid.nx; ++ix)
      pixels[h.grid.index(ix, h.grid.ny - 1 - iy)] = static_cast<float>(1e9 * h(ix, iy));
  }
  const auto out = OIIO::ImageOutput::create(path);
  ASSERT_TRUE(out && out->open(path, spec));
  ASSERT_TRUE(out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
  out->close();
}

// It is no reason to take the pixels for squares. The reader of an EXR takes any number.
TEST(Sizes, AStatedSideBelowZeroIsRefusedWithAndWithoutAWidth) {
  const std::string path = temporary("below.exr");
  write_in_other_units(path, oblong(), 6, -4);
  for (const double width : {0.0, 6e-6}) {
    EXPECT_EQ(refusal_of([&] { read_heightmap(path, width); }),
              "cannot read " + path +
                  ": the file says that it is 6 um wide and -4 um high, and sides are not below 0; "
                  "correct them in the file, or save it without");
  }
}

// Sides in micrometres and heights in nanometres, as other programs may write them; rows from the
// top.
TEST(Sizes, AnImageInOtherUnitsIsReadInMetres) {
  const Heightmap h = oblong();
  const std::string path = temporary("units.exr");
  write_in_other_units(path, h, 6, 4);
  const Heightmap back = read_heightmap(path);
  EXPECT_NEAR(back.grid.lx, 6e-6, 1e-15);
  EXPECT_NEAR(back.grid.ly, 4e-6, 1e-15);
  for (std::size_t i = 0; i < h.z.size(); ++i) ASSERT_NEAR(back.z[i], h.z[i], 1e-12);
}

}  // namespace
}  // namespace papilla::tests::sizes_test
