#include "report/tables.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "base/error.h"
#include "base/files.h"
#include "base/text.h"

namespace papilla::report {

bool CsvTable::has(const std::string& name) const {
  return std::find(header.begin(), header.end(), name) != header.end();
}

std::size_t CsvTable::column(const std::string& name) const {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) throw InputError({Problem{path, 0, 0, "", "no column " + name}});
  return static_cast<std::size_t>(found - header.begin());
}

std::vector<std::string> CsvTable::texts(const std::string& name) const {
  const std::size_t at = column(name);
  std::vector<std::string> out;
  for (const auto& row : rows) out.push_back(row[at]);
  return out;
}

std::vector<double> CsvTable::numbers(const std::string& name) const {
  std::vector<double> out;
  for (const std::string& cell : texts(name)) {
    char* end = nullptr;
    const double v = std::strtod(cell.c_str(), &end);
    out.push_back(end == cell.c_str() ? std::numeric_limits<double>::quiet_NaN() : v);
  }
  return out;
}

namespace {

CsvTable table_of(const std::string& text, const std::string& path) {
  CsvTable table;
  table.path = path;
  int number = 0;
  for (const std::string& line : split(text, '\n')) {
    ++number;
    if (line.empty()) continue;
    if (line.front() == '#') {
      const std::size_t begin = std::min(line.find_first_not_of("# "), line.size());
      table.comments.push_back(line.substr(begin));
    } else if (table.header.empty()) {
      table.header = split(line, ',');
    } else {
      table.rows.push_back(split(line, ','));
      if (table.rows.back().size() != table.header.size()) {
        throw InputError({Problem{path, number, 1, "", "a row of another length than the header"}});
      }
    }
  }
  return table;
}

}  // namespace

CsvTable read_csv(const std::string& path) { return table_of(read_bytes(path), path); }

CsvTable read_csv(const Folder& folder, const std::string& name) {
  return table_of(folder.read(name), folder.path(name));
}

std::string csv_cell(std::string text) {
  std::replace(text.begin(), text.end(), ',', ';');
  return text;
}

std::string name_with_unit(const std::string& name, const std::string& unit) {
  return name + (unit.empty() ? "" : " [" + unit + "]");
}

std::string markdown_row(const std::vector<std::string>& cells) {
  return "| " + join_names(cells, " | ") + " |\n";
}

std::string markdown_head(const std::vector<std::string>& names) {
  std::string dashes;
  for (std::size_t i = 0; i < names.size(); ++i) dashes += "|---";
  return markdown_row(names) + dashes + "|\n";
}

}  // namespace papilla::report
