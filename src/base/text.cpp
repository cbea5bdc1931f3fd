#include "base/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace papilla::base {
namespace {
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitute = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substitute});
    }
  }
  return row.back();
}

// Length of the UTF-8 sequence that a text begins with; 0: it is none.
std::size_t sequence_length(std::string_view text) {
  const auto at = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  const unsigned lead = at(0);
  const std::size_t length = lead < 0x80   ? 1
                             : lead < 0xC2 ? 0
                             : lead < 0xE0 ? 2
                             : lead < 0xF0 ? 3
                             : lead < 0xF5 ? 4
                                           : 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((at(i) & 0xC0) != 0x80) return 0;
  }
  // Longer than need be, halves of pairs, beyond the last.
  const unsigned second = at(1);
  const bool wrong = (lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F) ||
                     (lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F);
  return wrong ? 0 : length;
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string visible(std::string_view text) {
  std::string out;
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    const auto first = static_cast<unsigned char>(text[0]);
    // C0 and DEL; C1 is two bytes.
    const bool control =
        (length == 1 && (first < 0x20 || first == 0x7F) && first != '\n' && first != '\t') ||
        (length == 2 && first == 0xC2 && static_cast<unsigned char>(text[1]) < 0xA0);
    const std::size_t taken = std::max<std::size_t>(length, 1);
    if (length == 0 || control) {
      for (const char c : text.substr(0, taken))
        out += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      out += text.substr(0, taken);
    }
    text.remove_prefix(taken);
  }
  return out;
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& known) {
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance < best_distance) {
      best_distance = distance;
      best = candidate;
    }
  }
  return best;
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(separator, begin), text.size());
    std::string_view part = text.substr(begin, end - begin);
    while (!part.empty() && part.front() == ' ') part.remove_prefix(1);
    while (!part.empty() && part.back() == ' ') part.remove_suffix(1);
    parts.emplace_back(part);
    begin = end + 1;
  }
  return parts;
}

std::string counted(long long count, std::string_view noun) {
  return std::to_string(count) + " " + std::string(noun) + (count == 1 ? "" : "s");
}

std::string fixed(double value, int digits) {
  const std::string text = fmt::format("{:.{}f}", value, digits);
  return text.find_first_not_of("-0.") == std::string::npos ? text.substr(text.starts_with('-'))
                                                            : text;
}

std::string significant(double value, int digits) {
  const std::string rounded = fmt::format("{:.{}g}", value, digits);
  return fmt::format("{}", std::strtod(rounded.c_str(), nullptr) + 0.0);
}

std::string with_error(double value, double error) {
  if (!(error > 0) || !std::isfinite(error) || !std::isfinite(value))
    return significant(value, 4) + " ± " + significant(error, 2);
  // Of the rounded error: 0.0998 is 0.10.
  const double shown = std::strtod(fmt::format("{:.1e}", error).c_str(), nullptr);
  const int decimals = 1 - static_cast<int>(std::floor(std::log10(shown) + 1e-9));
  if (decimals > 6) return fmt::format("{:.4g} ± {:.2g}", value, error);
  const double step = std::pow(10.0, -decimals);  // of whole numbers, where there are no decimals
  const auto text = [&](double v) {
    return decimals < 0 ? fixed(std::round(v / step) * step, 0) : fixed(v, decimals);
  };
  return text(value) + " ± " + text(shown);
}

std::string join_names(const std::vector<std::string>& names, std::string_view separator) {
  std::string out;
  for (const std::string& name : names) {
    if (!out.empty()) out += separator;
    out += name;
  }
  return out;
}

std::size_t text_width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
  }));
}

std::string aligned_table(const std::vector<std::vector<std::string>>& rows, std::size_t left) {
  std::vector<std::size_t> width;
  for (const auto& row : rows) {
    width.resize(std::max(width.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], text_width(row[i]));
  }
  std::string out;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string pad(width[i] - text_width(row[i]), ' ');
      line += (i > 0 ? "  " : "") + (i < left ? row[i] + pad : pad + row[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + '\n';
  }
  return out;
}

std::string aligned_markdown(const std::string& text) {
  std::string out;
  std::vector<std::vector<std::string>> table;
  const auto flush = [&] {
    std::vector<std::size_t> width;
    for (const auto& row : table) {
      width.resize(std::max(width.size(), row.size()), 3);
      for (std::size_t i = 0; i < row.size(); ++i)
        width[i] = std::max(width[i], text_width(row[i]));
    }
    for (const auto& row : table) {
      for (std::size_t i = 0; i < row.size(); ++i) {
        const bool rule = row[i] == "---";
        out += "| " + row[i] + std::string(width[i] - text_width(row[i]), rule ? '-' : ' ') + " ";
      }
      out += "|\n";
    }
    table.clear();
  };
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t end = text.find('\n', begin);
    const bool closed = end != std::string::npos;
    if (!closed) end = text.size();
    const std::string_view line(text.data() + begin, end - begin);
    if (line.size() > 1 && line.front() == '|' && line.back() == '|') {
      table.push_back(split(line.substr(1, line.size() - 2), '|'));
    } else {
      flush();
      out += line;
      if (closed) out += '\n';
    }
    begin = end + 1;
  }
  flush();
  return out;
}

}  // namespace papilla::base
