#include "forward/kept_patches.h"

#include <algorithm>

#include "base/check.h"
#include "forward/load_law.h"

namespace papilla::forward {
namespace {

// The drive acts last, on contact and water as they are; so does the film that it acts through.
Scene before_drive(Scene scene) {
  scene.drive = {};
  scene.surface.dielectric.clear();
  scene.surface.process = {};
  scene.surface.step_coverage = 0;
  scene.surface.electrode_edge_radius = 0;
  return scene;
}

Scene before_water(Scene scene) {
  scene = before_drive(std::move(scene));
  scene.surface.contact_angle = 0;
  return scene;
}

}  // namespace

void KeptPatches::begin(const PatchSetup& setup) {
  const Fidelity& fidelity = setup.fidelity();
  PAPILLA_CHECK(fidelity.estimator == Estimator::Load, "patches are kept for the load estimator");
  std::vector<MapVersion> maps = map_versions(setup.described());
  if (const std::string& skin = setup.scene().finger.skin.map; !skin.empty())
    maps.push_back(map_version(skin));
  const Key contact{before_water(setup.scene()), setup.described(), fidelity, maps};
  const Key water{before_drive(setup.scene()), setup.described(), fidelity, maps};
  const bool same_contact = whole_ && contact_ && *contact_ == contact;
  const bool same_water = same_contact && water_ && *water_ == water;
  held_ = same_water ? Held::Water : same_contact ? Held::Contact : Held::Nothing;
  const int skins = std::max(fidelity.skins, sampled_skins(setup, setup.plan()));
  if (!same_contact) skins_.clear();
  for (Skin& skin : skins_) {
    skin.contact = same_contact;
    skin.water = same_water;
  }
  // The same contact may ask for another number: dry skin has samples of the load law only driven.
  skins_.resize(static_cast<std::size_t>(skins));
  contact_ = contact;
  water_ = water;
  whole_ = false;
}

}  // namespace papilla::forward
