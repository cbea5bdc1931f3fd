// papilla solve persson: mean field of a rough skin under voltage.
#include <chrono>
#include <iostream>
#include <memory>

#include "cases/persson.h"
#include "cli/commands.h"
#include "report/persson.h"

namespace papilla {
namespace {

int solve(const DesignOptions& options) {
  const MeanFieldCase c = read_mean_field(options.file, options.overrides);
  const auto begin = std::chrono::steady_clock::now();
  const MeanFieldResult r = solve_mean_field(c);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::cout << (options.json ? mean_field_json(c, r, seconds) + '\n'
                             : mean_field_text(c, r, seconds));
  return r.point.on.pull.status == PullStatus::Collapsed ? kWorkFailed : kSuccess;
}

}  // namespace

void add_solve_persson(Command solve_command, Context& context) {
  Command command = solve_command.add_command(
      "persson", "Mean field of a rough skin under voltage: area, gap, pull, friction");
  auto options = std::make_shared<DesignOptions>();
  command.add_option("file", options->file, "Case, e.g. designs/physics/wrist_on_glass.toml")
      .required()
      .type_name("FILE");
  add_set_option(command, options->overrides);
  command.add_flag("--json", options->json, "One JSON object, SI units");
  command.on_chosen(
      [&context, options] { context.action = [options] { return solve(*options); }; });
}

}  // namespace papilla
