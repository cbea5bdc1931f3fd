// The patches of one humidity before the drive, to be driven at one voltage after another.
#pragma once

#include <memory>
#include <vector>

#include "base/rooms.h"
#include "forward/field_ratio.h"
#include "forward/patch_setup.h"
#include "forward/response.h"

namespace papilla::forward {

// Contact and water before the drive are solved once. Memory: 32 bytes per pixel, skin and patch
// pressure.
class UndrivenPatches {
 public:
  // scene: of one humidity; its amplitude matters to the correction alone.
  UndrivenPatches(const Scene& scene, const Texture& texture, const Fidelity& fidelity);

  // The rule's pull is corrected as at one amplitude [V] until another is asked for: at first that
  // of the scene, or 1 V where that has none. Cost: as `field_ratios`.
  void correct_at(double amplitude);
  // 0 where the fidelity corrects nothing.
  double corrected_at() const;

  // The response at an amplitude [V] > 0, one point, and without each skin. The load estimator
  // costs field and water alone, the area one contact solve per patch.
  Resampled drive(double amplitude, Estimator estimator) const;

 private:
  double humidity() const { return setup_->scene().environment.relative_humidity[0]; }

  Scene driven_;  // by the voltage that the field is corrected at
  std::unique_ptr<const PatchSetup> setup_;
  FieldRatios field_;  // of the one humidity
  std::shared_ptr<const ContactKernel> kernel_;
  std::vector<double> pressures_;
  std::vector<std::vector<double>> height_;          // one per skin
  std::vector<std::vector<UndrivenPatch>> patches_;  // [skin][pressure x water member]
};

}  // namespace papilla::forward
