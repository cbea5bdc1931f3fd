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
         "rough contact of a map"},
        {"papilla solve contact physics/rough_contact.toml",
         "the statistics of a stated spectrum over seeds"},
        {"papilla solve droplets --design m3_samples/a3h350.toml --out droplets.png",
         "the sweat in the gap of a published sample, as a picture"},
        {"papilla solve field --gap gap.npy --size \"12 um\" --voltage \"150 V\" --method full",
         "the pull over a map of the gap, by the 3-D field"},
        {"papilla solve drive physics/fingertip_drive.toml",
         "impedances, modulation and limits of a fingertip's drive"}}});
  command.require_command();
  for (const auto& add : kPieces) add(command, context);
  for (const Command& piece : command.commands()) {
    Manual own{piece.meaning(), {}};
    for (const Manual::Line& example : command.manual().examples) {
      if (example.what.starts_with("papilla solve " + piece.name() + " "))
        own.examples.push_back(example);
    }
    piece.document(own);
  }
}

}  // namespace papilla::cli
