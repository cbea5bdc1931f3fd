// papilla solve PIECE: one piece of physics alone.

#include "cli/commands.h"

namespace papilla::cli {

void add_solve(Command app, Context& context) {
  Command command = app.add_command("solve", "One piece of physics alone");
  command.document(
      {"Solves one piece of the physics on maps or cases of one's own, by the solvers of the "
       "model.",
       {{"papilla solve bridge --volume \"0.01 um3\" --gap \"100 nm\"", "a capillary bridge"},
        {"papilla solve persson physics/wrist_on_glass.toml",
         "the mean field of a rough skin under voltage"},
        {"papilla solve haze transparent_glass/study.toml", "how a texture looks"},
        {"papilla solve contact --height heights.npy --size \"12 um\" --pressure \"15 kPa\" "
         "--modulus \"53 MPa\"",
         "rough contact of a map"}}});
  command.require_command();
  for (const auto& add : kPieces) add(command, context);
}

}  // namespace papilla::cli
