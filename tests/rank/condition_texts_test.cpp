// Conditions as wholes: every section of a design for every kind of criterion, values as files have
// them, and the whole message of a refusal.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "base/error.h"
#include "rank/conditions.h"
#include "tests/rank/samples.h"
#include "tests/support/refusal.h"

namespace papilla::tests::condition_texts_test {
namespace {

std::vector<std::string> keys(const Design& a, const Design& b, const std::string& criteria) {
  std::vector<std::string> out;
  for (const ConditionDifference& d : condition_differences({{a}, {b}}, by(criteria)))
    out.push_back(d.key);
  return out;
}

// What is felt depends on finger, air, model and accuracy, with a drive on that as well; a look on
// the view alone.
TEST(ConditionTexts, EachKindOfCriterionHasItsOwnConditions) {
  Design a, b;
  b.finger.load = 0.3;
  b.environment.relative_humidity = {0.5};
  b.model.rim_pinning = true;
  b.accuracy.grid = 64;
  b.drive.amplitude = 50;
  b.view.fill_index = 1.3;
  b.texture = Texture{HoleArray{}};
  b.surface.contact_angle = 1.2;
  b.title = "other";
  using Keys = std::vector<std::string>;
  const Keys felt{"finger.load", "environment.relative_humidity", "model.rim_pinning",
                  "accuracy.grid"};
  Keys driven = felt, all;
  driven.push_back("drive.amplitude");
  all = driven;
  all.push_back("view.fill_index");
  Keys felt_and_seen = felt;
  felt_and_seen.push_back("view.fill_index");
  EXPECT_EQ(keys(a, b, "friction:low"), felt);
  EXPECT_EQ(keys(a, b, "modulation:high"), driven);
  EXPECT_EQ(keys(a, b, "friction:low,modulation:high"), driven);
  EXPECT_EQ(keys(a, b, "modulation:high,friction:low"), driven);
  EXPECT_EQ(keys(a, b, "haze:low"), (Keys{"view.fill_index"}));
  EXPECT_EQ(keys(a, b, "haze:low,friction:low"), felt_and_seen);
  EXPECT_EQ(keys(a, b, "friction:low,haze:low"), felt_and_seen);
  EXPECT_EQ(keys(a, b, "modulation:high,gloss:high"), all);
}

TEST(ConditionTexts, TheStoryOfAFingerItsStateAndTheTargetAreNone) {
  Design a, b;
  b.finger.name = "other";
  b.finger.fitted_to = "M1";
  b.finger.uncertainty = {{"skin.rms", 0.1, {}}};
  b.finger.calibrated_for.rim_pinning = true;
  b.finger.state = FingerState::Wet;
  b.accuracy.target = 0.02;
  b.accuracy.parameters = true;
  EXPECT_TRUE(keys(a, b, "modulation:high,haze:low").empty());
  EXPECT_TRUE(keys(b, a, "modulation:high,haze:low").empty());
}

// A number with its unit, a number, a word, yes or no, a list and a list of other length.
TEST(ConditionTexts, ValuesAreWrittenAsFilesHaveThem) {
  Design a, b;
  a.finger.load = 0.25;
  b.finger.skin.hurst = 0.75;
  b.finger.skin.map = "skin.exr";
  b.model.droplet_enhancement = false;
  b.model.water = WaterModel::Threshold;
  b.environment.relative_humidity = {0.5, 0.6};
  b.accuracy.droplet_seeds = 6;
  std::map<std::string, std::string> texts;
  for (const ConditionDifference& d : condition_differences({{a}, {b}}, by("friction:low")))
    texts[d.key] = d.value + " | " + d.other_value;
  EXPECT_EQ(texts, (std::map<std::string, std::string>{
                       {"finger.load", "0.25 N | 0.2 N"},
                       {"finger.skin.hurst", "0.8 | 0.75"},
                       {"finger.skin.map", " | skin.exr"},
                       {"model.droplet_enhancement", "true | false"},
                       {"model.water", "droplets | threshold"},
                       {"environment.relative_humidity",
                        "[\"15 %\", \"35 %\", \"55 %\", \"75 %\"] | [\"50 %\", \"60 %\"]"},
                       {"accuracy.droplet_seeds", "1 | 6"}}));
}

TEST(ConditionTexts, NamesAreThoseGivenThenTitlesThenNumbers) {
  Design a, b, c;
  a.title = "mine";
  b.finger.load = 0.3;
  c.finger.load = 0.2;
  c.environment.relative_humidity = {0.5};
  RankOptions options = by("friction:low");
  options.names = {"one", "two"};
  std::vector<std::string> texts;
  for (const ConditionDifference& d : condition_differences({{a}, {b}, {c}}, options))
    texts.push_back(d.first + " | " + d.other);
  EXPECT_EQ(texts, (std::vector<std::string>{"one | two", "one | candidate 3"}));
  texts.clear();
  c.title = "wet";
  for (const ConditionDifference& d : condition_differences({{a}, {b}, {c}}, by("friction:low")))
    texts.push_back(d.first + " | " + d.other);
  EXPECT_EQ(texts, (std::vector<std::string>{"\"mine\" | candidate 2", "\"mine\" | \"wet\""}));
}

// Six are shown, three are settable; what is beyond is counted.
TEST(ConditionTexts, TheWholeRefusalOfAnyNumberOfDifferences) {
  const auto refusal = [](int count) -> std::string {
    std::vector<ConditionDifference> list;
    for (int i = 0; i < count; ++i) list.push_back({fmt::format("k{}", i), "a", "1", "2", "b"});
    return refusal_of([&] { require_same_conditions(list); });
  };
  const auto expected = [](int shown, const std::string& more, const std::string& equal) {
    std::string lines;
    for (int i = 0; i < shown; ++i) lines += fmt::format("\n  k{}: 1 in a, 2 in b", i);
    return "the candidates are not judged under the same conditions, so that their order would say "
           "nothing about the surfaces:" +
           lines + more + "\nmake them equal: " + equal +
           "; or compare them as they are: --any-conditions";
  };
  const std::string same = "the same [finger] base, environment, drive and accuracy in every file";
  EXPECT_EQ(refusal(0), "");
  EXPECT_EQ(refusal(1), expected(1, "", "--set 'k0=1'"));
  EXPECT_EQ(refusal(3), expected(3, "", "--set 'k0=1' --set 'k1=1' --set 'k2=1'"));
  EXPECT_EQ(refusal(4), expected(4, "", same));
  EXPECT_EQ(refusal(6), expected(6, "", same));
  EXPECT_EQ(refusal(7), expected(6, "\n  and 1 keys more", same));
  EXPECT_EQ(refusal(9), expected(6, "\n  and 3 keys more", same));
}

TEST(CriteriaTexts, EachRefusalSaysWhatIsWrong) {
  const auto refusal = [](const std::string& text) -> std::string {
    return refusal_of([&] { parse_criteria(text); });
  };
  EXPECT_EQ(refusal("friction"), "");
  EXPECT_EQ(refusal("compliance"),
            "compliance has no better direction of its own; say compliance:low or compliance:high");
  EXPECT_EQ(refusal("compliance:high,bridges:low"), "");
  EXPECT_EQ(refusal("friction:down"), "\"down\" is no direction; use low or high");
  EXPECT_EQ(refusal("compliance:up"), "\"up\" is no direction; use low or high");
  EXPECT_EQ(refusal("voltage_for(modulation = 0.2):low"),
            "\"voltage_for(modulation = 0.2)\": a ranking is by forces at the designs' own drive");
  EXPECT_EQ(refusal("felt(modulation = 0.2):high"),
            "\"felt(modulation = 0.2)\": a ranking is by forces at the designs' own drive");
  EXPECT_EQ(refusal("friction:low,"), "\"friction:low,\": expected METRIC:low or METRIC:high");
  const std::vector<Criterion> own = parse_criteria("friction,modulation,range(modulation),gloss");
  std::string texts;
  for (const Criterion& c : own) texts += c.text() + " ";
  EXPECT_EQ(texts,
            "mean(friction):low mean(modulation):high range(modulation):low mean(gloss):high ");
}

}  // namespace
}  // namespace papilla::tests::condition_texts_test
