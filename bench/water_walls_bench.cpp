// Whether the capillary force over the walls of holes has a limit under refinement, and what the
// depth of the holes does to it (claim M7): the same skins on grids of 128^2 to 1024^2, by the mean
// volume and by a low and a high one. Prints results/accuracy/water_walls.csv:
// ninja -C build/release water_walls_bench && build/release/bench/water_walls_bench designs >
// results/accuracy/water_walls.csv
#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "base/constants.h"
#include "design/design.h"
#include "forward/forward.h"
#include "forward/scene_terms.h"
#include "numerics/statistics.h"
#include "physics/capillary/droplets.h"

namespace {

using namespace papilla::tests;

constexpr int kPlacements = 3;

struct Case {
  std::string file;
  double wall;  // [deg]
};

struct Skins {
  std::vector<double> mean_volume, two_volumes;  // capillary force by load
};

Skins solve(const std::string& folder, const Case& c, double rh, int grid, int skins) {
  Design design = read_design(folder + "/m3_samples/" + c.file + ".toml");
  if (auto* holes = std::get_if<HoleArray>(&design.texture.kind))
    holes->wall_angle = c.wall * kPi / 180;
  const Scene scene = scene_of(design);
  Fidelity fidelity = fidelity_level("search");
  fidelity.grid = grid;
  Scene dry = scene;
  std::fill(dry.finger.water.volume.begin(), dry.finger.water.volume.end(), 0.0);
  dry.drive.amplitude = 0;
  const SkinWater& skin = scene.finger.water;
  const WaterProperties water{skin.surface_tension, skin.contact_angle, scene.surface.contact_angle,
                              skin.hysteresis};
  Skins out;
  for (int k = 0; k < skins; ++k) {
    PatchPicture p = picture_patch(dry, design.texture, fidelity, rh, k);
    const Grid g = p.texture.grid;
    const Gap gap{g, std::move(p.fields.off.gap)};
    const double load = ScaleBridge(scene, fidelity, g, rh).mean_pressure() * g.area();
    const double volume = skin.volume_per_area(rh) * g.area();
    const auto force = [&](double share) {
      double sum = 0;
      for (int member = 1; member <= kPlacements; ++member) {
        sum +=
            settle_droplets(gap, share * volume, water, {}, static_cast<std::uint64_t>(member), k)
                .capillary_force;
      }
      return sum / kPlacements / load;
    };
    out.mean_volume.push_back(force(1));
    out.two_volumes.push_back(0.5 * (force(2.0 / 3) + force(4.0 / 3)));
  }
  return out;
}

void print(int grid, double rh, const Case& c, const char* rule, const std::vector<double>& force,
           const std::vector<double>& shallow) {
  const Estimate mean = mean_estimate(force), change = ratio_estimate(force, shallow);
  fmt::print("{},{},{},{:.0f},{:.0f},{},{:.4f},{:.4f},{:.1f},{:.1f}\n", grid, force.size(), c.file,
             c.wall, 100 * rh, rule, mean.value, mean.se, 100 * (change.value - 1),
             100 * change.se);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : "designs";
  fmt::print(
      "grid,skins,sample,wall_deg,humidity_percent,volumes,capillary_per_load,se,change_against_"
      "350_nm_percent,se\n");
  for (const auto& [grid, skins] : {std::pair{128, 40}, {256, 40}, {512, 40}, {1024, 12}}) {
    for (double rh : {0.55, 0.75}) {
      for (double wall : {90.0, 70.0}) {
        if (grid == 1024 && (wall < 90 || rh < 0.7)) continue;
        Skins shallow;
        for (const char* file : {"a3h350", "a3h600", "a3h900"}) {
          const Case c{file, wall};
          const Skins s = solve(folder, c, rh, grid, skins);
          if (shallow.mean_volume.empty()) shallow = s;
          print(grid, rh, c, "mean", s.mean_volume, shallow.mean_volume);
          print(grid, rh, c, "low and high", s.two_volumes, shallow.two_volumes);
          std::fflush(stdout);
        }
      }
    }
  }
}
