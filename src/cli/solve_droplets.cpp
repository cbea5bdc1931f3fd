// papilla solve droplets: sweat in a given gap; states, forces and a picture of
// the droplets before and after they move.
#include <chrono>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/error.h"
#include "base/units.h"
#include "cases/droplets.h"
#include "cli/commands.h"
#include "report/droplets.h"

namespace papilla::cli {
namespace {

struct DropletsOptions {
  std::string gap_file, design, humidity = "75 %", size, volume = "1 um3", theta_skin = "80 deg",
                                theta_substrate = "50 deg";
  std::string surface_tension = "72.126 mN/m", step = "200 nm", model = "droplets", picture;
  double drops_per_um3 = 100, hysteresis = 0.33;
  std::uint64_t seed = 1, index = 0;
  int skin = 0, seeds = 0;
  double spread = 1.0 / 3;
  bool pinning = false, wicking = false;
  bool json = false;
  std::vector<Option> of_gap, of_design;  // that only one of the two obeys
  std::vector<Option> of_placements;
};

DropletCase case_of(const DropletsOptions& options) {
  if (!options.design.empty()) {
    refuse(options.of_gap, "--gap; a design has its own");
    const double rh = parse_si(options.humidity, "%");
    if (!(rh >= 0 && rh <= 1)) throw InputError("--humidity is 0 to 100 %");
    return droplets_of_design(options.design, rh, options.skin, options.pinning, options.wicking);
  }
  refuse(options.of_design, "--design");
  DropletCase c =
      droplets_of_file(options.gap_file, options.size.empty() ? 0 : parse_si(options.size, "um"));
  c.volume = parse_si(options.volume, "um3");
  c.water.theta_skin = parse_si(options.theta_skin, "deg");
  c.water.theta_substrate = parse_si(options.theta_substrate, "deg");
  c.water.surface_tension = parse_si(options.surface_tension, "mN/m");
  c.water.hysteresis = options.hysteresis;
  c.how.drops_per_volume = options.drops_per_um3 * 1e18;
  c.how.first_step = parse_si(options.step, "nm");
  return c;
}

// Throws InputError.
void check(const DropletCase& c) {
  const double drops = c.how.drops_per_volume;
  if (!(c.volume >= 0)) throw InputError("--volume must not be negative");
  if (!(drops > 0 && drops * c.volume <= 1e6)) {
    throw InputError("--drops-per-um3 must be positive and give at most a million droplets");
  }
  if (!(c.how.first_step > 0)) throw InputError("--step must be positive");
  if (!(c.water.surface_tension > 0)) throw InputError("--surface-tension must be positive");
  for (double theta : {c.water.theta_skin, c.water.theta_substrate}) {
    if (!(theta >= 0 && theta <= kPi)) throw InputError("contact angles are 0 to 180 deg");
  }
}

int solve_ensemble(const DropletsOptions& options, const DropletCase& c) {
  if (options.model != "droplets") throw InputError("--placements is for droplets");
  if (!(options.spread > 0 && options.spread < 1))
    throw InputError("--spread is above 0 and below 1: two volumes are compared");
  const DropletEnsemble ensemble =
      solve_droplet_ensemble(c, options.spread, options.seeds, options.seed, options.index);
  std::cout << (options.json ? droplet_ensemble_json(ensemble) + '\n'
                             : droplet_ensemble_text(ensemble));
  return kSuccess;
}

int solve(const DropletsOptions& options) {
  if (options.seeds == 0) refuse(options.of_placements, "--placements");
  if (options.seeds > 0 && !options.picture.empty())
    throw InputError("--out draws one placement: leave it out, or --placements");
  const DropletCase c = case_of(options);
  check(c);
  if (options.seeds > 0) return solve_ensemble(options, c);
  const WaterModel model =
      options.model == "threshold" ? WaterModel::Threshold : WaterModel::Droplets;
  const auto start = std::chrono::steady_clock::now();
  const DropletResult result = solve_droplets(c, model, options.seed, options.index);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (!options.picture.empty()) {
    write_droplet_picture(options.picture, c.gap,
                          model == WaterModel::Threshold
                              ? result.wetting
                              : unmoved_droplets(c, options.seed, options.index),
                          result.wetting);
  }
  std::cout << (options.json ? droplets_json(c, model, result, seconds) + '\n'
                             : droplets_text(c, result));
  return result.report.converged ? kSuccess : kWorkFailed;
}

}  // namespace

void add_solve_droplets(Command solve_command, Context& context) {
  Command command = solve_command.add_command("droplets", "Droplets of sweat in a given gap");
  auto options = std::make_shared<DropletsOptions>();
  Command where = command.add_alternatives("gap");
  where.add_option("--gap", options->gap_file, "Heightmap of the gap: .npy, .gsf, .exr, .tif");
  where.add_option("--design", options->design,
                   "Design file: gap of its dry contact, water and angles of its finger");
  options->of_design = {
      command.add_option("--humidity", options->humidity, "Of the design").show_default(),
      command.add_option("--skin", options->skin, "Skin patch of the design, from 0")
          .range(0, 1000000)
          .show_default(),
      command.add_flag(
          "--pin-edges", options->pinning,
          "Design: lines do not pass the edges of holes, also where its model lets them"),
      command.add_flag("--wick-corners", options->wicking,
                       "Design: droplets at the foot of a wall creep along it"),
  };
  options->of_gap = {
      command.add_option("--size", options->size, "Lateral size in x where the file does not say"),
      command.add_option("--volume", options->volume, "Water in the patch").show_default(),
      command.add_option("--theta-skin", options->theta_skin, "Contact angle on the skin")
          .show_default(),
      command
          .add_option("--theta-substrate", options->theta_substrate, "Contact angle on the surface")
          .show_default(),
      command.add_option("--surface-tension", options->surface_tension, "Of the sweat")
          .show_default(),
      command
          .add_option("--hysteresis", options->hysteresis, "cos(receding) - cos(advancing), 0 to 2")
          .range(0.0, 2.0)
          .show_default(),
      command
          .add_option("--drops-per-um3", options->drops_per_um3, "Droplets that a volume starts as")
          .show_default(),
      command.add_option("--step", options->step, "First step of a droplet: its mobility")
          .show_default(),
  };
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
  command
      .add_option("--placements", options->seeds,
                  "Placements of a low and a high volume each, with standard errors")
      .range(2, 10000);
  options->of_placements = {
      command
          .add_option("--spread", options->spread, "Low and high volume, as a share of the volume")
          .show_default()};
  command.add_flag("--json", options->json, "One JSON object, SI units");
  command.on_chosen(
      [&context, options] { context.action = [options] { return solve(*options); }; });
}

}  // namespace papilla::cli
