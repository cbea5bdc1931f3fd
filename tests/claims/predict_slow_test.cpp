#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "claims/predict.h"
#include "design/design.h"
#include "report/predictions.h"

namespace papilla::tests::predict_slow_test {
namespace {

const std::vector<Prediction>& few_skins() {
  static const std::vector<Prediction> once = [] {
    PredictOptions options;
    options.finger = read_finger(find_design("fingers/reference.toml"));
    options.finger.belief.clear();  // its members are asked elsewhere
    options.skins = 3;
    options.grid = 64;
    return predictions(options);
  }();
  return once;
}

const Prediction& find(const std::string& id, const std::string& condition) {
  const auto& all = few_skins();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Prediction& p) {
    return p.id == id && p.condition.find(condition) != std::string::npos;
  });
  EXPECT_NE(found, all.end()) << id << ", " << condition;
  return found == all.end() ? all.front() : *found;
}

TEST(PredictionsOfOneRun, AirThatBreaksDownTakesFromTheSquareOfTheVoltage) {
  // Where air insulates the pull goes with the square. A field that air holds does not grow, and a
  // gap that closes adds less than that takes.
  const double pull = find("pull over voltage", "").value.value;
  EXPECT_GT(pull, 1.4);
  EXPECT_LT(pull, 2);
  // Friction without voltage goes nearly with the load.
  EXPECT_NEAR(find("F_off over load", "").value.value, 1, 0.05);
  // The area follows the load less than in proportion, so the added friction lags behind the pull;
  // of friction what bridges hold grows a little besides.
  const double added = find("added friction over voltage", "").value.value;
  EXPECT_GT(added, 1.2);
  EXPECT_LT(added, pull);
  EXPECT_NEAR(find("added contact area over voltage", "").value.value, added, 5e-3);
}

TEST(PredictionsOfOneRun, ACurrentLosesToLoadWhatAVoltageKeeps) {
  // A larger contact takes less voltage for the same current.
  EXPECT_LT(find("modulation over load", "0.2 mA").value.value,
            find("modulation over load", "200 V").value.value - 0.8);
}

TEST(PredictionsOfOneRun, AnInsulatingFilmLosesLowFrequenciesAndALeakyOneGainsThem) {
  EXPECT_GT(find("added friction, 25 kHz over 10 Hz", "1e14").value.value, 1.2);
  EXPECT_LT(find("added friction, 25 kHz over 10 Hz", "1e8").value.value, 1);
}

TEST(PredictionsOfOneRun, AWetFingerSticksToSmoothGlassAtEveryLoad) {
  for (const char* load : {"0.05 N", "0.2 N", "1 N"})
    EXPECT_GT(find("friction, wet over clean", std::string("smooth glass, ") + load).value.value, 1)
        << load;
}

TEST(PredictionsOfOneRun, FrictionGrowsWhileGlassKeepsTheSweatIn) {
  EXPECT_GT(find("friction, 30 s over 1 s of touch", "flat").value.value, 1.05);
}

TEST(PredictionsOfOneRun, RougherGlassIsHazierAndDuller) {
  for (const auto& [rougher, smoother] : {std::pair{"100 nm", "50 nm"}, {"50 nm", "20 nm"}}) {
    EXPECT_GT(find("haze", rougher).value.value, find("haze", smoother).value.value);
    EXPECT_LT(find("gloss at 60 deg", rougher).value.value,
              find("gloss at 60 deg", smoother).value.value);
  }
}

// Exponents and ratios again from the numbers that are said beside them: "0.15 N: 12.3 mN; ...".
TEST(PredictionsOfOneRun, AreTheSlopesAndRatiosOfTheNumbersBesideThem) {
  int exponents = 0, ratios = 0;
  for (const Prediction& p : few_skins()) {
    if (p.quantity != "exponent" && p.quantity != "ratio") continue;
    EXPECT_EQ(p.samples.size(), 3u) << p.id;
    EXPECT_NEAR(mean_estimate(p.samples).value, p.value.value, 1e-12) << p.id;
    EXPECT_EQ(mean_estimate(p.samples).se, p.value.se) << p.id;
    std::vector<double> x, y;
    std::istringstream parts(p.beside);
    for (std::string part; std::getline(parts, part, ';');) {
      if (p.quantity == "exponent") x.push_back(std::log(std::stod(part)));
      y.push_back(std::log(std::stod(part.substr(part.find(':') + 1))));
    }
    ASSERT_GE(y.size(), 2u) << p.id;
    if (p.quantity == "ratio") {
      EXPECT_NEAR(p.value.value / std::exp(y.back() - y.front()), 1, 2e-3) << p.id;
      ++ratios;
      continue;
    }
    const double n = static_cast<double>(x.size()),
                 mx = std::accumulate(x.begin(), x.end(), 0.0) / n,
                 my = std::accumulate(y.begin(), y.end(), 0.0) / n;
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      xx += (x[i] - mx) * (x[i] - mx), xy += (x[i] - mx) * (y[i] - my);
    EXPECT_NEAR(p.value.value, xy / xx, 2e-3) << p.id << ", " << p.condition;
    ++exponents;
  }
  EXPECT_GE(exponents, 8);
  EXPECT_EQ(ratios, 11);
}

TEST(PredictionsOfOneRun, ReadBackFromTheirTables) {
  const auto json = nlohmann::json::parse(predictions_json(few_skins(), "reference"));
  ASSERT_EQ(json["predictions"].size(), few_skins().size());
  for (std::size_t i = 0; i < few_skins().size(); ++i) {
    EXPECT_EQ(json["predictions"][i]["value"].get<double>(), few_skins()[i].value.value);
    EXPECT_NE(predictions_text(few_skins()).find(few_skins()[i].condition), std::string::npos);
  }
  const std::string csv = predictions_csv(few_skins());
  EXPECT_EQ(static_cast<std::size_t>(std::count(csv.begin(), csv.end(), '\n')),
            few_skins().size() + 1);
}

}  // namespace
}  // namespace papilla::tests::predict_slow_test
