#include "cases/droplets.h"

#include <algorithm>
#include <memory>

#include "base/error.h"
#include "design/design.h"
#include "forward/forward.h"
#include "forward/scene_terms.h"
#include "geometry/io/files.h"
#include "physics/capillary/threshold.h"

namespace papilla::cases {

DropletCase droplets_of_design(const std::string& file, double relative_humidity, int skin,
                               bool rim_pinning, bool corner_wicking) {
  const Design design = read_design(file);
  Scene scene = scene_of(design);
  const Finger finger = scene.finger.applied();
  Fidelity fidelity = fidelity_of(design);
  fidelity.estimator = Estimator::Load;
  std::fill(scene.finger.water.volume.begin(), scene.finger.water.volume.end(), 0.0);
  scene.drive.amplitude = 0;
  const PatchPicture picture =
      picture_patch(scene, design.texture, fidelity, relative_humidity, skin);
  if (picture.fields.off.gap.empty())
    throw InputError(file + ": no contact: " + picture.fields.off.reason);
  const Grid& grid = picture.texture.grid;
  DropletCase out;
  out.gap = {grid, picture.fields.off.gap};
  out.volume = finger.water.volume_per_area(relative_humidity) * grid.area();
  out.water = water_properties(in_its_state(scene), scene.surface.contact_angle);
  out.how.drops_per_volume = finger.water.drops_per_um3 * 1e18;
  out.how.first_step = scene.model.droplet_step;
  out.how.rims = std::make_shared<RimMap>(picture.texture);
  out.how.rim_pinning = rim_pinning || scene.model.rim_pinning;
  out.how.corner_wicking = corner_wicking || scene.model.corner_wicking;
  return out;
}

DropletCase droplets_of_file(const std::string& file, double width) {
  const Heightmap map = read_heightmap(file, width);
  if (*std::min_element(map.z.begin(), map.z.end()) < 0)
    throw InputError(file + ": a gap must not be negative (0 in contact)");
  DropletCase out;
  out.gap = {map.grid, map.z};
  return out;
}

DropletResult solve_droplets(const DropletCase& c, WaterModel model, std::uint64_t seed,
                             std::uint64_t index) {
  DropletResult out;
  out.wetting = model == WaterModel::Threshold
                    ? fill_threshold(c.gap, c.volume, c.water)
                    : settle_droplets(c.gap, c.volume, c.water, c.how, seed, index, &out.report);
  return out;
}

Wetting unmoved_droplets(const DropletCase& c, std::uint64_t seed, std::uint64_t index) {
  DropletOptions unmoved = c.how;
  unmoved.max_moves = 0;
  return settle_droplets(c.gap, c.volume, c.water, unmoved, seed, index);
}

DropletEnsemble solve_droplet_ensemble(const DropletCase& c, double spread, int placements,
                                       std::uint64_t seed, std::uint64_t index) {
  DropletEnsemble out;
  out.placements = placements;
  std::vector<double> all;
  for (double factor : {1 - spread, 1 + spread}) {
    const double volume = factor * c.volume;
    std::vector<double> force, bridges, wetted;
    for (int k = 0; k < placements; ++k) {
      const Wetting w = settle_droplets(c.gap, volume, c.water, c.how, seed,
                                        index + static_cast<std::uint64_t>(k));
      force.push_back(w.capillary_force);
      bridges.push_back(w.bridges);
      wetted.push_back(w.wetted_fraction);
    }
    all.insert(all.end(), force.begin(), force.end());
    out.volumes.push_back(
        {volume, mean_estimate(force), mean_estimate(bridges), mean_estimate(wetted)});
  }
  out.mean_capillary_force = mean_estimate(all).value;
  return out;
}

}  // namespace papilla::cases
