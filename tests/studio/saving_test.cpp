// Saved files are what a person would have written.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <tuple>

#include "base/error.h"
#include "base/files.h"
#include "base/units.h"
#include "geometry/io/files.h"
#include "studio/files.h"
#include "tests/temporary.h"

namespace papilla::tests {
namespace {

namespace fs = std::filesystem;

TEST(EditedToml, ChangesAValueInItsPlaceAndNothingElse) {
  EXPECT_EQ(edited_toml("# mine\n[texture]\ndepth = \"350 nm\"  # etched\nwidth = 3\n",
                        {{"texture.depth", "262 nm"}}),
            "# mine\n[texture]\ndepth = \"262 nm\"  # etched\nwidth = 3\n");
}

TEST(EditedToml, TakesListsTablesInALineAndOtherLetters) {
  EXPECT_EQ(edited_toml("a = { material = \"µ]\", d = \"500 nm\" }\n", {{"a.d", "700 nm"}}),
            "a = { material = \"µ]\", d = \"700 nm\" }\n");
  EXPECT_EQ(
      edited_toml("[air]\nrh = [\"15 %\", # dry\n  \"75 %\"]\nx = 1\n", {{"air.rh", "[\"20 %\"]"}}),
      "[air]\nrh = [\"20 %\"]\nx = 1\n");
  EXPECT_EQ(edited_toml("s = [{ d = 1.5 }, { d = 2 }]\n", {{"s.1.d", "3"}}),
            "s = [{ d = 1.5 }, { d = 3 }]\n");
  EXPECT_EQ(edited_toml("[a]\nb = 1.5e-3# why\n", {{"a.b", "2"}}), "[a]\nb = 2# why\n");
}

TEST(EditedToml, PutsANewKeyAtTheEndOfItsSection) {
  EXPECT_EQ(edited_toml("[a]\nx = 1\n\n# of b\n[b]\ny = 2\n", {{"a.z", "on"}, {"c.d.e", "4 V"}}),
            "[a]\nx = 1\nz = \"on\"\n\n# of b\n[b]\ny = 2\n\n[c.d]\ne = \"4 V\"\n");
}

TEST(EditedToml, ANewKindTakesThePlaceOfTheOld) {
  EXPECT_EQ(edited_toml("[texture]\ntype = \"hole_array\"\ndepth = \"1 um\"\n\n[surface]\n",
                        {{"texture.type", "grating"}, {"texture.width", "2 um"}}),
            "[texture]\ntype = \"grating\"\nwidth = \"2 um\"\n\n[surface]\n");
}

class Saving : public ::testing::Test {
 protected:
  // The draft saved, as its file reads back.
  std::string save(const Draft& draft, const std::string& name) {
    files_.save(draft, study_of(draft), files_.target(name, true));
    EXPECT_EQ(read_design(place_.path() / name), study_of(draft).design);
    return read_bytes(place_.path() / name);
  }

  const TemporaryFolder place_;
  const Files files_{place_.path()};
  const std::string shipped_ = PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml";
};

TEST_F(Saving, StandsOnAShippedDesignWithTheChangedKeysAlone) {
  EXPECT_EQ(
      save({shipped_, {{"texture.depth", "262 nm"}, {"drive.amplitude", "120 V"}}}, "mine.toml"),
      "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n\n[texture]\ndepth = \"262 nm\"\n\n"
      "[drive]\namplitude = \"120 V\"\n");
}

TEST_F(Saving, EditsItsOwnFileAndKeepsItsComments) {
  save({shipped_, {}}, "mine.toml");
  write_bytes(place_.path() / "mine.toml",
              read_bytes(place_.path() / "mine.toml") +
                  "\n# for the second wafer\n[finger]\nload = \"0.3 N\"\n");
  const std::string file = place_.path() / "mine.toml";
  EXPECT_NE(save({file, {{"finger.load", "0.5 N"}}}, "mine.toml")
                .find("\n# for the second wafer\n[finger]\nload = \"0.5 N\"\n"),
            std::string::npos);
}

TEST_F(Saving, WritesAListWholeWhereOneOfItsItemsChanged) {
  const std::string text =
      save({shipped_, {{"surface.dielectric.0.thickness", "700 nm"}}}, "film.toml");
  EXPECT_NE(text.find("dielectric = [{ material = \"SiO2\", thickness = \"700 nm\""),
            std::string::npos);
}

TEST_F(Saving, RefusesNamesOutsideAndFilesThatAreThere) {
  const Draft draft{shipped_, {{"texture.depth", "262 nm"}}};
  const Study study = study_of(draft);
  files_.save(draft, study, files_.target("a.toml", false));
  EXPECT_THROW(files_.target("a.toml", false), InputError);
  for (const char* name : {"../a.toml", "/etc/a.toml", "a.txt", ".a.toml", ""})
    EXPECT_THROW(files_.target(name, true), InputError) << name;
  int left = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(place_.path())) ++left;
  EXPECT_EQ(left, 1);
}

TEST_F(Saving, AScanStandsBesideTheFileThatNamesIt) {
  const std::string bytes = read_bytes(PAPILLA_DESIGNS_DIR "/measured_surface/scan.gsf");
  files_.keep_scan("mine.gsf", bytes);
  const Draft draft = files_.with_scan({shipped_, {}}, "scans/mine.gsf", "", false, false);
  EXPECT_NE(save(draft, "scanned.toml").find("file = \"scans/mine.gsf\""), std::string::npos);
  EXPECT_THROW(files_.keep_scan("mine.exe", bytes), InputError);
  EXPECT_THROW(files_.keep_scan("../mine.gsf", bytes), InputError);
  EXPECT_THROW(files_.with_scan({shipped_, {}}, "../scan.gsf", "", false, false), InputError);
}

// The whole map where it is small, of its shorter side; else a square of 24 um.
TEST_F(Saving, APatchOfAScanIsAsLargeAsTheScanAtMost24um) {
  for (const auto& [lx, ly, expected] :
       {std::tuple{12e-6, 6e-6, 6e-6}, {6e-6, 12e-6, 6e-6}, {30e-6, 48e-6, 24e-6}}) {
    Heightmap map{{static_cast<int>(std::lround(lx / 0.5e-6)),
                   static_cast<int>(std::lround(ly / 0.5e-6)), lx, ly},
                  {}};
    map.z.resize(map.grid.size());
    for (std::size_t i = 0; i < map.z.size(); ++i) map.z[i] = 1e-8 * static_cast<double>(i % 7);
    fs::create_directories(place_.path() / "scans");
    write_gsf((place_.path() / "scans/map.gsf").string(), map, {});
    const Draft draft = files_.with_scan({shipped_, {{"texture.depth", "1 nm"}}}, "scans/map.gsf",
                                         "", false, false);
    std::string patch;
    for (const Change& c : draft.changes) {
      EXPECT_NE(c.path, "texture.depth");  // of the texture before
      if (c.path == "texture.patch") patch = c.text;
    }
    patch = patch.substr(patch.find_first_of("0123456789"));
    EXPECT_NEAR(parse_si(patch.substr(0, patch.find('"')), "um"), expected, 1e-12) << patch;
  }
}

}  // namespace
}  // namespace papilla::tests
