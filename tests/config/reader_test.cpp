#include "config/reader.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/units.h"
#include "config/describe.h"
#include "config/writer.h"
#include "geometry/facts.h"
#include "scene/environment.h"
#include "scene/finger.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::reader_test {
namespace {

namespace fs = std::filesystem;

struct Hole {
  double diameter = 3e-6, depth = 350e-9, wall_angle = 1.5;
};
void fields(FieldVisitor& v, Hole& s) {
  v.number({"diameter", "um", 0.2, 50, "hole diameter at the top", Source::Choice, "",
            Presence::Required},
           s.diameter);
  v.number({"depth", "nm", 0, 5000, "hole depth"}, s.depth);
  v.number({"wall_angle", "deg", 45, 90, "angle of the wall"}, s.wall_angle);
}

struct Source3 {
  double voltage = 0;
};
void fields(FieldVisitor& v, Source3& s) { v.number({"voltage", "V", 0, 1000, "peak"}, s.voltage); }

struct Whole {
  int schema_version = 1;
  Finger finger;
  Environment environment;
  Surface surface;
  Drive drive;
  bool operator==(const Whole&) const = default;
};
void fields(FieldVisitor& v, Whole& s) {
  v.integer({"schema_version", "version"}, 1, 1, s.schema_version);
  v.section({"finger", "finger"}, s.finger);
  v.section({"environment", "air"}, s.environment);
  v.section({"surface", "finish"}, s.surface);
  v.section({"drive", "drive"}, s.drive);
}

std::string problems_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return refusal_of([&] {
    Document document = parse_document(text, "hole.toml", overrides);
    Whole whole;
    fields(document.open(""), whole);
    document.close();
    finish(document);
  });
}

Whole read_whole(const std::string& text, const std::vector<std::string>& overrides = {}) {
  Document document = parse_document(text, "whole.toml", overrides);
  Whole whole;
  read_section(document, "", whole);
  finish(document);
  return whole;
}

class Folder {
 public:
  explicit Folder(const std::string& name) : path_(temporary(name)) {
    fs::remove_all(path_);
    fs::create_directories(path_);
  }
  ~Folder() { fs::remove_all(path_); }
  std::string write(const std::string& name, const std::string& text) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name) << text;
    return (path_ / name).string();
  }
  std::string path() const { return path_.string(); }

 private:
  fs::path path_;
};

TEST(Reader, ReportsAllProblemsAtOnceWithTheirPlaces) {
  Document document = parse_document(
      "[texture]\n"
      "\n"
      "# a comment\n"
      "diamter = \"3 um\"\n"
      "depth = 350\n"
      "wall_angle = \"95 deg\"\n"
      "[drive]\n"
      "voltage = \"200 um\"\n",
      "hole.toml");
  Hole hole;
  Source3 drive;
  read_section(document, "texture", hole);
  read_section(document, "drive", drive);
  EXPECT_EQ(
      refusal_of([&] { finish(document); }),
      "hole.toml:1:1: texture: missing `diameter` (hole diameter at the top), a length in um\n"
      "hole.toml:4:1: texture: unknown key `diamter`, did you mean `diameter`?\n"
      "hole.toml:5:9: texture.depth: needs a unit, e.g. \"350 nm\"\n"
      "hole.toml:6:14: texture.wall_angle: 95 deg is outside 45 to 90 deg\n"
      "hole.toml:8:11: drive.voltage: expected a voltage, got \"200 um\"");
}

TEST(Reader, NamesEachKindOfMistake) {
  EXPECT_EQ(problems_of("schema_version = 2\n"),
            "hole.toml:1:18: schema_version: expected 1, got 2");
  EXPECT_EQ(problems_of("[finger]\nload = \"nan N\"\n"),
            "hole.toml:2:8: finger.load: expected a force, got \"nan N\"; write it like \"1 N\"");
  EXPECT_EQ(problems_of("[finger]\nload = \"-1 N\"\n"),
            "hole.toml:2:8: finger.load: -1 N is outside 0 to 100 N");
  EXPECT_EQ(problems_of("[finger]\nstate = \"claen\"\n"),
            "hole.toml:2:9: finger.state: expected one of clean, natural, wet, got \"claen\"; did "
            "you mean \"clean\"?");
  EXPECT_EQ(problems_of("[surface]\nrefractive_index = nan\n"),
            "hole.toml:2:20: surface.refractive_index: expected a finite number, got nan");
  EXPECT_EQ(problems_of("[surface]\nrefractive_index = [1, 2]\n"),
            "hole.toml:2:20: surface.refractive_index: expected a plain number, got a list");
  EXPECT_EQ(problems_of("[environment]\nrelative_humidity = \"15 %\"\n"),
            "hole.toml:2:21: environment.relative_humidity: expected a list, e.g. [\"1 %\"], got "
            "\"15 %\"");
  EXPECT_EQ(problems_of("[environment]\nrelative_humidity = [\"15 %\", 0.35]\n"),
            "hole.toml:2:30: environment.relative_humidity.1: needs a unit: \"35 %\" if 0.35 is a "
            "share of 1, \"0.35 %\" if it is in percent");
  EXPECT_EQ(problems_of("[environment]\nrelative_humidity = [\"15 %\", 1.5]\n"),
            "hole.toml:2:30: environment.relative_humidity.1: needs a unit, e.g. \"1.5 %\"");
  EXPECT_EQ(problems_of("finger = 3\n"),
            "hole.toml:1:10: finger: expected a section [finger], got 3");
  EXPECT_EQ(problems_of("[surface]\ndielectric = [{ thickness = \"1 V\" }, 3]\n"),
            "hole.toml:2:29: surface.dielectric.0.thickness: expected a length, got \"1 V\"\n"
            "hole.toml:2:38: surface.dielectric.1: expected a section { ... }, got 3");
  EXPECT_EQ(problems_of("[finger.calibrated_for]\nrim_pinning = 1\n"),
            "hole.toml:2:15: finger.calibrated_for.rim_pinning: expected true or false, got 1");
  EXPECT_EQ(problems_of(" \n"),
            "hole.toml:1:1: the file is empty, expected `schema_version = 1` and sections");
  EXPECT_TRUE(problems_of("[finger\n").starts_with("hole.toml:1:8: not valid TOML"));
  EXPECT_TRUE(problems_of("\xff\xfe\x00\x01garbage").starts_with("hole.toml:1:1: not valid TOML"));
}

// Lines that are wrong by themselves hide none of the others; what opens a table or a list ends it.
TEST(Reader, TellsSeveralLinesThatAreNoToml) {
  const std::string said = problems_of(
      "[finger]\nload = \"1 N\"\nload = \"2 N\"\nstate = \"clean\"\nstate = \"wet\"\nname = "
      "ab c\n[surface\nload = 3\nload = 4\n");
  for (const char* place : {"hole.toml:3:", "hole.toml:5:", "hole.toml:6:", "hole.toml:7:"})
    EXPECT_NE(said.find(place), std::string::npos) << place << " in " << said;
  EXPECT_EQ(said.find("hole.toml:9:"), std::string::npos) << said;
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 3) << said;
}

TEST(Reader, OverridesTakeTextWithoutQuotesAndSayWhereTheyCameFrom) {
  const Whole whole = read_whole(
      "schema_version = 1\n[surface]\ndielectric = [{ material = \"a\" }, { material = \"b\" }]\n",
      {"finger.load=300 mN", "finger.state=natural", "surface.dielectric.1.thickness=2 um",
       "environment.relative_humidity=[\"20 %\"]"});
  EXPECT_EQ(whole.finger.load, 0.3);
  EXPECT_EQ(whole.finger.state, FingerState::Natural);
  EXPECT_EQ(whole.surface.dielectric[1].thickness, 2e-6);
  EXPECT_EQ(whole.environment.relative_humidity, std::vector<double>{0.2});
  EXPECT_EQ(problems_of("schema_version = 1", {"finger.laod=1 N"}),
            "--set finger.laod=1 N: finger: unknown key `laod`, did you mean `load`?");
  EXPECT_THROW(read_whole("schema_version = 1", {"finger.load"}), InputError);
}

TEST(Reader, BareNumbersOfAnOverrideWithAColonAreSi) {
  const Whole whole = read_whole(
      "schema_version = 1\n",
      {"finger.load:=0.3", "environment.relative_humidity:=[0.2, 0.4]",
       "surface.dielectric:=[{ material = \"a\", thickness = 2e-6, permittivity = 3 }]"});
  EXPECT_EQ(whole.finger.load, 0.3);
  EXPECT_EQ(whole.environment.relative_humidity, (std::vector<double>{0.2, 0.4}));
  EXPECT_EQ(whole.surface.dielectric.at(0).thickness, 2e-6);
  EXPECT_EQ(problems_of("schema_version = 1", {"finger.load=0.3"}),
            "--set finger.load=0.3: finger.load: needs a unit, e.g. \"0.3 N\"");
}

TEST(Reader, ATextWithoutAUnitIsToldWhichOneIsMissing) {
  EXPECT_EQ(problems_of("[finger]\nload = \"1.5\"\n"),
            "hole.toml:2:8: finger.load: needs a unit, e.g. \"1.5 N\"");
}

TEST(Reader, OverridesReachTheItemsOfADefaultList) {
  const Whole plain = read_whole("schema_version = 1\n");
  ASSERT_EQ(plain.surface.dielectric.size(), 1u);
  Whole expected = plain;
  expected.surface.dielectric[0].thickness = 1e-6;
  expected.environment.relative_humidity.at(1) = 0.4;
  for (const char* text : {"schema_version = 1\n", "schema_version = 1\n[surface]\n"}) {
    EXPECT_EQ(read_whole(text, {"surface.dielectric.0.thickness=1 um",
                                "environment.relative_humidity.1=40 %"}),
              expected);
  }
  EXPECT_EQ(problems_of("schema_version = 1\n", {"surface.dielectric.1.thickness=1 um"}),
            "--set surface.dielectric.1.thickness=1 um: surface.dielectric: no item 1 in a list of "
            "1");
  for (const char* text :
       {"schema_version = 1\n", "[[surface.dielectric]]\nmaterial = \"HfO2\"\n"}) {
    EXPECT_TRUE(problems_of(text, {"surface.dielectric..thickness=1 um"})
                    .starts_with("--set surface.dielectric..thickness=1 um: surface.dielectric"));
  }
  EXPECT_EQ(problems_of("schema_version = 1\n", {"surface.dielectric.0.thikness=1 um"}),
            "--set surface.dielectric.0.thikness=1 um: surface.dielectric.0: unknown key "
            "`thikness`, did you mean `thickness`?");
}

TEST(Reader, ANewListReplacesTheDefaultItems) {
  const Whole whole = read_whole("[[surface.dielectric]]\nmaterial = \"HfO2\"\n");
  ASSERT_EQ(whole.surface.dielectric.size(), 1u);
  EXPECT_EQ(whole.surface.dielectric[0].material, "HfO2");
  EXPECT_TRUE(read_whole("surface = { dielectric = [] }").surface.dielectric.empty());
}

TEST(Reader, BaseFilesLieBelowAndKeepTheirPlaces) {
  const Folder folder("base");
  folder.write("designs/fingers/soft.toml",
               "schema_version = 1\nname = \"soft\"\nload = \"1 N\"\n[skin]\nrms = \"100 nm\"\n");
  folder.write("designs/common.toml", "schema_version = 1\n[drive]\namplitude = \"90 V\"\n");
  const std::string study = folder.write("home/study.toml",
                                         "schema_version = 1\n"
                                         "base = \"common.toml\"\n"
                                         "[finger]\n"
                                         "base = \"../fingers/soft.toml\"\n"
                                         "load = \"2 N\"\n");
  Document document = load_document(study, {}, {folder.path() + "/designs"});
  Whole whole;
  read_section(document, "", whole);
  finish(document);
  EXPECT_EQ(whole.finger.name, "soft");
  EXPECT_EQ(whole.finger.load, 2);
  EXPECT_EQ(whole.finger.skin.rms, 100e-9);
  EXPECT_EQ(whole.drive.amplitude, 90);
  EXPECT_TRUE(document.origins().at("finger.skin.rms").file.ends_with("designs/fingers/soft.toml"));
  EXPECT_EQ(document.origins().at("finger.skin.rms").line, 5);
}

TEST(Reader, TheBaseOfASectionStandsAboveThatOfTheFile) {
  const Folder folder("section_base");
  folder.write("soft.toml", "schema_version = 1\nname = \"soft\"\nload = \"1 N\"\n");
  folder.write("hard.toml", "schema_version = 1\nname = \"hard\"\n");
  folder.write(
      "common.toml",
      "schema_version = 1\n[finger]\nbase = \"soft.toml\"\n[drive]\namplitude = \"90 V\"\n");
  const std::string study =
      folder.write("study.toml", "schema_version = 1\nbase = \"common.toml\"\n");
  const auto finger = [&](const std::vector<std::string>& overrides) {
    Document document = load_document(study, overrides);
    Whole whole;
    read_section(document, "", whole);
    finish(document);
    EXPECT_EQ(whole.finger.load, 1);
    return whole.finger.name;
  };
  EXPECT_EQ(finger({}), "soft");
  EXPECT_EQ(finger({"finger.base=\"hard.toml\""}), "hard");
}

TEST(Reader, ABaseThatACallerNamesLiesWhereverTheCallerSays) {
  const Folder folder("own_base");
  folder.write("fitted/skin.toml", "[skin]\nrms = \"70 nm\"\n");
  const std::string own =
      folder.write("fitted/own.toml", "schema_version = 1\nname = \"own\"\nbase = \"skin.toml\"\n");
  const std::string study =
      folder.write("designs/study.toml", "schema_version = 1\n[finger]\nname = \"of the file\"\n");
  const auto read = [&](const std::vector<std::string>& overrides) {
    Document document = load_document(study, overrides);
    Whole whole;
    read_section(document, "", whole);
    finish(document);
    return whole.finger;
  };
  EXPECT_EQ(read({"finger.base=\"" + own + "\""}).skin.rms, 70e-9);
  // A file that names it is still refused.
  folder.write("designs/study.toml", "schema_version = 1\n[finger]\nbase = \"" + own + "\"\n");
  EXPECT_NE(refusal_of([&] { read({}); }).find("outside"), std::string::npos);
}

TEST(Reader, BasesOutsideTheRootsAndCyclesAreRefused) {
  const Folder folder("cycle");
  folder.write("secret.toml", "[drive]\n");
  const auto message = [&](const std::string& text) -> std::string {
    const std::string file = folder.write("home/study.toml", text);
    return refusal_of([&] { load_document(file); });
  };
  EXPECT_NE(message("base = \"../secret.toml\"").find("outside"), std::string::npos);
  EXPECT_NE(message("base = \"none.toml\"").find("study.toml:1:8: base: no file"),
            std::string::npos);
  EXPECT_NE(message("base = \"study.toml\"").find("based on itself"), std::string::npos);
  fs::create_symlink(folder.path() + "/secret.toml", folder.path() + "/home/link.toml");
  EXPECT_NE(message("base = \"link.toml\"").find("outside"), std::string::npos);
}

// A part in 10^12 of the largest limit beyond either, and of a smaller one near nothing.
TEST(Reader, LimitsHoldButForTheRoundingOfUnits) {
  Document document = parse_document("a = 1\n", "x.toml");
  const auto fits = [&](const NumberSpec& spec, double value) {
    Node node = number_node(value * find_unit(spec.unit)->to_si);
    node.si = true;
    double out = -1;
    const bool good = document.number(node, "k", spec, out);
    EXPECT_EQ(out, good ? node.number : -1);
    return good;
  };
  const NumberSpec angle{"k", "deg", 45, 90, ""};
  EXPECT_TRUE(fits(angle, 90 * (1 + 5e-13)));
  EXPECT_FALSE(fits(angle, 90 * (1 + 2e-12)));
  EXPECT_TRUE(fits(angle, 45 - 4.5e-11));
  EXPECT_FALSE(fits(angle, 45 - 1.8e-10));
  const NumberSpec wide{"k", "um", 1e-6, 1e6, ""};
  EXPECT_TRUE(fits(wide, 1e-6 * (1 - 5e-10)));
  EXPECT_FALSE(fits(wide, 1e-6 * (1 - 2e-9)));
  EXPECT_FALSE(fits(wide, 0.5e-6));
  EXPECT_FALSE(fits(wide, 0));
  const NumberSpec from_nothing{"k", "V", 0, 10, ""};
  EXPECT_TRUE(fits(from_nothing, 0));
  EXPECT_FALSE(fits(from_nothing, -1e-15));
  EXPECT_TRUE(fits(from_nothing, 10 * (1 + 5e-13)));
  const NumberSpec below{"k", "um", -100, 1, ""};
  EXPECT_TRUE(fits(below, -100 - 5e-11));
  EXPECT_FALSE(fits(below, -100 - 2e-10));
  EXPECT_TRUE(fits(below, 1 + 5e-11));
  EXPECT_FALSE(fits(below, 1 + 2e-10));
}

TEST(Reader, WhatIsTakenByItsPathCountsAsRead) {
  const std::string text = "note = 1\n[drive]\nvoltage = \"2 V\"\nremark = 3\n";
  const auto said = [&](const std::vector<std::string>& taken) -> std::string {
    Document document = parse_document(text, "hole.toml");
    Source3 drive;
    read_section(document, "drive", drive);
    EXPECT_EQ(drive.voltage, 2);
    for (const std::string& path : taken) {
      const Node* node = document.take(path);
      EXPECT_NE(node, nullptr);
      EXPECT_EQ(document.origins().at(path).line, node->place.line);
    }
    EXPECT_EQ(document.take("drive.none"), nullptr);
    EXPECT_EQ(document.origins().count("drive.none"), 0u);
    EXPECT_TRUE(document.has("drive.remark"));
    EXPECT_FALSE(document.has("drive.none"));
    return refusal_of([&] { finish(document); });
  };
  EXPECT_EQ(said({"note", "drive.remark"}), "");
  EXPECT_EQ(said({"note"}),
            "hole.toml:4:1: drive: unknown key `remark`; known here: none, voltage");
  EXPECT_EQ(said({"drive.remark"}), "hole.toml:1:1: unknown key `note`; known here: drive");
}

TEST(Reader, AProblemStandsAtItsValueOrAtTheNearestSectionAroundIt) {
  Document document = parse_document("a = 1\n[drive]\nvoltage = \"2 V\"\n", "hole.toml");
  document.problem_at("drive.voltage", "one");
  document.problem_at("drive.none.deeper", "two");
  document.problem_at("nothing", "three");
  std::vector<std::string> said;
  for (const Problem& p : document.problems()) said.push_back(p.text());
  EXPECT_EQ(said, (std::vector<std::string>{"hole.toml:3:11: drive.voltage: one",
                                            "hole.toml:2:1: drive.none.deeper: two",
                                            "hole.toml:1:1: nothing: three"}));
}

TEST(Writer, TheResolvedFileReadsBackToTheSameValues) {
  Whole whole;
  whole.finger.skin.rms = 256.123456789e-9 / 3;
  whole.surface.contact_angle = 1.0 / 3;
  whole.environment.relative_humidity = {0.1 / 3, 0.7};
  whole.surface.dielectric.push_back({"\"quoted\" \\ name", 1e-9 / 7, 2.5, 1e14 / 3, 5e8});
  const std::string text = to_toml(whole);
  EXPECT_EQ(read_whole(text), whole) << text;
}

TEST(Writer, EveryValueSaysWhereItCameFrom) {
  Document document =
      parse_document("[drive]\namplitude = \"150 V\"\n", "study.toml", {"finger.load=1 N"});
  Whole whole;
  read_section(document, "", whole);
  finish(document);
  const std::string text = to_toml(whole, &document.origins());
  EXPECT_NE(text.find("amplitude = \"150 V\"  # study.toml:2:13\n"), std::string::npos) << text;
  EXPECT_NE(text.find("load = \"1 N\"  # --set finger.load=1 N\n"), std::string::npos) << text;
  EXPECT_NE(text.find("frequency = \"5 kHz\"  # default (paper: M3: 5 kHz)\n"), std::string::npos);
}

struct Part {
  double share = 0.25;
};
void fields(FieldVisitor& v, Part& s) {
  v.number({"share", "%", 0, 100, "of the whole", Source::Measured}, s.share);
}

// One of each kind.
struct Each {
  double length = 3e-6, plain = 2;
  std::vector<double> angles{0, 1.5707963267948966};
  int count = 4, version = 1;
  bool on = true;
  std::string name = "a \"b\"\\\n\t\x01", file = "/x/y.csv";
  Lattice lattice = Lattice::Hexagonal;
  Part part;
  std::vector<Part> parts{{0.5}, {1}};
};
void fields(FieldVisitor& v, Each& s) {
  v.number({"length", "um", 0.5, 50, "a side", Source::Paper, "M3", Presence::Required}, s.length);
  v.number({"plain", "", -1, 1e7, "a factor", Source::Fit, "to M3"}, s.plain);
  v.numbers({"angles", "deg", 0, 90, "of views"}, s.angles);
  v.integer({"count", "of parts"}, 1, 8, s.count);
  v.integer({"version", "of all"}, 1, 1, s.version);
  v.flag({"on", "whether"}, s.on);
  v.text({"name", "for people", Source::Estimate}, s.name);
  v.path({"file", "beside it"}, s.file);
  v.choice({"lattice", "arrangement"}, {"square", "hexagonal"}, s.lattice);
  v.section({"part", "one"}, s.part);
  v.list({"parts", "more"}, s.parts);
}

TEST(Describe, ARowSaysAllOfItsField) {
  const std::vector<FieldRow> rows = field_rows(Each{}, "each");
  std::vector<std::string> said;
  for (const FieldRow& r : rows) {
    if (r.path == "each.name") continue;
    said.push_back(r.path + " | " + r.kind + " | " + r.range + " | " + r.default_value + " | " +
                   r.doc + " | " + r.source + " | " + r.reference + (r.required ? " | must" : "") +
                   (r.section ? " | section" : ""));
  }
  EXPECT_EQ(said, (std::vector<std::string>{
                      "each.length | a length in um | 0.5 to 50 um | 3 um | a side | paper | M3 | "
                      "must",
                      "each.plain | a number | -1 to 1e7 | 2 | a factor | fit | to M3",
                      "each.angles | a list, each an angle in deg | 0 to 90 deg | [0 deg, 90 deg] "
                      "| of views | choice | ",
                      "each.count | a whole number | 1 to 8 | 4 | of parts | choice | ",
                      "each.version | a whole number | 1 | 1 | of all | choice | ",
                      "each.on | true or false |  | true | whether | choice | ",
                      "each.file | a file |  | /x/y.csv | beside it | choice | ",
                      "each.lattice | one of square, hexagonal |  | hexagonal | arrangement | "
                      "choice | ",
                      "each.part | a section |  |  | one | choice |  | section",
                      "each.part.share | a share in % | 0 to 100 % | 25 % | of the whole | "
                      "measured | ",
                      "each.parts | a list of sections |  |  | more | choice |  | section",
                      "each.parts.0.share | a share in % | 0 to 100 % | 50 % | of the whole | "
                      "measured | ",
                      "each.parts.1.share | a share in % | 0 to 100 % | 100 % | of the whole | "
                      "measured | "}));
}

TEST(Describe, RowsAreTextOrATable) {
  std::vector<FieldRow> rows = field_rows(Each{});
  rows = {rows[0], rows[1], rows[5], rows[9], rows[10]};
  const std::string blank(36, ' ');
  EXPECT_EQ(reference_text(rows),
            "length" + std::string(31, ' ') + "a side\n" + blank +
                "   a length in um, 0.5 to 50 um, required\n" + "plain" + std::string(32, ' ') +
                "a factor\n" + blank + "   a number, -1 to 1e7, default 2 (fit: to M3)\n" + "on" +
                std::string(35, ' ') + "whether\n" + blank +
                "   true or false, default true (choice)\n" + "\n[part]  one\n" + "part.share" +
                std::string(27, ' ') + "of the whole\n" + blank +
                "   a share in %, 0 to 100 %, default 25 % (measured)\n");
  EXPECT_EQ(reference_markdown(rows),
            "| key | meaning | kind | range | default | source |\n|---|---|---|---|---|---|\n"
            "| `length` | a side | a length in um | 0.5 to 50 um | required | paper: M3 |\n"
            "| `plain` | a factor | a number | -1 to 1e7 | `2` | fit: to M3 |\n"
            "| `on` | whether | true or false |  | `true` | choice |\n"
            "| **`part`** | one | a section | | | |\n"
            "| `part.share` | of the whole | a share in % | 0 to 100 % | `25 %` | measured |\n");
}

TEST(Describe, NumbersAloneAreFoundWithTheirLimits) {
  Each each;
  std::vector<std::string> paths;
  for (const NumberField& n : number_fields(each, "each")) paths.push_back(n.path);
  EXPECT_EQ(paths, (std::vector<std::string>{"each.length", "each.plain", "each.angles.0",
                                             "each.angles.1", "each.part.share",
                                             "each.parts.0.share", "each.parts.1.share"}));
  const NumberField angle = find_number(each, "angles.1");
  EXPECT_EQ(std::tuple(angle.low, angle.high, std::string(angle.unit), std::string(angle.doc)),
            std::tuple(0.0, 90.0, "deg", "of views"));
  set_number(each, "angles.1", 0.5);
  EXPECT_EQ(each.angles, (std::vector<double>{0, 0.5}));
  set_number(each, "parts.1.share", 0.75);
  EXPECT_EQ(each.parts[1].share, 0.75);
  EXPECT_EQ(each.parts[0].share, 0.5);
}

TEST(Writer, WritesEachKindAsAFileHasIt) {
  EXPECT_EQ(to_toml(Each{}),
            "length = \"3 um\"\nplain = 2.0\nangles = [\"0 deg\", \"90 deg\"]\ncount = 4\n"
            "version = 1\non = true\nname = \"a \\\"b\\\"\\\\\\n\\t\\u0001\"\n"
            "file = \"/x/y.csv\"\nlattice = \"hexagonal\"\n\n[part]\nshare = \"25 %\"\n\n"
            "[[parts]]\nshare = \"50 %\"\n\n[[parts]]\nshare = \"100 %\"\n");
  const Origins origins{{"plain", {"a.toml", 3, 7}}, {"parts.1.share", {"--set x", 0, 0}}};
  const std::string text = to_toml(Each{}, &origins);
  EXPECT_TRUE(
      text.starts_with("length = \"3 um\"  # default (paper: M3)\nplain = 2.0  # a.toml:3:7\n"
                       "angles = [\"0 deg\", \"90 deg\"]  # default (choice)\n"))
      << text;
  EXPECT_TRUE(text.ends_with(
      "[part]\nshare = \"25 %\"  # default (measured)\n\n[[parts]]\nshare = \"50 %\"  # default "
      "(measured)\n\n[[parts]]\nshare = \"100 %\"  # --set x\n"))
      << text;
}

// What a file says of one of each kind beside the length that it must have; "": it is taken.
std::string said_of(const std::string& line, const std::string& length = "length = \"3 um\"\n") {
  Document document = parse_document(length + line + "\n", "e.toml");
  Each each;
  read_section(document, "", each);
  return refusal_of([&] { finish(document); });
}

TEST(Reader, EachKindOfFieldSaysWhatItTakes) {
  EXPECT_EQ(said_of("plain = 1", ""), "e.toml:1:1: missing `length` (a side), a length in um");
  for (const auto& [line, message] : std::vector<std::pair<std::string, std::string>>{
           {"plain = 2", ""},
           {"plain = \"2\"", ""},
           {"plain = \"2 %\"", ""},
           {"plain = \"2 um\"", "plain: expected a plain number, got \"2 um\""},
           {"plain = \"x\"", "plain: expected a plain number, got \"x\""},
           {"plain = true", "plain: expected a plain number, got true"},
           {"plain = inf", "plain: expected a finite number, got inf"},
           {"plain = -1.5", "plain: -1.5 is outside -1 to 1e7"},
           {"plain = 1.1e7", "plain: 11000000 is outside -1 to 1e7"},
           {"angles = []", ""},
           {"angles = [\"90 deg\", \"1 rad\"]", ""},
           {"angles = 3", "angles: expected a list, e.g. [\"1 deg\"], got 3"},
           {"angles = [3]", "angles.0: needs a unit, e.g. \"3 deg\""},
           {"angles = [\"1 deg\", \"91 deg\"]", "angles.1: 91 deg is outside 0 to 90 deg"},
           {"angles = [\"x\"]", "angles.0: expected an angle, got \"x\"; write it like \"1 deg\""},
           {"count = 8", ""},
           {"count = 1", ""},
           {"count = 9", "count: 9 is outside 1 to 8"},
           {"count = 0", "count: 0 is outside 1 to 8"},
           {"count = 2.0", "count: expected a whole number, got 2"},
           {"version = 1", ""},
           {"version = 0", "version: expected 1, got 0"},
           {"on = false", ""},
           {"on = 1", "on: expected true or false, got 1"},
           {"name = \"\"", ""},
           {"name = 3", "name: expected a text in quotes, got 3"},
           {"file = \"\"", ""},
           {"file = 3", "file: expected the name of a file in quotes, got 3"},
           {"file = \"none.csv\"", "file: no such file: \"none.csv\""},
           {"lattice = \"square\"", ""},
           {"lattice = \"sqare\"",
            "lattice: expected one of square, hexagonal, got \"sqare\"; did you mean \"square\"?"},
           {"lattice = \"xyz\"", "lattice: expected one of square, hexagonal, got \"xyz\""},
           {"lattice = 1", "lattice: expected one of square, hexagonal, got 1"},
           {"part = { share = \"25 %\" }", ""},
           {"part = { share = 1.0 }",
            "part.share: needs a unit: \"100 %\" if 1 is a share of 1, \"1 %\" if it is in "
            "percent"},
           {"part = { share = 0 }", "part.share: needs a unit, e.g. \"0 %\""},
           {"part = [1]", "part: expected a section [part], got a list"},
           {"parts = []", ""},
           {"parts = 3", "parts: expected a list of sections, [[parts]] or [{ ... }], got 3"},
           {"parts = [{ share = \"1 %\" }, 3]", "parts.1: expected a section { ... }, got 3"},
           {"parts = [{ share = \"101 %\" }]", "parts.0.share: 101 % is outside 0 to 100 %"},
           {"parts = { 1 = { share = \"1 %\" } }", ""},
           {"parts = { 2 = { share = \"1 %\" } }", "parts: no item 2 in a list of 2"}}) {
    const std::string said = said_of(line);
    const std::size_t at = said.find(": ");  // behind the place
    EXPECT_EQ(said.empty() ? "" : said.substr(at + 2), message) << line;
    EXPECT_EQ(said.substr(0, 9), message.empty() ? "" : "e.toml:2:") << line;
  }
}

TEST(Reader, ReadsEachKindAsItStands) {
  const TemporaryFolder place;
  const std::string file = place.path() / "a.csv";
  std::ofstream(file) << "x";
  Document document = parse_document(
      "length = \"4 um\"\nplain = -1\nangles = [\"45 deg\"]\ncount = 8\nversion = 1\non = false\n"
      "name = \"b\"\nfile = \"" +
          file +
          "\"\nlattice = \"square\"\npart = { share = \"5 %\" }\n"
          "[[parts]]\n[[parts]]\nshare = \"75 %\"\n[[parts]]\nshare = \"0 %\"\n",
      "e.toml");
  Each each;
  read_section(document, "", each);
  finish(document);
  EXPECT_DOUBLE_EQ(each.length, 4e-6);
  EXPECT_EQ(each.plain, -1);
  ASSERT_EQ(each.angles.size(), 1u);
  EXPECT_DOUBLE_EQ(each.angles[0], 3.14159265358979323846 / 4);
  EXPECT_EQ(each.count, 8);
  EXPECT_FALSE(each.on);
  EXPECT_EQ(each.name, "b");
  EXPECT_EQ(each.file, fs::weakly_canonical(file).string());
  EXPECT_EQ(each.lattice, Lattice::Square);
  EXPECT_DOUBLE_EQ(each.part.share, 0.05);
  ASSERT_EQ(each.parts.size(), 3u);
  EXPECT_DOUBLE_EQ(each.parts[0].share, 0.25);  // its own default, not the list's
  EXPECT_DOUBLE_EQ(each.parts[1].share, 0.75);
  EXPECT_EQ(each.parts[2].share, 0);
  EXPECT_EQ(document.origins().at("parts.1.share").line, 13);
  EXPECT_EQ(document.origins().count("parts.0.share"), 0u);
}

// What --set makes of a file.
std::string set(const std::string& text, const std::vector<std::string>& settings) {
  try {
    Document document = parse_document(text, "e.toml", settings);
    Node root = table_node();
    for (const char* key : {"a", "b", "texture", "list"}) {
      if (const Node* node = document.take(key)) root.set(key, *node);
    }
    return write_toml(root);
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Reader, OverridesAreValuesOrTexts) {
  EXPECT_EQ(set("a = 1\n", {"a=2"}), "a = 2\n");
  EXPECT_EQ(set("a = 1\n", {" a = 2"}), "a = 1\n");  // another key
  EXPECT_EQ(set("a = 1\n", {"a = 2"}), "a = 2\n");
  EXPECT_EQ(set("a = 1\n", {"a=  3 um "}), "a = \"3 um \"\n");
  EXPECT_EQ(set("a = 1\n", {"a=x=y"}), "a = \"x=y\"\n");
  EXPECT_EQ(set("a = 1\n", {"a=1\nb = 2"}), "a = \"1\\nb = 2\"\n");
  EXPECT_EQ(set("a = 1\n", {"a = 2", "a=3"}), "a = 3\n");
  EXPECT_EQ(set("a = 1\n", {"b.c.d=[1, 2]"}), "a = 1\n\n[b]\n\n[b.c]\nd = [1, 2]\n");
  EXPECT_EQ(set("list = [1, 2]\n", {"list.1=5"}), "list = [1, 5]\n");
  EXPECT_EQ(set("list = [{ a = 1 }]\n", {"list.0.a=5", "list.0.b=6"}),
            "\n[[list]]\na = 5\nb = 6\n");
  const std::string wrong = "expected KEY=VALUE, e.g. drive.amplitude=150V";
  EXPECT_EQ(set("a = 1\n", {"=2"}), "--set =2: " + wrong);
  EXPECT_EQ(set("a = 1\n", {"a"}), "--set a: " + wrong);
  EXPECT_EQ(set("list = [1, 2]\n", {"list.2=5"}),
            "--set list.2=5: list.2: no item 2 in a list of 2");
  EXPECT_EQ(set("list = [1, 2]\n", {"list.x=5"}),
            "--set list.x=5: list.x: no item x in a list of 2");
  EXPECT_EQ(set("a = 1\n", {"a.b=5"}), "--set a.b=5: a.b: has no members");
}

// "texture.period" = ... and [texture] period = ... are two spellings of one path.
TEST(Reader, OverridesReachKeysThatAreSeveralPartsOfAPath) {
  EXPECT_EQ(set("[a]\n\"b.c\" = 1\n", {"a.b.c=2"}), "\n[a]\n\"b.c\" = 2\n");
  EXPECT_EQ(set("[a]\n\"b.c\" = { d = 1 }\n", {"a.b.c.d=2", "a.b.c.e=3"}),
            "\n[a]\n\"b.c\" = { d = 2, e = 3 }\n");
  EXPECT_EQ(set("list = [{ \"b.c\" = 1 }]\n", {"list.0.b.c=2"}), "\n[[list]]\n\"b.c\" = 2\n");
  EXPECT_EQ(set("[a]\n\"b.c\" = 1\n", {"a.b.d=2"}), "\n[a]\n\"b.c\" = 1\n\n[a.b]\nd = 2\n");
}

// Of a metric with arguments, as constraints are named.
TEST(Reader, OverridesAreSplitOutsideOfBracketsAndQuotes) {
  const std::string metric = "[a]\n\"worst(b(c = 0.5))\" = ";
  EXPECT_EQ(set(metric + "1\n", {"a.worst(b(c = 0.5))=2"}), "\n" + metric + "2\n");
  EXPECT_EQ(set("b = 1\n", {"a.worst(b(c = 0.5)) = 2"}), "b = 1\n\n" + metric + "2\n");
  EXPECT_EQ(set("b = 1\n", {"a.\"c = 0.5\"=2"}), "b = 1\n\n[a]\n\"c = 0.5\" = 2\n");
  EXPECT_EQ(set("b = 1\n", {"b=f(x)=0.5"}), "b = \"f(x)=0.5\"\n");
  EXPECT_EQ(set("b = 1\n", {"a(b=2"}),
            "--set a(b=2: expected KEY=VALUE, e.g. drive.amplitude=150V");
}

// Another kind takes the members away, whatever the order of the settings.
TEST(Reader, AKindComesBeforeItsMembers) {
  const std::string text = "[texture]\ntype = \"x\"\ndepth = 1\n";
  EXPECT_EQ(set(text, {"texture.width=2", "texture.type=y"}),
            "\n[texture]\ntype = \"y\"\nwidth = 2\n");
  EXPECT_EQ(set(text, {"texture.width=2", "texture.type=x"}),
            "\n[texture]\ntype = \"x\"\ndepth = 1\nwidth = 2\n");
}

// As the pen of a study, whatever its first counterface becomes.
TEST(Reader, SectionsOutliveTheKindOfTheirSection) {
  EXPECT_EQ(set("[texture]\ntype = \"x\"\ndepth = 1\n[texture.in]\nload = 2\n", {"texture.type=y"}),
            "\n[texture]\ntype = \"y\"\n\n[texture.in]\nload = 2\n");
}

// Of tables the members that the file has not; of lists and of another kind nothing.
TEST(Reader, ABaseFillsWhatIsMissing) {
  const Folder folder("fills");
  folder.write("base.toml",
               "schema_version = 1\na = 1\nb = 2\nlist = [1, 2]\n[texture]\ntype = \"x\"\nd = 3\n"
               "[texture.in]\ne = 4\nf = 5\n");
  const auto merged = [&](const std::string& text) {
    Document document = load_document(
        folder.write("top.toml", "schema_version = 1\nbase = \"base.toml\"\n" + text));
    Node root = table_node();
    for (const char* key : {"a", "b", "list", "texture", "base"}) {
      if (const Node* node = document.take(key)) root.set(key, *node);
    }
    return write_toml(root);
  };
  EXPECT_EQ(merged("b = 7\nlist = [3]\n[texture.in]\ne = 6\n"),
            "a = 1\nb = 7\nlist = [3]\n\n[texture]\ntype = \"x\"\nd = 3\n\n[texture.in]\ne = 6\n"
            "f = 5\n");
  EXPECT_EQ(merged("texture = { type = \"x\" }\n"),
            "a = 1\nb = 2\nlist = [1, 2]\n\n[texture]\ntype = \"x\"\nd = 3\n\n[texture.in]\ne = 4\n"
            "f = 5\n");
  EXPECT_EQ(merged("texture = { type = \"y\" }\n"),
            "a = 1\nb = 2\nlist = [1, 2]\n\n[texture]\ntype = \"y\"\n");
  EXPECT_EQ(merged("texture = 3\n"), "a = 1\nb = 2\nlist = [1, 2]\ntexture = 3\n");
}

// A base with two layers and volumes of its own, and a file that changes single items of them.
class ItemsOfABase : public ::testing::Test {
 protected:
  ItemsOfABase() {
    folder_.write("base.toml",
                  "schema_version = 1\n"
                  "[[surface.dielectric]]\nmaterial = \"Al2O3\"\nthickness = \"300 nm\"\n"
                  "[[surface.dielectric]]\nmaterial = \"HfO2\"\nthickness = \"100 nm\"\n"
                  "[finger]\n"
                  "base = \"mine.toml\"\n");
    folder_.write("mine.toml",
                  "schema_version = 1\n"
                  "[water]\n"
                  "volume = [\"0.5 um3\", \"2 um3\", \"6 um3\", \"20 um3\"]\n");
  }

  Document read(const std::string& text, Whole& whole,
                const std::vector<std::string>& overrides = {}) const {
    Document document =
        load_document(folder_.write("top.toml", "schema_version = 1\n" + text), overrides);
    read_section(document, "", whole);
    finish(document);
    return document;
  }

  const Folder folder_{"items"};
};

TEST_F(ItemsOfABase, ChangeAloneInASection) {
  Whole whole;
  const Document document =
      read("base = \"base.toml\"\n[surface.dielectric.0]\nthickness = \"280 nm\"\n", whole);
  ASSERT_EQ(whole.surface.dielectric.size(), 2u);
  EXPECT_EQ(whole.surface.dielectric[0].material, "Al2O3");
  EXPECT_EQ(whole.surface.dielectric[0].thickness, 280e-9);
  EXPECT_EQ(whole.surface.dielectric[1].material, "HfO2");
  EXPECT_EQ(whole.surface.dielectric[1].thickness, 100e-9);
  const auto file = [&](const char* path) {
    return fs::path(document.origins().at(path).file).filename().string();
  };
  EXPECT_EQ(file("surface.dielectric.0.thickness"), "top.toml");
  EXPECT_EQ(file("surface.dielectric.0.material"), "base.toml");
  EXPECT_EQ(file("surface.dielectric.1.thickness"), "base.toml");
}

TEST_F(ItemsOfABase, ChangeAloneInAListOfNumbersWhoseSourcesAreSaid) {
  Whole whole;
  const Document document =
      read("base = \"base.toml\"\n[finger]\nwater.volume.1 = \"3 um3\"\n", whole);
  EXPECT_EQ(whole.finger.water.volume, (std::vector{0.5e-18, 3e-18, 6e-18, 20e-18}));
  const std::string text = to_toml(whole, &document.origins());
  const std::size_t line = text.find("\nvolume = [");
  const std::string said = text.substr(line, text.find('\n', line + 1) - line);
  EXPECT_NE(said.find("  # 1: "), std::string::npos) << said;
  EXPECT_NE(said.find("top.toml:4:18; the others: "), std::string::npos) << said;
  EXPECT_TRUE(said.ends_with("mine.toml:3:10")) << said;
  // The finger's file below a section of this file.
  Whole below;
  read("[finger]\nbase = \"mine.toml\"\nwater.volume.0 = \"0.4 um3\"\n", below);
  EXPECT_EQ(below.finger.water.volume, (std::vector{0.4e-18, 2e-18, 6e-18, 20e-18}));
  // As a file does, so does the command line.
  Whole set;
  const Document changed = read("base = \"base.toml\"\n", set, {"finger.water.volume.1=3 um3"});
  EXPECT_EQ(set.finger.water.volume, whole.finger.water.volume);
  EXPECT_NE(to_toml(set, &changed.origins())
                .find("  # 1: --set finger.water.volume.1=3 um3; the others: "),
            std::string::npos);
}

TEST_F(ItemsOfABase, AreThoseThatItHas) {
  Whole whole;
  const auto told = [&](const std::string& text) {
    const auto problems = tests::problems_of([&] { read("base = \"base.toml\"\n" + text, whole); });
    EXPECT_EQ(problems.size(), 1u);
    const Problem p = problems.empty() ? Problem{} : problems[0];
    return fmt::format("{}:{}: {}: {}", fs::path(p.file).filename().string(), p.line, p.key,
                       p.message);
  };
  EXPECT_EQ(told("[surface.dielectric.2]\nthickness = \"1 nm\"\n"),
            "top.toml:3: surface.dielectric: no item 2 in a list of 2");
  EXPECT_EQ(told("[finger]\nwater.volume.4 = \"3 um3\"\n"),
            "top.toml:4: finger.water.volume: no item 4 in a list of 4");
}

TEST(Writer, NumbersSetAloneInADefaultListSaySo) {
  Document document = parse_document("[environment]\nrelative_humidity.1 = \"40 %\"\n", "a.toml");
  Whole whole;
  read_section(document, "", whole);
  finish(document);
  const std::string text = to_toml(whole, &document.origins());
  EXPECT_NE(text.find("  # 1: a.toml:2:23; the others: default ("), std::string::npos) << text;
}

TEST(Reader, FilesThatAreNoneAreRefusedWithWhatTheyAre) {
  const Folder folder("none");
  const auto why = [&](const std::string& path) {
    try {
      load_document(path);
    } catch (const InputError& error) {
      const Problem& p = error.problems().at(0);
      EXPECT_TRUE(p.file == path || p.file.ends_with("old.toml")) << p.file;
      return p.message;
    }
    return std::string();
  };
  EXPECT_EQ(why(folder.path() + "/a.toml"), "no such file");
  EXPECT_EQ(why(folder.path()), "is a folder, expected a TOML file");
  folder.write("resolved.toml", "");
  fs::create_directory(folder.path() + "/best");
  folder.write("best/build.toml", "");
  EXPECT_EQ(why(folder.path()),
            "is a folder, expected a TOML file: it has best/build.toml, resolved.toml");
  for (const char* ending : {".gsf", ".npy", ".exr", ".tif", ".tiff", ".x3p"}) {
    const std::string map = folder.write(std::string("a") + ending, "a = 1\n");
    EXPECT_EQ(why(map), "is a map of heights, expected a TOML file; `papilla surface " + map +
                            "` shows it, and a design has it as `texture.file` of `texture.type = "
                            "\"measured\"`");
  }
  const std::string large = folder.write("large.toml", "a = 1\n");
  fs::resize_file(large, (16 << 20) + 1);
  EXPECT_EQ(why(large), "larger than 16 MiB, expected a TOML file");
  EXPECT_EQ(why(folder.write("b.toml", "base = 3\n")), "expected the name of a file, got 3");
  folder.write("old.toml", "schema_version = 2\n");
  EXPECT_EQ(why(folder.write("c.toml", "base = \"old.toml\"\n")), "expected 1, got 2");
  EXPECT_EQ(why(folder.write("d.toml", "base = \"d.toml\"\n")), "\"d.toml\" is based on itself");
}

TEST(Toml, IsWrittenAsItIsRead) {
  const std::string text =
      "z = 1\na = -2.5\nlarge = 1e300\nwhole = 3.0\nup = inf\ndown = -inf\nnone = nan\n"
      "yes = true\nno = false\n\"two words\" = \"x\"\n\"\" = \"\"\nmixed = [1, { b = 2 }, [3, "
      "[]]]\n"
      "empty = []\nescaped = \"\\\\ \\\" \\n \\t \\u0001 \\u007F\"\n\n[A-b_9]\n"
      "\"c.d\" = { e = 1 }\nf = 2\n\n[[list]]\na = 1\n\n[[list]]\n\n[list.in]\nb = 2\n";
  EXPECT_EQ(write_toml(parse_toml(text, "x")), text);
}

TEST(Toml, EachKindIsDescribed) {
  const Node root = parse_toml(
      "a = {}\nb = []\nc = \"x\"\nd = 12\ne = 1.5\nf = true\ng = false\nh = 2020-01-02\n", "x");
  std::string said;
  for (const Node& node : root.children) said += describe(node) + "; ";
  EXPECT_EQ(said, "a section; a list; \"x\"; 12; 1.5; true; false; a date or time; ");
  EXPECT_EQ(root.children[4].place.line, 5);
  EXPECT_EQ(root.children[4].place.column, 5);
  EXPECT_EQ(root.children[4].key_place.column, 1);
}

TEST(Toml, KeysHaveTwoHundredDotsAtMost) {
  const auto deep = [](int dots) {
    std::string out = "x = 1\na";
    for (int i = 0; i < dots; ++i) out += ".a";
    return out + " = 1\n";
  };
  EXPECT_NO_THROW(parse_toml(deep(200), "x"));
  try {
    parse_toml(deep(201), "x");
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_EQ(error.problems()[0].text(), "x:2:1: more than 200 dots in a key");
  }
  // Counted anew behind a comma, an equals sign and a line.
  const auto key = [](const std::string& part, int dots) {
    std::string out = part;
    for (int i = 0; i < dots; ++i) out += "." + part;
    return out;
  };
  std::string numbers = "x = [1.5";
  for (int i = 0; i < 300; ++i) numbers += ", 1.5";
  for (const std::string& text :
       {numbers + "]\n", key("a", 150) + " = { " + key("b", 150) + " = 1 }\n",
        "[" + key("a", 150) + "]\n[" + key("b", 150) + "]\n"})
    EXPECT_EQ(refusal_of([&] { parse_toml(text, "x"); }), "");
}

// Each key alone has fewer than two hundred; those of the tables around it go with it.
TEST(Toml, KeysInTablesHaveFourHundredDotsInAllAtMost) {
  std::string key = "a";
  for (int i = 0; i < 150; ++i) key += ".a";
  const auto nested = [&](int levels, const std::string& open, const std::string& close) {
    std::string out = key + " = 1";
    for (int i = 1; i < levels; ++i) out = key + " = " + open + out + close;
    return out + "\n";
  };
  for (const auto& [open, close] :
       {std::pair("{ ", " }"), std::pair("[{ ", " }]"), std::pair("[1.5,\n{ ", " }\n]")}) {
    EXPECT_EQ(refusal_of([&] { parse_toml(nested(2, open, close), "x"); }), "") << open;
    for (const int levels : {3, 100})
      EXPECT_TRUE(refusal_of([&] {
                    parse_toml(nested(levels, open, close), "x");
                  }).ends_with("more than 400 dots in a key and those that it stands in"))
          << open;
  }
  // Of tables beside each other none stands in another.
  std::string many = "x = [";
  for (int i = 0; i < 5; ++i) many += "{ " + key + " = 1.5, b = [1.5] }, ";
  EXPECT_EQ(refusal_of([&] { parse_toml(many + "]\ny." + key + " = { z = 1 }\n", "x"); }), "");
}

// Signs in quotes part no keys, and dots there make no tables.
TEST(Toml, QuotedPartsOfAKeyCountAsOthers) {
  const auto key = [](const std::string& part, int dots) {
    std::string out = part;
    for (int i = 0; i < dots; ++i) out += "." + part;
    return out;
  };
  for (const char* part : {"\"=\"", "\",\"", "'='", "\"\\\"=\"", "'\"'", "\"a.b\""}) {
    EXPECT_EQ(refusal_of([&] { parse_toml(key(part, 150) + " = 1\n", "x"); }), "") << part;
    EXPECT_TRUE(refusal_of([&] {
                  parse_toml(key(part, 201) + " = 1\n", "x");
                }).ends_with("x:1:1: more than 200 dots in a key"))
        << part;
  }
  const std::string many(300, '.');
  for (const std::string& text :
       {"a = \"" + many + "\"\n", "'" + many + "' = 1\n", "a = '''" + many + "''''\n",
        "a = \"\"\"\n\\\"\"\" " + many + "\n\"\"\"\"\"\n"})
    EXPECT_EQ(refusal_of([&] { parse_toml(text, "x"); }), "") << text;
  // A text that does not end in its line hides none of the next.
  EXPECT_TRUE(refusal_of([&] {
                parse_toml("a = '\"' \"\\\n" + key("b", 201) + " = 1\n", "x");
              }).ends_with("x:2:1: more than 200 dots in a key"));
}

// Wherever they stand; a '#' in quotes begins none, so that it hides no deep key.
TEST(Toml, CommentsMayHaveAnyNumberOfDots) {
  const std::string many(300, '.');
  for (const std::string& text :
       {"# " + many + "\na = 1\n", "a = 1 # " + many + "\n", "a = \"3 um\" # \"" + many + "\n",
        "a = \"x \\\" # y\" # " + many + "\n", "a = '#' # " + many,
        "  # it's " + many + "\na = 1\n", "a = \"\"\"\n# " + many + "\n\"\"\"\n"})
    EXPECT_EQ(refusal_of([&] { parse_toml(text, "x"); }), "") << text;
  std::string deep;
  for (int i = 0; i < 201; ++i) deep += ".b";
  for (const std::string& text :
       {"\"#\"" + deep + " = 1\n", "'#'" + deep + " = 1\n", "\"\\\"#\"" + deep + " = 1\n",
        "t = { a = \"\"\"\n' \"\"\", \"'#\"" + deep + " = 1 }\n",
        "t = { a = \"\"\"\n# \"\"\", b" + deep + " = 1 }\n"})
    EXPECT_TRUE(refusal_of([&] { parse_toml(text, "x"); }).ends_with("more than 200 dots in a key"))
        << text;
}

TEST(Describe, FindsNumbersByPath) {
  Whole whole;
  EXPECT_EQ(get_number(whole, "surface.dielectric.0.thickness"), 500e-9);
  set_number(whole, "environment.relative_humidity.1", 0.4);
  EXPECT_EQ(whole.environment.relative_humidity[1], 0.4);
  set_number(whole, "finger.skin.rms", 1e-7);
  EXPECT_EQ(whole.finger.skin.rms, 1e-7);
  EXPECT_STREQ(find_number(whole, "finger.skin.rms").unit, "nm");
  EXPECT_EQ(refusal_of([&] { set_number(whole, "finger.skin.rsm", 1); }),
            "finger.skin.rsm: no such number in the design, did you mean `finger.skin.rms`?");
}

TEST(Describe, EveryRowHasUnitRangeDefaultAndSource) {
  const std::string text = reference_markdown(field_rows(Whole{}));
  EXPECT_NE(text.find("| `finger.skin.rms` | rms height over a 12 um patch | a length in nm | 0 to "
                      "100000 nm | `207 nm` | fit: to M3; AFM anchors 200-350 nm |"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace papilla::tests::reader_test
