#include "papilla/physics.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "api/inside.h"
#include "physics/capillary/bridge.h"
#include "physics/contact/contact.h"

namespace papilla::api {

Solid Solid::half_space(double contact_modulus) {
  return {contact_modulus, 0, 0, contact_modulus, 0};
}

ContactResult contact(const Heights& heights, const Solid& solid, double mean_pressure,
                      double tolerance, double hardness) {
  return across([&] {
    const Heightmap map = heightmap_of(heights);
    const auto kernel = make_contact_kernel(
        map.grid, {solid.layer_modulus, solid.layer_poisson, solid.layer_thickness,
                   solid.bulk_modulus, solid.bulk_poisson});
    ContactSolution s = solve_contact(*kernel, map.z, mean_pressure, {},
                                      {.tolerance = tolerance, .hardness = hardness});
    if (s.status == ContactStatus::Invalid) throw papilla::InputError(s.reason);
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
      throw papilla::InputError(
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

}  // namespace papilla::api
