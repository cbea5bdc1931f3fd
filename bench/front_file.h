// Designs from the table of a front: `pareto.csv` of a search, or one that search_bench wrote.
#pragma once

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "search/problem.h"

namespace papilla::tests {

inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> out;
  std::istringstream in(line);
  for (std::string cell; std::getline(in, cell, ',');) out.push_back(cell);
  return out;
}

// At most `most` designs along the front, both ends with it: all rows, or those that say that they
// are on it. Throws InputError for a table without one column a variable.
inline std::vector<Point> read_front(const std::string& path, const StudyProblem& problem,
                                     std::size_t most) {
  std::ifstream in(path);
  if (!in) throw InputError("cannot read " + path);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> header = cells_of(line);
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
  };
  const Point own = problem.space().value(problem.space().unit_of_study());
  const auto value_of = [&](std::size_t k, const std::vector<std::string>& row) {
    const Variable& v = problem.study().variables[k];
    const std::string name = v.unit.empty() ? v.path : v.path + " [" + v.unit + "]";
    if (column(name) >= row.size()) throw InputError(path + ": no column `" + name + "`");
    const std::string& cell = row[column(name)];
    if (cell.empty()) return own[k];  // a measure that this kind of texture has not
    const auto& kinds = texture_kinds();
    return v.is_kind()
               ? static_cast<double>(std::find(kinds.begin(), kinds.end(), cell) - kinds.begin())
               : parse_si(cell + " " + v.unit, v.unit);
  };
  const std::size_t on_front = column("on front");
  std::vector<Point> all, kept;
  while (std::getline(in, line)) {
    const std::vector<std::string> row = cells_of(line);
    if (on_front < header.size() && row.at(on_front) != "yes") continue;
    Point value;
    for (std::size_t k = 0; k < own.size(); ++k) value.push_back(value_of(k, row));
    all.push_back(problem.space().snapped(problem.space().unit(value)));
  }
  for (std::size_t i = 0; i < std::min(most, all.size()); ++i)
    kept.push_back(all[all.size() <= most ? i : i * (all.size() - 1) / (most - 1)]);
  return kept;
}

}  // namespace papilla::tests
