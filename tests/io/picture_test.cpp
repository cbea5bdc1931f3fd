// Pictures of a field: what is low is dark, what lies far back is above, and the bar is as long as
// it says by its place in 1, 2, 5.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "geometry/io/files.h"

namespace papilla::tests::picture_test {
namespace {

using Colour = std::array<int, 3>;

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;

  Picture(const Grid& grid, const std::vector<double>& values)
      : rgb(render_field(grid, values, width, height)) {}
  Colour at(int x, int y) const {
    const std::size_t k = 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(x));
    return {rgb.at(k), rgb.at(k + 1), rgb.at(k + 2)};
  }
};

TEST(Pictures, ColoursRunFromLowToHighAndYUpwards) {
  const Grid grid{5, 3, 5e-6, 3e-6};
  std::vector<double> values(grid.size());
  for (int iy = 0; iy < 3; ++iy)
    for (int ix = 0; ix < 5; ++ix) values[grid.index(ix, iy)] = iy < 2 ? 4.0 * iy : 8.0 - ix;
  const Picture p(grid, values);
  const int zoom = p.width / 5;
  ASSERT_EQ(p.width, 510);  // whole pixels, up to 512
  ASSERT_EQ(p.height, 306);
  const auto at = [&](int ix, int iy) {
    return p.at(ix * zoom + zoom / 2, (2 - iy) * zoom + zoom / 2);
  };
  EXPECT_EQ(at(4, 0), (Colour{68, 1, 84}));     // the lowest
  EXPECT_EQ(at(0, 2), (Colour{253, 231, 37}));  // the highest, in the uppermost row
  EXPECT_EQ(at(4, 2), (Colour{33, 145, 140}));  // half way
  EXPECT_EQ(at(2, 2), (Colour{94, 201, 98}));   // three quarters
  EXPECT_EQ(at(1, 2), (Colour{174, 216, 68}));  // between two anchors
  const Picture flat(grid, std::vector<double>(grid.size(), 3.0));
  EXPECT_EQ(flat.at(300, 20), (Colour{253, 231, 37}));
  const Grid large{600, 40, 1, 1};  // a pixel a pixel
  EXPECT_EQ(Picture(large, std::vector<double>(large.size())).width, 600);
}

TEST(Pictures, TheBarIsARoundLengthBelowAThirdOfTheWidth) {
  const Colour white{255, 255, 255}, black{0, 0, 0};
  for (const auto& [width_um, bar_um] :
       {std::pair{10.0, 2.0}, {20.0, 5.0}, {4.0, 1.0}, {0.4, 0.1}, {100.0, 20.0}}) {
    const Grid grid{64, 32, 1e-6 * width_um, 1e-6};
    const Picture p(grid, std::vector<double>(grid.size()));
    int rows = 0, longest = 0, left = 0, lowest = 0;
    for (int y = 0; y < p.height; ++y) {
      int count = 0, first = 0, last = 0;
      for (int x = 0; x < p.width; ++x) {
        if (p.at(x, y) != white) continue;
        if (count == 0) first = x;
        last = x;
        ++count;
      }
      if (count == 0) continue;
      ++rows;
      longest = count;
      left = first;
      lowest = y;
      EXPECT_GT(y, p.height / 2);  // below, at the left
      EXPECT_LT(first, p.width / 10);
      EXPECT_EQ(last - first + 1, count);
      EXPECT_EQ(p.at(first - 1, y), black);  // with a rim that shows it on white
      EXPECT_EQ(p.at(last + 1, y), black);
    }
    EXPECT_GE(rows, 3);
    // As far from the left as from below, with its rim all round.
    EXPECT_EQ(left, p.height - 1 - lowest);
    for (int x = left - 1; x <= left + longest; ++x) {
      EXPECT_EQ(p.at(x, lowest + 1), black);
      EXPECT_EQ(p.at(x, lowest - rows), black);
    }
    EXPECT_NEAR(longest * width_um / p.width, bar_um, 0.51 * width_um / p.width) << width_um;
  }
}

TEST(Pictures, ABarHigherThanItsPictureIsCutAtTheTop) {
  const Grid grid{600, 6, 1e-3, 1e-5};
  const Picture p(grid, std::vector<double>(grid.size()));
  ASSERT_EQ(p.height, 6);
  for (const int y : {0, 1}) EXPECT_EQ(p.at(10, y), (Colour{255, 255, 255})) << y;
  EXPECT_EQ(p.at(10, 2), (Colour{0, 0, 0}));
  EXPECT_EQ(p.at(10, 3), (Colour{253, 231, 37}));
}

}  // namespace
}  // namespace papilla::tests::picture_test
