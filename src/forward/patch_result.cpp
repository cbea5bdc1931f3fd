#include "forward/patch_result.h"

#include <algorithm>
#include <numeric>

#include "base/check.h"

namespace papilla::forward {

PatchCosts& PatchCosts::operator+=(const PatchCosts& other) {
  contact_solves += other.contact_solves;
  fft_pairs += other.fft_pairs;
  seconds.contact += other.seconds.contact;
  seconds.water += other.seconds.water;
  seconds.field += other.seconds.field;
  return *this;
}

namespace {

bool is_friction(Measured PointQuantities::*quantity) {
  return quantity == &PointQuantities::friction_off || quantity == &PointQuantities::friction_on;
}

}  // namespace

double LoadExponents::of(Measured PointQuantities::*quantity) const {
  const bool rubs = is_friction(quantity) || quantity == &PointQuantities::modulation;
  return rubs ? friction : area;
}

GridLaw grid_law(Measured PointQuantities::*quantity, bool friction_by_load) {
  if (friction_by_load && is_friction(quantity)) return GridLaw::Other;
  for (const PointQuantity& q : kPointQuantities) {
    if (q.value == quantity) return q.grid;
  }
  PAPILLA_CHECK(false, "every quantity is in the table");
  return GridLaw::Other;
}

PatchResult over_water(std::span<const PatchResult> members) {
  PatchResult out = members.front();
  if (members.size() == 1) return out;
  for (const PatchMember& member : kPatchMembers) {
    double& value = out.*member.value;
    if (member.water == OverWater::Mean) value = 0;
    for (const PatchResult& m : members) {
      switch (member.water) {
        case OverWater::Common:
          break;
        case OverWater::Mean:
          value += m.*member.value / static_cast<double>(members.size());
          break;
        case OverWater::Highest:
          value = std::max(value, m.*member.value);
          break;
        case OverWater::Lowest:
          value = std::min(value, m.*member.value);
          break;
      }
    }
  }
  for (const PatchResult& m : members.subspan(1)) {
    out.costs += m.costs;
    out.status.note(m.status);
  }
  return out;
}

void add_over_pressures(std::span<const PatchResult> patches, const PressureShares& shares,
                        PatchResult& out) {
  const auto press = [&](const PatchMember& member) {
    return member.value == &PatchResult::area_off  ? shares.press_off
           : member.value == &PatchResult::area_on ? shares.press_on
                                                   : 1;
  };
  const double touching = std::accumulate(shares.off.begin(), shares.off.end(), 0.0);
  double of_pull = 0;
  for (const PatchMember& member : kPatchMembers) {
    double& value = out.*member.value;
    for (std::size_t k = 0; k < patches.size(); ++k) {
      const double one = patches[k].*member.value;
      switch (member.pressures) {
        case OverPressures::Given:
          break;
        case OverPressures::Nominal:
          value += shares.nominal[k] * one;
          break;
        case OverPressures::Off:
          value += shares.off[k] * press(member) * one;
          break;
        case OverPressures::On:
          value += shares.on[k] * press(member) * one;
          break;
        case OverPressures::Touching:
          value += shares.off[k] / touching * one;
          break;
        case OverPressures::OfPull:
          of_pull += shares.on[k] * one * patches[k].pull;
          break;
        case OverPressures::Highest:
          value = std::max(value, one);
          break;
        case OverPressures::Lowest:
          value = std::min(value, one);
          break;
      }
    }
  }
  if (out.pull > 0) out.over_limit_share = of_pull / out.pull;
  for (const PatchResult& p : patches) {
    out.costs += p.costs;
    out.status.note(p.status);
  }
}

}  // namespace papilla::forward
