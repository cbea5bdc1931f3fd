#include "report/text_difference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "search/reanswer.h"

namespace papilla::report {
namespace {

struct Word {
  std::size_t at = 0;
  std::string_view text;
};

std::vector<Word> words_of(std::string_view text) {
  constexpr std::string_view kSeparators = " \t\r\n,|<>\"()";
  std::vector<Word> out;
  std::size_t at = text.find_first_not_of(kSeparators);
  while (at < text.size()) {
    const std::size_t end = std::min(text.find_first_of(kSeparators, at), text.size());
    out.push_back({at, text.substr(at, end - at)});
    at = text.find_first_not_of(kSeparators, end);
  }
  return out;
}

bool same_word(std::string_view a, std::string_view b) {
  if (a == b) return true;
  const std::string first(a), second(b);
  char *end_a = nullptr, *end_b = nullptr;
  const double x = std::strtod(first.c_str(), &end_a), y = std::strtod(second.c_str(), &end_b);
  const bool numbers = end_a != first.c_str() && end_b != second.c_str();
  return numbers && std::string_view(end_a) == std::string_view(end_b) && same_number(x, y);
}

}  // namespace

std::vector<WordDifference> word_differences(const std::string& says, const std::string& expected,
                                             std::size_t most) {
  const std::vector<Word> there = words_of(says), here = words_of(expected);
  std::vector<WordDifference> out;
  const bool parallel = there.size() == here.size();
  for (std::size_t i = 0; i < here.size() && out.size() < most; ++i) {
    const std::string_view other = i < there.size() ? there[i].text : std::string_view();
    if (same_word(other, here[i].text)) continue;
    out.push_back({here[i].at, std::string(other), std::string(here[i].text)});
    if (!parallel) return out;
  }
  if (!parallel && out.empty())
    out.push_back({expected.size(), std::string(there[here.size()].text), ""});
  return out;
}

std::string line_text(const std::string& text, std::size_t at) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(at, text.size()));
  return fmt::format("line {}", 1 + std::count(text.begin(), end, '\n'));
}

}  // namespace papilla::report
