// Layouts and bodies of triangles against their design, to where each tolerance ends.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "fabricate/checks.h"
#include "fabricate/layers.h"
#include "geometry/io/drawing.h"
#include "geometry/io/layout.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::shapes_judged_test {
namespace {

// What is said of a layout by either of its files.
struct LayoutJudge {
  Texture texture;
  Grid grid;
  double facet_error = 2e-9;

  Layout drawn() const {
    Layout out = draw_array(*array_of(facts(texture)), grid.lx, grid.ly, facet_error).layout;
    with_source([&](const ExportSource& source) { out.layers = layers_of(source); });
    return out;
  }
  void with_source(const std::function<void(const ExportSource&)>& use) const {
    const Heightmap map{grid, {}};
    ExportOptions options;
    options.facet_error = facet_error;
    const FileInfo info;
    const std::function<void(double)> quiet;
    use({map, texture, options, info, quiet});
  }
  Faults of(const Layout& layout) const {
    Faults out;
    with_source([&](const ExportSource& source) { out = judged(source, layout); });
    return out;
  }
  static Faults judged(const ExportSource& source, const Layout& layout) {
    write_gds(temporary("judged.gds"), layout);
    write_oasis(temporary("judged.oas"), layout);
    const Faults out = check_gds(source, temporary("judged.gds"));
    EXPECT_EQ(check_oasis(source, temporary("judged.oas")), out);
    return out;
  }
  Faults of(const std::function<void(Layout&)>& change) const {
    Layout layout = drawn();
    change(layout);
    return of(layout);
  }
  std::string refusal(const std::function<void(Layout&)>& change) const {
    return refusal_of([&] { of(change); });
  }
};

Polygon& outline(Layout& layout) { return layout.cells[0].polygons.at(0).outline; }
LayoutReference& placed(Layout& layout) { return layout.cells.back().references.at(0); }

const LayoutJudge kHoles{Texture{HoleArray{.period = 6e-6, .diameter = 3e-6}},
                         {64, 64, 12e-6, 12e-6}};
const LayoutJudge kGrooves{Texture{Grating{.period = 4e-6, .width = 1.5e-6, .depth = 1e-7}},
                           {64, 64, 12e-6, 10e-6}};

// A hole and a pillar of one size have the same polygons; what they are stands in the file.
TEST(JudgedLayouts, ALayerSaysWhetherItsPolygonsAreDeepOrHigh) {
  const LayoutJudge pillars{
      Texture{PillarArray{.period = 6e-6, .diameter = 3e-6, .height = 350e-9}},
      {64, 64, 12e-6, 12e-6}},
      holes{Texture{HoleArray{.period = 6e-6, .diameter = 3e-6, .depth = 350e-9}},
            {64, 64, 12e-6, 12e-6}};
  const Layout deep = holes.drawn(), high = pillars.drawn();
  EXPECT_EQ(deep.cells[0].polygons, high.cells[0].polygons);
  EXPECT_EQ(deep.layers,
            (std::vector<LayoutLayer>{
                {1, "HOLES_DEEP",
                 "tone: polygons are deep, what is around them is high; kind: holes; depth 350 nm; "
                 "diameter 3 um at the land; pitch 6 um, square"}}));
  EXPECT_EQ(high.layers[0].name, "PILLARS_HIGH");
  EXPECT_NE(high.layers[0].label.find("diameter 3 um at the top"), std::string::npos);
  EXPECT_EQ(pillars.of(high), Faults{});
  const Faults inverted = pillars.of(deep);
  ASSERT_EQ(inverted.size(), 1u);
  EXPECT_TRUE(
      inverted[0].starts_with("its layer 1 is said to be \"HOLES_DEEP: tone: polygons are "
                              "deep"))
      << inverted[0];
  const Faults silent = pillars.of([](Layout& layout) { layout.layers.clear(); });
  ASSERT_EQ(silent.size(), 1u);
  EXPECT_TRUE(silent[0].starts_with("its layer 1 has no name and label")) << silent[0];
}

TEST(JudgedLayouts, AWidthIsRightToANanometre) {
  EXPECT_EQ(kGrooves.of([](Layout&) {}), Faults{});
  const auto wider = [](int left, int right) {
    return kGrooves.of([=](Layout& layout) {
      for (auto& x : outline(layout).x) x += x > 2000 ? right : -left;
    });
  };
  EXPECT_EQ(wider(1, 1),
            Faults{"its critical dimension (width of the grooves) is 1.502 um, the design's 1.5 "
                   "um: 0.133 % more"});
  EXPECT_EQ(wider(-1, -1),
            Faults{"its critical dimension (width of the grooves) is 1.498 um, the design's 1.5 "
                   "um: 0.133 % less"});
  EXPECT_EQ(wider(-1, 1), Faults{});  // moved by 1 nm
}

// A corner of a groove that is cut by as much on one side as it grows on the other keeps its width.
TEST(JudgedLayouts, ACornerOfAGrooveIsRightToOneAndAHalfNanometres) {
  const auto slanted = [](int by) {
    return kGrooves.of([=](Layout& layout) {
      Polygon& p = outline(layout);
      for (std::size_t i = 0; i < 4; ++i) p.x[i] += p.y[i] > 0 ? by : -by;
    });
  };
  EXPECT_EQ(slanted(1), Faults{});
  EXPECT_EQ(slanted(2), Faults{"a corner of its grooves is 2 nm off the outline"});
  // As high as the map: 10 um, and 3 nm beyond at both ends, 0.9 nm of its width by the area.
  const Faults high = kGrooves.of([](Layout& layout) {
    for (auto& y : outline(layout).y) y += y > 0 ? 3 : -3;
  });
  EXPECT_EQ(high, (Faults{"a corner of its grooves is 3 nm off the outline"}));
}

// The facets may be off the circle by their own error and the rounding of a corner.
TEST(JudgedLayouts, ACornerOfACircleIsRightToItsFacetsAndTheirRounding) {
  LayoutJudge fine = kHoles;
  fine.facet_error = 1e-12;  // 1024 sides: corners on the circle
  const auto out = [](const LayoutJudge& judge, int by) {
    return judge.of([=](Layout& layout) {
      // The first corner, nearly along x from the centre at 3 um.
      outline(layout).x.at(0) += by;
    });
  };
  EXPECT_EQ(out(fine, 0), Faults{});
  EXPECT_EQ(out(fine, 1), Faults{});
  EXPECT_EQ(out(fine, 2), Faults{"a corner of its holes is 2 nm off the outline"});
  // 16 sides of 50 nm: corners lie r (sqrt(a / sin a) - 1) = 19.6 nm outside, a = 22.5 deg. One
  // moved by 28 nm is 46 off in its own direction of 11 deg, one of 38 nm is 56.
  LayoutJudge coarse = kHoles;
  coarse.facet_error = 50e-9;
  Layout drawn = coarse.drawn();
  EXPECT_EQ(outline(drawn).x.size(), 16u);
  EXPECT_EQ(out(coarse, 0), Faults{});
  const auto corner = [&](int by) {
    int found = 0;
    for (const std::string& fault : out(coarse, by)) found += fault.starts_with("a corner of its");
    return found;
  };
  EXPECT_EQ(corner(28), 0);
  EXPECT_EQ(corner(38), 1);
}

TEST(JudgedLayouts, APlaceIsRightToTwoNanometres) {
  const auto moved = [](int x, int y) {
    return kHoles.of([=](Layout& layout) { placed(layout).x += x, placed(layout).y += y; });
  };
  EXPECT_EQ(moved(1, -1), Faults{});
  EXPECT_EQ(moved(-2, 2),
            Faults{"its holes are up to 2.828 nm off their places, in the row that begins at (3, "
                   "3) um"});
  // The last of the columns and of the rows, by their pitch.
  const auto pitch = [](int x, int y) {
    return kHoles.of(
        [=](Layout& layout) { placed(layout).step_x += x, placed(layout).step_y += y; });
  };
  EXPECT_EQ(pitch(1, 1), Faults{});
  EXPECT_EQ(pitch(3, 0), Faults{"its holes are up to 3 nm off their places, in the row that begins "
                                "at (3, 3) um"});
  EXPECT_EQ(pitch(0, -3), Faults{"its holes are up to 3 nm off their places, in the row that "
                                 "begins at (3, 9) um"});
}

// Three columns and hexagons: two rows a cell, the odd ones half a period on.
TEST(JudgedLayouts, OfHexagonsEveryRowHasItsPlace) {
  const double row = std::sqrt(3.0) * 6e-6;
  const LayoutJudge hexagons{
      Texture{HoleArray{.lattice = Lattice::Hexagonal, .period = 6e-6, .diameter = 3e-6}},
      {64, 64, 18e-6, 2 * row}};
  EXPECT_EQ(hexagons.of([](Layout&) {}), Faults{});
  // Rows 0.5 sqrt 3 times 6 um apart: the second from below is at 1.5 of it, 7794.23 nm, which is
  // rounded to 7794, its first hole at 4.5 um.
  EXPECT_EQ(hexagons.of([](Layout& layout) { layout.cells[1].references.at(1).x += 7; }),
            Faults{"its holes are up to 7.004 nm off their places, in the row that begins at (4.5, "
                   "7.794) um"});
  EXPECT_EQ(hexagons.of([](Layout& layout) { placed(layout).columns = 2; }),
            Faults{"8 polygons, the design's 12"});
  EXPECT_EQ(hexagons.of([](Layout& layout) { placed(layout).columns = 4; }),
            Faults{"16 polygons, the design's 12"});
}

// GDSII has each of its rows in seven parts, of 32767 columns and of 3398.
TEST(JudgedLayouts, ArraysThatGdsiiHoldsInPartsAreTheDesigns) {
  const LayoutJudge wide{Texture{HoleArray{.period = 1e-6, .diameter = 0.5e-6}},
                         {64, 64, 200e-3, 100e-6}};
  EXPECT_EQ(wide.of([](Layout&) {}), Faults{});
  EXPECT_EQ(wide.of([](Layout& layout) { placed(layout).columns -= 1; }),
            Faults{"19999900 polygons, the design's 20000000"});
}

// Twice the rows of the design and sixteen, by way of three cells each, are looked at: of two rows
// 60, the top among them.
TEST(JudgedLayouts, FarMoreRowsThanTheDesignHasAreRefused) {
  const auto rows = [](long n) {
    return kHoles.refusal([=](Layout& layout) {
      placed(layout).rows = n;
      placed(layout).step_y = 1;
    });
  };
  EXPECT_EQ(rows(59), "");
  EXPECT_EQ(rows(60), "more rows of polygons than the design has");
  EXPECT_EQ(kHoles.refusal([](Layout& layout) {
    LayoutCell outer{"OUTER", {}, {placed(layout)}};
    outer.references[0].cell = layout.cells.back().name;
    layout.cells.push_back(outer);
  }),
            "an array of columns in an array of columns");
}

// --- triangles ---

// Twelve by eight pixels of 1 um, 200 nm deep in part, on a base that lies 1 um lower.
class JudgedBody : public ::testing::Test {
 protected:
  JudgedBody() : design_{{12, 8, 12e-6, 8e-6}, std::vector<double>(96)} {
    for (std::size_t i = 0; i < 96; ++i) design_.z[i] = i % 3 == 0 ? 0 : -200e-9;
    write_stl(path_, design_);
    bytes_ = read_bytes(path_);
  }
  Faults judged() const {
    const Texture texture;
    const ExportOptions options;
    const FileInfo info;
    const std::function<void(double)> quiet;
    return check_stl({design_, texture, options, info, quiet}, path_);
  }
  // Number 0 to 8 of a triangle, as change makes it.
  Faults changed(std::size_t triangle, std::size_t number,
                 const std::function<float(float)>& change) const {
    std::string bytes = bytes_;
    char* at = bytes.data() + 84 + 50 * triangle + 12 + 4 * number;
    float value = 0;
    std::memcpy(&value, at, 4);
    value = change(value);
    std::memcpy(at, &value, 4);
    write_bytes(path_, bytes);
    return judged();
  }
  static std::function<float(float)> steps(int up) {  // of the last binary digit
    return [=](float v) {
      for (int i = 0; i < std::abs(up); ++i)
        v = std::nextafter(v, up > 0 ? std::numeric_limits<float>::infinity() : -1.0F);
      return v;
    };
  }

  const std::string path_ = temporary("judged.stl");
  Heightmap design_;
  std::string bytes_;
};

// 2e-7 of the largest of a corner's numbers. The first triangle begins at the origin, 1.2 um high
// above the base (a digit of it is 1.2e-7 um, and its nearest lies 0.5e-7 above: up one is allowed,
// down two); of pixel (11, 7), triangle 4 95, the second corner lies 12 um along x (a digit
// is 9.5e-7 um: two are allowed).
TEST_F(JudgedBody, ItsCornersAreRightToTheirDigits) {
  EXPECT_EQ(judged(), Faults{});
  for (const auto& [up, faults] : {std::pair{1, 0u}, {-2, 0u}, {2, 1u}, {-3, 1u}})
    EXPECT_EQ(changed(0, 2, steps(up)).size(), faults) << up;
  // Along y, 7 um, the longest number is still x.
  const std::size_t last = 4 * 95;
  for (const auto& [up, faults] : {std::pair{4, 0u}, {-4, 0u}, {6, 1u}, {-6, 1u}})
    EXPECT_EQ(changed(last, 4, steps(up)).size(), faults) << up;
  EXPECT_EQ(changed(last, 3, steps(2)), Faults{});
  EXPECT_EQ(changed(last, 3, steps(-2)), Faults{});
  EXPECT_EQ(changed(last, 3, steps(-4)).size(), 1u);
}

TEST_F(JudgedBody, ACornerIsSaidByItsPlaceAndHowFarItIsOff) {
  EXPECT_EQ(changed(0, 2, [](float z) { return z + 0.003F; }),
            Faults{"1 corners are off the surface, by 3 nm at most, at (0, 0) um"});
  // Beside a corner by less than half a pixel it is that far off; by more it is a corner of the
  // next pixel; beyond the sides by more than that it is off by no number.
  const std::size_t last = 4 * 95;  // its first corner is (11, 7) um
  EXPECT_EQ(changed(last, 0, [](float) { return 10.96875F; }),
            Faults{"1 corners are off the surface, by 31.25 nm at most, at (10.97, 7) um"});
  EXPECT_EQ(changed(last, 1, [](float) { return 7.0625F; }),
            Faults{"1 corners are off the surface, by 62.5 nm at most, at (11, 7.062) um"});
  for (const auto& [number, value, place] :
       {std::tuple{0u, -0.625F, "(-0.625, 0)"}, {1u, -0.625F, "(0, -0.625)"}}) {
    const Faults faults = changed(0, number, [v = value](float) { return v; });
    EXPECT_EQ(faults.back(),
              std::string("1 corners are off the surface, by inf nm at most, at ") + place + " um");
  }
  EXPECT_EQ(changed(0, 0, [](float) { return -0.375F; }).back(),
            "1 corners are off the surface, by 375 nm at most, at (-0.375, 0) um");
  const std::string sides = changed(0, 0, [](float) { return 12.375F; }).front();
  EXPECT_EQ(sides, "its width is 12.38 um, the design's 12 um: 3.12 % more");
  EXPECT_EQ(changed(0, 0, [](float) { return 12.375F; }).back(),
            "1 corners are off the surface, by 375 nm at most, at (12.38, 0) um");
  EXPECT_EQ(changed(0, 0, [](float) { return 12.625F; }).back(),
            "1 corners are off the surface, by inf nm at most, at (12.62, 0) um");
  EXPECT_EQ(changed(0, 1, [](float) { return 8.625F; }).back(),
            "1 corners are off the surface, by inf nm at most, at (0, 8.625) um");
}

// Programs shade, and some slice, by the normals.
TEST_F(JudgedBody, ItsNormalsStandOnTheTrianglesOutwards) {
  const auto with_normal = [&](std::size_t triangle, float times) {
    std::string bytes = bytes_;
    for (std::size_t k = 0; k < 3; ++k) {
      char* at = bytes.data() + 84 + 50 * triangle + 4 * k;
      float value = 0;
      std::memcpy(&value, at, 4);
      value *= times;
      std::memcpy(at, &value, 4);
    }
    write_bytes(path_, bytes);
    return judged();
  };
  const Faults turned{"the normals of 1 triangles do not stand on them, outwards"};
  EXPECT_EQ(with_normal(5, -1), turned);
  EXPECT_EQ(with_normal(100, 0), turned);
  EXPECT_EQ(with_normal(100, 1), Faults{});
}

// The two triangles of a pixel's base again in place of those of the next pixel: as many triangles,
// of the same volume, with a hole in the base.
TEST_F(JudgedBody, OfTrianglesThatCloseNoBodyTheOpenEdgesAreCounted) {
  const std::size_t pixel = 4 * 40;
  const auto at = [&](std::size_t triangle) { return 84 + 50 * triangle; };
  std::string bytes = bytes_;
  bytes.replace(at(pixel + 6), 100, bytes_.substr(at(pixel + 2), 100));
  write_bytes(path_, bytes);
  // Three round the hole, three round the doubled square, and twice the edge between both.
  const std::string open =
      " edges of triangles are those of no other one in the opposite direction";
  Faults faults = judged();
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_TRUE(faults[0].starts_with("8" + open)) << faults[0];
}

TEST_F(JudgedBody, CornersThatAreNoNumbersAreCounted) {
  const Faults faults =
      changed(7, 2, [](float) { return std::numeric_limits<float>::quiet_NaN(); });
  EXPECT_EQ(faults.front(), "1 triangles have corners that are no finite numbers");
  for (const std::string& fault : faults) EXPECT_EQ(fault.find("nan"), std::string::npos) << fault;
}

// 4 triangles a pixel and 4 a pixel of the sides; volume 32 of 96 um2 times 1.2 and 64 times 1 um.
TEST_F(JudgedBody, ItsTrianglesAndVolumeAreCounted) {
  std::string bytes = bytes_;
  const std::uint32_t count = 4 * 96 + 4 * (12 + 8), less = count - 1;
  ASSERT_EQ(bytes.size(), 84 + 50 * std::size_t{count});
  std::memcpy(bytes.data() + 80, &less, 4);
  write_bytes(path_, bytes);
  Faults faults = judged();
  ASSERT_GE(faults.size(), 2u);
  EXPECT_EQ(faults[0], "463 triangles, the design's 464");
  EXPECT_EQ(faults[1], "more after its last triangle");
  // Every height 1e-4 of the mean above the base more or less, and half of that.
  const double mean = 32 * 0.2e-6 / 96 + 1e-6;
  for (const auto& [share, said] :
       {std::pair{2e-4, true}, {-2e-4, true}, {0.7e-4, false}, {-0.7e-4, false}}) {
    Heightmap file = design_;
    for (double& z : file.z) z += share * mean;
    write_stl(path_, file, 1e-6 + share * mean);
    faults = judged();
    EXPECT_EQ(faults.front().starts_with("its volume is 102."), said) << share << faults.front();
  }
}

}  // namespace
}  // namespace papilla::tests::shapes_judged_test
