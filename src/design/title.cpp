#include "design/title.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "base/units.h"
#include "config/describe.h"
#include "geometry/facts.h"

namespace papilla::design {
namespace {

// Sections by which a design is another one: not how it is answered.
constexpr std::array<std::string_view, 5> kOfTheDesign{"texture", "surface", "finger",
                                                       "counterface", "drive"};
constexpr const char* kTexture = "texture";
constexpr const char* kChanged = "changed";

// Paths and what a title says of each, in the order of their first telling.
using Told = std::vector<std::pair<std::string, std::string>>;

void tell(Told& told, const std::string& path, const std::string& value) {
  const auto earlier =
      std::find_if(told.begin(), told.end(), [&](const auto& t) { return t.first == path; });
  if (earlier == told.end())
    told.emplace_back(path, value);
  else
    earlier->second = value;
}

std::string section_of_path(const std::string& path) { return path.substr(0, path.find('.')); }

// "texture.depth=300 nm" as path and value; of "texture.depth:=3e-7" the path ends before the
// colon.
std::pair<std::string, std::string> path_and_value(const std::string& override_text) {
  const std::size_t equals = std::min(override_text.find('='), override_text.size());
  std::string path = override_text.substr(0, equals);
  path.erase(path.find_last_not_of(": ") + 1);
  std::string value = override_text.substr(std::min(equals + 1, override_text.size()));
  if (value.find_first_of("{[") != std::string::npos) return {path, kChanged};  // of many values
  std::erase_if(value, [](char c) { return c == '"' || c == '\''; });
  value.erase(0, value.find_first_not_of(' '));
  return {path, value};
}

bool is_of_the_design(const std::string& section) {
  return std::find(kOfTheDesign.begin(), kOfTheDesign.end(), section) != kOfTheDesign.end();
}

// Not by the rounding of a unit or of the unit cube alone.
bool differ(double a, double b) {
  return std::abs(a - b) > 1e-9 * std::max(std::abs(a), std::abs(b));
}

// For people: a search finds a depth of 345.678912 nm.
std::string rounded_quantity(double si, const std::string& unit) {
  const double rounded = std::stod(fmt::format("{:.4g}", si / find_unit(unit)->to_si));
  return unit.empty() ? format_number(rounded) : fmt::format("{} {}", format_number(rounded), unit);
}

// What a title says of this path already goes.
void forget(std::string& title, const std::string& path) {
  const std::string begin = "; " + path + " ";
  for (std::size_t at = title.find(begin); at != std::string::npos; at = title.find(begin))
    title.erase(at, std::min(title.find(';', at + 1), title.size()) - at);
}

std::string title_with(const std::string& title, Told told) {
  if (title.empty()) return {};
  std::string out = title;
  for (const auto& [path, value] : told) forget(out, path);
  constexpr std::size_t kMostTold = 3;
  if (told.size() > kMostTold) {
    for (const auto& [path, value] : std::exchange(told, {})) {
      const std::string section = section_of_path(path);
      tell(told, section, path == section ? value : kChanged);
    }
  }
  for (const auto& [path, value] : told) {
    forget(out, path);
    out += "; " + path + " " + value;
  }
  return out.size() <= kLongestTitle ? out : title;
}

}  // namespace

std::string title_as_set(const Design& design, const std::vector<std::string>& overrides) {
  Design copy = design;
  const std::vector<NumberField> numbers = number_fields(copy);
  Told told;
  for (const std::string& one : overrides) {
    const auto [path, value] = path_and_value(one);
    if (path == "title") return design.title;
    if (!is_of_the_design(section_of_path(path))) continue;
    const auto number = std::find_if(numbers.begin(), numbers.end(),
                                     [&path = path](const auto& n) { return n.path == path; });
    tell(told, path,
         number == numbers.end() ? value : format_quantity(*number->value, number->unit));
  }
  return title_with(design.title, std::move(told));
}

std::string title_as_changed(const Design& before, const Design& made) {
  Design from = before, to = made;
  const std::vector<NumberField> numbers = number_fields(to), earlier = number_fields(from);
  const bool flattened = facts(from.texture).relief.present && !facts(to.texture).relief.present;
  Told told;
  if (flattened)
    tell(told, kTexture, "flat");
  else if (from.texture.kind.index() != to.texture.kind.index())
    tell(told, std::string(kTexture) + ".type", texture_kinds()[to.texture.kind.index()]);
  for (const NumberField& number : numbers) {
    const std::string section = section_of_path(number.path);
    if (!is_of_the_design(section) || (flattened && section == kTexture)) continue;
    const auto same = std::find_if(earlier.begin(), earlier.end(),
                                   [&](const auto& n) { return n.path == number.path; });
    if (same == earlier.end() || differ(*same->value, *number.value))
      tell(told, number.path, rounded_quantity(*number.value, number.unit));
  }
  return title_with(before.title, std::move(told));
}

}  // namespace papilla::design
