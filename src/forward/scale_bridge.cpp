#include "forward/scale_bridge.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "base/check.h"
#include "base/constants.h"
#include "forward/scene_terms.h"
#include "physics/macro/fingertip.h"
#include "physics/persson/persson.h"

namespace papilla::forward {
namespace {

constexpr double kPatch = 12e-6;  // where the spectrum of the ridges meets that of the skin

// Spectrum of the ridge above the patch size, then that of the skin within patches.
PowerSpectrum ridge_and_skin(const Finger& finger, double q_patch) {
  const MacroContact& macro = finger.macro;
  const Skin& skin = finger.skin;
  const double lowest = std::min(2 * kPi / macro.ridge_longest, 0.5 * q_patch);
  PowerSpectrum all = self_affine_spectrum(macro.ridge_rms, lowest, lowest, q_patch, skin.hurst);
  const double roll_off = 2 * kPi / skin.roll_off, cutoff = 2 * kPi / skin.cutoff;
  if (cutoff <= q_patch || skin.rms == 0) return all;
  const double begin = std::min(q_patch, roll_off);
  const PowerSpectrum within =
      self_affine_spectrum(skin.rms * skin.relief_factor(), begin, roll_off, cutoff, skin.hurst)
          .between(q_patch, cutoff);
  for (std::size_t i = 0; i < within.wave_number.size(); ++i) {
    const double q = i == 0 ? q_patch * (1 + 1e-9) : within.wave_number[i];
    if (q <= all.wave_number.back()) continue;
    all.wave_number.push_back(q);
    all.density.push_back(within.density[i]);
  }
  return all;
}

MeanField ridge_field(const Finger& finger, double q_patch, double relative_humidity) {
  const MacroContact& macro = finger.macro;
  const double factor = finger.skin.modulus_factor(relative_humidity);
  return MeanField(ridge_and_skin(finger, q_patch),
                   {finger.skin.bulk_modulus * factor, finger.skin.bulk_poisson,
                    macro.corneum_thickness, macro.tissue_modulus, 0.5});
}

// How many times more patches carry a surface that gives by compliance [m/Pa] than a rigid one
// under a patch pressure of `rigid` [Pa]: those within reach of its compression as well. Eq.
// coupling.6
double more_patches(const Finger& finger, double compliance, double rigid,
                    double relative_humidity) {
  const double nominal = ridge_load(finger.macro, finger.load, relative_humidity).mean_pressure;
  if (!(nominal > 0) || !(compliance > 0) || finger.macro.ridge_rms <= 0) return 1;
  const MeanField all = ridge_field(finger, 2 * kPi / kPatch, relative_humidity);
  const PowerSpectrum ridges = all.spectrum().between(all.spectrum().lowest(), 2 * kPi / kPatch);
  const GapDistribution gaps = MeanField(ridges, all.solid()).gaps(nominal);
  // A patch at a few nanometres touches with its skin.
  constexpr double kTouches = 5e-9;
  const double touching = gaps.cumulative(kTouches);
  if (!(touching > 0)) return 1;
  const auto within = [&](double pressure) {
    return gaps.cumulative(kTouches + compliance * pressure) / touching;
  };
  // pressure x patches is the load: rises with the pressure.
  double low = 0, high = rigid;
  for (int k = 0; k < 60 && high - low > 1e-9 * rigid; ++k) {
    const double pressure = 0.5 * (low + high);
    (pressure * within(pressure) < rigid ? low : high) = pressure;
  }
  return rigid / (0.5 * (low + high));
}

}  // namespace

double capacitive_gap(const Finger& finger, double ridge_pressure, double dielectric,
                      double relative_humidity) {
  const double h0 = dielectric + finger.skin_layer(relative_humidity);
  const MeanField field = ridge_field(finger, 2 * kPi / kPatch, relative_humidity);
  return 1 / field.gaps(ridge_pressure).inverse(h0) - h0;
}

ScaleBridge::ScaleBridge(const Scene& scene, const Fidelity& fidelity, const Grid& grid,
                         double relative_humidity, const CompliantBody& body)
    : closure_(scene.model.closure), patch_area_(grid.area()) {
  const Finger& finger = scene.finger;
  const MacroContact& macro = finger.macro;
  if (closure_ == Closure::Uniform) {
    carrying_share_ = macro.load_share;
    mean_pressure_ = nominal_ = finger.patch_pressure(relative_humidity);
    if (body.present()) {
      const double more =
          more_patches(finger, body.compliance(scene.surface), nominal_, relative_humidity);
      carrying_share_ *= more;
      mean_pressure_ = nominal_ /= more;
    }
    pressures_ = {mean_pressure_};
    return;
  }
  carrying_share_ = macro.ridge_share;
  nominal_ = ridge_load(macro, finger.load, relative_humidity).mean_pressure;
  const double q_patch = 2 * kPi / std::sqrt(grid.area());
  const MeanField field = ridge_field(finger, q_patch, relative_humidity);
  if (nominal_ == 0) {
    pressures_ = {nominal_};
    shares_ = {{1}, {1}};
    mean_pressure_ = nominal_;
    return;
  }
  const PatchPressures patches(field.stress_measure(q_patch), nominal_, fidelity.bridge_nodes);
  pressures_ = patches.pressure();
  shares_ = {patches.share(), patches.share()};
  mean_pressure_ = nominal_ / std::accumulate(shares_.off.begin(), shares_.off.end(), 0.0);
  if (!scene.drive.driven()) return;
  // Pull of the open gaps at the pressure that it makes itself.
  const FieldProblem electric = field_problem(scene, relative_humidity);
  const std::complex<double> h0 = electric.dielectric + electric.skin_layer;
  const double scale = 0.5 * kVacuumPermittivity * square(electric.v_rms);
  bool settled = false;
  for (int i = 0; i < 100 && !settled; ++i) {
    const double pull = scale * field.gaps(nominal_ + far_pull_).far_inverse_square(h0, q_patch);
    settled = std::abs(pull - far_pull_) <= 1e-6 * (nominal_ + pull);
    far_pull_ = pull;
    if (far_pull_ > 1e3 * nominal_) break;
  }
  if (!settled) {
    status_.note({Trouble::FarGapPullIn, 0, ""});
    far_pull_ = 0;
  }
  shares_.on = patches.share_at(nominal_ + far_pull_);
}

PatchResult ScaleBridge::combine(std::span<const PatchResult> patches) const {
  PAPILLA_CHECK(patches.size() == pressures_.size(), "one result per pressure");
  if (closure_ == Closure::Uniform) return patches[0];
  PatchResult out;
  out.load = nominal_ * patch_area_;
  out.pull = far_pull_ * patch_area_;
  out.status = status_;
  add_over_pressures(patches, shares_, out);
  return out;
}

}  // namespace papilla::forward
