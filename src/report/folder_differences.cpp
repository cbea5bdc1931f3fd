#include "report/folder_differences.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "base/text.h"
#include "report/page.h"
#include "report/receipts.h"
#include "report/stated_number.h"
#include "report/sums.h"
#include "search/reanswer.h"

namespace papilla::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostOfAFile = 5;  // differences that are told

std::string says_text(const std::string& where, const WordDifference& d) {
  return fmt::format("{} says \"{}\", recomputed \"{}\"", where, d.says, d.expected);
}

// The number that a place of the plain text lies in; null: none.
const TextPart* number_at(const std::vector<TextPart>& parts, std::size_t at) {
  std::size_t end = 0;
  for (const TextPart& part : parts) {
    end += part.text.size();
    if (at < end) return part.number ? &part : nullptr;
  }
  return nullptr;
}

bool same_value(const Json& a, const Json& b) {
  if (a.is_number() && b.is_number()) return same_number(a.get<double>(), b.get<double>());
  if (a.is_string() && b.is_string())
    return word_differences(a.get<std::string>(), b.get<std::string>(), 1).empty();
  return a == b;
}

std::string value_text(const Json& value) {
  constexpr std::size_t kLong = 60;
  const std::string text = value.is_string() ? value.get<std::string>() : value.dump();
  return text.size() > kLong ? text.substr(0, kLong) + "…" : text;
}

// Every value by its pointer.
std::map<std::string, Json> flat(const Json& json) {
  std::map<std::string, Json> out;
  if (!json.is_structured()) return out;
  const Json values = json.flatten();
  for (const auto& [pointer, value] : values.items()) out[pointer] = value;
  return out;
}

// Parsed, or null where it is damaged.
Json parsed_or_null(const std::string& text) { return Json::parse(text, nullptr, false); }

class Differences {
 public:
  Differences(const Folder& there, const Folder& here) : there_(there), here_(here) {}

  void run(const std::string& file, const Json& says, const Json& run) {
    const std::map<std::string, Json> expected = flat(run);
    if (says.is_discarded()) {
      for (const auto& [pointer, value] : expected) lost(value, file + ": is damaged");
      return other(file + ": is damaged");
    }
    const std::map<std::string, Json> found = flat(says);
    for (const auto& [pointer, value] : expected) {
      const std::string where = file + "#" + pointer;
      const auto there = found.find(pointer);
      if (there == found.end()) {
        lost(value, where + ": is missing");
        other(where + ": is missing");
      } else if (value.is_string()) {
        said(where, there->second, said_parts(value.get<std::string>()));
      } else if (!same_value(there->second, value)) {
        other(differs(where, there->second, value));
      }
    }
    for (const auto& [pointer, value] : found) {
      if (!expected.contains(pointer)) other(file + "#" + pointer + ": is not of the run");
    }
  }

  // A text with stated numbers.
  void text(const std::string& file, const std::string& says, const std::vector<TextPart>& parts) {
    std::string expected;
    for (const TextPart& part : parts) expected += part.text;
    for (const WordDifference& d : word_differences(says, expected)) {
      const std::string where =
          expected.find('\n') == std::string::npos ? file : file + ", " + line_text(expected, d.at);
      if (const TextPart* part = number_at(parts, d.at))
        out.receipts.push_back({part->number->words, part->text, says_text(where, d)});
      else
        other(says_text(where, d));
    }
  }

  void json(const std::string& file, const Json& says, const Json& expected) {
    if (says.is_discarded()) return other(file + ": is damaged");
    const std::map<std::string, Json> found = flat(says);
    std::size_t told = 0;
    const std::map<std::string, Json> wanted = flat(expected);
    for (const auto& [pointer, value] : wanted) {
      const auto known = found.find(pointer);
      const Json there = known == found.end() ? Json("nothing") : known->second;
      if (same_value(there, value)) continue;
      if (++told <= kMostOfAFile) other(differs(file + "#" + pointer, there, value));
    }
  }

  // The page holds the run's texts and tables.
  void page() {
    if (!there_.has(kPageName)) return other(std::string(kPageName) + ": is missing");
    const std::string says = there_.read(kPageName), expected = here_.read(kPageName);
    Json found = data_of(says), wanted = data_of(expected);
    if (!found.is_object()) return other(std::string(kPageName) + ": has no data");
    for (const char* own : {"run", "summary"}) wanted.erase(own);
    wanted.erase("files");  // by the sums of the folder
    json(kPageName, found, wanted);
    text(std::string(kPageName) + " without scripts", without_scripts(says),
         {{without_scripts(expected), std::nullopt}});
  }

  void file(const std::string& name) {
    if (!there_.has(name)) return other(name + ": is missing");
    const std::string says = there_.read(name), expected = here_.read(name);
    if (says == expected) return;
    if (name.ends_with(".json"))
      json(name, parsed_or_null(says), Json::parse(expected));
    else
      text(name, says, {{expected, std::nullopt}});
  }

  void other(const std::string& text) { out.others.push_back(text); }
  // A place that is gone, with the numbers that stood there.
  void lost(const Json& value, const std::string& says) {
    if (!value.is_string()) return;
    for (const TextPart& part : said_parts(value.get<std::string>()))
      if (part.number) out.receipts.push_back({part.number->words, part.text, says});
  }

  Json page_data() const {
    return there_.has(kPageName) ? data_of(there_.read(kPageName)) : Json::object();
  }

  FolderDifferences out;

 private:
  static std::string differs(const std::string& where, const Json& says, const Json& expected) {
    return fmt::format("{} says \"{}\", recomputed \"{}\"", where, value_text(says),
                       value_text(expected));
  }

  void said(const std::string& where, const Json& says, const std::vector<TextPart>& parts) {
    const bool number = parts.size() == 1 && parts.front().number && parts.front().text.empty();
    if (!number && says.is_string()) return text(where, says.get<std::string>(), parts);
    const Json expected = number ? json_of(*parts.front().number) : Json("a text");
    if (same_value(says, expected)) return;
    if (number)
      out.receipts.push_back({parts.front().number->words, "", differs(where, says, expected)});
    else
      other(differs(where, says, expected));
  }
  static Json json_of(const StatedNumber& number) { return as_read(Json(stated_value(number))); }

  static Json data_of(const std::string& page) {
    return parsed_or_null(
        between(page, "<script type=\"application/json\" id=\"data\">", "</script>"));
  }
  static std::string without_scripts(const std::string& page) {
    return between(page, "<noscript>", "</noscript>");
  }
  static std::string between(const std::string& text, std::string_view begin,
                             std::string_view end) {
    const std::size_t from = text.find(begin);
    if (from == std::string::npos) return {};
    const std::size_t first = from + begin.size();
    return text.substr(first, text.find(end, first) - first);
  }

  const Folder &there_, &here_;
};

bool is_picture(const std::string& name) {
  constexpr std::array<std::string_view, 4> kEndings{".exr", ".gsf", ".png", ".tif"};
  return std::any_of(kEndings.begin(), kEndings.end(),
                     [&](std::string_view ending) { return name.ends_with(ending); });
}

// Those that have their own comparison, or are what all is made of.
bool is_apart(const std::string& name) {
  constexpr std::array<std::string_view, 6> kApart{"run.json",      "summary.md", kReceiptsName,
                                                   "resolved.toml", kSumsName,    kPageName};
  return name.starts_with("journal") ||
         std::find(kApart.begin(), kApart.end(), name) != kApart.end();
}

}  // namespace

FolderDifferences folder_differences(const Folder& there, const Folder& here, const Json& run,
                                     const std::string& summary) {
  Differences found(there, here);
  found.run("run.json", parsed_or_null(there.read("run.json")), run);
  const std::vector<TextPart> parts = said_parts(summary);
  if (there.has("summary.md"))
    found.text("summary.md", there.read("summary.md"), parts);
  else
    found.other("summary.md: is missing");
  const Json page = found.page_data();
  if (page.is_object() && page.contains("run") && page.contains("summary") &&
      page["summary"].is_string()) {
    found.run(std::string(kPageName) + "#run", page["run"], run);
    found.text(std::string(kPageName) + "#summary", page["summary"].get<std::string>(), parts);
  }
  found.page();
  for (const std::string& name : lasting_files(here)) {
    if (!is_apart(name) && !is_picture(name)) found.file(name);
  }
  for (const std::string& name : changed_files(there))
    found.other(visible(name) + ": is not as the run wrote it (" + kSumsName + ")");
  return std::move(found.out);
}

}  // namespace papilla::report
