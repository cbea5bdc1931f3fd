// The committed tables of accuracy against the model of today.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "design/design.h"
#include "forward/forward.h"
#include "metrics/metrics.h"

namespace papilla::tests::recomputed_test {
namespace {

std::map<std::string, std::string> row_of(const std::string& setting) {
  std::ifstream file(std::string(PAPILLA_SOURCE_DIR) + "/results/accuracy/sweeps.csv");
  std::map<std::string, std::string> row;
  std::vector<std::string> names;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#")) continue;
    std::vector<std::string> cells;
    std::stringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    if (names.empty()) names = cells;
    if (cells.size() < 2 || cells[1] != setting) continue;
    for (std::size_t i = 0; i < cells.size(); ++i) row[names[i]] = cells[i];
  }
  return row;
}

TEST(AccuracyTables, ARowIsWhatTheModelGivesToday) {
  std::map<std::string, std::string> row = row_of("32 pixels");
  ASSERT_FALSE(row.empty());
  const Design design = read_design(std::string(PAPILLA_DESIGNS_DIR) + "/m3_samples/a3h350.toml");
  Fidelity f = fidelity_level("design");
  f.grid = std::stoi(row["grid"]);
  f.skins = std::stoi(row["skins"]);
  f.threads = 1;
  const Response r = evaluate(scene_of(design), design.texture, f);
  const auto modulation = summarise(Summary::Mean, kModulation, r);
  const double value = std::stod(row["modulation"]), stated = std::stod(row["modulation_stated"]);
  EXPECT_NEAR(modulation->value, value, 1e-3 * value);
  EXPECT_NEAR(modulation->se, stated, 0.02 * stated);
}

}  // namespace
}  // namespace papilla::tests::recomputed_test
