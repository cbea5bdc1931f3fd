#include "geometry/io/mask.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "base/random.h"
#include "fabricate/export.h"
#include "geometry/io/layout.h"
#include "geometry/texture.h"
#include "report/export.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::mask_test {
namespace {

FeatureArray array_of(const HoleArray& holes) {
  return std::get<FeatureArray>(facts(holes).outline);
}

TEST(PixelMargins, AreThoseOfHolesPillarsAndGrooves) {
  for (const auto& [period, width] : {std::pair{6e-6, 4.8e-6}, {4e-6, 1e-6}}) {
    HoleArray holes;
    holes.period = period, holes.diameter = width, holes.depth = 100e-9, holes.wall_angle = kPi / 2;
    Grating grooves;
    grooves.period = period, grooves.width = width, grooves.depth = 100e-9;
    grooves.wall_angle = kPi / 2;
    PillarArray pillars;
    pillars.period = period, pillars.diameter = width, pillars.height = 100e-9;
    pillars.wall_angle = kPi / 2;
    for (const Texture& texture : {Texture{holes}, Texture{grooves}, Texture{pillars}}) {
      const Heightmap h = generate(texture, patch_grid(texture, 192, 2 * period));
      const PixelMargins found = measure_margins(h);
      const FabricationMargins want = facts(texture).margins;
      EXPECT_NEAR(found.min_hole, want.min_hole, 1.6 * found.pixel)
          << texture_name(texture) << width;
      EXPECT_NEAR(found.min_wall, want.min_wall, 1.6 * found.pixel)
          << texture_name(texture) << width;
    }
  }
  EXPECT_EQ(measure_margins(generate({}, patch_grid({}, 32))).min_hole, kInfinity);
}

// Two round holes that run into one another: the line through both of their crossings is the neck,
// whichever way it lies.
TEST(PixelMargins, AShortNeckBetweenTwoHolesIsTheirNarrowestPlace) {
  const double radius = 3e-6;
  for (const double apart : {4.4e-6, 4.8e-6}) {
    for (const bool upright : {false, true}) {
      Heightmap h{upright ? Grid{150, 200, 12e-6, 20e-6} : Grid{200, 150, 20e-6, 12e-6}, {}};
      h.z.assign(h.grid.size(), 0);
      const double x = 0.5 * h.grid.lx, y = 0.5 * h.grid.ly;
      for (int iy = 0; iy < h.grid.ny; ++iy) {
        for (int ix = 0; ix < h.grid.nx; ++ix) {
          const double along =
                           upright ? (iy + 0.5) * h.grid.dy() - y : (ix + 0.5) * h.grid.dx() - x,
                       across =
                           upright ? (ix + 0.5) * h.grid.dx() - x : (iy + 0.5) * h.grid.dy() - y;
          if (std::hypot(std::abs(along) - 0.5 * apart, across) < radius) h(ix, iy) = -100e-9;
        }
      }
      const double neck = 2 * std::sqrt(radius * radius - 0.25 * apart * apart);
      const PixelMargins found = measure_margins(h);
      EXPECT_NEAR(found.min_hole, neck, 1.6 * found.pixel) << apart << upright;
    }
  }
}

TEST(PixelMargins, DistancesAreThoseOfEveryPair) {
  const Grid grid{24, 17, 24e-6, 34e-6};
  RandomStream random(5, "mask test", 0);
  std::vector<std::uint8_t> set(grid.size());
  for (auto& s : set) s = random.uniform() < 0.97;
  const std::vector<double> d = distance_inside(grid, set);
  for (int y = 0; y < grid.ny; ++y) {
    for (int x = 0; x < grid.nx; ++x) {
      double best = set[grid.index(x, y)] ? kInfinity : 0;
      for (int v = -grid.ny; v < 2 * grid.ny; ++v) {
        for (int u = -grid.nx; u < 2 * grid.nx; ++u) {
          if (!set[grid.index(wrap(u, grid.nx), wrap(v, grid.ny))])
            best = std::min(best, std::hypot((u - x) * grid.dx(), (v - y) * grid.dy()));
        }
      }
      ASSERT_NEAR(d[grid.index(x, y)], best, 1e-12);
    }
  }
}

double area_of(const Polygon& p) {
  double sum = 0;
  for (std::size_t i = 0; i < p.x.size(); ++i) {
    const std::size_t j = (i + 1) % p.x.size();
    sum += static_cast<double>(p.x[i]) * p.y[j] - static_cast<double>(p.x[j]) * p.y[i];
  }
  return 0.5e-18 * std::abs(sum);
}

TEST(GdsMask, PolygonsCoverTheAreaBelowTheLevel) {
  HoleArray holes;
  holes.diameter = 4.5e-6;
  const Texture texture{holes};
  const Heightmap h = generate(texture, patch_grid(texture, 256));
  double area = 0;
  for (const Polygon& p : polygons_below(h, -0.5 * holes.depth)) area += area_of(p);
  EXPECT_NEAR(area / h.grid.area(), facts(texture).open_share.value(), 0.005);
}

// One low pixel, centred at (18, 12) nm: the level crosses a third of the way to its right
// neighbour, (22, 12) nm, and a twentieth of the way to the one beyond its corner, (18.6, 12.4) nm,
// which the grid of 1 nm puts onto the same line.
TEST(GdsMask, PolygonsOfNoAreaAreLeftOut) {
  Heightmap h{{3, 3, 36e-9, 24e-9}, std::vector<double>(9, 19e-9)};
  h(1, 1) = -1e-9;
  h(2, 1) = h(1, 0) = 2e-9;
  const std::vector<Polygon> polygons = polygons_below(h, 0);
  EXPECT_FALSE(polygons.empty());
  for (const Polygon& p : polygons)
    EXPECT_GT(area_of(p), 0) << p.x[0] << " " << p.y[0] << " of " << p.x.size();
}

TEST(LayoutArray, APeriodOffTheGridIsRefusedAndFacetsKeepTheirError) {
  HoleArray holes;
  holes.period = 6.0004e-6;
  EXPECT_THROW(draw_array(array_of(holes), 1e-4, 1e-4), InputError);
  holes.period = 6e-6;
  const LayoutArray fine = draw_array(array_of(holes), 1e-4, 1e-4, 1e-9).array;
  const LayoutArray coarse = draw_array(array_of(holes), 1e-4, 1e-4, 50e-9).array;
  EXPECT_GT(fine.sides, 2 * coarse.sides);
  for (const auto& [array, error] : {std::pair{fine, 1e-9}, {coarse, 50e-9}})
    EXPECT_LE(0.5 * holes.diameter * (1 - std::cos(kPi / array.sides)), error);
  EXPECT_EQ(fine.drift, 0);
}

// pi / acos(1 - error / radius), in fours, 8 to 1024: 60.8, 19.2, 1217 and 3 for 3 um.
TEST(LayoutArray, CirclesHaveSidesInFoursWithinTheirBounds) {
  HoleArray holes;
  holes.diameter = 3e-6;
  for (const auto& [error, sides] :
       {std::pair{2e-9, 64}, {20e-9, 20}, {5e-12, 1024}, {1.5e-6, 8}, {1.0, 8}})
    EXPECT_EQ(draw_array(array_of(holes), 1e-4, 1e-4, error).array.sides, sides) << error;
}

TEST(ExportedFiles, AllHaveThePeriodThatALayoutCanHold) {
  Study study;
  Design& design = study.design;
  HoleArray holes;
  holes.period = 7997.3636e-9;
  design.texture.kind = holes;
  ExportOptions options;
  options.pixels = 256;
  const std::string folder = temporary("snapped");
  const Export out = export_with_record(study, options, folder);  // the default formats
  EXPECT_TRUE(std::filesystem::exists(folder + "/texture.gds"));
  EXPECT_TRUE(std::filesystem::exists(folder + "/export.json"));
  EXPECT_NEAR(out.heightmap.grid.lx / out.cells_x, 7997e-9, 1e-15);
  ASSERT_EQ(out.warnings.size(), 1u);
  EXPECT_NE(out.warnings[0].find("7997 nm, 0.36 nm (0.0045 %) less"), std::string::npos)
      << out.warnings[0];
  options.formats = {"npy"};  // nothing asks for whole nanometres
  const Export maps = export_design(design, options, folder);
  EXPECT_NEAR(maps.heightmap.grid.lx / maps.cells_x, holes.period, 1e-15);
  EXPECT_TRUE(maps.warnings.empty());
}

TEST(ExportedFiles, PixelsTooLargeForAWallAreSaidWithThoseThatWouldDo) {
  Design design;
  HoleArray holes;
  holes.period = 3e-6;
  holes.diameter = 2.54e-6;  // walls of 0.46 um, half-way down their 88 deg of 0.472 um
  design.texture.kind = holes;
  ExportOptions options;
  options.formats = {"npy"};
  options.size = 120e-6;
  options.pixels = 512;  // 234 nm
  const std::string folder = temporary("coarse");
  const Export coarse = export_design(design, options, folder);
  ASSERT_EQ(coarse.warnings.size(), 1u);
  EXPECT_NE(coarse.warnings[0].find("--pixels 1018 would do"), std::string::npos)
      << coarse.warnings[0];
  options.pixels = 1018;
  EXPECT_TRUE(export_design(design, options, folder).warnings.empty());
  options.formats = {"gds"};  // has no pixels
  options.pixels = 512;
  EXPECT_TRUE(export_design(design, options, folder).warnings.empty());
}

TEST(LayoutArray, HexagonsKeepTheirPlacesOverTheWholeArea) {
  HoleArray holes;
  holes.lattice = Lattice::Hexagonal;
  for (const double period : {6e-6, 2.345e-6, 10e-6, 0.731e-6}) {
    holes.period = period;
    holes.diameter = 0.4 * period;
    for (const double size : {period, 1e-4, 15e-3}) {
      const auto [layout, a] = draw_array(array_of(holes), size, size);
      write_gds(temporary("c.gds"), layout);
      EXPECT_LE(a.drift, 0.5e-9) << period << " " << size;
      EXPECT_NEAR(a.pitch_y * static_cast<double>(a.rows),
                  std::sqrt(3.0) * period * static_cast<double>(a.rows), 1e-9);
      EXPECT_LT(std::filesystem::file_size(temporary("c.gds")), 20000u);
    }
  }
}

TEST(Dose, IsTheInverseOfTheCurveAndCountsWhatItClips) {
  const std::string path = temporary("curve.csv");
  std::ofstream(path) << "depth_nm,grey\n0,10\n100,60\n300,255\n";
  const DoseCurve curve = read_dose_curve(path);
  Heightmap h{{4, 1, 4e-6, 1e-6}, {0, -50e-9, -200e-9, -400e-9}};
  const DoseMap dose = write_dose(temporary("dose.png"), h, curve);
  EXPECT_EQ(dose.lowest, 10);
  EXPECT_EQ(dose.highest, 255);
  EXPECT_EQ(dose.deep, 1u);
  EXPECT_EQ(dose.shallow, 0u);
  // Of another system, with a note above its heading.
  std::ofstream(path, std::ios::binary)
      << "# of the writer\r\n\r\ndepth_nm,grey\r\n0,10\r\n100,60\r\n";
  EXPECT_EQ(read_dose_curve(path).grey, (std::vector<double>{10, 60}));
  std::ofstream(path) << "depth_nm,grey\n0,10\n100,60\n80,255\n";
  EXPECT_THROW(read_dose_curve(path), InputError);
  for (const char* wrong : {"0,10\n100,word\n", "0,10\n100,256\n", "0,-1\n100,20\n",
                            "0,10\n-1,20\n", "0,10\n2e9,20\n", "0,10\n", "0,10\n100,60\n200,60\n",
                            "0,10\n100,60\n100,70\n", "0,90\n100,60\n200,70\n", "0;10\n100;20\n"}) {
    std::ofstream(path) << wrong;
    EXPECT_THROW(read_dose_curve(path), InputError) << wrong;
  }
}

TEST(Dose, AHeadingSaysTheUnitAndTheOrder) {
  const std::string path = temporary("headed.csv");
  for (const char* table : {"depth_um,grey\n0,10\n0.35,255\n", "grey,depth_nm\n10,0\n255,350\n",
                            "depth,grey\n0,10\n350,255\n"}) {
    std::ofstream(path) << table;
    const DoseCurve curve = read_dose_curve(path);
    ASSERT_EQ(curve.depth.size(), 2u) << table;
    EXPECT_NEAR(curve.depth[1], 350e-9, 1e-16) << table;
    EXPECT_EQ(curve.grey, (std::vector<double>{10, 255})) << table;
  }
  std::ofstream(path) << "x,dose\n0,10\n350,255\n";
  EXPECT_THROW(read_dose_curve(path), InputError);
}

TEST(Dose, TwoLinesAreACurve) {
  const std::string path = temporary("two.csv");
  std::ofstream(path) << "0,10\n100,60\n";
  const DoseCurve curve = read_dose_curve(path);
  EXPECT_EQ(curve.grey, (std::vector<double>{10, 60}));
}

// Rows from the top; half a nanometre beyond either end is the end.
TEST(Dose, IsThatOfEachPixelFromTheTopRowOn) {
  const Heightmap h{{3, 2, 3e-6, 2e-6}, {0, -99.6e-9, -100e-9, -200e-9, -300.4e-9, -301e-9}};
  DoseMap dose;
  const std::vector<std::uint8_t> grey = dose_levels(h, {{100e-9, 300e-9}, {60, 160}}, dose);
  EXPECT_EQ(grey, (std::vector<std::uint8_t>{110, 160, 160, 60, 60, 60}));
  EXPECT_EQ(dose.shallow, 1u);
  EXPECT_EQ(dose.deep, 1u);
  EXPECT_EQ(dose.lowest, 60);
  EXPECT_EQ(dose.highest, 160);
}

// Deep is dark, or the table runs upwards: the same curve.
TEST(Dose, ACurveMayFallAndBeWrittenFromItsEnd) {
  const std::string path = temporary("falling.csv");
  std::ofstream(path) << "# resist\n300,5\n100,60\n0,250\n";
  const DoseCurve curve = read_dose_curve(path);
  ASSERT_EQ(curve.depth.size(), 3u);
  const std::vector<double> depth{0, 100e-9, 300e-9};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(curve.depth[i], depth[i], 1e-18);
  EXPECT_EQ(curve.grey, (std::vector<double>{250, 60, 5}));
  const Heightmap h{{3, 1, 3e-6, 1e-6}, {0, -200e-9, -50e-9}};
  const DoseMap dose = write_dose(temporary("falling.png"), h, curve);
  EXPECT_NEAR(dose.lowest, 32, 1);  // half way from 60 to 5
  EXPECT_EQ(dose.highest, 250);
}

TEST(ProcessBias, IsUndoneInTheFile) {
  HoleArray holes;
  holes.edge_radius = 100e-9;
  const Texture out = compensated(Texture{holes}, {50e-9, 80e-9});
  EXPECT_NEAR(std::get<HoleArray>(out.kind).diameter, holes.diameter + 100e-9, 1e-15);
  EXPECT_NEAR(std::get<HoleArray>(out.kind).edge_radius, 20e-9, 1e-15);
  EXPECT_THROW(compensated(Texture{PillarArray{}}, {2e-6, 0}), InputError);
  EXPECT_THROW(compensated(Texture{HoleArray{}}, {2e-6, 0}), InputError);  // holes would meet
  EXPECT_THROW(compensated(Texture{RandomRough{}}, {1e-9, 0}), InputError);
}

std::string refusal(const Texture& texture, const char* format) {
  Design design;
  design.texture = texture;
  ExportOptions options;
  options.formats = {format};
  options.polarity = Polarity::WhiteDeep;
  options.pixels = 32;
  return refusal_of([&] { export_design(design, options, temporary("drawn")); });
}

TEST(Outlines, OfARoughSurfaceThereAreNoneAndTheRefusalSaysWhatToTake) {
  for (const Texture& texture : {Texture{RandomRough{}}, Texture{ParticleFilm{}}}) {
    for (const char* format : {"gds", "mask"}) {
      const std::string why = refusal(texture, format);
      EXPECT_NE(why.find("has no outline"), std::string::npos) << why;
      EXPECT_NE(why.find("take its heights"), std::string::npos) << why;
    }
    EXPECT_EQ(refusal(texture, "npy"), "");
  }
  EXPECT_NE(refusal(Texture{HoleArray{.depth = 0}}, "gds").find("flat, there are no outlines"),
            std::string::npos);
  Stack stack;
  stack.parts = {Texture{HoleArray{}}, Texture{RandomRough{.rms = 5e-9}}};
  EXPECT_EQ(refusal(Texture{stack}, "gds"), "");
}

}  // namespace
}  // namespace papilla::tests::mask_test
