// Which files an export writes, why not the others, what the process leaves of a feature, and what
// is said where a dose does not reach.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/error.h"
#include "fabricate/export.h"
#include "fabricate/formats.h"
#include "tests/io/address_limit.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::chosen_files_test {
namespace {

std::string names(const Texture& texture, const ExportOptions& options) {
  std::string out;
  for (const ExportFormat& format : chosen_formats(texture, options))
    out += std::string(format.name) + " ";
  return out;
}

// Those that a polarity, a curve and an outline allow, in the order of the table.
TEST(ChosenFiles, AreAllThatTheTextureAndTheOptionsAllow) {
  const Texture holes{HoleArray{}}, rough{RandomRough{}}, waves{Waves{}}, flat{};
  ExportOptions options;
  EXPECT_EQ(names(holes, options), "exr gsf npy png gds ");
  EXPECT_EQ(names(rough, options), "exr gsf npy png ");
  EXPECT_EQ(names(waves, options), "exr gsf npy png ");
  EXPECT_EQ(names(flat, options), "exr gsf npy png ");
  options.polarity = Polarity::WhiteHigh;
  EXPECT_EQ(names(holes, options), "exr tiff mask gsf npy png gds ");
  EXPECT_EQ(names(rough, options), "exr tiff gsf npy png ");
  EXPECT_EQ(names(waves, options), "exr tiff mask gsf npy png ");  // contours are on request
  EXPECT_EQ(names(flat, options), "exr tiff mask gsf npy png ");
  options.dose_curve = DoseCurve{{0, 1e-6}, {0, 255}};
  EXPECT_EQ(names(holes, options), "exr tiff mask gsf npy png gds dose ");
  options.levels = 3;
  EXPECT_EQ(names(rough, options), "exr tiff gsf npy png dose ");
  options.formats = {"oasis", "stl", "x3p", "png16", "tiff32", "oasis"};
  EXPECT_EQ(names(holes, options), "oasis stl x3p png16 tiff32 ");  // one file of each
}

TEST(ChosenFiles, SayWhatTheyNeed) {
  const auto why = [](const Texture& texture, const char* format, int levels = 1) {
    ExportOptions options;
    options.formats = {format};
    options.levels = levels;
    return refusal_of([&] { chosen_formats(texture, options); });
  };
  const Texture holes{HoleArray{}}, rough{RandomRough{}};
  EXPECT_EQ(why(holes, "dose"), "format \"dose\" needs --dose-curve, a CSV of depth_nm,grey");
  for (const char* format : {"tiff", "mask"})
    EXPECT_EQ(why(holes, format), std::string("format \"") + format +
                                      "\" needs a polarity: white-high (bright is high) or "
                                      "white-deep (bright is deep)");
  for (const char* format : {"gds", "oasis", "mask"}) {
    EXPECT_EQ(why(rough, format),
              std::string("format \"") + format +
                  "\": a random rough surface has no outline: its heights vary gradually, none of "
                  "them parts deep from high; take its heights, exr, tiff, gsf, npy, x3p or stl, "
                  "or a dose map; `--format gds --levels 3` draws its contour lines");
  }
  EXPECT_EQ(why(rough, "gds", 2), "");
  EXPECT_EQ(why(rough, "oasis", 2), "");
  EXPECT_NE(why(rough, "mask", 2), "");
  const std::string flat = "the surface is flat, there are no outlines to write";
  EXPECT_EQ(why(Texture{}, "gds"), "format \"gds\": " + flat);
  EXPECT_EQ(why(Texture{}, "gds", 2), "format \"gds\": " + flat);
  EXPECT_EQ(why(Texture{HoleArray{.depth = 0}}, "oasis"), "format \"oasis\": " + flat);
  EXPECT_EQ(why(holes, "jpeg").substr(0, 33), "unknown format \"jpeg\"; known: exr");
}

TEST(ChosenFiles, TheMostExactHeightsAreSimulatedAgain) {
  const auto file = [](const std::vector<std::string>& formats) {
    std::vector<ExportedFile> files;
    for (const std::string& format : formats) files.push_back({format, "f/" + format});
    return heights_file(files);
  };
  EXPECT_EQ(file({"tiff", "tiff32", "gsf", "exr"}), "f/exr");
  EXPECT_EQ(file({"tiff", "tiff32", "gsf"}), "f/gsf");
  EXPECT_EQ(file({"tiff", "npy", "tiff32"}), "f/tiff32");
  EXPECT_EQ(file({"mask", "tiff"}), "f/tiff");
  EXPECT_EQ(refusal_of([&] {
              file({"mask", "npy", "gds"});
            }),
            "no file of heights to simulate: needs exr, gsf, tiff32 or tiff");
}

TEST(ChosenFiles, HaveTheirNamesInTheFolder) {
  const std::string folder = temporary("chosen");
  Design design;
  design.texture = Texture{HoleArray{}};
  ExportOptions options;
  options.pixels = 32;
  std::string all;
  for (const ExportedFile& file : export_design(design, options, folder).files)
    all += file.format + " " + file.path.substr(folder.size()) + "\n";
  EXPECT_EQ(all,
            "exr /heightmap.exr\ngsf /heightmap.gsf\nnpy /heightmap.npy\npng /preview.png\ngds "
            "/texture.gds\n");
  EXPECT_EQ(info_of(design).title, "papilla heightmap");
  EXPECT_EQ(info_of(design).comment, "hole_array");
  design.title = "mine";
  EXPECT_EQ(info_of(design).title, "mine");
}

// Contours tell their polygons and levels, an array its cells.
TEST(ChosenFiles, ALayoutTellsWhatItHolds) {
  Design design;
  design.texture = Texture{HoleArray{.period = 6e-6}};
  ExportOptions options;
  options.formats = {"gds"};
  options.size = 30e-6, options.pixels = 64;
  Export out = export_design(design, options, temporary("holds"));
  ASSERT_TRUE(out.array && !out.contours);
  EXPECT_EQ(out.array->columns, 5);
  EXPECT_EQ(out.array->rows, 5);
  EXPECT_EQ(out.cells_x, 5);
  EXPECT_EQ(out.cells_y, 5);
  design.texture = Texture{Waves{.period = 6e-6}};
  options.levels = 3;
  out = export_design(design, options, temporary("holds"));
  ASSERT_TRUE(out.contours && !out.array);
  EXPECT_EQ(out.contours->levels, 3);
  EXPECT_EQ(out.contours->polygons,
            draw_contours(out.heightmap, 3, edge_planes(out.texture, out.heightmap))
                .cells.back()
                .polygons.size());
}

// Pixels of 0, 10 to 40 nm of depth, of each a fifth, or as many as a curve reaches.
TEST(ChosenFiles, PixelsBeyondTheDoseCurveAreSaidInPerCent) {
  const Heightmap h{{5, 1, 5e-6, 1e-6}, {0, -10e-9, -20e-9, -30e-9, -40e-9}};
  const auto written = [&](double from, double to) {
    ExportOptions options;
    options.dose_curve = DoseCurve{{from, to}, {10, 200}};
    Export out;
    const Texture texture{HoleArray{}};
    const FileInfo info;
    const std::function<void(double)> quiet;
    find_export_format("dose").write({h, texture, options, info, quiet}, temporary("d.png"), out);
    EXPECT_TRUE(out.dose);
    EXPECT_LE(out.warnings.size(), 1u);
    return out.warnings.empty() ? std::string() : out.warnings[0];
  };
  const auto words = [](const std::string& deep, const std::string& shallow) {
    return "the dose curve does not reach all depths: " + deep +
           " % of the pixels are deeper than its end, " + shallow +
           " % shallower than its start; they get the dose of that end";
  };
  EXPECT_EQ(written(0, 40e-9), "");
  EXPECT_EQ(written(0, 25e-9), words("40", "0"));
  EXPECT_EQ(written(15e-9, 40e-9), words("0", "40"));
  EXPECT_EQ(written(5e-9, 15e-9), words("60", "20"));
}

// --- what the process moves ---

TEST(Process, MovesBothWallsAndRoundsTheRims) {
  const auto holes = [](const ProcessBias& bias) {
    return std::get<HoleArray>(
        compensated(Texture{HoleArray{.diameter = 3e-6, .edge_radius = 50e-9}}, bias).kind);
  };
  EXPECT_NEAR(holes({30e-9, 20e-9}).diameter, 3.06e-6, 1e-18);
  EXPECT_NEAR(holes({30e-9, 20e-9}).edge_radius, 30e-9, 1e-20);
  EXPECT_EQ(holes({0, 60e-9}).edge_radius, 0);
  EXPECT_NEAR(holes({-30e-9, 0}).diameter, 2.94e-6, 1e-18);
  const auto pillars = [](double shrink) {
    return std::get<PillarArray>(
               compensated(Texture{PillarArray{.diameter = 3e-6}}, {shrink, 0}).kind)
        .diameter;
  };
  EXPECT_NEAR(pillars(30e-9), 2.94e-6, 1e-18);
  EXPECT_NEAR(pillars(-30e-9), 3.06e-6, 1e-18);
  const Texture grooves{Grating{.period = 6e-6, .width = 2e-6}};
  EXPECT_NEAR(std::get<Grating>(compensated(grooves, {50e-9, 0}).kind).width, 2.1e-6, 1e-18);
}

TEST(Process, ThatLeavesNothingOrMovesWhatHasNoWallsIsRefused) {
  const auto why = [](const Texture& texture, const ProcessBias& bias) {
    return refusal_of([&] { compensated(texture, bias); });
  };
  const Texture pillars{PillarArray{.diameter = 3e-6}};
  EXPECT_EQ(why(pillars, {1.499e-6, 0}), "");
  EXPECT_EQ(why(pillars, {1.5e-6, 0}), "process bias: nothing is left of the features");
  EXPECT_EQ(why(Texture{HoleArray{.diameter = 3e-6}}, {-1.6e-6, 0}),
            "process bias: nothing is left of the features");
  EXPECT_EQ(why(Texture{HoleArray{.period = 6e-6, .diameter = 5.9e-6}}, {60e-9, 0}),
            "process bias: texture.diameter: 6.02 um is not smaller than the period 6 um; features "
            "would overlap");
  const std::string walls = "process bias is for holes, pillars and grooves, not \"waves\"";
  EXPECT_EQ(why(Texture{Waves{}}, {1e-9, 0}), walls);
  EXPECT_EQ(why(Texture{Waves{}}, {0, 1e-9}), walls);
  EXPECT_EQ(why(Texture{Waves{}}, {}), "");
}

// The heights, the encoded file, and both again: 32 bytes a pixel.
TEST(Exports, OfMoreHeightsThanTheMemoryHoldsAreRefused) {
  if (!kAddressesAreFree) GTEST_SKIP() << "the sanitizer has the addresses";
  Design design;
  ExportOptions options;
  options.formats = {"npy"};
  options.pixels = 10036;
  const auto prepare = [&] {
    const AddressLimit limit(3.0 * (1 << 30));
    prepare_export(design, options);
  };
  EXPECT_EQ(refusal_of(prepare),
            "a heightmap of 10036 x 10036 pixels needs 3 GiB of memory; 3 GiB are there");
}

}  // namespace
}  // namespace papilla::tests::chosen_files_test
