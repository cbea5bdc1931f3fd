// An export as people and programs read it: made-up numbers, each another.
#include "report/export.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "report/fields.h"
#include "report/verdict.h"
#include "tests/report/same_json.h"
#include "tests/temporary.h"

namespace papilla::tests::export_test {
namespace {

Export made_up() {
  Export e;
  e.files = {{"gsf", "out/heightmap.gsf"}, {"png", "out/heightmap.png"}};
  e.heightmap = {{2, 3, 4e-6, 9e-6}, {0, -1e-7, 3e-8, 0, -4e-7, 0}};
  return e;
}

ExportVerdict felt() {
  ExportVerdict v;
  v.files = {{"out/heightmap.gsf", FileState::Sound, {}},
             {"out/mask.tif", FileState::Differs, {"too wide", "too deep"}},
             {"out/a.png", FileState::Missing, {"is not there"}},
             {"out/b.png", FileState::Unreadable, {"no PNG"}}};
  v.felt = Verification{{2e-6, 1.5e-6, 3e-8}, "mean(modulation)", 0.25, 0.2, 0.2, {"is felt"}};
  return v;
}

TEST(ExportReport, ForPeopleHasTheSizeInItsUnits) {
  Export e = made_up();
  EXPECT_EQ(export_text(e, "out", {}),
            "out/heightmap.gsf\nout/heightmap.png\nout/export.json\n"
            "size 4 x 9 um, 2 x 3 pixels of 2000 x 3000 nm\n");
  e.repeat = 3;
  EXPECT_TRUE(export_text(e, "out", {})
                  .ends_with("pixels of 2000 x 3000 nm; the EXR 3 x 3 times that: 12 x 27 um\n"));
  e.repeat = 1;
  e.cells_x = 8, e.cells_y = 4;
  EXPECT_EQ(export_text(e, "out", felt()),
            "out/heightmap.gsf\nout/heightmap.png\nout/export.json\n"
            "size 4 x 9 um, 2 x 3 pixels of 2000 x 3000 nm, 8 x 4 periods of 0.5 x 2.25 um\n"
            "at half the depth smallest hole 2 um, smallest wall 1.5 um (pixel 0.03 um); "
            "mean(modulation) 0.2, of "
            "the design 0.25: 20 % off\n");
  e.heightmap.grid.lx = 1.000002;
  EXPECT_NE(export_text(e, "out", {}).find("size 1000002 x 9 um"), std::string::npos);
  e.heightmap.grid.lx = 4e-6;
  // A layout of an array has no pixels.
  e.array = LayoutArray{};
  e.files = {{"gds", "out/texture.gds"}, {"oasis", "out/texture.oas"}};
  EXPECT_TRUE(
      export_text(e, "out", {}).ends_with("size 4 x 9 um, 8 x 4 periods of 0.5 x 2.25 um\n"));
}

TEST(ExportReport, AVerdictIsALineAFileAndALineAFault) {
  ExportVerdict v = felt();
  EXPECT_EQ(verdict_text(v),
            "out/heightmap.gsf  sound\n"
            "out/mask.tif       differs\n"
            "out/a.png          missing\n"
            "out/b.png          unreadable\n"
            "at half the depth smallest hole 2 um, smallest wall 1.5 um (pixel 0.03 um); "
            "mean(modulation) 0.2, of "
            "the design 0.25: 20 % off\n");
  EXPECT_EQ(fault_lines(v),
            (std::vector<std::string>{"out/mask.tif: too wide", "out/mask.tif: too deep",
                                      "out/a.png: is not there", "out/b.png: no PNG", "is felt"}));
  v.felt->file = v.felt->loss = std::nan("");
  EXPECT_TRUE(verdict_text(v).ends_with("mean(modulation) not known, of the design 0.25\n"))
      << verdict_text(v);
  v.felt->file = v.felt->loss = 0.2;
  v.felt->against = "the design with the process undone";
  EXPECT_NE(verdict_text(v).find("0.2, of the design with the process undone 0.25: 20 % off"),
            std::string::npos)
      << verdict_text(v);
  v.felt->pixels.min_wall = kInfinity;
  EXPECT_NE(verdict_text(v).find("smallest hole 2 um"), std::string::npos);
  v.felt->pixels.min_hole = kInfinity;  // a surface without edges has none to speak of
  EXPECT_NE(verdict_text(v).find("unreadable\nmean(modulation) 0.2"), std::string::npos);
  v.felt->pixels.min_wall = 1.5e-6;
  EXPECT_NE(verdict_text(v).find("smallest wall 1.5 um"), std::string::npos);
  v.felt.reset();
  EXPECT_TRUE(verdict_text(v).ends_with("unreadable\n"));
}

TEST(ExportReport, IsSoundWhereEveryFileAndTheFeelingAre) {
  ExportVerdict v = felt();
  EXPECT_FALSE(v.readable());
  v.files.pop_back();
  EXPECT_TRUE(v.readable());
  v.felt->faults.clear();
  EXPECT_FALSE(v.sound());
  v.files.resize(1);
  EXPECT_TRUE(v.sound());
  v.felt->faults = {"is felt"};
  EXPECT_FALSE(v.sound());
  v.felt.reset();
  EXPECT_TRUE(v.sound());
}

TEST(ExportReport, VerdictsOfFoldersAreSoundTogether) {
  ExportVerdict good;
  good.files = {{"a/heightmap.gsf", FileState::Sound, {}}};
  const nlohmann::json sound{
      {"folder", "a"},
      {"sound", true},
      {"files",
       nlohmann::json::array(
           {{{"file", "heightmap.gsf"}, {"state", "sound"}, {"faults", nlohmann::json::array()}}})},
      {"verification", nullptr}};
  expect_document(verdict_json({{"a", good}}),
                  {{"schema", 1}, {"sound", true}, {"folders", nlohmann::json::array({sound})}});
  expect_document(
      verdict_json({{"out", felt()}, {"a", good}}),
      {{"schema", 1},
       {"sound", false},
       {"folders",
        {{{"folder", "out"},
          {"sound", false},
          {"files",
           {{{"file", "heightmap.gsf"}, {"state", "sound"}, {"faults", nlohmann::json::array()}},
            {{"file", "mask.tif"}, {"state", "differs"}, {"faults", {"too wide", "too deep"}}},
            {{"file", "a.png"}, {"state", "missing"}, {"faults", {"is not there"}}},
            {{"file", "b.png"}, {"state", "unreadable"}, {"faults", {"no PNG"}}}}},
          {"verification",
           {{"min_hole", 2e-6},
            {"min_wall", 1.5e-6},
            {"pixel", 3e-8},
            {"merit", "mean(modulation)"},
            {"against", "the design"},
            {"design", 0.25},
            {"file", 0.2},
            {"loss", 0.2},
            {"faults", {"is felt"}}}}},
         sound}}});
}

TEST(ExportReport, TheRecordHasWhatTheFilesHold) {
  Study study;
  study.design = read_design(find_design("m3_samples/a3h600.toml"));
  ExportOptions options;
  options.formats = {"gsf"};
  options.repeat = 3, options.bias.shrink = 2e-8;
  Export e = made_up();
  e.texture = study.design.texture;
  e.cells_x = 8, e.cells_y = 4;
  e.warnings = {"a warning"};
  const auto record = [&](const ExportVerdict& v = {}) {
    return nlohmann::json::parse(export_json(study, options, e, "out", v));
  };
  nlohmann::json json = record();
  EXPECT_TRUE(json.contains("made_from"));
  json.erase("made_from");
  const FabricationMargins margins = facts(e.texture).margins;
  nlohmann::json expected{{"schema", 1},
                          {"title", study.design.title},
                          {"texture", texture_name(e.texture)},
                          {"pixels", {2, 3}},
                          {"size", {4e-6, 9e-6}},
                          {"cells", {8, 4}},
                          {"lowest", -4e-7},
                          {"highest", 3e-8},
                          {"polarity", nullptr},
                          {"min_hole", margins.min_hole},
                          {"min_wall", margins.min_wall},
                          {"aspect_ratio", margins.aspect_ratio},
                          {"process_shrink", 2e-8},
                          {"exr_repeat", 3},
                          {"layout", nullptr},
                          {"dose", nullptr},
                          {"files",
                           {{{"format", "gsf"}, {"file", "heightmap.gsf"}},
                            {{"format", "png"}, {"file", "heightmap.png"}}}},
                          {"warnings", {"a warning"}},
                          {"folder", "out"},
                          {"verdict", nlohmann::json::array()}};
  expect_same(json, expected, "record");
  options.polarity = Polarity::WhiteHigh;
  EXPECT_EQ(record()["polarity"], "white-high");
  options.polarity = Polarity::WhiteDeep;
  EXPECT_EQ(record()["polarity"], "white-deep");
  e.dose = DoseMap{12.5, 200.25, 7, 9};
  e.contours = LayoutContours{11, 5};
  json = record(felt());
  expect_same(json["dose"],
              {{"lowest_grey", 12.5},
               {"highest_grey", 200.25},
               {"clipped_shallow", 7},
               {"clipped_deep", 9}},
              "dose");
  expect_same(json["layout"], {{"polygons", 11}, {"levels", 5}, {"drawn", "deep"}}, "contours");
  EXPECT_EQ(json["verdict"].size(), 4u);
  EXPECT_EQ(json["verification"]["loss"], 0.2);
  e.array = LayoutArray{20, 10, 3e-6, 5e-6, 1e-9, 16, "pillars"};
  expect_same(record()["layout"],
              {{"columns", 20},
               {"rows", 10},
               {"pitch", {3e-6, 5e-6}},
               {"drift", 1e-9},
               {"sides", 16},
               {"drawn", "pillars"}},
              "array");
}

// A file by itself; a folder with a record; a run's best and front, each by its name.
TEST(ExportPlaces, AreFilesFoldersAndTheDesignsOfARun) {
  namespace fs = std::filesystem;
  const std::string run = temporary("places");
  const auto places = [](const std::string& path) {
    std::vector<std::pair<std::string, std::string>> out;
    for (const ExportPlace& p : export_places(path)) out.emplace_back(p.folder, p.file);
    return out;
  };
  using Places = std::vector<std::pair<std::string, std::string>>;
  EXPECT_THROW(export_places(run), InputError);
  for (const char* below : {"front/02", "front/01", "best", "other", "front/none"})
    fs::create_directories(run + "/" + below);
  EXPECT_EQ(places(run), (Places{{run, ""}}));  // says what is missing
  for (const char* below : {"front/02", "front/01", "best", "other"})
    write_bytes(run + "/" + below + "/export.json", "{}");
  EXPECT_EQ(places(run + "//"),
            (Places{{run + "/best", ""}, {run + "/front/01", ""}, {run + "/front/02", ""}}));
  EXPECT_EQ(places(run + "/other/"), (Places{{run + "/other", ""}}));
  EXPECT_EQ(places(run + "/front/none"), (Places{{run + "/front/none", ""}}));
  EXPECT_EQ(places(run + "/best/export.json"), (Places{{run + "/best", "export.json"}}));
}

TEST(FieldPictures, OfAnEarlierRunAreRemovedAndNothingElse) {
  namespace fs = std::filesystem;
  const std::string folder = temporary("fields");
  fs::create_directories(folder);
  const std::vector<std::string> old{"gap_15.png",   "pressure_off_35.npy", "pressure_on_5.png",
                                     "pull_100.npy", "water_15.png",        "gap_50.3.png"},
      others{"gap_15.csv", "gap_.png", "gap.png", "mine_15.png", "gap_1a.png", "pressure_15.png"};
  for (const auto* names : {&old, &others}) {
    for (const std::string& name : *names) write_bytes(folder + "/" + name, "x");
  }
  remove_field_pictures(folder);  // no folder of results
  EXPECT_TRUE(fs::exists(folder + "/gap_15.png"));
  write_bytes(folder + "/response.json", "{}");
  remove_field_pictures(folder);
  for (const std::string& name : old) EXPECT_FALSE(fs::exists(folder + "/" + name)) << name;
  for (const std::string& name : others) EXPECT_TRUE(fs::exists(folder + "/" + name)) << name;
}

}  // namespace
}  // namespace papilla::tests::export_test
