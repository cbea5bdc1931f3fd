#include "report/schema.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "base/text.h"
#include "base/units.h"
#include "config/describe.h"
#include "design/study.h"
#include "metrics/metrics.h"
#include "optim/search.h"
#include "report/json.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kNumber = "[-+]?([0-9]+\\.?[0-9]*|\\.[0-9]+)([eE][-+]?[0-9]+)?";

std::string regex_escaped(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (std::string_view(".^$|()[]{}*+?\\").find(c) != std::string_view::npos) out += '\\';
    out += c;
  }
  return out;
}

// Units that mean the same: all names of one factor; of several any words, which the reader judges.
std::string unit_pattern(const std::string& unit) {
  std::vector<std::string> names;
  for (const std::string& name : unit_names(*find_unit(unit))) names.push_back(regex_escaped(name));
  if (names.empty()) return "[^0-9\\s].*";
  return fmt::format("({})", join_names(names, "|"));
}

// A number as files write it: with a unit in a text, bare where it has none.
Json quantity(const std::string& unit, double low, double high) {
  if (unit.empty()) {
    return {{"anyOf",
             {{{"type", "number"}, {"minimum", low}, {"maximum", high}},
              {{"type", "string"}, {"pattern", fmt::format("^\\s*{}\\s*%?\\s*$", kNumber)}}}}};
  }
  return {{"type", "string"},
          {"pattern", fmt::format("^\\s*{}\\s*{}\\s*$", kNumber, unit_pattern(unit))}};
}

Json object(Json properties) {
  return {
      {"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
}

// A text, or a list of one.
Json one_text() {
  const Json text{{"type", "string"}};
  return {{"anyOf", {text, {{"type", "array"}, {"items", text}, {"maxItems", 1}}}}};
}

// Collects the properties of the struct that it visits.
class SchemaVisitor final : public FieldVisitor {
 public:
  // texture: the kind of every `type` that it meets.
  explicit SchemaVisitor(int texture = 0) : texture_(texture) {}

  Json properties() { return std::move(levels_.back()); }

  void number(const NumberSpec& spec, double&) override {
    put(spec.key, spec.doc, quantity(spec.unit, spec.low, spec.high));
  }
  void numbers(const NumberSpec& spec, std::vector<double>&) override {
    put(spec.key, spec.doc,
        {{"type", "array"}, {"items", quantity(spec.unit, spec.low, spec.high)}});
  }
  void integer(const FieldSpec& spec, int low, int high, int&) override {
    put(spec.key, spec.doc, {{"type", "integer"}, {"minimum", low}, {"maximum", high}});
  }
  void flag(const FieldSpec& spec, bool&) override {
    put(spec.key, spec.doc, {{"type", "boolean"}});
  }
  void text(const FieldSpec& spec, std::string&) override {
    put(spec.key, spec.doc, {{"type", "string"}});
  }
  void path(const FieldSpec& spec, std::string&) override {
    put(spec.key, spec.doc, {{"type", "string"}});
  }
  void choice(const FieldSpec& spec, const std::vector<std::string>& names, int& value) override {
    if (names == texture_kinds()) {
      value = texture_;
      put(spec.key, spec.doc, {{"const", names[static_cast<std::size_t>(texture_)]}});
    } else {
      put(spec.key, spec.doc, {{"enum", names}});
    }
  }
  using FieldVisitor::choice;

 protected:
  bool begin_section(const FieldSpec& spec) override {
    open_.push_back(spec);
    levels_.push_back(Json::object());
    return std::string(spec.key) != "texture";
  }
  void end_section() override {
    const FieldSpec spec = open_.back();
    Json inside = std::move(levels_.back());
    open_.pop_back();
    levels_.pop_back();
    if (std::string(spec.key) == "texture") {  // one of several kinds, each with keys of its own
      put(spec.key, spec.doc, {{"$ref", "#/$defs/texture"}});
      return;
    }
    inside["base"] = {{"type", "string"}};
    put(spec.key, spec.doc, object(std::move(inside)));
  }
  // One item stands for all of a list.
  int begin_list(const FieldSpec& spec, int, bool& replace) override {
    open_.push_back(spec);
    levels_.push_back(Json::object());
    textures_ = std::string(spec.key) == "parts";
    replace = !textures_;
    return textures_ ? 0 : 1;
  }
  bool begin_item(int) override { return true; }
  void end_item() override {}
  void end_list() override {
    const FieldSpec spec = open_.back();
    Json items = textures_ ? Json{{"$ref", "#/$defs/texture"}} : object(std::move(levels_.back()));
    open_.pop_back();
    levels_.pop_back();
    textures_ = false;
    put(spec.key, spec.doc, {{"type", "array"}, {"items", std::move(items)}});
  }

 private:
  void put(const char* key, const char* doc, Json schema) {
    if (*doc) schema["description"] = doc;
    levels_.back()[key] = std::move(schema);
  }

  int texture_;
  bool textures_ = false;  // the list that is open is of textures
  std::vector<FieldSpec> open_;
  std::vector<Json> levels_{Json::object()};
};

template <class S>
Json properties_of(S s, int texture = 0) {
  SchemaVisitor visitor(texture);
  fields(visitor, s);
  return visitor.properties();
}

// Each kind has its keys; without a `type`, which a base may give, any of them.
Json texture_schema() {
  Json kinds = Json::array(), any = Json::object();
  const std::vector<std::string>& names = texture_kinds();
  for (std::size_t k = 0; k < names.size(); ++k) {
    Json properties = properties_of(Texture{}, static_cast<int>(k));
    properties["base"] = {{"type", "string"}};
    for (const auto& [key, schema] : properties.items()) {
      if (key == "type") continue;
      if (!any.contains(key)) any[key] = {{"anyOf", Json::array()}};
      any[key]["anyOf"].push_back(schema);
    }
    Json kind = object(std::move(properties));
    kind["required"] = {"type"};
    kinds.push_back(std::move(kind));
  }
  Json untyped = object(std::move(any));
  untyped["not"] = {{"required", {"type"}}};
  kinds.push_back(std::move(untyped));
  return {{"anyOf", std::move(kinds)}};
}

// The paths of numbers, as scatter and scenarios name them; built: as design_space does.
std::string path_pattern(bool built) {
  std::vector<std::string> paths;
  for (std::size_t k = 0; k < texture_kinds().size(); ++k) {
    Design d;
    d.texture = default_texture(k);
    for (const NumberField& field : number_fields(d)) {
      if (built && !is_built(field.path)) continue;
      std::string path;
      for (const std::string& part : split(field.path, '.')) {
        const bool index = part.find_first_not_of("0123456789") == std::string::npos;
        path += (path.empty() ? "" : "\\.") + (index ? std::string("[0-9]+") : part);
      }
      if (std::find(paths.begin(), paths.end(), path) == paths.end()) paths.push_back(path);
    }
  }
  paths.push_back("texture\\.type");
  paths.push_back("texture\\.levels");
  paths.push_back("texture\\.parts\\.[0-9]+\\.[a-z_]+");
  // A section may stand for the beginning of a path: texture.depth without quotes.
  for (const char* section : {"texture", "surface", "view", "finger", "counterface", "environment",
                              "drive", "model", "accuracy"}) {
    if (!built || is_built(section)) paths.push_back(section);
  }
  return fmt::format("^({})$", join_names(paths, "|"));
}

Json by_path(Json value, bool built = false) {
  return {{"type", "object"},
          {"propertyNames", {{"pattern", path_pattern(built)}}},
          {"additionalProperties", {{"anyOf", {std::move(value), {{"type", "object"}}}}}}};
}

std::string metric_pattern() {
  std::vector<std::string> names, with_modulation;
  for (const MetricInfo& m : metric_list()) {
    names.push_back(regex_escaped(m.name));
    if (m.takes_modulation) with_modulation.push_back(m.name);
  }
  return fmt::format(
      "((mean|variation|range|std|worst|best|first|last)\\()?\\s*(pen\\.)?({}|({})\\(.*\\))\\s*\\)"
      "?",
      join_names(names, "|"), join_names(with_modulation, "|"));
}

Json constraints_schema() {
  Json known = Json::object();
  for (const ConstraintKind& kind : constraint_kinds()) {
    known[kind.name] = quantity(kind.unit, 0, 1e9);
    known[kind.name]["description"] = kind.doc;
  }
  Json out = object(std::move(known));
  out["patternProperties"] = {
      {fmt::format("^{}$", metric_pattern()), {{"type", {"string", "number"}}}}};
  return out;
}

// By path a tolerance, of normal ones its standard deviation; and what goes together.
Json scatter_schema(const Json& value) {
  Json sigma = object({{"sigma", value}});
  sigma["required"] = {"sigma"};
  const Json paths{
      {"type", "array"}, {"items", {{"type", "string"}}}, {"minItems", 2}, {"maxItems", 2}};
  Json pair = object({{"between", paths}, {"value", quantity("", -1, 1)}});
  pair["required"] = {"between", "value"};
  Json out = by_path({{"anyOf", {value, sigma}}});
  out["properties"] = {{"correlation", {{"type", "array"}, {"items", std::move(pair)}}}};
  out["propertyNames"] = {{"anyOf", {out["propertyNames"], {{"const", "correlation"}}}}};
  return out;
}

// The sections that only a study has.
Json study_sections() {
  const Json value{{"type", {"string", "number"}}};
  const Json choice{{"type", "object"},
                    {"properties", {{"choice", {{"type", "array"}, {"minItems", 1}}}}},
                    {"required", {"choice"}},
                    {"additionalProperties", false}};
  const Json interval{{"type", "array"}, {"items", value}, {"minItems", 2}, {"maxItems", 2}};
  const Json gapped{
      {"type", "object"},
      {"properties", {{"range", interval}, {"exclude", {{"type", "array"}, {"items", interval}}}}},
      {"required", {"range"}},
      {"additionalProperties", false}};
  const Json metric{{"type", "string"}, {"pattern", fmt::format("^\\s*{}\\s*$", metric_pattern())}};
  // An empty list takes away what a base wishes for.
  const Json metrics{{"anyOf", {metric, {{"type", "array"}, {"items", metric}}}}};
  Json scenario = object(
      {{"name", {{"type", "string"}}}, {"weight", quantity("", 0, 1e6)}, {"set", by_path(value)}});
  scenario["required"] = {"name"};
  Json fingers = object(
      {{"fingers", {{"type", "array"}, {"items", {{"type", "string"}}}, {"minItems", 1}}},
       {"shared",
        {{"type", "array"},
         {"items", {{"type", "string"}, {"enum", {"load", "state", "touch_time", "belief"}}}}}}});
  fingers["required"] = {"fingers"};
  return {{"design_space", by_path({{"anyOf", {interval, choice, gapped}}}, true)},
          {"objective", object({{"maximise", metrics},
                                {"minimise", metrics},
                                {"target", {{"type", "object"}, {"additionalProperties", value}}},
                                {"risk", one_text()}})},
          {"constraints", constraints_schema()},
          {"population", std::move(fingers)},
          {"scenarios", {{"type", "array"}, {"items", std::move(scenario)}}},
          {"scatter", scatter_schema(value)},
          {"risk", object(properties_of(StudyRisk{}))},
          {"search", object(properties_of(Search{}))}};
}

}  // namespace

std::string json_schema() {
  Json properties = properties_of(Design{});
  properties["base"] = {{"type", "string"}, {"description", "another file below this one"}};
  const Json sections = study_sections();
  for (const auto& [key, schema] : sections.items()) properties[key] = schema;
  return Json{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "Papilla designs and studies"},
              {"type", "object"},
              {"properties", std::move(properties)},
              {"required", {"schema_version"}},
              {"additionalProperties", false},
              {"$defs", {{"texture", texture_schema()}}}}
      .dump(2);
}

}  // namespace papilla::report
