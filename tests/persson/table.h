// Reads a reference table: comma-separated, "#" lines are remarks, the first other line may be a
// header.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "base/rooms.h"

namespace papilla::tests {

struct TableRow {
  std::string name;            // first column as text
  std::vector<double> values;  // all columns; text reads as 0
};

inline std::vector<TableRow> read_table(const std::string& name, bool header) {
  std::ifstream file(std::string(PAPILLA_TEST_DATA) + "/persson/" + name);
  EXPECT_TRUE(file.good()) << name;
  std::vector<TableRow> rows;
  std::string line;
  while (std::getline(file, line)) {
    if (line.empty() || line[0] == '#' || line[0] == ' ') continue;
    if (header) {
      header = false;
      continue;
    }
    TableRow row;
    std::stringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) {
      if (row.values.empty()) row.name = cell;
      row.values.push_back(std::strtod(cell.c_str(), nullptr));
    }
    rows.push_back(row);
  }
  EXPECT_FALSE(rows.empty()) << name;
  return rows;
}

}  // namespace papilla::tests
