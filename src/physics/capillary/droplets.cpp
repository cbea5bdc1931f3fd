#include "physics/capillary/droplets.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/check.h"
#include "base/constants.h"
#include "base/random.h"
#include "physics/capillary/drop_wetting.h"
#include "physics/capillary/settling.h"
#include "physics/capillary/threshold.h"

namespace papilla::capillary {

namespace {

// Of a cap: at its foot or, where it is more than half a sphere, around its middle [m].
double widest_radius(const Droplet& cap) {
  return cap.height > cap.radius ? 0.5 * (square(cap.radius) / cap.height + cap.height)
                                 : cap.radius;
}

// A droplet as it is found on another gap.
Drop rewetted(const Droplet& d, DropEnergy& energy) {
  Drop drop;
  if (d.state == DropletState::Bridge || d.height >= energy.gap_at(d.x, d.y)) {
    drop = energy.kept(d.x, d.y, d.volume, d.radius);
  } else {  // floats: keeps its shape
    drop.x = d.x;
    drop.y = d.y;
    drop.volume = d.volume;
    drop.radius = widest_radius(d);
    drop.footprint = d.radius;
    drop.height = d.height;
    drop.side = d.state;
    drop.energy = d.energy;
  }
  drop.film = d.film;
  return drop;
}

}  // namespace

std::vector<DropletSeed> scatter_droplets(const Grid& grid, double volume,
                                          const DropletOptions& options, std::uint64_t seed,
                                          std::uint64_t index) {
  PAPILLA_CHECK(volume >= 0 && std::isfinite(volume), "water volume must be finite, not negative");
  if (volume == 0) return {};
  const int n =
      static_cast<int>(std::clamp(std::round(options.drops_per_volume * volume), 1.0, 1e6));
  RandomStream random(seed, "droplets", index);
  std::vector<DropletSeed> out(n);
  double sum = 0;
  for (DropletSeed& d : out) {
    d.x = random.uniform() * grid.lx;
    d.y = random.uniform() * grid.ly;
    d.volume = 1 - random.uniform();  // (0, 1]
    sum += d.volume;
  }
  for (DropletSeed& d : out) d.volume = volume * d.volume / sum;
  return out;
}

Wetting settle_droplets(const Gap& gap, const std::vector<DropletSeed>& droplets,
                        const WaterProperties& water, const DropletOptions& options,
                        SettleReport* report) {
  if (report) *report = {};
  double volume = 0, space = 0;
  for (const DropletSeed& d : droplets) volume += d.volume;
  if (volume == 0) {
    Wetting dry;
    dry.grid = gap.grid;
    return dry;
  }
  for (double h : gap.value) space += h;
  if (volume >= space * gap.grid.pixel_area()) return fill_threshold(gap, volume, water);
  DropEnergy energy(gap, water, options.gap_floor, options.first_step);
  std::vector<Drop> placed;
  placed.reserve(droplets.size());
  for (const DropletSeed& d : droplets)
    placed.push_back(energy.placed(d.x, d.y, d.volume, 0, false));
  SettleReport settled;
  settled.initial_droplets = static_cast<int>(placed.size());
  DropPopulation drops(gap.grid, energy);
  drops.take(std::move(placed));
  double wicked = 0;
  if (options.rims && options.corner_wicking) {
    wicked = wick_into_corners(gap.grid, *options.rims, water, energy.cap_state(), drops);
  }
  settled.initial_energy = drops.energy();
  settle(gap, water, options, energy, drops, settled);
  settled.merges = drops.merges();
  settled.evaluations = energy.evaluations();
  if (report) *report = settled;
  return wetting_of(gap, water, options, energy, drops.drops(), volume, wicked);
}

Wetting settle_droplets(const Gap& gap, double volume, const WaterProperties& water,
                        const DropletOptions& options, std::uint64_t seed, std::uint64_t index,
                        SettleReport* report) {
  return settle_droplets(gap, scatter_droplets(gap.grid, volume, options, seed, index), water,
                         options, report);
}

Wetting rewet(const Wetting& wetting, const Gap& gap, const WaterProperties& water,
              const DropletOptions& options) {
  if (wetting.status == WettingStatus::Dry) return wetting;
  if (wetting.droplets.empty()) {
    if (wetting.status == WettingStatus::Discs) return wetting;  // all of it is in corners
    return fill_threshold(gap, wetting.volume, water);           // flooded, or threshold water
  }
  DropEnergy energy(gap, water, options.gap_floor);
  std::vector<Drop> placed;
  for (const Droplet& d : wetting.droplets) placed.push_back(rewetted(d, energy));
  DropPopulation drops(gap.grid, energy);
  drops.take(std::move(placed));
  return wetting_of(gap, water, options, energy, drops.drops(), wetting.volume,
                    wetting.wicked_volume);
}

DropletBand droplet_band(double water_per_area, double mean_gap, double bridge_share) {
  if (!(water_per_area > 0)) return {};
  DropletBand band;
  // Eq. capillary.19
  band.pull = 0.7 * square(1 - bridge_share) * -std::expm1(-water_per_area / 7e-9);
  // Eq. capillary.20
  band.capillary = mean_gap > 0 ? 1.5 / (1 + water_per_area / (0.01 * mean_gap)) : 0;
  return band;
}

Traction capillary_traction(const Wetting& wetting, const Gap& gap, const WaterProperties&) {
  const Grid& g = gap.grid;
  Traction out{g, std::vector<double>(g.size(), 0.0)};
  for (const Droplet& d : wetting.droplets) {
    if (d.state != DropletState::Bridge || d.force == 0) continue;
    const Disc disc{d.x, d.y, d.radius};
    std::size_t count = 0;
    for_pixels(g, disc, [&](std::size_t) { ++count; });
    if (count > 0) {
      const double pressure = d.force / (static_cast<double>(count) * g.pixel_area());
      for_pixels(g, disc, [&](std::size_t k) { out.value[k] += pressure; });
    } else {
      out.value[pixel_of(g, d.x, d.y)] += d.force / g.pixel_area();
    }
  }
  for (std::size_t k = 0; k < wetting.film_region.size(); ++k) {
    const int region = wetting.film_region[k];
    if (region > 0) out.value[k] += wetting.film_pressure[static_cast<std::size_t>(region - 1)];
  }
  return out;
}

}  // namespace papilla::capillary
