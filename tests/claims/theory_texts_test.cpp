// The whole answer of every theory claim beside the committed table, word by word: of what is
// rounding the words around it.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "base/files.h"
#include "claims/papers.h"
#include "tests/claims/csv_rows.h"

namespace papilla::tests::theory_texts_test {
namespace {

// Up to the number that is rounding: "relative difference 2e-16", "gamma = 1/2: 1e-13".
std::string before_rounding(const std::string& text) {
  for (const char* words : {"relative difference ", "gamma = 1/2: "}) {
    if (const std::size_t at = text.find(words); at != std::string::npos) return text.substr(0, at);
  }
  return text;
}

TEST(TheoryTexts, AreThoseOfTheCommittedTable) {
  std::map<std::string, std::vector<std::string>> table;
  const std::string path = std::string(PAPILLA_SOURCE_DIR) + "/results/reproduction/claims.csv";
  for (const auto& row : csv_rows(read_bytes(path))) table[row.at(0)] = row;
  FingerModel model(Finger{}, Preset::Papilla, 1);
  int rounding = 0;
  for (const Claim& c : theory_claims()) {
    const std::vector<std::string>& row = table.at(c.id);
    const Judgement j = c.judge(model);
    EXPECT_EQ(verdict_name(j.verdict), row.at(4)) << c.id;
    EXPECT_EQ(before_rounding(j.model), before_rounding(row.at(7))) << c.id;
    EXPECT_EQ(j.reason, row.at(8)) << c.id;
    EXPECT_EQ(j.se, 0) << c.id;
    EXPECT_FALSE(j.single) << c.id;
    rounding += before_rounding(j.model) != j.model;
  }
  EXPECT_EQ(rounding, 5);  // J3, J4, J6, B3 and B7
}

}  // namespace
}  // namespace papilla::tests::theory_texts_test
