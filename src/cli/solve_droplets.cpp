// papilla solve droplets: sweat in a given gap; states, forces and a picture.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/constants.h"
#include "base/error.h"
#include "base/units.h"
#include "cli/commands.h"
#include "geometry/io/files.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/threshold.h"

namespace papilla {
namespace {

struct DropletsOptions {
  std::string gap_file, size, volume = "1 um3", theta_skin = "80 deg", theta_substrate = "50 deg";
  std::string surface_tension = "72.126 mN/m", step = "200 nm", model = "droplets", picture;
  double drops_per_um3 = 100, hysteresis = 0.26;
  std::uint64_t seed = 1, index = 0;
  bool json = false;
};

const char* name(DropletState state) {
  switch (state) {
    case DropletState::OnSkin:
      return "skin";
    case DropletState::OnSubstrate:
      return "substrate";
    case DropletState::Bridge:
      return "bridge";
  }
  return "";
}

const char* name(WettingStatus status) {
  switch (status) {
    case WettingStatus::Dry:
      return "dry";
    case WettingStatus::Discs:
      return "discs";
    case WettingStatus::Flooded:
      return "flooded";
    case WettingStatus::Film:
      return "film";
  }
  return "";
}

// The gap in colours, bridges and film white-rimmed, droplets that do not bridge red-rimmed.
void draw(const std::string& path, const Gap& gap, const Wetting& wetting) {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb = render_field(gap.grid, gap.value, width, height);
  const double sx = width / gap.grid.lx, sy = height / gap.grid.ly;
  const auto put = [&](double x, double y, std::uint8_t r, std::uint8_t g, std::uint8_t b) {
    const int ix = wrap(static_cast<int>(std::floor(x * sx)), width);
    const int iy = height - 1 - wrap(static_cast<int>(std::floor(y * sy)), height);
    std::uint8_t* p = &rgb[3 * (static_cast<std::size_t>(iy) * width + ix)];
    p[0] = r;
    p[1] = g;
    p[2] = b;
  };
  for (const Droplet& d : wetting.droplets) {
    const bool bridge = d.state == DropletState::Bridge;
    const int points = std::max(16, static_cast<int>(8 * d.radius * std::max(sx, sy)));
    for (int k = 0; k < points; ++k) {
      const double a = 2 * kPi * k / points;
      put(d.x + d.radius * std::cos(a), d.y + d.radius * std::sin(a), 255, bridge ? 255 : 60,
          bridge ? 255 : 60);
    }
  }
  if (wetting.status == WettingStatus::Film) {
    const Grid& g = gap.grid;
    for (int iy = 0; iy < g.ny; ++iy) {
      for (int ix = 0; ix < g.nx; ++ix) {
        const auto wet = [&](int x, int y) {
          return wetting.bridged[g.index(wrap(x, g.nx), wrap(y, g.ny))] != 0;
        };
        const bool rim = wet(ix, iy) && !(wet(ix + 1, iy) && wet(ix - 1, iy) && wet(ix, iy + 1) &&
                                          wet(ix, iy - 1));
        if (rim) put(g.x(ix), g.y(iy), 255, 255, 255);
      }
    }
  }
  write_png_rgb(path, width, height, rgb);
}

int solve(const DropletsOptions& options) {
  const double lateral = options.size.empty() ? 0 : parse_si(options.size, "um");
  const Heightmap map = read_heightmap(options.gap_file, lateral);
  const Gap gap{map.grid, map.z};
  if (*std::min_element(gap.value.begin(), gap.value.end()) < 0) {
    throw InputError(options.gap_file + ": a gap must not be negative (0 in contact)");
  }
  const double volume = parse_si(options.volume, "um3");
  const double drops = options.drops_per_um3 * 1e18;
  WaterProperties water;
  water.theta_skin = parse_si(options.theta_skin, "deg");
  water.theta_substrate = parse_si(options.theta_substrate, "deg");
  water.surface_tension = parse_si(options.surface_tension, "mN/m");
  water.hysteresis = options.hysteresis;
  DropletOptions how;
  how.drops_per_volume = drops;
  how.first_step = parse_si(options.step, "nm");
  if (!(volume >= 0)) throw InputError("--volume must not be negative");
  if (!(drops > 0 && drops * volume <= 1e6)) {
    throw InputError("--drops-per-um3 must be positive and give at most a million droplets");
  }
  if (!(how.first_step > 0)) throw InputError("--step must be positive");
  if (!(water.surface_tension > 0)) throw InputError("--surface-tension must be positive");
  for (double theta : {water.theta_skin, water.theta_substrate}) {
    if (!(theta >= 0 && theta <= kPi)) throw InputError("contact angles are 0 to 180 deg");
  }

  const auto start = std::chrono::steady_clock::now();
  SettleReport report;
  const Wetting w =
      options.model == "threshold"
          ? fill_threshold(gap, volume, water)
          : settle_droplets(gap, volume, water, how, options.seed, options.index, &report);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.picture.empty()) draw(options.picture, gap, w);

  if (options.json) {
    nlohmann::ordered_json out;
    out["schema"] = 1;
    out["model"] = options.model;
    out["status"] = name(w.status);
    out["converged"] = report.converged;
    out["volume"] = w.volume;
    out["bridge_volume"] = w.bridge_volume;
    out["bridges"] = w.bridges;
    out["wetted_fraction"] = w.wetted_fraction;
    out["capillary_force"] = w.capillary_force;
    out["capillary_pressure"] = w.capillary_force / gap.grid.area();
    out["retention"] = w.retention;
    out["initial_droplets"] = report.initial_droplets;
    out["initial_energy"] = report.initial_energy;
    out["final_energy"] = report.final_energy;
    out["moves"] = report.moves;
    out["merges"] = report.merges;
    out["seconds"] = seconds;
    auto& list = out["droplets"] = nlohmann::ordered_json::array();
    for (const Droplet& d : w.droplets) {
      list.push_back({{"x", d.x},
                      {"y", d.y},
                      {"volume", d.volume},
                      {"state", name(d.state)},
                      {"radius", d.radius},
                      {"height", d.height},
                      {"edge_gap", d.edge_gap},
                      {"force", d.force},
                      {"energy", d.energy}});
    }
    std::cout << out.dump(2) << '\n';
  } else {
    std::cout << fmt::format(
        "state            {}\nwater            {:.6g} um3, {:.4g} % of it in {} bridges\n"
        "wetted           {:.4g} % of the patch\ncapillary force  {:.6g} uN ({:.6g} kPa)\n"
        "retention        {:.6g} uN\ndroplets         {} of {} left, {} moves, {} mergers{}\n",
        name(w.status), w.volume * 1e18, w.volume > 0 ? 100 * w.bridge_volume / w.volume : 0.0,
        w.bridges, 100 * w.wetted_fraction, w.capillary_force * 1e6,
        w.capillary_force / gap.grid.area() * 1e-3, w.retention * 1e6, w.droplets.size(),
        report.initial_droplets, report.moves, report.merges,
        report.converged ? "" : "; stopped before every droplet was at rest");
  }
  return report.converged ? kSuccess : kWorkFailed;
}

}  // namespace

void add_solve_droplets(CLI::App& solve_command, Context& context) {
  CLI::App* command = solve_command.add_subcommand("droplets", "Droplets of sweat in a given gap");
  auto options = std::make_shared<DropletsOptions>();
  command->add_option("--gap", options->gap_file, "Heightmap of the gap: .npy, .gsf, .exr, .tif")
      ->required();
  command->add_option("--size", options->size, "Lateral size in x where the file does not say");
  command->add_option("--volume", options->volume, "Water in the patch")->capture_default_str();
  command->add_option("--theta-skin", options->theta_skin)->capture_default_str();
  command->add_option("--theta-substrate", options->theta_substrate)->capture_default_str();
  command->add_option("--surface-tension", options->surface_tension)->capture_default_str();
  command->add_option("--hysteresis", options->hysteresis, "cos(receding) - cos(advancing)")
      ->capture_default_str();
  command->add_option("--drops-per-um3", options->drops_per_um3)->capture_default_str();
  command->add_option("--step", options->step, "First step of a droplet: its mobility")
      ->capture_default_str();
  command->add_option("--seed", options->seed)->capture_default_str();
  command->add_option("--index", options->index, "Member of the ensemble")->capture_default_str();
  command->add_option("--model", options->model, "droplets or threshold")
      ->check(CLI::IsMember({"droplets", "threshold"}))
      ->capture_default_str();
  command->add_option("--out-picture", options->picture, "PNG of the gap and the droplets");
  command->add_flag("--json", options->json, "One JSON object, SI units");
  command->callback(
      [&context, options] { context.action = [options] { return solve(*options); }; });
}

}  // namespace papilla
