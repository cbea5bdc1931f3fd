#include "claims/reproduce.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.h"
#include "report/claims.h"

namespace papilla {
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
}  // namespace papilla
