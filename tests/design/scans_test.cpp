// What is said of the measured maps behind a design.
#include "design/scans.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "base/constants.h"
#include "geometry/io/files.h"
#include "tests/temporary.h"

namespace papilla::tests::scans_test {
namespace {

TEST(DesignScans, APartThatAloneIsTakenIsSaid) {
  DesignScan scan{"a.gsf", {}, 12e-6};
  scan.changes.width = 25.6e-6;
  scan.changes.height = 20e-6;
  EXPECT_NE(text(scan).find("of its 25.6 x 20 um a square of 12 um is the texture"),
            std::string::npos)
      << text(scan);
  scan.changes.width = scan.changes.height = 12e-6;
  EXPECT_EQ(text(scan).find("a square"), std::string::npos) << text(scan);
}

// The map of a texture is cut to its patch, that of a skin as each window needs it.
TEST(DesignScans, AreThoseOfTheTextureAndOfTheSkin) {
  EXPECT_TRUE(scans_of(Design{}).empty());
  const std::string file = PAPILLA_DESIGNS_DIR "/measured_surface/scan.gsf";
  Measured3d measured;
  measured.file = file, measured.patch = 12e-6;
  Design design;
  design.texture = Texture{measured};
  const std::vector<DesignScan> one = scans_of(design);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].file, file);
  EXPECT_EQ(one[0].taken, 12e-6);
  EXPECT_GT(one[0].changes.width, 12e-6);
  design.finger.skin.map = file;
  const std::vector<DesignScan> two = scans_of(design);
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[1].file, file);
  EXPECT_EQ(two[1].taken, 0);
  EXPECT_EQ(two[1].changes.width, one[0].changes.width);
}

// In a stack the keys that choose the square are those of the part.
TEST(DesignScans, AMapInAStackNamesTheKeysOfItsPart) {
  Measured3d measured;
  measured.file = PAPILLA_DESIGNS_DIR "/measured_surface/scan.gsf", measured.patch = 12e-6;
  Stack stack;
  stack.parts = {Texture{RandomRough{}}, Texture{measured}};
  Stack outer;
  outer.parts = {Texture{stack}, Texture{measured}};
  Design design;
  design.texture = Texture{outer};
  const std::vector<DesignScan> scans = scans_of(design);
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_NE(text(scans[0]).find("(texture.parts.0.parts.1.patch, at_x, at_y)"), std::string::npos)
      << text(scans[0]);
  EXPECT_NE(text(scans[1]).find("(texture.parts.1.patch, at_x, at_y)"), std::string::npos)
      << text(scans[1]);
}

// Beside holes of a period of 5 um the patch is whole periods of those, no square of a side that a
// key says.
TEST(DesignScans, OfAMapBesidePeriodicPartsSayThePatchThatIsSimulated) {
  Measured3d measured;
  measured.file = PAPILLA_DESIGNS_DIR "/measured_surface/scan.gsf", measured.patch = 12e-6;
  HoleArray holes;
  holes.period = 5e-6, holes.diameter = 2e-6;
  Stack stack;
  stack.parts = {Texture{holes}, Texture{measured}};
  Design design;
  design.texture = Texture{stack};
  const std::vector<DesignScan> scans = scans_of(design);
  ASSERT_EQ(scans.size(), 1u);
  const std::string said = text(scans[0]);
  EXPECT_NE(said.find("; of its 20 x 20 um the simulated patch of 10 x 15 um, whole periods of the "
                      "stack, is the texture (texture.parts.1.at_x, at_y)"),
            std::string::npos)
      << said;
  EXPECT_EQ(said.find("a square of"), std::string::npos) << said;
}

// What makes another surface of a map without a word of its file: a wrong scale, a short patch.
TEST(DesignScans, SayAPixelTooWideAndAPatchTooShortForFriction) {
  const auto said = [](double width, double taken) {
    DesignScan scan{"a.npy", {}, taken};
    scan.changes.width = scan.changes.height = width;
    scan.changes.pixels = 256 * 256;
    return text(scan);
  };
  EXPECT_NE(said(400e-6, 12e-6)
                .find("; its pixels are 1.56 um wide: of waves shorter than 3.12 um, which "
                      "friction rests on, nothing is in it; is its width of 400 um right?"),
            std::string::npos)
      << said(400e-6, 12e-6);
  EXPECT_EQ(said(100e-6, 12e-6).find("its pixels"), std::string::npos);
  EXPECT_EQ(said(400e-6, 0).find("its pixels"), std::string::npos);  // of a skin
  EXPECT_NE(said(4e-6, 4e-6).find("; its patch of 4 um is shorter than the waves of skin"),
            std::string::npos)
      << said(4e-6, 4e-6);
  EXPECT_EQ(said(6e-6, 6e-6).find("its patch"), std::string::npos);
  EXPECT_EQ(said(6e-6, 0).find("its patch"), std::string::npos);
}

TEST(DesignScans, OfAMapThatIsRepeatedSayThePatchThatItMakes) {
  DesignScan scan{"a.npy", {}, 12e-6, "texture", UnitCell{12e-6, 12e-6}};
  scan.changes.width = scan.changes.height = 2e-6;
  scan.changes.as_is = true;
  EXPECT_EQ(text(scan),
            "a.npy: taken as it is, neither levelled nor mended; repeated, it makes the simulated "
            "patch of 12 x 12 um");
}

// A wave of 16 um on 20 um: as high at one border as it is at most, and higher by the plane of 29
// nm that falls towards it and is taken away.
TEST(DesignScans, SayTheStepOfAPatchThatLeavesNoRoomForItsSeam) {
  Heightmap wave{{200, 200, 20e-6, 20e-6}, {}};
  for (int i = 0; i < 200 * 200; ++i)
    wave.z.push_back(50e-9 * std::sin(2 * kPi * (0.1e-6 * (i % 200)) / 16e-6));
  Measured3d map;
  map.file = temporary("wave.gsf");
  write_gsf(map.file, wave, {});
  const auto said = [&](double patch, double at_x = 0) {
    map.patch = patch, map.at_x = at_x;
    Design design;
    design.texture = Texture{map};
    return text(scans_of(design).at(0));
  };
  const std::string whole = said(20e-6), step =
                                             "the patch leaves no room for the tenth that is "
                                             "blended: at its border stands a step of ";
  ASSERT_NE(whole.find(step), std::string::npos) << whole;
  EXPECT_NEAR(std::stod(whole.substr(whole.find(step) + step.size())), 50 + 29, 2) << whole;
  EXPECT_NE(whole.find("take texture.patch = 16.66 um or less, in the middle of the map"),
            std::string::npos)
      << whole;
  const std::string middle = said(16.66e-6);
  EXPECT_EQ(middle.find(step), std::string::npos) << middle;
  EXPECT_NE(middle.find("blended along two borders"), std::string::npos) << middle;
  // At the border of the map nothing lies below the patch.
  const std::string corner = said(10e-6, -5e-6);
  EXPECT_NE(corner.find(step), std::string::npos) << corner;
  EXPECT_EQ(corner.find("blended along two borders"), std::string::npos) << corner;
}

// A map of 16 x 12 um that is said to repeat after its patch.
std::string said_as_is(double patch, double (*height)(double x)) {
  Heightmap h{{160, 120, 16e-6, 12e-6}, {}};
  for (int i = 0; i < 160 * 120; ++i) h.z.push_back(height(0.1e-6 * (i % 160 + 0.5)));
  Measured3d map;
  map.file = temporary(fmt::format("as_is_{:.0f}.gsf", 1e6 * patch)), map.as_is = true,
  map.patch = patch;
  write_gsf(map.file, h, {});
  Design design;
  design.texture = Texture{map};
  return text(scans_of(design).at(0));
}

// A wave of 16 um is 35.4 nm high 2 um from the border of the map and as deep 12 um further.
TEST(DesignScans, SayThatAMapTakenAsItIsDoesNotRepeatAfterItsPatch) {
  const std::string wave =
      said_as_is(12e-6, [](double x) { return 50e-9 * std::sin(2 * kPi * x / 16e-6); });
  const std::string step =
      "the map does not repeat after that patch: at its border stands a step of ";
  ASSERT_NE(wave.find(step), std::string::npos) << wave;
  EXPECT_NEAR(std::stod(wave.substr(wave.find(step) + step.size())), 70.7, 0.5) << wave;
  EXPECT_NE(wave.find("take texture.patch = a period of the map, or leave out as_is"),
            std::string::npos)
      << wave;
}

// Walls of grooves of 4 um stand at the border of a patch of two of them, where they belong.
TEST(DesignScans, SayThePeriodThatAMapTakenAsItIsRepeatsAfter) {
  const auto grooves = [](double x) { return std::fmod(x, 4e-6) < 2e-6 ? -100e-9 : 0.0; };
  const std::string two = said_as_is(8e-6, grooves);
  EXPECT_NE(two.find("of its 16 x 12 um a square of 8 um is one period (texture.patch), and the "
                     "simulated patch of 8 x 16 um is whole periods"),
            std::string::npos)
      << two;
  EXPECT_EQ(two.find("a step of"), std::string::npos) << two;
  // 16 um are no whole number of its 12 um, which is refused: nothing is repeated.
  EXPECT_EQ(said_as_is(16e-6, grooves).find("repeated"), std::string::npos);
}

// On a patch that is shorter than the waves of skin friction is that of another finger.
TEST(DesignProblems, RefuseAPatchOfAMapTooShortForSkin) {
  const auto refused = [](double patch, bool as_is) {
    Measured3d map;
    map.file = "a.npy", map.patch = patch, map.as_is = as_is;
    Design design;
    design.texture = Texture{map};
    for (const DesignProblem& p : design_problems(design)) {
      if (p.path == "texture.patch") return p.message;
    }
    return std::string();
  };
  EXPECT_TRUE(refused(2e-6, false).starts_with("2 um is shorter than the waves of skin"))
      << refused(2e-6, false);
  EXPECT_EQ(refused(2e-6, true), "");  // repeated
  EXPECT_EQ(refused(3e-6, false), "");
}

}  // namespace
}  // namespace papilla::tests::scans_test
