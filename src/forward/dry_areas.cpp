#include "forward/dry_areas.h"

#include <algorithm>

#include "forward/errors.h"

namespace papilla::forward {
namespace {

// Eq. accuracy.17
double dry_area_factor(Scene scene, const Texture& texture, Fidelity fidelity, int skins) {
  scene.drive.control = DriveControl::Voltage;
  scene.drive.amplitude = 0;
  std::fill(scene.finger.water.volume.begin(), scene.finger.water.volume.end(), 0.0);
  fidelity.skins = fidelity.control_skins = skins;
  PatchSet patches = solve_patches(scene, texture, fidelity);
  measure_errors(scene, texture, fidelity, patches);
  return patches.area_factor;
}

}  // namespace

Response evaluate_resolved(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                           int dry_skins) {
  PatchSet patches = solve_patches(scene, texture, fidelity);
  patches.area_factor = dry_area_factor(scene, texture, fidelity, dry_skins);
  return respond(scene, fidelity, patches);
}

}  // namespace papilla::forward
