// papilla solve persson: mean field of a rough skin under voltage.
#include <chrono>
#include <iostream>
#include <memory>

#include "base/files.h"
#include "cases/persson.h"
#include "cli/commands.h"
#include "report/persson.h"

namespace papilla::cli {
namespace {

struct MeanFieldCommand : DesignOptions {
  std::string out;
};

void write_curves(const Context& context, const std::string& folder, const MeanFieldCase& c) {
  make_folder(folder);
  const MeanFieldCurves curves = mean_field_curves(c);
  write_bytes(folder + "/roughness.csv", roughness_csv(curves));
  write_bytes(folder + "/separation.csv", separation_csv(curves));
  if (!curves.stress.empty()) {
    write_bytes(folder + "/stress.csv", stress_csv(curves));
  } else {
    context.note("no stress.csv: the case's own point has no pull, or no state under its voltage");
  }
  if (!curves.step.empty()) {
    write_bytes(folder + "/step.csv", step_csv(curves));
  } else if (c.interface.lossy_skin && !curves.stress.empty()) {
    context.note("no step.csv: no dielectric holds the voltage after a step");
  }
  if (!curves.grid.empty()) write_bytes(folder + "/grid.csv", mean_field_grid_csv(curves.grid));
}

int solve(const Context& context, const MeanFieldCommand& options) {
  const MeanFieldCase c = read_mean_field(options.file, options.overrides);
  const auto begin = std::chrono::steady_clock::now();
  const MeanFieldResult r = solve_mean_field(c);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!options.out.empty()) {
    write_curves(context, options.out, c);
    context.note("wrote " + options.out);
  }
  std::cout << (options.json ? mean_field_json(c, r, seconds) + '\n'
                             : mean_field_text(c, r, seconds));
  const bool failed = !r.point.sound() || r.point.yielded;
  return failed ? kWorkFailed : kSuccess;
}

}  // namespace

void add_solve_persson(Command solve_command, Context& context) {
  Command command = solve_command.add_command(
      "persson", "Mean field of a rough skin under voltage: area, gap, pull, friction");
  auto options = std::make_shared<MeanFieldCommand>();
  command.add_option("file", options->file, "Case, e.g. designs/physics/wrist_on_glass.toml")
      .required()
      .type_name("FILE");
  add_set_option(command, options->overrides);
  command.add_flag("--json", options->json, "One JSON object, SI units");
  command
      .add_option("--out", options->out,
                  "Also write spectrum and area over magnification, stresses, gap over pressure, "
                  "step response, and the sweep's voltages by its loads, as tables")
      .type_name("DIR");
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return solve(context, *options); };
  });
}

}  // namespace papilla::cli
