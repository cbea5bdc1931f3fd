// What the field rule lacks on this scene: the 3-D field on a few of its skins.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/rooms.h"
#include "forward/fidelity.h"
#include "forward/response.h"
#include "geometry/texture.h"
#include "scene/scene.h"

namespace papilla::forward {

// The pull by the 3-D field over that by the rule in use, at one humidity.
struct FieldRatio {
  double correction = 1;        // on the rule's pull
  std::optional<double> error;  // relative, of the corrected pull; none where nothing was measured
};
using FieldRatios = std::vector<FieldRatio>;  // one per humidity of a scene

// From fidelity.field_skins patches at rest with the water of the drive, on at most 128 pixels. The
// rule with spreading flux is corrected; columns stay as asked for, with what they lack as their
// error. Eq. electrostatics.17. Cost: one contact, water and 3-D field per skin and humidity.
FieldRatios field_ratios(const Scene& scene, const Texture& texture, const Fidelity& fidelity);

// That of a humidity from the pulls of single skins [Pa]. A skin whose 3-D field has no solution
// counts in neither sum; without any the error is 1. A pull below 0 counts: beside water the 3-D
// field takes more off the air's pull than these pixels leave of it, so little or nothing is left.
FieldRatio field_ratio(std::span<const std::optional<double>> full, std::span<const double> rule,
                       bool corrected);

// Whether 3-D fields are solved beside the rule; whether the rule's pull will be corrected by them,
// the relative error of the pull then, and the price of it [s] on one core.
bool field_solved(const Scene& scene, const Fidelity& fidelity);
bool field_corrected(const Scene& scene, const Fidelity& fidelity);
inline constexpr double kCorrectedFieldError = 0.03;
// What pixels and cells of the 3-D field leave of the pull that is corrected to it, relative, at
// most all of it: common to all runs. The walls of water, which take pull off, take more off on
// finer pixels. Eq. electrostatics.17
double full_field_error(double correction);
inline constexpr int kMostFieldPixels = 128;  // along the window; finer ones: `full_field_error`
double field_ratio_seconds(const Scene& scene, const Grid& grid, const Fidelity& fidelity);

// Adds what the pull's error leaves of the numbers of a point. Eq. electrostatics.17, friction.3,
// friction.4
void add_field_error(const FieldRatio& ratio, const LoadExponents& exponents, ResponsePoint& point);

}  // namespace papilla::forward
