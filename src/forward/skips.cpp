#include "forward/skips.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/constants.h"
#include "forward/scene_terms.h"
#include "numerics/reductions.h"

namespace papilla::forward {
namespace {

constexpr double kHamaker = 5e-20;          // [J] water, glass, keratin: 3.7e-20 to 9e-20
constexpr double kClosestApproach = 3e-10;  // [m] of atoms
constexpr double kMolarVolume = 1.8e-5;     // [m^3/mol] of water
constexpr double kThermal = 2479;           // R T at 25 C [J/mol]

}  // namespace

Traction van_der_waals_traction(const Gap& gap) {
  Traction out{gap.grid, std::vector<double>(gap.value.size(), 0.0)};
  for (std::size_t i = 0; i < gap.value.size(); ++i) {
    if (gap.value[i] <= 0) continue;
    const double g = gap.value[i] + kClosestApproach;
    out.value[i] = kHamaker / (6 * kPi * g * g * g);
  }
  return out;
}

Traction kelvin_traction(const Gap& gap, const Scene& scene, double relative_humidity) {
  Traction out{gap.grid, std::vector<double>(gap.value.size(), 0.0)};
  const SkinWater& water = scene.finger.water;
  const double cosines = std::cos(water.contact_angle) + std::cos(scene.surface.contact_angle);
  if (relative_humidity <= 0 || cosines <= 0) return out;
  const double suction = kThermal / kMolarVolume * -std::log(std::min(relative_humidity, 1.0));
  // A meniscus in equilibrium with the air fills gaps up to the one that its curvature spans.
  const double widest = suction > 0 ? water.surface_tension * cosines / suction : kInfinity;
  for (std::size_t i = 0; i < gap.value.size(); ++i) {
    if (gap.value[i] > 0 && gap.value[i] <= widest) out.value[i] = suction;
  }
  return out;
}

SkipBounds skip_bounds(const Scene& given, const Texture& texture, const Fidelity& given_fidelity,
                       int skins) {
  Scene once = given;
  once.model.coupling = Coupling::OnePass;
  Scene scene = once;
  scene.finger = given.finger.applied();
  Fidelity fidelity = given_fidelity;
  fidelity.estimator = Estimator::Area;
  const double beta = fidelity.load_exponent;
  SkipBounds out;
  Scene held = given;  // with the retention that preset m3 leaves out, undriven
  held.model.preset = Preset::Papilla;
  held.drive = {};
  fidelity.skins = skins;
  fidelity.control_skins = 0;
  for (const ResponsePoint& p : evaluate(held, texture, fidelity).points) {
    const double sliding = p.friction_off.value - p.retention_force.value;
    if (sliding > 0) out.retention = std::max(out.retention, p.retention_force.value / sliding);
  }
  for (const double rh : scene.environment.relative_humidity) {
    double load_off = 0, load_on = 0, waals = 0, kelvin = 0, pull = 0, next = 0;
    for (int k = 0; k < skins; ++k) {
      const PatchPicture p = picture_patch(once, texture, fidelity, rh, k);
      const CoveredSurface surface(p.texture, film_of(scene));
      const Gap off{p.texture.grid, p.fields.off.gap}, on{p.texture.grid, p.fields.on.gap};
      if (off.value.empty() || on.value.empty()) continue;
      load_off += mean(p.fields.off.pressure);
      load_on += mean(p.fields.on.pressure);
      waals += van_der_waals_traction(off).mean();
      kelvin += kelvin_traction(off, scene, rh).mean();
      if (!scene.drive.driven()) continue;
      pull += p.fields.pull.mean();
      next += solve_field(scene, on, &surface, p.fields.wetting_on, field_problem(scene, rh),
                          fidelity.field_tolerance)
                  .mean_pressure;
    }
    if (load_off <= 0) continue;
    // Friction grows no faster than the load (beta < 1), and near contacts, where these forces sit,
    // by two to three times what the same force would spread out (measured, skips_test.cpp).
    out.van_der_waals = std::max(out.van_der_waals, 2 * beta * waals / load_off);
    out.kelvin = std::max(out.kelvin, rh < 1 ? 2 * beta * kelvin / load_off : kInfinity);
    if (pull > 0 && load_on > 0) {
      const double gain = next / pull - 1;
      const double bound = gain < 1 ? pull * std::max(gain, 0.0) / (1 - gain) / load_on : kInfinity;
      // Of 142 random scenes of eight kinds of texture the largest change was 3.2 beta times this.
      out.self_consistency = std::max(out.self_consistency, 4 * beta * bound);
    }
  }
  return out;
}

Plan measured_plan(const Scene& scene, const Texture& texture, const Fidelity& fidelity) {
  Plan plan = make_plan(scene, texture, fidelity);
  const SkipBounds bounds = skip_bounds(scene, texture, fidelity);
  const std::map<Piece, double> measured{{Piece::VanDerWaals, bounds.van_der_waals},
                                         {Piece::Kelvin, bounds.kelvin},
                                         {Piece::Coupling, bounds.self_consistency},
                                         {Piece::Retention, bounds.retention}};
  for (PlanSkip& skip : plan.skipped) {
    const auto bound = measured.find(skip.piece);
    if (bound == measured.end()) continue;
    skip.bound = bound->second;
    skip.estimate = skip.piece == Piece::VanDerWaals;  // its constant is proven by nothing
  }
  return plan;
}

}  // namespace papilla::forward
