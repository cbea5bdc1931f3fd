#include "config/columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "base/text.h"
#include "base/units.h"

namespace papilla::config {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// "load_mN", "load [mN]", "load (mN)" -> "load" and "mN".
struct NameAndUnit {
  std::string name, unit;
};
NameAndUnit parted(std::string_view cell, const std::vector<ColumnKind>& kinds) {
  const auto known = [&](std::string_view name) {
    return std::any_of(kinds.begin(), kinds.end(), [&](const ColumnKind& k) {
      return k.name == name || std::find(k.also.begin(), k.also.end(), name) != k.also.end();
    });
  };
  if (const std::size_t open = cell.find_first_of("[("); open != std::string_view::npos) {
    const std::size_t close = cell.find_first_of("])", open);
    return {std::string(trimmed(cell.substr(0, open))),
            std::string(trimmed(cell.substr(
                open + 1, close == std::string_view::npos ? close : close - open - 1)))};
  }
  if (known(cell)) return {std::string(cell), ""};
  const std::size_t dash = cell.rfind('_');
  if (dash == std::string_view::npos || !known(cell.substr(0, dash)))
    return {std::string(cell), ""};
  return {std::string(cell.substr(0, dash)), std::string(cell.substr(dash + 1))};
}

}  // namespace

TableColumn read_column(std::string_view cell, const std::vector<ColumnKind>& kinds) {
  const NameAndUnit is = parted(cell, kinds);
  const auto named = [&](const ColumnKind& k) {
    return k.name == is.name || std::find(k.also.begin(), k.also.end(), is.name) != k.also.end();
  };
  auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const ColumnKind& k) {
    return named(k) && k.unit.empty() == is.unit.empty();
  });
  if (kind == kinds.end()) kind = std::find_if(kinds.begin(), kinds.end(), named);
  if (kind == kinds.end()) return {};
  if (kind->is_text || kind->unit.empty()) return {&*kind, 1, ""};
  // "%" is no letter of a name.
  const std::string unit = is.unit == "percent" ? "%" : is.unit;
  const Unit wanted = *find_unit(kind->unit);
  const std::optional<Unit> found = find_unit(unit);
  if (is.unit.empty() || !found || !found->same_dimension(wanted)) {
    const std::string shown = kind->unit == "%" ? "percent" : kind->unit;
    throw InputError(
        is.unit.empty()
            ? fmt::format("{}: a column without a unit: write {}_{}", cell, is.name, shown)
            : fmt::format("{}: \"{}\" is no unit of {}; write {}_{}", cell, is.unit,
                          dimension_name(wanted), is.name, shown));
  }
  return {&*kind, found->to_si, unit};
}

bool Header::has(const ColumnKind& kind) const {
  return std::any_of(columns.begin(), columns.end(),
                     [&](const TableColumn& c) { return c.kind == &kind; });
}

Header read_header(const std::vector<std::string_view>& cells,
                   const std::vector<ColumnKind>& kinds) {
  Header out;
  for (const std::string_view cell : cells) {
    TableColumn column;
    try {
      column = read_column(cell, kinds);
      if (!column.kind) out.unread.emplace_back(cell);
    } catch (const InputError& error) {
      out.problems.emplace_back("", error.problems().front().message);
    }
    if (column.kind && out.has(*column.kind))
      out.problems.emplace_back(cell, "a second column of the same quantity");
    out.columns.push_back(column);
  }
  return out;
}

std::string unread_note(const Header& header) {
  return header.unread.empty() ? "" : "columns that are not read: " + join_names(header.unread);
}

void split_cells(std::string_view line, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  for (std::size_t from = 0;;) {
    const std::size_t to = line.find(separator, from);
    std::string_view cell =
        trimmed(line.substr(from, to == std::string_view::npos ? to : to - from));
    if (cell.size() > 1 && cell.front() == '"' && cell.back() == '"')
      cell = cell.substr(1, cell.size() - 2);
    cells.push_back(cell);
    if (to == std::string_view::npos) return;
    from = to + 1;
  }
}

char separator_of(std::string_view header) {
  for (const char c : {',', ';', '\t'}) {
    if (header.find(c) != std::string_view::npos) return c;
  }
  return ',';
}

std::optional<double> cell_number(std::string_view cell) {
  if (!cell.empty() && cell.front() == '+') cell.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

Lines::Lines(std::string_view text) : rest_(text) {
  if (rest_.starts_with(kByteOrderMark)) rest_.remove_prefix(kByteOrderMark.size());
}

void Lines::each(std::string_view blank, const std::function<void(std::string_view line)>& comment,
                 const std::function<void(const std::vector<std::string_view>&)>& header,
                 const std::function<void(const std::vector<std::string_view>&)>& row) {
  std::string_view line;
  std::vector<std::string_view> cells;
  std::optional<char> separator;
  while (next(line)) {
    if (line.find_first_not_of(blank) == std::string_view::npos) continue;
    if (line.front() == '#') {
      comment(line);
      continue;
    }
    const bool first = !separator;
    if (first) separator = separator_of(line);
    split_cells(line, *separator, cells);
    (first ? header : row)(cells);
  }
}

bool Lines::next(std::string_view& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  ended_within_ = end == std::string_view::npos;
  line = trimmed(rest_.substr(0, end));
  rest_ = ended_within_ ? std::string_view{} : rest_.substr(end + 1);
  ++number_;
  return true;
}

}  // namespace papilla::config
