// When more measurements are not worth it, and what a journal keeps of a plan.
#include "lab/planning.h"

#include <gtest/gtest.h>

#include "lab/records.h"
#include "tests/lab/ensembles.h"
#include "tests/support/refusal.h"

namespace papilla::tests::planning_test {
namespace {

// Two designs whose difference is N(1, 1), and a batch of one touch that reads it with N(0, s^2):
// the expected regret is .083, n touches lower it by s' phi(1/s') - Phi(-1/s'), s'^2 = 1 / (1 +
// s^2/n), and change the choice with probability Phi(-1/s').
std::optional<StopReason> after_one_touch(double s, double small) {
  Ensemble e = linear_ensemble(500, {{1.0}}, {{1.0}, {0.0}});
  for (double& u : e.worth[0]) u += 1;
  const Kernels k = kernels_of(e);
  const Instrument instrument = plain_instrument(s);
  const Evidence none(e, k, instrument);
  const DecisionLimits limits;
  DecisionGain gain(e, k, none, limits, 1000);
  Candidate touch;
  touch.readings = {observation(0, s)};
  BatchOptions one;
  one.count = 1;
  const Batch batch = choose_batch({touch}, gain, one);
  EXPECT_EQ(batch.end, BatchEnd::Count);
  return reason_to_stop({touch}, batch, one.costs, small, gain);
}

TEST(Planning, StopsWhereLittleIsExpectedToBeLost) {
  EXPECT_EQ(after_one_touch(3, 0.2), StopReason::Regret);
}

// One touch of s = 3 saves .00005 and changes the choice once in a thousand; ten save .028 and do
// so once in twelve.
TEST(Planning, GoesOnWhereMoreTouchesThanAShortBatchHasChangeTheChoice) {
  EXPECT_EQ(after_one_touch(3, 0.01), std::nullopt);
}

TEST(Planning, StopsWhereTenTouchesChangeNothing) {
  EXPECT_EQ(after_one_touch(30, 0.01), StopReason::NoChange);
}

TEST(Planning, KeepsWhyABatchEndsAndReadsPlansThatDoNotSay) {
  JournalEntry entry;
  entry.plan = PlanRecord{};
  entry.plan->date = "2026-03-01";
  entry.plan->stop = true;
  entry.plan->stop_reason = StopReason::NoChange;
  entry.plan->ended = BatchEnd::Time;
  entry.plan->shortest = 3600;
  entry.plan->best_worth = -0.05;
  const PlanRecord again = *read_entry(entry_text(entry, {}), {}).plan;
  EXPECT_EQ(again.stop_reason, StopReason::NoChange);
  EXPECT_EQ(again.ended, BatchEnd::Time);
  EXPECT_EQ(again.shortest, 3600);
  EXPECT_EQ(again.best_worth, -0.05);
  const PlanRecord older = *read_entry(R"({"plan":{"date":"2026-03-01","aim":"decision",)"
                                       R"("experiments":[],"seconds":0.0,"regret_now":0.1,)"
                                       R"("regret_after":0.1,"p_change":0.0,"stop":true}})",
                                       {})
                                .plan;
  EXPECT_TRUE(older.stop);
  EXPECT_FALSE(older.stop_reason || older.ended);
  EXPECT_EQ(older.best_worth, 0);
}

// An older program wrote the places of designs in the list, in keys too.
TEST(Journal, ReadsPlacesOfDesignsWhereTheListIsThatOfThen) {
  const std::string text =
      R"({"tell":{"date":"2026-03-02","file":"a.csv","sha256":"","trace":false,"notes":[],)"
      R"("readings":[{"experiment":{"design":1,"load":0.2,"humidity":0.35,"voltage":0.0,)"
      R"("frequency":0.0,"state":"clean"},"id":"","field":"","finger":"1","day":"1","repeat":1,)"
      R"("off":0.06,"off_sd":0.0,"on":0.0,"on_sd":0.0,"line":2,"key":"1 | clean | 1"}],)"
      R"("replaced":["0 | clean | 1"]},"decision":{"date":"2026-03-02","readings":1,)"
      R"("best":"deep","p_best":1.0,"regret":0.0,"p_designs":[1.0,0.0],"p_hypothesis":[1.0],)"
      R"("effective_members":6.0,"explained":1.0,"discrepancy":"","designs":["deep","shallow"]}})";
  const std::vector<std::string> designs{"deep", "shallow", "added"};
  const JournalEntry entry = read_entry(text, designs);
  const FrictionReading& reading = entry.tell->readings.front();
  EXPECT_EQ(reading.experiment.design, 1u);
  EXPECT_EQ(reading.key, "\"shallow\" | clean | 1");
  EXPECT_EQ(entry.tell->replaced, std::vector<std::string>{"\"deep\" | clean | 1"});
  // As this program writes it, in a list of another order.
  const JournalEntry moved = read_entry(entry_text(entry, designs), {"added", "deep", "shallow"});
  EXPECT_EQ(moved.tell->readings.front().experiment.design, 2u);
  EXPECT_EQ(moved.tell->readings.front().key, reading.key);
  EXPECT_EQ(moved.tell->replaced, entry.tell->replaced);
  for (const std::vector<std::string>& other :
       {std::vector<std::string>{"deep"}, {"deep", "added"}, {"shallow", "deep"}})
    EXPECT_NE(refusal_of([&] { read_entry(text, other); }).find("an older program"),
              std::string::npos);
}

}  // namespace
}  // namespace papilla::tests::planning_test
