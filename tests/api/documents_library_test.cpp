// Values of the library beside the documents of the commands: the same numbers, each under its
// name; and the borders of designs, levels, studies and files.
#include <gtest/gtest.h>
#include <papilla/papilla.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/temporary.h"

namespace {

using Json = nlohmann::json;

constexpr const char* kSmall =
    "schema_version = 1\nbase = \"m3_samples/a3h350.toml\"\n[accuracy]\nlevel = \"draft\"\n"
    "grid = 48\n[environment]\nrelative_humidity = [\"30 %\", \"70 %\"]\n";

std::string refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const papilla::InputError& error) {
    return error.what();
  }
  return "";
}

papilla::EvaluateOptions options_of(const std::string& level, double target = 0,
                                    bool parameters = false) {
  papilla::EvaluateOptions out;
  out.level = level, out.target = target, out.parameters = parameters;
  return out;
}

const papilla::Response& small_response() {
  static const papilla::Response response =
      papilla::evaluate(papilla::Design::parse(kSmall), options_of("", 0, true));
  return response;
}

void expect_number(const Json& json, const std::optional<double>& value, const std::string& name) {
  if (value) {
    ASSERT_TRUE(json.is_number()) << name;
    EXPECT_EQ(json.get<double>(), *value) << name;
  } else {
    EXPECT_TRUE(json.is_null()) << name;
  }
}

TEST(ResponseOfTheLibrary, IsItsDocumentInNumbers) {
  const papilla::Response& r = small_response();
  const Json json = Json::parse(r.json());
  EXPECT_TRUE(r.driven());
  EXPECT_EQ(r.trouble(), "");
  ASSERT_EQ(r.points().size(), 2u);
  std::size_t known = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const papilla::Point& p = r.points()[i];
    const Json& point = json["points"][i];
    EXPECT_EQ(p.relative_humidity, i == 0 ? 0.3 : 0.7);
    EXPECT_TRUE(p.sound);
    EXPECT_EQ(p.status, "ok");
    const std::vector<std::pair<const char*, const papilla::Quantity*>> quantities{
        {"F_off", &p.friction_off},
        {"F_on", &p.friction_on},
        {"modulation", &p.modulation},
        {"area_fraction_off", &p.area_fraction_off},
        {"area_fraction_on", &p.area_fraction_on},
        {"capillary_force", &p.capillary_force},
        {"electrostatic_force", &p.electrostatic_force},
        {"retention_force", &p.retention_force},
        {"bridges", &p.bridges},
        {"wetted_fraction", &p.wetted_fraction},
        {"mean_gap", &p.mean_gap},
        {"indentation", &p.indentation}};
    for (const auto& [name, q] : quantities) {
      EXPECT_EQ(point[name]["value"].get<double>(), q->value) << name;
      EXPECT_EQ(point[name]["se"].get<double>(), q->error) << name;
      const Json& parts = point[name]["parts"];
      EXPECT_EQ(parts.size(), 9u);
      EXPECT_EQ(parts["sampling"].get<double>(), q->parts.sampling) << name;
      for (const auto& [origin, part] : {std::pair{"grid", q->parts.grid},
                                         {"solver", q->parts.solver},
                                         {"humidity", q->parts.humidity},
                                         {"method", q->parts.method},
                                         {"field", q->parts.field},
                                         {"parameters", q->parts.parameters},
                                         {"water", q->parts.water}}) {
        expect_number(parts[origin], part, std::string(name) + " " + origin);
        known += part.has_value();
      }
    }
  }
  EXPECT_GT(known, 24u);
  EXPECT_TRUE(json.contains("seconds"));
  EXPECT_FALSE(Json::parse(r.json(false)).contains("seconds"));
  EXPECT_EQ(Json::parse(r.json(false))["fidelity"]["grid"], 48);
  EXPECT_NE(r.svg("a title").find(">a title<"), std::string::npos);
  EXPECT_NE(r.table().find("   30%"), std::string::npos);
}

// Beyond breakdown the JSON has null, and so has C++ (and with it Python) no number.
TEST(ResponseOfTheLibrary, HasNoNumbersOfAStateThatDoesNotExist) {
  const papilla::Design first = papilla::Design::parse(kSmall).with("environment.relative_humidity",
                                                                    "[\"30 %\"]"),
                        broken = first.with("drive.amplitude", "5 kV");
  const papilla::Comparison c = papilla::compare(first, broken);
  const papilla::Point& p = c.second.points().at(0);
  const Json point = Json::parse(c.second.json())["points"][0];
  EXPECT_EQ(p.status.find("breakdown: "), 0u) << p.status;
  for (const auto& q : papilla::kQuantities<papilla::Quantity>) {
    EXPECT_EQ(point[q.key].is_null(), std::isnan((p.*q.value).value)) << q.name;
    EXPECT_EQ(point[q.key].is_null(), std::isnan((p.*q.value).error)) << q.name;
  }
  EXPECT_TRUE(std::isnan(p.modulation.value) && std::isfinite(p.friction_off.value));
  EXPECT_TRUE(std::isnan(c.points[0].modulation.value) && std::isnan(c.mean_modulation.error));
  EXPECT_EQ(c.points[0].friction_off.value, 0);
  papilla::SensitivityOptions options;
  options.keys = {"texture.depth"};
  EXPECT_TRUE(std::isnan(papilla::sensitivity(broken, "mean(modulation)", options).at(0).slope));
  EXPECT_TRUE(std::isfinite(papilla::sensitivity(broken, "mean(friction)", options).at(0).slope));
}

TEST(ResponseOfTheLibrary, HasALevelOrATarget) {
  const papilla::Design design = papilla::Design::parse(kSmall);
  const auto said = [&](const papilla::EvaluateOptions& options) {
    return refusal([&] { papilla::evaluate(design, options); });
  };
  EXPECT_EQ(said(options_of("drafty")),
            "level: expected draft, design or reference, got \"drafty\"");
  EXPECT_EQ(said(options_of("", -0.01)), "target: expected a share from 0 to 1");
  EXPECT_EQ(said(options_of("", 1)), "target: expected a share from 0 to 1");
  EXPECT_EQ(said(options_of("", NAN)), "target: expected a share from 0 to 1");
  EXPECT_EQ(said(options_of("draft", 0.1)),
            "target: give a level or a target, not both: a target finds its own level");
  papilla::EvaluateOptions options;
  options.threads = -1;
  EXPECT_EQ(said(options), "threads: expected 0, all processors, to 4096, got -1");
  options.threads = 0;
  for (const double modulation :
       {-0.1, 0.0, static_cast<double>(NAN), static_cast<double>(INFINITY)}) {
    options.voltage_for = {0.3, modulation};
    EXPECT_EQ(said(options).substr(0, 46), "voltage_for: expected modulations above 0, 0.3");
  }
  // A level takes the place of the design's own target.
  const papilla::Design aimed =
      design.with({{"accuracy.level", "design"}, {"accuracy.target", "50 %"}});
  const Json json = Json::parse(papilla::evaluate(aimed, options_of("draft")).json());
  EXPECT_FALSE(json.contains("accuracy"));
  EXPECT_EQ(json["fidelity"]["level"], "draft");
}

TEST(ComparisonOfTheLibrary, IsTheSecondLessTheFirst) {
  const papilla::Design first = papilla::Design::parse(kSmall).with("environment.relative_humidity",
                                                                    "[\"30 %\"]"),
                        second = first.with("texture.depth", "500 nm");
  const papilla::Comparison c = papilla::compare(first, second);
  ASSERT_EQ(c.points.size(), 1u);
  const papilla::Point &a = c.first.points()[0], &b = c.second.points()[0];
  const papilla::ComparedPoint& p = c.points[0];
  EXPECT_EQ(p.relative_humidity, 0.3);
  EXPECT_NEAR(p.friction_off.value, b.friction_off.value - a.friction_off.value, 1e-12);
  EXPECT_NEAR(p.friction_on.value, b.friction_on.value - a.friction_on.value, 1e-12);
  EXPECT_NEAR(p.modulation.value, b.modulation.value - a.modulation.value, 1e-12);
  EXPECT_NE(p.friction_off.value, p.friction_on.value);
  EXPECT_TRUE(p.modulation.paired);
  EXPECT_GT(p.modulation.error, 0);
  EXPECT_LT(p.friction_off.error, std::hypot(a.friction_off.error, b.friction_off.error));
  // At one humidity the mean is its value.
  EXPECT_NEAR(c.mean_friction.value, p.friction_off.value, 1e-12);
  EXPECT_NEAR(c.mean_modulation.value, p.modulation.value, 1e-12);
  EXPECT_NEAR(c.mean_modulation.error, p.modulation.error, 1e-12);
  // Without a drive there is friction alone; at the level of the first.
  const papilla::Comparison off =
      papilla::compare(first, second.with({{"drive.amplitude", "0 V"}, {"accuracy.grid", "64"}}));
  EXPECT_EQ(off.points[0].modulation.error, 0);
  EXPECT_EQ(off.points[0].friction_on.value, 0);
  EXPECT_EQ(off.mean_modulation.value, 0);
  EXPECT_NE(off.mean_friction.value, 0);
  EXPECT_EQ(refusal([&] { papilla::compare(first, papilla::Design::parse(kSmall)); }),
            "environment.relative_humidity: compared designs meet the same humidities");
}

// The second meets the skins and the grid of the first, whatever its file says of its own.
TEST(ComparisonOfTheLibrary, MeetsTheSkinsOfTheFirst) {
  const papilla::Design first = papilla::Design::parse(kSmall).with("environment.relative_humidity",
                                                                    "[\"30 %\"]"),
                        second = first.with("texture.depth", "500 nm");
  papilla::EvaluateOptions options;
  options.model = false;
  const auto of = [&](const papilla::Design& other) {
    return papilla::compare(first, other, options).points.at(0).modulation;
  };
  const papilla::Difference same = of(second),
                            others = of(second.with({{"accuracy.seed", "7"},
                                                     {"accuracy.grid", "64"},
                                                     {"accuracy.droplet_seeds", "2"}}));
  EXPECT_TRUE(others.paired);
  EXPECT_EQ(others.value, same.value);
  EXPECT_EQ(others.error, same.error);
}

// A deep texture takes more skins to a target than a shallow one: both meet those.
TEST(ComparisonOfTheLibrary, IsPairedAtATarget) {
  const papilla::Design first = papilla::Design::parse(kSmall).with(
                            {{"environment.relative_humidity", "[\"30 %\"]"},
                             {"drive.amplitude", "90 V"}}),
                        second = first.with("texture.depth", "3 um");
  papilla::EvaluateOptions options = options_of("", 0.1);
  options.model = false;
  const auto plan = [](const papilla::Response& r) { return Json::parse(r.json())["fidelity"]; };
  const Json alone = plan(papilla::evaluate(first, options)),
             other = plan(papilla::evaluate(second, options));
  ASSERT_NE(alone, other);
  const papilla::Comparison c = papilla::compare(first, second, options);
  EXPECT_EQ(plan(c.first), plan(c.second));
  EXPECT_GE(plan(c.first)["skins"], std::max(alone["skins"], other["skins"]));
  EXPECT_GE(plan(c.first)["grid"], std::max(alone["grid"], other["grid"]));
  EXPECT_TRUE(c.points.at(0).modulation.paired);
  EXPECT_TRUE(c.mean_friction.paired);
  EXPECT_NEAR(c.points[0].modulation.value,
              c.second.points()[0].modulation.value - c.first.points()[0].modulation.value, 1e-12);
}

TEST(SensitivityOfTheLibrary, IsTheChangeOverTheStep) {
  const papilla::Design design =
      papilla::Design::parse(kSmall).with("environment.relative_humidity", "[\"30 %\"]");
  papilla::SensitivityOptions options;
  options.keys = {"texture.diameter"};
  options.step = 0.1;
  const auto found = papilla::sensitivity(design, "mean(friction)", options);
  ASSERT_EQ(found.size(), 1u);
  const papilla::Sensitivity& s = found[0];
  EXPECT_EQ(s.unit, "um");
  EXPECT_NEAR(s.value, 3e-6, 1e-15);
  EXPECT_NEAR(s.down, 2.7e-6, 1e-12);
  EXPECT_NEAR(s.up, 3.3e-6, 1e-12);
  EXPECT_NEAR(s.slope, s.change.value / 0.6e-6, 1e-9 * std::abs(s.slope));
  EXPECT_NEAR(s.slope_error, s.change.error / 0.6e-6, 1e-9 * s.slope_error);
  EXPECT_GT(s.slope_error, 0);
  for (const double step : {0.0, -0.1, 1.0}) {
    options.step = step;
    EXPECT_EQ(refusal([&] { papilla::sensitivity(design, "mean(friction)", options); }),
              "step: expected more than 0 and less than 1");
  }
}

// Both ends meet the same skins on the same grid, whatever accuracy the design asks for.
TEST(SensitivityOfTheLibrary, IsPairedAtATargetOfTheDesign) {
  const papilla::Design design =
      papilla::Design::parse(kSmall).with("environment.relative_humidity", "[\"30 %\"]");
  papilla::SensitivityOptions options;
  options.keys = {"texture.depth"};
  const auto of = [&](const papilla::Design& d) {
    return papilla::sensitivity(d, "mean(friction)", options).at(0);
  };
  const papilla::Sensitivity plain = of(design), aimed = of(design.with("accuracy.target", "50 %"));
  EXPECT_TRUE(aimed.change.paired);
  EXPECT_EQ(aimed.change.value, plain.change.value);
  EXPECT_EQ(aimed.change.error, plain.change.error);
}

// The ends of so large a step would take unlike numbers of skins to the target.
TEST(SensitivityOfTheLibrary, IsPairedAtATargetThatIsAskedFor) {
  const papilla::Design design =
      papilla::Design::parse(kSmall).with({{"environment.relative_humidity", "[\"30 %\"]"},
                                           {"drive.amplitude", "90 V"},
                                           {"texture.depth", "1.6 um"}});
  papilla::SensitivityOptions options;
  options.keys = {"texture.depth"};
  options.step = 0.9;
  options.evaluate = options_of("", 0.1);
  const papilla::Sensitivity s = papilla::sensitivity(design, "mean(modulation)", options).at(0);
  EXPECT_TRUE(s.change.paired);
}

// A skin that carries the load may yield under the pull: what the command says of each point.
TEST(CasesOfTheLibrary, SayWhichPointsYieldEverywhere) {
  const papilla::PerssonResult r =
      papilla::api::persson({"physics/wrist_on_glass.toml",
                             "",
                             {{"skin.hardness", "100 kPa"},
                              {"drive.amplitude", "200 V"},
                              {"sweep.voltage", "[\"0 V\", \"200 V\"]"}}});
  EXPECT_TRUE(r.point.yielded);
  ASSERT_EQ(r.over_voltage.size(), 2u);
  EXPECT_FALSE(r.over_voltage[0].yielded);
  EXPECT_TRUE(r.over_voltage[1].yielded);
  EXPECT_EQ(Json::parse(r.json)["over_voltage"][1]["yielded"], true);
}

TEST(CasesOfTheLibrary, HaveTheNumbersOfTheirDocuments) {
  const papilla::PerssonResult r = papilla::api::persson(
      {"physics/wrist_on_glass.toml",
       "",
       {{"drive.amplitude", "120 V"}, {"sweep.load", "[\"0.2 N\", \"0.5 N\", \"1 N\"]"}}});
  const Json json = Json::parse(r.json);
  EXPECT_EQ(json["rms"].get<double>(), r.rms);
  EXPECT_EQ(json["slope"].get<double>(), r.slope);
  EXPECT_EQ(json["contact_modulus"].get<double>(), r.contact_modulus);
  const auto expect_point = [](const papilla::PerssonPoint& p, const Json& of) {
    const std::vector<std::pair<const char*, double>> numbers{{"voltage", p.voltage},
                                                              {"load", p.load},
                                                              {"frequency", p.frequency},
                                                              {"area_off", p.area_off},
                                                              {"area_on", p.area_on},
                                                              {"pressure", p.pressure},
                                                              {"pull", p.pull},
                                                              {"mean_gap", p.mean_gap},
                                                              {"friction", p.friction},
                                                              {"coefficient", p.coefficient},
                                                              {"capacitance", p.capacitance}};
    for (const auto& [name, value] : numbers) EXPECT_EQ(of[name].get<double>(), value) << name;
    EXPECT_EQ(of["collapsed"], p.collapsed);
    EXPECT_EQ(of["breaks_down"], p.breaks_down);
    EXPECT_EQ(of.value("yielded", false), p.yielded);
  };
  expect_point(r.point, json["point"]);
  EXPECT_EQ(r.point.voltage, 120);
  EXPECT_EQ(r.over_voltage.size(), 5u);
  EXPECT_EQ(r.over_load.size(), 3u);
  EXPECT_EQ(r.over_frequency.size(), 4u);
  for (std::size_t i = 0; i < 3; ++i) expect_point(r.over_load[i], json["over_load"][i]);
  EXPECT_EQ(r.over_load[2].load, 1);
  EXPECT_EQ(r.over_voltage[4].voltage, 200);
  EXPECT_EQ(r.over_frequency[3].frequency, 10000);
  EXPECT_TRUE(r.table.starts_with("Dry wrist skin")) << r.table;
  const papilla::DriveResult d = papilla::api::drive(
      {"",
       "schema_version = 1\ntitle = \"mine\"\n[drive]\namplitude = \"100 V\"\nwaveform = "
       "\"sine\"\nfrequency = \"5 kHz\"\n[touch]\nload = \"1 N\"\narea = \"30 mm2\"\n",
       {{"touch.coefficient", "0.2"}}});
  const Json drive = Json::parse(d.json);
  EXPECT_EQ(drive["title"], "mine");
  EXPECT_EQ(drive["period"].get<double>(), d.period);
  EXPECT_EQ(drive["mean_pull"].get<double>(), d.mean_pull);
  EXPECT_EQ(drive["distortion"].get<double>(), d.distortion);
  ASSERT_EQ(drive["friction_lines"].size(), d.line_frequency.size());
  for (std::size_t i = 0; i < d.line_frequency.size(); ++i) {
    EXPECT_EQ(drive["friction_lines"][i]["frequency"].get<double>(), d.line_frequency[i]);
    EXPECT_EQ(drive["friction_lines"][i]["amplitude"].get<double>(), d.line_amplitude[i]);
  }
  const auto most = [](const std::vector<double>& v) {
    double out = 0;
    for (const double x : v) out = std::max(out, std::abs(x));
    return out;
  };
  EXPECT_NEAR(most(d.current), drive["peak_current"].get<double>(), 1e-12);
  EXPECT_NEAR(most(d.source_voltage), drive["peak_source_voltage"].get<double>(), 1e-9);
  EXPECT_NEAR(most(d.gap_voltage), drive["peak_gap_voltage"].get<double>(), 1e-9);
  EXPECT_EQ(d.pull.size(), d.friction.size());
  double pull = 0;
  for (const double v : d.pull) pull += v / static_cast<double>(d.pull.size());
  EXPECT_NEAR(pull, d.mean_pull, 1e-9 * pull);
  EXPECT_TRUE(d.table.starts_with("mine\n"));
}

TEST(DesignOfTheLibrary, NamesEveryNumberInSi) {
  const papilla::Design design = papilla::Design::parse(kSmall);
  bool depth = false, angle = false;
  for (const papilla::Number& n : design.numbers()) {
    EXPECT_LE(n.low, n.value) << n.path;
    EXPECT_GE(n.high, n.value) << n.path;
    EXPECT_EQ(n.value, design.number(n.path)) << n.path;
    if (n.path == "texture.depth") {
      depth = true;
      EXPECT_EQ(n.unit, "nm");
      EXPECT_NEAR(n.value, 350e-9, 1e-18);
      EXPECT_EQ(n.low, 0);
      EXPECT_NEAR(n.high, 1e-4, 1e-12);
      EXPECT_FALSE(n.meaning.empty());
    }
    if (n.path == "surface.contact_angle") {
      angle = true;
      EXPECT_NEAR(n.high, std::acos(-1.0), 0.2);
    }
  }
  EXPECT_TRUE(depth && angle);
  EXPECT_NE(refusal([&] { design.number("texture.depht"); }), "");
  EXPECT_EQ(design.drawn(), nullptr);
  EXPECT_NE(refusal([&] { papilla::Design::read("m3_samples/none.toml"); }), "");
  EXPECT_EQ(papilla::Design::read("m3_samples/a3h350.toml").number("texture.depth"), 350e-9);
}

TEST(DesignOfTheLibrary, HasHeightsOfEightPixelsOrMore) {
  const papilla::Design design = papilla::Design::parse(kSmall);
  const std::string why = "heights: expected 8 to 65536 pixels";
  EXPECT_EQ(refusal([&] { design.heights(7); }), why);
  EXPECT_EQ(refusal([&] { design.heights(65537); }), why);
  const papilla::Heights h = design.heights(8);
  EXPECT_EQ(h.nx, 8);
  EXPECT_NEAR(h.nx * h.dx, 12e-6, 1e-12);  // two periods of 6 um
  EXPECT_NEAR(h.ny * h.dy, 12e-6, 1e-12);
}

TEST(DesignOfTheLibrary, IsDrawnOnSquarePixelsOfASquare) {
  const auto said = [](const papilla::Heights& h) {
    return refusal([&] { papilla::Design::from_heights(h, {{"base", "m3_samples/flat.toml"}}); });
  };
  const auto map = [](int nx, int ny, double dx, double dy) {
    papilla::Heights h{nx, ny, dx, dy, std::vector<double>(static_cast<std::size_t>(nx) * ny, 0.0)};
    h.z[1] = 1e-8;
    return h;
  };
  EXPECT_EQ(said(map(8, 8, 1e-6, 1e-6)), "");
  EXPECT_EQ(said(map(8, 8, 1e-6, 1e-6 * (1 + 1e-10))), "");
  const std::string square =
      "heights: expected square pixels on a square, got 8 x 8 pixels of 1 x 2 um";
  EXPECT_EQ(said(map(8, 8, 1e-6, 2e-6)), square);
  EXPECT_NE(said(map(8, 8, 1e-6, 1e-6 * (1 + 1e-8))), "");
  EXPECT_NE(said(map(8, 8, 1e-6, 1e-6 * (1 - 1e-8))), "");
  EXPECT_NE(said(map(8, 10, 1e-6, 1e-6)), "");
  EXPECT_EQ(said(map(7, 7, 1e-6, 1e-6)), "heights: expected 8 x 8 pixels at least, got 7 x 7");
  papilla::Heights infinite = map(8, 8, 1e-6, 1e-6);
  infinite.z[3] = INFINITY;
  EXPECT_EQ(said(infinite), "heights: expected finite heights");
  // Its file is there for as long as the design is.
  std::string file;
  {
    const papilla::Design design =
        papilla::Design::from_heights(map(8, 8, 1e-6, 1e-6), {{"base", "m3_samples/flat.toml"}});
    ASSERT_NE(design.drawn(), nullptr);
    EXPECT_EQ(design.drawn()->z[1], 1e-8);
    EXPECT_NEAR(design.number("texture.patch"), 8e-6, 1e-15);
    const std::string toml = design.toml();
    const std::size_t at = toml.find("/papilla-"), begin = toml.rfind('"', at) + 1;
    ASSERT_NE(at, std::string::npos) << toml;
    file = toml.substr(begin, toml.find('"', at) - begin);
    EXPECT_TRUE(std::filesystem::exists(file));
    const papilla::Design other = design.with("drive.amplitude", "50 V");
    EXPECT_EQ(other.drawn(), design.drawn());
  }
  EXPECT_FALSE(std::filesystem::exists(file));
}

// Of the caller's argument, once: it knows no key of the texture.
TEST(DesignOfTheLibrary, NamesTheSizeOfHeightsThatHaveAnotherOne) {
  const auto said = [](double width, bool repeats, const papilla::Design::Values& values) {
    const papilla::Heights h{8, 8, width / 8, width / 8, std::vector<double>(64, 0.0)};
    return refusal([&] { papilla::Design::from_heights(h, values, repeats); });
  };
  EXPECT_EQ(said(6, true, {}), "size: the width of the map: 6000000 um is outside 0.1 to 10000 um");
  EXPECT_EQ(said(2e-6, true, {}), "");
  EXPECT_TRUE(said(2e-6, false, {})
                  .starts_with("size: the patch that a map of this width leaves beside its seam: "
                               "1.66 um is shorter"))
      << said(2e-6, false, {});
  EXPECT_TRUE(
      said(6e-6, false, {{"texture.patch", "2 um"}}).find("texture.patch: 2 um is shorter") !=
      std::string::npos)
      << said(6e-6, false, {{"texture.patch", "2 um"}});
}

// The outer tenth of a patch is blended into what lies beyond it, of which a map as large has none.
TEST(DesignOfTheLibrary, TakesAsMuchOfHeightsAsLeavesRoomForTheirSeam) {
  papilla::Heights wave{16, 16, 0.75e-6, 0.75e-6, {}};  // 12 um, its borders a step apart
  for (int i = 0; i < 256; ++i) wave.z.push_back(1e-8 * std::sin(0.5 * (i % 16)));
  const auto patch = [&](bool repeats) {
    return papilla::Design::from_heights(wave, {}, repeats).number("texture.patch");
  };
  EXPECT_NEAR(patch(true), 12e-6, 1e-12);
  EXPECT_NEAR(patch(false), 10e-6, 1e-12);
}

// More droplets than can be settled: no file has one.
TEST(DesignOfTheLibrary, IsDrawnWhereNoSimulationSettlesIt) {
  const papilla::Design dry = papilla::Design::parse(kSmall);
  const papilla::Design design = dry.with("finger.water.drops_per_um3", "100000");
  papilla::ExportOptions options;
  options.formats = {"gsf"}, options.pixels = 96;
  const std::string folder = papilla::tests::temporary("wet");
  EXPECT_EQ(papilla::export_files(design, folder, options).files.size(), 1u);
  EXPECT_EQ(design.heights(16).nx, 16);
  for (const std::string& said : {refusal([&] { papilla::evaluate(design); }),
                                  refusal([&] { papilla::compare(dry, design); }), refusal([&] {
                                    papilla::api::rank({design, design});
                                  }),
                                  refusal([&] { design.require_simulated(); })})
    EXPECT_NE(said.find("finger.water.drops_per_um3: 1e+05 makes"), std::string::npos) << said;
}

constexpr const char* kStudy =
    "schema_version = 1\nbase = \"m3_samples/a3h350.toml\"\n"
    "[design_space]\n\"texture.depth\" = [\"100 nm\", \"500 nm\"]\n"
    "\"texture.diameter\" = { choice = [\"2 um\", \"3 um\"] }\n"
    "[objective]\nmaximise = \"mean(modulation)\"\nminimise = \"mean(friction)\"\n"
    "[constraints]\nmin_wall = \"3.5 um\"\n\"worst(modulation)\" = 0.1\n";

TEST(StudyOfTheLibrary, SaysWhatMayChangeAndWhatIsWanted) {
  const papilla::Study study = papilla::Study::parse(kStudy);
  ASSERT_EQ(study.variables().size(), 2u);
  const papilla::Variable &depth = study.variables()[0], &width = study.variables()[1];
  EXPECT_EQ(depth.path + " " + depth.unit, "texture.depth nm");
  EXPECT_NEAR(depth.low, 100e-9, 1e-18);
  EXPECT_NEAR(depth.high, 500e-9, 1e-18);
  EXPECT_TRUE(depth.choices.empty());
  EXPECT_EQ(width.path, "texture.diameter");
  ASSERT_EQ(width.choices.size(), 2u);
  EXPECT_NEAR(width.choices[0], 2e-6, 1e-15);
  ASSERT_EQ(study.objectives().size(), 2u);
  EXPECT_EQ(study.objectives()[0].name, "mean(modulation)");
  EXPECT_TRUE(study.objectives()[0].maximise);
  EXPECT_EQ(study.objectives()[1].name, "mean(friction)");
  EXPECT_FALSE(study.objectives()[1].maximise);
  EXPECT_EQ(study.objectives()[0].unit + "|" + study.objectives()[1].unit, "|N");
  EXPECT_EQ(papilla::si_unit(depth.unit), "m");
  EXPECT_EQ(study.violations(), 1u);
  EXPECT_NEAR(study.own_values()[0], 350e-9, 1e-15);
  EXPECT_NEAR(study.own_values()[1], 3e-6, 1e-15);
  const papilla::Design made = study.design({420e-9, 2e-6});
  EXPECT_NEAR(made.number("texture.depth"), 420e-9, 1e-16);
  EXPECT_NEAR(made.number("texture.diameter"), 2e-6, 1e-15);
  EXPECT_EQ(refusal([] { papilla::Study::read("m3_samples/a3h350.toml"); }),
            "expected a study: it has no [design_space]");
  EXPECT_EQ(refusal([] { papilla::Study::read(""); }),
            "file: expected the name of a file, got an empty text");
  const papilla::Design changed = study.design({420e-9, 3e-6});
  EXPECT_TRUE(changed.title().ends_with("; texture.depth 420 nm")) << changed.title();
}

// What the file says is the study's own, where its space leaves that out too; the rest is of the
// space.
TEST(StudyOfTheLibrary, HasItsOwnValuesBesideItsSpace) {
  const papilla::Study study = papilla::Study::parse(
      "schema_version = 1\nbase = \"m3_samples/a3h350.toml\"\n"
      "surface.contact_angle = \"50 deg\"\n"
      "[design_space]\n\"texture.type\" = { choice = [\"flat\", \"grating\"] }\n"
      "\"texture.depth\" = [\"100 nm\", \"500 nm\"]\n"
      "\"texture.diameter\" = { choice = [\"2 um\", \"4 um\"] }\n"
      "\"surface.contact_angle\" = [\"70 deg\", \"80 deg\"]\n"
      "[objective]\nmaximise = \"mean(modulation)\"\n[constraints]\nmin_wall = \"3.5 um\"\n");
  const double degree = std::numbers::pi / 180;
  std::vector<double> values = study.own_values();
  ASSERT_EQ(values.size(), 4u);
  EXPECT_NEAR(values[2], 3e-6, 1e-15);
  EXPECT_NEAR(values[3], 50 * degree, 1e-12);
  const papilla::Design own = study.design(values);
  const auto kind = [](const papilla::Design& d) { return d.toml().find("type = \"hole_array\""); };
  EXPECT_NE(kind(own), std::string::npos);
  EXPECT_NEAR(own.number("texture.depth"), 350e-9, 1e-16);
  EXPECT_NEAR(own.number("texture.diameter"), 3e-6, 1e-15);
  EXPECT_NEAR(own.number("surface.contact_angle"), 50 * degree, 1e-12);
  values[1] = 420e-9;
  const papilla::Design deeper = study.design(values);
  EXPECT_NE(kind(deeper), std::string::npos);
  EXPECT_NEAR(deeper.number("texture.depth"), 420e-9, 1e-16);
  EXPECT_NEAR(deeper.number("surface.contact_angle"), 50 * degree, 1e-12);
  EXPECT_EQ(study.judge(values).reason, "min_wall 3 um is below 3.5 um");
  values[3] = 51 * degree;
  EXPECT_EQ(refusal([&] { study.design(values); }),
            "surface.contact_angle: 0.890118 is outside 1.22173 to 1.39626");
}

TEST(StudyOfTheLibrary, TakesValuesOfItsSpaceAlone) {
  const papilla::Study study = papilla::Study::parse(kStudy);
  const auto said = [&](const std::vector<double>& values) {
    return refusal([&] { study.design(values); });
  };
  EXPECT_EQ(said({350e-9}), "values: expected one value for each of 2 variables, got 1");
  EXPECT_EQ(said({350e-9, 2e-6, 1}), "values: expected one value for each of 2 variables, got 3");
  EXPECT_EQ(said({100e-9, 2e-6}), "");
  EXPECT_EQ(said({500e-9, 3e-6}), "");
  // Rounding is forgiven, a billionth of the larger bound.
  EXPECT_EQ(said({100e-9 - 4e-16, 2e-6}), "");
  EXPECT_EQ(said({500e-9 + 4e-16, 2e-6}), "");
  EXPECT_EQ(said({100e-9 - 6e-16, 2e-6}), "texture.depth: 1e-07 is outside 1e-07 to 5e-07");
  EXPECT_EQ(said({500e-9 + 6e-16, 2e-6}), "texture.depth: 5e-07 is outside 1e-07 to 5e-07");
  EXPECT_EQ(said({NAN, 2e-6}).substr(0, 14), "texture.depth:");
  // What is no choice is the nearest one.
  EXPECT_NEAR(study.design({350e-9, 2.1e-6}).number("texture.diameter"), 2e-6, 1e-15);
}

// A wall of 3 um at a diameter of 3 um is refused before anything is solved.
TEST(StudyOfTheLibrary, AShapeBeyondItsLimitsIsRefusedAtOnce) {
  const papilla::Judgement j = papilla::Study::parse(kStudy).judge({350e-9, 3e-6});
  EXPECT_FALSE(j.ok);
  EXPECT_EQ(j.reason, "min_wall 3 um is below 3.5 um");
  EXPECT_TRUE(j.values.empty() && j.errors.empty() && j.violations.empty());
}

TEST(StudyOfTheLibrary, JudgesADesignOnEveryGoalAndLimit) {
  const papilla::Study study = papilla::Study::parse(
      std::string(kStudy) + "[environment]\nrelative_humidity = [\"30 %\"]\n");
  const papilla::Judgement j = study.judge({350e-9, 2e-6});
  ASSERT_TRUE(j.ok) << j.reason;
  ASSERT_EQ(j.values.size(), 2u);
  EXPECT_EQ(j.errors.size(), 2u);
  EXPECT_GT(j.values[0], 0);
  EXPECT_GT(j.values[1], 0);
  // At one humidity the worst is the mean: at least 0.1 of it, relative to what there is.
  ASSERT_EQ(j.violations.size(), 1u);
  EXPECT_NEAR(j.violations[0], std::max(-1.0, 0.1 / j.values[0] - 1), 1e-9);
  EXPECT_EQ(study.judge({350e-9, 2e-6}, 1).values, j.values);
}

TEST(StudyOfTheLibrary, JudgesWithModelsOfItsFingersUnlessItIsForced) {
  const papilla::Study study =
      papilla::Study::parse(std::string(kStudy) + "[model]\nrim_pinning = true\n");
  const std::vector<double> beyond{350e-9, 3e-6};  // refused by its wall: nothing is solved
  const std::string said = refusal([&] { study.judge(beyond); });
  EXPECT_NE(said.find("model.rim_pinning is true, the finger"), std::string::npos) << said;
  EXPECT_NE(said.find("or set `force`"), std::string::npos) << said;
  EXPECT_EQ(study.judge(beyond, 0, nullptr, true).reason, "min_wall 3 um is below 3.5 um");
}

// What is minimised is, and the number of judgements is that of the designs.
TEST(SearchOfTheLibrary, MinimisesWhatItsStudyMinimises) {
  const papilla::Study study = papilla::Study::parse(
      "schema_version = 1\nbase = \"m3_samples/a3h350.toml\"\n"
      "[design_space]\n\"texture.depth\" = [\"100 nm\", \"500 nm\"]\n"
      "[objective]\nminimise = \"mean(friction)\"\n[constraints]\n\"worst(friction)\" = \"0.5 N\"\n"
      "[search]\nevaluations = 30\n");
  papilla::Search search(study);
  double best = INFINITY, found = 0;
  for (int step = 0; step < 30; ++step) {
    const auto asked = search.ask();
    EXPECT_EQ(refusal([&] { search.tell(std::vector<papilla::Judgement>(asked.size() + 1)); }),
              "judgements: expected one per design that was asked for");
    std::vector<papilla::Judgement> judgements;
    for (const std::vector<double>& values : asked) {
      // Least at 250 nm, of which only what is beyond 320 nm keeps the limit.
      const double off = (values[0] - 250e-9) / 1e-7, violation = (320e-9 - values[0]) / 1e-7;
      papilla::Judgement judgement;
      judgement.ok = true;
      judgement.values = {off * off};
      judgement.errors = {0};
      judgement.violations = {violation};
      if (violation <= 0 && off * off < best) best = off * off, found = values[0];
      judgements.push_back(judgement);
    }
    if (judgements.empty()) break;
    search.tell(judgements);
  }
  EXPECT_NEAR(found, 320e-9, 10e-9);
}

TEST(SearchOfTheLibrary, IsToldNumbersBeforeItAsksAgain) {
  const papilla::Study study = papilla::Study::parse(
      std::string(kStudy) + "[search]\nmethod = \"nsga2\"\nevaluations = 30\n");
  papilla::Search search(study);
  const std::size_t asked = search.ask().size();
  ASSERT_GT(asked, 0u);
  EXPECT_EQ(refusal([&] { search.ask(); }), "ask: tell() first what the " + std::to_string(asked) +
                                                " designs of the last ask() are worth");
  papilla::Judgement good;
  good.ok = true, good.values = {0.5, 0.1}, good.violations = {-0.1};
  const auto said = [&](const papilla::Judgement& last) {
    std::vector<papilla::Judgement> all(asked, good);
    all.back() = last;
    return refusal([&] { search.tell(all); });
  };
  papilla::Judgement unknown = good, short_of_one = good, unlimited = good;
  unknown.values[0] = NAN;
  short_of_one.values.pop_back();
  unlimited.violations[0] = INFINITY;
  for (const papilla::Judgement& bad : {unknown, short_of_one, unlimited}) {
    EXPECT_EQ(
        said(bad),
        "judgements: expected 2 finite values and 1 violations of a design that is ok; of one "
        "that could not be judged say ok = false");
  }
  EXPECT_EQ(said({false, "too deep", {}, {}, {}}), "");
  EXPECT_EQ(refusal([&] { search.ask(); }), "") << "after it was told";
}

TEST(FilesOfTheLibrary, AreWrittenAndJudgedAgain) {
  const std::string folder = papilla::tests::temporary("exported");
  const papilla::Design design = papilla::Design::parse(kSmall);
  papilla::ExportOptions options;
  options.formats = {"gsf", "mask"};
  options.pixels = 96, options.size = 18e-6;
  EXPECT_EQ(refusal([&] {
              options.polarity = "white";
              papilla::export_files(design, folder, options);
            }),
            "polarity: expected white-high or white-deep, got white");
  options.polarity = "white-deep";
  EXPECT_EQ(refusal([&] {
              papilla::ExportOptions alone = options;
              alone.formats = {"gsf"};
              papilla::export_files(design, folder, alone);
            }),
            "polarity is of tiff, mask, and no such file is written: name one in formats, or leave "
            "polarity out");
  const papilla::Exported made = papilla::export_files(design, folder, options);
  ASSERT_EQ(made.files.size(), 2u);
  EXPECT_EQ(made.files[0], folder + "/heightmap.gsf");
  EXPECT_EQ(made.files[1], folder + "/mask.tif");
  EXPECT_TRUE(made.warnings.empty());
  EXPECT_NEAR(made.heights.nx * made.heights.dx, 18e-6, 1e-12);
  EXPECT_EQ(made.heights.nx, 96);
  const auto verdicts = papilla::verify(folder, {.geometry = true});
  ASSERT_EQ(verdicts.size(), 1u);
  EXPECT_EQ(verdicts[0].folder, folder);
  EXPECT_FALSE(verdicts[0].felt);
  EXPECT_TRUE(verdicts[0].sound());
  ASSERT_EQ(verdicts[0].files.size(), 2u);
  EXPECT_TRUE(verdicts[0].files[0].sound && verdicts[0].files[1].sound);
  // The other polarity is another file.
  options.polarity = "white-high";
  const std::string other = papilla::tests::temporary("high");
  papilla::export_files(design, other, options);
  std::filesystem::copy_file(other + "/mask.tif", folder + "/mask.tif",
                             std::filesystem::copy_options::overwrite_existing);
  const papilla::FolderVerdict spoiled = papilla::verify(folder, {.geometry = true})[0];
  EXPECT_FALSE(spoiled.sound());
  EXPECT_TRUE(spoiled.files[0].sound);
  EXPECT_FALSE(spoiled.files[1].sound);
  EXPECT_FALSE(spoiled.files[1].faults.empty());
  // A folder is sound where all its files are, and nothing is felt that should not be.
  papilla::FolderVerdict felt;
  felt.verdict.faults = {"a loss"};
  EXPECT_TRUE(felt.sound());
  felt.felt = true;
  EXPECT_FALSE(felt.sound());
  felt.verdict.faults.clear();
  EXPECT_TRUE(felt.sound());
}

TEST(FilesOfTheLibrary, AreOfTheSizesThatTheCommandTakes) {
  const papilla::Design design = papilla::Design::parse(kSmall);
  const std::string folder = papilla::tests::temporary("of_sizes");
  const auto said = [&](double size, int pixels) {
    papilla::ExportOptions options;
    options.formats = {"gsf"}, options.size = size, options.pixels = pixels;
    return refusal([&] { papilla::export_files(design, folder, options); });
  };
  const std::string size = "size: expected a width of at most 1 m, or 0 for about 12 um";
  for (const double wrong : {-1e-6, 1.01, HUGE_VAL, std::nan("")}) EXPECT_EQ(said(wrong, 96), size);
  EXPECT_EQ(said(0, 7), "pixels: expected 8 to 65536, got 7");
  EXPECT_EQ(said(0, 65537), "pixels: expected 8 to 65536, got 65537");
  // A tolerance that is no number is kept by every loss.
  EXPECT_EQ(refusal([&] { papilla::verify(folder, {.tolerance = std::nan("")}); }),
            "tolerance: expected a share from 0 to 1, got nan");
}

// What a warning says is in arguments: `pixels 18 would do`.
TEST(FilesOfTheLibrary, AreWarnedOfInArguments) {
  papilla::ExportOptions options;
  options.formats = {"gsf"}, options.pixels = 8, options.size = 60e-6;
  const papilla::Exported coarse = papilla::export_files(
      papilla::Design::parse(kSmall), papilla::tests::temporary("coarse"), options);
  ASSERT_FALSE(coarse.warnings.empty());
  for (const std::string& warning : coarse.warnings)
    EXPECT_EQ(warning.find(" --"), std::string::npos) << warning;
}

// The heights of a design from an array lie in a file that goes with the design.
TEST(FilesOfTheLibrary, OfDrawnHeightsAreJudgedWithoutTheDesign) {
  const std::string made = papilla::tests::temporary("drawn_made"),
                    folder = papilla::tests::temporary("drawn_moved");
  std::filesystem::remove_all(made);
  std::filesystem::remove_all(folder);
  papilla::ExportOptions options;
  options.formats = {"npy", "gsf"}, options.pixels = 32;
  {
    papilla::Heights h{16, 16, 0.75e-6, 0.75e-6, std::vector<double>(256, 0.0)};
    for (std::size_t i = 0; i < h.z.size(); i += 5) h.z[i] = -1e-7;
    const papilla::Design design =
        papilla::Design::from_heights(h, {{"base", "m3_samples/flat.toml"}});
    papilla::export_files(design, made, options);
  }
  std::filesystem::rename(made, folder);
  const auto verdicts = papilla::verify(folder, {.geometry = true});
  ASSERT_EQ(verdicts.size(), 1u);
  EXPECT_EQ(verdicts[0].files.size(), 2u);
  EXPECT_TRUE(verdicts[0].sound());
}

TEST(RankingOfTheLibrary, IsItsDocumentInNumbers) {
  const papilla::Design flat = papilla::Design::parse(
      "schema_version = 1\nbase = \"m3_samples/flat.toml\"\n[accuracy]\nlevel = \"draft\"\n"
      "grid = 32\n[environment]\nrelative_humidity = [\"30 %\"]\n");
  const papilla::Design angled = flat.with("surface.contact_angle", "80 deg");
  papilla::RankOptions options;
  options.by = "friction:low", options.max_skins = 6, options.names = {"one", "two"};
  options.states = "wet";
  const papilla::Ranking r = papilla::api::rank({flat, angled}, options);
  const Json json = Json::parse(r.json);
  ASSERT_EQ(r.states.size(), 1u);
  EXPECT_EQ(json["states"][0]["state"], "wet");
  ASSERT_EQ(r.states[0].size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const papilla::Ranked& one = r.states[0][i];
    const Json& of = json["states"][0]["candidates"][i];
    EXPECT_EQ(of["index"], one.index);
    EXPECT_EQ(of["rank"], one.rank);
    EXPECT_EQ(of["name"], options.names[one.index]);
    EXPECT_EQ(of["p_best"].get<double>(), one.p_best);
    EXPECT_EQ(of["score"]["value"].get<double>(), one.score);
    EXPECT_EQ(of["score"]["low"].get<double>(), one.low);
    EXPECT_EQ(of["score"]["high"].get<double>(), one.high);
    ASSERT_EQ(one.p_best_by.size(), 1u);
    EXPECT_EQ(of["p_best_by"]["mean(friction)"].get<double>(), one.p_best_by[0]);
  }
  EXPECT_NE(r.table.find("one"), std::string::npos);
  EXPECT_EQ(refusal([&] { papilla::api::rank({flat}, options); }), "name two designs at least");
  options.states.clear();
  const papilla::Design natural = flat.with("finger.state", "natural"),
                        wet = angled.with("finger.state", "wet");
  EXPECT_EQ(refusal([&] {
              papilla::api::rank({natural, wet}, options);
            }).substr(0, 52),
            "the designs' fingers are in different states (finger");
  options.states = "dry";
  EXPECT_EQ(refusal([&] {
              papilla::api::rank({flat, angled}, options);
            }).substr(0, 24),
            "states: expected some of");
}

TEST(RankingOfTheLibrary, RefusesWhatFitsNoDesigns) {
  const papilla::Design flat =
      papilla::Design::parse("schema_version = 1\nbase = \"m3_samples/flat.toml\"\n");
  const auto said = [&](const papilla::RankOptions& options, std::size_t count = 2) {
    return refusal([&] { papilla::api::rank(std::vector<papilla::Design>(count, flat), options); });
  };
  papilla::RankOptions options;
  EXPECT_EQ(said(options, 1), "name two designs at least");
  options.names = {"one"};
  EXPECT_EQ(said(options), "names: expected one for each of 2 designs, got 1");
  options.names = {"one", "two"}, options.max_skins = 0;
  EXPECT_EQ(said(options),
            "max_skins: expected 6, the first step of every design, to 100000, got 0");
  options.max_skins = 6, options.threads = -1;
  EXPECT_EQ(said(options), "threads: expected 0, all processors, to 4096, got -1");
}

TEST(RankingOfTheLibrary, IsOfModelsOfItsFingersUnlessItIsForced) {
  const papilla::Design flat = papilla::Design::parse(
      "schema_version = 1\nbase = \"m3_samples/flat.toml\"\n[model]\nrim_pinning = true\n");
  const papilla::Design dry = flat.with("environment.relative_humidity", "[\"30 %\"]");
  papilla::RankOptions options;
  const auto said = [&] { return refusal([&] { papilla::api::rank({flat, dry}, options); }); };
  EXPECT_NE(said().find("model.rim_pinning is true, the finger"), std::string::npos) << said();
  options.force = true;  // and is refused for what comes after that
  EXPECT_NE(said().find("not judged under the same conditions"), std::string::npos) << said();
}

// Two designs of one title would stand in messages and tables as one.
TEST(RankingOfTheLibrary, NumbersTitlesThatAreAlike) {
  const papilla::Design flat =
      papilla::Design::parse("schema_version = 1\nbase = \"m3_samples/flat.toml\"\n");
  const papilla::Design dry = flat.with("environment.relative_humidity", "[\"30 %\"]");
  ASSERT_EQ(dry.title(), flat.title());
  const auto said = [](const papilla::Design& first, const papilla::Design& second) {
    return refusal([&] { papilla::api::rank({first, second}); });
  };
  const std::string alike = said(flat, dry), untitled = said(flat, dry.with("title", "\"\""));
  EXPECT_NE(alike.find(" in " + flat.title() + " (1), "), std::string::npos) << alike;
  EXPECT_NE(alike.find(" in " + flat.title() + " (2)\n"), std::string::npos) << alike;
  EXPECT_NE(untitled.find(" in " + flat.title() + ", "), std::string::npos) << untitled;
  EXPECT_NE(untitled.find(" in design 2\n"), std::string::npos) << untitled;
  // The first number is another's title.
  const std::string taken = refusal([&] {
    papilla::api::rank({flat.with("title", "\"" + flat.title() + " (1)\""), flat, dry});
  });
  EXPECT_NE(taken.find(flat.title() + " (1)"), std::string::npos) << taken;
  EXPECT_NE(taken.find(flat.title() + " (3)"), std::string::npos) << taken;
}

TEST(UnitsOfTheLibrary, AreReadAndWritten) {
  EXPECT_EQ(papilla::quantity_text(3.5e-7, "nm"), "350 nm");
  EXPECT_EQ(papilla::quantity_text(1.5e-6, "um"), "1.5 um");
  EXPECT_EQ(papilla::in_si("1.5 um", "nm"), 1.5e-6);
  EXPECT_EQ(refusal([] { papilla::quantity_text(1, "furlong"); }),
            "unit: no unit \"furlong\" is known");
  EXPECT_NE(refusal([] { papilla::in_si("3 V", "um"); }), "");
}

}  // namespace
