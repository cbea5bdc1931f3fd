#include "forward/status.h"

#include <gtest/gtest.h>

#include <set>

#include "base/check.h"
#include "forward/response.h"

namespace papilla::tests::status_test {
namespace {

constexpr int kTroubles = static_cast<int>(Trouble::RidgesCarry) + 1;

TEST(Status, EveryTroubleHasWordsOfItsOwn) {
  std::set<std::string> words;
  for (int t = 0; t < kTroubles; ++t)
    words.insert(text(ModelStatus{static_cast<Trouble>(t), 2, ""}));
  EXPECT_EQ(words.size(), static_cast<std::size_t>(kTroubles));
  EXPECT_EQ(text(ModelStatus{}), "ok");
  // There is none beyond those that are looked at here.
  EXPECT_THROW(text(ModelStatus{static_cast<Trouble>(kTroubles), 0, ""}), base::InternalError);
}

TEST(Status, TheFirstTroubleIsKept) {
  ModelStatus status;
  status.note({});
  EXPECT_TRUE(status.sound());
  status.note({Trouble::Flooded, 0, ""});
  status.note({Trouble::PassesUsedUp, 0, ""});
  EXPECT_EQ(status.trouble, Trouble::Flooded);
  status.note({});
  EXPECT_EQ(status.trouble, Trouble::Flooded);
}

TEST(Status, NoTroubleHidesAPullIn) {
  for (int t = 0; t < kTroubles; ++t) {
    ModelStatus status{static_cast<Trouble>(t), 0, ""};
    const Trouble first = status.trouble;
    const bool closed = status.pull_in();
    status.note({Trouble::GrowingPullIn, 0, ""});
    EXPECT_EQ(status.trouble, closed ? first : Trouble::GrowingPullIn) << t;
    status.note({Trouble::Flooded, 0, ""});
    EXPECT_TRUE(status.pull_in()) << t;
    // Nor a pull-in of the drive one that needs none.
    status.note({Trouble::UndrivenPullIn, 0, ""});
    status.note({Trouble::ClosedPullIn, 0, ""});
    EXPECT_EQ(status.trouble, Trouble::UndrivenPullIn) << t;
  }
}

TEST(Status, OnlyATroubleWithoutEquilibriumIsPullIn) {
  int pull_in = 0;
  for (int t = 0; t < kTroubles; ++t) {
    const ModelStatus status{static_cast<Trouble>(t), 0, ""};
    EXPECT_EQ(status.pull_in(), text(status).starts_with("pull-in")) << text(status);
    pull_in += status.pull_in();
  }
  EXPECT_EQ(pull_in, 5);
}

TEST(Status, NumbersAndReasonsAreSaidInTheirUnits) {
  EXPECT_EQ(text(ModelStatus{Trouble::WaterMoves, 200, ""}),
            "water: droplets not at rest after 200 moves of one");
  EXPECT_EQ(text(ModelStatus{Trouble::ContactUnsolved, 0, "why"}), "contact: why");
  EXPECT_EQ(text(ModelStatus{Trouble::FieldUnsolved, 0, "why"}), "field: why");
  EXPECT_TRUE(text(ModelStatus{Trouble::SecondPassPullIn, 1.25, ""})
                  .starts_with("pull-in: the gap closes, a second pass would raise the pull by "
                               "125 % ("));
  EXPECT_EQ(text(ModelStatus{Trouble::PassesUsedUp, 12, ""}),
            "coupling: not settled after 12 passes");
  EXPECT_TRUE(text(ModelStatus{Trouble::FullContact, 1.5, ""})
                  .starts_with("full contact: the area estimate is 1.5 times the patch, "));
  EXPECT_EQ(text(std::vector<PointTrouble>{}), "");
  EXPECT_EQ(text(std::vector<PointTrouble>{{0.15, {Trouble::ContactUnsolved, 0, "a"}},
                                           {0.75, {Trouble::FieldUnsolved, 0, "b"}}}),
            "15 % RH: contact: a; 75 % RH: field: b");
}

// Humidities read unlike each other and unlike the one that the water was fitted at.
TEST(Status, HumiditiesHaveTheDigitsThatTellThemApart) {
  EXPECT_EQ(humidity_decimals({}), 0);
  EXPECT_EQ(humidity_decimals({0.154, 0.75, 0.154}), 0);
  EXPECT_EQ(humidity_decimals({0.75, 0.149, 0.15}), 1);
  EXPECT_EQ(humidity_decimals({0.75, 0.7501}), 2);
  EXPECT_EQ(humidity_decimals({0.75, 0.75 + 1e-12}), 0);  // one humidity
  const std::string low =
      text(std::vector<PointTrouble>{{0.149, {Trouble::WaterBeyondFit, 0.15, ""}}});
  EXPECT_TRUE(low.starts_with("14.9 % RH: water beyond its fit: ")) << low;
  EXPECT_NE(low.find("fitted up to 15 % RH"), std::string::npos) << low;
  EXPECT_NE(text(ModelStatus{Trouble::WaterBeyondFit, 0.752, ""}).find("up to 75.2 % RH"),
            std::string::npos);
}

TEST(Status, ATroubleIsSaidOnceWithItsHumidities) {
  EXPECT_EQ(text(std::vector<PointTrouble>{{0.15, {Trouble::ContactUnsolved, 0, "a"}},
                                           {0.35, {Trouble::FieldUnsolved, 0, "b"}},
                                           {0.75, {Trouble::ContactUnsolved, 0, "a"}}}),
            "15, 75 % RH: contact: a; 35 % RH: field: b");
}

TEST(Status, AFloodDoesNotHideWaterBeyondItsFit) {
  Response r;
  for (const double rh : {0.5, 0.8, 0.95}) r.points.emplace_back().relative_humidity = rh;
  const ModelStatus beyond{Trouble::WaterBeyondFit, 0.75, ""}, flooded{Trouble::Flooded, 0, ""};
  r.points[1].water_fit = r.points[2].water_fit = beyond;
  r.points[1].status = beyond, r.points[2].status = flooded;
  EXPECT_EQ(r.said(), (std::vector<PointTrouble>{{0.8, beyond}, {0.95, flooded}, {0.95, beyond}}));
}

TEST(Status, AResponseTellsItsTroublesByHumidity) {
  Response r;
  for (const double rh : {0.2, 0.4, 0.6}) r.points.emplace_back().relative_humidity = rh;
  EXPECT_TRUE(r.troubles().empty());
  r.points[1].status.note({Trouble::Flooded, 3, ""});
  ASSERT_EQ(r.troubles().size(), 1u);
  EXPECT_EQ(r.troubles()[0], (PointTrouble{0.4, {Trouble::Flooded, 3, ""}}));
}

// What a voltage beyond breakdown leads to never happens: that is said first, and no number is
// known under it.
TEST(Status, BreakdownIsSaidBeforeWhatItLeadsTo) {
  ResponsePoint p;
  p.status.note({Trouble::FullContact, 3e4, ""});
  p.area_fraction_off.value = 0.01, p.area_fraction_on.value = 300;
  EXPECT_EQ(p.said(), p.status);
  EXPECT_TRUE(p.knows_undriven());
  EXPECT_FALSE(p.knows_driven());
  p.oxide_margin = 0.004;
  EXPECT_EQ(p.said(), (ModelStatus{Trouble::Breakdown, 250, ""}));
  EXPECT_TRUE(p.knows_undriven());
  EXPECT_FALSE(p.knows_driven());
  p.oxide_margin = 1, p.status = {}, p.area_fraction_on.value = 0.02;
  EXPECT_TRUE(p.said().sound() && p.knows_driven());
  p.status.note({Trouble::FieldUnsolved, 0, "why"});
  EXPECT_FALSE(p.knows_driven());
  p.status = {Trouble::WaterBeyondFit, 0.75, ""};
  EXPECT_TRUE(p.knows_driven());
  p.area_fraction_off.value = 1.01;
  EXPECT_FALSE(p.knows_undriven() || p.knows_driven());
  Response r;
  r.points = {p};
  r.points[0].relative_humidity = 0.9, r.points[0].oxide_margin = 0.5;
  EXPECT_EQ(r.said(), (std::vector<PointTrouble>{{0.9, {Trouble::Breakdown, 2, ""}}}));
  EXPECT_EQ(r.troubles(), (std::vector<PointTrouble>{{0.9, p.status}}));
}

// The drive's leaves what was before it; water alone leaves nothing.
TEST(Status, PastPullInNoNumberIsKnown) {
  for (int t = 0; t < kTroubles; ++t) {
    ResponsePoint p;
    p.status = {static_cast<Trouble>(t), 2, ""};
    if (!p.status.pull_in()) continue;
    p.source_voltage = 200;
    EXPECT_EQ(p.knows_undriven(), !p.status.pull_in_undriven()) << t;
    EXPECT_FALSE(p.knows_driven()) << t;
    p.source_voltage = 0;
    EXPECT_FALSE(p.knows_undriven() || p.knows_driven()) << t;
  }
}

TEST(Status, EveryEndOfASearchForAVoltageHasItsWords) {
  VoltageAnswer a;
  a.limit = 312.345;
  a.model = {Trouble::ContactUnsolved, 0, "why"};
  const auto said = [&](VoltageEnd end) {
    a.end = end;
    return text(a);
  };
  EXPECT_EQ(said(VoltageEnd::Reached), "reached");
  EXPECT_EQ(said(VoltageEnd::NoDielectric),
            "no dielectric, or none on side walls: contact would short the drive");
  EXPECT_EQ(said(VoltageEnd::Breakdown), "the dielectric breaks down at 312.3 V");
  EXPECT_EQ(said(VoltageEnd::Unsound), "contact: why");
  EXPECT_EQ(said(VoltageEnd::NotConverged), "the search for the voltage has not converged");
  EXPECT_FALSE(a.reached());
  TargetReport r;
  r.end = TargetEnd::PlanUnsettled;
  EXPECT_EQ(text(r), "not reached: the plan does not settle");
  r.end = TargetEnd::TimeSpent;
  EXPECT_EQ(text(r), "not reached: the time limit of the run left no more");
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
}  // namespace papilla::tests::status_test
