// Water between patches that do not carry: the capillary force and retention of patches that hang
// over flat glass by so much, beside those of a patch that carries, and how many of them there are.
// ninja -C build/release far_water_bench && build/release/bench/far_water_bench designs >
// results/accuracy/far_water.csv
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/constants.h"
#include "design/design.h"
#include "forward/patch_setup.h"
#include "forward/scale_bridge.h"
#include "forward/scene_terms.h"
#include "physics/capillary/droplets.h"
#include "physics/macro/fingertip.h"
#include "physics/persson/persson.h"

namespace {

using namespace papilla::tests;

constexpr int kSkins = 8;
constexpr double kPatch = 12e-6;
constexpr std::array kHangs{0.0, 0.05e-6, 0.1e-6, 0.2e-6, 0.4e-6, 0.8e-6};

struct Hold {
  double capillary = 0, retention = 0, load = 0;  // means over the skins [N]
};

// Droplets of the humidity in a gap [N].
Hold held(const PatchSetup& setup, double rh, std::uint64_t skin, std::vector<double> gap) {
  const Scene& scene = setup.scene();
  const Grid& grid = setup.plan().grid;
  DropletOptions options;
  options.drops_per_volume = scene.finger.water.drops_per_um3 * 1e18;
  options.first_step = scene.model.droplet_step;
  const Wetting wetting = settle_droplets(
      {grid, std::move(gap)}, grid.area() * scene.finger.water.volume_per_area(rh),
      water_properties(scene, scene.surface.contact_angle), options, setup.fidelity().seed, skin);
  return {wetting.capillary_force / kSkins, wetting.retention / kSkins, 0};
}

// Of the ridges at a humidity: the share per gap [1/m] at u over the share that carries.
double patches_per_gap(const Finger& finger, double ridge_rms, double rh, double u) {
  const double lowest = 2 * kPi / finger.macro.ridge_longest, q = 2 * kPi / kPatch;
  const double factor = finger.skin.modulus_factor(rh);
  const MeanField field(self_affine_spectrum(ridge_rms, lowest, lowest, q, finger.skin.hurst),
                        {finger.skin.bulk_modulus * factor, finger.skin.bulk_poisson,
                         finger.macro.corneum_thickness, finger.macro.tissue_modulus, 0.5});
  const double pressure = ridge_load(finger.macro, finger.load, rh).mean_pressure;
  const GapDistribution gaps = field.gaps(pressure);
  return gaps.density(u) / gaps.contact;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string designs = argc > 1 ? argv[1] : "designs";
  fmt::print(
      "state,relative_humidity,hang_nm,capillary_over_load,retention_over_carrying,"
      "patches_per_um_ridge_2.2um,patches_per_um_ridge_0.8um\n");
  for (const char* state : {"clean", "natural"}) {
    const Design design =
        read_design(designs + "/m3_samples/flat.toml", {fmt::format("finger.state=\"{}\"", state)});
    Fidelity fidelity = fidelity_level("search");
    fidelity.skins = kSkins;
    const PatchSetup setup(scene_of(design), design.texture, fidelity);
    const Grid& grid = setup.plan().grid;
    const Finger& finger = setup.scene().finger;
    for (const double rh : design.environment.relative_humidity) {
      const auto kernel = contact_kernel(setup.scene(), setup.body(), grid, rh);
      Hold carrying;
      std::array<Hold, kHangs.size()> far{};
      for (int k = 0; k < kSkins; ++k) {
        const auto skin = static_cast<std::uint64_t>(k);
        const std::vector<double> height = setup.height(setup.skin(k));
        PatchStates start;
        const PatchResult r =
            solve_patch(setup.problem(height, *kernel, rh, finger.patch_pressure(rh), {1, skin}),
                        setup.plan(), fidelity, start);
        carrying.load += r.load / kSkins;
        carrying.retention += r.retention / kSkins;
        const double highest = *std::max_element(height.begin(), height.end());
        for (std::size_t i = 0; i < kHangs.size(); ++i) {
          std::vector<double> gap = height;
          for (double& g : gap) g = highest - g + kHangs[i];
          const Hold one = held(setup, rh, skin, std::move(gap));
          far[i].capillary += one.capillary;
          far[i].retention += one.retention;
        }
      }
      for (std::size_t i = 0; i < kHangs.size(); ++i) {
        const double u = std::max(kHangs[i], 0.02e-6);
        fmt::print("{},{:g},{:g},{:.4f},{:.3f},{:.2f},{:.2f}\n", state, rh, kHangs[i] * 1e9,
                   far[i].capillary / carrying.load,
                   carrying.retention > 0 ? far[i].retention / carrying.retention : 0,
                   1e-6 * patches_per_gap(finger, 2.2e-6, rh, u),
                   1e-6 * patches_per_gap(finger, 0.8e-6, rh, u));
      }
    }
  }
}
