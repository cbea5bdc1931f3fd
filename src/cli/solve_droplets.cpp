// papilla solve droplets: sweat in a given gap; states, forces and a picture of
// the droplets before and after they move.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/constants.h"
#include "base/error.h"
#include "base/statistics.h"
#include "base/units.h"
#include "cli/commands.h"
#include "design/design.h"
#include "forward/forward.h"
#include "geometry/io/files.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/threshold.h"

namespace papilla {
namespace {

struct DropletsOptions {
  std::string gap_file, design, humidity = "75 %", size, volume = "1 um3", theta_skin = "80 deg",
                                theta_substrate = "50 deg";
  std::string surface_tension = "72.126 mN/m", step = "200 nm", model = "droplets", picture;
  double drops_per_um3 = 100, hysteresis = 0.26;
  std::uint64_t seed = 1, index = 0;
  int skin = 0, seeds = 0;
  double spread = 1.0 / 3;
  bool pinning = false, wicking = false;
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

// One panel: the gap in grey (bright: wide) with its scale bar, droplets by state.
struct Panel {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;
};

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kBridge{30, 110, 255}, kFilm{0, 190, 200}, kSubstrate{255, 150, 0},
    kOnSkin{220, 40, 160};

Panel draw_panel(const Gap& gap, const Wetting& wetting) {
  Panel out;
  out.rgb = render_field(gap.grid, gap.value, out.width, out.height);
  std::vector<bool> bar(static_cast<std::size_t>(out.width) * out.height);
  for (std::size_t k = 0; k < bar.size(); ++k) {
    std::uint8_t* p = &out.rgb[3 * k];
    // The colour scale has neither white nor black: those are the bar.
    bar[k] = p[0] == p[1] && p[1] == p[2] && (p[0] == 0 || p[0] == 255);
    if (bar[k]) continue;
    const auto grey = static_cast<std::uint8_t>((2 * p[0] + 5 * p[1] + p[2]) / 8);
    p[0] = p[1] = p[2] = grey;
  }
  const double sx = out.width / gap.grid.lx, sy = out.height / gap.grid.ly;
  const auto blend = [&](int ix, int iy, const Colour& c, double share) {
    const std::size_t k =
        static_cast<std::size_t>(out.height - 1 - wrap(iy, out.height)) * out.width +
        wrap(ix, out.width);
    if (bar[k]) return;
    for (int i = 0; i < 3; ++i) {
      std::uint8_t& v = out.rgb[3 * k + i];
      v = static_cast<std::uint8_t>(std::lround((1 - share) * v + share * c[i]));
    }
  };
  if (wetting.status == WettingStatus::Film || wetting.status == WettingStatus::Flooded) {
    const Grid& g = gap.grid;
    for (int iy = 0; iy < out.height; ++iy) {
      for (int ix = 0; ix < out.width; ++ix) {
        const int px = std::min(ix * g.nx / out.width, g.nx - 1);
        const int py = std::min(iy * g.ny / out.height, g.ny - 1);
        const std::size_t k = g.index(px, py);
        if (wetting.film.empty() ? wetting.bridged[k] : wetting.film[k] != FilmPixel::None)
          blend(ix, iy, kFilm, 0.6);
      }
    }
  }
  for (const Droplet& d : wetting.droplets) {
    if (d.film > 0) continue;
    const Colour& c = d.state == DropletState::Bridge        ? kBridge
                      : d.state == DropletState::OnSubstrate ? kSubstrate
                                                             : kOnSkin;
    const double rx = d.radius * sx, ry = d.radius * sy;
    const double rim = std::max(0.0, 1 - 1.5 / std::max(1.5, std::min(rx, ry)));
    const int x0 = static_cast<int>(std::floor(d.x * sx)),
              y0 = static_cast<int>(std::floor(d.y * sy));
    const int nx = static_cast<int>(std::ceil(rx)), ny = static_cast<int>(std::ceil(ry));
    for (int iy = -ny; iy <= ny; ++iy) {
      for (int ix = -nx; ix <= nx; ++ix) {
        const double q = std::hypot(ix / std::max(rx, 1.0), iy / std::max(ry, 1.0));
        if (q <= 1) blend(x0 + ix, y0 + iy, c, q >= rim ? 1 : 0.45);
      }
    }
  }
  return out;
}

// Initial and final droplets side by side.
void draw(const std::string& path, const Gap& gap, const Wetting& initial, const Wetting& final) {
  const Panel left = draw_panel(gap, initial), right = draw_panel(gap, final);
  constexpr int kBetween = 8;
  const int width = 2 * left.width + kBetween;
  std::vector<std::uint8_t> rgb(static_cast<std::size_t>(3) * width * left.height, 255);
  const auto copy = [&](const Panel& panel, int from) {
    for (int y = 0; y < panel.height; ++y) {
      std::copy_n(panel.rgb.begin() + static_cast<std::ptrdiff_t>(3) * y * panel.width,
                  3 * panel.width,
                  rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * width + from));
    }
  };
  copy(left, 0);
  copy(right, left.width + kBetween);
  write_png_rgb(path, width, left.height, rgb);
}

// The gap of a design: its dry contact, at its patch pressure. What its scene says of the water
// takes the place of the options.
Gap gap_of_design(const DropletsOptions& options, WaterProperties& water, double& volume,
                  DropletOptions& how) {
  const Design design = read_design(options.design);
  Scene scene = scene_of(design);
  const Finger finger = scene.finger.applied();
  const double rh = parse_si(options.humidity, "%");
  if (!(rh >= 0 && rh <= 1)) throw InputError("--humidity is 0 to 100 %");
  Fidelity fidelity = fidelity_of(design);
  fidelity.estimator = Estimator::Load;
  std::fill(scene.finger.water.volume.begin(), scene.finger.water.volume.end(), 0.0);
  scene.drive.amplitude = 0;
  const PatchPicture picture = picture_patch(scene, design.texture, fidelity, rh, options.skin);
  if (picture.fields.off.gap.empty()) {
    throw InputError(options.design + ": no contact: " + picture.fields.off.reason);
  }
  const Grid& grid = picture.texture.grid;
  volume = finger.water.volume_per_area(rh) * grid.area();
  water = {finger.water.surface_tension, finger.water.contact_angle, scene.surface.contact_angle,
           finger.water.hysteresis};
  how.drops_per_volume = finger.water.drops_per_um3 * 1e18;
  how.first_step = scene.model.droplet_step;
  how.rims = std::make_shared<RimMap>(picture.texture);
  how.rim_pinning = options.pinning;
  how.corner_wicking = options.wicking;
  return {grid, picture.fields.off.gap};
}

Gap gap_of_file(const DropletsOptions& options, WaterProperties& water, double& volume,
                DropletOptions& how) {
  const double lateral = options.size.empty() ? 0 : parse_si(options.size, "um");
  const Heightmap map = read_heightmap(options.gap_file, lateral);
  if (*std::min_element(map.z.begin(), map.z.end()) < 0) {
    throw InputError(options.gap_file + ": a gap must not be negative (0 in contact)");
  }
  volume = parse_si(options.volume, "um3");
  water.theta_skin = parse_si(options.theta_skin, "deg");
  water.theta_substrate = parse_si(options.theta_substrate, "deg");
  water.surface_tension = parse_si(options.surface_tension, "mN/m");
  water.hysteresis = options.hysteresis;
  how.drops_per_volume = options.drops_per_um3 * 1e18;
  how.first_step = parse_si(options.step, "nm");
  return {map.grid, map.z};
}

// The papers' way: a low and a high volume by several placements each; means with standard errors.
int solve_ensemble(const DropletsOptions& options, const Gap& gap, double volume,
                   const WaterProperties& water, const DropletOptions& how) {
  nlohmann::ordered_json out;
  out["schema"] = 1;
  out["volumes"] = nlohmann::ordered_json::array();
  std::vector<double> all;
  for (double factor : {1 - options.spread, 1 + options.spread}) {
    std::vector<double> force, bridges, wetted;
    for (int s = 0; s < options.seeds; ++s) {
      const Wetting w = settle_droplets(gap, factor * volume, water, how, options.seed,
                                        options.index + static_cast<std::uint64_t>(s));
      force.push_back(w.capillary_force);
      bridges.push_back(w.bridges);
      wetted.push_back(w.wetted_fraction);
    }
    all.insert(all.end(), force.begin(), force.end());
    const Estimate f = mean_estimate(force), b = mean_estimate(bridges), a = mean_estimate(wetted);
    if (!options.json) {
      std::cout << fmt::format(
          "{:.4g} um3, {} placements: capillary force {:.4g} ± {:.2g} uN, {:.3g} ± {:.2g} bridges, "
          "wetted {:.3g} ± {:.2g} %\n",
          1e18 * factor * volume, options.seeds, 1e6 * f.value, 1e6 * f.se, b.value, b.se,
          100 * a.value, 100 * a.se);
    }
    const auto pair = [](const Estimate& e) {
      return nlohmann::ordered_json{{"value", e.value}, {"se", e.se}};
    };
    out["volumes"].push_back({{"volume", factor * volume},
                              {"capillary_force", pair(f)},
                              {"bridges", pair(b)},
                              {"wetted_fraction", pair(a)}});
  }
  const double mean = mean_estimate(all).value;
  out["mean_capillary_force"] = mean;
  if (options.json) {
    std::cout << out.dump(2) << '\n';
  } else {
    std::cout << fmt::format("mean             {:.4g} uN\n", 1e6 * mean);
  }
  return kSuccess;
}

int solve(const DropletsOptions& options) {
  WaterProperties water;
  DropletOptions how;
  double volume = 0;
  const Gap gap = options.design.empty() ? gap_of_file(options, water, volume, how)
                                         : gap_of_design(options, water, volume, how);
  const double drops = how.drops_per_volume;
  if (!(volume >= 0)) throw InputError("--volume must not be negative");
  if (!(drops > 0 && drops * volume <= 1e6)) {
    throw InputError("--drops-per-um3 must be positive and give at most a million droplets");
  }
  if (!(how.first_step > 0)) throw InputError("--step must be positive");
  if (!(water.surface_tension > 0)) throw InputError("--surface-tension must be positive");
  for (double theta : {water.theta_skin, water.theta_substrate}) {
    if (!(theta >= 0 && theta <= kPi)) throw InputError("contact angles are 0 to 180 deg");
  }

  if (options.seeds > 0) {
    if (options.model != "droplets") throw InputError("--placements is for droplets");
    if (!(options.spread > 0 && options.spread < 1))
      throw InputError("--spread is above 0 and below 1: two volumes are compared");
    return solve_ensemble(options, gap, volume, water, how);
  }
  const auto start = std::chrono::steady_clock::now();
  SettleReport report;
  const Wetting w =
      options.model == "threshold"
          ? fill_threshold(gap, volume, water)
          : settle_droplets(gap, volume, water, how, options.seed, options.index, &report);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.picture.empty()) {
    DropletOptions unmoved = how;
    unmoved.max_moves = 0;
    draw(options.picture, gap,
         options.model == "threshold"
             ? w
             : settle_droplets(gap, volume, water, unmoved, options.seed, options.index),
         w);
  }

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
                      {"film", d.film},
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

void add_solve_droplets(Command solve_command, Context& context) {
  Command command = solve_command.add_command("droplets", "Droplets of sweat in a given gap");
  auto options = std::make_shared<DropletsOptions>();
  Command where = command.add_alternatives("gap");
  where.add_option("--gap", options->gap_file, "Heightmap of the gap: .npy, .gsf, .exr, .tif");
  where.add_option("--design", options->design,
                   "Design file: gap of its dry contact, water and angles of its finger");
  command.add_option("--humidity", options->humidity, "Of the design").show_default();
  command.add_option("--skin", options->skin, "Skin patch of the design, from 0")
      .range(0, 1000000)
      .show_default();
  command.add_option("--size", options->size, "Lateral size in x where the file does not say");
  command.add_option("--volume", options->volume, "Water in the patch").show_default();
  command.add_option("--theta-skin", options->theta_skin, "Contact angle on the skin")
      .show_default();
  command.add_option("--theta-substrate", options->theta_substrate, "Contact angle on the surface")
      .show_default();
  command.add_option("--surface-tension", options->surface_tension, "Of the sweat").show_default();
  command.add_option("--hysteresis", options->hysteresis, "cos(receding) - cos(advancing), 0 to 2")
      .range(0.0, 2.0)
      .show_default();
  command.add_option("--drops-per-um3", options->drops_per_um3, "Droplets that a volume starts as")
      .show_default();
  command.add_option("--step", options->step, "First step of a droplet: its mobility")
      .show_default();
  command.add_option("--seed", options->seed, "Seed of the placement")
      .range(0L, 1L << 53)
      .show_default();
  command.add_option("--index", options->index, "Member of the ensemble")
      .range(0L, 1L << 53)
      .show_default();
  command.add_option("--model", options->model, "droplets or threshold")
      .one_of({"droplets", "threshold"})
      .show_default();
  command.add_option(
      "--out", options->picture,
      "PNG of the initial (left) and final droplets: bridges blue, film cyan, on the "
      "surface orange, on the skin magenta; gap in grey");
  command.add_flag("--pin-edges", options->pinning, "Design: lines do not pass the edges of holes");
  command.add_flag("--wick-corners", options->wicking,
                   "Design: droplets at the foot of a wall creep along it");
  command
      .add_option("--placements", options->seeds,
                  "Placements of a low and a high volume each, with standard errors")
      .range(2, 10000);
  command.add_option("--spread", options->spread, "Low and high volume, as a share of the volume")
      .show_default();
  command.add_flag("--json", options->json, "One JSON object, SI units");
  command.on_chosen(
      [&context, options] { context.action = [options] { return solve(*options); }; });
}

}  // namespace papilla
