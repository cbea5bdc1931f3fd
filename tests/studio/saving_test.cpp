// Saved files are what a person would have written.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <tuple>

#include "base/error.h"
#include "base/files.h"
#include "base/units.h"
#include "config/describe.h"
#include "geometry/io/files.h"
#include "studio/files.h"
#include "tests/io/instrument_bytes.h"
#include "tests/temporary.h"

namespace papilla::tests::saving_test {
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

// From its first letter to its last, whatever stands in it and behind it.
TEST(EditedToml, FindsTheEndOfAValue) {
  for (const auto& [before, after] : {std::pair{"a = \"\"\nb = \"x\"\n", "a = 7\nb = \"x\"\n"},
                                      {"a = \"x\"\n", "a = 7\n"},
                                      {"a = ''\nb = 'x'\n", "a = 7\nb = 'x'\n"},
                                      {"a = 'c:\\'\nb = 'x'\n", "a = 7\nb = 'x'\n"},
                                      {"a = \"it's\"  # it's\n", "a = 7  # it's\n"},
                                      {"a = \"\\\\\"\nb = \"x\"\n", "a = 7\nb = \"x\"\n"},
                                      {"a = \"say \\\"no\\\"\"  # b\n", "a = 7  # b\n"},
                                      {"a = [\"]\", ']', \"\"] # ]\n", "a = 7 # ]\n"},
                                      {"a = [[1, 2], [3]]\nb = [4]\n", "a = 7\nb = [4]\n"},
                                      {"a = []\nb = []\n", "a = 7\nb = []\n"},
                                      {"a = true \t # b\n", "a = 7 \t # b\n"},
                                      {"a = -1.5e-3", "a = 7"},
                                      {"a = 1\r\nb = 2\r\n", "a = 7\r\nb = 2\r\n"},
                                      {"b = \"\u00b5\u00b5\"\nc = { d = \"\u00b5\" }\na = 1\n",
                                       "b = \"\u00b5\u00b5\"\nc = { d = \"\u00b5\" }\na = 7\n"}})
    EXPECT_EQ(edited_toml(before, {{"a", "7"}}), after);
  for (const auto& [before, after] :
       {std::pair{"s = { a = 1, b = 2 }\n", "s = { a = 7, b = 2 }\n"},
        {"s = { b = 2 , a = 1 }\n", "s = { b = 2 , a = 7 }\n"},
        {"s = { b = \"\u00b5\u00b5\", a = 1 } # c\n", "s = { b = \"\u00b5\u00b5\", a = 7 } # c\n"},
        {"s = {a=[1],b=2}\n", "s = {a=7,b=2}\n"}})
    EXPECT_EQ(edited_toml(before, {{"s.a", "7"}}), after);
}

// Bare where TOML takes it so.
TEST(EditedToml, QuotesWhatIsNoValueOfToml) {
  for (const auto& [text, written] : {std::pair{"2", "2"},
                                      {"-1e-3", "-1e-3"},
                                      {"true", "true"},
                                      {"[1, 2]", "[1, 2]"},
                                      {"\"x\"", "\"x\""},
                                      {"262 nm", "\"262 nm\""},
                                      {"on", "\"on\""}})
    EXPECT_EQ(edited_toml("a = 0\n", {{"a", text}}), std::string("a = ") + written + "\n");
}

TEST(EditedToml, ANewKeyStandsBehindTheLastThatItsSectionSays) {
  const std::vector<studio::Change> x{{"a.x", "1"}};
  for (const auto& [before, after] :
       {std::pair{"", "[a]\nx = 1\n"},
        {"b = 2", "b = 2\n\n[a]\nx = 1\n"},
        {"b = 2\n", "b = 2\n\n[a]\nx = 1\n"},
        {"b = 2\n\n", "b = 2\n\n[a]\nx = 1\n"},
        {"[a]\n", "[a]\nx = 1\n"},
        {"[a]", "[a]\nx = 1"},
        {"  [ a ]  # a\ny = 2 # y\n\n  # of b\n [b]\nz = 3\n",
         "  [ a ]  # a\ny = 2 # y\nx = 1\n\n  # of b\n [b]\nz = 3\n"},
        {"[a]\r\ny = 2\r\n\r\n[b]\r\n", "[a]\r\ny = 2\r\nx = 1\n\r\n[b]\r\n"},
        {"[a]\n# y = 1\ny = 2\n\n# z\nz = 3\n", "[a]\n# y = 1\ny = 2\n\n# z\nz = 3\nx = 1\n"},
        {"[b]\n[a]\ny = 2\n[c]\n", "[b]\n[a]\ny = 2\nx = 1\n[c]\n"},
        // Said by a section below it alone.
        {"[a.b]\ny = 2\n", "[a.b]\ny = 2\n\n[a]\nx = 1\n"},
        {"[[a.b]]\ny = 2\n", "[[a.b]]\ny = 2\n\n[a]\nx = 1\n"}})
    EXPECT_EQ(edited_toml(before, x), after);
}

// Where a section has no header it gets none: that would say it twice.
TEST(EditedToml, ANewKeyStandsInTheLineOfItsTable) {
  for (const auto& [before, after] :
       {std::pair{"s = { a = 1 }\n", "s = { a = 1, b = 2 }\n"},
        {"s = {a=\"}\"} # s\n", "s = {a=\"}\", b = 2} # s\n"},
        {"s = {}\n", "s = { b = 2 }\n"},
        {"s.a = 1\n\n[t]\nc = 3\n", "s.a = 1\ns.b = 2\n\n[t]\nc = 3\n"}})
    EXPECT_EQ(edited_toml(before, {{"s.b", "2"}}), after);
  EXPECT_EQ(edited_toml("f = { a = 1 }\n", {{"f.w.x", "2"}, {"f.w.y", "3"}}),
            "f = { a = 1, w.x = 2, w.y = 3 }\n");
  EXPECT_EQ(edited_toml("[f]\nw.x = 1\n[t]\n", {{"f.w.y", "2"}}), "[f]\nw.x = 1\nw.y = 2\n[t]\n");
}

TEST(EditedToml, ANewKeyOfAnItemStandsInIt) {
  const std::vector<studio::Change> second{{"f.l.1.b", "2"}, {"f.l.1.r.law", "debye"}};
  EXPECT_EQ(edited_toml("[f]\nl = [{ a = 1 }, { a = 3 }]\n", second),
            "[f]\nl = [{ a = 1 }, { a = 3, b = 2, r.law = \"debye\" }]\n");
  EXPECT_EQ(
      edited_toml("[[f.l]]\na = 1\n[f.l.r]\nx = 1\n\n[[ f.l ]] # two\na = 3\n\n[g]\n", second),
      "[[f.l]]\na = 1\n[f.l.r]\nx = 1\n\n[[ f.l ]] # two\na = 3\nb = 2\nr.law = \"debye\"\n"
      "\n[g]\n");
  EXPECT_EQ(edited_toml("[[f.l]]\n[[f.l]]\na = 3\n[f.l.r]\nx = 1\n", second),
            "[[f.l]]\n[[f.l]]\na = 3\nb = 2\n[f.l.r]\nx = 1\nlaw = \"debye\"\n");
  // By the numbers of its items.
  EXPECT_EQ(edited_toml("[f.l.1]\na = 3\n", second),
            "[f.l.1]\na = 3\nb = 2\n\n[f.l.1.r]\nlaw = \"debye\"\n");
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

// Of the same kind nothing goes, nor of another section.
TEST(EditedToml, OnlyANewKindTakesTheMembersAway) {
  const std::string text =
      "[surface]\nd = 1\n\n[texture]\n# holes\ntype = \"hole_array\"\ndepth = 2 # deep\n\n"
      "# drive\n[drive]\namplitude = 3\n";
  EXPECT_EQ(edited_toml(text, {{"texture.type", "hole_array"}}), text);
  EXPECT_EQ(edited_toml(text, {{"texture.type", "\"hole_array\""}}), text);
  EXPECT_EQ(edited_toml(text, {{"texture.type", "flat"}}),
            "[surface]\nd = 1\n\n[texture]\ntype = \"flat\"\n\n# drive\n[drive]\n"
            "amplitude = 3\n");
  EXPECT_EQ(edited_toml("texture = { type = \"flat\", a = 1 }\n", {{"texture.type", "hole_array"}}),
            "texture = { type = \"hole_array\", a = 1 }\n");
}

class Saving : public ::testing::Test {
 protected:
  // The draft saved, as its file reads back.
  std::string save(const Draft& draft, const std::string& name) {
    files_.save(draft, study_of(draft), files_.target(name, true));
    Design wanted = study_of(draft).design;
    wanted.title = title_of(draft, wanted);
    EXPECT_EQ(read_design(place_.path() / name), wanted);
    return read_bytes(place_.path() / name);
  }

  const TemporaryFolder place_;
  const Files files_{place_.path()};
  const std::string shipped_ = PAPILLA_DESIGNS_DIR "/m3_samples/a3h600.toml";
};

TEST_F(Saving, StandsOnAShippedDesignWithTheChangedKeysAlone) {
  EXPECT_EQ(
      save({shipped_, {{"texture.depth", "262 nm"}, {"drive.amplitude", "120 V"}}}, "mine.toml"),
      "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n"
      "title = \"Published sample: holes of 3 um, 600 nm deep, period 6 um; texture.depth 262 nm; "
      "drive.amplitude 120 V\"\n\n[texture]\ndepth = \"262 nm\"\n\n[drive]\namplitude = "
      "\"120 V\"\n");
}

// Saved again and again it says each value once; a file that has a title has it in its own line.
TEST_F(Saving, SaysInTheTitleWhatWasChanged) {
  const std::string file = place_.path() / "mine.toml";
  write_bytes(file,
              "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\ntitle = \"Mine\"  # first\n");
  save({file, {{"texture.depth", "262 nm"}}}, "mine.toml");
  const std::string text = save({file, {{"texture.depth", "300 nm"}}}, "mine.toml");
  EXPECT_NE(text.find("\ntitle = \"Mine; texture.depth 300 nm\"  # first\n"), std::string::npos)
      << text;
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

TEST_F(Saving, TwoChangedItemsOfAListAreOneList) {
  const std::string text = save({shipped_,
                                 {{"surface.dielectric.0.thickness", "700 nm"},
                                  {"surface.dielectric.0.permittivity", "4.5"}}},
                                "film.toml");
  const std::string key = "dielectric = ";  // its title names the changed items too
  std::size_t lists = 0;
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1))
    ++lists;
  EXPECT_EQ(lists, 1u) << text;
}

// Of a film that the file itself has, however it says it.
TEST_F(Saving, AFilmOfItsOwnFileTakesKeysThatItHadNot) {
  const std::string head = "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n\n";
  const std::string file = place_.path() / "mine.toml";
  for (const char* film :
       {"[surface]\ndielectric = [{ material = \"SiO2\", thickness = \"1 um\" }]\n",
        "[[surface.dielectric]]\nmaterial = \"SiO2\"\nthickness = \"1 um\"\n",
        "[surface.dielectric.0]\nthickness = \"1 um\"\n"}) {
    write_bytes(file, head + film);
    const std::string text = save({file,
                                   {{"surface.dielectric.0.refractive_index", "1.46"},
                                    {"surface.dielectric.0.relaxation.law", "debye"},
                                    {"surface.dielectric.0.relaxation.time", "1 us"},
                                    {"surface.contact_angle", "70 deg"}}},
                                  "mine.toml");
    EXPECT_NE(text.find("refractive_index = 1.46"), std::string::npos) << text;
  }
}

// A base below a folder of designs is named from there, any other from the file that names it.
TEST_F(Saving, ABaseIsNamedFromTheFolderOfItsFile) {
  save({shipped_, {{"texture.depth", "262 nm"}}}, "sub/mine.toml");
  const std::string own = place_.path() / "sub/mine.toml";
  EXPECT_EQ(
      save({own, {{"drive.amplitude", "120 V"}}}, "copy.toml"),
      "schema_version = 1\nbase = \"sub/mine.toml\"\n"
      "title = \"Published sample: holes of 3 um, 600 nm deep, period 6 um; texture.depth 262 "
      "nm; drive.amplitude 120 V\"\n\n[drive]\namplitude = \"120 V\"\n");
}

// A file stands on none above its folder: there it has every value, of a study also its search.
TEST_F(Saving, WritesTheWholeDesignWhereItsBaseWouldLieAboveIt) {
  save({shipped_, {{"texture.depth", "262 nm"}}}, "two.toml");
  const std::string two = place_.path() / "two.toml";
  const std::string text = save({two, {{"drive.amplitude", "120 V"}}}, "sub/new.toml");
  EXPECT_EQ(text.find("base = "), std::string::npos) << text;
  EXPECT_NE(text.find("depth = \"262 nm\""), std::string::npos) << text;
  fs::remove(two);
  EXPECT_DOUBLE_EQ(
      get_number(read_design((place_.path() / "sub/new.toml").string()), "drive.amplitude"), 120);
  write_bytes(place_.path() / "study.toml",
              read_bytes(PAPILLA_DESIGNS_DIR "/hydrophobic_glass/study.toml"));
  save({place_.path() / "study.toml", {{"drive.amplitude", "120 V"}}}, "other/study.toml");
  EXPECT_TRUE(read_study((place_.path() / "other/study.toml").string()).is_study());
}

// A list that was set as a whole, in the place of its sections.
TEST_F(Saving, AListStandsInThePlaceOfItsSections) {
  const std::string file = place_.path() / "mine.toml";
  write_bytes(file,
              "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n\n[[surface.dielectric]]\n"
              "material = \"SiO2\"\nthickness = \"1 um\"\n[surface.dielectric.relaxation]\n"
              "law = \"debye\"\ntime = \"1 us\"\n\n# air\n[environment]\n"
              "relative_humidity = [\"35 %\"]\n");
  const Design design = read_design(file);
  Design thick = design;
  thick.surface.dielectric.push_back(thick.surface.dielectric.front());
  const std::string text = save({file, changes_between(design, thick)}, "mine.toml");
  EXPECT_EQ(text.find("[["), std::string::npos) << text;
  EXPECT_NE(text.find("\n# air\n[environment]\nrelative_humidity = [\"35 %\"]\n"),
            std::string::npos)
      << text;
  EXPECT_EQ(changes_between(read_design(file), thick), std::vector<studio::Change>{});
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
  const std::string text = save(draft, "scanned.toml");
  EXPECT_NE(text.find("file = \"scans/mine.gsf\""), std::string::npos) << text;
  EXPECT_EQ(text.find(place_.path().string()), std::string::npos) << text;  // nor in its title
  EXPECT_THROW(files_.keep_scan("mine.exe", bytes), InputError);
  EXPECT_THROW(files_.keep_scan("../mine.gsf", bytes), InputError);
  EXPECT_THROW(files_.with_scan({shipped_, {}}, "../scan.gsf", "", false, false), InputError);
}

// Designs to the fourth folder down; nothing hidden, and no resolved copies.
TEST_F(Saving, ListsDesignsAndFinishedSearches) {
  for (const char* name : {"b.toml", "a.toml", "resolved.toml", ".hidden.toml", ".in/c.toml",
                           "c.txt", "d/e/f/g.toml", "d/e/f/x/y.toml", "s/001/study.toml",
                           "s/001/run.json", "s/002/study.toml", "s/resolved.toml"}) {
    fs::create_directories((place_.path() / name).parent_path());
    write_bytes(place_.path() / name, "");
  }
  const auto list = files_.list();
  EXPECT_EQ(list["folder"], place_.path().filename().string());
  EXPECT_EQ(list["designs"], nlohmann::ordered_json({"a.toml", "b.toml", "d/e/f/g.toml",
                                                     "s/001/study.toml", "s/002/study.toml"}));
  EXPECT_EQ(list["results"], nlohmann::ordered_json({"s/001"}));
  EXPECT_EQ(list.size(), 3u);
  EXPECT_EQ(files_.open("a.toml"), fs::weakly_canonical(place_.path() / "a.toml").string());
  for (const char* name : {"c.txt", "../a.toml", ".hidden.toml", ""})
    EXPECT_THROW(files_.open(name), InputError) << name;
  for (int i = 0; i < 200; ++i) write_bytes(place_.path() / fmt::format("e{:03}.toml", i), "");
  EXPECT_EQ(files_.list()["designs"].size(), 200u);
}

TEST_F(Saving, AnExportIsShownBeforeItIsMade) {
  Study study = read_study(shipped_);
  study.constraints = {read_constraint("min_wall", 1e-6), read_constraint("aspect_ratio", 0.5)};
  const auto preview = files_.export_preview(study);
  // Holes of 3 um at a pitch of 6 um, 600 nm deep.
  const auto row = [&](std::size_t i) { return preview["margins"][i]; };
  EXPECT_EQ(preview["margins"].size(), 2u);
  EXPECT_EQ(row(0)["name"], "smallest hole");
  EXPECT_NEAR(row(0)["value"].get<double>(), 3e-6, 1e-15);
  EXPECT_TRUE(row(0)["limit"].is_null());
  EXPECT_EQ(row(1)["name"], "smallest wall");
  EXPECT_NEAR(row(1)["value"].get<double>(), 3e-6, 1e-15);
  EXPECT_EQ(row(1)["limit"], 1e-6);
  EXPECT_NEAR(preview["aspect_ratio"]["value"].get<double>(), 0.2, 1e-12);
  EXPECT_EQ(preview["aspect_ratio"]["limit"], 0.5);
  bool mask = false;
  for (const auto& f : preview["formats"]) {
    EXPECT_EQ(f.size(), 3u);
    mask = mask || (f["name"] == "mask" && f["file"] == "mask.tif");
  }
  EXPECT_TRUE(mask);
}

// No file has a droplet: what has too many is saved and exported, and what is left out is said.
TEST_F(Saving, ADesignThatNoSimulationSettlesIsSavedAndExported) {
  const Draft wet{shipped_, {{"finger.water.drops_per_um3", "100000"}, {"texture.type", "flat"}}};
  const std::string name = files_.target("wet.toml", false);
  files_.save(wet, study_of(wet), name);
  EXPECT_NE(read_bytes(name).find("100000"), std::string::npos);
  const auto made = files_.export_files(study_of(wet), "export/wet", false);
  EXPECT_TRUE(made["sound"].get<bool>());
  EXPECT_NE(made["words"].get<std::string>().find("how it feels is not simulated: "
                                                  "finger.water.drops_per_um3"),
            std::string::npos)
      << made["words"];
}

TEST_F(Saving, AnExportTakesNoFolderThatHoldsSomethingOrIsOfASearch) {
  const Study study = read_study(shipped_);
  fs::create_directories(place_.path() / "mine/made");
  write_bytes(place_.path() / "mine/made/mask.tif", "kept");
  write_bytes(place_.path() / "file", "kept");
  const auto refusal = [&](const char* name, bool overwrite) {
    try {
      files_.export_files(study, name, overwrite);
      return std::string("made");
    } catch (const InputError& error) {
      return error.problems().front().message;
    }
  };
  for (const char* name : {"mine/made", "file"})
    EXPECT_EQ(refusal(name, false),
              "is there already: overwrite its files, or choose another name");
  for (const char* name : {"searches", "searches/001", "searches/new"})
    EXPECT_EQ(refusal(name, true), "is a folder of searches; choose another name, as export/mine");
  EXPECT_EQ(read_bytes(place_.path() / "mine/made/mask.tif"), "kept");
  EXPECT_FALSE(fs::exists(place_.path() / "searches"));
}

TEST_F(Saving, AScanIsKeptWithItsNameAndLength) {
  for (const char* name : {"a.npy", "a.gsf", "a.exr", "a.tif", "a.x3p", "a.gwy", "A.SUR", "a.sdf"})
    EXPECT_EQ(files_.keep_scan(name, "12345"),
              (nlohmann::ordered_json{{"name", std::string("scans/") + name}, {"bytes", 5}}));
  EXPECT_EQ(read_bytes(place_.path() / "scans/a.tif"), "12345");
  for (const char* name : {"a.png", "a", "a.gsf.txt", ".gsf", "a.nid"})
    EXPECT_THROW(files_.keep_scan(name, ""), InputError) << name;
}

// Designs name the file: it keeps its map.
TEST_F(Saving, AnotherScanOfTheSameNameStandsBesideIt) {
  const auto kept = [&](const char* name, const char* bytes) {
    return files_.keep_scan(name, bytes)["name"].get<std::string>();
  };
  EXPECT_EQ(kept("a.gsf", "tilted"), "scans/a.gsf");
  EXPECT_EQ(kept("a.gsf", "level"), "scans/a-2.gsf");
  EXPECT_EQ(kept("a.gsf", "third"), "scans/a-3.gsf");
  EXPECT_EQ(kept("a.gsf", "level"), "scans/a-2.gsf");
  EXPECT_EQ(kept("a.gsf", "tilted"), "scans/a.gsf");
  EXPECT_EQ(kept("sub/a.gsf", "level"), "scans/sub/a.gsf");
  EXPECT_EQ(read_bytes(place_.path() / "scans/a.gsf"), "tilted");
  EXPECT_EQ(read_bytes(place_.path() / "scans/a-2.gsf"), "level");
}

// Of an instrument's file the channel that was named.
TEST_F(Saving, AScanOfSeveralChannelsIsTheNamedOne) {
  Heightmap low{{16, 16, 8e-6, 8e-6}, std::vector<double>(256, 0.0)}, high = low;
  low.z[5] = 1e-8;
  high.z[5] = 3e-8;
  files_.keep_scan("two.gwy", gwy_bytes({{"Forward", "m", &low}, {"Backward", "m", &high}}));
  EXPECT_THROW(files_.with_scan({shipped_, {}}, "scans/two.gwy", "", false, true), InputError);
  const Draft draft = files_.with_scan({shipped_, {}}, "scans/two.gwy::Backward", "", false, true);
  const auto file = std::find_if(draft.changes.begin(), draft.changes.end(),
                                 [](const studio::Change& c) { return c.path == "texture.file"; });
  ASSERT_NE(file, draft.changes.end());
  EXPECT_NE(file->text.find("scans/two.gwy::Backward"), std::string::npos) << file->text;
  EXPECT_NE(save(draft, "named.toml").find("file = \"scans/two.gwy::Backward\""),
            std::string::npos);
  EXPECT_THROW(files_.with_scan({shipped_, {}}, "scans/two.gwy::Up", "", false, true), InputError);
}

// What was asked of the scan stands in the draft, and nothing of the texture before.
TEST_F(Saving, AScanIsADraftOfWhatWasAskedOfIt) {
  Heightmap map{{16, 16, 8e-6, 8e-6}, std::vector<double>(256, 0.0)};
  for (std::size_t i = 0; i < 256; ++i) map.z[i] = 1e-8 * static_cast<double>(i % 7);
  fs::create_directories(place_.path() / "scans");
  write_gsf((place_.path() / "scans/map.gsf").string(), map, {});
  write_npy((place_.path() / "scans/map.npy").string(), map);
  const Draft from{shipped_, {{"texture.depth", "1 nm"}, {"drive.amplitude", "120 V"}}};
  const auto changes = [&](const char* name, const char* size, bool fill, bool as_is) {
    return files_.with_scan(from, name, size, fill, as_is).changes;
  };
  const std::string folder = fs::weakly_canonical(place_.path()).string() + "/scans/";
  const studio::Change voltage{"drive.amplitude", "120 V"}, type{"texture.type", "measured"},
      gsf{"texture.file", '"' + folder + "map.gsf\""},
      npy{"texture.file", '"' + folder + "map.npy\""};
  EXPECT_EQ(changes("scans/map.gsf", "", false, false),
            (std::vector<studio::Change>{voltage, type, gsf, {"texture.patch", "6.66 um"}}));
  EXPECT_EQ(changes("scans/map.gsf", "", true, false),
            (std::vector<studio::Change>{
                voltage, type, gsf, {"texture.fill", "true"}, {"texture.patch", "6.66 um"}}));
  EXPECT_EQ(changes("scans/map.npy", "12 um", false, true),
            (std::vector<studio::Change>{voltage,
                                         type,
                                         npy,
                                         {"texture.width", "12 um"},
                                         {"texture.as_is", "true"},
                                         {"texture.patch", "12 um"}}));
  EXPECT_THROW(changes("scans/map.npy", "-1 um", false, true), InputError);
  EXPECT_THROW(changes("scans/map.npy", "1 V", false, true), InputError);
}

// As much of a small map as leaves room for the seam, of its shorter side; else a square of 24 um.
TEST_F(Saving, APatchOfAScanLeavesRoomForItsSeamAndIs24umAtMost) {
  for (const auto& [lx, ly, expected] :
       {std::tuple{12e-6, 6e-6, 5e-6}, {6e-6, 12e-6, 5e-6}, {30e-6, 48e-6, 24e-6}}) {
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
    for (const studio::Change& c : draft.changes) {
      EXPECT_NE(c.path, "texture.depth");  // of the texture before
      if (c.path == "texture.patch") patch = c.text;
    }
    patch = patch.substr(patch.find_first_of("0123456789"));
    EXPECT_NEAR(parse_si(patch.substr(0, patch.find('"')), "um"), expected, 1e-12) << patch;
  }
}

}  // namespace
}  // namespace papilla::tests::saving_test
