#include "physics/capillary/facts.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/constants.h"
#include "geometry/texture.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/threshold.h"

namespace papilla {
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

// A smooth finger takes three times that. More droplets on a longer patch: 100 um take 16 times the
// water of the window, not 69.
double droplet_seconds(const Grid& grid) {
  const double room = std::pow(std::max(1.0, grid.area() / square(kWindow)), 2.0 / 3);
  return 1e-5 * std::sqrt(static_cast<double>(grid.size())) * room;
}

double threshold_seconds(const Grid& grid) { return 9e-9 * static_cast<double>(grid.size()); }

constexpr WaterFacts kDroplets{
    "droplet ensemble by lowest energy",
    "its variation over humidity is what textures change; error: mobility and number",
    droplet_error, droplet_seconds};

constexpr WaterFacts kThreshold{
    "volume threshold",
    "cheap and smooth; it reverses the sign of the texture's effect on variation", threshold_error,
    threshold_seconds};

}  // namespace

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

}  // namespace papilla
