// What a design may not say across its fields: each contradiction by its words, and the border of
// each by the number that just is none.
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "base/error.h"
#include "design/design.h"
#include "design/study.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::contradictions_test {
namespace {

// A line each; "" for a sound design.
std::string said(const Design& design) {
  std::string out;
  for (const DesignProblem& p : design_problems(design)) out += p.path + ": " + p.message + "\n";
  return out;
}

TEST(Contradictions, OfTheAirAreItsOrderAndItsWeights) {
  Design d;
  Environment& air = d.environment;
  EXPECT_EQ(said(d), "");
  const std::string rising = "environment.relative_humidity: expected rising values\n";
  air.relative_humidity = {};
  EXPECT_EQ(said(d), "environment.relative_humidity: expected at least one humidity\n");
  air.relative_humidity = {0.5};
  EXPECT_EQ(said(d), "");
  air.relative_humidity = {0.2, 0.2};
  EXPECT_EQ(said(d), rising);
  air.relative_humidity.clear();
  for (int i = 0; i <= 1000; ++i) air.relative_humidity.push_back(i / 1000.0);
  EXPECT_EQ(said(d), "environment.relative_humidity: 1001 humidities: expected 1000 at most\n");
  air.relative_humidity = {0.2, 0.4, 0.3, 0.1};  // said once
  EXPECT_EQ(said(d), rising);
  air.relative_humidity = {0.2, 0.4, 0.6};
  for (const auto& [weights, words] : std::vector<std::pair<std::vector<double>, std::string>>{
           {{1, 0, 0}, ""},
           {{0, 0, 1}, ""},
           {{0, 0, 0}, "environment.weights: expected at least one weight above 0\n"},
           {{1, 1}, "environment.weights: expected 3 weights, one per humidity, got 2\n"},
           {{1, 1, 1, 1}, "environment.weights: expected 3 weights, one per humidity, got 4\n"}}) {
    air.weights = weights;
    EXPECT_EQ(said(d), words);
  }
}

// A finger's file by itself, as predict, reproduce and calibrate read it.
TEST(Contradictions, OfAFingersFileAreRefusedAtTheirKeys) {
  const auto refused = [](const std::string& text) {
    const std::string file = temporary("contradicted.toml");
    std::ofstream(file) << "schema_version = 1\n" << text;
    return keyed_refusal_of([&] { read_finger(file); });
  };
  EXPECT_EQ(refused("name = \"fine\"\n"), "");
  EXPECT_EQ(refused("[water]\nrelative_humidity = [\"20 %\", \"60 %\"]\n"),
            "water.volume: expected 2 volumes, one per humidity of water.relative_humidity, got "
            "4\n");
  for (const char* nodes :
       {"[\"75 %\", \"55 %\", \"35 %\", \"15 %\"]", "[\"15 %\", \"35 %\", \"35 %\", \"75 %\"]"})
    EXPECT_EQ(refused(std::string("[water]\nrelative_humidity = ") + nodes + "\n"),
              "water.relative_humidity: expected rising values\n");
  EXPECT_EQ(refused("load = \"0 N\"\n"), "load: expected a force above 0 N\n");
  EXPECT_EQ(refused("[saturation]\nrest_low = \"50 deg\"\nrest_high = \"50 deg\"\n"),
            "saturation.rest_high: expected another angle than rest_low\n");
  EXPECT_EQ(refused("[skin]\ncutoff = \"4 um\"\n"),
            "skin.cutoff: expected a shorter wavelength than roll_off\n");
}

TEST(Contradictions, OfTheFingerAreItsWaterItsLoadAndItsSkin) {
  const auto with = [](const auto& change) {
    Design d;
    change(d);
    return said(d);
  };
  const std::string volumes = "finger.water.volume: expected ";
  EXPECT_EQ(with([](Design& d) {
              d.finger.water.volume = {1e-18, 2e-18};
            }),
            volumes + "4 volumes, one per humidity of finger.water.relative_humidity, got 2\n");
  EXPECT_EQ(with([](Design& d) {
              d.finger.water.volume.clear();
              d.finger.water.relative_humidity.clear();
            }),
            volumes + "0 volumes, one per humidity of finger.water.relative_humidity, got 0\n");
  EXPECT_EQ(with([](Design& d) {
              d.finger.water.relative_humidity = {0.1, 0.3, 0.3, 0.4};
            }),
            "finger.water.relative_humidity: expected rising values\n");
  EXPECT_EQ(with([](Design& d) {
              d.finger.water.relative_humidity = {0.4, 0.3, 0.5, 0.6};
            }),
            "finger.water.relative_humidity: expected rising values\n");
  EXPECT_EQ(with([](Design& d) { d.finger.load = 0; }),
            "finger.load: expected a force above 0 N\n");
  EXPECT_EQ(with([](Design& d) { d.finger.load = 1e-9; }), "");
  EXPECT_EQ(with([](Design& d) { d.finger.saturation.rest_high = d.finger.saturation.rest_low; }),
            "finger.saturation.rest_high: expected another angle than rest_low\n");
  EXPECT_EQ(with([](Design& d) { d.finger.skin.cutoff = d.finger.skin.roll_off; }),
            "finger.skin.cutoff: expected a shorter wavelength than roll_off\n");
  EXPECT_EQ(with([](Design& d) { d.finger.skin.cutoff = 0.99 * d.finger.skin.roll_off; }), "");
  EXPECT_EQ(
      with([](Design& d) { d.finger.skin.roll_off = 30e-6, d.finger.skin.cutoff = 20e-6; }),
      "finger.skin.cutoff: expected at most the 12 um that rms is of: no wave would be left\n");
  // A measured skin has no spectrum, and the closure that asks for one none of it.
  EXPECT_EQ(with([](Design& d) {
              d.finger.skin.map = "skin.gsf";
              d.finger.skin.cutoff = d.finger.skin.roll_off;
            }),
            "");
  EXPECT_EQ(with([](Design& d) { d.model.closure = Closure::Persson; }), "");
  EXPECT_EQ(with([](Design& d) {
              d.finger.skin.map = "skin.gsf";
              d.model.closure = Closure::Persson;
            }),
            "finger.skin.map: closures persson and balance take the spectrum of the skin; use "
            "model.closure = \"uniform\" with a map\n");
}

TEST(Contradictions, OfTheDriveAreWhatItsSourceDoesNotHold) {
  const auto with = [](const Drive& drive) {
    Design d;
    d.drive = drive;
    return said(d);
  };
  const auto current = DriveControl::Current;
  EXPECT_EQ(with({.amplitude = 200}), "");
  EXPECT_EQ(with({.control = current, .current = 1e-3}), "");
  EXPECT_EQ(with({.control = current, .amplitude = 1, .current = 1e-3}),
            "drive.amplitude: a voltage, beside control = \"current\": set it to 0 V, give "
            "drive.current, and the largest voltage of the source as drive.source_compliance\n");
  EXPECT_EQ(with({.control = current, .amplitude = 0, .current = 1e-3}), "");  // what helps
  EXPECT_EQ(with({.amplitude = 200, .current = 1e-3}),
            "drive.current: a current, beside control = \"voltage\": say control = \"current\", or "
            "set it to 0 mA and give drive.amplitude\n");
  // Of a voltage the limit of a current says nothing here.
  EXPECT_EQ(with({.amplitude = 200, .current_limit = 0}), "");
  EXPECT_EQ(with({.control = current, .current = 5e-3, .current_limit = 5e-3}), "");
  EXPECT_EQ(with({.control = current, .current = 5.5e-3, .current_limit = 5e-3}),
            "drive.current: 5.5 mA is above drive.current_limit, 5 mA\n");
  EXPECT_EQ(with({.control = current, .waveform = Waveform::Dc}), "");
  EXPECT_EQ(with({.waveform = Waveform::Dc, .amplitude = 200}), "");
  EXPECT_EQ(with({.control = current, .waveform = Waveform::Dc, .current = 1e-3}),
            "drive.waveform: a constant current through a film that insulates has no end: give an "
            "alternating one\n");
  EXPECT_EQ(with({.control = current, .waveform = Waveform::Square}), "");
  EXPECT_EQ(with({.waveform = Waveform::Square, .amplitude = 200}), "");
  EXPECT_EQ(with({.control = current, .waveform = Waveform::Square, .current = 1e-3}),
            "drive.waveform: a square current makes a triangular voltage across film and gap, "
            "which is not modelled: give a sine, or control = \"voltage\" with drive.amplitude "
            "(`papilla solve drive` follows the circuit in time)\n");
  const std::string envelope =
      "drive.modulation_frequency: expected a frequency above 0 Hz for am\n";
  EXPECT_EQ(with({.waveform = Waveform::Am}), "");  // undriven
  EXPECT_EQ(with({.waveform = Waveform::Am, .amplitude = 200}), envelope);
  EXPECT_EQ(with({.waveform = Waveform::Am, .amplitude = 200, .modulation_frequency = 0.1}), "");
  EXPECT_EQ(with({.amplitude = 200, .modulation_frequency = 0}), "");
  EXPECT_EQ(with({.amplitude = 200, .source_compliance = 200}), "");
  EXPECT_EQ(with({.amplitude = 201, .source_compliance = 200}),
            "drive.amplitude: 201 V is above source_compliance, 200 V\n");
  EXPECT_EQ(with({.amplitude = 201, .source_compliance = 0}), "");
  Design bare;
  bare.surface.dielectric.clear();
  EXPECT_EQ(said(bare), "");
  bare.drive.amplitude = 1;
  const std::string film =
      "surface.dielectric: a driven surface needs a dielectric layer thicker than 0\n";
  EXPECT_EQ(said(bare), film);
  bare.surface.dielectric = {FilmDielectric{}};
  bare.surface.dielectric[0].thickness = 0;
  EXPECT_EQ(said(bare), film);
}

FilmDielectric layer(double thickness, LayerProcess process) {
  FilmDielectric out;
  out.thickness = thickness, out.process = process;
  return out;
}

// The last planar layer carries the texture; what lies below it is planar too.
TEST(Contradictions, OfTheFilmAreItsOrderAndADepthThatReachesTheElectrode) {
  Design d;
  d.texture = Texture{HoleArray{.depth = 350e-9}};
  auto& layers = d.surface.dielectric;
  const auto order = [](int k) {
    return "surface.dielectric." + std::to_string(k) +
           ".process: a layer that follows the texture cannot lie below a planar one: list the "
           "layers from the electrode up, or make it planar\n";
  };
  layers = {layer(400e-9, LayerProcess::Planar), layer(50e-9, LayerProcess::Conformal)};
  EXPECT_EQ(said(d), "");
  layers = {layer(400e-9, LayerProcess::Surface), layer(50e-9, LayerProcess::Directional),
            layer(400e-9, LayerProcess::Planar), layer(50e-9, LayerProcess::Surface)};
  EXPECT_EQ(said(d), order(0) + order(1));
  d.surface.process = FilmProcess::Planar;  // the first and the last as well: the last carries
  EXPECT_EQ(said(d),
            order(1) +
                "surface.dielectric.3.thickness: 50 nm: the texture is cut 350 nm deep into this "
                "planar layer and would reach the layer below it, and cuts through several layers "
                "are not modelled; make it thicker, or the texture shallower\n");
  layers = {layer(400e-9, LayerProcess::Surface), layer(350e-9, LayerProcess::Surface)};
  EXPECT_EQ(said(d),
            "surface.dielectric.1.thickness: 350 nm: the texture is cut 350 nm deep into this "
            "planar layer and would reach the layer below it, and cuts through several layers are "
            "not modelled; make it thicker, or the texture shallower\n");
  layers = {layer(350e-9, LayerProcess::Surface)};
  EXPECT_EQ(said(d),
            "surface.dielectric.0.thickness: 350 nm: the texture is cut 350 nm deep into this "
            "planar layer and would reach its electrode; make it thicker, or the texture "
            "shallower\n");
  layers = {layer(400e-9, LayerProcess::Surface), layer(350e-9, LayerProcess::Surface)};
  layers[1].thickness = 351e-9;
  EXPECT_EQ(said(d), "");
  layers[1].thickness = 1e-9;
  d.texture = Texture{PillarArray{}};  // stand on it
  EXPECT_EQ(said(d), "");
  d.texture = Texture{RandomRough{}};  // has no planes
  EXPECT_EQ(said(d), "");
}

TEST(Contradictions, OfTheViewAndTheGridAreTheirBorders) {
  Design d;
  d.view.angles.clear();
  EXPECT_EQ(said(d), "view.angles: expected at least one angle\n");
  d = {};
  d.view.fill_index = d.surface.refractive_index = 1.5;  // a matched fill
  EXPECT_EQ(said(d), "");
  d.view.fill_index = 1.51;
  EXPECT_EQ(said(d),
            "view.fill_index: expected at most 1.5, the index of what the texture is cut into\n");
  d.surface.process = FilmProcess::Planar;  // the film is cut, not the glass
  d.surface.dielectric[0].refractive_index = 1.46;
  d.view.fill_index = 1.48;
  EXPECT_EQ(said(d),
            "view.fill_index: expected at most 1.46, the index of what the texture is cut into\n");
  d = {};
  const std::string grid = "accuracy.grid: expected 0 (by level) or at least 16 pixels\n";
  for (const auto& [pixels, words] : {std::pair{0, std::string()},
                                      {1, grid},
                                      {15, grid},
                                      {16, std::string()},
                                      {17, std::string()}}) {
    d.accuracy.grid = pixels;
    EXPECT_EQ(said(d), words) << pixels;
  }
  d = {};
  d.texture = Texture{HoleArray{.period = 3e-6, .diameter = 3e-6}};
  EXPECT_EQ(said(d),
            "texture.diameter: 3 um is not smaller than the period 3 um; features would overlap\n");
}

TEST(DesignParts, AreHandedOnAsTheyAre) {
  Design d;
  d.accuracy.seed = 7, d.accuracy.droplet_seeds = 3;
  const Fidelity level = fidelity_level(d.accuracy.level_name());
  Fidelity own = fidelity_of(d);
  EXPECT_EQ(own.grid, level.grid);
  EXPECT_EQ(own.seed, 7u);
  EXPECT_EQ(own.droplet_seeds, 3);
  d.accuracy.grid = 20;
  EXPECT_EQ(fidelity_of(d).grid, 20);
  d.finger.load = 1.5, d.drive.amplitude = 100, d.surface.contact_angle = 1;
  const Scene scene = scene_of(d);
  EXPECT_EQ(scene.finger, d.finger);
  EXPECT_EQ(scene.drive, d.drive);
  EXPECT_EQ(scene.surface, d.surface);
  EXPECT_EQ(scene.environment, d.environment);
  EXPECT_EQ(scene.model, d.model);
}

// Each option that is another than that of the fit, as both are written.
TEST(DesignParts, OptionsThatTheFingerWasNotFittedWithAreNamed) {
  Design d;
  EXPECT_TRUE(calibration_mismatch(d).empty());
  d.finger.name = "mine";
  d.model.water = WaterModel::Threshold;
  d.model.droplet_step = 300e-9;
  d.finger.calibrated_for.air_limit = AirLimit::Emission;
  EXPECT_EQ(
      calibration_mismatch(d),
      (std::vector<std::string>{
          "model.water is \"threshold\", the finger \"mine\" was fitted with \"droplets\"",
          "model.air_limit is \"ionisation\", the finger \"mine\" was fitted with \"emission\"",
          "model.droplet_step is \"300 nm\", the finger \"mine\" was fitted with \"200 "
          "nm\""}));
}

// --- studies ---

// Each problem without the name of its file, a line each.
std::string problems(const std::string& text) {
  try {
    parse_study("schema_version = 1\n" + text, "s.toml");
  } catch (const InputError& error) {
    std::string out;
    for (const Problem& p : error.problems())
      out += std::to_string(p.line) + ":" + std::to_string(p.column) + " " + p.key + ": " +
             p.message + "\n";
    return out;
  }
  return "";
}

TEST(StudySections, SayWhatTheyExpect) {
  const std::string wish = "[objective]\nmaximise = \"mean(modulation)\"\n";
  EXPECT_EQ(problems(wish + "[design_space]\n\"drive.amplitude\" = [\"1 V\", \"2 V\"]\n"), "");
  EXPECT_EQ(problems("[design_space]\n\"drive.amplitude\" = [\"1 V\", \"2 V\"]\n"),
            "1:1 objective: a study needs `maximise`, `minimise` or `target`, e.g. maximise = "
            "\"mean(modulation)\"\n");
  for (const char* enough : {"minimise = \"mean(friction)\"", "target = { modulation = 0.5 }"})
    EXPECT_EQ(problems(std::string("[objective]\n") + enough +
                       "\n[design_space]\n\"drive.amplitude\" = [\"1 V\", \"2 V\"]\n"),
              "");
  EXPECT_EQ(problems(wish), "");  // no variables: no study
  EXPECT_EQ(problems("design_space = 3\n"),
            "2:16 design_space: expected a section [design_space], got 3\n");
  EXPECT_EQ(problems("[objective]\nmaximise = 3\n"),
            "3:12 objective.maximise: expected a text or a list of texts, got 3\n");
  EXPECT_EQ(problems("[objective]\nminimise = [\"mean(friction)\", 4]\n"),
            "3:31 objective.minimise: expected a text or a list of texts, got 4\n");
  EXPECT_EQ(problems("[objective]\ntarget = 0.5\n"),
            "3:10 objective.target: expected { METRIC = value }, e.g. { modulation = 0.8 }, got "
            "0.5\n");
  EXPECT_EQ(problems("[objective]\ntarget = { modulatoin = 0.5 }\n"),
            "3:12 objective.target: no metric over humidity is called \"modulatoin\"\n");
  EXPECT_EQ(problems("[objective]\ntarget = { haze = 0.5 }\n"),
            "3:12 objective.target: no metric over humidity is called \"haze\"\n");
  EXPECT_EQ(problems("[population]\nfingers = []\n"),
            "3:11 population.fingers: expected a list of finger files\n");
  EXPECT_EQ(problems("[population]\nfingers = \"a.toml\"\n"),
            "3:11 population.fingers: expected a list of finger files\n");
  EXPECT_EQ(problems("[population]\nfingers = [3]\n"),
            "3:12 population.fingers: expected the name of a file, got 3\n");
}

TEST(StudySections, OfVariablesSayWhatABoundIs) {
  const auto variable = [](const std::string& value) {
    return problems(
        "[objective]\nmaximise = \"mean(modulation)\"\n[design_space]\n\"drive.amplitude\" "
        "= " +
        value + "\n");
  };
  const std::string expected =
      " design_space.drive.amplitude: expected [low, high], { choice = [...] } or { range = [low, "
      "high], exclude = [[from, to]] }";
  EXPECT_EQ(variable("3"), "5:21" + expected + ", got 3\n");
  EXPECT_EQ(variable("[\"1 V\"]"), "5:21" + expected + ", got a list\n");
  EXPECT_EQ(variable("[\"1 V\", \"2 V\", \"3 V\"]"), "5:21" + expected + ", got a list\n");
  EXPECT_EQ(variable("{ choice = [\"2 V\"] }"), "");
  EXPECT_EQ(variable("{ choice = [] }"), "5:32" + expected + ", got a list\n");
  EXPECT_EQ(variable("{ choice = [\"2 V\"], more = 1 }"), "5:21" + expected + "\n");
  EXPECT_EQ(variable("{ range = [\"1 V\", \"2 V\"], exclude = [] }"), "");
  EXPECT_EQ(variable("{ range = [\"1 V\", \"2 V\"], exclude = 3 }"),
            "5:31" + expected + ", got 3\n");
  EXPECT_EQ(variable("{ range = [\"1 V\", \"2 V\"], exclude = [], more = 1 }"),
            "5:21" + expected + "\n");
  EXPECT_EQ(
      variable("[\"2 V\", \"2 V\"]"),
      "5:21 design_space.drive.amplitude: expected low < high; of one value write { choice = [\"2 "
      "V\"] }, or state it in the design and leave it out here\n");
  EXPECT_EQ(variable("[\"3 V\", \"2 V\"]"),
            "5:21 design_space.drive.amplitude: expected low < high\n");
  const std::string ends =
      " design_space.drive.amplitude.exclude: expected low < from < to < high; where nothing is "
      "left "
      "at an end, narrow `range` instead\n";
  const auto excluded = [&](const char* from, const char* to) {
    const std::string said = variable("{ range = [\"1 V\", \"2 V\"], exclude = [[\"" +
                                      std::string(from) + "\", \"" + to + "\"]] }");
    return said.empty() ? said : said.substr(said.find(' '));
  };
  EXPECT_EQ(excluded("1.1 V", "1.9 V"), "");
  EXPECT_EQ(excluded("1 V", "1.9 V"), ends);
  EXPECT_EQ(excluded("1.1 V", "2 V"), ends);
  EXPECT_EQ(excluded("1.5 V", "1.5 V"), ends);
}

// A search chooses what is built: who touches it, in which air, how that is calculated, is given.
TEST(StudySections, OfVariablesAreNumbersOfWhatIsBuilt) {
  const auto variable = [](const std::string& path, const std::string& ends) {
    return problems("[objective]\nmaximise = \"mean(modulation)\"\n[design_space]\n\"" + path +
                    "\" = " + ends + "\n");
  };
  for (const auto& [path, ends] : {std::pair("finger.skin.rms", "[\"50 nm\", \"150 nm\"]"),
                                   {"environment.relative_humidity.0", "[\"20 %\", \"60 %\"]"},
                                   {"model.droplet_step", "[\"50 nm\", \"800 nm\"]"},
                                   {"accuracy.target", "[\"1 %\", \"5 %\"]"},
                                   {"view.cone", "[\"1 deg\", \"5 deg\"]"},
                                   {"view.panel.distance", "[\"300 mm\", \"500 mm\"]"},
                                   {"view.displacement", "[\"1 nm\", \"5 nm\"]"}}) {
    const std::string said = variable(path, ends);
    EXPECT_TRUE(
        said.starts_with(std::string("5:1 design_space.") + path + ": is nothing that is built"))
        << said;
    EXPECT_NE(said.find("[[scenarios]]"), std::string::npos) << said;
  }
  EXPECT_EQ(variable("surface.contact_angle", "[\"20 deg\", \"60 deg\"]"), "");
  EXPECT_EQ(variable("view.fill_index", "[1.1, 1.4]"), "");
}

// The kinds that numbers alone make, by their place in the list; parts of a stack from 1 on.
TEST(StudySections, OfKindsAndPartsAreTheirChoices) {
  const std::string wish = "[objective]\nmaximise = \"mean(modulation)\"\n";
  const Study study = parse_study("schema_version = 1\n" + wish +
                                      "[texture]\ntype = \"hole_array\"\n[design_space]\n"
                                      "\"texture.type\" = { choice = [\"grating\", \"flat\", "
                                      "\"waves\"] }\n",
                                  "s.toml");
  ASSERT_EQ(study.variables.size(), 1u);
  const Variable& kind = study.variables[0];
  EXPECT_EQ(kind.choices, (std::vector<double>{3, 0, 5}));
  EXPECT_EQ(kind.low, 0);
  EXPECT_EQ(kind.high, 5);
  EXPECT_TRUE(kind.is_kind());
  EXPECT_EQ(variable_text(kind, 5), "waves");
  const auto types = [&](const std::string& value) {
    return problems(wish + "[design_space]\n\"texture.type\" = " + value + "\n");
  };
  const std::string expected =
      " design_space.texture.type: expected { choice = [...] } of texture types, got ";
  EXPECT_EQ(types("[\"flat\", \"grating\"]"), "5:18" + expected + "a list\n");
  EXPECT_EQ(types("{ choice = [] }"), "5:18" + expected + "a section\n");
  EXPECT_EQ(types("{ choice = [\"flat\", \"measured\"] }"), "5:38" + expected + "\"measured\"\n");
  EXPECT_EQ(types("{ choice = [\"flat\", 3] }"), "5:38" + expected + "3\n");
  const auto levels = [&](const std::string& value) {
    return problems(wish +
                    "[texture]\ntype = \"stack\"\nparts = [{ type = \"hole_array\" }, { type = "
                    "\"random_rough\" }]\n[design_space]\n\"texture.levels\" = " +
                    value + "\n");
  };
  const std::string parts =
      " design_space.texture.levels: expected { choice = [...] } of numbers of parts, 1 to 2, got ";
  EXPECT_EQ(levels("{ choice = [1, 2] }"), "");
  EXPECT_EQ(levels("{ choice = [0, 1] }"), "8:32" + parts + "0\n");
  EXPECT_EQ(levels("{ choice = [1, 3] }"), "8:35" + parts + "3\n");
  EXPECT_EQ(levels("{ choice = [1, 1.5] }"), "8:35" + parts + "1.5\n");
}

TEST(Variables, AreWrittenAsPeopleWriteThem) {
  const Variable depth{"texture.depth", "nm", 1e-7, 9e-7, {}, {}},
      share{"texture.coverage", "%", 0, 0.5, {}, {}}, plain{"texture.hurst", "", 0, 1, {}, {}};
  EXPECT_EQ(variable_text(depth, 123.456e-9), "123 nm");
  EXPECT_EQ(variable_text(depth, 123.456789e-9, true), "123.457");
  EXPECT_EQ(variable_text(share, 0.25), "25 %");
  EXPECT_EQ(variable_text(plain, 0.75), "0.75");
}

// A period of 1 mm never ended, 1e5 droplets a um3 took minutes.
TEST(Contradictions, MoreDropletsThanCanBeSettledAreRefusedBeforeTheWork) {
  Design d;
  d.environment.relative_humidity = {0.15, 0.75};
  HoleArray holes;
  holes.period = 6e-6, holes.diameter = 3e-6, holes.depth = 300e-9;
  const auto refused = [&](double period, double drops) {
    holes.period = period;
    d.texture = {holes};
    d.finger.water.drops_per_um3 = drops;
    const std::vector<DesignProblem> problems = design_problems(d);
    return !problems.empty() && problems.front().path == "finger.water.drops_per_um3" &&
           problems.front().message.find("droplets on a patch of") != std::string::npos;
  };
  EXPECT_FALSE(refused(6e-6, 100));
  EXPECT_FALSE(refused(100e-6, 100));
  EXPECT_TRUE(refused(1e-3, 100));
  EXPECT_TRUE(refused(6e-6, 1e5));
  EXPECT_TRUE(design_problems(d, DesignUse::Drawn).empty());  // no file has a droplet
  d.model.water = WaterModel::Threshold;
  EXPECT_FALSE(refused(6e-6, 1e5));
}

// Four particles of 20 um that cover a tenth need 226 um, and there is no period to shorten.
TEST(Contradictions, MoreDropletsThanCanBeSettledNameWhatMakesThePatchShorter) {
  Design d;
  d.environment.relative_humidity = {0.15, 0.75};
  d.finger.water.drops_per_um3 = 100;
  const auto ways = [&](const Texture& texture) {
    d.texture = texture;
    for (const DesignProblem& problem : design_problems(d)) {
      if (problem.path == "finger.water.drops_per_um3")
        return problem.message.substr(problem.message.find("fewer of them"));
    }
    return std::string();
  };
  EXPECT_EQ(ways({ParticleFilm{.radius = 20e-6, .coverage = 0.1}}),
            "fewer of them, smaller particles or more coverage by them, or model.water = "
            "\"threshold\"");
  EXPECT_EQ(ways({ParticleFilm{.radius = 20e-6, .coverage = 0.2}}), "");
  EXPECT_EQ(ways({HoleArray{.period = 1e-3, .diameter = 3e-6, .depth = 300e-9}}),
            "fewer of them, a shorter period, or model.water = \"threshold\"");
  d.finger.water.drops_per_um3 = 1e5;
  EXPECT_EQ(ways({HoleArray{.period = 6e-6, .diameter = 3e-6, .depth = 300e-9}}),
            "fewer of them, or model.water = \"threshold\"");
}

}  // namespace
}  // namespace papilla::tests::contradictions_test
