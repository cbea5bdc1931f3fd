// papilla solve drive: from the source to the force over time and its spectrum.
#include <iostream>
#include <memory>

#include "base/files.h"
#include "cases/drive.h"
#include "cli/commands.h"
#include "report/drive.h"

namespace papilla::cli {
namespace {

struct DriveCommand {
  DesignOptions file;
  std::string out, swipe;
  bool render = false;
};

// The swipes asked for: recorded, rendered.
std::vector<Swipe> swipes_of(const DriveCommand& command, const DriveCase& c,
                             const DriveResult& result) {
  std::vector<Swipe> out;
  if (!command.swipe.empty()) {
    out.push_back(
        run_swipe(read_bytes(command.swipe), command.swipe, swipe_machine(c), c.swipe.filter));
  }
  if (command.render) out.push_back(render_swipe(c, result.network));
  return out;
}

int solve(const Context& context, const DriveCommand& command) {
  const DriveCase c = read_drive_case(command.file.file, command.file.overrides);
  if (!command.out.empty()) make_folder(command.out);
  const DriveResult r = solve_drive(c);
  const std::vector<Swipe> swipes = swipes_of(command, c, r);
  if (!command.out.empty()) {
    write_bytes(command.out + "/series.csv", drive_series_csv(r));
    write_bytes(command.out + "/lines.csv", drive_lines_csv(r));
    write_bytes(command.out + "/drive.svg", drive_svg(c, r));
    if (command.render) write_bytes(command.out + "/swipe.csv", swipe_csv(swipes.back()));
    context.note("wrote " + command.out);
  }
  if (command.file.json) {
    std::cout << drive_json(c, r, swipes) << '\n';
    return kSuccess;
  }
  std::cout << drive_text(c, r);
  for (const Swipe& swipe : swipes) std::cout << swipe_text(swipe);
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
                  "Recorded forces \"time,lateral,normal\" [s, N], or without times at 1 kHz: when "
                  "stickiness would drive the finger")
      .type_name("FORCES.csv");
  command.add_flag("--render", options->render,
                   "Close the loop: a finger drags to and fro ([swipe]), driven while it sticks");
  command
      .add_option("--out", options->out,
                  "Also write series.csv, lines.csv, drive.svg and, rendered, swipe.csv")
      .type_name("DIR");
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return solve(context, *options); };
  });
}

}  // namespace papilla::cli
