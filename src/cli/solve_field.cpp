// papilla solve field: the electrostatic pull over a gap heightmap.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/memory.h"
#include "base/units.h"
#include "cli/commands.h"
#include "geometry/io/files.h"
#include "physics/electrostatics/full_field.h"
#include "report/pieces.h"

namespace papilla::cli {
namespace {

struct FieldCommand {
  std::string gap, texture, size, voltage, thickness = "500 nm", skin_layer = "0 nm";
  std::string strength = "1 GV/m", edge_radius = "0 nm", method = "spread", out_pressure;
  std::string process = "conformal";
  double step_coverage = 0;
  double permittivity = 3.9;
  bool dc = false, json = false;
  std::vector<Option> of_texture, of_directional;
};

double not_negative(const std::string& text, const char* unit, const char* option) {
  const double value = parse_si(text, unit);
  if (value < 0) throw InputError(fmt::format("{} must not be negative, got \"{}\"", option, text));
  return value;
}

Heightmap read_map(const std::string& file, const std::string& size) {
  const double width = size.empty() ? 0 : not_negative(size, "um", "--size");
  return read_heightmap(file, width);
}

FilmProcess film_process(const FieldCommand& c) {
  if (c.process == "planar") return FilmProcess::Planar;
  return c.process == "directional" ? FilmProcess::Directional : FilmProcess::Conformal;
}

int solve(const FieldCommand& c) {
  if (c.texture.empty()) refuse(c.of_texture, "--texture; the surface is flat");
  if (c.process != "directional") refuse(c.of_directional, "--process directional");
  const Heightmap gap = read_map(c.gap, c.size);
  if (*std::min_element(gap.z.begin(), gap.z.end()) < 0)
    throw InputError(c.gap + ": a gap must not be negative anywhere");
  std::optional<Heightmap> texture;
  if (!c.texture.empty()) {
    texture = read_map(c.texture, c.size);
    if (texture->grid.nx != gap.grid.nx || texture->grid.ny != gap.grid.ny)
      throw InputError("--texture and --gap differ in pixels");
    // Its highest place is where a planar film is as thick as said, as of textures. Eq. geometry.9
    const double top = *std::max_element(texture->z.begin(), texture->z.end());
    for (double& z : texture->z) z -= top;
  }
  FieldProblem p;
  p.v_peak = not_negative(c.voltage, "V", "--voltage");
  p.v_rms = c.dc ? p.v_peak : p.v_peak / std::sqrt(2.0);
  p.dielectric_thickness = not_negative(c.thickness, "um", "--thickness");
  p.dielectric = p.dielectric_thickness / c.permittivity;
  const double strength = not_negative(c.strength, "MV/m", "--strength");
  p.edge_radius = not_negative(c.edge_radius, "nm", "--edge-radius");
  p.skin_layer = not_negative(c.skin_layer, "nm", "--skin-layer");
  const Gap given{gap.grid, gap.z};
  Wetting dry;
  dry.grid = gap.grid;
  if (c.method == "full")
    require_memory(2000.0 * static_cast<double>(gap.grid.size()), "a field over " + c.gap);

  const auto begin = std::chrono::steady_clock::now();
  std::optional<CoveredSurface> covered;
  if (texture)
    covered.emplace(*texture, std::vector<FilmLayer>{{film_process(c), c.step_coverage,
                                                      p.dielectric_thickness, c.permittivity}});
  const CoveredSurface* surface = covered ? &*covered : nullptr;
  const FieldSolution s = c.method == "local"    ? solve_local_field(given, surface, dry, p)
                          : c.method == "spread" ? solve_spread_field(given, surface, dry, p)
                                                 : solve_full_field(given, surface, dry, p);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!c.out_pressure.empty() && s.ok) write_npy(c.out_pressure, {gap.grid, s.traction.value});
  const FieldRun run{c.method, gap.grid.area(), strength, seconds};
  std::cout << (c.json ? field_json(s, run) + '\n' : field_text(s, run));
  return s.ok ? kSuccess : kWorkFailed;
}

}  // namespace

void add_solve_field(Command solve_command, Context& context) {
  Command command = solve_command.add_command(
      "field", "Electrostatic pull over a gap: by columns, with spreading flux, or 3-D");
  auto c = std::make_shared<FieldCommand>();
  command.add_option("--gap", c->gap, "Gap heightmap (.npy .gsf .exr .tif .x3p)").required();
  command.add_option("--texture", c->texture,
                     "Surface below the gap, whose oxide follows its walls; default: flat");
  command.add_option("--size", c->size, "Lateral size in x, where the file does not say");
  command.add_option("--voltage", c->voltage, "Peak of a sine: \"200 V\"").required();
  command.add_flag("--dc", c->dc, "The voltage is constant");
  command.add_option("--thickness", c->thickness, "Of the dielectric").show_default();
  command.add_option("--permittivity", c->permittivity, "Of the dielectric, relative")
      .range(1.0, 1e5)
      .show_default();
  command.add_option("--strength", c->strength, "Its breakdown field").show_default();
  c->of_texture = {
      command
          .add_option(
              "--process", c->process,
              "Of the dielectric on --texture: conformal, directional, planar (surface.process)")
          .one_of({"conformal", "directional", "planar"})
          .show_default(),
      command.add_option("--step-coverage", c->step_coverage, "Of a directional dielectric")
          .range(0.0, 1.0)
          .show_default(),
      command
          .add_option("--edge-radius", c->edge_radius,
                      "Of the electrode's edges below walls of --texture; 0: not stated")
          .show_default()};
  c->of_directional = {c->of_texture[1]};
  command.add_option("--skin-layer", c->skin_layer, "d/eps of the stratum corneum in series")
      .show_default();
  command
      .add_option("--method", c->method,
                  "spread: flux spreads in the dielectric; local: columns; full: 3-D")
      .one_of({"spread", "local", "full"})
      .show_default();
  command.add_option("--out-pressure", c->out_pressure, "Pressure [Pa] as .npy");
  command.add_flag("--json", c->json, "One JSON object");
  command.on_chosen([c, &context] { context.action = [c] { return solve(*c); }; });
}

}  // namespace papilla::cli
