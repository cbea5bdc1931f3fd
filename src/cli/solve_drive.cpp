// papilla solve drive: from the source to the force over time and its spectrum.
#include <iostream>
#include <memory>

#include "base/files.h"
#include "cases/drive.h"
#include "cli/commands.h"
#include "report/drive.h"

namespace papilla {
namespace {

struct DriveCommand {
  DesignOptions file;
  std::string out, swipe;
};

int solve(const Context& context, const DriveCommand& command) {
  const DriveCase c = read_drive_case(command.file.file, command.file.overrides);
  if (!command.out.empty()) make_folder(command.out);
  const DriveResult r = solve_drive(c);
  if (!command.out.empty()) {
    write_bytes(command.out + "/series.csv", drive_series_csv(r));
    write_bytes(command.out + "/lines.csv", drive_lines_csv(r));
    write_bytes(command.out + "/drive.svg", drive_svg(c, r));
    context.note("wrote " + command.out);
  }
  if (command.file.json) {
    std::cout << drive_json(c, r) << '\n';
    return kSuccess;
  }
  std::cout << drive_text(c, r);
  if (!command.swipe.empty()) {
    StictionOptions how;
    how.stuck_current = how.partial_current = c.drive.current;
    std::cout << swipe_text(run_swipe(read_bytes(command.swipe), command.swipe, how));
  }
  return kSuccess;
}

}  // namespace

void add_solve_drive(Command solve_command, Context& context) {
  Command command = solve_command.add_command(
      "drive", "From the source to the force: impedances, modulation, spectrum, limits");
  auto options = std::make_shared<DriveCommand>();
  command.add_option("file", options->file.file, "Case, e.g. designs/physics/fingertip_drive.toml")
      .required()
      .type_name("FILE");
  add_set_option(command, options->file.overrides);
  command.add_flag("--json", options->file.json, "One JSON object, SI units");
  command
      .add_option("--swipe", options->swipe,
                  "Forces \"lateral,normal\" [N] at 1 kHz: when stickiness would drive the finger")
      .type_name("FORCES.csv");
  command.add_option("--out", options->out, "Also write series.csv, lines.csv and drive.svg")
      .type_name("DIR");
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return solve(context, *options); };
  });
}

}  // namespace papilla
