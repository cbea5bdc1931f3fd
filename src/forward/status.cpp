#include "forward/status.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "base/check.h"
#include "base/text.h"

namespace papilla::forward {

bool ModelStatus::pull_in() const {
  return trouble == Trouble::SecondPassPullIn || trouble == Trouble::ClosedPullIn ||
         trouble == Trouble::GrowingPullIn || trouble == Trouble::FarGapPullIn ||
         trouble == Trouble::UndrivenPullIn;
}

std::string text(const ModelStatus& status) {
  switch (status.trouble) {
    case Trouble::None:
      return "ok";
    case Trouble::WaterMoves:
      return fmt::format("water: droplets not at rest after {:.0f} moves of one", status.number);
    case Trouble::ContactUnsolved:
      return "contact: " + status.reason;
    case Trouble::FieldUnsolved:
      return "field: " + status.reason;
    case Trouble::Flooded:
      return "flooded: more water than gap, no meniscus and no capillary force";
    case Trouble::SecondPassPullIn:
      return fmt::format(
          "pull-in: the gap closes, a second pass would raise the pull by {:.0f} % (coupling = "
          "\"equilibrium\" seeks one)",
          100 * status.number);
    case Trouble::ClosedPullIn:
      return "pull-in: no equilibrium short of a closed gap";
    case Trouble::GrowingPullIn:
      return "pull-in: the attraction outgrows the skin's resistance, the gap jumps shut";
    case Trouble::FarGapPullIn:
      return "pull-in: the gaps between patches in contact close";
    case Trouble::UndrivenPullIn:
      return "pull-in: load and water alone close the gap, without a voltage";
    case Trouble::PassesUsedUp:
      return fmt::format("coupling: not settled after {:.0f} passes", status.number);
    case Trouble::FullContact:
      return fmt::format(
          "full contact: the area estimate is {:.3g} times the patch, friction and modulation mean "
          "nothing physical",
          status.number);
    case Trouble::NearlyFlooded:
      return fmt::format(
          "nearly flooded: water and contact cover all but {:.2g} % of the patch, the pull that is "
          "left hangs on single pixels and its error is not known",
          100 * status.number);
    case Trouble::WaterBeyondFit:
      return fmt::format(
          "water beyond its fit: the volumes of the finger were fitted up to {:.6g} % RH on this "
          "side and are continued from there (finger.water.relative_humidity)",
          100 * status.number);
    case Trouble::Breakdown:
      return fmt::format(
          "breakdown: the field in a layer of the dielectric is {:.3g} times its strength, the "
          "numbers under voltage mean nothing physical",
          status.number);
    case Trouble::RidgesCarry:
      return fmt::format(
          "soft surface: {:.3g} % of the ridges carry, as many as there are; its compression "
          "brings "
          "no more (Eq. coupling.6)",
          100 * status.number);
  }
  PAPILLA_CHECK(false, "a trouble without words");
  return {};
}

int humidity_decimals(std::vector<double> humidities) {
  constexpr double kSame = 1e-9;  // as `note_water` has it
  constexpr int kMost = 7;        // per cent to 1e-9
  std::sort(humidities.begin(), humidities.end());
  const auto alike = [&](int decimals) {
    for (std::size_t i = 1; i < humidities.size(); ++i) {
      const double a = humidities[i - 1], b = humidities[i];
      if (b - a > kSame && fixed(100 * a, decimals) == fixed(100 * b, decimals)) return true;
    }
    return false;
  };
  int decimals = 0;
  while (decimals < kMost && alike(decimals)) ++decimals;
  return decimals;
}

std::string text(const std::vector<PointTrouble>& troubles) {
  // A humidity reads unlike the one that its water was fitted at.
  std::vector<double> humidities;
  for (const PointTrouble& t : troubles) {
    humidities.push_back(t.relative_humidity);
    if (t.status.trouble == Trouble::WaterBeyondFit) humidities.push_back(t.status.number);
  }
  const int decimals = humidity_decimals(humidities);
  std::string out;
  std::set<std::string> told;
  for (const PointTrouble& first : troubles) {
    const std::string said = text(first.status);
    if (!told.insert(said).second) continue;
    std::vector<std::string> at;
    for (const PointTrouble& t : troubles) {
      if (text(t.status) == said) at.push_back(fixed(100 * t.relative_humidity, decimals));
    }
    out += fmt::format("{}{} % RH: {}", out.empty() ? "" : "; ", join_names(at), said);
  }
  return out;
}

}  // namespace papilla::forward
