// The JSON Schema of designs and studies, part by part: what each pattern takes and what it
// refuses. Whole files are judged by it in schema_slow_test.cpp.
#include "report/schema.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <regex>
#include <string>
#include <vector>

#include "geometry/texture.h"
#include "tests/report/same_json.h"

namespace papilla::tests::schema_test {
namespace {

using Json = nlohmann::json;
using Texts = std::vector<std::string>;

const Json& schema() {
  static const Json all = Json::parse(json_schema());
  return all;
}

const Json& property(const char* section, const char* key) {
  return schema().at("properties").at(section).at("properties").at(key);
}

void expect_pattern(const Json& part, const Texts& taken, const Texts& refused) {
  const std::regex pattern(part.at("pattern").get<std::string>());
  for (const std::string& text : taken) EXPECT_TRUE(std::regex_search(text, pattern)) << text;
  for (const std::string& text : refused) EXPECT_FALSE(std::regex_search(text, pattern)) << text;
}

TEST(JsonSchema, HasEverySectionAndNoOther) {
  Json frame = schema();
  Texts sections;
  for (const auto& [name, part] : frame["properties"].items()) {
    sections.push_back(name);
    if (part.contains("properties") && !part.contains("propertyNames")) {
      EXPECT_EQ(part["additionalProperties"], false) << name;
      EXPECT_EQ(part["type"], "object") << name;
    }
  }
  EXPECT_EQ(sections,
            (Texts{"accuracy",   "base",        "constraints", "counterface", "design_space",
                   "drive",      "environment", "finger",      "model",       "objective",
                   "population", "risk",        "scatter",     "scenarios",   "schema_version",
                   "search",     "surface",     "texture",     "title",       "view"}));
  frame.erase("properties"), frame.erase("$defs");
  EXPECT_EQ(frame, (Json{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                         {"title", "Papilla designs and studies"},
                         {"type", "object"},
                         {"required", {"schema_version"}},
                         {"additionalProperties", false}}));
  EXPECT_EQ(schema()["properties"]["base"],
            (Json{{"type", "string"}, {"description", "another file below this one"}}));
}

TEST(JsonSchema, AQuantityHasAUnitOfItsDimensionAloneOrNone) {
  const Json& rounding = property("search", "rounding");
  EXPECT_EQ(rounding["type"], "string");
  EXPECT_EQ(rounding["description"],
            "grid of the fab: the best design is judged again with its periods and widths on it, "
            "other lengths on finer steps; 0: not");
  expect_pattern(rounding, {"10 nm", "10nm", " 1e-2 um ", "+.5 µm", "3. mm", "-4.25E+3 pm", "0 m"},
                 {"10", "10 V", "nm", "1 2 nm", "10 nm 3", "e3 nm", ". nm", "10 min", "1,5 nm"});
  expect_pattern(property("drive", "amplitude"), {"100 V", "0.1 kV"}, {"100", "100 N"});
  expect_pattern(property("search", "time"), {"5 min", "1 h", "300 s", "2 ms"}, {"5", "5 m"});
  // A unit of several factors is any word: the reader judges it.
  expect_pattern(property("finger", "water")["properties"]["surface_tension"],
                 {"72 mN/m", "0.07 N/m"}, {"72", "72 5"});
  // Bare numbers have their range; the same in a text may be a share.
  const Json& permeable = property("surface", "refractive_index");
  ASSERT_EQ(permeable["anyOf"].size(), 2u);
  EXPECT_EQ(permeable["anyOf"][0], (Json{{"type", "number"}, {"minimum", 1.0}, {"maximum", 5.0}}));
  EXPECT_EQ(permeable["anyOf"][1]["type"], "string");
  expect_pattern(permeable["anyOf"][1], {"1.5", "150 %", " 15%"}, {"1.5 um", "", "% 3"});
}

TEST(JsonSchema, OtherValuesAreOfTheirType) {
  Json seed = property("search", "seed");
  EXPECT_EQ(seed, (Json{{"type", "integer"},
                        {"minimum", 0},
                        {"maximum", 1073741824},
                        {"description", "of the search's random numbers"}}));
  EXPECT_EQ(property("accuracy", "parameters")["type"], "boolean");
  EXPECT_EQ(schema()["properties"]["title"]["type"], "string");
  EXPECT_EQ(property("accuracy", "level")["enum"], (Json{"draft", "design", "reference"}));
  const Json& humidity = property("environment", "relative_humidity");
  EXPECT_EQ(humidity["type"], "array");
  expect_pattern(humidity["items"], {"15 %", "15%"}, {"0.15", "15 um"});
  const Json& layers = property("surface", "dielectric");
  EXPECT_EQ(layers["type"], "array");
  EXPECT_EQ(layers["items"]["type"], "object");
  EXPECT_EQ(layers["items"]["additionalProperties"], false);
  expect_pattern(layers["items"]["properties"]["thickness"], {"500 nm"}, {"500"});
  // Sections take a file below them, the file itself too.
  for (const char* section : {"surface", "finger", "drive"})
    EXPECT_EQ(property(section, "base"), (Json{{"type", "string"}})) << section;
  EXPECT_FALSE(schema()["properties"]["search"]["properties"].contains("base"));
}

TEST(JsonSchema, ATextureHasTheKeysOfItsKindAlone) {
  EXPECT_EQ(schema()["properties"]["texture"]["$ref"], "#/$defs/texture");
  const Json& kinds = schema()["$defs"]["texture"]["anyOf"];
  const std::vector<std::string>& names = texture_kinds();
  ASSERT_EQ(kinds.size(), names.size() + 1);
  for (std::size_t k = 0; k < names.size(); ++k) {
    EXPECT_EQ(kinds[k]["properties"]["type"]["const"], names[k]);
    EXPECT_EQ(kinds[k]["required"], Json{"type"});
    EXPECT_EQ(kinds[k]["additionalProperties"], false);
    EXPECT_EQ(kinds[k]["properties"]["base"], (Json{{"type", "string"}}));
    EXPECT_FALSE(kinds[k].contains("not"));
  }
  EXPECT_TRUE(kinds[1]["properties"].contains("diameter"));
  EXPECT_FALSE(kinds[0]["properties"].contains("diameter"));
  // Without a type any key of any kind, by the schema of each kind that has it.
  const Json& untyped = kinds.back();
  EXPECT_EQ(untyped["not"], (Json{{"required", {"type"}}}));
  EXPECT_FALSE(untyped["properties"].contains("type"));
  EXPECT_FALSE(untyped.contains("required"));
  std::size_t with_diameter = 0;
  Json first;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (!kinds[k]["properties"].contains("diameter")) continue;
    if (with_diameter == 0) first = kinds[k]["properties"]["diameter"];
    ++with_diameter;
  }
  EXPECT_GT(with_diameter, 0u);
  EXPECT_EQ(untyped["properties"]["diameter"]["anyOf"].size(), with_diameter);
  EXPECT_EQ(untyped["properties"]["diameter"]["anyOf"][0], first);
  EXPECT_EQ(untyped["properties"]["base"]["anyOf"].size(), names.size());
  // The parts of a stack are textures.
  const Json& parts = untyped["properties"]["parts"]["anyOf"][0];
  EXPECT_EQ(parts["type"], "array");
  EXPECT_EQ(parts["items"], (Json{{"$ref", "#/$defs/texture"}}));
}

TEST(JsonSchema, PathsAreThoseOfNumbersAndTheirBeginnings) {
  const Json& space = schema()["properties"]["design_space"];
  EXPECT_EQ(space["type"], "object");
  expect_pattern(
      space["propertyNames"],
      {"texture.depth", "texture.type", "texture.levels", "texture.parts.0.depth",
       "texture.parts.12.no_such", "surface.dielectric.0.thickness",
       "surface.dielectric.15.permittivity", "surface.contact_angle", "texture", "surface", "view",
       "view.fill_index", "counterface", "drive"},
      {"view.cone", "view.panel.gap", "finger.load", "finger", "environment", "model.droplet_step",
       "model", "accuracy", "texture.depht", "texturexdepth", "depth", "texture.depth.x",
       "atexture.depth", "surface.dielectric.x.thickness", "search", "texture.parts.depth", ""});
  const Json value{{"type", {"string", "number"}}};
  const Json interval{{"type", "array"}, {"items", value}, {"minItems", 2}, {"maxItems", 2}};
  const Json choice{{"type", "object"},
                    {"properties", {{"choice", {{"type", "array"}, {"minItems", 1}}}}},
                    {"required", {"choice"}},
                    {"additionalProperties", false}};
  const Json gapped{
      {"type", "object"},
      {"properties", {{"range", interval}, {"exclude", {{"type", "array"}, {"items", interval}}}}},
      {"required", {"range"}},
      {"additionalProperties", false}};
  const Json any_of_them{{"anyOf", Json::array({interval, choice, gapped})}};
  const Json section{{"type", "object"}};
  EXPECT_EQ(space["additionalProperties"], (Json{{"anyOf", Json::array({any_of_them, section})}}));
  const Json& scatter = schema()["properties"]["scatter"];
  const Json sigma{{"type", "object"},
                   {"properties", {{"sigma", value}}},
                   {"additionalProperties", false},
                   {"required", {"sigma"}}};
  const Json tolerance{{"anyOf", Json::array({value, sigma})}};
  EXPECT_EQ(scatter["additionalProperties"], (Json{{"anyOf", Json::array({tolerance, section})}}));
  EXPECT_EQ(scatter["propertyNames"],
            (Json{{"anyOf", Json::array({schema()["properties"]["scenarios"]["items"]["properties"]
                                                 ["set"]["propertyNames"],
                                         {{"const", "correlation"}}})}}));
  EXPECT_EQ(scatter["properties"]["correlation"]["items"]["required"], (Json{"between", "value"}));
}

TEST(JsonSchema, WishesAreMetricsOverHumidity) {
  const Json& maximise = property("objective", "maximise");
  ASSERT_EQ(maximise["anyOf"].size(), 2u);
  EXPECT_EQ(maximise["anyOf"][1]["type"], "array");
  EXPECT_EQ(maximise["anyOf"][1]["items"], maximise["anyOf"][0]);
  EXPECT_FALSE(maximise["anyOf"][1].contains("minItems"));
  expect_pattern(
      maximise["anyOf"][0],
      {"modulation", "mean(modulation)", "worst( friction_on )", " std(haze) ", "drive.amplitude",
       "voltage_for(modulation = 0.5)", "felt(modulation = 0.2)", "mean(felt(modulation = 0.2))"},
      {"modulations", "median(modulation)", "", "drivexamplitude", "felts"});
  EXPECT_EQ(property("objective", "minimise"), maximise);
  EXPECT_EQ(property("objective", "target"),
            (Json{{"type", "object"}, {"additionalProperties", {{"type", {"string", "number"}}}}}));
  EXPECT_EQ(property("objective", "risk"),
            (Json{{"anyOf",
                   {{{"type", "string"}},
                    {{"type", "array"}, {"items", {{"type", "string"}}}, {"maxItems", 1}}}}}));
}

TEST(JsonSchema, ConstraintsHaveTheirUnitsOrAreOfMetrics) {
  const Json& hole = property("constraints", "min_hole");
  EXPECT_EQ(
      hole["description"],
      "smallest hole or gap between features, at its floor; of gradual profiles at half the depth");
  expect_pattern(hole, {"0.4 um"}, {"0.4", "0.4 V"});
  EXPECT_EQ(property("constraints", "aspect_ratio")["anyOf"][0],
            (Json{{"type", "number"}, {"minimum", 0.0}, {"maximum", 1e9}}));
  const Json& metrics = schema()["properties"]["constraints"]["patternProperties"];
  ASSERT_EQ(metrics.size(), 1u);
  expect_pattern({{"pattern", metrics.begin().key()}}, {"worst(modulation)", "mean(friction)"},
                 {"xworst(modulation)", "worst(modulation) at least"});
  EXPECT_EQ(metrics.begin().value(), (Json{{"type", {"string", "number"}}}));
}

TEST(JsonSchema, FingersAndScenariosAreLists) {
  EXPECT_EQ(
      schema()["properties"]["population"],
      (Json{{"type", "object"},
            {"properties",
             {{"fingers", {{"type", "array"}, {"items", {{"type", "string"}}}, {"minItems", 1}}},
              {"shared",
               {{"type", "array"},
                {"items",
                 {{"type", "string"}, {"enum", {"load", "state", "touch_time", "belief"}}}}}}}},
            {"additionalProperties", false},
            {"required", {"fingers"}}}));
  const Json& scenarios = schema()["properties"]["scenarios"];
  EXPECT_EQ(scenarios["type"], "array");
  const Json& one = scenarios["items"];
  EXPECT_EQ(one["required"], Json{"name"});
  EXPECT_EQ(one["additionalProperties"], false);
  EXPECT_EQ(one["properties"]["name"], (Json{{"type", "string"}}));
  EXPECT_EQ(one["properties"]["weight"]["anyOf"][0],
            (Json{{"type", "number"}, {"minimum", 0.0}, {"maximum", 1e6}}));
  const Json& set = one["properties"]["set"];
  expect_pattern(set["propertyNames"], {"texture.depth", "finger.load", "finger", "drive"},
                 {"search", "texture.depht"});
  EXPECT_EQ(set["additionalProperties"]["anyOf"][0], (Json{{"type", {"string", "number"}}}));
}

}  // namespace
}  // namespace papilla::tests::schema_test
