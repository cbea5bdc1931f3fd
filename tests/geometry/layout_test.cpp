#include "geometry/io/layout.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "geometry/io/drawing.h"
#include "geometry/texture.h"
#include "tests/temporary.h"

namespace papilla::tests::layout_test {
namespace {

struct GdsRecord {
  int type;
  std::string data;
  int i16(std::size_t at) const {
    return static_cast<std::int16_t>(static_cast<unsigned char>(data[at]) << 8 |
                                     static_cast<unsigned char>(data[at + 1]));
  }
  std::int32_t i32(std::size_t at) const {
    std::uint32_t v = 0;
    for (std::size_t i = 0; i < 4; ++i) v = v << 8 | static_cast<unsigned char>(data[at + i]);
    return static_cast<std::int32_t>(v);
  }
  double real(std::size_t at) const {
    double mantissa = 0;
    for (std::size_t i = 1; i < 8; ++i)
      mantissa = mantissa * 256 + static_cast<unsigned char>(data[at + i]);
    return std::ldexp(mantissa, -56) *
           std::pow(16.0, (static_cast<unsigned char>(data[at]) & 0x7f) - 64);
  }
};

std::vector<GdsRecord> records(const std::string& path) {
  const std::string bytes = read_bytes(path);
  std::vector<GdsRecord> out;
  for (std::size_t at = 0; at < bytes.size();) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(bytes[at + i]); };
    const std::size_t length = byte(0) * 256u + byte(1);
    EXPECT_GE(length, 4u);
    EXPECT_EQ(length % 2, 0u);
    out.push_back({byte(2) * 256 + byte(3), bytes.substr(at + 4, length - 4)});
    at += length;
  }
  return out;
}

double polygon_area(const GdsRecord& xy) {  // nm^2
  double sum = 0;
  const std::size_t n = xy.data.size() / 8;
  for (std::size_t i = 0; i + 1 < n; ++i) {
    sum += static_cast<double>(xy.i32(8 * i)) * xy.i32(8 * i + 12) -
           static_cast<double>(xy.i32(8 * i + 8)) * xy.i32(8 * i + 4);
  }
  return 0.5 * std::abs(sum);
}

// A structure: its own polygons and what it places, how often.
struct Structure {
  double area = 0;  // nm^2
  std::vector<std::pair<std::string, long>> places;
};

double drawn_area(const std::map<std::string, Structure>& all, const std::string& name) {
  const Structure& s = all.at(name);
  double sum = s.area;
  for (const auto& [placed, count] : s.places)
    sum += static_cast<double>(count) * drawn_area(all, placed);
  return sum;
}

FeatureArray array_of(const Texture& texture) {
  return std::get<FeatureArray>(facts(texture).outline);
}

TEST(Gds, TheArrayHasTheOpenAreaOfTheTexture) {
  for (const Lattice lattice : {Lattice::Square, Lattice::Hexagonal}) {
    HoleArray holes;
    holes.lattice = lattice;
    const Texture texture{holes};
    const std::string path = temporary("array.gds");
    const auto [layout, array] = draw_array(array_of(texture), 600e-6, 600e-6);
    write_gds(path, layout);
    std::map<std::string, Structure> structures;
    std::string name;
    int element = 0;
    for (const GdsRecord& record : records(path)) {
      const auto text = [&] { return std::string(record.data.c_str()); };
      switch (record.type) {
        case 0x0305:
          EXPECT_DOUBLE_EQ(record.real(0), 1e-3);  // database units in um
          EXPECT_DOUBLE_EQ(record.real(8), 1e-9);
          break;
        case 0x0606:
          name = text();
          break;
        case 0x0800:
        case 0x0A00:
        case 0x0B00:
          element = record.type;
          break;
        case 0x1206:
          structures[name].places.emplace_back(text(), 1);
          break;
        case 0x1302:
          EXPECT_EQ(record.i16(0), 100);
          structures[name].places.back().second = static_cast<long>(record.i16(0)) * record.i16(2);
          break;
        case 0x1003:
          if (element == 0x0800) structures[name].area += polygon_area(record);
          if (element == 0x0B00) {
            EXPECT_EQ(record.i32(8), 600000);
          }
          break;
        default:
          break;
      }
    }
    const double height = 1e9 * array.pitch_y * static_cast<double>(array.rows);
    EXPECT_NEAR(height, 600000, 1e9 * array.pitch_y);
    const double open = drawn_area(structures, name) / (600000 * height);
    // Rounding to 1 nm: at most half a database unit along the rim.
    EXPECT_NEAR(open, facts(texture).open_share.value(), 4 * 0.5e-9 / holes.diameter * open);
  }
}

TEST(Gds, RefusesWhatIsNoArray) { EXPECT_THROW(array_of(Texture{}), std::bad_variant_access); }

TEST(Stl, IsAClosedBodyOfTheRightVolume) {
  const Texture texture{HoleArray{}};
  const Grid grid = patch_grid(texture, 64);
  const Heightmap h = generate(texture, grid);
  const std::string path = temporary("block.stl");
  write_stl(path, h, 1e-6);
  const std::string bytes = read_bytes(path);
  std::uint32_t faces = 0;
  std::memcpy(&faces, bytes.data() + 80, 4);
  ASSERT_EQ(bytes.size(), 84 + 50 * static_cast<std::size_t>(faces));
  using Point = std::array<float, 3>;
  std::map<std::pair<Point, Point>, int> edges;  // directed
  double volume = 0;
  for (std::uint32_t f = 0; f < faces; ++f) {
    std::array<Point, 4> own;  // its normal, then its corners
    std::memcpy(own.data(), bytes.data() + 84 + 50 * static_cast<std::size_t>(f), 48);
    const Point& normal = own[0];
    const std::array<Point, 3> p{own[1], own[2], own[3]};
    for (std::size_t i = 0; i < 3; ++i) {  // of length one, upright on both sides: out of the body
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      const auto side = [&](std::size_t to, std::size_t axis) { return p[to][axis] - p[0][axis]; };
      const double cross = side(1, j) * side(2, k) - side(1, k) * side(2, j);
      double twice = 0;
      for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
        twice += square(double{side(1, b)} * side(2, c) - double{side(1, c)} * side(2, b));
      }
      EXPECT_NEAR(normal[i], cross / std::sqrt(twice), 1e-4);
    }
    for (std::size_t i = 0; i < 3; ++i) ++edges[{p[i], p[(i + 1) % 3]}];
    volume += (static_cast<double>(p[0][0]) * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) -
               static_cast<double>(p[0][1]) * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) +
               static_cast<double>(p[0][2]) * (p[1][0] * p[2][1] - p[1][1] * p[2][0])) /
              6;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.count({edge.second, edge.first}));
  }
  // Of the whole period: each pixel counts once.
  double expected = 0;
  for (const double z : h.z) expected += 1e18 * grid.pixel_area() * (z + 350e-9 + 1e-6);
  EXPECT_NEAR(volume, expected, 1e-4 * expected);
  // From 0 to the sides, and alike at opposite ones, so that tiles meet.
  std::map<std::pair<float, float>, float> top;
  for (const auto& [edge, count] : edges) {
    if (edge.first[2] > 0) top[{edge.first[0], edge.first[1]}] = edge.first[2];
  }
  const auto lx = static_cast<float>(1e6 * grid.lx), ly = static_cast<float>(1e6 * grid.ly);
  EXPECT_EQ(top.begin()->first, std::pair(0.0F, 0.0F));
  EXPECT_EQ(top.rbegin()->first, std::pair(lx, ly));
  for (const auto& [place, z] : top) {
    if (place.first == 0) {
      EXPECT_EQ(z, top.at({lx, place.second}));
    }
    if (place.second == 0) {
      EXPECT_EQ(z, top.at({place.first, ly}));
    }
  }
}

}  // namespace
}  // namespace papilla::tests::layout_test
