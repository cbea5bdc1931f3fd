#include "papilla/physics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "api/inside.h"
#include "base/constants.h"
#include "base/memory.h"
#include "cases/droplets.h"
#include "physics/capillary/bridge.h"
#include "physics/contact/contact.h"
#include "physics/electrostatics/full_field.h"
#include "physics/optics/optics.h"

namespace papilla::api {

namespace {

// Far beyond what a linear solid stands for.
constexpr double kMostStrain = 100;

Gap gap_of(const Heights& heights) {
  const Heightmap map = heightmap_of(heights);
  if (*std::min_element(map.z.begin(), map.z.end()) < 0)
    throw wrong("gap", "must not be negative anywhere; it is 0 in contact");
  return {map.grid, map.z};
}

void require(bool kept, const char* argument, const char* message) {
  if (!kept) throw wrong(argument, message);
}

void check(const Water& water) {
  require(water.surface_tension > 0, "surface_tension", "must be positive");
  require(water.theta_skin >= 0 && water.theta_skin <= kPi, "theta_skin", "is 0 to pi");
  require(water.theta_substrate >= 0 && water.theta_substrate <= kPi, "theta_substrate",
          "is 0 to pi");
  require(water.hysteresis >= 0 && water.hysteresis <= 2, "hysteresis", "is 0 to 2");
}

DropletState state_of(const Droplet& d) {
  return {d.x, d.y, d.volume, static_cast<DropletPlace>(d.state), d.radius, d.height, d.force};
}
static_assert(static_cast<int>(DropletPlace::Bridge) ==
              static_cast<int>(rooms::DropletState::Bridge));

WaterState state_of(WettingStatus status) {
  switch (status) {
    case WettingStatus::Dry:
      return WaterState::Dry;
    case WettingStatus::Discs:
      return WaterState::Discs;
    case WettingStatus::Film:
      return WaterState::Film;
    case WettingStatus::Flooded:
      return WaterState::Flooded;
  }
  return WaterState::Dry;
}

FieldProblem problem_of(double voltage, const FieldOptions& o) {
  require(voltage >= 0, "voltage", "must not be negative");
  require(o.thickness >= 0, "thickness", "must not be negative");
  require(o.permittivity >= 1, "permittivity", "is 1 or more");
  require(o.skin_layer >= 0, "skin_layer", "must not be negative");
  require(o.edge_radius >= 0, "edge_radius", "must not be negative");
  FieldProblem p;
  p.v_peak = voltage;
  p.v_rms = o.dc ? voltage : voltage / std::sqrt(2.0);
  p.dielectric_thickness = o.thickness;
  p.dielectric = o.thickness / o.permittivity;
  p.edge_radius = o.edge_radius;
  p.skin_layer = o.skin_layer;
  return p;
}

FieldSolution solve(FieldMethod method, const Gap& gap, const CoveredSurface* surface,
                    const FieldProblem& problem) {
  Wetting dry;
  dry.grid = gap.grid;
  switch (method) {
    case FieldMethod::Local:
      return solve_local_field(gap, surface, dry, problem);
    case FieldMethod::Spread:
      return solve_spread_field(gap, surface, dry, problem);
    case FieldMethod::Full:
      break;
  }
  require_memory(2000.0 * static_cast<double>(gap.grid.size()), "a field");
  return solve_full_field(gap, surface, dry, problem);
}

}  // namespace

Solid Solid::half_space(double contact_modulus) {
  return {contact_modulus, 0, 0, contact_modulus, 0};
}

ContactResult contact(const Heights& heights, const Solid& solid, double mean_pressure,
                      double tolerance, double hardness) {
  return across([&] {
    const Heightmap map = heightmap_of(heights);
    require(mean_pressure >= 0, "mean_pressure", "must not be negative");
    require(mean_pressure <= kMostStrain * std::max(solid.layer_modulus, solid.bulk_modulus),
            "mean_pressure", "is more than 100 times the modulus");
    require(solid.layer_modulus > 0 && solid.bulk_modulus > 0, "modulus", "must be positive");
    require(hardness >= 0, "hardness", "must not be negative");
    require(tolerance > 0 && tolerance <= 0.1, "tolerance", "is above 0, at most 0.1");
    const auto kernel = make_contact_kernel(
        map.grid, {solid.layer_modulus, solid.layer_poisson, solid.layer_thickness,
                   solid.bulk_modulus, solid.bulk_poisson});
    ContactSolution s = solve_contact(*kernel, map.z, mean_pressure, {},
                                      {.tolerance = tolerance, .hardness = hardness});
    if (s.status == ContactStatus::Invalid) throw rooms::InputError(s.reason);
    const ContactArea area = measure_area(*kernel, s, hardness);
    ContactResult r;
    r.converged = s.converged();
    r.reason = s.reason;
    r.area_fraction = area.near_edge;
    r.area_fraction_error = area.se;
    r.mean_pressure = std::accumulate(s.pressure.begin(), s.pressure.end(), 0.0) /
                      static_cast<double>(s.pressure.size());
    r.approach = s.shift + *std::max_element(map.z.begin(), map.z.end());
    r.elastic_energy = s.elastic_energy;
    r.certificate = s.certificate;
    r.pressure = std::move(s.pressure);
    r.gap = std::move(s.gap);
    return r;
  });
}

BridgeResult bridge(double volume, double gap, double theta1, double theta2,
                    double surface_tension) {
  return across([&] {
    const Bridge b = solve_bridge(volume, gap, theta1, theta2, surface_tension);
    if (b.status == BridgeStatus::Invalid)
      throw rooms::InputError(
          "volume, gap and surface tension must be positive, the contact angles 0 to 180 deg");
    const BridgeLimits limits = bridge_limits(theta1, theta2);
    const bool known = limits.status == BridgeStatus::Converged;
    return BridgeResult{b.status == BridgeStatus::Converged,
                        std::string(text(b.status)),
                        b.energy,
                        b.force,
                        b.pressure,
                        b.radius1,
                        b.radius2,
                        known ? limits.rupture * std::cbrt(volume) : 0};
  });
}

DropletsResult droplets(const Heights& gap, double volume, const Water& water,
                        const DropletOptions& options) {
  return across([&] {
    check(water);
    require(volume >= 0, "volume", "must not be negative");
    require(options.drops_per_volume > 0 && options.drops_per_volume * volume <= 1e6,
            "drops_per_volume", "must be positive and give at most a million droplets");
    require(options.first_step > 0, "first_step", "must be positive");
    DropletCase c;
    c.gap = gap_of(gap);
    c.water = {water.surface_tension, water.theta_skin, water.theta_substrate, water.hysteresis};
    c.volume = volume;
    c.how.drops_per_volume = options.drops_per_volume;
    c.how.first_step = options.first_step;
    const DropletResult r =
        solve_droplets(c, options.threshold ? WaterModel::Threshold : WaterModel::Droplets,
                       options.seed, options.index);
    DropletsResult out;
    out.converged = r.report.converged;
    out.state = state_of(r.wetting.status);
    for (const Droplet& d : r.wetting.droplets) out.droplets.push_back(state_of(d));
    out.bridged = r.wetting.bridged;
    out.bridged.resize(c.gap.grid.size());  // dry: none
    out.capillary_force = r.wetting.capillary_force;
    out.retention = r.wetting.retention;
    out.wetted_fraction = r.wetting.wetted_fraction;
    out.bridges = r.wetting.bridges;
    out.bridge_volume = r.wetting.bridge_volume;
    out.initial_energy = r.report.initial_energy;
    out.final_energy = r.report.final_energy;
    return out;
  });
}

FieldResult field(const Heights& gap, double voltage, const FieldOptions& options,
                  const Heights* surface) {
  return across([&] {
    const FieldProblem problem = problem_of(voltage, options);
    const Gap given = gap_of(gap);
    std::optional<CoveredSurface> covered;
    if (surface) {
      const Heightmap map = heightmap_of(*surface);
      require(map.grid == given.grid, "surface", "must have the pixels and the size of the gap");
      covered.emplace(map, std::vector<FilmLayer>{{FilmProcess::Conformal, 0, options.thickness,
                                                   options.permittivity}});
    }
    FieldSolution s = solve(options.method, given, covered ? &*covered : nullptr, problem);
    FieldResult out;
    out.converged = s.ok;
    out.reason = s.reason;
    out.pressure = std::move(s.traction.value);
    out.mean_pressure = s.mean_pressure;
    out.force = s.mean_pressure * given.grid.area();
    out.peak_air_field = s.peak_air_field;
    out.peak_oxide_field = s.peak_oxide_field;
    out.residual = s.residual;
    return out;
  });
}

Look look(const Heights& heights, const LookOptions& options) {
  return across([&] {
    require(options.index >= 1 && options.index <= 5, "index", "is 1 to 5");
    require(options.fill_index >= 1 && options.fill_index <= options.index, "fill_index",
            "is 1 to the index of the glass");
    require(!options.angles.empty() &&
                std::all_of(options.angles.begin(), options.angles.end(),
                            [](double a) { return a >= 0 && a <= 70 * kPi / 180; }),
            "angles", "are 0 to 70 deg, one at least");
    Light light;
    light.angles = options.angles;
    return look_of(phase_screen(heightmap_of(heights), {options.index, options.fill_index}, light));
  });
}

}  // namespace papilla::api
