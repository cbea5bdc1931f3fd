// A mask of a map as KLayout sees it.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

#include "base/constants.h"
#include "geometry/io/drawing.h"
#include "geometry/texture.h"
#include "tests/cli/program.h"

namespace papilla::tests::klayout_slow_test {
namespace {

TEST(KlayoutMask, HasTheAreaOfTheHolesInSquareMicrometres) {
  const Workplace place;
  if (place.shell("command -v klayout && command -v python3").status != 0)
    GTEST_SKIP() << "needs klayout (scripts/setup --test)";
  HoleArray holes;
  holes.period = 6e-6;
  holes.diameter = 4e-6;
  holes.wall_angle = kPi / 2;
  const Heightmap h = generate(Texture{holes}, patch_grid(Texture{holes}, 128, 12e-6));
  write_gds((place.path() / "texture.gds").string(), draw_contours(h, 1));
  const Outcome run = place.shell("python3 " PAPILLA_SOURCE_DIR "/tests/io/clients.py gds .");
  ASSERT_EQ(run.status, 0) << run.err;
  std::istringstream in(run.out);
  std::map<std::string, double> facts;
  for (std::string name, value; in >> name >> value;) facts[name] = std::stod(value);
  EXPECT_DOUBLE_EQ(facts["dbu"], 1e-3);
  const double count = h.grid.area() / square(holes.period);
  EXPECT_NEAR(facts["area_1"], count * kPi * 4, 0.02 * count * kPi * 4);
}

}  // namespace
}  // namespace papilla::tests::klayout_slow_test
