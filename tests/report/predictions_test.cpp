// Predictions as tables: what is said of a model part, and of one that is missing.
#include "report/predictions.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace papilla::tests::predictions_test {
namespace {

std::vector<Prediction> some() {
  return {{"a", "on glass", "ratio", "", {2, 0.25}, "", true, 0.5, 32, 0},
          {"b", "on glass", "amplitude", "V", {91.2, 2.4}, "", true, 8.0, 32, 3},
          {"c", "on glass", "amplitude", "V", {80, 2}, "", true, std::nullopt, 32, 30},
          {"d", "glass", "haze", "%", {1.06, 0}, "", false, std::nullopt, 32, 0}};
}

TEST(PredictionTables, SayWhyANumberHasNoModelPart) {
  const std::string text = predictions_text(some()), page = predictions_markdown(some(), "mine");
  for (const char* said :
       {"2 ± 0.25 numerical ± 0.5 model",
        "91.2 ± 2.4 numerical ± 8 model V (model part of 29 members: 3 of 32 members have no "
        "answer)",
        "80 ± 2 V (model part not known: 30 of 32 members have no answer)",
        "1.06 % (hangs on no finger)"}) {
    EXPECT_NE(text.find(said), std::string::npos) << said << "\n" << text;
    EXPECT_NE(page.find(said), std::string::npos) << said << "\n" << page;
  }
  EXPECT_NE(page.find("(its belief)"), std::string::npos);
  const auto json = nlohmann::json::parse(predictions_json(some(), "mine"))["predictions"];
  EXPECT_EQ(json[0]["model_note"], "");
  EXPECT_TRUE(json[2]["model"].is_null());
  EXPECT_EQ(json[2]["model_note"], "model part not known: 30 of 32 members have no answer");
  EXPECT_NE(predictions_csv(some()).find(",80,2,,,model part not known: 30 of 32 members"),
            std::string::npos);
}

TEST(PredictionTables, SayNothingOfMembersWithoutABelief) {
  std::vector<Prediction> plain = some();
  for (Prediction& p : plain) p.members = p.silent = 0, p.model.reset();
  EXPECT_EQ(predictions_text(plain).find("members"), std::string::npos);
  EXPECT_EQ(predictions_text(plain).find("hangs"), std::string::npos);
  EXPECT_NE(predictions_markdown(plain, "mine").find("the finger names no belief"),
            std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::predictions_test
