// When more measurements are not worth it, and what a journal keeps of a plan.
#include "lab/planning.h"

#include <gtest/gtest.h>

#include "lab/records.h"
#include "tests/lab/ensembles.h"

namespace papilla::tests::planning_test {
namespace {

// Two designs whose difference is N(1, 1), and a batch of one touch that reads it with N(0, s^2):
// the expected regret is .083, n touches lower it by s' phi(1/s') - Phi(-1/s'), s'^2 = 1 / (1 +
// s^2/n), and change the choice with probability Phi(-1/s').
std::optional<StopReason> after_one_touch(double s, double small) {
  Ensemble e = linear_ensemble(1500, {{1.0}}, {{1.0}, {0.0}});
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
  const PlanRecord again = *read_entry(entry_text(entry)).plan;
  EXPECT_EQ(again.stop_reason, StopReason::NoChange);
  EXPECT_EQ(again.ended, BatchEnd::Time);
  EXPECT_EQ(again.shortest, 3600);
  const PlanRecord older = *read_entry(R"({"plan":{"date":"2026-03-01","aim":"decision",)"
                                       R"("experiments":[],"seconds":0.0,"regret_now":0.1,)"
                                       R"("regret_after":0.1,"p_change":0.0,"stop":true}})")
                                .plan;
  EXPECT_TRUE(older.stop);
  EXPECT_FALSE(older.stop_reason || older.ended);
}

}  // namespace
}  // namespace papilla::tests::planning_test
