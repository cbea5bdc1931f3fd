#include "forward/point.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "forward/electric_path.h"
#include "forward/scene_terms.h"
#include "forward/water_band.h"
#include "numerics/statistics.h"
#include "physics/contact/facts.h"

namespace papilla::forward {
namespace {

using Patches = std::span<const PatchResult>;

Measured sampled_mean(Patches patches, double PatchResult::*member, double factor = 1) {
  std::vector<double> values;
  values.reserve(patches.size());
  for (const PatchResult& p : patches) values.push_back(p.*member);
  const Estimate e = mean_estimate(values);
  return {factor * e.value, {.sampling = std::abs(factor) * e.se}};
}

// Per-skin numbers, peaks, shares and the first trouble or pull-in.
void gather(ResponsePoint& point, Patches patches) {
  const auto count = static_cast<double>(patches.size());
  for (const PatchResult& p : patches) {
    point.samples.load_off.push_back(p.load + p.capillary_off);
    point.samples.load_on.push_back(p.load + p.capillary_on + p.pull);
    point.samples.area_off.push_back(p.area_off);
    point.samples.area_on.push_back(p.area_on);
    point.over_limit_area += p.over_limit_area / count;
    point.over_limit_share += p.over_limit_share / count;
    point.oxide_margin = std::min(point.oxide_margin, p.oxide_margin);
    point.peak_oxide_field = std::max(point.peak_oxide_field, p.peak_oxide_field);
    point.peak_air_field = std::max(point.peak_air_field, p.peak_air_field);
    if (p.volume > 0) point.bridge_water_share += p.bridge_volume / p.volume / count;
    point.status.note(p.status);
  }
}

// The share of the patch of a contact that grows by a factor: in proportion where it is small, to
// rounding up to a tenth, and smoothly to all of it. Eq. friction.3
double grown(double area, double factor) {
  constexpr double kSharpness = 8;
  if (!(area < 1)) return std::min(factor, 1.0);
  const double closed = 1 - std::pow(area, kSharpness), open = area * factor;
  return open / std::pow(closed + std::pow(open, kSharpness), 1 / kSharpness);
}

// A contact area that grows with the load on it.
struct GrownArea {
  Measured area;
  double held = 1;  // of what it would be if it could be more than the patch
};

GrownArea scaled(const Measured& dry, const Estimate& load_ratio, const Fidelity& fidelity,
                 ResponsePoint& point) {
  const double factor = fidelity.area_by_load(load_ratio.value);
  const double relative =
      load_ratio.value > 0 ? fidelity.load_exponent * load_ratio.se / load_ratio.value : 0;
  const double open = dry.value * factor;
  if (open > 1) point.status.note({Trouble::FullContact, open, ""});
  GrownArea out;
  if (open > 0) out.held = grown(dry.value, factor) / open;
  out.area.value = open * out.held;
  out.area.parts.sampling = out.held * std::hypot(dry.parts.sampling * factor, open * relative);
  return out;
}

// Eq. friction.3: F ~ L^beta on the dry contact area of the patches in contact, of which there are
// as many more as the open gaps press on (Eq. coupling.10).
void areas_by_load(ResponsePoint& point, const ScaleBridge& bridge, Patches patches,
                   const Fidelity& fidelity, double area_factor) {
  const Measured dry = sampled_mean(patches, &PatchResult::area_dry, area_factor);
  std::vector<double> loads;
  for (const PatchResult& p : patches) loads.push_back(p.load);
  const double gain_by_gaps = bridge.growth_on() / bridge.growth_off();
  const auto by_law = [&](double growth, const Estimate& ratio) {
    GrownArea out = scaled(dry, {ratio.value / growth, ratio.se / growth}, fidelity, point);
    out.area.value *= growth;
    out.area.parts.sampling *= growth;
    return out;
  };
  const Estimate off = ratio_estimate(point.samples.load_off, loads);
  const Estimate on = ratio_estimate(point.samples.load_on, loads);
  const Estimate gain = ratio_estimate(point.samples.load_on, point.samples.load_off);
  const GrownArea without = by_law(bridge.growth_off(), off);
  const GrownArea with = by_law(bridge.growth_on(), on);
  point.area_fraction_off = without.area;
  point.area_fraction_on = with.area;
  const double ratio =
      gain_by_gaps * fidelity.area_by_load(gain.value / gain_by_gaps) * with.held / without.held;
  point.modulation.value = ratio - 1;
  point.modulation.parts.sampling =
      fidelity.load_exponent * ratio * gain.se / std::max(gain.value, 1e-12);
}

// Eq. friction.1, friction.2: resolved areas, ratio of sums over the skins.
void areas_resolved(ResponsePoint& point, double area_factor) {
  const Estimate off = mean_estimate(point.samples.area_off);
  const Estimate on = mean_estimate(point.samples.area_on);
  point.area_fraction_off = {area_factor * off.value, {.sampling = area_factor * off.se}};
  point.area_fraction_on = {area_factor * on.value, {.sampling = area_factor * on.se}};
  for (const Measured* area : {&point.area_fraction_off, &point.area_fraction_on}) {
    if (area->value > 1) point.status.note({Trouble::FullContact, area->value, ""});
  }
  if (off.value > 0) {
    const Estimate gain = ratio_estimate(point.samples.area_on, point.samples.area_off);
    point.modulation = {gain.value - 1, {.sampling = gain.se}};
  }
}

Measured friction(double strength, const Measured& area, const Measured& retention) {
  Measured f;
  f.value = strength * area.value + retention.value;
  f.parts.sampling = std::hypot(strength * area.parts.sampling, retention.parts.sampling);
  return f;
}

// Friction off and on from areas and retention, which is part of both: the modulation of the areas
// counts by the share of the dry friction, and bridges that a closed gap has spread hold more. Eq.
// friction.1
void add_friction(ResponsePoint& point, double strength, const Measured& retention_on,
                  bool driven) {
  point.strength = strength;
  point.friction_off = friction(strength, point.area_fraction_off, point.retention_force);
  point.friction_on = friction(strength, point.area_fraction_on, retention_on);
  point.retention_gain = retention_on.value - point.retention_force.value;
  if (!driven) {
    point.modulation = {};
    return;
  }
  if (point.friction_off.value <= 0) return;
  const double share = 1 - point.retention_force.value / point.friction_off.value;
  point.modulation.value *= share;
  point.modulation.value += point.retention_gain / point.friction_off.value;
  point.modulation.parts.sampling *= std::abs(share);
}

// Eq. friction.4: a coefficient on all that presses, whatever touches; retention is held besides.
void rub_by_load(ResponsePoint& point, double coefficient, double patches_per_finger,
                 const Measured& retention_on, bool driven) {
  const auto rubbed = [&](const std::vector<double>& loads, const Measured& held) {
    const Estimate load = mean_estimate(loads);
    const double factor = coefficient * patches_per_finger;
    return Measured{factor * load.value + held.value,
                    {.sampling = std::hypot(factor * load.se, held.parts.sampling)}};
  };
  point.friction_off = rubbed(point.samples.load_off, point.retention_force);
  point.friction_on = rubbed(point.samples.load_on, retention_on);
  point.retention_gain = retention_on.value - point.retention_force.value;
  point.modulation = {};
  if (!driven || point.friction_off.value <= 0) return;
  const Estimate gain = ratio_estimate(point.samples.load_on, point.samples.load_off);
  point.modulation.value = point.friction_on.value / point.friction_off.value - 1;
  point.modulation.parts.sampling = gain.se;
}

// Eq. accuracy.1
void add_solver_errors(ResponsePoint& point, Patches patches, const LoadExponents& exponents) {
  double certificate = 0, residual = 0;
  for (const PatchResult& p : patches) {
    certificate = std::max(certificate, p.certificate);
    residual = std::max(residual, p.coupling_residual);
  }
  // An attraction that is off by a share of the load moves the area by that times beta.
  const auto relative = [&](Measured PointQuantities::*quantity) {
    return std::hypot(contact_error(certificate), exponents.of(quantity) * residual);
  };
  for (const PointQuantity& q : kPointQuantities) {
    Measured& m = point.*q.value;
    m.parts.solver.emplace(relative(q.value) * std::abs(m.value));
  }
  point.modulation.parts.solver =
      relative(&PointQuantities::modulation) * (1 + std::abs(point.modulation.value));
}

}  // namespace

ResponsePoint response_point(const PointSetting& setting, double relative_humidity, double weight,
                             const ScaleBridge& bridge, Patches patches) {
  const Scene& scene = setting.scene;
  const Plan& plan = setting.plan;
  const MacroContact& macro = scene.finger.macro;
  ResponsePoint point;
  point.relative_humidity = relative_humidity;
  point.weight = weight;
  point.patch_pressure = bridge.mean_pressure();
  if (plan.field) point.source_voltage = source_voltage(scene, relative_humidity).peak;
  const double carrying =
      bridge.carrying_share() * macro.gross_area(scene.finger.load, relative_humidity);  // [m^2]
  const double patches_per_finger = carrying / plan.grid.area();
  gather(point, patches);
  if (!patches.empty()) {
    point.samples.preload = patches.front().load;
    point.samples.pressed_off = point.samples.preload * bridge.growth_off();
    point.samples.pressed_on = point.samples.preload * bridge.growth_on();
  }
  for (const PointQuantity& q : kPointQuantities) {
    if (q.mean_of)
      point.*q.value = sampled_mean(patches, q.mean_of, q.whole_finger ? patches_per_finger : 1);
  }
  Measured retention_on = sampled_mean(patches, &PatchResult::retention_on, patches_per_finger);
  if (!plan.retention) point.retention_force = retention_on = {};
  if (setting.fidelity.estimator == Estimator::Load || !plan.traction_solves) {
    areas_by_load(point, bridge, patches, setting.fidelity, setting.area_factor);
  } else {
    areas_resolved(point, setting.area_factor);
  }
  for (auto* areas : {&point.samples.area_off, &point.samples.area_on})
    for (double& area : *areas) area *= setting.area_factor;
  add_friction(point, shear_strength(scene, relative_humidity) * carrying, retention_on,
               plan.field);
  if (scene.touch.coefficient > 0)
    rub_by_load(point, scene.touch.coefficient, patches_per_finger, retention_on, plan.field);
  const LoadExponents exponents =
      load_exponents(setting.fidelity.load_exponent, scene.touch.coefficient);
  add_solver_errors(point, patches, exponents);
  if (plan.water) add_water_band(point, patches, scene.model.water, plan.grid, exponents);
  return point;
}

void note_water(ResponsePoint& point, const SkinWater& water) {
  constexpr double kLeastOpen = 0.05;
  const double open = 1 - point.wetted_fraction.value - point.area_fraction_off.value;
  if (open < kLeastOpen) point.status.note({Trouble::NearlyFlooded, std::max(open, 0.0), ""});
  const std::vector<double>& fitted = water.relative_humidity;
  if (fitted.size() < 2) return;  // one volume at every humidity
  const double nearest = std::clamp(point.relative_humidity, fitted.front(), fitted.back());
  constexpr double kSame = 1e-9;
  if (std::abs(point.relative_humidity - nearest) > kSame)
    point.status.note({Trouble::WaterBeyondFit, nearest, ""});
}

}  // namespace papilla::forward
