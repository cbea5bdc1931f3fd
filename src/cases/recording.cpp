#include "cases/recording.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#include "base/error.h"
#include "base/text.h"

namespace papilla::cases {
namespace {

// Nothing where one of them is no finite number.
std::optional<std::vector<double>> numbers_of(const std::vector<std::string>& cells) {
  std::vector<double> out(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const char* end = cells[i].data() + cells[i].size();
    const auto [stop, error] = std::from_chars(cells[i].data(), end, out[i]);
    if (error != std::errc{} || stop != end || !std::isfinite(out[i])) return std::nullopt;
  }
  return out;
}

[[noreturn]] void refuse(const std::string& name, int line, const std::string& what) {
  throw InputError({Problem{name, line, 1, "", what}});
}

}  // namespace

std::vector<std::vector<double>> number_rows(const std::string& csv, const std::string& name,
                                             const std::string& word, const std::string& expected) {
  std::vector<std::vector<double>> rows;
  std::istringstream lines(csv);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    const std::vector<std::string> cells = split(line, ',');
    const auto values = numbers_of(cells);
    if (!values && rows.empty() && line.find(word) != std::string::npos && cells.size() > 1)
      continue;  // the head
    const bool alike =
        values && values->size() > 1 && (rows.empty() || values->size() == rows[0].size());
    if (!alike) {
      refuse(name, number,
             fmt::format("expected {}, got \"{}\"{}", expected, line,
                         line.find(';') != std::string::npos
                             ? "; the separator is a comma, decimals a point"
                             : ""));
    }
    rows.push_back(*values);
  }
  if (rows.size() < 2) refuse(name, 1, fmt::format("expected two lines of {} or more", expected));
  return rows;
}

double even_step(const std::vector<std::vector<double>>& rows, const std::string& name) {
  const double step = (rows.back()[0] - rows.front()[0]) / static_cast<double>(rows.size() - 1);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double here = rows[i][0] - rows[i - 1][0];
    if (!(step > 0) || std::abs(here - step) > 0.01 * step) {
      refuse(
          name, static_cast<int>(i + 1),
          fmt::format("expected even steps of time, got {:g} s among steps of {:g} s", here, step));
    }
  }
  return step;
}

Signal recorded_signal(const std::string& csv, const std::string& name) {
  const auto rows = number_rows(csv, name, "time", "\"time,value\" in s and V or A");
  if (rows[0].size() != 2) refuse(name, 1, "expected \"time,value\" in s and V or A");
  const double step = even_step(rows, name);
  const auto count = static_cast<double>(rows.size());
  Signal out{step * count, std::vector<double>(std::bit_ceil(rows.size()))};
  for (std::size_t i = 0; i < out.value.size(); ++i) {
    const double at = count * static_cast<double>(i) / static_cast<double>(out.value.size());
    const auto before = static_cast<std::size_t>(at);
    const double share = at - static_cast<double>(before);
    const double next = rows[(before + 1) % rows.size()][1];  // it repeats
    out.value[i] = rows[before][1] + share * (next - rows[before][1]);
  }
  return out;
}

}  // namespace papilla::cases
