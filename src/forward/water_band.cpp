#include "forward/water_band.h"

#include <cmath>

#include "base/check.h"
#include "base/constants.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/threshold.h"

namespace papilla::forward {
namespace {

// Sums over the patches, but for the mean volume.
struct Loads {
  double volume = 0, preload = 0, capillary = 0, pull = 0;
};

Loads loads_of(std::span<const PatchResult> patches) {
  Loads out;
  for (const PatchResult& p : patches) {
    out.volume += p.volume / static_cast<double>(patches.size());
    out.preload += p.load;
    out.capillary += p.capillary_off;
    out.pull += p.pull;
  }
  return out;
}

// Eq. capillary.23: patches whose water is between disc and film, each with a step of its own.
void add_hand_over(DropletBand& band, std::span<const PatchResult> patches, const Loads& loads) {
  // The largest steps of the sweeps in Film.WithMovingDroplets... and docs/theory/capillary.md.
  constexpr double kForceStep = 0.18, kPullStep = 0.10;
  double forces = 0, pulls = 0;
  for (const PatchResult& p : patches) {
    if (!(p.on_its_way > 0)) continue;
    const double share = p.on_its_way / p.bridge_volume;
    forces += square(kForceStep * share * p.capillary_off);
    pulls += square(kPullStep * share * p.pull);
  }
  if (loads.capillary != 0)
    band.capillary = std::hypot(band.capillary, std::sqrt(forces) / loads.capillary);
  if (loads.pull > 0) band.pull = std::hypot(band.pull, std::sqrt(pulls) / loads.pull);
}

// How far a band of the droplets moves a quantity, relative to it.
double reach(WaterBand of, const DropletBand& band, const Loads& loads, double load_exponent) {
  // Nothing can be wrong in a load that water or drive lift off.
  const auto share = [&](double change, double load) {
    return load > 0 ? load_exponent * std::abs(change) / load : 0;
  };
  const double capillary = band.capillary * loads.capillary;
  switch (of) {
    case WaterBand::None:
      return 0;
    case WaterBand::Capillary:
      return band.capillary;
    case WaterBand::Pull:
      return band.pull;
    case WaterBand::LoadOff:
      return share(capillary, loads.preload + loads.capillary);
    case WaterBand::LoadOn:
      return share(capillary - band.pull * loads.pull,
                   loads.preload + loads.capillary + loads.pull);
  }
  PAPILLA_CHECK(false, "a band without a reach");
  return 0;
}

}  // namespace

void add_water_band(ResponsePoint& point, std::span<const PatchResult> patches, WaterModel model,
                    const Grid& grid, const LoadExponents& exponents) {
  const Loads loads = loads_of(patches);
  if (model == WaterModel::Threshold) {
    // Eq. capillary.21, of what droplets would give.
    const double short_of = threshold_shortfall(loads.volume / grid.area());
    point.modulation.parts.water = short_of / (1 - short_of) * std::abs(point.modulation.value);
    return;
  }
  DropletBand band =
      droplet_band(loads.volume / grid.area(), point.mean_gap.value, point.bridge_water_share);
  add_hand_over(band, patches, loads);
  for (const PointQuantity& q : kPointQuantities) {
    if (q.water == WaterBand::None) continue;
    Measured& m = point.*q.value;
    m.parts.water = reach(q.water, band, loads, exponents.of(q.value)) * std::abs(m.value);
  }
}

}  // namespace papilla::forward
