#include "studio/form.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "config/describe.h"
#include "config/node.h"
#include "config/writer.h"
#include "geometry/texture.h"
#include "report/json.h"

namespace papilla::studio {
namespace {

using Json = nlohmann::ordered_json;

class FormCollector final : public PathVisitor {
 public:
  FormCollector() : PathVisitor("") {}

  std::vector<FormKey> keys;

  void number(const NumberSpec& spec, double& si) override {
    FormKey& key = add(spec, KeyType::Number);
    key.unit = spec.unit;
    key.value = quantity(si, spec.unit);
    key.shown = si / find_unit(spec.unit)->to_si;
    key.low = spec.low;
    key.high = spec.high;
  }
  void numbers(const NumberSpec& spec, std::vector<double>& si) override {
    FormKey& key = add(spec, KeyType::Numbers);
    key.unit = spec.unit;
    std::vector<std::string> texts;
    for (const double v : si) texts.push_back(quantity(v, spec.unit));
    key.value = join_names(texts, ", ");
  }
  void integer(const FieldSpec& spec, int low, int high, int& value) override {
    FormKey& key = add(spec, KeyType::Integer);
    key.shown = value;
    key.low = low;
    key.high = high;
    key.value = std::to_string(value);
  }
  void flag(const FieldSpec& spec, bool& value) override {
    add(spec, KeyType::Flag).value = value ? "true" : "false";
  }
  void text(const FieldSpec& spec, std::string& value) override {
    add(spec, KeyType::Text).value = value;
  }
  void path(const FieldSpec& spec, std::string& value) override {
    add(spec, KeyType::Path).value = value;
  }
  void choice(const FieldSpec& spec, const std::vector<std::string>& names, int& value) override {
    FormKey& key = add(spec, KeyType::Choice);
    key.choices = names;
    key.value = names.at(static_cast<std::size_t>(value));
  }
  using FieldVisitor::choice;

 private:
  static std::string quantity(double si, const char* unit) {
    return *unit ? format_quantity(si, unit) : format_number(si);
  }
  template <class Spec>
  FormKey& add(const Spec& spec, KeyType type) {
    FormKey& key = keys.emplace_back();
    key.path = join(spec.key);
    key.type = type;
    key.doc = spec.doc;
    key.source = source_name(spec.source);
    key.reference = spec.reference;
    return key;
  }
};

const char* type_name(KeyType type) {
  switch (type) {
    case KeyType::Number:
      return "number";
    case KeyType::Numbers:
      return "numbers";
    case KeyType::Integer:
      return "integer";
    case KeyType::Flag:
      return "flag";
    case KeyType::Choice:
      return "choice";
    case KeyType::Text:
      return "text";
    case KeyType::Path:
      return "path";
  }
  return "";
}

[[noreturn]] void refuse(const std::string& path, const std::string& message) {
  throw InputError({Problem{"", 0, 0, path, message}});
}

// "262 nm", or a bare number in the unit of the key where nothing else can be meant.
std::string number_text(const FormKey& key, const std::string& text) {
  const auto q = parse_quantity(text);
  // The page takes a decimal comma for a point where nothing else can be meant.
  const std::size_t comma = text.find(',');
  const bool number = comma != std::string::npos && parse_quantity(text.substr(0, comma));
  if (!q && number) {
    refuse(key.path, fmt::format("\"{}\" may be of a decimal comma or of thousands; write a point "
                                 "(1.2) or the digits alone (1200)",
                                 text));
  }
  if (!q) refuse(key.path, "expected a number" + (key.unit.empty() ? "" : " in " + key.unit));
  if (key.unit.empty()) return format_number(parse_si(text, ""));
  if (!q->unit.empty()) return format_quantity(parse_si(text, key.unit), key.unit);
  if (const BareNumber bare = bare_number(q->value, key.unit); bare.ambiguous)
    refuse(key.path, bare.advice);
  return fmt::format("{} {}", format_number(q->value), key.unit);
}

std::string whole_text(const FormKey& key, const std::string& text) {
  const auto q = parse_quantity(text);
  if (!q || !q->unit.empty() || q->value != std::floor(q->value))
    refuse(key.path, "expected a whole number");
  if (q->value < key.low || q->value > key.high)
    refuse(key.path, fmt::format("{} is outside {} to {}", format_number(q->value),
                                 format_number(key.low), format_number(key.high)));
  return fmt::format("{}", static_cast<long long>(q->value));
}

std::string list_text(const FormKey& key, const std::string& text) {
  constexpr std::size_t kMost = 64;
  const std::vector<std::string> items = split(text, ',');
  if (items.size() > kMost) refuse(key.path, "expected at most 64 values");
  std::vector<std::string> out;
  for (const std::string& item : items) {
    if (item.empty()) continue;
    const std::string value = number_text(key, item);
    out.push_back(key.unit.empty() ? value : toml_string(value));
  }
  return "[" + join_names(out, ", ") + "]";
}

std::string value_text(const FormKey& key, const std::string& text) {
  switch (key.type) {
    case KeyType::Number:
      return number_text(key, text);
    case KeyType::Numbers:
      return list_text(key, text);
    case KeyType::Integer:
      return whole_text(key, text);
    case KeyType::Flag:
      if (text != "true" && text != "false") refuse(key.path, "expected true or false");
      return text;
    case KeyType::Choice:
      if (std::find(key.choices.begin(), key.choices.end(), text) == key.choices.end())
        refuse(key.path, "expected one of " + join_names(key.choices));
      return text;
    case KeyType::Text:
      return toml_string(text);
    case KeyType::Path:
      refuse(key.path, "a file is chosen by its import view, not by its name");
  }
  return "";
}

struct SliderRange {
  double low = 0, high = 0;
  bool logarithmic = false;
};

// A slider is for trying: around the value that the file had, not the whole range of the key.
SliderRange slider_of(const FormKey& key, double opened) {
  constexpr double kAround = 4, kWholeRange = 200;
  if (key.type == KeyType::Integer) {
    const double span = std::max(8.0, 2 * std::abs(opened));
    return {key.low, std::min(key.high, key.low + span), false};
  }
  const bool whole = key.high <= kWholeRange && key.low >= 0;
  if (whole && (key.unit == "deg" || key.unit == "%" || key.high <= 2))
    return {key.low, key.high, false};
  if (!(opened > 0)) return {key.low, std::min(key.high, whole ? key.high : 10.0), false};
  return {std::max(key.low, opened / kAround), std::min(key.high, kAround * opened), true};
}

// What the items of each list of a design are: their keys, and of which kind they are.
std::map<std::string, std::string> items_of(const std::vector<FormKey>& keys) {
  std::map<std::string, std::string> out;
  for (const FormKey& key : keys) {
    const std::string list = list_of(key.path);
    if (list.empty()) continue;
    out[list] += key.path + (key.path.ends_with(".type") ? " " + key.value : "") + "\n";
  }
  return out;
}

// Of both, those whose items are others.
std::set<std::string> other_lists(const std::vector<FormKey>& from,
                                  const std::vector<FormKey>& to) {
  const std::map<std::string, std::string> before = items_of(from), after = items_of(to);
  std::set<std::string> out;
  for (const auto* side : {&before, &after}) {
    for (const auto& [list, items] : *side) {
      if (!before.contains(list) || !after.contains(list) || before.at(list) != after.at(list))
        out.insert(list);
    }
  }
  return out;
}

Json place_json(const Study& study, const FormKey& key, bool changed) {
  if (changed) return "changed here";
  const auto found = study.origins.find(key.path);
  if (found == study.origins.end())
    return fmt::format("default ({}{}{})", key.source, key.reference.empty() ? "" : ": ",
                       key.reference);
  const Place& place = found->second;
  const std::string name = place.file.substr(place.file.rfind('/') + 1);
  return place.line > 0 ? fmt::format("{}, line {}", name, place.line) : name;
}

}  // namespace

std::vector<FormKey> form_keys(const Design& design) {
  FormCollector collector;
  Design copy = design;
  fields(collector, copy);
  return std::move(collector.keys);
}

Change checked_change(const std::vector<FormKey>& keys, const std::string& path,
                      const std::string& text) {
  constexpr std::size_t kLongest = 2000;
  if (text.size() > kLongest) refuse(path, "expected a shorter text");
  const auto key =
      std::find_if(keys.begin(), keys.end(), [&](const FormKey& k) { return k.path == path; });
  if (key == keys.end()) refuse(path.substr(0, kLongest), "no such key in this design");
  return {path, value_text(*key, text)};
}

bool is_number(const std::string& text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

std::string list_of(const std::string& path) {
  std::string out;
  for (const std::string& part : split(path, '.')) {
    if (is_number(part)) return out;
    out += (out.empty() ? "" : ".") + part;
  }
  return "";
}

Change whole_list(const Design& design, const std::string& list) {
  Node all = to_table(design);
  Node* items = &all;
  for (const std::string& part : split(list, '.')) items = items->find(part);
  for (Node& item : items->children) {
    std::erase_if(item.children, [](const Node& member) {
      const Node* law = member.find("law");
      return law && law->text == "none";
    });
  }
  return {list, value_toml(*items)};
}

std::vector<Change> changes_between(const Design& from, const Design& to) {
  std::vector<Change> out;
  Design start = from;
  if (texture_name(from.texture) != texture_name(to.texture)) {
    out.push_back({"texture.type", texture_name(to.texture)});
    const auto& kinds = texture_kinds();
    start.texture = default_texture(static_cast<std::size_t>(
        std::find(kinds.begin(), kinds.end(), texture_name(to.texture)) - kinds.begin()));
  }
  const std::vector<FormKey> before = form_keys(start), after = form_keys(to);
  const std::set<std::string> lists = other_lists(before, after);
  // Options of the model that a file does not set are those that its finger was fitted with.
  const bool other_defaults = !(from.finger.calibrated_for == to.finger.calibrated_for);
  for (const FormKey& key : after) {
    if (key.path == "title" || lists.contains(list_of(key.path))) continue;
    const auto same = std::find_if(before.begin(), before.end(),
                                   [&](const FormKey& k) { return k.path == key.path; });
    const bool kept = same != before.end() && same->value == key.value;
    if (kept && !(other_defaults && key.path.starts_with("model."))) continue;
    out.push_back({key.path, key.type == KeyType::Path ? toml_string(key.value)
                                                       : value_text(key, key.value)});
  }
  for (const std::string& list : lists) out.push_back(whole_list(to, list));
  return out;
}

std::optional<Json> moved_since(const Json& told, const Json& rows) {
  constexpr std::array<std::string_view, 4> follows_the_hand{"value", "shown", "place", "changed"};
  if (told.size() != rows.size()) return std::nullopt;
  Json out = Json::array();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const Json &before = told[i], &now = rows[i];
    if (before == now) continue;
    if (before.size() != now.size()) return std::nullopt;
    Json& moved = out.emplace_back(Json{{"path", now["path"]}});
    for (const auto& [key, value] : now.items()) {
      if (before.value(key, Json()) == value) continue;
      if (std::find(follows_the_hand.begin(), follows_the_hand.end(), key) ==
          follows_the_hand.end())
        return std::nullopt;
      moved[key] = value;
    }
  }
  return out;
}

Json form_json(const Study& study, const Design& opened, const std::vector<Change>& changes) {
  const std::vector<FormKey> at_start = form_keys(opened);
  Json keys = Json::array();
  for (const FormKey& key : form_keys(study.design)) {
    if (key.path == "schema_version" || key.path == "title") continue;
    const std::string list = list_of(key.path);
    const bool changed = std::any_of(changes.begin(), changes.end(), [&](const Change& c) {
      return c.path == key.path || c.path == list;
    });
    Json row{{"path", key.path},
             {"type", type_name(key.type)},
             {"value", key.value},
             {"unit", key.unit},
             {"doc", key.doc},
             {"source", key.source},
             {"reference", key.reference},
             {"place", place_json(study, key, changed)},
             {"changed", changed}};
    if (!key.choices.empty()) row["choices"] = key.choices;
    if (key.type == KeyType::Number || key.type == KeyType::Integer) {
      const auto start = std::find_if(at_start.begin(), at_start.end(),
                                      [&](const FormKey& k) { return k.path == key.path; });
      SliderRange range = slider_of(key, start == at_start.end() ? key.shown : start->shown);
      const auto variable = std::find_if(study.variables.begin(), study.variables.end(),
                                         [&](const Variable& v) { return v.path == key.path; });
      if (variable != study.variables.end() && variable->choices.empty() && !key.unit.empty()) {
        const double to_si = find_unit(key.unit)->to_si;
        range = {variable->low / to_si, variable->high / to_si, false};
      }
      row["shown"] = key.shown;
      row["low"] = json_number(key.low);
      row["high"] = json_number(key.high);
      row["slider"] = {{"low", std::min(range.low, key.shown)},
                       {"high", std::max(range.high, key.shown)},
                       {"log", range.logarithmic && range.low > 0 && key.shown > 0}};
    }
    keys.push_back(std::move(row));
  }
  return keys;
}

}  // namespace papilla::studio
