#include "claims/reproduce.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/files.h"
#include "report/claims.h"
#include "tests/claims/csv_rows.h"

namespace papilla::tests::reproduce_test {
namespace {

TEST(Reproduce, TheoryClaimsEndInTheirKnownVerdicts) {
  // What the papers of the theory claim comes out, but for the places where their own numbers
  // contradict it; those are known and stay said.
  ReproduceOptions options;
  for (const Claim& claim : theory_claims()) options.ids.push_back(claim.id);
  const auto results = reproduce(options);
  EXPECT_EQ(results.size(), options.ids.size());
  for (const ClaimResult& r : results) {
    const std::string& id = r.claim->id;
    const Verdict expected = id == "P19" || id == "P21" || id == "J2" ? Verdict::PaperInconsistent
                             : id == "P18"                            ? Verdict::Fitted
                             : id == "S3"                             ? Verdict::NotTestable
                                                                      : Verdict::Agrees;
    EXPECT_EQ(r.papilla.verdict, expected) << id << ": " << r.papilla.model;
    EXPECT_FALSE(r.papilla.model.empty()) << id;
    if (r.papilla.verdict != Verdict::Agrees) {
      EXPECT_FALSE(r.papilla.reason.empty()) << id;
    }
  }
}

// Every number that a theory claim shows, beside the committed table of all claims.
TEST(Reproduce, TheoryClaimsSayWhatTheCommittedTableSays) {
  std::map<std::string, std::vector<std::string>> table;
  const std::string path = std::string(PAPILLA_SOURCE_DIR) + "/results/reproduction/claims.csv";
  for (const auto& row : csv_rows(read_bytes(path))) table[row.at(0)] = row;
  ReproduceOptions options;
  for (const Claim& claim : theory_claims()) options.ids.push_back(claim.id);
  const auto results = reproduce(options);
  auto today = csv_rows(claims_csv(results));
  ASSERT_EQ(today.size(), results.size() + 1);
  EXPECT_EQ(today[0], table.at("id"));
  for (std::size_t i = 1; i < today.size(); ++i) {
    std::vector<std::string>& now = today[i];
    const std::vector<std::string>& then = table.at(now[0]);
    const double value = std::stod(then.at(5));
    EXPECT_NEAR(std::stod(now.at(5)), value, 1e-5 * std::abs(value) + 1e-13) << now[0];
    now[5] = then[5];
    if (then[7].find("1e-") != std::string::npos ||
        then[7].find("relative difference") != std::string::npos)
      continue;  // differences that are rounding
    EXPECT_EQ(now, then) << now[0];
  }
}

TEST(Reproduce, AgreementOfAFittedClaimIsNoPrediction) {
  ReproduceOptions options;
  options.ids = {"P1", "P2"};
  options.finger.fitted_to = "M1 P1";
  const auto results = reproduce(options);
  ASSERT_EQ(results.size(), 2u);
  EXPECT_EQ(results[0].papilla.verdict, Verdict::Fitted);
  EXPECT_EQ(results[1].papilla.verdict, Verdict::Agrees);
}

TEST(Reproduce, AnUnknownClaimIsAMistakeOfTheUser) {
  ReproduceOptions options;
  options.ids = {"P99"};
  EXPECT_THROW(reproduce(options), InputError);
}

TEST(Reproduce, TablesHaveARowAClaim) {
  ReproduceOptions options;
  options.ids = {"P1", "P2", "P21"};
  const auto results = reproduce(options);
  const auto json = nlohmann::json::parse(claims_json(results));
  EXPECT_EQ(json["schema"], 1);
  ASSERT_EQ(json["claims"].size(), 3u);
  for (const char* key : {"id", "paper", "model", "se", "verdict", "reason"}) {
    EXPECT_TRUE(json["claims"][0].contains(key)) << key;
  }
  EXPECT_EQ(json["counts"]["agrees"], 2);
  EXPECT_EQ(json["counts"]["paper inconsistent"], 1);
  std::istringstream csv(claims_csv(results));
  int lines = 0;
  for (std::string line; std::getline(csv, line);) ++lines;
  EXPECT_EQ(lines, 4);
  EXPECT_NE(claims_markdown(results, "reference").find("| P21 |"), std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::reproduce_test
