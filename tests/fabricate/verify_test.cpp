// What is said of files that differ from their design.
#include "fabricate/verify.h"

#include <fmt/format.h>

#include "base/constants.h"
#include "fabricate/export.h"
#include "geometry/io/drawing.h"
#include "tests/fabricate/exported_folder.h"
#include "tests/temporary.h"

namespace papilla::tests {
namespace {

// What a fault says: a number a maker can act on.
std::string faults_of(const Folder& folder, const std::string& name) {
  std::string out;
  for (const FileVerdict& file : verify_folder(folder.path(), name)) {
    for (const std::string& fault : file.faults) out += fault + "\n";
  }
  return out;
}

TEST(Verify, SaysWhatIsWrongAndByHowMuch) {
  const Workplace place;
  HoleArray holes;
  holes.period = 6e-6, holes.diameter = 3e-6, holes.depth = 100e-9;
  const Folder folder(place.path() / "f", Texture{holes}, Polarity::WhiteDeep);
  const auto again = [&](const HoleArray& made, const char* format) {
    const Heightmap h = generate(Texture{made}, folder.made().heightmap.grid);
    write_again({format, folder.path() + "/" + find_export_format(format).file}, h, Texture{made},
                folder.options());
  };
  HoleArray deep = holes;
  deep.depth = 200e-9;  // twice as deep moves the friction by less than the 5 % allowed
  again(deep, "exr");
  EXPECT_NE(faults_of(folder, "heightmap.exr")
                .find("its depth is 200 nm, the design's 100 nm: 100 % more"),
            std::string::npos)
      << faults_of(folder, "heightmap.exr");
  HoleArray wide = holes;
  wide.diameter = 3.3e-6;
  again(wide, "mask");
  EXPECT_NE(
      faults_of(folder, "mask.tif").find("its critical dimension (width of the holes) is 3.3"),
      std::string::npos)
      << faults_of(folder, "mask.tif");
  again(wide, "gds");
  EXPECT_NE(
      faults_of(folder, "texture.gds")
          .find("its critical dimension (width of the holes) is 3.3 um, the design's 3 um: 10 "
                "% more"),
      std::string::npos)
      << faults_of(folder, "texture.gds");
  const std::set<std::string> named = folder.named();
  EXPECT_EQ(named.size(), 3u);
}

// A row of hexagons off its place is seen in a layout whose polygons are all right.
TEST(Verify, KnowsThePlaceOfEveryRow) {
  const Workplace place;
  HoleArray holes;
  holes.period = 6e-6, holes.diameter = 3e-6, holes.lattice = Lattice::Hexagonal;
  const Folder folder(place.path() / "f", Texture{holes}, Polarity::WhiteDeep);
  const std::string path = folder.path() + "/texture.gds";
  Layout layout = read_gds(path);
  const auto block = std::find_if(layout.cells.begin(), layout.cells.end(),
                                  [](const LayoutCell& c) { return c.name == "BLOCK"; });
  ASSERT_NE(block, layout.cells.end());
  block->references.at(1).x += 20;
  write_gds(path, layout);
  EXPECT_NE(faults_of(folder, "texture.gds").find("its holes are up to 20"), std::string::npos)
      << faults_of(folder, "texture.gds");
  block->references.pop_back();
  write_gds(path, layout);
  EXPECT_NE(faults_of(folder, "texture.gds").find("polygons, the design's"), std::string::npos)
      << faults_of(folder, "texture.gds");
}

// Hexagons need an oblong map.
TEST(Verify, SaysHowManyPixelsAMapShouldHaveAlongEitherSide) {
  const Workplace place;
  HoleArray holes;
  holes.period = 6e-6, holes.diameter = 3e-6, holes.lattice = Lattice::Hexagonal;
  const Folder folder(place.path() / "f", Texture{holes}, Polarity::WhiteDeep);
  Grid grid = folder.made().heightmap.grid;
  const int nx = grid.nx, ny = grid.ny;
  ASSERT_NE(nx, ny);
  grid.nx += 8, grid.ny -= 4;
  write_again({"npy", folder.path() + "/" + find_export_format("npy").file},
              generate(Texture{holes}, grid), Texture{holes}, folder.options());
  const std::string why = faults_of(folder, find_export_format("npy").file);
  EXPECT_NE(why.find(fmt::format("{} x {} pixels, the design's {} x {}", nx + 8, ny - 4, nx, ny)),
            std::string::npos)
      << why;
}

TEST(Verify, RefusesAFolderWithoutARecord) {
  const Workplace place;
  EXPECT_THROW(verify_folder(place.path().string()), InputError);
  write_bytes((place.path() / kRecordName).string(), "{\"schema\": 1}");
  EXPECT_THROW(verify_folder(place.path().string()), InputError);
  write_bytes((place.path() / kRecordName).string(), "{\"made_from\": {\"design\": 3}}");
  EXPECT_THROW(verify_folder(place.path().string()), InputError);
}

TEST(Verify, NamesWhatIsNarrowerThanItsLimitAndHowFarTheMeritIsOff) {
  Study study;
  study.design.environment.relative_humidity = {0.35};
  HoleArray holes;
  holes.period = 6e-6, holes.diameter = 4e-6, holes.depth = 200e-9, holes.wall_angle = kPi / 2;
  study.design.texture = Texture{holes};
  study.constraints = {{"min_wall", 1.9e-6, true}, {"min_hole", 3.9e-6, true}};
  ExportOptions options;
  options.formats = {"gsf"};
  options.size = 12e-6;
  options.pixels = 192;
  const std::string folder = temporary("verify");
  const std::string file = export_design(study.design, options, folder).files.at(0).path;
  const Verification sound = verify_export(study, file, 0.2);
  EXPECT_TRUE(sound.faults.empty()) << sound.faults.front();
  EXPECT_NEAR(sound.pixels.min_wall, 2e-6, 0.1e-6);
  EXPECT_NEAR(sound.pixels.min_hole, 4e-6, 0.1e-6);
  EXPECT_EQ(sound.merit, "mean(friction)");  // undriven
  EXPECT_NEAR(sound.loss, std::abs(sound.file - sound.design) / sound.design, 1e-12);
  EXPECT_LT(sound.loss, 0.2);
  study.constraints[0].limit = 2.5e-6;
  const Verification narrow = verify_export(study, file, 0.2);
  ASSERT_EQ(narrow.faults.size(), 1u);
  EXPECT_TRUE(narrow.faults[0].starts_with("min_wall of the file is ")) << narrow.faults[0];
  EXPECT_NE(narrow.faults[0].find(" um, below 2.5 um (pixel 0.062 um)"), std::string::npos)
      << narrow.faults[0];
  EXPECT_EQ(verify_export(study, file, 0).faults.size(), 1u + (narrow.loss > 0));
  // A file a pixel off its limit is not narrower than it can show.
  study.constraints[0].limit = sound.pixels.min_wall + 0.5 * 0.0625e-6;
  EXPECT_TRUE(verify_export(study, file, 0.2).faults.empty());
}

}  // namespace
}  // namespace papilla::tests
