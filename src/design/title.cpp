#include "design/title.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "base/text.h"
#include "base/units.h"
#include "config/describe.h"

namespace papilla::design {
namespace {

// Sections by which a design is another one: not how it is answered.
constexpr std::array<std::string_view, 5> kOfTheDesign{"texture", "surface", "finger",
                                                       "counterface", "drive"};
constexpr const char* kChanged = "changed";

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

// What a title says of this path already goes.
void forget(std::string& title, const std::string& path) {
  const std::string begin = "; " + path + " ";
  for (std::size_t at = title.find(begin); at != std::string::npos; at = title.find(begin))
    title.erase(at, std::min(title.find(';', at + 1), title.size()) - at);
}

}  // namespace

std::string title_as_set(const Design& design, const std::vector<std::string>& overrides) {
  if (design.title.empty()) return {};
  Design copy = design;
  const std::vector<NumberField> numbers = number_fields(copy);
  std::vector<std::pair<std::string, std::string>> told;
  const auto tell = [&](const std::string& path, const std::string& value) {
    const auto earlier =
        std::find_if(told.begin(), told.end(), [&](const auto& t) { return t.first == path; });
    if (earlier == told.end())
      told.emplace_back(path, value);
    else
      earlier->second = value;
  };
  for (const std::string& one : overrides) {
    const auto [path, value] = path_and_value(one);
    if (path == "title") return design.title;
    if (std::find(kOfTheDesign.begin(), kOfTheDesign.end(), section_of_path(path)) ==
        kOfTheDesign.end())
      continue;
    const auto number = std::find_if(numbers.begin(), numbers.end(),
                                     [&path = path](const auto& n) { return n.path == path; });
    tell(path, number == numbers.end() ? value : format_quantity(*number->value, number->unit));
  }
  std::string out = design.title;
  for (const auto& [path, value] : told) forget(out, path);
  constexpr std::size_t kMostTold = 3;
  if (told.size() > kMostTold) {
    for (const auto& [path, value] : std::exchange(told, {})) tell(section_of_path(path), kChanged);
  }
  for (const auto& [path, value] : told) {
    forget(out, path);
    out += "; " + path + " " + value;
  }
  return out.size() <= kLongestTitle ? out : design.title;
}

}  // namespace papilla::design
