#include "forward/patch_setup.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <tuple>

#include "base/cache.h"
#include "forward/scene_terms.h"
#include "geometry/measured_map.h"
#include "geometry/roughness.h"

namespace papilla::forward {
namespace {

// Sliding offset of skin k against the texture: the R2 low-discrepancy sequence over the patch.
double offset_share(int k, bool second) {
  const double step = second ? 0.56984029099805327 : 0.75487766624669276;
  return std::fmod(0.5 + step * (k + 1), 1.0);
}

// The skins of a finger are common to all designs of a search.
Heightmap known_surface(const Spectrum& spectrum, const Grid& grid, std::uint64_t seed, int index) {
  using Key = std::tuple<Spectrum, Grid, std::uint64_t, int>;
  constexpr double kMostBytes = 64e6;
  static Cache<Key, Heightmap> cache(256, kMostBytes);
  return *cache.get(
      {spectrum, grid, seed, index}, sizeof(double) * static_cast<double>(grid.size()), [&] {
        return std::make_shared<const Heightmap>(random_surface(
            spectrum, grid, seed, static_cast<std::uint64_t>(index),
            offset_share(index, false) * grid.lx, offset_share(index, true) * grid.ly));
      });
}

}  // namespace

PatchSetup::PatchSetup(const Scene& scene, const Texture& texture, const Fidelity& fidelity)
    : scene_(in_its_state(scene)),
      fidelity_(fidelity),
      texture_(texture),
      plan_(make_plan(scene_, texture, fidelity)),
      surface_(
          generate(texture, plan_.grid),
          plan_.field ? film_of(scene_) : std::vector<FilmLayer>()),  // nothing else asks for it
      body_(compliant_body(scene_.surface, surface_.height)) {
  if (scene_.model.closure == Closure::Balance)
    levels_ = surface_levels(surface_, scene_.surface.equivalent_thickness());
  if (surface_.cut_through > 0) {
    plan_.warnings.push_back(fmt::format(
        "the texture cuts through its planar film on {:.2g} % of the patch: the drive meets the "
        "bare "
        "electrode there, and the numbers under voltage mean nothing physical; make the film "
        "thicker, or the texture shallower",
        100 * surface_.cut_through));
  }
}

Heightmap PatchSetup::skin(int k) const {
  const int index = fidelity_.first_skin + k;
  const Skin& skin = scene_.finger.skin;
  const Grid& grid = plan_.grid;
  if (!skin.map.empty()) {
    Heightmap measured = measured_skin(skin.map, skin.map_width, grid, fidelity_.seed,
                                       static_cast<std::uint64_t>(index));
    for (double& z : measured.z) z *= skin.relief_factor();
    return measured;
  }
  const Spectrum spectrum{skin.rms * skin.relief_factor(), skin.roll_off, skin.hurst,
                          plan_.effective_cutoff};
  return known_surface(spectrum, grid, fidelity_.seed, index);
}

std::vector<double> PatchSetup::height(const Heightmap& skin) const {
  std::vector<double> sum = skin.z;
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = surface_.height.z[i] + sum[i];
  return sum;
}

std::vector<WaterMember> PatchSetup::water_members(int k) const {
  const int index = fidelity_.first_skin + k;
  if (!plan_.water) return {{1, water_stream(index, 0)}};
  const double spread = scene_.finger.water.volume_spread;
  const int seeds = scene_.model.water == WaterModel::Droplets ? fidelity_.droplet_seeds : 1;
  std::vector<WaterMember> out;
  for (int s = 0; s < seeds; ++s) {
    const std::uint64_t member = water_stream(index, s);
    if (spread > 0) {
      out.push_back({1 - spread, member});
      out.push_back({1 + spread, member});
    } else {
      out.push_back({1, member});
    }
  }
  return out;
}

PatchProblem PatchSetup::problem(std::span<const double> height, const ContactKernel& kernel,
                                 double relative_humidity, double pressure,
                                 const WaterMember& water) const {
  return {&scene_,           &surface_, height,      &kernel,
          relative_humidity, pressure,  water.index, water.factor};
}

}  // namespace papilla::forward
