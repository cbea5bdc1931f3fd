#include "report/stated_number.h"

#include <nlohmann/json.hpp>

#include "report/json.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

// Control characters, which no text of a page has: begin, between number and text, end.
constexpr char kOpen = '\x01', kMiddle = '\x02', kClose = '\x03';

Json json_of(const StatedError& error) {
  return {{"size", json_number(error.size)}, {"absent", error.absent}};
}

std::optional<double> number_of(const Json& j) {
  return j.is_number() ? std::optional(j.get<double>()) : std::nullopt;
}

StatedError error_of(const Json& j) {
  return {number_of(j.at("size")), j.at("absent").get<std::string>()};
}

std::string carried(const StatedNumber& number, const std::string& text) {
  Json stages = Json::array();
  for (const Stage stage : number.rests_on) stages.push_back(static_cast<std::size_t>(stage));
  const Json j{{"words", as_read(number.words)},
               {"value", json_number(number.value)},
               {"unit", number.unit},
               {"numerical", json_of(number.numerical)},
               {"model", json_of(number.model)},
               {"rests_on", std::move(stages)}};
  return kOpen + j.dump(-1, ' ', true, Json::error_handler_t::replace) + kMiddle + text + kClose;
}

// Nothing where it is not what carried() writes: a name in a study may hold any character.
std::optional<StatedNumber> number_carried(const std::string& text) {
  try {
    const Json j = Json::parse(text);
    StatedNumber out;
    out.words = j.at("words");
    if (const auto value = number_of(j.at("value"))) out.value = *value;
    out.unit = j.at("unit");
    out.numerical = error_of(j.at("numerical"));
    out.model = error_of(j.at("model"));
    for (const Json& stage : j.at("rests_on")) {
      const auto index = stage.get<std::size_t>();
      if (index >= kStages) return std::nullopt;
      out.rests_on.push_back(static_cast<Stage>(index));
    }
    return out;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

// Of a text that is one number and nothing else.
bool is_number(const std::vector<TextPart>& parts) {
  return parts.size() == 1 && parts.front().number && parts.front().text.empty();
}

}  // namespace

std::string stated(const StatedNumber& number, const std::string& text) {
  return text.empty() ? "" : carried(number, as_read(text));
}

std::string stated_value(const StatedNumber& number) { return carried(number, ""); }

std::vector<TextPart> said_parts(const std::string& text) {
  std::vector<TextPart> out;
  const auto add_words = [&](std::string words) {
    if (words.empty()) return;
    if (out.empty() || out.back().number) out.emplace_back();
    out.back().text += words;
  };
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t begin = text.find(kOpen, at);
    const std::size_t between = text.find(kMiddle, begin), end = text.find(kClose, between);
    if (begin == std::string::npos || between == std::string::npos || end == std::string::npos)
      break;
    add_words(text.substr(at, begin - at));
    const std::string said = text.substr(between + 1, end - between - 1);
    if (auto number = number_carried(text.substr(begin + 1, between - begin - 1)))
      out.push_back({said, std::move(number)});
    else
      add_words(text.substr(begin, end + 1 - begin));
    at = end + 1;
  }
  add_words(text.substr(at));
  return out;
}

std::string as_read(const std::string& text) {
  if (text.find(kOpen) == std::string::npos) return text;
  std::string out;
  for (const TextPart& part : said_parts(text)) out += part.text;
  return out;
}

Json as_read(const Json& json) {
  if (json.is_string()) {
    const std::string& text = json.get_ref<const std::string&>();
    const std::vector<TextPart> parts = said_parts(text);
    return is_number(parts) ? json_number(parts.front().number->value) : Json(as_read(text));
  }
  Json out = json;
  if (json.is_structured()) {
    for (auto& [key, value] : out.items()) value = as_read(Json(value));
  }
  return out;
}

}  // namespace papilla::report
