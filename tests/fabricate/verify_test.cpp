// What is said of files that differ from their design.
#include "fabricate/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/constants.h"
#include "fabricate/export.h"
#include "forward/forward.h"
#include "geometry/io/drawing.h"
#include "geometry/io/files.h"
#include "metrics/metrics.h"
#include "tests/fabricate/exported_folder.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::verify_test {
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
  HoleArray narrow = holes;  // too narrow is wrong as well
  narrow.diameter = 2.7e-6;
  again(narrow, "mask");
  EXPECT_NE(
      faults_of(folder, "mask.tif").find("its critical dimension (width of the holes) is 2.7"),
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

// A record is a text that anybody can write: memory is taken for what its files can hold.
TEST(Verify, DrawsNoMorePixelsThanTheMapsOfItsRecordHold) {
  const Workplace place;
  const Folder folder(place.path() / "f", Texture{HoleArray{}}, Polarity::WhiteDeep);
  const std::string record = folder.path() + "/export.json";
  auto json = nlohmann::ordered_json::parse(read_bytes(record));
  json["made_from"]["pixels"] = 16384;
  write_bytes(record, json.dump());
  const std::string refused = refusal_of([&] { verify_folder(folder.path(), ""); });
  EXPECT_TRUE(refused.starts_with("16384 x 16384 pixels are more than the ")) << refused;
  // Of a layout nobody knows how many they were.
  Study study;
  study.design.texture = Texture{HoleArray{}};
  ExportOptions options;
  options.formats = {"gds"};
  options.pixels = 4098;
  const std::string layout = (place.path() / "layout").string();
  export_with_record(study, options, layout);
  EXPECT_EQ(verify_folder(layout, "").at(0).state, FileState::Sound);
  // Nor where the maps beside it were taken away.
  const std::string kept = layout + "/export.json";
  json = nlohmann::ordered_json::parse(read_bytes(kept));
  json["made_from"]["files"].push_back({{"format", "exr"}, {"file", "heightmap.exr"}});
  write_bytes(kept, json.dump());
  EXPECT_EQ(verify_folder(layout, "texture.gds").at(0).state, FileState::Sound);
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

// Of a folder that an export without a polarity wrote.
TEST(Verify, TellsSoundMissingBrokenAndForeignFilesApart) {
  const Workplace place;
  Study study;
  HoleArray holes;
  holes.period = 6e-6, holes.diameter = 3e-6, holes.depth = 200e-9;
  study.design.texture = Texture{holes};
  ExportOptions options;
  options.pixels = 32, options.formats = {"gsf", "npy"};
  const std::string folder = (place.path() / "f").string();
  const Export made = export_with_record(study, options, folder);
  const auto file_of = [](const char* format) { return find_export_format(format).file; };
  const auto judged = [&](const char* format) {
    const std::vector<FileVerdict> all = verify_folder(folder, file_of(format));
    EXPECT_EQ(all.size(), 1u);
    EXPECT_EQ(all.at(0).path, folder + "/" + file_of(format));
    return all.at(0);
  };
  for (const FileVerdict& file : verify_folder(folder))
    EXPECT_EQ(file.state, FileState::Sound) << file.path;
  EXPECT_THROW(verify_folder(folder, file_of("exr")), InputError);
  fs::remove(folder + "/" + file_of("npy"));
  EXPECT_EQ(judged("npy").state, FileState::Missing);
  EXPECT_EQ(judged("npy").faults, std::vector<std::string>{"is missing"});
  const std::string gsf = folder + "/" + file_of("gsf");
  write_bytes(gsf, read_bytes(gsf).substr(0, 100));
  EXPECT_EQ(judged("gsf").state, FileState::Unreadable);
  // Files of a known name that the export did not write.
  const std::string foreign = "is not among the files of this export";
  options.polarity = Polarity::WhiteDeep;
  const auto write = [&](const char* format, double times) {
    Heightmap h = made.heightmap;
    for (double& z : h.z) z *= times;
    write_again({format, folder + "/" + file_of(format)}, h, made.texture, options);
  };
  write("mask", 1);  // the record says no polarity to judge it by
  EXPECT_EQ(judged("mask").state, FileState::Differs);
  EXPECT_EQ(judged("mask").faults, std::vector<std::string>{foreign});
  write("exr", 1);
  EXPECT_EQ(judged("exr").state, FileState::Sound);
  write("exr", 1.1);
  const FileVerdict deep = judged("exr");
  EXPECT_EQ(deep.state, FileState::Differs);
  ASSERT_EQ(deep.faults.size(), 3u);
  EXPECT_EQ(deep.faults[0], foreign);
  EXPECT_EQ(deep.faults[1], "its depth is 220 nm, the design's 200 nm: 10 % more");
}

TEST(Verify, NamesTheFirstLineInWhichADesignIsAnother) {
  const Workplace place;
  ExportRecord record;
  HoleArray holes;
  holes.depth = 200e-9;
  record.design.texture = Texture{holes};
  const std::string path = (place.path() / "design.toml").string();
  record.files = {{kDesignFormat, path}};
  write_design(path, record.design);
  EXPECT_EQ(verify_files(record, {}).at(0).state, FileState::Sound);
  Design other = record.design;
  holes.depth = 250e-9;
  other.texture = Texture{holes};
  write_design(path, other);
  const FileVerdict verdict = verify_files(record, {}).at(0);
  EXPECT_EQ(verdict.state, FileState::Differs);
  EXPECT_EQ(verdict.faults,
            std::vector<std::string>{"is another design than the files were made from: `depth = "
                                     "\"250 nm\"`, there `depth = \"200 nm\"`"});
}

// As on another machine, where the file is not.
TEST(Verify, NeedsNoBeliefOfTheFinger) {
  const Workplace place;
  Study study;
  study.design.finger.belief = (place.path() / "elsewhere.toml").string();
  ExportOptions options;
  options.pixels = 32, options.formats = {"npy"};
  const std::string folder = (place.path() / "f").string();
  export_with_record(study, options, folder);
  EXPECT_EQ(read_bytes(folder + "/" + kRecordName).find("elsewhere"), std::string::npos);
  for (const FileVerdict& file : verify_folder(folder))
    EXPECT_EQ(file.state, FileState::Sound) << file.path;
}

// What is wrong with a design stands in the record of its files, for who has them alone.
TEST(Verify, HasTheWarningsOfTheDesignInTheRecord) {
  const Workplace place;
  ExportOptions options;
  options.pixels = 32, options.formats = {"npy"};
  const std::string folder = (place.path() / "f").string();
  const Export made = export_with_record(Study{}, options, folder, {}, {}, {"it breaks a limit"});
  EXPECT_EQ(made.warnings.front(), "it breaks a limit");
  EXPECT_NE(read_bytes(folder + "/" + kRecordName).find("it breaks a limit"), std::string::npos);
}

// The design beside the files of a run keeps its belief, which is no other design.
TEST(Verify, TakesADesignWithItsBeliefForTheOneOfTheRecord) {
  const Workplace place;
  const Study study = read_study(PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml");
  ASSERT_NE(study.design.finger.belief, "");
  const std::string path = (place.path() / "design.toml").string();
  write_design(path, study.design);
  Export made;
  made.files = {{kDesignFormat, path}};
  ExportRecord record = record_of(study, {}, made);
  EXPECT_EQ(record.design.finger.belief, "");
  EXPECT_EQ(verify_files(record, {}).at(0).state, FileState::Sound);
  record.design.finger.belief = study.design.finger.belief;  // as earlier versions wrote it
  EXPECT_EQ(verify_files(record, {}).at(0).state, FileState::Sound);
}

// A picture of other bytes by another version is no fault of the folder: how to mend it is said.
TEST(Verify, NamesAnotherVersionThatMadeAFileThatDiffers) {
  Study study;
  study.design.texture = Texture{HoleArray{.period = 6e-6, .diameter = 3e-6}};
  ExportOptions options;
  options.formats = {"png"};
  options.pixels = 64;
  Export made = export_design(study.design, options, temporary("versions"));
  ExportRecord record = record_of(study, options, made);
  record.version = "0.2.2";
  EXPECT_EQ(verify_files(record, made).at(0).faults, std::vector<std::string>{});
  made.heightmap.z[0] -= 1e-6;
  const std::vector<std::string> other = verify_files(record, made).at(0).faults;
  ASSERT_EQ(other.size(), 2u);
  EXPECT_TRUE(other[1].starts_with("it was made by papilla 0.2.2, and this is")) << other[1];
  record.version.clear();
  EXPECT_TRUE(verify_files(record, made)
                  .at(0)
                  .faults.at(1)
                  .starts_with("it was made by papilla 0.2.2 or an earlier one"));
  EXPECT_EQ(verify_files(record_of(study, options, made), made).at(0).faults.size(), 1u);
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
  study.constraints = {read_constraint("min_wall", 1.9e-6), read_constraint("min_hole", 3.9e-6)};
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
  ASSERT_GT(narrow.loss, 0);
  const Verification strict = verify_export(study, file, 0.5 * narrow.loss);
  ASSERT_EQ(strict.faults.size(), 2u);
  EXPECT_TRUE(strict.faults[1].ends_with(
      fmt::format(": {:.2g} % off, more than {:.2g} %", 100 * narrow.loss, 50 * narrow.loss)))
      << strict.faults[1];
  // A file a pixel off its limit is not narrower than it can show.
  study.constraints[0].limit = sound.pixels.min_wall + 0.5 * 0.0625e-6;
  EXPECT_TRUE(verify_export(study, file, 0.2).faults.empty());
}

// Rims of 100 nm make holes of 45 nm wider half-way down than at the land, where their walls keep
// the limit: that is no fault of the file. Walls that are narrower than the design's are.
TEST(Verify, ARoundRimBreaksNoLimitThatTheLandKeeps) {
  Study study;
  study.design.environment.relative_humidity = {0.35};
  HoleArray holes;
  holes.period = 4.674e-6, holes.diameter = 4.071e-6, holes.depth = 45e-9;
  holes.wall_angle = 80 * kPi / 180, holes.edge_radius = 100e-9;
  study.design.texture = Texture{holes};
  study.constraints = {read_constraint("min_wall", 0.6e-6)};
  ExportOptions options;
  options.formats = {"gsf"};
  options.pixels = 512;
  const std::string folder = temporary("verify_rim");
  const std::string file = export_design(study.design, options, folder).files.at(0).path;
  const Verification sound = verify_export(study, file, 0.2);
  EXPECT_LT(sound.pixels.min_wall, 0.6e-6 - sound.pixels.pixel);
  EXPECT_TRUE(sound.faults.empty()) << sound.faults.front();
  holes.diameter = 3.9e-6;  // the file's walls are .17 um narrower than these
  study.design.texture = Texture{holes};
  const Verification narrow = verify_export(study, file, 1);
  ASSERT_EQ(narrow.faults.size(), 1u);
  EXPECT_TRUE(narrow.faults[0].starts_with("min_wall of the file is ")) << narrow.faults[0];
}

// Where nothing repeats the patch of a design is 12 um wide: of a file of twice that only as much
// is judged, one that is hardly larger is judged whole, and as it is.
TEST(Verify, OfAFileThatIsMuchLargerThanItsDesignsPatchAPatchIsJudged) {
  Study study;
  study.design.environment.relative_humidity = {0.35};
  RandomRough rough;
  rough.rms = 30e-9;
  study.design.texture = Texture{rough};
  const std::string file = temporary("patch.gsf");
  const Scene scene = scene_of(study.design);
  for (const auto& [side, other] : {std::pair{24, 12}, {15, 15}}) {
    const Grid grid{16 * side / 3, 16 * side / 3, 1e-6 * side, 1e-6 * side};
    const Heightmap drawn = generate(study.design.texture, grid);
    write_gsf(file, drawn, {});
    const auto judged = [&](double patch) {
      Measured3d map;
      map.file = file, map.patch = patch, map.as_is = patch == grid.lx;
      map.top = *std::max_element(drawn.z.begin(), drawn.z.end());
      return summarise(Summary::Mean, kFriction,
                       evaluate(scene, Texture{map}, fidelity_level("draft")))
          ->value;
    };
    const double found = verify_export(study, file, 1).file;
    EXPECT_NEAR(found, judged(1e-6 * other), 1e-9 * found) << side;
    EXPECT_GT(std::abs(found - judged(1e-6 * (other == 12 ? side : 12))), 1e-6 * found) << side;
  }
}

// A lattice is judged on the patch of its design, whatever the sides of the file: of two by two
// periods where the design is simulated on two by three, of as many more as leave half a period on
// either side of its middle.
TEST(Verify, TheMapOfALatticeIsJudgedOnThePatchOfItsDesign) {
  Study study;
  study.design.environment.relative_humidity = {0.35};
  HoleArray holes;
  holes.period = 4.9e-6, holes.diameter = 2.4e-6, holes.depth = 300e-9;
  study.design.texture = Texture{holes};
  const Grid patch = simulated_patch(study.design.texture, 128);
  ASSERT_GT(patch.ly, 1.4 * patch.lx);
  const std::string file = temporary("lattice.gsf");
  for (const int periods : {2, 5}) {
    const int pixels = 98 * periods;
    const Grid grid{pixels, pixels, periods * holes.period, periods * holes.period};
    write_gsf(file, generate(study.design.texture, grid), {});
    EXPECT_LT(verify_export(study, file, 0.05).loss, 0.01) << periods;
  }
  // As wide as the patch, and half a patch longer.
  std::get<HoleArray>(study.design.texture.kind).period = 6e-6;
  write_gsf(file, generate(study.design.texture, {120, 180, 12e-6, 18e-6}), {});
  EXPECT_LT(verify_export(study, file, 0.05).loss, 0.01);
}

// The files are right, and what they are files of breaks down.
TEST(Verify, NotesWhatTheModelSaysAgainstTheDesign) {
  Study study;
  study.design.environment.relative_humidity = {0.35};
  study.design.texture = Texture{HoleArray{.period = 6e-6, .diameter = 3e-6, .depth = 300e-9}};
  study.design.drive.amplitude = 5000;
  const std::string file = temporary("breaks.gsf");
  write_gsf(file, generate(study.design.texture, simulated_patch(study.design.texture, 128)), {});
  const Verification found = verify_export(study, file, 0.05);
  EXPECT_TRUE(found.faults.empty()) << found.faults.front();
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_TRUE(found.notes[0].starts_with("of the design itself: 35 % RH: breakdown: "))
      << found.notes[0];
}

// Grooves of 2 um in 6 um and of 0.8 um in 3 um: each mask has walls of 2.2 um at least, and 0.1 um
// are left between a groove of one and its neighbour of the other. That is no fault of the file,
// and is said. The file is felt on the patch of the design, though a stack has no relief of its
// own.
TEST(Verify, NotesWhatTwoPartsOfAStackLeaveBetweenThem) {
  Study study;
  study.design.environment.relative_humidity = {0.35};
  Stack both;
  both.parts = {
      Texture{Grating{.period = 6e-6, .width = 2e-6, .depth = 200e-9, .wall_angle = kPi / 2}},
      Texture{Grating{.period = 3e-6, .width = 0.8e-6, .depth = 200e-9, .wall_angle = kPi / 2}}};
  study.design.texture = Texture{both};
  study.constraints = {read_constraint("min_wall", 1e-6)};
  ExportOptions options;
  options.formats = {"gsf"};
  options.size = 12e-6;
  options.pixels = 480;
  const std::string folder = temporary("verify_stack");
  const std::string file = export_design(study.design, options, folder).files.at(0).path;
  const Verification found = verify_export(study, file, 0.05);
  EXPECT_TRUE(found.faults.empty()) << found.faults.front();
  EXPECT_LT(found.pixels.min_wall, 0.2e-6);
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_TRUE(found.notes[0].starts_with("min_wall of the file is 0.")) << found.notes[0];
  EXPECT_NE(found.notes[0].find("each part of the stack alone keeps the limit"), std::string::npos)
      << found.notes[0];
  study.constraints = {read_constraint("min_wall", 2.5e-6)};  // more than a part has
  EXPECT_EQ(verify_export(study, file, 0.05).faults.size(), 1u);
}

// Holes of 2 um in 4 um keep 1.95 um of land; rims of 0.8 um take some of it half-way down, with
// nothing beside them as much as without a stack.
TEST(Verify, NotesNothingOfAStackThatOnePartIsByItself) {
  Study study;
  study.design.environment.relative_humidity = {0.35};
  Stack alone;
  alone.parts = {Texture{HoleArray{.period = 4e-6,
                                   .diameter = 2e-6,
                                   .depth = 200e-9,
                                   .wall_angle = kPi * 80 / 180,
                                   .edge_radius = 0.8e-6}},
                 Texture{}};
  study.design.texture = Texture{alone};
  study.constraints = {read_constraint("min_wall", 1.95e-6)};
  ExportOptions options;
  options.formats = {"gsf"};
  options.size = 12e-6;
  options.pixels = 480;
  const std::string folder = temporary("verify_rims");
  const std::string file = export_design(study.design, options, folder).files.at(0).path;
  const Verification found = verify_export(study, file, 0.05);
  EXPECT_LT(found.pixels.min_wall, 1.95e-6 - found.pixels.pixel);
  EXPECT_TRUE(found.faults.empty()) << found.faults.front();
  EXPECT_TRUE(found.notes.empty()) << found.notes.front();
}

}  // namespace
}  // namespace papilla::tests::verify_test
