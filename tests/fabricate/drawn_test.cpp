// What an export makes of a size, a period and pixels that were asked for, and what it says where
// that is not the same; what is said of files whose heights are others.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "fabricate/checks.h"
#include "tests/fabricate/exported_folder.h"
#include "tests/temporary.h"

namespace papilla::tests::drawn_test {
namespace {

HoleArray holes_of(double period, double diameter) {
  HoleArray holes;
  holes.period = period, holes.diameter = diameter, holes.depth = 200e-9;
  holes.wall_angle = kPi / 2;
  return holes;
}

struct Drawn {
  Export out;
  std::string refused;

  Drawn(const Texture& texture, const ExportOptions& options) {
    Design design;
    design.texture = texture;
    try {
      out = prepare_export(design, options);
    } catch (const InputError& error) {
      refused = error.what();
    }
  }
  std::string warning() const { return out.warnings.empty() ? "" : out.warnings.front(); }
};

ExportOptions options_of(const char* format, int pixels, double size) {
  ExportOptions options;
  options.formats = {format};
  options.pixels = pixels, options.size = size;
  options.polarity = Polarity::WhiteDeep;
  return options;
}

TEST(Period, OfALayoutIsTheNearestNanometreAndSaidToBe) {
  for (const auto& [asked, made, words] :
       {std::tuple{6000.3e-9, 6000e-9, "6000 nm, 0.3 nm (0.005 %) less"},
        {6000.7e-9, 6001e-9, "6001 nm, 0.3 nm (0.005 %) more"},
        {2000.5004e-9, 2001e-9, "2001 nm, 0.5 nm (0.025 %) more"},
        {6000.00005e-9, 6000.00005e-9, ""}}) {
    for (const char* format : {"gds", "oasis"}) {
      const Drawn drawn(Texture{holes_of(asked, 1e-6)}, options_of(format, 64, 30e-6));
      EXPECT_NEAR(facts(drawn.out.texture).period(), made, 1e-18) << asked;
      const std::vector<std::string>& said = drawn.out.warnings;
      const bool found = std::any_of(said.begin(), said.end(), [&](const std::string& w) {
        return w.find("grid of layouts") != std::string::npos && w.find(words) != std::string::npos;
      });
      EXPECT_EQ(found, *words != '\0') << asked << " " << drawn.warning();
    }
    EXPECT_EQ(facts(Drawn(Texture{holes_of(asked, 1e-6)}, options_of("npy", 64, 30e-6)).out.texture)
                  .period(),
              asked);
  }
  // Rounded down, the wall would be nothing: up.
  EXPECT_NEAR(
      facts(
          Drawn(Texture{holes_of(2000.3e-9, 2000.1e-9)}, options_of("gds", 64, 30e-6)).out.texture)
          .period(),
      2001e-9, 1e-18);
}

TEST(Repeat, SaysWhichFilesHoldTheMapOnce) {
  ExportOptions options = options_of("exr", 64, 12e-6);
  const auto warnings = [&] { return Drawn(Texture{holes_of(6e-6, 3e-6)}, options).out.warnings; };
  options.repeat = 4;
  EXPECT_EQ(warnings(), std::vector<std::string>{});
  options.formats = {"exr", "gds"};
  EXPECT_EQ(warnings(), std::vector<std::string>{"--repeat 4 is of exr alone: gds holds the map "
                                                 "once; --size is of all files"});
  options.formats = {"gsf", "exr", "oasis"};
  EXPECT_EQ(warnings(), std::vector<std::string>{"--repeat 4 is of exr alone: gsf, oasis hold the "
                                                 "map once; --size is of all files"});
  options.repeat = 1;
  EXPECT_EQ(warnings(), std::vector<std::string>{});
}

TEST(Repeat, IsKnownOfTheExrAlone) {
  ExportOptions options = options_of("exr", 64, 12e-6);
  options.repeat = 4;
  EXPECT_EQ(Drawn(Texture{holes_of(6e-6, 3e-6)}, options).out.repeat, 4);
  options.formats = {"gsf"};
  EXPECT_EQ(Drawn(Texture{holes_of(6e-6, 3e-6)}, options).out.repeat, 1);
}

// Half of 450 nm lies below all of the shallow holes, which stand in no edge of it; the first of
// three levels, 75 nm, does not.
TEST(Edges, APartOfAStackThatTheyDoNotFollowIsSaid) {
  Stack stack;
  stack.parts = {Texture{HoleArray{.period = 6e-6, .diameter = 3e-6, .depth = 350e-9}},
                 Texture{HoleArray{.period = 2e-6, .diameter = 0.8e-6, .depth = 100e-9}}};
  ExportOptions options = options_of("mask", 120, 12e-6);
  options.formats = {"mask", "gds"};
  const auto warnings = [&] { return Drawn(Texture{stack}, options).out.warnings; };
  EXPECT_EQ(warnings(), std::vector<std::string>{
                            "part 2 of the stack (hole_array, 100 nm) is not drawn in mask and "
                            "gds, whose edges are 225 nm, half of the depth, below the highest "
                            "place: --levels 3 draws it in a layout, `papilla wafer` draws a mask "
                            "for each part"});
  options.formats = {"gds"}, options.levels = 3;
  EXPECT_EQ(warnings(), std::vector<std::string>{});
  options.levels = 1;
  // Half of 650 nm lies below all of the holes of 300 nm.
  std::get<HoleArray>(stack.parts[0].kind).depth = 300e-9;
  std::get<HoleArray>(stack.parts[1].kind).depth = 350e-9;
  const std::vector<std::string> other = warnings();
  ASSERT_EQ(other.size(), 1u);
  EXPECT_TRUE(
      other[0].starts_with("part 1 of the stack (hole_array, 300 nm) is drawn on 4 % of "
                           "its area only in gds"))
      << other[0];
  // Of equal depths each floor lies on the level, half of both: what is drawn is where they
  // overlap.
  std::get<HoleArray>(stack.parts[1].kind).depth = 300e-9;
  EXPECT_EQ(
      warnings(),
      (std::vector<std::string>{
          "part 1 of the stack (hole_array, 300 nm) is drawn on 8 % of its area only in gds, "
          "whose edges are 300 nm, half of the depth, below the highest place: --levels 2 "
          "draws it in a layout, `papilla wafer` draws a mask for each part",
          "part 2 of the stack (hole_array, 300 nm) is drawn on 11 % of its area only in gds, "
          "whose edges are 300 nm, half of the depth, below the highest place: --levels 2 "
          "draws it in a layout, `papilla wafer` draws a mask for each part"}));
  // Of holes in holes the shallow ones are drawn where they lie in others. Of two levels one draws
  // these and leaves out the inner ones, three draw all.
  stack.parts = {Texture{HoleArray{.period = 6e-6, .diameter = 2e-6, .depth = 250e-9}},
                 Texture{HoleArray{.period = 6e-6, .diameter = 4e-6, .depth = 200e-9}},
                 Texture{HoleArray{.period = 2e-6, .diameter = 1e-6, .depth = 200e-9}}};
  const std::vector<std::string> nested = warnings();
  ASSERT_EQ(nested.size(), 2u);
  EXPECT_TRUE(nested[0].starts_with("part 2 of the stack (hole_array, 200 nm) is drawn on 30 % of"))
      << nested[0];
  EXPECT_TRUE(nested[1].starts_with("part 3 of the stack (hole_array, 200 nm) is drawn on 21 % of"))
      << nested[1];
  EXPECT_NE(nested[0].find("--levels 3 draws it"), std::string::npos) << nested[0];
  options.formats = {"exr"};
  EXPECT_EQ(warnings(), std::vector<std::string>{});
}

// No mask of its own makes pillars beside pillars: what the one leaves standing the other etches.
TEST(Edges, AMaskForEachPartIsNamedWhereAWaferDrawsThem) {
  Stack stack;
  stack.parts = {Texture{PillarArray{.period = 6e-6, .diameter = 3e-6, .height = 350e-9}},
                 Texture{PillarArray{.period = 2e-6, .diameter = 0.8e-6, .height = 100e-9}}};
  const std::string said = Drawn(Texture{stack}, options_of("mask", 120, 12e-6)).warning();
  EXPECT_TRUE(said.starts_with("part 2 of the stack (pillar_array, 100 nm) is ")) << said;
  EXPECT_EQ(said.find("papilla wafer"), std::string::npos) << said;
}

// A large map is judged by one of its periods: it says what a small one does.
TEST(Edges, OfManyPeriodsAreJudgedAsOfOne) {
  Stack stack;
  stack.parts = {Texture{HoleArray{.period = 6e-6, .diameter = 3e-6, .depth = 350e-9}},
                 Texture{HoleArray{.period = 2e-6, .diameter = 0.8e-6, .depth = 100e-9}}};
  const Drawn large(Texture{stack}, options_of("mask", 1024, 24e-6));
  ASSERT_EQ(large.out.warnings.size(), 1u) << large.warning();
  EXPECT_TRUE(
      large.warning().starts_with("part 2 of the stack (hole_array, 100 nm) is not drawn in "
                                  "mask, whose edges are 225 nm"))
      << large.warning();
}

// Walls of 45 deg: 600 nm deep, they part the edges at the land and half-way down by 300 nm a side.
TEST(Edges, OfAMaskAndALayoutThatAreAtOtherPlacesAreSaid) {
  ExportOptions options = options_of("mask", 240, 12e-6);
  options.formats = {"mask", "gds"};
  const auto warnings = [&](double angle) {
    return Drawn(Texture{HoleArray{.period = 6e-6,
                                   .diameter = 3e-6,
                                   .depth = 600e-9,
                                   .wall_angle = angle * kPi / 180,
                                   .edge_radius = 0}},
                 options)
        .out.warnings;
  };
  EXPECT_EQ(warnings(90), std::vector<std::string>{});
  const std::vector<std::string> slanted = warnings(45);
  ASSERT_EQ(slanted.size(), 1u);
  const std::string begin = "mask and gds have other widths: holes are ";
  ASSERT_TRUE(slanted[0].starts_with(begin)) << slanted[0];
  // The design's own width, and beside it what the pixels make of it.
  const std::string own = begin + "2.4 um wide at half their depth, where mask is drawn (";
  ASSERT_TRUE(slanted[0].starts_with(own)) << slanted[0];
  EXPECT_NEAR(std::stod(slanted[0].substr(own.size())), 2.4, 0.02);
  EXPECT_TRUE(slanted[0].ends_with(" um by its whole pixels), and 3 um at the land, where gds is"))
      << slanted[0];
  options.formats = {"gds"};
  EXPECT_EQ(warnings(45), std::vector<std::string>{});
}

// V-grooves of 2 um, 400 nm deep, on pixels of 227 nm: the mean over the lowest one is 354.5 nm
// deep. Half of 400 nm is where they are 1 um wide.
TEST(Edges, OfSharpGroovesLieAtHalfTheDepthOfTheDesign) {
  const Texture grooves{VGrooves{.period = 5e-6, .width = 2e-6, .depth = 400e-9}};
  const Drawn drawn(grooves, options_of("gds", 44, 10e-6));
  const Heightmap& h = drawn.out.heightmap;
  ASSERT_EQ(h.grid.nx, 44);
  double area = 0;
  const Layout lines = draw_contours(h, 1, edge_planes(grooves, h));
  for (const LayoutPolygon& p : lines.cells.back().polygons) {
    const Polygon& o = p.outline;
    for (std::size_t i = 0, n = o.x.size(); i < n; ++i)
      area += 0.5e-18 * (1.0 * o.x[i] * o.y[(i + 1) % n] - 1.0 * o.x[(i + 1) % n] * o.y[i]);
  }
  EXPECT_NEAR(area / (2 * h.grid.ly), 1e-6, 2e-9);
  ASSERT_EQ(drawn.out.warnings.size(), 1u) << drawn.warning();
  EXPECT_TRUE(
      drawn.warning().starts_with("the map is 354.5 nm deep, the design 400 nm: a pixel of 227 nm "
                                  "is the mean over its area and "
                                  "cuts sharp ends off; --pixels "))
      << drawn.warning();
  EXPECT_TRUE(Drawn(grooves, options_of("gds", 1000, 10e-6)).out.warnings.empty());
  const Workplace place;
  EXPECT_EQ(Folder(place.path() / "f", grooves, Polarity::WhiteDeep).named(),
            std::set<std::string>{});
}

// Walls of 22 deg: a floor of 15 nm below holes of 3 um, 1.5 um wide half-way down.
TEST(Pixels, OfAMaskAreJudgedByTheWidthHalfWayDown) {
  const double depth = 600e-9, run = 0.5 * (3e-6 - 15e-9);
  const Texture slanted{HoleArray{
      .period = 6e-6, .diameter = 3e-6, .depth = depth, .wall_angle = std::atan(depth / run)}};
  EXPECT_EQ(Drawn(slanted, options_of("mask", 240, 12e-6)).refused, "");
  EXPECT_NE(Drawn(slanted, options_of("mask", 12, 12e-6)).refused.find("means nothing"),
            std::string::npos);
}

// A quarter of the smallest hole or wall a pixel, else a warning that says how many would do; half
// of it, else no mask.
TEST(Pixels, AreFourAcrossTheSmallestFeatureOrAreSaidToBeTooFew) {
  const Texture holes{holes_of(6e-6, 5.19e-6)};  // walls of 810 nm
  for (const auto& [pixels, warned] : {std::pair{60, false}, {58, true}}) {
    const Drawn maps(holes, options_of("npy", pixels, 12e-6));
    EXPECT_EQ(!maps.out.warnings.empty(), warned) << maps.warning();
    if (!warned) continue;
    EXPECT_NE(maps.warning().find("a pixel of 207 nm is more than a quarter of the smallest hole "
                                  "or wall, 810 nm"),
              std::string::npos)
        << maps.warning();
    EXPECT_NE(maps.warning().find("--pixels 60 would do"), std::string::npos) << maps.warning();
  }
  for (const auto& [pixels, drawn] : {std::pair{30, true}, {28, false}}) {
    const Drawn mask(holes, options_of("mask", pixels, 12e-6));
    EXPECT_EQ(mask.refused.empty(), drawn) << mask.refused;
    if (drawn) continue;
    EXPECT_NE(mask.refused.find("a pixel of 429 nm is more than half the smallest hole or wall, "
                                "810 nm; --pixels 60 would do"),
              std::string::npos)
        << mask.refused;
  }
  // Up to 2^14 pixels a side; beyond, another way.
  const auto remedy = [&](double size) {
    return Drawn(holes, options_of("npy", 64, size)).warning();
  };
  EXPECT_NE(remedy(3.312e-3).find("--pixels 16356 would do"), std::string::npos);
  EXPECT_NE(remedy(3.324e-3).find("would take 16416 pixels per side: ask for a smaller --size"),
            std::string::npos)
      << remedy(3.324e-3);
  const Drawn most(holes, options_of("npy", 16400, 3.312e-3));
  EXPECT_NE(most.refused.find("16400 x 16400 pixels are more than 2^28"), std::string::npos)
      << most.refused;
  EXPECT_TRUE(Drawn(Texture{RandomRough{}}, options_of("npy", 8, 12e-6)).out.warnings.empty());
}

TEST(Sides, AreWholePeriodsAndSaidWhereTheyAreOthers) {
  const auto drawn = [](const Texture& texture, double size, double size_y) {
    ExportOptions options = options_of("npy", 96, size);
    options.size_y = size_y;
    return Drawn(texture, options);
  };
  const Texture square{holes_of(3e-6, 1e-6)};
  HoleArray hexagons = holes_of(3e-6, 1e-6);
  hexagons.lattice = Lattice::Hexagonal;
  const double row = std::sqrt(3.0) * 3e-6;
  const auto expect_cells = [](const Drawn& d, int x, int y, double lx, double ly) {
    EXPECT_EQ(d.out.cells_x, x);
    EXPECT_EQ(d.out.cells_y, y);
    EXPECT_NEAR(d.out.heightmap.grid.lx, lx, 1e-15);
    EXPECT_NEAR(d.out.heightmap.grid.ly, ly, 1e-15);
  };
  expect_cells(drawn(square, 12e-6, 0), 4, 4, 12e-6, 12e-6);
  EXPECT_EQ(drawn(square, 12e-6, 0).warning(), "");
  expect_cells(drawn(square, 13e-6, 0), 4, 4, 12e-6, 12e-6);
  EXPECT_EQ(drawn(square, 13e-6, 0).warning(),
            "13 um were asked for, 12 um are written: a whole number of periods");
  expect_cells(drawn(square, 12e-6, 7e-6), 4, 2, 12e-6, 6e-6);
  EXPECT_EQ(drawn(square, 12e-6, 7e-6).warning(),
            "12 x 7 um were asked for, 12 x 6 um are written: a whole number of periods");
  EXPECT_EQ(drawn(square, 12e-6, 6e-6).warning(), "");
  // As many digits as tell the two apart.
  EXPECT_NE(Drawn(Texture{holes_of(6e-6, 3e-6)}, options_of("gds", 96, 1))
                .warning()
                .find("1000000 um were asked for, 1000002 um are written"),
            std::string::npos);
  // Of less than one and a half periods there is one, of hexagons with its two rows.
  expect_cells(drawn(square, 3e-6, 0), 1, 1, 3e-6, 3e-6);
  expect_cells(drawn(square, 4.4e-6, 0), 1, 1, 3e-6, 3e-6);
  expect_cells(drawn(square, 4.6e-6, 0), 2, 2, 6e-6, 6e-6);
  expect_cells(drawn(Texture{hexagons}, 3e-6, 0), 1, 1, 3e-6, row);
  expect_cells(drawn(Texture{hexagons}, 12e-6, 0), 4, 2, 12e-6, 2 * row);
  EXPECT_EQ(drawn(Texture{hexagons}, 12e-6, 0).warning(), "");  // its height is that of its rows
  // Grooves of 6 um beside hexagons of 2 um: 6 x 3.46 um, of which 10.39 um are three.
  hexagons.period = 2e-6;
  Stack fine;
  fine.parts = {Texture{Grating{.period = 6e-6, .width = 2e-6}}, Texture{hexagons}};
  expect_cells(drawn(Texture{fine}, 12e-6, 0), 2, 3, 12e-6, 2 * row);
  expect_cells(drawn(Texture{fine}, 6e-6, 0), 1, 3, 6e-6, 2 * row);
  // What does not repeat has no cells, and is as large as it must be.
  const Texture film{ParticleFilm{.radius = 1e-6}};
  EXPECT_EQ(drawn(film, 5e-6, 0).out.cells_x, 0);
  EXPECT_EQ(drawn(film, 5e-6, 0).warning(),
            "5 um were asked for, 8 um are written: the smallest patch that holds the texture");
  EXPECT_EQ(drawn(film, 9e-6, 0).warning(), "");
  Measured3d scan;
  scan.file = PAPILLA_DESIGNS_DIR "/measured_surface/scan.gsf";
  scan.patch = 12e-6;
  EXPECT_NE(drawn(Texture{scan}, 20e-6, 0)
                .warning()
                .find("20 um were asked for, 12 um are written: a measured surface is its patch"),
            std::string::npos);
}

TEST(Formats, ThatCannotBeWrittenSayWhatTheyNeed) {
  const Texture holes{HoleArray{}};
  const auto refused = [&](const char* format) {
    ExportOptions options;
    options.formats = {format};
    return Drawn(holes, options).refused;
  };
  EXPECT_NE(refused("dose").find("needs --dose-curve"), std::string::npos);
  EXPECT_NE(refused("mask").find("needs a polarity: white-high"), std::string::npos);
  EXPECT_EQ(refused("gds"), "");
  EXPECT_NE(refused("jpeg"), "");
}

// Files of the right kind with other heights: what is said of them is what was done to them.
class Changed : public ::testing::Test {
 protected:
  std::string said(const char* format, const std::function<void(Heightmap&)>& change) const {
    const ExportFormat& kind = find_export_format(format);
    Heightmap h = folder_.made().heightmap;
    change(h);
    write_again({format, folder_.path() + "/" + kind.file}, h, folder_.made().texture,
                folder_.options());
    std::string out;
    for (const FileVerdict& file : verify_folder(folder_.path(), kind.file)) {
      EXPECT_NE(file.state, FileState::Sound) << format;
      for (const std::string& fault : file.faults) out += fault + "\n";
    }
    return out;
  }
  static bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }

  const Workplace place_;
  const Folder folder_{place_.path() / "f", Texture{holes_of(6e-6, 3e-6)}, Polarity::WhiteDeep};
};

TEST_F(Changed, OnePixelIsFoundByItsPlaceAndHowFarItIsOff) {
  const Grid& grid = folder_.made().heightmap.grid;
  ASSERT_EQ(grid.nx, 64);
  for (const char* format : {"npy", "gsf", "exr", "tiff32"}) {
    const std::string why = said(format, [](Heightmap& h) { h(41, 20) += 10e-9; });
    const std::string place =
        fmt::format("({:.4g}, {:.4g}) um", 1e6 * grid.x(41), 1e6 * grid.y(20));
    EXPECT_TRUE(has(why, "1 of 4096 heights are off")) << format << why;
    EXPECT_TRUE(has(why, "by 10 nm at most, at " + place)) << format << why;
    EXPECT_FALSE(has(why, "upside down")) << why;
    EXPECT_FALSE(has(why, "critical dimension")) << why;
  }
}

TEST_F(Changed, HeightsAndSidesAreSaidInTheirUnits) {
  std::string why = said("gsf", [](Heightmap& h) {
    for (double& z : h.z) z *= 1.02;
  });
  EXPECT_TRUE(has(why, "its depth is 204 nm, the design's 200 nm: 2 % more")) << why;
  why = said("gsf", [](Heightmap& h) {
    for (double& z : h.z) z = -200e-9 - z;
  });
  EXPECT_TRUE(has(why, "it is upside down: what is deep is high")) << why;
  why = said("gsf", [](Heightmap& h) { h.grid.lx *= 1.5; });
  EXPECT_TRUE(has(why, "its width is 18 um, the design's 12 um: 50 % more")) << why;
  EXPECT_FALSE(has(why, "its height")) << why;
  why = said("gsf", [](Heightmap& h) { h.grid.ly *= 0.75; });
  EXPECT_TRUE(has(why, "its height is 9 um, the design's 12 um: 25 % less")) << why;
  why = said("tiff", [](Heightmap& h) { h.grid.ly *= 0.75; });
  EXPECT_TRUE(has(why, "its height by the TIFF tags is 9 um, the design's 12 um")) << why;
  why = said("npy", [](Heightmap& h) {
    h.grid.ny = 32;
    h.z.resize(h.grid.size());
  });
  EXPECT_TRUE(has(why, "64 x 32 pixels, the design's 64 x 64")) << why;
  why = said("gsf", [](Heightmap& h) {
    for (double& z : h.z) z = 0;
  });
  EXPECT_TRUE(has(why, "its depth is 0 nm, the design's 200 nm: 100 % less")) << why;
}

TEST_F(Changed, PicturesAreComparedLevelByLevel) {
  std::string why = said("dose", [](Heightmap& h) { h(3, 60) -= 300e-9; });
  EXPECT_TRUE(has(why, "levels differ from the design's")) << why;
  why = said("png", [](Heightmap& h) {
    h.grid.ny = 32, h.grid.ly *= 0.5;
    h.z.resize(h.grid.size());
  });
  EXPECT_TRUE(has(why, "512 x 316 pixels in 3 channels, the design's 512 x 572 in 3")) << why;
}

// By volume where the depth is another too: holes a tenth wider and a fifth deeper.
TEST_F(Changed, WidthsAreToldFromDepths) {
  HoleArray other = holes_of(6e-6, 3.3e-6);
  other.depth = 240e-9;
  const Heightmap made = generate(Texture{other}, folder_.made().heightmap.grid);
  const std::string why = said("gsf", [&](Heightmap& h) { h.z = made.z; });
  EXPECT_TRUE(has(why, "its depth is 240 nm, the design's 200 nm: 20 % more")) << why;
  EXPECT_TRUE(has(why, "its critical dimension (width of the holes) is 3.")) << why;
  const std::size_t at = why.find("um: ", why.find("width of the holes"));
  ASSERT_NE(at, std::string::npos) << why;
  EXPECT_NEAR(std::stod(why.substr(at + 4)), 10, 0.3) << why;  // per cent more
}

// By the area below half the depth where the depth is right, whatever the zero of the format.
TEST_F(Changed, WidthsOfHolesOfTheRightDepthAreThoseOfTheirPixels) {
  const Heightmap made = generate(Texture{holes_of(6e-6, 3.3e-6)}, folder_.made().heightmap.grid);
  const auto width = [](const Heightmap& h) {
    double deep = 0;
    for (const double z : h.z) deep += z < -100e-9;
    return 6 * std::sqrt(4 / kPi * deep / static_cast<double>(h.z.size()));  // um
  };
  const double is = width(made), design = width(folder_.made().heightmap);
  EXPECT_NEAR(is, 3.3, 0.5 * 12 / 64);  // half a pixel
  EXPECT_NEAR(design, 3, 0.5 * 12 / 64);
  for (const char* format : {"exr", "tiff32", "mask"}) {
    const std::string why = said(format, [&](Heightmap& h) { h.z = made.z; });
    EXPECT_TRUE(has(why, fmt::format("its critical dimension (width of the holes) is {:.4g} um, "
                                     "the design's {:.4g} um: {:.3g} % more",
                                     is, design, 100 * (is / design - 1))))
        << format << why;
    EXPECT_FALSE(has(why, "its depth")) << format << why;
  }
}

// Of a texture without equal features the area is said in per cent: 41 pixels more of 4096.
TEST(ChangedRough, TheAreaBelowHalfTheDepthIsSaidInPerCent) {
  const Workplace place;
  RandomRough rough;
  rough.rms = 30e-9;
  const Folder folder(place.path() / "f", Texture{rough}, Polarity::WhiteDeep);
  const std::string name = find_export_format("npy").file;
  Heightmap h = folder.made().heightmap;
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  const double middle = 0.5 * (*low + *high), top = *high;
  const auto share = [&] {
    double deep = 0;
    for (const double z : h.z) deep += z < middle;
    return 100 * deep / static_cast<double>(h.z.size());
  };
  ASSERT_EQ(h.z.size(), 4096u);
  const double design = share();
  int moved = 0;
  for (double& z : h.z) {
    if (z < middle || z == top || moved == 41) continue;
    z = middle - 1e-9;
    ++moved;
  }
  EXPECT_NEAR(share() - design, 1.001, 0.001);
  write_again({"npy", folder.path() + "/" + name}, h, folder.made().texture, folder.options());
  const FileVerdict verdict = verify_folder(folder.path(), name).at(0);
  ASSERT_EQ(verdict.faults.size(), 2u);
  EXPECT_EQ(verdict.faults[0], fmt::format("{:.4g} % of its area is below half the depth, of the "
                                           "design's {:.4g} %",
                                           share(), design));
  EXPECT_TRUE(verdict.faults[1].starts_with("41 of 4096 heights are off")) << verdict.faults[1];
}

// 300 nm of 2 um are 38.25 of 255 levels; a picture of one channel is no preview.
TEST_F(Changed, PicturesSayHowManyLevelsAreOffAndByHowMuch) {
  ASSERT_EQ(folder_.made().heightmap(0, 63), 0);  // land
  std::string why = said("dose", [](Heightmap& h) { h(0, 63) -= 300e-9; });
  EXPECT_EQ(why, "1 of 4096 levels differ from the design's, by 38 of 255 at most\n");
  // One level more or less is the rounding of another processor.
  const std::string dose = folder_.path() + "/" + find_export_format("dose").file;
  for (const auto& [by, state] : {std::pair{8e-9, FileState::Sound}, {16e-9, FileState::Differs}}) {
    Heightmap h = folder_.made().heightmap;
    h(0, 63) -= by;  // of 7.84 nm a level
    write_again({"dose", dose}, h, folder_.made().texture, folder_.options());
    EXPECT_EQ(verify_folder(folder_.path(), find_export_format("dose").file).at(0).state, state);
  }
  const std::string png = find_export_format("png").file;
  const Grid grid{512, 512, 12e-6, 12e-6};
  write_dose(folder_.path() + "/" + png, {grid, std::vector<double>(grid.size())},
             {{0, 1e-6}, {0, 255}});
  const FileVerdict grey = verify_folder(folder_.path(), png).at(0);
  ASSERT_EQ(grey.faults.size(), 1u);
  EXPECT_EQ(grey.faults[0], "512 x 512 pixels in 1 channels, the design's 512 x 572 in 3");
}

TEST(Differences, AreShownToTheDigitWhereTheyAre) {
  EXPECT_EQ(differs(101e-9, 100e-9, 1e-9, "nm"), "is 101 nm, the design's 100 nm: 1 % more");
  EXPECT_EQ(differs(99.99e-9, 100e-9, 1e-9, "nm"), "is 99.99 nm, the design's 100 nm: 0.01 % less");
  EXPECT_EQ(differs(6.0000012e-6, 6e-6, 1e-6, "um"),
            "is 6.0000012 um, the design's 6 um: 2e-05 % more");
  EXPECT_EQ(differs(2e-9, 0, 1e-9, "nm"), "is 2 nm, the design's 0");
}

}  // namespace
}  // namespace papilla::tests::drawn_test
