#include "physics/capillary/facts.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/constants.h"
#include "geometry/texture.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/threshold.h"

namespace papilla::capillary {
namespace {

double droplet_error(std::span<const double> water_per_area) {
  double largest = 0;
  for (const double water : water_per_area) {
    // The share of the water in bridges as on the published samples (results/accuracy/water.csv).
    const double share = std::min(0.75, 0.2 + 0.009 * (water / 1e-9));
    largest = std::max(largest, droplet_band(water, 0, share).pull);
  }
  return largest;
}

double threshold_error(std::span<const double> water_per_area) {
  return threshold_shortfall(*std::max_element(water_per_area.begin(), water_per_area.end()));
}

// Once settled, droplets of a window are few; of 1,000 and more each costs its own way there, less
// where it floats and more where many merge. A smooth finger takes three times the first part.
double droplet_seconds(const Grid& grid, double droplets) {
  constexpr double kPerDroplet = 2e-6;
  return 1e-5 * std::sqrt(static_cast<double>(grid.size())) + kPerDroplet * droplets;
}

double threshold_seconds(const Grid& grid, double) {
  return 9e-9 * static_cast<double>(grid.size());
}

constexpr WaterFacts kDroplets{
    "droplet ensemble by lowest energy",
    "its variation over humidity is what textures change; error: mobility and number",
    droplet_error, droplet_seconds};

constexpr WaterFacts kThreshold{
    "volume threshold",
    "cheap and smooth; it reverses the sign of the texture's effect on variation", threshold_error,
    threshold_seconds};

}  // namespace

double starting_droplets(const Grid& patch, double water_per_area, double drops_per_um3) {
  return 1e18 * drops_per_um3 * water_per_area * patch.area();
}

const WaterFacts& water_facts(WaterModel model) {
  switch (model) {
    case WaterModel::Droplets:
      return kDroplets;
    case WaterModel::Threshold:
      return kThreshold;
  }
  PAPILLA_CHECK(false, "a model without facts");
  return kDroplets;
}

}  // namespace papilla::capillary
