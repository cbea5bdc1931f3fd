#include "forward/scale_bridge.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "base/check.h"
#include "base/constants.h"
#include "forward/open_gaps.h"
#include "forward/scene_terms.h"
#include "physics/macro/fingertip.h"
#include "physics/persson/patches.h"
#include "physics/persson/persson.h"

namespace papilla::forward {
namespace {

// Of the ridges, above which the share that carries is said to have reached its limit.
constexpr double kNearlyAll = 0.95;

double sum_of(const std::vector<double>& share) {
  return std::accumulate(share.begin(), share.end(), 0.0);
}

// Patches of a surface that gives by `compliance` [m/Pa]: more of them at less pressure each. Eq.
// coupling.6
void compress(const Finger& finger, double compliance, double relative_humidity, Balance& all) {
  const double rigid = sum_of(all.shares.nominal);
  const double share =
      compressed_share(finger, compliance, {rigid, all.nominal / rigid, 1}, relative_humidity);
  const double more = share / rigid;
  for (double& p : all.pressures) p /= more;
  const auto widen = [&](std::vector<double>& shares, double pressed) {
    const double touching = sum_of(shares);
    double load = 0;
    for (std::size_t k = 0; k < shares.size(); ++k) {
      shares[k] *= below(1, touching, touching * more) / touching;
      load += shares[k] * all.pressures[k];
    }
    return pressed / load;
  };
  widen(all.shares.nominal, all.nominal);
  all.shares.press_off = widen(all.shares.off, all.pressed_off);
  all.shares.press_on = widen(all.shares.on, all.pressed_on);
  all.touching_off = sum_of(all.shares.off);
  all.touching_on = sum_of(all.shares.on);
}

}  // namespace

ScaleBridge::ScaleBridge(const Scene& scene, const Fidelity& fidelity, const Grid& grid,
                         double relative_humidity, const CompliantBody& body,
                         const SurfaceLevels& levels)
    : closure_(scene.model.closure), patch_area_(grid.area()) {
  const Finger& finger = scene.finger;
  const MacroContact& macro = finger.macro;
  if (closure_ == Closure::Uniform) {
    carrying_share_ = macro.load_share;
    mean_pressure_ = nominal_ = finger.patch_pressure(relative_humidity);
    if (body.present()) {
      // The share that is given may be beyond the ridges': nothing to bring then.
      const double most = std::max(macro.ridge_share, macro.load_share);
      carrying_share_ = compressed_share(finger, body.compliance(scene.surface),
                                         {macro.load_share, nominal_, most}, relative_humidity);
      mean_pressure_ = nominal_ *= macro.load_share / carrying_share_;
      note_limit(carrying_share_ / most);
    }
    pressures_ = {mean_pressure_};
    return;
  }
  carrying_share_ = macro.ridge_share;
  const double q_patch = 2 * kPi / std::sqrt(grid.area());
  if (closure_ == Closure::Balance) {
    balance_ = solve_balance(scene, q_patch, relative_humidity, fidelity.balance_nodes, levels);
    nominal_ = balance_.nominal;
    if (body.present() && nominal_ > 0) {
      compress(finger, body.compliance(scene.surface), relative_humidity, balance_);
      note_limit(balance_.touching_off);
    }
    if (balance_.pull_in) status_.note({Trouble::FarGapPullIn, 0, ""});
    if (balance_.pull_in_undriven) status_.note({Trouble::UndrivenPullIn, 0, ""});
    pressures_ = balance_.pressures;
    shares_ = balance_.shares;
    mean_pressure_ = nominal_ / sum_of(shares_.nominal);
    return;
  }
  nominal_ = ridge_load(macro, finger.load, relative_humidity).mean_pressure;
  const MeanField field = ridge_field(finger, q_patch, relative_humidity);
  if (nominal_ == 0) {
    pressures_ = {nominal_};
    shares_ = {{1}, {1}, {1}};
    mean_pressure_ = nominal_;
    return;
  }
  const PatchPressures patches(field.stress_measure(q_patch), nominal_, fidelity.bridge_nodes);
  pressures_ = patches.pressure();
  shares_ = {patches.share(), patches.share(), patches.share()};
  mean_pressure_ = nominal_ / sum_of(shares_.off);
  if (!scene.drive.driven()) return;
  // Pull of the open gaps at the pressure that it makes itself.
  const FieldProblem electric = field_problem(scene, relative_humidity);
  const std::complex<double> h0 = electric.dielectric + electric.skin_layer;
  const double scale = 0.5 * kVacuumPermittivity * square(electric.v_rms);
  const auto pull_at = [&](double pressure) {
    const GapDistribution gaps = field.gaps(pressure);
    // What holds the field takes its part gap by gap. Eq. electrostatics.21
    return field_is_held(electric) ? open_gap_pull(gap_shares(gaps, q_patch), {}, electric)
                                   : scale * gaps.far_inverse_square(h0, q_patch);
  };
  bool settled = false;
  for (int i = 0; i < 100 && !settled; ++i) {
    const double pull = pull_at(nominal_ + far_pull_);
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

void ScaleBridge::note_limit(double share_of_ridges) {
  if (share_of_ridges > kNearlyAll) status_.note({Trouble::RidgesCarry, share_of_ridges, ""});
}

PatchResult ScaleBridge::combine(std::span<const PatchResult> patches) const {
  PAPILLA_CHECK(patches.size() == pressures_.size(), "one result per pressure");
  if (closure_ == Closure::Uniform) {
    PatchResult out = patches[0];
    out.status = status_;
    out.status.note(patches[0].status);
    return out;
  }
  PatchResult out;
  out.load = nominal_ * patch_area_;
  out.status = status_;
  if (closure_ == Closure::Persson) {
    out.pull = far_pull_ * patch_area_;
  } else {
    out.pull = balance_.far.pull * patch_area_;
    out.capillary_off = balance_.far.capillary * patch_area_;
    out.capillary_on = balance_.far.capillary_on * patch_area_;
    out.retention = balance_.far.retention * patch_area_;
    out.retention_on = balance_.far.retention_on * patch_area_;
  }
  add_over_pressures(patches, shares_, out);
  return out;
}

}  // namespace papilla::forward
