// Numbers that carry what is behind them, and where two texts differ.
#include "report/receipts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "report/stated_number.h"
#include "report/text_difference.h"
#include "tests/support/refusal.h"

namespace papilla::tests::receipts_test {
namespace {

using Json = nlohmann::ordered_json;

StatedNumber gain() {
  return {"gain of \"it\"", 0.031, "mN", {0.012, ""}, {{}, "not known"}, {Stage::Confirm}};
}

TEST(StatedNumber, IsReadAsItsTextAndGivesBackWhatIsBehindIt) {
  const std::string text = "It gains " + stated(gain(), "0.031 ± 0.012 mN") + " and 2.";
  EXPECT_EQ(as_read(text), "It gains 0.031 ± 0.012 mN and 2.");
  const std::vector<TextPart> parts = said_parts(text);
  ASSERT_EQ(parts.size(), 3u);
  ASSERT_TRUE(parts[1].number.has_value());
  EXPECT_EQ(parts[1].number->words, gain().words);
  EXPECT_EQ(parts[1].number->value, 0.031);
  EXPECT_EQ(parts[1].number->numerical, gain().numerical);
  EXPECT_EQ(parts[1].number->model, gain().model);
  EXPECT_EQ(parts[1].number->rests_on, gain().rests_on);
}

TEST(StatedNumber, IsANumberAgainInJson) {
  const Json json{
      {"value", stated_value(gain())}, {"said", {"a " + stated(gain(), "3")}}, {"n", 2}};
  EXPECT_EQ(as_read(json), (Json{{"value", 0.031}, {"said", {"a 3"}}, {"n", 2}}));
  StatedNumber none = gain();
  none.value = std::nan("");
  EXPECT_TRUE(as_read(Json(stated_value(none))).is_null());
}

// A name in a stranger's study may hold the characters that a number begins with.
TEST(StatedNumber, IsNothingThatAStrangerCanWriteByAccident) {
  for (const std::string text : {"\x01", "a\x01{}\x02z\x03", "\x01{\"words\":1}\x02z\x03",
                                 "\x02\x03\x01", "\x01[]\x02\x03"}) {
    EXPECT_EQ(as_read(text), text);
    for (const TextPart& part : said_parts(text)) EXPECT_FALSE(part.number.has_value());
  }
}

TEST(Receipts, ReadBackAsTheyWereWritten) {
  Receipts receipts{"0.1.0", "knee", true, "abc", "a study", {}};
  receipts.list.push_back({"r01", gain(), "0.031", {"run.json#/recommendation"}, "def"});
  const std::string text = receipts_text(receipts);
  const Receipts back = read_receipts(text, "receipts.json");
  EXPECT_EQ(receipts_text(back), text);
  EXPECT_EQ(back.pick, "knee");
  EXPECT_TRUE(back.finish);
  EXPECT_EQ(back.name, "a study");
  EXPECT_EQ(back.list.at(0).number.numerical, gain().numerical);
  for (const std::string& damaged :
       {std::string(), std::string("[]"), std::string("{\"version\": 3}"),
        text.substr(0, text.size() / 2)})
    EXPECT_NE(refusal_of([&] { read_receipts(damaged, "receipts.json"); }).find("receipts.json"),
              std::string::npos);
}

TEST(TextDifference, FindsTheWordThatWasChanged) {
  const std::string text = "Build design 01 (holes 3 um wide).\nIt gains 0.031 ± 0.012.";
  EXPECT_TRUE(word_differences(text, text).empty());
  std::string other = text;
  other.replace(other.find("0.031"), 5, "0.131");
  const std::vector<WordDifference> found = word_differences(other, text);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].says, "0.131");
  EXPECT_EQ(found[0].expected, "0.031");
  EXPECT_EQ(found[0].at, text.find("0.031"));
  EXPECT_EQ(line_text(text, found[0].at), "line 2");
}

TEST(TextDifference, OfNumbersIsBeyondTheRoundingOfAnotherMachine) {
  EXPECT_TRUE(word_differences("a 0.1234567890", "a 0.1234567891").empty());
  EXPECT_FALSE(word_differences("a 0.12345", "a 0.12346").empty());
  EXPECT_FALSE(word_differences("a 1um", "a 1nm").empty());
}

TEST(TextDifference, IsToldWhereAWordIsMissing) {
  EXPECT_EQ(word_differences("a b", "a b c").at(0).expected, "c");
  EXPECT_EQ(word_differences("a b c d", "a b c").at(0).says, "d");
  EXPECT_EQ(word_differences("", "a").at(0).expected, "a");
}

}  // namespace
}  // namespace papilla::tests::receipts_test
