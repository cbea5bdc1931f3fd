// How the numbers of patches combine, against the weights written out.
#include "forward/patch_result.h"

#include <gtest/gtest.h>

#include "forward/response.h"

namespace papilla::tests::patch_result_test {
namespace {

// Every member another number, by its place in the table.
PatchResult numbered(double first, double step) {
  PatchResult out;
  for (std::size_t i = 0; i < kPatchMembers.size(); ++i)
    out.*kPatchMembers[i].value = first + step * static_cast<double>(i);
  out.costs = {2, 30.5, {1, 2, 3}};
  return out;
}

TEST(PatchMembers, EveryMemberHasOneRow) {
  for (std::size_t i = 0; i < kPatchMembers.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(kPatchMembers[i].value, kPatchMembers[k].value);
  }
  for (std::size_t i = 0; i < kPointQuantities.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k)
      EXPECT_NE(kPointQuantities[i].value, kPointQuantities[k].value);
  }
}

TEST(PatchMembers, OfWaterAreMeansPeaksAndSummedCosts) {
  const std::vector<PatchResult> members{numbered(1, 1), numbered(3, 2)};
  const PatchResult out = over_water(members);
  EXPECT_DOUBLE_EQ(out.pull, (members[0].pull + members[1].pull) / 2);
  EXPECT_EQ(out.load, members[0].load);
  EXPECT_EQ(out.mean_gap, members[0].mean_gap);
  EXPECT_EQ(out.peak_air_field, members[1].peak_air_field);
  EXPECT_EQ(out.oxide_margin, members[0].oxide_margin);
  EXPECT_EQ(out.costs.contact_solves, 4);
  EXPECT_EQ(out.costs.fft_pairs, 61);
  EXPECT_EQ(out.costs.seconds.contact, 2);
  EXPECT_EQ(out.costs.seconds.water, 4);
  EXPECT_EQ(out.costs.seconds.field, 6);
}

TEST(PatchMembers, OfPatchPressuresAreWeightedByTheirShares) {
  const std::vector<PatchResult> patches{numbered(1, 1), numbered(3, 2)};
  const PressureShares shares{{0.1, 0.3}, {0.1, 0.3}, {0.2, 0.6}};
  PatchResult out;
  out.load = 7;
  out.pull = 5;
  add_over_pressures(patches, shares, out);
  EXPECT_EQ(out.load, 7);
  const double pull = 5 + 0.2 * patches[0].pull + 0.6 * patches[1].pull;
  EXPECT_DOUBLE_EQ(out.pull, pull);
  EXPECT_DOUBLE_EQ(out.capillary_off,
                   0.1 * patches[0].capillary_off + 0.3 * patches[1].capillary_off);
  EXPECT_DOUBLE_EQ(out.area_on, 0.2 * patches[0].area_on + 0.6 * patches[1].area_on);
  EXPECT_DOUBLE_EQ(out.mean_gap, 0.25 * patches[0].mean_gap + 0.75 * patches[1].mean_gap);
  EXPECT_DOUBLE_EQ(out.over_limit_share, (0.2 * patches[0].pull * patches[0].over_limit_share +
                                          0.6 * patches[1].pull * patches[1].over_limit_share) /
                                             pull);
}

}  // namespace
}  // namespace papilla::tests::patch_result_test
