#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>

#include "tests/cli/program.h"

namespace papilla::tests::commands_test {
namespace {

const std::string kSample = PAPILLA_SOURCE_DIR "/designs/m3_samples/a3h600.toml";
const std::string kRough = PAPILLA_SOURCE_DIR "/designs/m3_samples/screen_rough.toml";
const std::string kDraft = " --set accuracy.level=draft ";
// Where no number of the answer matters.
const std::string kGrid = "--set accuracy.grid=32 ";
const std::string kQuick = kDraft + kGrid + "--set 'environment.relative_humidity=[\"50 %\"]' ";

TEST(Program, HelpAndVersionSucceed) {
  const Workplace place;
  EXPECT_EQ(place.run("--help").status, 0);
  const Outcome version = place.run("--version");
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(version.out, "papilla " PAPILLA_VERSION "\n");
  // Every command that --help lists explains itself.
  std::istringstream help(place.run("--help").out);
  int commands = 0;
  bool listed = false;
  for (std::string line; std::getline(help, line);) {
    if (listed && line.size() > 2 && line[2] != ' ') {
      const std::string name = line.substr(2, line.find(' ', 2) - 2);
      EXPECT_EQ(place.run(name + " --help").status, 0) << name;
      ++commands;
    }
    if (line == "Subcommands:") listed = true;
  }
  EXPECT_GE(commands, 4);
}

TEST(Program, TakesTheWordHelpForTheOption) {
  const Workplace place;
  for (const auto& [word, option] : std::vector<std::pair<std::string, std::string>>{
           {"help", "--help"},
           {"help solve", "solve --help"},
           {"solve help contact", "solve contact --help"}}) {
    const Outcome help = place.run(word);
    EXPECT_EQ(help.status, 0) << word;
    EXPECT_EQ(help.out, place.run(option).out) << word;
  }
  const Outcome none = place.run("help evalute");
  EXPECT_EQ(none.status, 2);
  EXPECT_NE(none.err.find("did you mean `evaluate`?"), std::string::npos) << none.err;
}

// The libraries of image formats and of searches take longer to load than most commands run.
TEST(Program, LoadsModulesWhereTheyAreUsedAndNowhereElse) {
  const Workplace place;
  const auto loads = [&](const std::string& arguments) {
    const Outcome run = place.shell("LD_DEBUG=libs '" PAPILLA_PROGRAM "' " + arguments);
    EXPECT_EQ(run.status, 0) << arguments;
    return run.err.find("papilla_") != std::string::npos;  // a module of any name
  };
  EXPECT_FALSE(loads("--version"));
  EXPECT_FALSE(loads("explain " + kSample));
  EXPECT_FALSE(loads("export " + kSample + " --format npy,gsf --pixels 64 --out plain"));
  EXPECT_TRUE(loads("export " + kSample + " --format exr --pixels 64 --out image"));
  // Copied without the module that belongs beside it, it says so before anything is written.
  std::filesystem::copy_file(PAPILLA_PROGRAM, place.path() / "alone");
  const auto beside = std::filesystem::path(PAPILLA_PROGRAM).parent_path();
  for (const auto& file : std::filesystem::directory_iterator(beside)) {  // none: linked statically
    if (file.path().filename().string().starts_with("libpapilla.so"))
      std::filesystem::copy(file.path(), place.path() / file.path().filename());
  }
  const auto alone = [&](const std::string& arguments) {
    return place.shell(
        "PAPILLA_DESIGNS='" PAPILLA_SOURCE_DIR "/designs' LD_LIBRARY_PATH=. ./alone " + arguments);
  };
  const Outcome broken = alone("export " + kSample + " --format exr --pixels 64 --out broken");
  EXPECT_EQ(broken.status, 1);
  EXPECT_NE(broken.err.find("papilla_images.so"), std::string::npos) << broken.err;
  EXPECT_FALSE(std::filesystem::exists(place.path() / "broken/heightmap.exr"));
  // With that one, but without pagmo's.
  std::filesystem::copy_file(beside / "papilla_images.so", place.path() / "papilla_images.so");
  const std::string study = PAPILLA_SOURCE_DIR "/designs/electroadhesive_glass/study.toml";
  const Outcome unable = alone("optimize " + study + " --set search.method=nsga2 --out never");
  EXPECT_EQ(unable.status, 1);
  EXPECT_NE(unable.err.find("papilla_evolution.so"), std::string::npos) << unable.err;
  EXPECT_FALSE(std::filesystem::exists(place.path() / "never"));
}

TEST(Program, CompletionIsValidShell) {
  const Workplace place;
  const Outcome run = place.shell("'" PAPILLA_PROGRAM "' completion bash > c.sh && bash -n c.sh");
  EXPECT_EQ(run.status, 0) << run.err;
  const Outcome bash = place.shell(
      "bash -c 'source c.sh; COMP_WORDS=(papilla expl); COMP_CWORD=1; _papilla; echo "
      "${COMPREPLY[*]}'");
  EXPECT_EQ(bash.out, "explain\n") << bash.err;
}

// One line a command and an option, in words that fish reads; every option of the program is there.
TEST(Program, CompletionOfFishKnowsEveryCommand) {
  const Workplace place;
  const Outcome fish = place.run("completion fish");
  ASSERT_EQ(fish.status, 0) << fish.err;
  EXPECT_NE(
      fish.out.find("complete -c papilla -n __fish_use_subcommand -f -a optimize -d 'Search "),
      std::string::npos)
      << fish.out;
  EXPECT_NE(fish.out.find("-n '__fish_seen_subcommand_from optimize' -l time -r -d '"),
            std::string::npos);
  EXPECT_NE(fish.out.find("-n '__fish_seen_subcommand_from solve' -f -a haze"), std::string::npos);
  std::istringstream lines(fish.out);
  for (std::string line; std::getline(lines, line);)
    EXPECT_TRUE(line.starts_with('#') || line.starts_with("complete -c papilla ")) << line;
}

TEST(Program, ManualPagesAreOfTheCommandsThemselves) {
  const Workplace place;
  ASSERT_EQ(place.run("describe --manuals man").status, 0);
  const std::string page = file_text(place.path() / "man/papilla-optimize.1");
  EXPECT_TRUE(page.starts_with(".TH \"papilla\\-optimize\" \"1\"")) << page;
  EXPECT_NE(page.find("\\fB\\-\\-time\\fR"), std::string::npos) << page;
  EXPECT_NE(page.find("130 for Ctrl"), std::string::npos);
  EXPECT_NE(file_text(place.path() / "man/papilla.1").find(".BR papilla\\-rank (1)"),
            std::string::npos);
  EXPECT_NE(file_text(place.path() / "man/papilla-solve.1").find("papilla solve haze"),
            std::string::npos);
}

// Words of the lines in bold of a section of a manual page.
std::vector<std::vector<std::string>> bold_lines(const std::string& page,
                                                 const std::string& section) {
  std::vector<std::vector<std::string>> out;
  const std::size_t begin = page.find(".SH " + section + "\n");
  if (begin == std::string::npos) return out;
  std::istringstream lines(page.substr(begin, page.find("\n.SH ", begin + 1) - begin));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("\\fB")) continue;
    for (const char* mark : {"\\fB", "\\fR", "\\fI", "\\"}) {
      for (std::size_t at; (at = line.find(mark)) != std::string::npos;)
        line.erase(at, std::string(mark).size());
    }
    std::istringstream words(line);
    out.emplace_back(std::istream_iterator<std::string>(words),
                     std::istream_iterator<std::string>());
  }
  return out;
}

TEST(Program, ManualPagesDescribeEveryCommandWithExamplesThatItTakes) {
  const Workplace place;
  ASSERT_EQ(place.run("describe --manuals man").status, 0);
  int pages = 0;
  for (const auto& entry : std::filesystem::directory_iterator(place.path() / "man")) {
    const std::string name = entry.path().stem().string(), page = file_text(entry.path());
    if (name == "papilla") continue;
    ++pages;
    EXPECT_NE(page.find(".SH DESCRIPTION\n"), std::string::npos) << name;
    const auto examples = bold_lines(page, "EXAMPLES");
    EXPECT_FALSE(examples.empty()) << name;
    for (const auto& words : examples) {
      EXPECT_EQ("papilla-" + words.at(1), name);
      for (const std::string& word : words) {
        if (word.starts_with("--")) {
          const std::string bold = "\\fB" + std::regex_replace(word, std::regex("-"), "\\-");
          EXPECT_NE(page.find(bold + "\\fR"), std::string::npos) << name << ' ' << word;
        } else if (word.ends_with(".toml") || word.ends_with(".gsf")) {
          EXPECT_TRUE(std::filesystem::exists(PAPILLA_DESIGNS_DIR "/" + word))
              << name << ' ' << word;
        }
      }
    }
  }
  EXPECT_GE(pages, 17);
}

TEST(Program, HelpOfAPieceOfPhysicsHasItsOwnExamples) {
  const Workplace place;
  for (const std::string piece :
       {"bridge", "contact", "drive", "droplets", "field", "haze", "persson"}) {
    const std::string help = place.run("solve " + piece + " --help").out;
    const std::string examples = help.substr(std::min(help.find("Examples:"), help.size()));
    int found = 0;
    for (std::size_t at = 0; (at = examples.find("papilla solve ", at)) != std::string::npos;) {
      at += std::string("papilla solve ").size();
      EXPECT_EQ(examples.substr(at, piece.size() + 1), piece + " ") << examples;
      ++found;
    }
    EXPECT_GT(found, 0) << piece;
  }
}

TEST(Describe, KnowsTheSectionsOfStudiesAndTheWordsOfTheField) {
  const Workplace place;
  for (const char* section : {"search", "objective", "design_space", "constraints", "population",
                              "scenarios", "scatter", "base"}) {
    const Outcome run = place.run(std::string("describe ") + section);
    EXPECT_EQ(run.status, 0) << section << run.err;
    EXPECT_NE(run.out.find(std::string("\n") + section), std::string::npos) << run.out;
  }
  EXPECT_EQ(place.run("describe search").out.find("constraints."), std::string::npos);
  EXPECT_NE(place.run("describe search.time").out.find("wall-clock"), std::string::npos);
  EXPECT_NE(place.run("describe voltage").err.find("did you mean `drive.amplitude`?"),
            std::string::npos);
  EXPECT_NE(place.run("describe drive.voltage").err.find("did you mean `drive.amplitude`?"),
            std::string::npos);
}

TEST(Explain, OfAStudySaysWhatItTakes) {
  const Workplace place;
  const Outcome run = place.run("explain " PAPILLA_DESIGNS_DIR "/electroadhesive_glass/study.toml");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(
      run.out.find("as a study: 100 evaluations of 4 tasks each, then 32 designs judged again"),
      std::string::npos)
      << run.out;
  EXPECT_NE(run.out.find("as busy as this machine is now, and about "), std::string::npos)
      << run.out;
}

// As `optimize` refuses it.
TEST(Explain, OfAStudyThatNoDesignAnswersIsRefused) {
  const Workplace place;
  const Outcome run = place.run("explain " PAPILLA_DESIGNS_DIR
                                "/m3_glass/conformal.toml --set 'constraints.min_wall=\"12 um\"' "
                                "--set 'design_space.texture.depth=[\"100 nm\", \"500 nm\"]'");
  EXPECT_EQ(run.status, 2) << run.out;
  EXPECT_NE(run.err.find("no texture of [design_space] keeps min_wall (at least 12 um)"),
            std::string::npos)
      << run.err;
  EXPECT_EQ(run.out, "");
}

// As `optimize` prices it, which keeps no more processors busy.
TEST(Explain, PricesAStudyOnTheJobsThatItAllows) {
  const Workplace place;
  const Outcome run = place.run("explain " PAPILLA_DESIGNS_DIR
                                "/electroadhesive_glass/study.toml --set search.jobs=1");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find(" on 1 processor as busy"), std::string::npos) << run.out;
}

// As many as are drawn: those of the search, its recommendation and two beside it in each variable,
// and those of the fab's grid.
TEST(Explain, OfAStudyThatAsksForLooksPricesThem) {
  const Workplace place;
  const Outcome run = place.run("explain " PAPILLA_DESIGNS_DIR "/transparent_glass/study.toml");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find("of that the looks of 252 designs take "), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("by the theory \"phase screen\")\n"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find(" for the look (--appearance: with)"), std::string::npos) << run.out;
  const std::size_t optics = run.out.find("  optics "), skipped = run.out.find("not modelled:");
  EXPECT_LT(optics, skipped) << run.out;
  EXPECT_EQ(run.out.find("  optics ", skipped), std::string::npos) << run.out;
}

// Holes between the theories: the plan for programs names the Fourier modal method and does not
// wait for it.
TEST(Explain, OfAStudyNamesTheTheoryOfItsLook) {
  const Workplace place;
  const Outcome run =
      place.run("explain " PAPILLA_DESIGNS_DIR
                "/transparent_glass/study.toml --set 'texture.period=\"1 um\"' --set "
                "'texture.diameter=\"0.5 um\"' --json");
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(run.err.find("timing the look"), std::string::npos) << run.err;
  const auto plan = nlohmann::json::parse(run.out)["plan"];
  const auto optics = std::find_if(plan["steps"].begin(), plan["steps"].end(),
                                   [](const auto& step) { return step["piece"] == "optics"; });
  ASSERT_NE(optics, plan["steps"].end()) << run.out;
  EXPECT_EQ((*optics)["method"], "rigorous");
}

// Their arc meets the floor first: half-way down the holes are half as wide again.
TEST(Explain, SaysWhatRimsLargerThanTheDepthMakeOfTheWalls) {
  const Workplace place;
  const auto said = [&](const char* radius) {
    return place
        .run("explain " + kSample +
             " --set texture.depth=350nm --set 'texture.wall_angle=88deg' --set "
             "texture.diameter=3um --set texture.edge_radius=" +
             radius)
        .out;
  };
  EXPECT_NE(said("1500nm").find("warning: rims of 1500 nm end at the depth of 350 nm before the "
                                "wall is 88 deg steep: holes are 4.49 um wide half-way down, 2.99 "
                                "um with sharp rims; below 363 nm the wall has its angle\n"),
            std::string::npos)
      << said("1500nm");
  EXPECT_EQ(said("300nm").find("rims of"), std::string::npos) << said("300nm");
  // Of a stack by the part that has them.
  place.write("stack.toml",
              "schema_version = 1\n[texture]\ntype = \"stack\"\nparts = [{ type = "
              "\"hole_array\", period = \"3 um\", diameter = \"1 um\", depth = \"50 nm\" }, "
              "{ type = \"hole_array\", period = \"6 um\", diameter = \"3 um\", depth = "
              "\"350 nm\", wall_angle = \"88 deg\", edge_radius = \"1500 nm\" }]\n[finger]\nbase "
              "= \"fingers/reference.toml\"\n");
  const Outcome stack = place.run("explain stack.toml");
  EXPECT_NE(stack.out.find("warning: texture.parts.1: rims of 1500 nm end at the depth of 350 nm"),
            std::string::npos)
      << stack.out << stack.err;
  EXPECT_EQ(stack.out.find("texture.parts.0: rims"), std::string::npos) << stack.out;
}

TEST(Explain, PricesTheMembersOfBeliefWhereTheyAreRun) {
  const Workplace place;
  const std::string members = " members of the finger's belief";
  EXPECT_NE(place.run("explain " + kSample + kDraft).out.find(members), std::string::npos);
  const Outcome other = place.run("explain " + kSample + kDraft + " --set model.closure=balance");
  EXPECT_EQ(other.status, 0) << other.err;
  EXPECT_EQ(other.out.find(members), std::string::npos) << other.out;
}

TEST(Explain, NamesWhatItSkipsAndWhy) {
  const Workplace place;
  const Outcome undriven = place.run("explain " + kSample + " --set drive.amplitude=0V");
  EXPECT_EQ(undriven.status, 0);
  EXPECT_NE(undriven.out.find("the drive is at 0"), std::string::npos) << undriven.out;
  const Outcome dry =
      place.run("explain " + kSample +
                " --set 'finger.water.volume=[\"0 um3\",\"0 um3\",\"0 um3\",\"0 um3\"]'");
  EXPECT_NE(dry.out.find("no water at any of these humidities"), std::string::npos) << dry.out;
  const auto plan = nlohmann::json::parse(place.run("explain --json " + kSample).out);
  EXPECT_EQ(plan["schema"], 1);
  EXPECT_GE(plan["plan"]["steps"].size(), 3u);
  const Outcome target =
      place.run("explain " + kSample + " --set accuracy.target=5% --set accuracy.level=draft");
  EXPECT_NE(target.out.find("accuracy.target = 5 %: what follows is the pilot"), std::string::npos)
      << target.out;
  EXPECT_NE(target.out.find("8 skins on 64 x 64 pixels"), std::string::npos) << target.out;
  EXPECT_NE(target.out.find("accuracy.level and accuracy.grid count for"), std::string::npos);
}

TEST(Evaluate, BeyondBreakdownItsNumbersMeanNothing) {
  const Workplace place;
  const std::string line = "evaluate " + kSample + kQuick + "--set drive.amplitude=99kV ";
  const Outcome text = place.run(line), json = place.run(line + "--json");
  EXPECT_NE(text.out.find("mean nothing physical"), std::string::npos) << text.out;
  EXPECT_EQ(text.out.find("from the refined 3-D field"), std::string::npos) << text.out;
  const auto status = nlohmann::json::parse(json.out)["points"][0]["status"].get<std::string>();
  EXPECT_NE(status.find("nothing physical"), std::string::npos) << status;
  const Outcome sound = place.run("evaluate " + kSample + kQuick + "--voltage-for 0.3");
  EXPECT_NE(sound.out.find("V (±: sampling, solver, field; not in ±: grid"), std::string::npos)
      << sound.out;
}

TEST(Rank, RefusesADesignAgainstItselfAndARegionWithoutAName) {
  const Workplace place;
  const Outcome twice = place.run("rank " + kSample + " " + kSample + kDraft);
  EXPECT_EQ(twice.status, 2);
  EXPECT_NE(twice.err.find("named twice"), std::string::npos) << twice.err;
  const Outcome nameless = place.run("rank " + kSample + "+ " + kSample + kDraft);
  EXPECT_EQ(nameless.status, 2);
  EXPECT_NE(nameless.err.find("a3h600.toml+"), std::string::npos) << nameless.err;
}

// A file whose name holds the sign that joins regions is that file.
// As in C++ and Python: the first step of every design.
TEST(Rank, TakesSixSkinsAtLeast) {
  const Workplace place;
  const Outcome run = place.run("rank " + kSample + " other.toml --max-skins 5");
  EXPECT_EQ(run.status, 2);
  EXPECT_NE(run.err.find("--max-skins: Value 5 not in range 6 to 100000"), std::string::npos)
      << run.err;
}

TEST(Rank, TakesAFileWhoseNameHoldsAPlus) {
  const Workplace place;
  for (const char* name : {"h+1.toml", "h.toml"})
    place.write(name, std::string("schema_version = 1\ntitle = \"") + name +
                          "\"\n[texture]\ntype = \"hole_array\"\ndepth = \"350 nm\"\n");
  const Outcome run = place.run("rank h+1.toml h.toml --by haze --no-parameters --json");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_EQ(nlohmann::json::parse(run.out)["candidates"].size(), 2u) << run.out;
}

// A candidate of several regions is not taken for its first.
TEST(Rank, NamesACandidateByItsFirstRegionAndHowManyMoreThereAre) {
  const Workplace place;
  for (const char* name : {"a", "b"})
    place.write(std::string(name) + ".toml",
                "schema_version = 1\n[texture]\ntype = \"hole_array\"\n");
  const Outcome run = place.run("rank a.toml+b.toml a.toml --by haze --no-parameters");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find(" a and 1 more "), std::string::npos) << run.out;
}

// As a design that names the scan, a file for each.
TEST(Rank, PutsScansIntoOneDesign) {
  const Workplace place;
  for (const char* depth : {"350", "600"})
    ASSERT_EQ(place
                  .run("export " + kSample + " --format gsf --set texture.depth=" + depth +
                       "nm --out d" + depth)
                  .status,
              0);
  std::ofstream(place.path() / "common.toml") << R"(schema_version = 1
[finger]
base = "fingers/reference.toml"
load = "0.3 N"
[environment]
relative_humidity = ["35 %"]
[accuracy]
level = "draft"
)";
  std::ofstream(place.path() / "named.toml") << R"(schema_version = 1
base = "common.toml"
[texture]
type = "measured"
file = "d350/heightmap.gsf"
)";
  const std::string by =
      " --base common.toml --by friction:low --no-parameters --max-skins 12 --json";
  const Outcome scans = place.run("rank d350/heightmap.gsf d600/heightmap.gsf" + by),
                mixed = place.run("rank named.toml d600/heightmap.gsf" + by);
  ASSERT_EQ(scans.status, 0) << scans.err;
  ASSERT_EQ(mixed.status, 0) << mixed.err;
  const auto a = nlohmann::json::parse(scans.out), b = nlohmann::json::parse(mixed.out);
  ASSERT_EQ(a["candidates"].size(), 2u) << scans.out;
  EXPECT_EQ(a["candidates"][0]["metrics"], b["candidates"][0]["metrics"]);
  const Outcome pressed = place.run("evaluate d350/heightmap.gsf --base common.toml --json"),
                named = place.run("evaluate named.toml --json");
  ASSERT_EQ(pressed.status, 0) << pressed.err;
  EXPECT_EQ(nlohmann::json::parse(pressed.out)["points"],
            nlohmann::json::parse(named.out)["points"]);
  const Outcome design = place.run("evaluate named.toml --base common.toml");
  EXPECT_EQ(design.status, 2);
  EXPECT_NE(design.err.find("named.toml is no scan"), std::string::npos) << design.err;
  const Outcome alone = place.run("rank d350/heightmap.gsf d600/heightmap.gsf");
  EXPECT_EQ(alone.status, 2);
  EXPECT_NE(alone.err.find("--base COMMON.toml"), std::string::npos) << alone.err;
}

TEST(Evaluate, GivesTheDocumentedJson) {
  const Workplace place;
  const Outcome run = place.run("evaluate --json " + kSample + kDraft + kGrid);
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_EQ(json["schema"], 1);
  ASSERT_EQ(json["points"].size(), 4u);
  for (const auto& point : json["points"]) {
    for (const char* key :
         {"F_off", "F_on", "modulation", "area_fraction_off", "area_fraction_on", "capillary_force",
          "electrostatic_force", "bridges", "wetted_fraction", "mean_gap"}) {
      ASSERT_TRUE(point.contains(key)) << key;
      EXPECT_GE(point[key]["se"].get<double>(), 0) << key;
      for (const char* part : {"sampling", "grid", "solver", "humidity", "method", "parameters"}) {
        EXPECT_TRUE(point[key]["parts"].contains(part)) << key << " " << part;
      }
    }
    const double off = point["F_off"]["value"], on = point["F_on"]["value"];
    EXPECT_NEAR(point["modulation"]["value"].get<double>(), (on - off) / off, 1e-9);
  }
  for (const char* key : {"mean_modulation", "variation", "range", "worst"}) {
    EXPECT_TRUE(json["summary"].contains(key)) << key;
  }
  for (const char* key : {"plan", "seconds", "contact_solves", "fft_pairs"}) {
    EXPECT_TRUE(json.contains(key)) << key;
  }
}

TEST(Evaluate, AnUndrivenDesignHasNoModulationAndSaysSo) {
  const Workplace place;
  const std::string arguments = kSample + kQuick + "--set drive.amplitude=0V";
  EXPECT_NE(place.run("evaluate " + arguments).out.find("undriven"), std::string::npos);
  const auto json = nlohmann::json::parse(place.run("evaluate --json " + arguments).out);
  EXPECT_TRUE(json["points"][0]["modulation"].is_null());
  EXPECT_TRUE(json["summary"]["mean_modulation"].is_null());
}

// What was asked for of the field is in the answer, or why it is not.
TEST(Evaluate, AnswersTheFieldCheckWithItsNumbers) {
  const Workplace place;
  const std::string quick = "-q evaluate " + kSample + kDraft +
                            "--set accuracy.grid=32 --no-model --set "
                            "'environment.relative_humidity=[\"50 %\"]' --check-field ";
  const Outcome json = place.run(quick + "--json"), text = place.run(quick);
  ASSERT_EQ(json.status, 0) << json.err;
  const auto rows = nlohmann::json::parse(json.out)["field_check"];
  ASSERT_GE(rows.size(), 1u) << json.out;
  EXPECT_TRUE(rows[0]["error"].is_number());
  EXPECT_NE(text.out.find("of the 3-D field's"), std::string::npos) << text.out;
  const Outcome undriven = place.run(quick + "--pull-in --set drive.amplitude=0V");
  EXPECT_NE(undriven.out.find("--pull-in and --check-field: the drive is at 0"), std::string::npos)
      << undriven.out;
}

TEST(Evaluate, TheResolvedFileGivesTheSameBytesOnTwoThreadsAsTheDesignOnOne) {
  const Workplace place;
  ASSERT_EQ(place.run("evaluate -q " + kSample + kDraft + kGrid + "--jobs 1 --out first").status,
            0);
  ASSERT_EQ(place.run("evaluate -q first/resolved.toml --jobs 2 --out second").status, 0);
  EXPECT_EQ(file_text(place.path() / "first/response.json"),
            file_text(place.path() / "second/response.json"));
  EXPECT_GT(file_text(place.path() / "first/response.json").size(), 1000u);
}

TEST(Evaluate, SweepsANumber) {
  const Workplace place;
  const Outcome run =
      place.run("evaluate --json -q " + kSample + kQuick + "--sweep drive.amplitude=50..200:2");
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  ASSERT_EQ(json["runs"].size(), 2u);
  EXPECT_EQ(json["runs"][1]["value"], 200);
  // As of a single evaluation: a bridge puts the whole voltage on the film.
  EXPECT_TRUE(json["runs"][1]["response"]["points"][0]["bridged_margin"].is_number());
  // The pull grows with the square of the voltage, so does the modulation at least.
  EXPECT_GT(json["runs"][1]["response"]["summary"]["mean_modulation"]["value"].get<double>(),
            8 * json["runs"][0]["response"]["summary"]["mean_modulation"]["value"].get<double>());
}

TEST(Evaluate, ASweepHasRoundValuesAndIsCheckedBeforeItStarts) {
  const Workplace place;
  const Outcome depths =
      place.run("evaluate " + kSample + kQuick + "--sweep texture.depth=0..1000:3");
  EXPECT_EQ(depths.status, 0) << depths.err;
  EXPECT_EQ(depths.err.find("moves nothing"), std::string::npos) << depths.err;
  const Outcome deaf = place.run("evaluate " + kSample + kQuick +
                                 "--set 'surface.shear_strength=2 MPa' --sweep "
                                 "'finger.macro.shear_strength=5 MPa..13 MPa:2'");
  EXPECT_NE(deaf.err.find("warning: finger.macro.shear_strength moves nothing here"),
            std::string::npos)
      << deaf.err;
  EXPECT_NE(depths.out.find("  500 nm "), std::string::npos) << depths.out;
  EXPECT_NE(depths.out.find("  1000 nm "), std::string::npos) << depths.out;
  const Outcome wide =
      place.run("evaluate " + kSample + kQuick + "--sweep texture.diameter=1..8:3");
  EXPECT_EQ(wide.status, 2);
  EXPECT_EQ(wide.out, "");
  EXPECT_NE(wide.err.find("at 8 um"), std::string::npos) << wide.err;
}

// As a single evaluation: a voltage that the dielectric does not hold has no answer.
TEST(Evaluate, ASweepEndsAsItsWorstValueAndSaysWhatItDoesNotDo) {
  const Workplace place;
  const std::string one = kDraft + "--no-model --set 'environment.relative_humidity=[\"50 %\"]' ";
  const Outcome broken =
      place.run("evaluate " + kSample + one + "--sweep drive.amplitude=50..1000:2");
  EXPECT_EQ(broken.status, 1) << broken.err;
  EXPECT_NE(broken.out.find("  50 V "), std::string::npos) << broken.out;
  // Moves what no line shows to its last digit.
  const Outcome little =
      place.run("evaluate " + kSample + one + "--sweep 'texture.depth=600 nm..600.001 nm:2'");
  EXPECT_EQ(little.status, 0) << little.err;
  EXPECT_EQ(little.err.find("moves nothing"), std::string::npos) << little.err;
  for (const std::string other :
       {"--out folder", "--voltage-for 0.5", "--pull-in", "--accuracy 5%", "--check-field"}) {
    const Outcome refused =
        place.run("evaluate " + kSample + one + "--sweep drive.amplitude=50..200:2 " + other);
    EXPECT_EQ(refused.status, 2) << other;
    EXPECT_EQ(refused.out, "") << other;
    EXPECT_NE(refused.err.find("--sweep goes without " + other.substr(0, other.find(' '))),
              std::string::npos)
        << refused.err;
  }
  for (const std::string count : {"5x", "4.7", "", "1"}) {
    const Outcome refused =
        place.run("evaluate " + kSample + one + "--sweep drive.amplitude=50..200:" + count);
    EXPECT_EQ(refused.status, 2) << count;
    EXPECT_NE(refused.err.find("expected a count of 2 to 10000"), std::string::npos) << refused.err;
  }
  EXPECT_EQ(place.entries(), 0);
}

TEST(Evaluate, OneHumidityHasNoVariationAndABrokenDielectricIsWarnedOf) {
  const Workplace place;
  const Outcome run = place.run("evaluate " + kSample + kDraft +
                                "--set 'environment.relative_humidity=[\"50 %\"]' "
                                "--set drive.amplitude=1kV");
  EXPECT_EQ(run.status, 1) << run.err;  // no answer under this voltage
  EXPECT_EQ(run.out.find("variation"), std::string::npos) << run.out;
  EXPECT_EQ(run.out.find("range/mean"), std::string::npos) << run.out;
  EXPECT_NE(run.out.find("warning: the dielectric breaks down"), std::string::npos) << run.out;
}

TEST(Evaluate, TheFolderIsTriedFirstAndHoldsThePicturesOfOneRun) {
  const Workplace place;
  place.write("afile", "");
  const Outcome refused = place.run("evaluate " + kSample + kDraft + "--out afile");
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("no such folder can be made"), std::string::npos) << refused.err;
  const auto at = [&](const char* humidity) {
    return place
        .run(fmt::format("evaluate {}{}--out out --set 'environment.relative_humidity=[\"{} %\"]'",
                         kSample, kDraft, humidity))
        .status;
  };
  ASSERT_EQ(at("30"), 0);
  place.write("out/gap_old.png", "");
  EXPECT_TRUE(std::filesystem::exists(place.path() / "out/gap_30.png"));
  ASSERT_EQ(at("50"), 0);
  EXPECT_FALSE(std::filesystem::exists(place.path() / "out/gap_30.png"));
  EXPECT_FALSE(std::filesystem::exists(place.path() / "out/gap_30.npy"));
  EXPECT_TRUE(std::filesystem::exists(place.path() / "out/gap_50.png"));
  EXPECT_TRUE(std::filesystem::exists(place.path() / "out/gap_old.png"));
}

// Files of a design that its run says not to build are written with that warning.
TEST(Export, WarnsOfARunThatKeepsItsLimitsNowhere) {
  const Workplace place;
  place.write("run/best/design.toml", "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n");
  place.write("run/run.json",
              R"({"interrupted": false, "feasible": false, "limits": [{"name": "min_wall", )"
              R"("asked": "at least 9 um", "text": "3 um", "kept": false}]})");
  const std::string warning =
      "run: build none of these: no design of the run keeps every limit; what it shows breaks "
      "min_wall at least 9 um (it has 3 um)";
  for (const char* named : {"run", "run/best", "run/best/"}) {
    const Outcome run =
        place.run(std::string("export ") + named + " --pixels 64 --format npy --out out");
    ASSERT_EQ(run.status, 0) << run.err;
    EXPECT_NE(run.err.find("warning: " + warning), std::string::npos) << run.err;
    EXPECT_NE(file_text(place.path() / "out/export.json").find('"' + warning), std::string::npos);
  }
  const Outcome wafer = place.run("wafer run --no-expected --out wafer");
  ASSERT_EQ(wafer.status, 0) << wafer.err;
  EXPECT_NE(wafer.out.find("warning: " + warning), std::string::npos) << wafer.out;
  EXPECT_NE(place.run("export run --pick knee --out picked").err.find("no front to pick from"),
            std::string::npos);
}

TEST(Wafer, WarnsOfModelsThatTheFingerWasNotFittedWith) {
  const Workplace place;
  place.write("d.toml",
              "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n[model]\nrim_pinning = true\n"
              "[environment]\nrelative_humidity = [\"30 %\"]\n");
  const std::string warning =
      "warning: what is expected is off by tens of percent: model.rim_pinning is true";
  const Outcome run = place.run("wafer d.toml --no-model --out wafer");
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_NE(run.out.find(warning), std::string::npos) << run.out;
  EXPECT_EQ(place.run("wafer d.toml --no-expected --out drawn").out.find(warning),
            std::string::npos);
}

// Only where the run was there is the best design rounded.
TEST(Export, SaysWhetherTheBuildSheetIsOnTheGridOfTheFab) {
  const Workplace place;
  for (const char* name : {"design.toml", "build.toml"})
    place.write(std::string("run/best/") + name,
                "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n");
  const auto said = [&](const std::string& run_json) {
    place.write("run/run.json", run_json);
    return place.run("export run --pixels 64 --format npy --out out").err;
  };
  const std::string grid = "on the grid of the fab as the build sheet has it",
                    interrupted = "the run was interrupted before its best design was rounded",
                    off = "not all on the grid of the fab";
  const std::string whole =
      said(R"({"interrupted": false, "grid": 1e-8, "build": {"on_grid": true}})");
  EXPECT_NE(whole.find(grid), std::string::npos) << whole;
  const std::string cut = said(R"({"interrupted": true})");
  EXPECT_NE(cut.find(interrupted), std::string::npos) << cut;
  EXPECT_EQ(cut.find(grid), std::string::npos) << cut;
  const std::string beside =
      said(R"({"interrupted": false, "grid": 1e-8, "build": {"on_grid": false}})");
  EXPECT_NE(beside.find(off), std::string::npos) << beside;
  EXPECT_EQ(said(R"({"interrupted": false, "grid": 0, "build": {"on_grid": true}})").find(grid),
            std::string::npos);
}

// A millimetre holds more droplets than can be settled, and no file holds one.
TEST(Export, DrawsWhatCannotBeSimulated) {
  const Workplace place;
  const std::string wide =
      "export " + kSample +
      " --set texture.period=1000um --set texture.diameter=900um --set texture.depth=100um"
      " --format gsf --pixels 64 --out out";
  const Outcome drawn = place.run(wide);
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_EQ(place.run("verify out --geometry").status, 0);
  for (const std::string& felt : {wide + " --verify", std::string("verify out")}) {
    const Outcome refused = place.run(felt);
    EXPECT_EQ(refused.status, 2) << felt;
    EXPECT_NE(refused.err.find("finger.water.drops_per_um3"), std::string::npos) << refused.err;
  }
  const Outcome looked =
      place.run("solve haze " + kSample + " --set finger.water.drops_per_um3=100000");
  EXPECT_EQ(looked.status, 0) << looked.err;
}

TEST(Export, WritesTheFilesThatItNames) {
  const Workplace place;
  const Outcome run =
      place.run("export " + kSample + " --pixels 64 --polarity white-deep --out out");
  ASSERT_EQ(run.status, 0) << run.err;
  std::istringstream names(run.out);
  int count = 0;
  for (std::string name; std::getline(names, name); ++count) {
    if (count == 8) {
      EXPECT_EQ(name,
                "size 12 x 12 um, 64 x 64 pixels of 187.5 x 187.5 nm, 2 x 2 periods of 6 x 6 um");
    } else {
      EXPECT_TRUE(std::filesystem::exists(place.path() / name)) << name;
    }
  }
  EXPECT_EQ(count, 9);
  const auto json = nlohmann::json::parse(file_text(place.path() / "out/export.json"));
  EXPECT_EQ(json["min_hole"], 3e-6);
  EXPECT_NEAR(json["lowest"].get<double>(), -600e-9, 1e-15);
  // The same design, the same bytes.
  ASSERT_EQ(place.run("export " + kSample + " --pixels 64 --polarity white-deep --out two").status,
            0);
  for (const char* name : {"heightmap.exr", "heightmap.tif", "mask.tif", "texture.gds"}) {
    EXPECT_EQ(file_text(place.path() / "out" / name), file_text(place.path() / "two" / name))
        << name;
  }
}

TEST(Export, HonoursTheSizeOrSaysWhatItWroteInstead) {
  const Workplace place;
  const auto written = [&](const std::string& arguments, std::string& warning) {
    const Outcome run = place.run("export --format npy --pixels 64 --out out " + arguments);
    EXPECT_EQ(run.status, 0) << run.err;
    warning = run.err;
    return nlohmann::json::parse(file_text(place.path() / "out/export.json"))["size"][0]
        .get<double>();
  };
  std::string warning;
  EXPECT_NEAR(written(kSample + " --size 6um", warning), 6e-6, 1e-12);
  EXPECT_EQ(warning, "");
  EXPECT_NEAR(written(kSample + " --size 16um", warning), 18e-6, 1e-12);
  EXPECT_NE(warning.find("16 um were asked for, 18 um are written"), std::string::npos) << warning;
  EXPECT_NEAR(written(kSample + " --size 1um", warning), 6e-6, 1e-12);
  EXPECT_NE(warning.find("1 um were asked for, 6 um"), std::string::npos) << warning;
  EXPECT_NEAR(
      written(PAPILLA_SOURCE_DIR "/designs/measured_surface/study.toml --size 100um", warning),
      12e-6, 1e-12);
  EXPECT_NE(warning.find("a measured surface is its patch"), std::string::npos) << warning;
}

TEST(Export, ADoseCurveThatEndsAboveTheFloorIsWarnedOf) {
  const Workplace place;
  place.write("dose.csv", "depth_nm,grey\n0,0\n100,255\n");
  const Outcome run =
      place.run("export " + kSample + " --format dose --dose-curve dose.csv --pixels 64 --out out");
  EXPECT_EQ(run.status, 0);
  EXPECT_NE(run.err.find("warning: the dose curve does not reach all depths"), std::string::npos)
      << run.err;
}

TEST(Export, MasksNeedAPolarityAndLayoutsARelief) {
  const Workplace place;
  const Outcome mask = place.run("export " + kSample + " --format mask --out out");
  EXPECT_EQ(mask.status, 2);
  EXPECT_NE(mask.err.find("needs a polarity"), std::string::npos) << mask.err;
  const Outcome gds = place.run("export " PAPILLA_SOURCE_DIR
                                "/designs/m3_samples/flat.toml --format gds --out out");
  EXPECT_EQ(gds.status, 2);
  EXPECT_NE(gds.err.find("the surface is flat"), std::string::npos) << gds.err;
  EXPECT_EQ(place.entries(), 0);
}

TEST(SolveContact, AFlatSurfaceTouchesEverywhereAtTheMeanPressure) {
  const Workplace place;
  const Outcome flat =
      place.run("export " PAPILLA_SOURCE_DIR
                "/designs/m3_samples/flat.toml --pixels 32 --format npy --out flat");
  ASSERT_EQ(flat.status, 0);
  EXPECT_NE(flat.err.find("a flat surface, so every height is 0"), std::string::npos) << flat.err;
  const Outcome run = place.run(
      "solve contact --height flat/heightmap.npy --size '12 um' --pressure '15 kPa' --modulus "
      "'53 MPa' --json --out-pressure p.npy --out-gap g.npy");
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  EXPECT_TRUE(json["converged"].get<bool>());
  EXPECT_EQ(json["area_fraction_raw"], 1);
  EXPECT_NEAR(json["max_pressure"].get<double>(), 15e3, 1e-6);
  EXPECT_EQ(json["mean_gap"], 0);
  EXPECT_EQ(json["method"], "dense");
  EXPECT_TRUE(std::filesystem::exists(place.path() / "p.npy"));
  EXPECT_TRUE(std::filesystem::exists(place.path() / "g.npy"));
  EXPECT_EQ(
      place.run("solve contact --height flat/heightmap.npy --size '12 um' --pressure '15 kPa'")
          .status,
      2);
}

TEST(SolveContact, HelpSaysWordsAndDefaultsOfItsOptions) {
  const Workplace place;
  const std::string help = place.run("solve contact --help").out;
  for (const char* said : {"--method TEXT:{auto,dense,sparse}=auto", "--hardness TEXT=0 Pa",
                           "--jobs,--threads INT:INT in [1 - 1024]=1", "[1 - 1000000]=1000"})
    EXPECT_NE(help.find(said), std::string::npos) << said << "\n" << help;
  EXPECT_EQ(help.find("->"), std::string::npos) << help;
}

TEST(SolveContact, TheApproachOfALoadGivesTheLoad) {
  const Workplace place;
  ASSERT_EQ(place.run("export " + kSample + " --pixels 64 --format npy --out holes").status, 0);
  const std::string solve =
      "solve contact --height holes/heightmap.npy --size '12 um' --layer-modulus '66 MPa' "
      "--layer-thickness '1 um' --bulk-modulus '60 MPa' --tolerance 1e-10 --json ";
  const Outcome loaded = place.run(solve + "--pressure '3 MPa' --method dense");
  ASSERT_EQ(loaded.status, 0) << loaded.err;
  const auto by_load = nlohmann::json::parse(loaded.out);
  for (const char* key : {"fft_pairs", "certificate", "area_fraction", "area_fraction_se",
                          "area_fraction_perimeter", "iterations", "elastic_energy"}) {
    EXPECT_TRUE(by_load[key].is_number()) << key;
  }
  const Outcome moved =
      place.run(solve + fmt::format("--approach '{} nm'", 1e9 * by_load["approach"].get<double>()));
  ASSERT_EQ(moved.status, 0) << moved.err;
  const auto by_approach = nlohmann::json::parse(moved.out);
  EXPECT_NEAR(by_approach["mean_pressure"].get<double>(), 3e6, 1e3);
  EXPECT_EQ(place.run(solve + "--pressure '3 MPa' --approach '3 nm'").status, 2);
  EXPECT_EQ(place.run(solve).status, 2);
  for (const char* method : {"quick", "2", "7"})  // words alone
    EXPECT_EQ(place.run(solve + "--pressure '3 MPa' --method " + method).status, 2) << method;
  // One iteration is not enough: said so, in the answer and in the exit status.
  const Outcome cut = place.run(solve + "--pressure '3 MPa' --method dense --max-iterations 1");
  EXPECT_EQ(cut.status, 1);
  EXPECT_FALSE(nlohmann::json::parse(cut.out)["converged"].get<bool>());
}

TEST(Program, OutputThatCannotBeWrittenIsAFailure) {
  const Workplace place;
  EXPECT_EQ(place.shell("'" PAPILLA_PROGRAM "' describe > /dev/full").status, 1);
}

TEST(Solve, PerssonAndDriveGiveTheDocumentedJson) {
  const Workplace place;
  const std::string physics = PAPILLA_SOURCE_DIR "/designs/physics/";
  const Outcome persson = place.run("solve persson --json " + physics + "wrist_on_glass.toml");
  ASSERT_EQ(persson.status, 0) << persson.err;
  const auto mean_field = nlohmann::json::parse(persson.out);
  EXPECT_EQ(mean_field["schema"], 1);
  EXPECT_GT(mean_field["point"]["area_ratio"].get<double>(), 1);
  EXPECT_EQ(mean_field["over_voltage"].size(), 5u);

  const Outcome drive = place.run("solve drive --json --out d " + physics + "fingertip_drive.toml");
  ASSERT_EQ(drive.status, 0) << drive.err;
  const auto circuit = nlohmann::json::parse(drive.out);
  EXPECT_EQ(circuit["schema"], 1);
  EXPECT_EQ(circuit["checks"].size(), 4u);  // body, source, air, film
  for (const char* file : {"series.csv", "lines.csv", "drive.svg"}) {
    EXPECT_TRUE(std::filesystem::exists(place.path() / "d" / file)) << file;
  }
  EXPECT_EQ(
      place.run("solve drive " + physics + "fingertip_drive.toml --set gap.distanc=1um").status, 2);
}

TEST(Solve, PerssonAndDriveMarkWhatALimitHolds) {
  const Workplace place;
  const std::string cases = PAPILLA_SOURCE_DIR "/designs/physics/";
  const Outcome persson = place.run("solve persson " + cases + "wrist_on_glass.toml");
  EXPECT_EQ(persson.status, 0) << persson.err;
  EXPECT_NE(persson.out.find("  gap held\n"), std::string::npos) << persson.out;
  EXPECT_NE(persson.out.find("limited by the finite body"), std::string::npos) << persson.out;
  EXPECT_EQ(persson.out.find("inf"), std::string::npos) << persson.out;
  const Outcome drive = place.run("solve drive " + cases + "fingertip_drive.toml");
  EXPECT_EQ(drive.status, 0) << drive.err;
  EXPECT_NE(drive.out.find("source voltage beyond 150 V"), std::string::npos) << drive.out;
  EXPECT_NE(drive.out.find("gap voltage beyond 327 V"), std::string::npos) << drive.out;
}

TEST(Describe, ShowsOneKey) {
  const Workplace place;
  const Outcome key = place.run("describe texture.depth");
  EXPECT_EQ(key.status, 0) << key.err;
  EXPECT_NE(key.out.find("texture.depth"), std::string::npos) << key.out;
  EXPECT_EQ(key.out.find("texture.diameter"), std::string::npos) << key.out;
  const Outcome wrong = place.run("describe texture.dept");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("did you mean `texture.depth`?"), std::string::npos) << wrong.err;
}

TEST(Program, MistakesOnTheCommandLineNameThemselves) {
  const Workplace place;
  place.write("dose.csv", "depth_nm,grey\n0,0\n100,255\n");
  place.write("semicolons.csv", "depth_nm;grey\n0;0\n100;255\n");
  const std::string drive = PAPILLA_SOURCE_DIR "/designs/physics/fingertip_drive.toml";
  for (const auto& [arguments, message] : std::vector<std::pair<std::string, std::string>>{
           {"solve foo", "unknown command `solve foo`"},
           {"solve contct", "did you mean `solve contact`?"},
           {"solve droplets", "try: papilla solve droplets --help"},
           {"evaluate " + kSample + " --voltage-for 50%", "0.5 for 50 %, got 50%"},
           {"evaluate " + kSample + " --accuracy 5", "has no unit; write 5%"},
           {"solve drive " + drive + " --swipe dose.csv", "expected \"lateral,normal\" in N"},
           {"solve droplets --design " + kSample + " --skin -4", "--skin"},
           {"solve droplets --design " + kSample + " --seed -1", "--seed"},
           {"solve droplets --design " + kSample + " --hysteresis 5", "--hysteresis"},
           {"solve droplets --design " + kSample + " --placements 2 --spread 0", "--spread"},
           {"evaluate " + kSample + " --set accuracy.grid=7", "at least 16 pixels"},
           {"evaluate " + kSample + " --accuracy ''", "--accuracy"},
           {"solve contact --height " PAPILLA_SOURCE_DIR
            "/designs/measured_surface/scan.gsf --pressure 1e20MPa --modulus 53MPa",
            "times the modulus"},
           {"evaluate " + kSample +
                " --set finger.skin.map=" PAPILLA_TEST_DATA
                "/../../designs/measured_surface/scan.gsf --set model.closure=persson",
            "finger.skin.map"},
           {"evaluate " + kSample + " --sweep drive.amplitude=50..50:3",
            "expected another end than the beginning"},
           {"export " + kSample + " --size '12x0 um'", "expected lengths above 0"},
           {"optimize " PAPILLA_TEST_DATA "/study/tiny.toml --time '-1 min'", "--time"},
           {"optimize " PAPILLA_TEST_DATA "/study/tiny.toml --finish", "add --resume"},
           {"optimize " PAPILLA_TEST_DATA "/study/tiny.toml --set model.rim_pinning=true",
            "fit the finger again, or run with --force"},
           {"rank " + kSample +
                " " PAPILLA_SOURCE_DIR "/designs/m3_samples/flat.toml --set model.rim_pinning=true",
            "fit the finger again, or run with --force"},
           {"optimize " PAPILLA_TEST_DATA "/study/tiny.toml --set objective.risk='mean - -2 std'",
            "seeks risk"},
           {"evaluate " + kSample + " --set texture.type=stack", "at least one part"},
           {"export " + kSample + " --format dose --dose-curve semicolons.csv --out out",
            "the separator is a comma"}}) {
    const Outcome run = place.run(arguments);
    EXPECT_EQ(run.status, 2) << arguments;
    EXPECT_NE(run.err.find(message), std::string::npos) << arguments << "\n" << run.err;
  }
}

// An option that another of a command's works has is not passed over.
TEST(Program, RefusesOptionsThatItWouldNotObey) {
  const Workplace place;
  for (const auto& [arguments, message] : std::vector<std::pair<std::string, std::string>>{
           {"report run --svg f.svg --out r.html", "--svg is the picture of the front alone"},
           {"report run --svg f.svg --pick knee", "--svg is the picture of the front alone"},
           {"bench --prices 5 --json", "--json, --page and --large are of the targets"},
           {"bench --prices 5 --page", "--json, --page and --large are of the targets"},
           {"bench --first 7", "--first is of --prices"},
           {"accuracy " + kSample + " --scenes 20", "--scenes draws scenes of its own"},
           {"accuracy --scenes 20 --set finger.load=1N", "--scenes draws scenes of its own"},
           {"accuracy --scenes 20 --grid 64", "--scenes draws scenes of its own"},
           {"accuracy --tight", "--tight and --first-scene are of --scenes"},
           {"accuracy --render tables --json", "it takes no other option"},
           {"solve droplets --design d.toml --volume 9um3", "--volume is of --gap"},
           {"solve droplets --design d.toml --size 4um", "--size is of --gap"},
           {"solve droplets --design d.toml --theta-skin 70deg", "--theta-skin is of --gap"},
           {"solve droplets --design d.toml --theta-substrate 70deg",
            "--theta-substrate is of --gap"},
           {"solve droplets --design d.toml --surface-tension 60mN/m",
            "--surface-tension is of --gap"},
           {"solve droplets --design d.toml --hysteresis 0.1", "--hysteresis is of --gap"},
           {"solve droplets --design d.toml --drops-per-um3 50", "--drops-per-um3 is of --gap"},
           {"solve droplets --design d.toml --step 100nm", "--step is of --gap"},
           {"solve droplets --gap g.npy --humidity 55%", "--humidity is of --design"},
           {"solve droplets --gap g.npy --skin 0", "--skin is of --design"},
           {"solve droplets --gap g.npy --pin-edges", "--pin-edges is of --design"},
           {"solve droplets --gap g.npy --wick-corners", "--wick-corners is of --design"},
           {"solve droplets --gap g.npy --placements 4 --out drops.png",
            "--out draws one placement"},
           {"solve droplets --gap g.npy --spread 0.2", "--spread is of --placements"},
           {"solve contact --height g.npy --threads 2", "--jobs is of a case of statistics"},
           {"solve contact --height g.npy --out d", "--out is of a case of statistics"},
           {"solve contact --height g.npy --set a=1", "--set is of a case of statistics"},
           {"solve contact --height g.npy --modulus 1MPa --bulk-modulus 1MPa",
            "--bulk-modulus is of --layer-modulus"},
           {"solve contact --height g.npy --modulus 1MPa --layer-poisson 0.4",
            "--layer-poisson is of --layer-modulus"},
           {"solve contact --height g.npy --modulus 1MPa --counter-poisson 0.4",
            "--counter-poisson is of --counter-modulus"},
           {"solve contact c.toml --pressure 1kPa", "--pressure is of --height"},
           {"solve contact c.toml --modulus 1MPa", "--modulus is of --height"},
           {"solve contact c.toml --out-gap g.npy", "--out-gap is of --height"},
           {"solve contact c.toml --size 4um", "--size is of --height"},
           {"solve haze d.toml --size 4um", "--size is of --height"},
           {"solve haze d.toml --level", "--level is of --height"},
           {"solve haze d.toml --index nan", "--index: expected a number, got nan"},
           {"solve contact --bulk-poisson nan", "--bulk-poisson: expected a number, got nan"},
           {"solve haze --height g.npy --set a=1", "--set is of a design FILE"},
           {"solve field --gap g.npy --voltage 1V --process planar", "--process is of --texture"},
           {"solve field --gap g.npy --voltage 1V --edge-radius 5nm",
            "--edge-radius is of --texture"},
           {"solve field --gap g.npy --voltage 1V --texture t.npy --step-coverage 0.5",
            "--step-coverage is of --process directional"},
           {"surface g.npy --as-is --level", "give one of them"},
           {"export " + kSample + " --format npy --repeat 3", "--repeat is of exr"},
           {"export " + kSample + " --format npy,exr --facet-error 2nm",
            "--facet-error is of gds, oasis, and no such file is written"},
           {"export " + kSample + " --format gds --levels 3",
            "--levels: the layout of holes, pillars and grooves has one layer; leave it out"},
           {"export " + kSample + " --format gds --polarity white-deep",
            "--polarity is of tiff, mask, and no such file is written"},
           {"export " + kSample + " --format npy --tolerance '2 %'",
            "--tolerance is of --verify: add that, or leave --tolerance out"},
           {"export " + kSample + " --format gds --edge-rounding 20nm",
            "--edge-rounding is of exr, tiff"},
           {"export " + kRough + " --levels 3",  // whose layout is on request
            "--levels is of gds, oasis, and no such file is written: name one in --format"},
           {"export " + kRough + " --format gds --levels 3 --facet-error 5nm",
            "--facet-error: the layout of this texture has no circles"},
           {"rank a.toml b.toml --base c.toml", "--base is for scans"},
           {"rank a.toml b.toml --parameters --no-parameters", "give one of them"},
           {"next lab --show --count 4", "--count is of a plan, and --show makes none"},
           {"next lab --show --day 1", "--day is of a plan, and --show makes none"},
           {"next lab --time '0 min'", "--time: \"0 min\": expected more than 0 min"},
           {"next lab --time='-5 min'", "--time: \"-5 min\": expected more than 0 min"}}) {
    const Outcome run = place.run(arguments);
    EXPECT_EQ(run.status, 2) << arguments;
    EXPECT_EQ(run.out, "") << arguments;
    EXPECT_NE(run.err.find(message), std::string::npos) << arguments << "\n" << run.err;
  }
  EXPECT_EQ(place.entries(), 0);
}

// Options that may be named several times take one value each time.
TEST(Program, OptionsLeaveTheArgumentsBehindTheirValues) {
  const Workplace place;
  EXPECT_EQ(place.run("export --format npy,gsf " + kSample + " --pixels 64 --out out").status, 0);
  EXPECT_TRUE(std::filesystem::exists(place.path() / "out/heightmap.gsf"));
  EXPECT_EQ(place.run("solve haze --angle '10 deg' " + kSample + " --json").status, 0);
  EXPECT_EQ(
      place.run("solve haze --set surface.refractive_index=1.5 " + kSample + " --json").status, 0);
  for (const std::string arguments : {"evaluate --voltage-for 0.5 nowhere.toml --no-model",
                                      "verify --receipt r01 nowhere.toml --geometry"}) {
    const Outcome run = place.run(arguments);
    EXPECT_EQ(run.status, 2) << arguments;
    EXPECT_EQ(run.err.find("is required"), std::string::npos) << run.err;
  }
}

TEST(Reproduce, GivesTheDocumentedJsonAndTables) {
  const Workplace place;
  const Outcome run = place.run("reproduce --json --claim P1 --claim J2 --out claims");
  ASSERT_EQ(run.status, 0) << run.err;
  const auto json = nlohmann::json::parse(run.out);
  ASSERT_EQ(json["claims"].size(), 2u);
  EXPECT_EQ(json["claims"][1]["verdict"], "paper inconsistent");
  EXPECT_TRUE(std::filesystem::exists(place.path() / "claims/claims.csv"));
  EXPECT_TRUE(std::filesystem::exists(place.path() / "claims/claims.md"));
  const Outcome wrong = place.run("reproduce --claim M133");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("did you mean `M13`"), std::string::npos) << wrong.err;
}

}  // namespace
}  // namespace papilla::tests::commands_test
