// papilla solve bridge: the exact liquid bridge between two plates.
#include <fmt/format.h>

#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/units.h"
#include "cli/commands.h"
#include "physics/capillary/bridge.h"

namespace papilla {
namespace {

struct BridgeOptions {
  std::string volume = "0.01 um3", gap = "100 nm", theta1 = "80 deg", theta2 = "50 deg";
  std::string surface_tension = "72.126 mN/m";
  bool json = false;
};

int solve(const BridgeOptions& options) {
  const double volume = parse_si(options.volume, "um3"), gap = parse_si(options.gap, "nm");
  const double theta1 = parse_si(options.theta1, "deg"), theta2 = parse_si(options.theta2, "deg");
  const double tension = parse_si(options.surface_tension, "mN/m");
  const Bridge bridge = solve_bridge(volume, gap, theta1, theta2, tension);
  if (bridge.status == BridgeStatus::Invalid) {
    throw InputError(
        "volume, gap and surface tension must be positive, the contact angles 0 to 180 deg");
  }
  const BridgeLimits limits = bridge_limits(theta1, theta2);
  const double size = std::cbrt(volume);
  const bool exists = bridge.status == BridgeStatus::Converged;
  const bool known = limits.status == BridgeStatus::Converged;
  if (options.json) {
    const auto number = [](bool there, double value) {
      return there ? nlohmann::json(value) : nlohmann::json(nullptr);
    };
    nlohmann::ordered_json out;
    out["schema"] = 1;
    out["exists"] = exists;
    out["reason"] = text(bridge.status);
    out["energy"] = number(exists, bridge.energy);
    out["force"] = number(exists, bridge.force);
    out["laplace_pressure"] = number(exists, bridge.pressure);
    out["radius1"] = number(exists, bridge.radius1);
    out["radius2"] = number(exists, bridge.radius2);
    out["rupture_gap"] = number(known, limits.rupture * size);
    out["equilibrium_gap"] = number(known && limits.switching > 0, limits.switching * size);
    out["snap_in_gap"] = number(known, limits.snap_in * size);
    out["zero_force_gap"] = number(known && limits.zero_force > 0, limits.zero_force * size);
    std::cout << out.dump(2) << '\n';
  } else {
    if (exists) {
      std::cout << fmt::format(
          "energy            {:.6g} fJ\nforce             {:.6g} nN ({})\n"
          "Laplace pressure  {:.6g} kPa\nradii             {:.6g} and {:.6g} nm\n",
          bridge.energy * 1e15, bridge.force * 1e9, bridge.force >= 0 ? "attracts" : "repels",
          bridge.pressure * 1e-3, bridge.radius1 * 1e9, bridge.radius2 * 1e9);
    } else {
      std::cout << "no bridge: " << text(bridge.status) << '\n';
    }
    if (known) {
      std::cout << fmt::format("ruptures at       {:.6g} nm\n", limits.rupture * size * 1e9);
      if (limits.switching > 0) {
        std::cout << fmt::format("a droplet above   {:.6g} nm (lower energy)\n",
                                 limits.switching * size * 1e9);
      }
    }
  }
  return bridge.status == BridgeStatus::NotConverged ? kWorkFailed : kSuccess;
}

}  // namespace

void add_solve_bridge(Command solve_command, Context& context) {
  Command command = solve_command.add_command("bridge", "Exact liquid bridge between two plates");
  auto options = std::make_shared<BridgeOptions>();
  command.add_option("--volume", options->volume, "Of the liquid").show_default();
  command.add_option("--gap", options->gap, "Distance of the plates").show_default();
  command.add_option("--theta1", options->theta1, "Contact angle on the first plate")
      .show_default();
  command.add_option("--theta2", options->theta2, "Contact angle on the second plate")
      .show_default();
  command.add_option("--surface-tension", options->surface_tension, "Of the liquid").show_default();
  command.add_flag("--json", options->json, "One JSON object, SI units");
  command.on_chosen(
      [&context, options] { context.action = [options] { return solve(*options); }; });
}

}  // namespace papilla
