#include "forward/status.h"

#include <gtest/gtest.h>

#include <set>

#include "forward/response.h"

namespace papilla {
namespace {

constexpr int kTroubles = static_cast<int>(Trouble::FullContact) + 1;

TEST(Status, EveryTroubleHasWordsOfItsOwn) {
  std::set<std::string> words;
  for (int t = 0; t < kTroubles; ++t)
    words.insert(text(ModelStatus{static_cast<Trouble>(t), 2, ""}));
  EXPECT_EQ(words.size(), static_cast<std::size_t>(kTroubles));
  EXPECT_EQ(text(ModelStatus{}), "ok");
}

TEST(Status, TheFirstTroubleIsKept) {
  ModelStatus status;
  status.note({});
  EXPECT_TRUE(status.sound());
  status.note({Trouble::Flooded, 0, ""});
  status.note({Trouble::ClosedPullIn, 0, ""});
  EXPECT_EQ(status.trouble, Trouble::Flooded);
}

TEST(Status, OnlyATroubleWithoutEquilibriumIsPullIn) {
  int pull_in = 0;
  for (int t = 0; t < kTroubles; ++t) {
    const ModelStatus status{static_cast<Trouble>(t), 0, ""};
    EXPECT_EQ(status.pull_in(), text(status).starts_with("pull-in")) << text(status);
    pull_in += status.pull_in();
  }
  EXPECT_EQ(pull_in, 4);
}

TEST(Status, AVoltageThatIsNotReachedNamesWhatCameFirst) {
  VoltageAnswer answer;
  answer.limit = 512.34;
  EXPECT_TRUE(answer.reached());
  answer.end = VoltageEnd::ModelEnds;
  answer.model = {Trouble::ClosedPullIn, 0, ""};
  EXPECT_EQ(text(answer), "pull-in: no equilibrium short of a closed gap at 512 V");
  answer.end = VoltageEnd::SourceEnds;
  EXPECT_EQ(text(answer), "the source ends at 512.3 V");
}

}  // namespace
}  // namespace papilla
