// Reference tables: CSV with # comments and one header line.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::tests {

using Row = std::map<std::string, std::string>;

inline double number(const Row& row, const std::string& column) {
  return std::stod(row.at(column));
}

inline std::vector<Row> read_table(const std::string& name) {
  std::ifstream in(std::string(PAPILLA_TEST_DATA) + "/electrostatics/" + name);
  std::vector<std::string> header;
  std::vector<Row> rows;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::istringstream cells(line);
    std::vector<std::string> values;
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(cell);
    if (header.empty()) {
      header = values;
      header[0].erase(0, header[0].find_first_not_of(' '));
      continue;
    }
    Row row;
    for (std::size_t i = 0; i < header.size(); ++i) row[header[i]] = values.at(i);
    rows.push_back(row);
  }
  EXPECT_FALSE(rows.empty()) << name;
  return rows;
}

}  // namespace papilla::tests
