#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "base/error.h"
#include "base/files.h"
#include "config/describe.h"
#include "config/writer.h"
#include "design/study.h"
#include "report/reference.h"
#include "tests/temporary.h"

namespace papilla::tests::design_test {
namespace {

namespace fs = std::filesystem;

const std::string kDesigns = PAPILLA_SOURCE_DIR "/designs/";
const std::string kStudy = kDesigns + "electroadhesive_glass/study.toml";

std::string written(const std::string& name, const std::string& text) {
  const fs::path folder = temporary("design_test");
  fs::create_directories(folder);
  const std::string path = (folder / name).string();
  std::ofstream(path) << text;
  return path;
}

std::string problems_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const std::string path = written("study.toml", text);
  try {
    read_study(path, overrides);
  } catch (const InputError& error) {
    std::string out = error.what();
    for (std::size_t at; (at = out.find(path)) != std::string::npos;) out.erase(at, path.size());
    return out;
  }
  return "";
}

TEST(Design, TheReferenceFingerFileIsTheDefaultFinger) {
  Finger reference = read_finger(kDesigns + "fingers/reference.toml");
  EXPECT_FALSE(reference.uncertainty.empty());
  EXPECT_TRUE(reference.belief.ends_with("fingers/belief.toml")) << reference.belief;
  reference.uncertainty.clear();  // known of the file's fit alone
  reference.belief.clear();       // and so is what is not known
  EXPECT_EQ(reference, Finger{});
}

TEST(Design, TheRelativesDifferInOneThing) {
  Finger expected = read_finger(kDesigns + "fingers/reference.toml");
  expected.name = "smooth";
  expected.skin.rms = 104e-9;
  EXPECT_EQ(read_finger(kDesigns + "fingers/smooth.toml"), expected);
  EXPECT_EQ(read_finger(kDesigns + "fingers/rough.toml").skin.rms, 414e-9);
  EXPECT_EQ(read_finger(kDesigns + "fingers/moist.toml").water.volume[3], 14.2e-18);
}

TEST(Design, ATextureStaysInsideThePlanarFilmThatCarriesIt) {
  const std::string text =
      "schema_version = 1\nbase = \"" + kDesigns + "m3_samples/a3h600.toml\"\n";
  const std::string told = problems_of(text, {"surface.process=planar"});
  EXPECT_NE(told.find("surface.dielectric.0.thickness: 500 nm: the texture is cut 600 nm deep"),
            std::string::npos)
      << told;
  EXPECT_EQ(problems_of(text, {"surface.process=planar", "surface.dielectric.0.thickness=700 nm"}),
            "");
  const std::string order =
      problems_of(text + "[[surface.dielectric]]\nprocess = \"conformal\"\n" +
                  "[[surface.dielectric]]\nthickness = \"900 nm\"\nprocess = \"planar\"\n");
  EXPECT_NE(order.find("surface.dielectric.0.process: a layer that follows the texture cannot lie"),
            std::string::npos)
      << order;
}

TEST(Design, ThePublishedSamplesHaveTheirDimensions) {
  for (const auto& [name, diameter, depth] :
       {std::tuple("a3h350", 3e-6, 350e-9), std::tuple("a3h600", 3e-6, 600e-9),
        std::tuple("a3h900", 3e-6, 900e-9), std::tuple("a4h350", 4e-6, 350e-9),
        std::tuple("a4h600", 4e-6, 600e-9)}) {
    Design design = read_design(kDesigns + "m3_samples/" + name + ".toml");
    EXPECT_EQ(get_number(design, "texture.diameter"), diameter);
    EXPECT_EQ(get_number(design, "texture.depth"), depth);
    EXPECT_EQ(get_number(design, "texture.period"), 6e-6);
    EXPECT_EQ(design.drive.amplitude, 200);
    EXPECT_NEAR(design.drive.v_rms(), 141.4, 0.1);
    design.finger.uncertainty.clear();
    design.finger.belief.clear();
    EXPECT_EQ(design.finger, Finger{});
  }
}

// Every text of a result is UTF-8, also where it names the folder that the program stands in.
TEST(Study, OfAFolderThatIsNoUtf8IsCalledByWhatCanBeShown) {
  const std::filesystem::path folder = temporary("r\xe9s");
  std::filesystem::create_directory(folder);
  const std::string file = (folder / "design.toml").string();
  write_bytes(file, "schema_version = 1\n");
  EXPECT_EQ(read_study(file).name, "r\\xe9s");
}

TEST(Study, TheMainStudyHasItsSpaceWishesLimitsAndFingers) {
  const Study study = read_study(kStudy);
  EXPECT_EQ(study.name, "electroadhesive_glass");
  ASSERT_EQ(study.variables.size(), 7u);
  EXPECT_EQ(study.design.surface.process, FilmProcess::Planar);
  EXPECT_EQ(study.variables[0].path, "texture.type");
  EXPECT_EQ(study.variables[0].choices.size(), 5u);
  EXPECT_EQ(study.variables[1].path, "texture.period");
  EXPECT_EQ(study.variables[1].low, 2e-6);
  EXPECT_EQ(study.variables[3].path, "texture.depth");
  EXPECT_EQ(study.variables[3].low, 0);
  EXPECT_EQ(study.variables[3].high, 1e-6);
  EXPECT_EQ(study.variables[4].path, "texture.wall_angle");
  EXPECT_EQ(study.variables[5].path, "surface.dielectric.0.thickness");
  EXPECT_EQ(study.variables[6].high, 80 * 3.14159265358979323846 / 180);
  EXPECT_EQ(study.objective.maximise, std::vector{parse_metric("mean(modulation)")});
  EXPECT_EQ(study.objective.minimise, std::vector{parse_metric("variation(modulation)")});
  ASSERT_EQ(study.constraints.size(), 4u);
  EXPECT_EQ(study.constraints[1], (read_constraint("min_wall", 0.4e-6)));
  EXPECT_EQ(study.constraints[2], (read_constraint("aspect_ratio", 1.0)));
  ASSERT_EQ(study.population.size(), 4u);
  EXPECT_EQ(study.population[1].name, "smooth");
  EXPECT_EQ(study.search.seed, 1);
}

TEST(Study, TheHoleArrayOfBeforeHasItsSpace) {
  const Study study = read_study(kDesigns + "m3_glass/study.toml");
  EXPECT_EQ(study.name, "m3_glass");
  ASSERT_EQ(study.variables.size(), 5u);
  EXPECT_EQ(study.design.surface.process, FilmProcess::Planar);
  EXPECT_EQ(study.variables[0].path, "surface.dielectric.0.thickness");
  EXPECT_EQ(study.variables[3].path, "texture.depth");
}

TEST(Study, ScenariosSetNumbersOfTheDesign) {
  const Study study = read_study(kDesigns + "hydrophobic_glass/study.toml");
  ASSERT_EQ(study.scenarios.size(), 2u);
  EXPECT_TRUE(study.scenarios[0].set.empty());
  const Design worn = with_settings(study.design, study.scenarios[1].set);
  EXPECT_NEAR(worn.surface.contact_angle, 1.3962634, 1e-7);
  EXPECT_EQ(study.variables.size(), 4u);
}

TEST(Study, TheResolvedFileReadsBackToTheSameStudy) {
  // Of slopes.toml choices stand between ranges: the order of the variables is part of a search.
  for (const char* name : {"electroadhesive_glass/study", "electroadhesive_glass/slopes",
                           "m3_glass/study", "hydrophobic_glass/study"}) {
    const Study study = read_study(kDesigns + name + ".toml", {"texture.depth=123.456789 nm"});
    const Study again = read_study(written("resolved.toml", resolved_toml(study)));
    EXPECT_EQ(again.design, study.design);
    EXPECT_EQ(again.variables, study.variables);
    EXPECT_EQ(again.objective, study.objective);
    EXPECT_EQ(again.constraints, study.constraints);
    EXPECT_EQ(again.population, study.population);
    EXPECT_EQ(again.scenarios, study.scenarios);
    EXPECT_EQ(again.search, study.search);
  }
}

// The population's own state and load are not those that the design has by default.
TEST(Study, AResolvedFileSetsNothingThatNobodySet) {
  const Study study =
      read_study(written("unsaid.toml",
                         "schema_version = 1\n[texture]\ntype = \"flat\"\n[population]\nfingers = "
                         "[\"fingers/natural.toml\"]\n[design_space]\n\"surface.contact_angle\" = "
                         "[\"30 deg\", \"80 deg\"]\n[objective]\nmaximise = "
                         "\"mean(modulation)\"\n"),
                 {"search.seed=7"});
  ASSERT_EQ(study.population.at(0).state, FingerState::Natural);
  ASSERT_EQ(study.design.finger.state, FingerState::Clean);
  const std::string resolved = resolved_toml(study);
  EXPECT_NE(resolved.find("seed = 7  # --set search.seed=7"), std::string::npos);
  const Study again = read_study(written("resolved.toml", resolved));
  EXPECT_EQ(again.population, study.population);
  EXPECT_EQ(again.search, study.search);
  for (const char* said : {"texture.type", "search.seed"})
    EXPECT_EQ(again.origins.count(said), 1u) << said;
  for (const char* unsaid :
       {"finger.state", "finger.load", "surface.refractive_index", "accuracy.level"})
    EXPECT_EQ(again.origins.count(unsaid), 0u) << unsaid;
  // A line that is changed is set.
  std::string changed = resolved;
  const std::size_t at = changed.find("refractive_index = 1.46");
  ASSERT_NE(at, std::string::npos);
  changed.replace(at, changed.find('\n', at) - at, "refractive_index = 1.5");
  EXPECT_EQ(read_study(written("resolved.toml", changed)).origins.count("surface.refractive_index"),
            1u);
}

TEST(Design, AWrittenDesignReadsBackToTheSameDesign) {
  Design design = read_design(kStudy);
  set_number(design, "texture.depth", 1e-6 / 7);
  const std::string path = written("design.toml", "");
  write_design(path, design);
  EXPECT_EQ(read_design(path), design);
}

TEST(Design, ModelOptionsStartFromWhatTheFingerWasFittedWith) {
  const std::string head =
      "schema_version = 1\n[finger.calibrated_for]\nair_limit = \"emission\"\n";
  EXPECT_EQ(read_design(written("a.toml", head)).model.air_limit, AirLimit::Emission);
  EXPECT_EQ(
      read_design(written("b.toml", head + "[model]\nair_limit = \"none\"\n")).model.air_limit,
      AirLimit::None);
}

TEST(Design, AKindFromTheCommandLineReplacesTheKeysOfTheOtherKind) {
  const Design flat = read_design(kStudy, {"texture.type=flat", "design_space={}"});
  EXPECT_EQ(flat.texture, Texture{});
}

// However the file and the override spell the path.
TEST(Study, AnOverrideReplacesTheRangeOfTheFile) {
  const std::string head =
      "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n[objective]\nmaximise = "
      "\"mean(modulation)\"\n";
  for (const std::string space : {"[design_space]\n\"texture.period\" = [\"4 um\", \"12 um\"]\n",
                                  "[design_space.texture]\nperiod = [\"4 um\", \"12 um\"]\n"}) {
    const std::string file =
        written("space.toml", head + space + "[scatter]\n\"texture.depth\" = \"20 nm\"\n");
    const Study study = read_study(
        file, {"design_space.texture.period=[\"5 um\", \"8 um\"]", "scatter.texture.depth=30 nm"});
    ASSERT_EQ(study.variables.size(), 1u);
    EXPECT_DOUBLE_EQ(study.variables[0].low, 5e-6);
    EXPECT_DOUBLE_EQ(study.variables[0].high, 8e-6);
    ASSERT_EQ(study.scatter.size(), 1u);
    EXPECT_DOUBLE_EQ(study.scatter[0].tolerance, 30e-9);
    const Study again = parse_study(resolved_toml(study), "resolved.toml");
    EXPECT_EQ(again.variables, study.variables);
  }
}

TEST(Study, APathStandsOnceInASection) {
  const std::string head =
      "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n[objective]\nmaximise = "
      "\"mean(modulation)\"\n[design_space]\n\"texture.period\" = [\"4 um\", \"12 um\"]\n";
  EXPECT_EQ(problems_of(head + "[design_space.texture]\nperiod = [\"5 um\", \"8 um\"]\n"),
            ":8:1: design_space.texture.period: stands twice, as \"texture.period\" and as "
            "texture.period: keep one of them");
  EXPECT_EQ(problems_of(head + "[scatter]\n\"texture.depth\" = \"20 nm\"\n[scatter.texture]\n"
                               "depth = \"30 nm\"\n"),
            ":10:1: scatter.texture.depth: stands twice, as \"texture.depth\" and as "
            "texture.depth: keep one of them");
}

// The metric's own = and dot are no part of the setting's.
TEST(Study, AnOverrideLimitsAMetricWithArguments) {
  const Study study =
      read_study(kStudy, {"constraints.worst(voltage_for(modulation = 0.5))=150 V"});
  const auto limit =
      std::find_if(study.constraints.begin(), study.constraints.end(), [](const Constraint& c) {
        return limit_name(c.on).find("voltage_for") != std::string::npos;
      });
  ASSERT_NE(limit, study.constraints.end());
  EXPECT_DOUBLE_EQ(limit->limit, 150);
}

TEST(Study, ProblemsAcrossFieldsAreLocated) {
  const std::string head = "schema_version = 1\n";
  EXPECT_EQ(problems_of("title = \"x\"\n"),
            ":1:1: missing `schema_version` (version of the file format), a whole number");
  EXPECT_EQ(problems_of(head + "[environment]\nrelative_humidity = [\"35 %\", \"15 %\"]\n"),
            ":3:21: environment.relative_humidity: expected rising values");
  EXPECT_EQ(problems_of(head + "[environment]\nweights = [1, 2]\n"),
            ":3:11: environment.weights: expected 4 weights, one per humidity, got 2");
  EXPECT_EQ(problems_of(head + "[finger]\nload = \"0 N\"\n"),
            ":3:8: finger.load: expected a force above 0 N");
  EXPECT_EQ(problems_of(head + "[drive]\ncontrol = \"current\"\namplitude = \"200 V\"\n"),
            ":4:13: drive.amplitude: a voltage, beside control = \"current\": set it to 0 V, give "
            "drive.current, and the largest voltage of the source as drive.source_compliance");
  EXPECT_EQ(problems_of(head + "[drive]\ncurrent = \"1 mA\"\n"),
            ":3:11: drive.current: a current, beside control = \"voltage\": say control = "
            "\"current\", or set it to 0 mA and give drive.amplitude");
  EXPECT_EQ(problems_of(head + "[drive]\ncontrol = \"current\"\ncurrent = \"6 mA\"\n"),
            ":4:11: drive.current: 6 mA is above drive.current_limit, 5 mA");
  EXPECT_EQ(
      problems_of(head + "[drive]\ncontrol = \"current\"\nwaveform = \"dc\"\ncurrent = \"1 mA\"\n"),
      ":4:12: drive.waveform: a constant current through a film that insulates has no end: give "
      "an alternating one");
  EXPECT_EQ(problems_of(head + "[drive]\ncontrol = \"current\"\nwaveform = \"dc\"\n"), "");
  EXPECT_EQ(
      problems_of(head + "[design_space]\n\"surface.contact_agle\" = [\"1 deg\", \"2 deg\"]\n"),
      ":3:1: design_space: `surface.contact_agle` is no number of this design, did you mean "
      "`surface.contact_angle`?");
  EXPECT_EQ(problems_of(head + "[objective]\nmaximise = \"mean(modulation)\"\n[design_space]\n"
                               "\"surface.contact_angle\" = [\"2 deg\", \"1 deg\"]\n"),
            ":5:27: design_space.surface.contact_angle: expected low < high");
  EXPECT_EQ(problems_of(head + "[objective]\nmaximise = \"mean(modulation)\"\n"
                               "risk = [\"mean\", \"worst\"]\n"),
            ":4:8: objective.risk: expected one text, got 2");
  EXPECT_EQ(problems_of(head + "[objective]\nmaximise = \"mean(modulation)\"\n"
                               "risk = [\"worst\"]\n"),
            "");
  EXPECT_EQ(problems_of(head + "[constraints]\nmin_hole = \"1 V\"\n"),
            ":3:12: constraints.min_hole: expected a length, got \"1 V\"");
  EXPECT_EQ(problems_of(head + "[constraints]\nmin_whole = \"1 um\"\n"),
            ":3:1: constraints: unknown key `min_whole`, did you mean `min_hole`?");
  EXPECT_EQ(problems_of(head + "[constraints]\nmax_contact_angle = \"90 deg\"\n"),
            ":3:1: constraints: `max_contact_angle`: the search changes a dimension between its "
            "ends alone; say them in [design_space]: \"surface.contact_angle\" = [low, high]");
  // What is refused, and what is computed, is no key that is known.
  const std::string listed = problems_of(
      head +
      "[constraints]\nmax_contact_angle = \"90 deg\"\n\"mean(modulation)\" = 0.1\nxyz = 1\n");
  EXPECT_NE(listed.find("unknown key `xyz`; known here: "), std::string::npos) << listed;
  EXPECT_EQ(listed.find(", max_contact_angle"), std::string::npos) << listed;
  EXPECT_EQ(listed.find(", mean(modulation)"), std::string::npos) << listed;
  EXPECT_EQ(problems_of(head + "[serach]\nseed = 1\n"),
            ":2:2: unknown key `serach`, did you mean `search`?");
  EXPECT_EQ(problems_of(head + "[population]\nfingers = [\"none.toml\"]\n"),
            ":3:12: population.fingers: no file \"none.toml\" beside this file or in the designs "
            "folder");
  const std::string range = head +
                            "[objective]\nmaximise = \"mean(modulation)\"\n[design_space]\n" +
                            "\"drive.amplitude\" = { range = [\"1 V\", \"2 V\"], exclude = ";
  EXPECT_EQ(
      problems_of(range + "[[\"1.5 V\", \"3 V\"]] }\n"),
      ":5:58: design_space.drive.amplitude.exclude: expected low < from < to < high; where nothing "
      "is left at an end, narrow `range` instead");
  EXPECT_EQ(problems_of(range + "[\"1.5 V\"] }\n"),
            ":5:58: design_space.drive.amplitude.exclude: expected [from, to], got \"1.5 V\"");
}

TEST(Study, AnAmplitudeAboveItsSourceIsSaidOfAVoltageAlone) {
  const std::string head = "schema_version = 1\n[drive]\n";
  const std::string volts = "amplitude = \"200 V\"\nsource_compliance = ";
  EXPECT_EQ(problems_of(head + volts + "\"150 V\"\n"),
            ":3:13: drive.amplitude: 200 V is above source_compliance, 150 V");
  EXPECT_EQ(problems_of(head + volts + "\"200 V\"\n"), "");
  EXPECT_EQ(problems_of(head + volts + "\"0 V\"\n"), "");  // not given
  EXPECT_EQ(problems_of(head + "control = \"current\"\n" + volts + "\"150 V\"\n"),
            ":4:13: drive.amplitude: a voltage, beside control = \"current\": set it to 0 V, give "
            "drive.current, and the largest voltage of the source as drive.source_compliance");
}

TEST(Study, ScenariosHaveNamesWeightsAndSettings) {
  const std::string head = "schema_version = 1\n";
  const auto read = [&](const std::string& items) {
    return parse_study(head + "scenarios = [" + items + "]\n", "s.toml").scenarios;
  };
  const std::vector<Scenario> both = read(
      "{ name = \"new\" }, { name = \"worn\", weight = 0.25, set = { "
      "\"surface.contact_angle\" = \"90 deg\" } }");
  ASSERT_EQ(both.size(), 2u);
  EXPECT_EQ(both[0], (Scenario{"new", 1, {}}));
  EXPECT_EQ(both[1].name, "worn");
  EXPECT_EQ(both[1].weight, 0.25);
  ASSERT_EQ(both[1].set.size(), 1u);
  EXPECT_EQ(both[1].set[0].path, "surface.contact_angle");
  EXPECT_DOUBLE_EQ(both[1].set[0].value, 0.5 * 3.14159265358979323846);
  EXPECT_EQ(read("{ name = \"never\", weight = 0 }").at(0).weight, 0);
  const auto wrong = [&](const std::string& value) {
    return problems_of(head + "scenarios = " + value + "\n");
  };
  EXPECT_EQ(wrong("[{ name = \"a\", weight = -1 }]"),
            ":2:37: scenarios.0.weight: -1 is outside 0 to 1000000");
  EXPECT_EQ(wrong("[{ name = \"a\", weight = 1000001 }]"),
            ":2:37: scenarios.0.weight: 1000001 is outside 0 to 1000000");
  EXPECT_EQ(wrong("3"), ":2:13: scenarios: expected a list of sections [[scenarios]], got 3");
  EXPECT_EQ(wrong("[{ name = \"a\" }, 3]"),
            ":2:30: scenarios.1: expected a section { ... }, got 3");
  EXPECT_EQ(wrong("[{ weight = 1 }]"), ":2:14: scenarios.0: missing `name` (a text)");
  EXPECT_EQ(wrong("[{ name = 3 }]"), ":2:23: scenarios.0: missing `name` (a text)");
  EXPECT_EQ(wrong("[{ name = \"a\", wieght = 1 }]"),
            ":2:28: scenarios.0: unknown key `wieght`, did you mean `weight`?");
  EXPECT_EQ(wrong("[{ name = \"a\", set = 3 }]"),
            ":2:34: scenarios.0.set: expected a section, e.g. { \"surface.contact_angle\" = \"80 "
            "deg\" }");
  const std::string twice = wrong(
      "[{ name = \"a\", set = { surface = { contact_angle = \"80 deg\" }, "
      "\"surface.contact_angle\" = \"70 deg\" } }]");
  EXPECT_TRUE(
      twice.ends_with(": scenarios.0.set.surface.contact_angle: stands twice, as "
                      "\"surface.contact_angle\" and as surface.contact_angle: keep one "
                      "of them"))
      << twice;
}

// What another kind of texture has is left out; of anything else there is a mistake.
TEST(Settings, ChangeTheNumbersThatADesignHas) {
  Design design;
  design.texture = Texture{HoleArray{}};
  const Design out = with_settings(
      design,
      {{"texture.depth", 2e-7}, {"texture.rms", 1e-8}, {"surface.dielectric.0.thickness", 3e-7}});
  EXPECT_EQ(get_number(out, "texture.depth"), 2e-7);
  EXPECT_EQ(out.surface.dielectric.at(0).thickness, 3e-7);
  EXPECT_EQ(get_number(out, "texture.diameter"), get_number(design, "texture.diameter"));
  EXPECT_THROW(with_settings(design, {{"surface.thickness", 1e-7}}), InputError);
}

// Overlapping ones become one, whose end is the farther.
TEST(Study, ExcludedRangesWithinOthersAreOne) {
  const Study study = parse_study(
      "schema_version = 1\n[objective]\nmaximise = \"mean(modulation)\"\n[design_space]\n"
      "\"drive.amplitude\" = { range = [\"1 V\", \"9 V\"], exclude = [[\"2 V\", \"6 V\"], [\"3 "
      "V\", "
      "\"4 V\"], [\"6 V\", \"7 V\"], [\"7.5 V\", \"8 V\"]] }\n"
      "\"surface.contact_angle\" = { choice = [\"60 deg\", \"30 deg\", \"90 deg\"] }\n",
      "s.toml");
  ASSERT_EQ(study.variables.size(), 2u);
  const Variable& amplitude = study.variables[0];
  ASSERT_EQ(amplitude.excluded.size(), 2u);
  EXPECT_EQ(amplitude.excluded[0].from, 2);
  EXPECT_EQ(amplitude.excluded[0].to, 7);
  EXPECT_EQ(amplitude.excluded[1].from, 7.5);
  EXPECT_EQ(amplitude.excluded[1].to, 8);
  EXPECT_EQ(std::tuple(amplitude.low, amplitude.high, amplitude.unit), std::tuple(1.0, 9.0, "V"));
  const Variable& angle = study.variables[1];
  ASSERT_EQ(angle.choices.size(), 3u);
  const double degree = 3.14159265358979323846 / 180;
  EXPECT_DOUBLE_EQ(angle.choices[0], 60 * degree);
  EXPECT_DOUBLE_EQ(angle.low, 30 * degree);
  EXPECT_DOUBLE_EQ(angle.high, 90 * degree);
}

TEST(Study, ScatterIsALengthAboveNothing) {
  const std::string head = "schema_version = 1\n[scatter]\n\"surface.dielectric.0.thickness\" = ";
  const std::vector<Scatter> scatter = parse_study(head + "\"25 nm\"\n", "s.toml").scatter;
  ASSERT_EQ(scatter.size(), 1u);
  EXPECT_EQ(scatter[0].path, "surface.dielectric.0.thickness");
  EXPECT_DOUBLE_EQ(scatter[0].tolerance, 25e-9);
  const std::string where = ":3:36: scatter.surface.dielectric.0.thickness: ";
  EXPECT_EQ(problems_of(head + "\"0 nm\"\n"), where + "expected a tolerance above 0");
  EXPECT_EQ(problems_of(head + "\"-1 nm\"\n"), where + "-1 nm is outside 0 to 1e9 nm");
}

// A metric is limited on its bad side: what is wished high from below, and what should vary little
// from above.
TEST(Study, LimitsAndWishesAreReadWithTheirSides) {
  const Study study = parse_study(
      "schema_version = 1\n[objective]\nmaximise = \"mean(modulation)\"\n"
      "minimise = [\"variation(modulation)\", \"mean(friction)\"]\nrisk = \"worst\"\n"
      "target = { modulation = 0.8 }\n[constraints]\nmin_wall = \"0.4 um\"\naspect_ratio = 1.5\n"
      "\"worst(modulation)\" = 0.2\n\"variation(modulation)\" = 0.3\n",
      "s.toml");
  EXPECT_EQ(study.objective,
            (Objective{{parse_metric("mean(modulation)")},
                       {parse_metric("variation(modulation)"), parse_metric("mean(friction)")},
                       {{kModulation, 0.8}},
                       "worst"}));
  EXPECT_EQ(study.constraints,
            (std::vector<Constraint>{read_constraint("min_wall", 0.4e-6),
                                     read_constraint("aspect_ratio", 1.5),
                                     read_constraint("worst(modulation)", 0.2),
                                     read_constraint("variation(modulation)", 0.3)}));
}

TEST(Study, APopulationTouchesAsTheStudySays) {
  const std::string fingers = "[population]\nfingers = [\"fingers/smooth.toml\"]\n";
  const Finger own = read_finger(kDesigns + "fingers/smooth.toml");
  ASSERT_NE(own.load, 2);
  ASSERT_NE(own.state, FingerState::Natural);
  const auto read = [&](const std::string& head) {
    return parse_study("schema_version = 1\n" + head + fingers, "s.toml").population.at(0);
  };
  EXPECT_EQ(read(""), own);
  Finger expected = own;
  expected.load = 2;
  EXPECT_EQ(read("[finger]\nload = \"2 N\"\n"), expected);
  expected = own;
  expected.state = FingerState::Natural;
  EXPECT_EQ(read("[finger]\nstate = \"natural\"\n"), expected);
}

// What the file of the study's finger says is that finger's: natural.toml keeps its state beside a
// study on reference.toml, and a resolved file says which of its own values hold for all.
TEST(Study, APopulationKeepsWhatTheStudysOwnFingerIsBasedOn) {
  const std::string head =
      "schema_version = 1\n[texture]\ntype = \"flat\"\n[finger]\nbase = "
      "\"fingers/reference.toml\"\nload = \"0.3 N\"\nskin.rms = \"200 nm\"\n[population]\nfingers "
      "= "
      "[\"fingers/clean.toml\", \"fingers/natural.toml\"]\n[design_space]\n"
      "\"surface.contact_angle\" = [\"30 deg\", \"80 deg\"]\n[objective]\nminimise = "
      "\"mean(friction)\"\n";
  const Study study = read_study(written("based.toml", head));
  EXPECT_EQ(study.population.at(0).state, FingerState::Clean);
  EXPECT_EQ(study.population.at(1).state, FingerState::Natural);
  for (const Finger& f : study.population) EXPECT_EQ(f.load, 0.3) << f.name;
  EXPECT_FALSE(study.population[1].belief.empty());
  ASSERT_EQ(study.unheard, std::vector<std::string>{"finger.skin.rms"});
  EXPECT_NE(unused_of(study).at(0).find("finger.skin.rms: a search does not use"),
            std::string::npos);
  const Study again = read_study(written("resolved.toml", resolved_toml(study)));
  EXPECT_EQ(again.population, study.population);
  EXPECT_TRUE(again.unheard.empty());
  // A key of the command line is the study's own.
  const Study without =
      read_study(written("based.toml", head), {"finger.belief=", "finger.touch_time=3 s"});
  for (const Finger& f : without.population) {
    EXPECT_EQ(f.belief, "") << f.name;
    EXPECT_EQ(f.touch_time, 3) << f.name;
  }
  const std::string listed = head.substr(0, head.find("[design_space]")) + "shared = [\"skin\"]\n";
  EXPECT_NE(problems_of(listed).find("population.shared: expected one of load, state, touch_time, "
                                     "belief, got \"skin\""),
            std::string::npos)
      << problems_of(listed);
}

// By its file, or by its folder where the file has the name that all have.
TEST(Study, IsNamedByItsFileOrItsFolder) {
  const auto name = [](const std::string& file) {
    return parse_study("schema_version = 1\n", file).name;
  };
  EXPECT_EQ(name("glass/fine.toml"), "fine");
  for (const char* file : {"glass/study.toml", "glass/resolved.toml", "glass/design.toml"})
    EXPECT_EQ(name(file), "glass") << file;
}

TEST(Study, ExcludesValuesOfAVariable) {
  const std::string file = temporary("excluding.toml");
  write_bytes(file,
              "schema_version = 1\nbase = \"m3_samples/a3h600.toml\"\n[design_space]\n"
              "\"texture.depth\" = { range = [\"100 nm\", \"900 nm\"], exclude = "
              "[[\"600 nm\", \"700 nm\"], [\"300 nm\", \"400 nm\"], [\"350 nm\", \"450 nm\"]] }\n"
              "[objective]\nmaximise = \"mean(modulation)\"\n");
  const Study study = read_study(file);
  ASSERT_EQ(study.variables.size(), 1u);
  const Variable& depth = study.variables.front();
  ASSERT_EQ(depth.excluded.size(), 2u);  // in order, merged
  EXPECT_DOUBLE_EQ(depth.low, 100e-9);
  EXPECT_DOUBLE_EQ(depth.excluded[0].from, 300e-9);
  EXPECT_DOUBLE_EQ(depth.excluded[0].to, 450e-9);
  EXPECT_DOUBLE_EQ(depth.excluded[1].from, 600e-9);
  const std::string again = temporary("excluded.toml");
  write_bytes(again, resolved_toml(study));
  EXPECT_EQ(read_study(again).variables, study.variables);
}

TEST(Design, AHoleLargerThanItsPeriodIsRefused) {
  EXPECT_EQ(
      problems_of("schema_version = 1\n[texture]\ntype = \"hole_array\"\nperiod = \"3 um\"\n"
                  "diameter = \"4 um\"\ndepth = \"350 nm\"\n"),
      ":5:12: texture.diameter: 4 um is not smaller than the period 3 um; features would overlap");
}

// Key, default, range and source of every number, as they are written down.
TEST(Keys, OfStudiesAreThoseOfTheReference) {
  for (const char* section : {"study", "accuracy"}) {
    const std::string page = std::string(PAPILLA_SOURCE_DIR) + "/docs/reference/" + section + ".md";
    EXPECT_EQ(reference_section(section, ReferenceFormat::Markdown), read_bytes(page)) << section;
  }
}

}  // namespace
}  // namespace papilla::tests::design_test
