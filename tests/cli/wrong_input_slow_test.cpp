// Whatever is wrong with an input: exit code 2, a message that says where, and nothing written.
#include <gtest/gtest.h>

#include <vector>

#include "tests/cli/program.h"

namespace papilla::tests::wrong_input_slow_test {
namespace {

struct WrongFile {
  const char* what;
  std::string text;
  const char* message;  // part of what is printed
};

const std::string kHead = "schema_version = 1\n";
const std::string kHole =
    kHead + "[texture]\ntype = \"hole_array\"\nperiod = \"6 um\"\ndiameter = \"3 um\"\n";

std::vector<WrongFile> wrong_files() {
  return {
      {"an empty file", "", "bad.toml:1:1: the file is empty"},
      {"blanks only", " \n\n", "bad.toml:1:1: the file is empty"},
      {"binary garbage", std::string("\x7f\x45\x4c\x46\x02\x01\x00\xff\xfe garbage", 18),
       "bad.toml:1:7: not valid TOML"},
      {"no TOML", "texture: {type: hole}\n", "bad.toml:1:8: not valid TOML"},
      {"an open bracket", kHead + "[texture\n", "bad.toml:2:9: not valid TOML"},
      {"a key twice", kHead + "title = \"a\"\ntitle = \"b\"\n", "bad.toml:3:9: not valid TOML"},
      {"no version", "title = \"x\"\n", "bad.toml:1:1: missing `schema_version`"},
      {"a version of the future", "schema_version = 2\n",
       "bad.toml:1:18: schema_version: expected 1, got 2"},
      {"a typo in a key", kHead + "[texture]\ntype = \"hole_array\"\ndiamter = \"3 um\"\n",
       "bad.toml:4:1: texture: unknown key `diamter`, did you mean `diameter`?"},
      {"a typo in a section", kHead + "[textur]\n",
       "bad.toml:2:2: unknown key `textur`, did you mean `texture`?"},
      {"a missing unit", kHole + "depth = 350\n",
       "bad.toml:6:9: texture.depth: needs a unit, e.g. \"350 nm\""},
      {"a wrong dimension", kHole + "depth = \"350 V\"\n",
       "bad.toml:6:9: texture.depth: expected a length, got \"350 V\""},
      {"an unknown unit", kHole + "depth = \"350 parsec\"\n",
       "bad.toml:6:9: texture.depth: expected a length, got \"350 parsec\""},
      {"not a number", kHole + "depth = \"nan nm\"\n",
       "bad.toml:6:9: texture.depth: expected a length, got \"nan nm\""},
      {"a hole larger than its period",
       kHead + "[texture]\ntype = \"hole_array\"\nperiod = \"3 um\"\ndiameter = \"4 um\"\n",
       "bad.toml:5:12: texture.diameter: 4 um is not smaller than the period 3 um"},
      {"an unknown kind", kHead + "[texture]\ntype = \"hole_aray\"\n",
       "bad.toml:3:8: texture.type: expected one of"},
      {"a negative load", kHead + "[finger]\nload = \"-0.2 N\"\n",
       "bad.toml:3:8: finger.load: -0.2 N is outside 0 to 100 N"},
      {"no load", kHead + "[finger]\nload = \"0 N\"\n",
       "bad.toml:3:8: finger.load: expected a force above 0 N"},
      {"humidity above 100 %", kHead + "[environment]\nrelative_humidity = [\"50 %\", \"150 %\"]\n",
       "bad.toml:3:30: environment.relative_humidity.1: 150 % is outside 0 to 100 %"},
      {"a humidity without unit", kHead + "[environment]\nrelative_humidity = [0.5]\n",
       "bad.toml:3:22: environment.relative_humidity.0: needs a unit"},
      {"no humidity", kHead + "[environment]\nrelative_humidity = []\n",
       "bad.toml:3:21: environment.relative_humidity: expected at least one humidity"},
      {"a text for a flag", kHead + "[model]\nrim_pinning = \"yes\"\n",
       "bad.toml:3:15: model.rim_pinning: expected true or false, got \"yes\""},
      {"a number for a section", kHead + "drive = 3\n",
       "bad.toml:2:9: drive: expected a section [drive], got 3"},
      {"a base that is not there", kHead + "base = \"none.toml\"\n",
       "bad.toml:2:8: base: no file \"none.toml\""},
      {"a base on itself", kHead + "base = \"bad.toml\"\n",
       "bad.toml:2:8: base: \"bad.toml\" is based on itself"},
      {"a base far away", kHead + "base = \"/etc/passwd\"\n",
       "bad.toml:2:8: base: \"/etc/passwd\" lies outside"},
      {"a map that is not there", kHead + "[finger.skin]\nmap = \"skin.npy\"\n",
       "bad.toml:3:7: finger.skin.map: no such file: \"skin.npy\""},
      {"a bound that is no number", kHead + "[design_space]\n\"texture.type\" = [1, 2]\n",
       "bad.toml:3:18: design_space.texture.type: expected { choice = [...] } of texture types"},
      {"a variable that is no number", kHead + "[design_space]\n\"finger.name\" = [1, 2]\n",
       "bad.toml:3:1: design_space: `finger.name` is no number of this design"},
      {"bounds the wrong way round",
       kHead + "[design_space]\n\"drive.amplitude\" = [\"2 V\", \"1 V\"]\n",
       "bad.toml:3:21: design_space.drive.amplitude: expected low < high"},
      {"an unknown metric", kHead + "[objective]\nmaximise = \"mean(modulatoin)\"\n",
       "bad.toml:3:12: objective.maximise: "},
      {"an unknown constraint", kHead + "[constraints]\nmin_hol = \"1 um\"\n",
       "bad.toml:3:1: constraints: unknown key `min_hol`, did you mean `min_hole`?"},
      {"a finger that is not there", kHead + "[population]\nfingers = [\"none.toml\"]\n",
       "bad.toml:3:12: population.fingers: no file \"none.toml\""},
      {"an unknown method", kHead + "[search]\nmethod = \"magic\"\n",
       "bad.toml:3:10: search.method: expected one of"},
  };
}

TEST(WrongFile, IsRefusedWithItsPlaceAndNothingIsWritten) {
  for (const WrongFile& wrong : wrong_files()) {
    const Workplace place;
    place.write("bad.toml", wrong.text);
    const Outcome run = place.run("evaluate bad.toml --out results");
    EXPECT_EQ(run.status, 2) << wrong.what << ": " << run.err;
    EXPECT_NE(run.err.find(wrong.message), std::string::npos)
        << wrong.what << ": expected \"" << wrong.message << "\", got\n"
        << run.err;
    EXPECT_EQ(run.out, "") << wrong.what;
    EXPECT_EQ(place.entries(), 1) << wrong.what << ": something was written";
  }
}

TEST(WrongFile, SeveralMistakesAreReportedTogether) {
  const Workplace place;
  place.write("bad.toml",
              kHole + "depth = 350\n[finger]\nlaod = \"1 N\"\n[drive]\namplitude = \"1 m\"\n");
  const Outcome run = place.run("explain bad.toml");
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(run.err,
            "error: bad.toml:6:9: texture.depth: needs a unit, e.g. \"350 nm\"\n"
            "error: bad.toml:8:1: finger: unknown key `laod`, did you mean `load`?\n"
            "error: bad.toml:10:13: drive.amplitude: expected a voltage, got \"1 m\"\n");
}

TEST(WrongCommandLine, IsRefused) {
  const Workplace place;
  place.write("good.toml", kHead);
  for (const auto& [arguments, message] : std::vector<std::pair<std::string, std::string>>{
           {"", "A subcommand is required"},
           {"evalute good.toml", "unknown command `evalute`, did you mean `evaluate`?"},
           {"explain", "file is required"},
           {"explain none.toml", "none.toml: no such file"},
           {"explain .", ".: is a folder"},
           {"explain good.toml --frobnicate", "--frobnicate"},
           {"explain good.toml --set finger.load", "expected KEY=VALUE"},
           {"explain good.toml --set 'finger.load=3 um'",
            "--set finger.load=3 um: finger.load: expected a force, got \"3 um\""},
           {"explain good.toml --set finger.laod=3N", "unknown key `laod`, did you mean `load`?"},
           {"evaluate good.toml --jobs -3", "--jobs"},
           {"evaluate good.toml --sweep finger.load", "expected PATH=LOW..HIGH"},
           {"evaluate good.toml --sweep finger.lod=1..2", "did you mean `finger.load`?"},
           {"evaluate good.toml --sweep 'finger.load=1 V..2 V'", "expected a force"},
           {"evaluate good.toml --set model.closure=persson", "fitted with \"uniform\""},
           {"describe textur", "no section `textur`, did you mean `texture`?"},
           {"describe depth", "no section `depth`, did you mean `texture.depth`?"},
           {"evaluate " PAPILLA_DESIGNS_DIR "/measured_surface/scan.gsf",
            "is a map of heights, expected a TOML file; `papilla surface "},
           {"optimize " PAPILLA_DESIGNS_DIR "/electroadhesive_glass/study.toml --time 60",
            "--time: \"60\" is a plain number"},
       }) {
    const Outcome run = place.run(arguments);
    EXPECT_EQ(run.status, 2) << arguments;
    EXPECT_NE(run.err.find(message), std::string::npos) << arguments << ": " << run.err;
    EXPECT_EQ(run.out, "") << arguments;
    EXPECT_EQ(place.entries(), 1) << arguments;
  }
}

}  // namespace
}  // namespace papilla::tests::wrong_input_slow_test
