// papilla solve bridge: the exact liquid bridge between two plates.
#include <cmath>
#include <iostream>
#include <memory>

#include "base/error.h"
#include "base/units.h"
#include "cli/commands.h"
#include "physics/capillary/bridge.h"
#include "report/pieces.h"

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
  std::cout << (options.json ? bridge_json(bridge, limits, size) + '\n'
                             : bridge_text(bridge, limits, size));
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
