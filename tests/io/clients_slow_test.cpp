// What the programs of others see in our files: sizes, heights, polarity, arrays.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <sstream>

#include "base/constants.h"
#include "tests/cli/program.h"

namespace papilla::tests::clients_slow_test {
namespace {

using Facts = std::map<std::string, std::string>;

Facts ask(const Workplace& place, const std::string& what, const std::string& folder) {
  const Outcome run =
      place.shell("python3 " PAPILLA_SOURCE_DIR "/tests/io/clients.py " + what + " " + folder);
  EXPECT_EQ(run.status, 0) << run.err;
  std::istringstream in(run.out);
  Facts out;
  for (std::string name, value; in >> name && std::getline(in >> std::ws, value);)
    out[name] = value;
  return out;
}
double number(const Facts& facts, const std::string& name) {
  return facts.contains(name) ? std::stod(facts.at(name)) : NAN;
}
bool missing(const Workplace& place, const std::string& programs) {
  return place.shell("for p in " + programs + "; do command -v $p || exit 1; done").status != 0;
}
constexpr const char* kDesign = PAPILLA_SOURCE_DIR "/designs/m3_samples/a3h350.toml ";
constexpr const char* kFilm = PAPILLA_SOURCE_DIR "/designs/coatings/hdpe_large_1.toml ";

TEST(Klayout, ReadsTheArrayOfAScreenFromLessThanTwoKilobytes) {
  const Workplace place;
  if (missing(place, "klayout python3")) GTEST_SKIP() << "needs klayout (scripts/setup --test)";
  const Outcome run = place.run(std::string("export ") + kDesign +
                                "--format gds --size '30 mm' --pixels 64 --out big --set "
                                "'texture.period=\"6 um\"' --set 'texture.diameter=\"4.5 um\"'");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_LT(std::filesystem::file_size(place.path() / "big/texture.gds"), 2000u);
  const Facts facts = ask(place, "gds", "big");
  EXPECT_EQ(number(facts, "count"), 25e6);
  EXPECT_EQ(number(facts, "oasis_count"), 25e6);
  EXPECT_NEAR(number(facts, "pitch_x"), 6, 1e-9);
  EXPECT_NEAR(number(facts, "pitch_y"), 6, 1e-9);
  EXPECT_NEAR(number(facts, "area_1"), kPi * 2.25 * 2.25, 0.01);
}

// Both layouts of one export are one drawing, in square and hexagonal rows and as contours.
TEST(Klayout, SeesInOasisWhatItSeesInGdsii) {
  const Workplace place;
  if (missing(place, "klayout python3")) GTEST_SKIP() << "needs klayout (scripts/setup --test)";
  const std::string period = " --set 'texture.period=\"6 um\"' --set 'texture.diameter=\"4.5 um\"'";
  for (const std::string& what :
       {kDesign + period, kDesign + period + " --set texture.lattice=hexagonal",
        std::string(kFilm) + "--levels 3"}) {
    const Outcome run =
        place.run("export " + what + " --format gds,oasis --size '90x60 um' --pixels 128 --out o");
    ASSERT_EQ(run.status, 0) << run.err;
    const Facts gds = ask(place, "gds", "o"), oasis = ask(place, "oasis", "o");
    EXPECT_FALSE(gds.empty());
    EXPECT_EQ(gds.size(), oasis.size());
    for (const auto& [name, value] : gds)  // its unit of OASIS is off in the sixteenth digit
      EXPECT_NEAR(number(oasis, name) / number(gds, name), 1, 1e-12) << name << " of " << what;
  }
}

TEST(Klayout, SeesTheAreasOfAMaskWithALayerALevel) {
  const Workplace place;
  if (missing(place, "klayout python3")) GTEST_SKIP() << "needs klayout (scripts/setup --test)";
  const Outcome run = place.run(std::string("export ") + kFilm +
                                "--format gds,npy --levels 3 --pixels 128 --out m");
  ASSERT_EQ(run.status, 0) << run.err;
  const Facts facts = ask(place, "gds", "m");
  EXPECT_EQ(number(facts, "oasis_layers"), 3);
  EXPECT_GT(number(facts, "area_1"), number(facts, "area_2"));
  EXPECT_GT(number(facts, "area_2"), number(facts, "area_3"));
}

TEST(Gwyddion, SeesSizesAndHeights) {
  const Workplace place;
  if (missing(place, "gwyddion python3")) GTEST_SKIP() << "needs gwyddion (scripts/setup --test)";
  const Outcome run = place.run(std::string("export ") + kDesign +
                                "--format gsf,x3p,png16 --pixels 128 --size '12 um' --out g --set "
                                "'texture.period=\"6 um\"'");
  ASSERT_EQ(run.status, 0) << run.err;
  const Facts facts = ask(place, "gwyddion", "g");
  for (const std::string kind : {"gsf", "x3p", "png"}) {
    EXPECT_NEAR(number(facts, kind + "_xreal"), 12e-6, 1e-12) << kind;
    EXPECT_NEAR(number(facts, kind + "_yreal"), 12e-6, 1e-12) << kind;
    EXPECT_EQ(number(facts, kind + "_pixels"), 128 * 128) << kind;
    EXPECT_NEAR(number(facts, kind + "_range"), 350e-9, 1e-10) << kind;
  }
}

TEST(Gwyddion, SeesUpAndDownAlikeInEveryFormat) {
  const Workplace place;
  if (missing(place, "gwyddion python3")) GTEST_SKIP() << "needs gwyddion (scripts/setup --test)";
  const Outcome run =
      place.run(std::string("export ") + kFilm + "--format gsf,x3p,png16 --pixels 128 --out g");
  ASSERT_EQ(run.status, 0) << run.err;
  const Facts facts = ask(place, "gwyddion", "g");
  const double top = number(facts, "gsf_top");
  EXPECT_GT(std::abs(top), 1e-6);
  EXPECT_NEAR(number(facts, "x3p_top"), top, 1e-3 * std::abs(top));
  EXPECT_NEAR(number(facts, "png_top"), top, 1e-2 * std::abs(top));
}

TEST(ImageTools, SeeResolutionChannelsHeightsAndPolarity) {
  const Workplace place;
  if (missing(place, "tiffinfo exrheader iinfo python3"))
    GTEST_SKIP() << "needs libtiff-tools, openexr, openimageio-tools (scripts/setup --test)";
  const Outcome run = place.run(std::string("export ") + kDesign +
                                "--format exr,tiff,mask --polarity white-deep --pixels 240 "
                                "--size '12 um' --out i --set 'texture.period=\"6 um\"' --set "
                                "'texture.diameter=\"3 um\"'");
  ASSERT_EQ(run.status, 0) << run.err;
  const Facts facts = ask(place, "images", "i");
  EXPECT_NEAR(number(facts, "tiff_resolution"), 240 / 12e-4, 1);
  EXPECT_EQ(number(facts, "tiff_none"), 1);
  EXPECT_EQ(number(facts, "tiff_bits"), 16);
  EXPECT_NEAR(number(facts, "exr_xreal"), 12e-6, 1e-12);
  EXPECT_EQ(facts.at("exr_channel"), "Y");
  EXPECT_NEAR(number(facts, "exr_max"), 0.35, 1e-4);  // um above the floor
  const double mean = number(facts, "mask_mean");
  EXPECT_NEAR(mean > 1 ? mean / 65535 : mean, kPi / 16, 0.01);  // white is deep
}

TEST(ImageMagick, SeesTheImages) {
  const Workplace place;
  if (missing(place, "identify python3"))
    GTEST_SKIP() << "needs imagemagick (scripts/setup --test)";
  const Outcome run = place.run(std::string("export ") + kDesign +
                                "--format tiff,png16 --polarity white-deep --pixels 128 --out i");
  ASSERT_EQ(run.status, 0) << run.err;
  const Facts facts = ask(place, "magick", "i");
  EXPECT_EQ(facts.at("heightmap.tif").substr(0, 4), "128x");
  EXPECT_NE(facts.at("heightmap.tif").find("TIFF"), std::string::npos);
  EXPECT_NE(facts.at("heightmap.png").find("PNG"), std::string::npos);
}

TEST(Export, ALargeAreaIsStreamed) {
  const Workplace place;
  const Outcome run =
      place.run(std::string("export ") + kDesign + "--format exr --pixels 256 --repeat 8 --out t");
  ASSERT_EQ(run.status, 0) << run.err;
  const Outcome one =
      place.run(std::string("export ") + kDesign + "--format exr --pixels 256 --out one");
  ASSERT_EQ(one.status, 0) << one.err;
  if (missing(place, "exrheader")) GTEST_SKIP() << "needs openexr (scripts/setup --test)";
  EXPECT_NE(place.shell("exrheader t/heightmap.exr").out.find("(0 0) - (2047 2047)"),
            std::string::npos);
}

TEST(Export, NoFormatHoldsALargeMapTwice) {
  const Workplace place;
  if (missing(place, "python3")) GTEST_SKIP() << "needs python3";
  place.write("peak.py",
              "import resource, subprocess, sys\n"
              "subprocess.run(sys.argv[1:], check=True, stdout=subprocess.DEVNULL)\n"
              "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024)\n");
  const auto peak = [&](const std::string& format, int pixels) {  // MB
    const std::string polarity = format == "tiff" ? "--polarity white-high " : "";
    const Outcome run = place.shell("python3 peak.py '" PAPILLA_PROGRAM "' export " +
                                    std::string(kDesign) + polarity + "--out p --format " + format +
                                    " --pixels " + std::to_string(pixels));
    EXPECT_EQ(run.status, 0) << run.err;
    return std::atof(run.out.c_str());
  };
  const double map = 3072.0 * 3072 * sizeof(double) / 1048576;
  for (const std::string format : {"exr", "tiff", "tiff32", "gsf", "npy", "png16", "x3p"})
    EXPECT_LT(peak(format, 3072) - peak(format, 64), 1.4 * map) << format;
}

TEST(Export, AFullDiskAndAMissingFolderLeaveTheOldFile) {
  const Workplace place;
  const std::string design = std::string("export ") + kDesign;
  ASSERT_EQ(place.run(design + "--format exr,gsf --pixels 64 --out f").status, 0);
  const std::string exr = file_text(place.path() / "f/heightmap.exr"),
                    gsf = file_text(place.path() / "f/heightmap.gsf");
  // A limit on the size of files stands for a full disk; 20 blocks of 512 bytes.
  for (const char* format : {"gsf", "npy", "x3p", "exr"}) {
    const Outcome full = place.shell("trap '' XFSZ; ulimit -f 20; '" PAPILLA_PROGRAM "' " + design +
                                     "--format " + format + " --pixels 512 --out f");
    EXPECT_EQ(full.status, 1) << format << full.err;
    EXPECT_NE(full.err.find("cannot write"), std::string::npos) << full.err;
  }
  EXPECT_EQ(file_text(place.path() / "f/heightmap.exr"), exr);
  EXPECT_EQ(file_text(place.path() / "f/heightmap.gsf"), gsf);
  EXPECT_EQ(place.shell("ls f | grep part").out, "");
  place.write("plain", "a file");
  const Outcome none = place.run(design + "--format gsf --out plain/below");
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("no such folder can be made"), std::string::npos) << none.err;
}

TEST(Export, AKillInTheMiddleLeavesTheOldFile) {
  const Workplace place;
  const std::string design = std::string("export ") + kDesign;
  ASSERT_EQ(place.run(design + "--format exr --pixels 64 --out f").status, 0);
  const std::string exr = file_text(place.path() / "f/heightmap.exr");
  // Stopped as soon as the new file has begun.
  place.shell("'" PAPILLA_PROGRAM "' " + design +
              "--format exr --pixels 512 --repeat 16 --out f & p=$!; "
              "for i in $(seq 600); do ls f/.heightmap.*.part.exr && break; sleep 0.02; done; "
              "ls f/.heightmap.*.part.exr && touch begun; kill -9 $p");
  EXPECT_TRUE(std::filesystem::exists(place.path() / "begun"));
  EXPECT_EQ(file_text(place.path() / "f/heightmap.exr"), exr);
  // What it left goes with the next one.
  ASSERT_EQ(place.run(design + "--format exr --pixels 64 --out f").status, 0);
  EXPECT_EQ(place.shell("ls f/.heightmap.*").status, 2);
}

TEST(Verify, JudgesTheFileAndFailsAboveTheTolerance) {
  const Workplace place;
  const std::string verify = std::string("export ") + kDesign +
                             "--format exr --pixels 256 --out v --verify --set "
                             "'environment.relative_humidity=[\"35 %\"]' ";
  const Outcome sound = place.run(verify);
  EXPECT_EQ(sound.status, 0) << sound.out << sound.err;
  EXPECT_NE(sound.out.find("smallest hole"), std::string::npos) << sound.out;
  const Outcome strict = place.run(verify + "--tolerance '0.000001 %'");
  EXPECT_NE(strict.status, 0);
  EXPECT_NE(strict.err.find("not sound: mean("), std::string::npos) << strict.err;
  // Seven pixels a hole lose its shape.
  const Outcome coarse = place.run(verify + "--pixels 12 --tolerance '0.5 %'");
  EXPECT_NE(coarse.status, 0) << coarse.out;
}

}  // namespace
}  // namespace papilla::tests::clients_slow_test
