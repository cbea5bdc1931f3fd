// Pictures of fields with their legend, read back dot by dot as a person reads them.
#include "geometry/io/legend.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "geometry/io/files.h"

namespace papilla::tests::legend_test {
namespace {

// How letters look: each the seven lines below its own name.
constexpr const char* kLetters = R"(
0       1       2       3       4       5       6       7
.###.   ..#..   .###.   #####   ...#.   #####   ..##.   #####
#...#   .##..   #...#   ...#.   ..##.   #....   .#...   ....#
#..##   ..#..   ....#   ..#..   .#.#.   ####.   #....   ...#.
#.#.#   ..#..   ...#.   ...#.   #..#.   ....#   ####.   ..#..
##..#   ..#..   ..#..   ....#   #####   ....#   #...#   .#...
#...#   ..#..   .#...   #...#   ...#.   #...#   #...#   .#...
.###.   .###.   #####   .###.   ...#.   .###.   .###.   .#...
8       9       .       -       +       %       e       n
.###.   .###.   .....   .....   .....   ##...   .....   .....
#...#   #...#   .....   .....   ..#..   ##..#   .....   .....
#...#   #...#   .....   .....   ..#..   ...#.   .###.   #.##.
.###.   .####   .....   #####   #####   ..#..   #...#   ##..#
#...#   ....#   .....   .....   ..#..   .#...   #####   #...#
#...#   ...#.   .##..   .....   ..#..   #..##   #....   #...#
.###.   .##..   .##..   .....   .....   ...##   .###.   #...#
m       u       k       M       P       a
.....   .....   #....   #...#   ####.   .....
.....   .....   #....   ##.##   #...#   .....
##.#.   #...#   #..#.   #.#.#   #...#   .###.
#.#.#   #...#   #.#..   #.#.#   ####.   ....#
#.#.#   #...#   ##...   #...#   #....   .####
#.#.#   #..##   #.#..   #...#   #....   #...#
#.#.#   .##.#   #..#.   #...#   #....   .####
)";

// Picture of a letter, line by line -> the letter.
const std::map<std::string, char>& letters() {
  static const std::map<std::string, char> all = [] {
    std::map<std::string, char> out;
    std::istringstream in(kLetters);
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      std::istringstream names(line);
      const std::vector<std::string> known{std::istream_iterator<std::string>(names), {}};
      std::vector<std::string> pictures(known.size());
      for (int row = 0; row < 7; ++row) {
        std::getline(in, line);
        std::istringstream parts(line);
        for (std::string& picture : pictures) {
          std::string part;
          parts >> part;
          picture += part;
        }
      }
      for (std::size_t i = 0; i < known.size(); ++i) out[pictures[i]] = known[i][0];
    }
    return out;
  }();
  return all;
}

using Colour = std::array<int, 3>;

struct Shown {
  FieldPicture picture;
  int dots;  // pixels of a dot

  Shown(const Grid& grid, const std::vector<double>& values, const FieldScale& scale)
      : picture(picture_with_legend(grid, values, scale)), dots(std::max(1, picture.width / 256)) {}

  Colour at(int x, int y) const {
    const std::size_t k = 3 * (static_cast<std::size_t>(y) * picture.width + x);
    return {picture.rgb.at(k), picture.rgb.at(k + 1), picture.rgb.at(k + 2)};
  }
  // The text of letters six dots apart from (left, top) on; what is no letter ends it.
  std::string text(int left, int top, int count) const {
    std::string out;
    for (int k = 0; k < count; ++k) {
      std::string seen;
      for (int y = 0; y < 7; ++y) {
        for (int x = 0; x < 5; ++x) {
          const Colour c = at(left + (6 * k + x) * dots, top + y * dots);
          EXPECT_EQ(c, at(left + (6 * k + x) * dots + dots - 1, top + y * dots + dots - 1));
          seen += c == Colour{0, 0, 0} ? '#' : c == Colour{255, 255, 255} ? '.' : '?';
        }
      }
      const auto known = letters().find(seen);
      out += known != letters().end() ? known->second : seen == std::string(35, '.') ? ' ' : '?';
    }
    return out;
  }
};

// Least, most with its unit at the right end, and the length of the bar below.
void expect_legend(const FieldScale& scale, const Grid& grid, double low, double high,
                   const std::string& least, const std::string& most, const std::string& bar) {
  std::vector<double> values(grid.size(), low);
  values.back() = high;
  const Shown shown(grid, values, scale);
  int width = 0, height = 0;
  render_field(grid, values, width, height);
  const int line = 10 * shown.dots;
  ASSERT_EQ(shown.picture.width, width);
  ASSERT_EQ(shown.picture.height, height + 3 * line);
  const auto length = [](const std::string& s) { return static_cast<int>(s.size()); };
  const int numbers = height + line + 2 * shown.dots, below = height + 2 * line + shown.dots;
  EXPECT_EQ(shown.text(shown.dots, numbers, length(least)), least);
  EXPECT_EQ(shown.text(width - 6 * shown.dots * length(most), numbers, length(most)), most);
  EXPECT_EQ(shown.text(shown.dots, below, length(bar)), bar);
}

TEST(Legends, SayTheLeastTheMostAndTheLengthOfTheBar) {
  const Grid small{64, 32, 10e-6, 5e-6}, large{600, 20, 400e-9, 10e-9}, fine{512, 8, 20e-6, 1e-6};
  expect_legend({1e9, "nm"}, small, -123.4e-9, 567e-9, "-123", "567 nm", "2 um");
  expect_legend({1e-3, "kPa"}, large, 0.89, 40600, "0.00089", "40.6 kPa", "100 nm");
  expect_legend({1e-6, "MPa"}, small, 1.25e-3, 7.5e12, "1.25e-09", "7.5e+06 MPa", "2 um");
  expect_legend({100, "%"}, fine, 0, 0.348, "0", "34.8 %", "5 um");
  expect_legend({1e6, "um"}, fine, -9.17e-6, 2e-6, "-9.17", "2 um", "5 um");
}

// A maker reads off the picture how deep and how wide the texture is.
TEST(Legends, OfHeightsAreInNanometres) {
  Heightmap h{{64, 32, 10e-6, 5e-6}, std::vector<double>(64 * 32, 0.0)};
  h(3, 4) = -350e-9;
  const FieldPicture preview = picture_of_heights(h);
  const Shown shown(h.grid, h.z, {1e9, "nm"});
  EXPECT_EQ(preview.rgb, shown.picture.rgb);
  const int field = preview.height - 30 * shown.dots;
  EXPECT_EQ(shown.text(shown.dots, field + 12 * shown.dots, 4), "-350");
  EXPECT_EQ(shown.text(preview.width - 24 * shown.dots, field + 12 * shown.dots, 4), "0 nm");
  EXPECT_EQ(shown.text(shown.dots, field + 21 * shown.dots, 4), "2 um");
}

TEST(Legends, HaveTheColoursOfTheirFieldFromLeastToMost) {
  const Grid grid{4, 2, 4e-6, 2e-6};
  const std::vector<double> values{0, 1, 2, 4, 4, 2, 1, 0};
  for (const bool root : {false, true}) {
    const Shown shown(grid, values, {1, "", root});
    const int width = shown.picture.width, zoom = width / 4, top = 2 * zoom;
    const auto colour = [&](double share) {
      const auto c = field_colour(root ? std::sqrt(share) : share);
      return Colour{c[0], c[1], c[2]};
    };
    // Cells of the upper row, whose bar stands in none of them.
    for (int i = 0; i < 4; ++i) {
      EXPECT_EQ(shown.at(i * zoom + zoom / 2, zoom / 2),
                colour(values[static_cast<std::size_t>(4 + i)] / 4))
          << i << root;
    }
    const int y = top + 5 * shown.dots;
    for (const int x : {0, width / 3, width / 2, width - 1})
      EXPECT_EQ(shown.at(x, y), colour(static_cast<double>(x) / (width - 1))) << x << root;
    EXPECT_EQ(shown.at(width / 2, top), (Colour{255, 255, 255}));  // a line between them
    EXPECT_EQ(shown.at(width / 2, top + shown.dots), colour(0.5 * width / (width - 1)));
    EXPECT_NE(shown.at(width / 2, top + 10 * shown.dots - 1), (Colour{255, 255, 255}));
    EXPECT_EQ(shown.at(width / 2, top + 10 * shown.dots), (Colour{255, 255, 255}));
  }
  // All alike: the colour of the most.
  const Shown flat(grid, std::vector<double>(8, 3.0), {1, "", false});
  EXPECT_EQ(flat.at(300, 50), (Colour{253, 231, 37}));
}

}  // namespace
}  // namespace papilla::tests::legend_test
