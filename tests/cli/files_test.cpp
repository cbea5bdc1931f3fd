// Files that go to a maker and maps that come from an instrument, by the program itself.
#include "base/files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/constants.h"
#include "geometry/io/drawing.h"
#include "geometry/io/files.h"
#include "geometry/roughness.h"
#include "tests/cli/program.h"

namespace papilla::tests::files_test {
namespace {

const std::string kHoles = PAPILLA_SOURCE_DIR "/designs/m3_samples/a3h600.toml";
using nlohmann::json;

// --- names ---

// Of a folder that has no such file the shipped one, in every command; the user's own comes first.
TEST(ShippedNames, AreFoundFromAnyFolder) {
  const Workplace place;
  const std::string draft = "--set 'accuracy.level=\"draft\"' --set accuracy.grid=32 --no-model";
  EXPECT_EQ(place.run("explain m3_samples/flat.toml").status, 0);
  const Outcome shipped = place.run("evaluate m3_samples/flat.toml --json " + draft);
  ASSERT_EQ(shipped.status, 0) << shipped.err;
  EXPECT_EQ(place.run("explain nowhere/flat.toml").status, 2);
  std::filesystem::create_directories(place.path() / "m3_samples");
  std::ofstream(place.path() / "m3_samples/flat.toml") << "schema_version = 2\n";
  EXPECT_EQ(place.run("explain m3_samples/flat.toml").status, 2);
}

// --- what was set ---

TEST(ExportCommand, CallsTheFilesOfADesignByWhatWasSetOfIt) {
  const Workplace place;
  const std::string how = "export " + kHoles + " --format gsf --pixels 64 --out ";
  ASSERT_EQ(place.run(how + "own").status, 0);
  ASSERT_EQ(place.run(how + "deep --set texture.depth=606nm").status, 0);
  const auto title = [&](const std::string& folder) {
    return json::parse(file_text(place.path() / folder / "export.json"))["title"]
        .get<std::string>();
  };
  EXPECT_EQ(title("deep"), title("own") + "; texture.depth 606 nm");
  EXPECT_NE(file_text(place.path() / "deep/heightmap.gsf").find("; texture.depth 606 nm\n"),
            std::string::npos);
  EXPECT_EQ(place.run("verify deep --geometry").status, 0);  // its record has the same title
}

// --- verify ---

TEST(VerifyCommand, RefusesOfAWaferWhatIsOfRunsAndExports) {
  const Workplace place;
  place.write("w/wafer.toml", "schema_version = 1\n");
  for (const std::string option :
       {"--receipt r99", "--time banana", "--tolerance '1 %'", "--jobs 2", "--geometry"}) {
    const Outcome run = place.run("verify w " + option);
    EXPECT_EQ(run.status, 2) << option;
    EXPECT_NE(run.err.find(option.substr(0, option.find(' ')) + " is of runs and exports"),
              std::string::npos)
        << run.err;
  }
}

TEST(VerifyCommand, NamesTheFileThatWasSwappedAndTheOneThatWasCutOff) {
  const Workplace place;
  const std::string how = " --pixels 64 --polarity white-deep --out ";
  ASSERT_EQ(place.run("export " + kHoles + how + "out").status, 0);
  ASSERT_EQ(
      place.run("export " + kHoles + " --set 'texture.depth=\"606 nm\"'" + how + "deep").status, 0);
  const Outcome sound = place.run("verify out --geometry");
  EXPECT_EQ(sound.status, 0) << sound.err;
  EXPECT_EQ(sound.err, "");
  std::filesystem::copy_file(place.path() / "deep/heightmap.gsf",
                             place.path() / "out/heightmap.gsf",
                             std::filesystem::copy_options::overwrite_existing);
  const Outcome swapped = place.run("verify out --geometry");
  EXPECT_EQ(swapped.status, 1);
  EXPECT_NE(
      swapped.err.find("out/heightmap.gsf: its depth is 606 nm, the design's 600 nm: 1 % more"),
      std::string::npos)
      << swapped.err;
  EXPECT_EQ(swapped.err.find("heightmap.exr"), std::string::npos) << swapped.err;
  EXPECT_EQ(place.run("verify out/heightmap.exr --geometry").status, 0);
  std::filesystem::resize_file(place.path() / "out/mask.tif", 1000);
  const Outcome cut = place.run("verify out --geometry --json");
  EXPECT_EQ(cut.status, 2);
  const auto verdict = json::parse(cut.out);
  EXPECT_FALSE(verdict["sound"]);
  for (const auto& file : verdict["folders"][0]["files"]) {
    const std::string name = file["file"];
    EXPECT_EQ(file["state"], name == "mask.tif"        ? "unreadable"
                             : name == "heightmap.gsf" ? "differs"
                                                       : "sound")
        << name;
  }
}

TEST(VerifyCommand, SimulatesWhatWasWrittenAndRefusesOtherFolders) {
  const Workplace place;
  ASSERT_EQ(place.run("export " + kHoles + " --format exr --pixels 64 --out out").status, 0);
  const Outcome felt = place.run("verify out --tolerance '20 %'");
  EXPECT_EQ(felt.status, 0) << felt.err;
  EXPECT_NE(felt.out.find("mean(modulation)"), std::string::npos) << felt.out;
  std::filesystem::remove(place.path() / "out/export.json");
  const Outcome none = place.run("verify out");
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("nothing says what the files should hold"), std::string::npos)
      << none.err;
  EXPECT_EQ(place.run("verify nowhere").status, 2);
}

// --- masks, rectangles, OASIS ---

TEST(ExportMask, OfPixelsWiderThanHalfAHoleIsRefusedWithWhatWouldDo) {
  const Workplace place;
  const std::string far = "export " + kHoles + " --size '1 mm' --pixels 256 --out out ";  // 3.9 um
  const Outcome mask = place.run(far + "--polarity white-deep");
  EXPECT_EQ(mask.status, 2);
  EXPECT_NE(mask.err.find("more than half the smallest hole or wall"), std::string::npos)
      << mask.err;
  EXPECT_NE(mask.err.find("--pixels 1336 would do"), std::string::npos) << mask.err;
  EXPECT_EQ(place.entries(), 0);
  // Heights are means over a pixel: they are written, and called what they are.
  const Outcome heights = place.run(far + "--format exr");
  EXPECT_EQ(heights.status, 1);
  EXPECT_NE(heights.err.find("edges are lost between its pixels"), std::string::npos)
      << heights.err;
  const Outcome enough = place.run("export " + kHoles +
                                   " --size '100 um' --pixels 256 --polarity white-deep --out out");
  EXPECT_EQ(enough.status, 0) << enough.err;
}

TEST(ExportSize, OfARectangleIsThatOfItsPeriods) {
  const Workplace place;
  for (const std::string size : {"'110x62 um'", "'110 um x 62um'", "'0.11 mm × 62 um'"}) {
    const Outcome run =
        place.run("export " + kHoles + " --pixels 440 --format npy,gds,oasis --out out" +
                  " --json --size " + size);
    ASSERT_EQ(run.status, 0) << run.err;
    const auto made = json::parse(run.out);
    EXPECT_NEAR(made["size"][0].get<double>(), 108e-6, 1e-12);  // 18 and 10 periods of 6 um
    EXPECT_NEAR(made["size"][1].get<double>(), 60e-6, 1e-12);
    EXPECT_EQ(made["pixels"][0], 440);
    EXPECT_EQ(made["pixels"][1], 244);
    EXPECT_EQ(made["layout"]["columns"], 18);
    EXPECT_EQ(made["layout"]["rows"], 10);
    EXPECT_NE(run.err.find("110 x 62 um were asked for, 108 x 60 um are written"),
              std::string::npos)
        << run.err;
    EXPECT_EQ(place.run("verify out --geometry").status, 0);
  }
  for (const std::string size :
       {"'x62 um'", "'110x um'", "'110x-2 um'", "'110x62'", "'3x2x1 um'", "'10x1000000 um'"})
    EXPECT_EQ(place.run("export " + kHoles + " --format npy --out out --size " + size).status, 2)
        << size;
}

TEST(ExportOasis, HoldsInOneArrayWhatGdsiiHoldsInParts) {
  const Workplace place;
  const std::string wide = "export " + kHoles + " --pixels 8 --size '250x2 mm' --out out --format ";
  const Outcome gds = place.run(wide + "gds");
  EXPECT_EQ(gds.status, 0) << gds.err;
  const std::string bytes = read_bytes((place.path() / "out/texture.gds").string());
  for (const char* columns : {"\x7f\xff", "\x22\xc4"})  // 32767 and 8900 in records of their own
    EXPECT_NE(bytes.find(std::string("\x00\x08\x13\x02", 4) + columns), std::string::npos);
  const Outcome oasis = place.run(wide + "oasis");
  ASSERT_EQ(oasis.status, 0) << oasis.err;
  const std::string file = (place.path() / "out/texture.oas").string();
  EXPECT_LT(std::filesystem::file_size(file), 1000u);
  const Layout layout = read_oasis(file);
  ASSERT_EQ(layout.cells.back().references.size(), 1u);
  EXPECT_EQ(layout.cells.back().references[0].columns, 41667);
  EXPECT_EQ(layout.cells.back().references[0].step_x, 6000);
}

// --- scans ---

// A rough map as an instrument gives it: tilted, one pixel far off, some without a height.
struct Instrument {
  double tilt = 0, spike = 0;
  int missing = 0;
};

std::string scan(const Workplace& place, const std::string& name, const Instrument& of) {
  const Grid grid{128, 128, 16e-6, 16e-6};
  Heightmap h =
      random_surface({.rms = 40e-9, .roll_off = 3e-6, .hurst = 0.8, .cutoff = 0.3e-6}, grid, 11, 0);
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) h(ix, iy) += of.tilt * grid.x(ix);
  }
  if (of.spike != 0) h(64, 80) = of.spike;
  for (int i = 0; i < of.missing; ++i) h(20 + i, 31) = std::numeric_limits<double>::quiet_NaN();
  write_gsf((place.path() / name).string(), h, {});
  return name;
}

const std::string kPress = " --pressure '2 MPa' --modulus '53 MPa' --json --height ";

double contact(const Workplace& place, const std::string& file) {
  const Outcome run = place.run("solve contact" + kPress + file);
  EXPECT_EQ(run.status, 0) << run.err;
  return json::parse(run.out)["area_fraction"];
}

TEST(Scans, AreLevelledAndMendedBeforeTheyArePressed) {
  const Workplace place;
  const double level = contact(place, scan(place, "level.gsf", {}));
  EXPECT_NEAR(contact(place, scan(place, "tilted.gsf", {.tilt = 0.02})), level, 2e-3 * level);
  EXPECT_NEAR(contact(place, scan(place, "spiked.gsf", {.tilt = 0.02, .spike = 5e-6})), level,
              0.02 * level);
  // As they are: a slope of 0.02 over 16 um lifts half of the surface out of reach.
  EXPECT_LT(contact(place, "tilted.gsf --as-is"), 0.9 * level);
}

// The line on a map that a command says, "" for none or several.
std::string said(const Outcome& run) {
  std::istringstream lines(run.err);
  std::string out;
  int count = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("a plane of") == std::string::npos) continue;
    out = line.substr(line.find(": a plane") + 2);
    ++count;
  }
  return count == 1 ? out : "";
}

TEST(Scans, EveryCommandSaysOnceAndInTheSameWordsWhatItChanged) {
  const Workplace place;
  scan(place, "s.gsf", {.tilt = 0.02, .spike = 5e-6, .missing = 7});
  place.write("s.toml",
              "schema_version = 1\n[texture]\ntype = \"measured\"\nfile = \"s.gsf\"\nfill = true\n"
              "[environment]\nrelative_humidity = [\"35 %\"]\n[accuracy]\nlevel = \"draft\"\n");
  const Outcome surface = place.run("surface s.gsf --fill");
  ASSERT_EQ(surface.status, 0) << surface.err;
  // In nanometres, from the deepest to the highest.
  const json areal = json::parse(place.run("surface s.gsf --fill --json").out)["areal"];
  double low = 0, high = 0;
  const std::size_t heights = surface.out.find("heights from ");
  ASSERT_NE(heights, std::string::npos) << surface.out;
  ASSERT_EQ(std::sscanf(surface.out.c_str() + heights, "heights from %lf to %lf nm", &low, &high),
            2);
  EXPECT_LT(low, 0);
  EXPECT_NEAR(high - low, 1e9 * areal["Sz"].get<double>(), 0.2);
  std::istringstream first(surface.out);
  std::string line;
  std::getline(first, line);
  const std::string words = line.substr(line.find(": ") + 2);
  EXPECT_NE(
      words.find("a plane of 1.15 deg (325.5 nm over the map) was taken away; 1 of 16384 pixels "
                 "(0.0061 %) replaced by their neighbours, 48"),
      std::string::npos)
      << words;
  EXPECT_NE(words.find("7 of 16384 pixels (0.043 %) were no numbers and were filled"),
            std::string::npos)
      << words;
  for (const std::string command :
       {"evaluate s.toml", "evaluate s.toml --json", "explain s.toml", "solve haze s.toml",
        "solve haze --fill --height s.gsf", "--quiet solve haze --fill --height s.gsf",
        "solve contact --fill --pressure '2 MPa' --modulus '53 MPa' --height s.gsf",
        "export s.toml --format npy --pixels 64 --out e"}) {
    const Outcome run = place.run(command);
    EXPECT_EQ(run.status, 0) << command << run.err;
    // A texture of the map is a part of it.
    const bool texture = command.find("s.toml") != std::string::npos;
    EXPECT_EQ(said(run),
              words + (texture ? "; of its 16 x 16 um a square of 12 um is the texture "
                                 "(texture.patch, at_x, at_y), blended along two borders with "
                                 "what lies beyond, so that it repeats"
                               : ""))
        << command << run.err;
  }
  const auto haze = json::parse(place.run("solve haze --json --fill --height s.gsf").out);
  EXPECT_EQ(haze["scan"]["replaced"], 1);
  EXPECT_EQ(haze["scan"]["filled"], 7);
}

TEST(Scans, HeightsThatAreNoNumbersAreRefusedWithTheWayOut) {
  const Workplace place;
  scan(place, "n.gsf", {.missing = 30});
  place.write("n.toml", "schema_version = 1\n[texture]\ntype = \"measured\"\nfile = \"n.gsf\"\n");
  for (const std::string& command :
       {std::string("solve contact") + kPress + "n.gsf", std::string("solve haze --height n.gsf"),
        std::string("surface n.gsf"), std::string("evaluate n.toml"),
        std::string("explain n.toml")}) {
    const Outcome run = place.run(command);
    EXPECT_EQ(run.status, 2) << command;
    EXPECT_NE(run.err.find("fill = true of a measured texture, --fill of a command"),
              std::string::npos)
        << command << run.err;
  }
  const double whole = contact(place, scan(place, "level.gsf", {}));
  EXPECT_NEAR(contact(place, "n.gsf --fill"), whole, 0.02 * whole);
  ASSERT_EQ(place.run("surface n.gsf --fill --out filled.gsf").status, 0);
  EXPECT_EQ(place.run("surface filled.gsf").status, 0);
  EXPECT_EQ(place.run("surface filled.gsf --out filled.png").status, 2);
}

TEST(SurfaceCommand, GivesTheDocumentedJson) {
  const Workplace place;
  scan(place, "s.gsf", {});
  const Outcome run = place.run("surface s.gsf --json --tip '30 nm'");
  ASSERT_EQ(run.status, 0) << run.err;
  const auto view = json::parse(run.out);
  EXPECT_EQ(view["pixels"][0], 128);
  EXPECT_NEAR(view["size"][0].get<double>(), 16e-6, 1e-15);
  for (const char* name : {"Sa", "Sq", "Sz", "Sp", "Sv", "Ssk", "Sku", "Sdq", "Sdr", "Sal", "Str",
                           "Std", "Sk", "Spk", "Svk", "Smr1", "Smr2"})
    EXPECT_TRUE(view["areal"][name].is_number()) << name;
  EXPECT_NEAR(view["areal"]["Sq"].get<double>(), 40e-9, 8e-9);
  EXPECT_NEAR(view["band"]["longest"].get<double>(), 4e-6, 1e-12);
  EXPECT_GE(view["band"]["shortest"].get<double>(), 250e-9 * (1 - 1e-9));
  EXPECT_EQ(view["section"]["heights"].size(), 128u);
  EXPECT_EQ(place.run("surface s.gsf --tip '-3 nm'").status, 2);
  EXPECT_EQ(place.run("surface none.gsf").status, 2);
}

}  // namespace
}  // namespace papilla::tests::files_test
