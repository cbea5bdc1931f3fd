#include "forward/point.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "forward/electric_path.h"
#include "forward/equilibrium.h"
#include "forward/scene_terms.h"
#include "forward/water_band.h"
#include "numerics/statistics.h"
#include "physics/contact/facts.h"

namespace papilla::forward {
namespace {

using Patches = std::span<const PatchResult>;

std::vector<double> of_skins(Patches patches, double PatchResult::*member) {
  std::vector<double> values;
  values.reserve(patches.size());
  for (const PatchResult& p : patches) values.push_back(p.*member);
  return values;
}

// Inlined, g++ 12 takes its store into a member that is chosen at run time for one out of bounds.
[[gnu::noinline]] Measured sampled_mean(Patches patches, double PatchResult::*member,
                                        double factor) {
  const Estimate e = mean_estimate(of_skins(patches, member));
  return {factor * e.value, {.sampling = std::abs(factor) * e.se}};
}

// A number with a sample per skin, whose mean it is to first order: skins with more water press
// harder and hold more, and in a sum they do both at once.
struct OverSkins {
  double value = 0;
  std::vector<double> samples{};

  Measured measured() const { return {value, {.sampling = mean_estimate(samples).se}}; }
};

// factor x number + other
OverSkins with_other(double factor, const OverSkins& number, const OverSkins& other) {
  OverSkins out{factor * number.value + other.value, other.samples};
  for (std::size_t k = 0; k < out.samples.size(); ++k) out.samples[k] += factor * number.samples[k];
  return out;
}

// Before and under the drive.
struct OffAndOn {
  OverSkins off, on;
};

// Per-skin numbers, peaks, shares, means and the first trouble or pull-in.
void gather(ResponsePoint& point, Patches patches, double patches_per_finger) {
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
  for (const PointQuantity& q : kPointQuantities) {
    if (q.mean_of)
      point.*q.value = sampled_mean(patches, q.mean_of, q.whole_finger ? patches_per_finger : 1);
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
  OverSkins area;
  double held = 1;  // of what it would be if it could be more than the patch
};

// area: estimate over the patch. Friction by a coefficient takes no area (Eq. friction.4).
void note_full_contact(ResponsePoint& point, const Scene& scene, double area) {
  if (area > 1 && !(scene.touch.coefficient > 0))
    point.status.note({Trouble::FullContact, area, ""});
}

// Eq. friction.3: F ~ L^beta on the dry contact area of the patches in contact, of which there are
// as many more as the open gaps press on (Eq. coupling.10).
OffAndOn areas_by_load(ResponsePoint& point, const ScaleBridge& bridge, Patches patches,
                       const PointSetting& setting) {
  const Fidelity& fidelity = setting.fidelity;
  const double area_factor = setting.area_factor;
  const std::vector<double> dry = of_skins(patches, &PatchResult::area_dry);
  const std::vector<double> preload = of_skins(patches, &PatchResult::load);
  const double dry_mean = mean_estimate(dry).value, preload_mean = mean_estimate(preload).value;
  const double gain_by_gaps = bridge.growth_on() / bridge.growth_off();
  const auto by_law = [&](double growth, const std::vector<double>& loads) {
    const double ratio = ratio_estimate(loads, preload).value;
    const double factor = fidelity.area_by_load(ratio / growth);
    const double pressed = area_factor * dry_mean * growth, open = pressed * factor;
    // A contact that the load alone has closed cannot grow: it is held at the patch, as it is.
    if (dry_mean <= 1 - kLeastLeftOpen) note_full_contact(point, setting.scene, open);
    GrownArea out;
    out.area.samples.resize(dry.size());
    if (open > 0) out.held = grown(pressed, factor) / open;
    out.area.value = open * out.held;
    if (!(open > 0)) return out;
    // Each skin by its own dry area and its own loads.
    const double mean = mean_estimate(loads).value;
    for (std::size_t k = 0; k < dry.size(); ++k)
      out.area.samples[k] =
          out.area.value * (dry[k] / dry_mean +
                            fidelity.load_exponent * (loads[k] / mean - preload[k] / preload_mean));
    return out;
  };
  const Estimate gain = ratio_estimate(point.samples.load_on, point.samples.load_off);
  const GrownArea without = by_law(bridge.growth_off(), point.samples.load_off);
  const GrownArea with = by_law(bridge.growth_on(), point.samples.load_on);
  const double ratio =
      gain_by_gaps * fidelity.area_by_load(gain.value / gain_by_gaps) * with.held / without.held;
  point.modulation.value = ratio - 1;
  point.modulation.parts.sampling =
      fidelity.load_exponent * ratio * gain.se / std::max(gain.value, 1e-12);
  return {without.area, with.area};
}

// Eq. friction.1, friction.2: resolved areas, ratio of sums over the skins.
OffAndOn areas_resolved(ResponsePoint& point, const PointSetting& setting) {
  const auto area = [&](const std::vector<double>& samples) {
    const OverSkins none{0, std::vector<double>(samples.size())};
    const OverSkins out =
        with_other(setting.area_factor, {mean_estimate(samples).value, samples}, none);
    note_full_contact(point, setting.scene, out.value);
    return out;
  };
  const OffAndOn out{area(point.samples.area_off), area(point.samples.area_on)};
  if (out.off.value > 0) {
    const Estimate gain = ratio_estimate(point.samples.area_on, point.samples.area_off);
    point.modulation = {gain.value - 1, {.sampling = gain.se}};
  }
  return out;
}

// Friction off and on from areas and retention, which is part of both: the modulation of the areas
// counts by the share of the dry friction, and bridges that a closed gap has spread hold more. Eq.
// friction.1
void add_friction(ResponsePoint& point, double strength, const OffAndOn& areas,
                  const OffAndOn& retention, bool driven) {
  point.strength = strength;
  point.friction_off = with_other(strength, areas.off, retention.off).measured();
  point.friction_on = with_other(strength, areas.on, retention.on).measured();
  point.retention_gain = retention.on.value - retention.off.value;
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
                 const OffAndOn& retention, bool driven) {
  const auto rubbed = [&](const std::vector<double>& loads, const OverSkins& held) {
    return with_other(coefficient * patches_per_finger, {mean_estimate(loads).value, loads}, held)
        .measured();
  };
  point.friction_off = rubbed(point.samples.load_off, retention.off);
  point.friction_on = rubbed(point.samples.load_on, retention.on);
  point.retention_gain = retention.on.value - retention.off.value;
  point.modulation = {};
  if (!driven || point.friction_off.value <= 0) return;
  const Estimate gain = ratio_estimate(point.samples.load_on, point.samples.load_off);
  point.modulation.value = point.friction_on.value / point.friction_off.value - 1;
  point.modulation.parts.sampling = gain.se;
}

// Shares of friction before and under the drive that stand on the solved contact.
struct OfContact {
  double off = 1, on = 1;

  double of(Measured PointQuantities::*quantity) const {
    if (quantity == &PointQuantities::friction_off) return off;
    const bool driven =
        quantity == &PointQuantities::friction_on || quantity == &PointQuantities::modulation;
    return driven ? on : 1;
  }
};

// Eq. friction.4: a coefficient on the load that is given needs no contact; attractions and
// retention do.
OfContact of_contact(const ResponsePoint& point, double coefficient, double patches_per_finger) {
  const double by_load = coefficient * patches_per_finger * point.samples.preload;
  const auto share = [&](const Measured& friction) {
    return friction.value > 0 ? std::min(std::abs(1 - by_load / friction.value), 1.0) : 1;
  };
  return {share(point.friction_off), share(point.friction_on)};
}

// Eq. accuracy.1
void add_solver_errors(ResponsePoint& point, Patches patches, const LoadExponents& exponents,
                       const OfContact& shares) {
  double certificate = 0, residual = 0;
  for (const PatchResult& p : patches) {
    certificate = std::max(certificate, p.certificate);
    residual = std::max(residual, p.coupling_residual);
  }
  // An attraction that is off by a share of the load moves the area by that times beta.
  const auto relative = [&](Measured PointQuantities::*quantity) {
    return std::hypot(shares.of(quantity) * contact_error(certificate),
                      exponents.of(quantity) * residual);
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
  gather(point, patches, patches_per_finger);
  if (!patches.empty()) {
    point.samples.preload = patches.front().load;
    point.samples.pressed_off = point.samples.preload * bridge.growth_off();
    point.samples.pressed_on = point.samples.preload * bridge.growth_on();
  }
  const auto on_finger = [&](double PatchResult::*member) {
    return patches_per_finger * mean_estimate(of_skins(patches, member)).value;
  };
  if (plan.field)
    point.capillary_gain =
        on_finger(&PatchResult::capillary_on) - on_finger(&PatchResult::capillary_off);
  if (!plan.retention) point.retention_force = {};
  const auto retained = [&](double PatchResult::*member) {
    OverSkins out{0, std::vector<double>(patches.size())};
    if (!plan.retention) return out;
    const std::vector<double> forces = of_skins(patches, member);
    return with_other(patches_per_finger, {mean_estimate(forces).value, forces}, out);
  };
  const OffAndOn retention{retained(&PatchResult::retention), retained(&PatchResult::retention_on)};
  const bool by_load = setting.fidelity.estimator == Estimator::Load || !plan.traction_solves;
  const OffAndOn areas =
      by_load ? areas_by_load(point, bridge, patches, setting) : areas_resolved(point, setting);
  point.area_fraction_off = areas.off.measured();
  point.area_fraction_on = areas.on.measured();
  for (auto* samples : {&point.samples.area_off, &point.samples.area_on})
    for (double& area : *samples) area *= setting.area_factor;
  add_friction(point, shear_strength(scene, relative_humidity) * carrying, areas, retention,
               plan.field);
  OfContact solved;
  if (scene.touch.coefficient > 0) {
    rub_by_load(point, scene.touch.coefficient, patches_per_finger, retention, plan.field);
    solved = of_contact(point, scene.touch.coefficient, patches_per_finger);
  }
  const LoadExponents exponents =
      load_exponents(setting.fidelity.load_exponent, scene.touch.coefficient);
  add_solver_errors(point, patches, exponents, solved);
  if (plan.water) add_water_band(point, patches, scene.model.water, plan.grid, exponents);
  return point;
}

namespace {

// The sampling part of every number from those of the point without each skin.
void take_sampling(ResponsePoint& point, std::span<const ResponsePoint> without) {
  for (const PointQuantity& q : kPointQuantities) {
    Measured& number = point.*q.value;
    std::vector<double> of_others;
    for (const ResponsePoint& p : without) of_others.push_back((p.*q.value).value);
    number.parts.sampling = mean_estimate(jackknife_samples(number.value, of_others)).se;
  }
}

// The results without each skin, by the load law of all.
std::vector<std::vector<PatchResult>> all_but_each(const std::vector<PatchResult>& results) {
  std::vector<std::vector<PatchResult>> out;
  for (std::size_t k = 0; k < results.size(); ++k) {
    out.push_back(results);
    out.back().erase(out.back().begin() + static_cast<std::ptrdiff_t>(k));
  }
  return out;
}

}  // namespace

SkinPoints skin_points(const PointSetting& setting, double relative_humidity, double weight,
                       const ScaleBridge& bridge, const std::vector<PatchResult>& patches,
                       std::vector<std::vector<PatchResult>> by_own_laws) {
  const auto point_of = [&](const std::vector<PatchResult>& some) {
    return response_point(setting, relative_humidity, weight, bridge, some);
  };
  SkinPoints out{point_of(patches), {}};
  if (patches.size() < 2) return out;
  const bool refitted = !by_own_laws.empty();
  for (const auto& others : refitted ? std::move(by_own_laws) : all_but_each(patches)) {
    out.without.push_back(point_of(others));
    out.without.back().samples = {};
  }
  if (refitted) take_sampling(out.all, out.without);
  return out;
}

void note_water(ResponsePoint& point, const SkinWater& water) {
  constexpr double kLeastOpen = 0.05;
  const double open = 1 - point.wetted_fraction.value - point.area_fraction_off.value;
  if (open < kLeastOpen) point.status.note({Trouble::NearlyFlooded, std::max(open, 0.0), ""});
  const std::vector<double>& fitted = water.relative_humidity;
  if (fitted.size() < 2) return;  // one volume at every humidity
  const double nearest = std::clamp(point.relative_humidity, fitted.front(), fitted.back());
  constexpr double kSame = 1e-9;
  if (std::abs(point.relative_humidity - nearest) > kSame) {
    point.water_fit = {Trouble::WaterBeyondFit, nearest, ""};
    point.status.note(point.water_fit);
  }
}

}  // namespace papilla::forward
