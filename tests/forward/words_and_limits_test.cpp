// Every word that an answer may end with, as one table, and bands of water at their limits.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "forward/response.h"
#include "forward/water_band.h"
#include "physics/capillary/droplets.h"

namespace papilla::tests::words_and_limits_test {
namespace {

TEST(AnswerWords, OfEveryTrouble) {
  const std::vector<std::pair<ModelStatus, std::string>> table{
      {{Trouble::None, 0, ""}, "ok"},
      {{Trouble::WaterMoves, 1000, ""}, "water: droplets not at rest after 1000 moves of one"},
      {{Trouble::ContactUnsolved, 0, "stuck"}, "contact: stuck"},
      {{Trouble::FieldUnsolved, 0, "shorted"}, "field: shorted"},
      {{Trouble::Flooded, 0, ""},
       "flooded: more water than gap, no meniscus and no capillary force"},
      {{Trouble::SecondPassPullIn, 1.257, ""},
       "pull-in: the gap closes, a second pass would raise the pull by 126 % (coupling = "
       "\"equilibrium\" seeks one)"},
      {{Trouble::ClosedPullIn, 0, ""}, "pull-in: no equilibrium short of a closed gap"},
      {{Trouble::GrowingPullIn, 0, ""},
       "pull-in: the attraction outgrows the skin's resistance, the gap jumps shut"},
      {{Trouble::FarGapPullIn, 0, ""}, "pull-in: the gaps between patches in contact close"},
      {{Trouble::UndrivenPullIn, 0, ""},
       "pull-in: load and water alone close the gap, without a voltage"},
      {{Trouble::PassesUsedUp, 12, ""}, "coupling: not settled after 12 passes"},
      {{Trouble::FullContact, 1.2345, ""},
       "full contact: the area estimate is 1.23 times the patch, friction and modulation mean "
       "nothing physical"}};
  for (const auto& [status, said] : table) {
    EXPECT_EQ(text(status), said);
    EXPECT_EQ(status.sound(), said == "ok");
    EXPECT_EQ(status.pull_in(), said.starts_with("pull-in: ")) << said;
  }
  EXPECT_EQ(
      text(std::vector<PointTrouble>{{0.154, {Trouble::ClosedPullIn, 0, ""}},
                                     {0.75, {Trouble::PassesUsedUp, 3, ""}}}),
      "15 % RH: pull-in: no equilibrium short of a closed gap; 75 % RH: coupling: not settled "
      "after 3 passes");
  EXPECT_EQ(text(std::vector<PointTrouble>{}), "");
}

TEST(AnswerWords, OfEveryTarget) {
  TargetReport r;
  r.quantity = "mean(modulation)";
  r.largest_part = "sampling", r.largest_share = 0.0567, r.largest_grid = 256, r.most_skins = 80;
  const std::vector<std::pair<TargetEnd, std::string>> table{
      {TargetEnd::Reached, "reached"},
      {TargetEnd::NoRelativeError, "mean(modulation) is zero: no relative error"},
      {TargetEnd::PlanUnsettled, "not reached: the plan does not settle"},
      {TargetEnd::LimitsReached,
       "not reached: sampling 5.7 % is the largest part; at most 256 pixels, 80 skins"},
      {TargetEnd::TimeSpent, "not reached: the time limit of the run left no more"}};
  for (const auto& [end, said] : table) {
    r.end = end;
    EXPECT_EQ(text(r), said);
  }
}

TEST(AnswerWords, OfEveryVoltage) {
  VoltageAnswer v;
  v.limit = 512.34;
  v.model = {Trouble::ClosedPullIn, 0, ""};
  const std::vector<std::pair<VoltageEnd, std::string>> table{
      {VoltageEnd::Reached, "reached"},
      {VoltageEnd::NoField, "what touches does not conduct: no field reaches it"},
      {VoltageEnd::NoDielectric,
       "no dielectric, or none on side walls: contact would short the drive"},
      {VoltageEnd::Breakdown, "the dielectric breaks down at 512.3 V"},
      {VoltageEnd::SourceEnds, "the source ends at 512.3 V"},
      {VoltageEnd::ModelEnds, "pull-in: no equilibrium short of a closed gap at 512 V"},
      {VoltageEnd::Unsound, "pull-in: no equilibrium short of a closed gap"},
      {VoltageEnd::NotConverged, "the search for the voltage has not converged"}};
  for (const auto& [end, said] : table) {
    v.end = end;
    EXPECT_EQ(text(v), said);
    EXPECT_EQ(v.reached(), said == "reached");
  }
}

TEST(AnswerWords, OnlyTroubledHumiditiesAreTold) {
  Response r;
  r.points.resize(3);
  r.points[0].relative_humidity = 0.2, r.points[1].relative_humidity = 0.4;
  r.points[1].status = {Trouble::Flooded, 0, ""};
  r.points[2].relative_humidity = 0.6;
  ASSERT_EQ(r.troubles().size(), 1u);
  EXPECT_EQ(r.troubles()[0], (PointTrouble{0.4, {Trouble::Flooded, 0, ""}}));
}

// Two patches of 1 uN that their water lifts off, and one that the drive lets go.
TEST(WaterBandLimits, NothingIsUnsureOfALoadThatIsGone) {
  const Grid grid{8, 8, 10e-6, 10e-6};
  std::vector<PatchResult> patches(2);
  for (PatchResult& p : patches) {
    p.load = 1e-6, p.capillary_off = -1.5e-6, p.pull = 2e-6;
    p.volume = 3e-18, p.bridge_volume = 1e-18;
  }
  ResponsePoint point;
  point.mean_gap.value = 200e-9, point.indentation.value = 1e-7;
  point.bridge_water_share = 1.0 / 3;
  point.friction_off.value = 2, point.friction_on.value = 3, point.retention_force.value = -0.2;
  point.bridges.value = 12, point.wetted_fraction.value = 0.1;
  point.area_fraction_off.value = 0.01, point.area_fraction_on.value = 0.02;
  point.modulation.value = -0.5;
  add_water_band(point, patches, WaterModel::Droplets, grid, {0.8, 0.8});
  const DropletBand band = droplet_band(3e-18 / grid.area(), 200e-9, 1.0 / 3);
  EXPECT_EQ(point.friction_off.parts.water, 0);  // 2 uN less 3
  EXPECT_EQ(point.area_fraction_off.parts.water, 0);
  // With the pull of 4 uN 3 are left; the band of -3 uN of capillary force and that of the pull.
  const double on = 0.8 * std::abs(band.capillary * -3 - band.pull * 4) / 3;
  EXPECT_NEAR(*point.friction_on.parts.water, 3 * on, 1e-12);
  EXPECT_NEAR(*point.area_fraction_on.parts.water, 0.02 * on, 1e-12);
  EXPECT_NEAR(*point.retention_force.parts.water, 0.2 * band.capillary, 1e-12);
  EXPECT_NEAR(*point.bridges.parts.water, 12 * band.capillary, 1e-12);
  EXPECT_NEAR(*point.wetted_fraction.parts.water, 0.1 * band.capillary, 1e-12);
  EXPECT_NEAR(*point.modulation.parts.water, 0.5 * band.pull, 1e-12);
  EXPECT_FALSE(point.mean_gap.parts.water || point.indentation.parts.water);
  // Water on its way adds 18 % of its share of a force that draws the other way as well.
  for (PatchResult& p : patches) p.on_its_way = 0.5e-18;
  patches[1].on_its_way = 0;
  add_water_band(point, patches, WaterModel::Droplets, grid, {0.8, 0.8});
  EXPECT_NEAR(*point.retention_force.parts.water,
              0.2 * std::hypot(band.capillary, 0.18 * 0.5 * 1.5 / 3), 1e-12);
  EXPECT_NEAR(*point.modulation.parts.water, 0.5 * std::hypot(band.pull, 0.10 * 0.5 * 2 / 4),
              1e-12);
}

}  // namespace
}  // namespace papilla::tests::words_and_limits_test
