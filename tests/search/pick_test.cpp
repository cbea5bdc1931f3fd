#include "search/pick.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "base/error.h"
#include "base/files.h"
#include "base/folder.h"
#include "search/records.h"
#include "tests/support/refusal.h"
#include "tests/temporary.h"

namespace papilla::tests::pick_test {
namespace {

const std::vector<std::string> kNames{"mean(modulation)", "variation(modulation)"};

// Mean (negated) against variation: the middle one gives up little for much.
const std::vector<PickCandidate> kFront{{kNames, {-0.50, 0.60}, 0.20},
                                        {kNames, {-0.46, 0.25}, 0.30},
                                        {kNames, {-0.40, 0.10}, 0.39},
                                        {kNames, {-0.30, 0.08}, 0.38}};

TEST(Pick, EachRuleHasItsDesign) {
  EXPECT_EQ(pick_design("", kFront), 2u);  // nowhere weaker than the others' weakest
  EXPECT_EQ(pick_design("worst", kFront), 2u);
  EXPECT_EQ(pick_design("knee", kFront), 1u);
  EXPECT_EQ(pick_design("mean(modulation)", kFront), 0u);
  EXPECT_EQ(pick_design("mean", kFront), 0u);
  EXPECT_EQ(pick_design("variation", kFront), 3u);
  EXPECT_EQ(pick_design("4", kFront), 3u);
}

// The second objective tells these apart by .01, known to 1: the first decides.
TEST(Pick, TheKneeDoesNotWeighWhatIsWithinTheError) {
  std::vector<PickCandidate> front{
      {kNames, {1.0, 0.000}}, {kNames, {0.5, 0.001}}, {kNames, {0.0, 0.010}}};
  EXPECT_EQ(pick_design("knee", front), 1u);
  for (PickCandidate& c : front) c.errors = {0.3, 1};
  EXPECT_EQ(pick_design("knee", front), 2u);
  const std::vector<ObjectiveRange> ranges = objective_ranges(front);
  EXPECT_EQ(ranges[0].low, 0);
  EXPECT_NEAR(ranges[0].width, std::hypot(1, 0.3), 1e-12);
  EXPECT_NEAR(ranges[1].width, std::hypot(0.01, 1), 1e-12);
  // Ranges that belief has decided with go before those of the front.
  EXPECT_EQ(pick_design("knee", front, {{0, 1}, {0, 0.01}}), 1u);
  front[0].errors[1] = std::numeric_limits<double>::infinity();  // not known
  EXPECT_NEAR(objective_ranges(front)[1].width, std::hypot(0.01, std::sqrt(2.0 / 3)), 1e-12);
}

TEST(Pick, OneDesignIsEveryRulesDesign) {
  for (const char* rule : {"", "worst", "knee", "variation", "1"})
    EXPECT_EQ(pick_design(rule, {kFront[0]}), 0u);
}

TEST(Pick, UnknownRulesAreRefused) {
  for (const char* rule : {"5", "0", "best", "3.5", "haze"})
    EXPECT_THROW(pick_design(rule, kFront), InputError) << rule;
  EXPECT_THROW(pick_design("", {}), InputError);
}

// The first of two would be picked without a word.
TEST(Pick, TheBeginningOfTwoObjectivesNamesNone) {
  const std::vector<std::string> names{"mean(modulation)", "mean(friction)"};
  EXPECT_EQ(read_pick_rule("mean(f", names, true), (PickRule{PickRule::Kind::Objective, 1}));
  EXPECT_EQ(refusal_of([&] { read_pick_rule("mean", names, true); }),
            "--pick: \"mean\" begins the names of 2 objectives; use one of \"worst\", \"knee\", "
            "\"mean(modulation)\", \"mean(friction)\" or the number of a design");
}

// A run keeps its journal: that it was interrupted stands in its run.json, or it has none.
TEST(Pick, OfARunWithoutAFrontSaysWhyThereIsNone) {
  const TemporaryFolder place;
  const std::string path = place.path();
  const Folder folder(path);
  const auto said = [&] { return refusal_of([&] { picked_design(folder, "knee"); }); };
  folder.write(kJournalName, "");
  EXPECT_NE(said().find("its run was interrupted"), std::string::npos) << said();
  folder.write("run.json", R"({"interrupted": true, "feasible": false})");
  EXPECT_NE(said().find("its run was interrupted"), std::string::npos) << said();
  folder.write("run.json", R"({"interrupted": false, "feasible": false})");
  EXPECT_EQ(said(), path +
                        ": no design of this run keeps every limit, so there is no front to pick "
                        "from");
  EXPECT_EQ(unfinished_hint(folder), "");
  folder.made_below("best").write("design.toml", "");
  EXPECT_NE(said().find("without --pick it is best/, which comes nearest"), std::string::npos)
      << said();
  EXPECT_EQ(picked_design(folder, ""), "best");
}

}  // namespace
}  // namespace papilla::tests::pick_test
