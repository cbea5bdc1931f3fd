// papilla solve PIECE: one piece of physics alone.

#include "cli/commands.h"

namespace papilla {

void add_solve(Command app, Context& context) {
  Command command = app.add_command("solve", "One piece of physics alone");
  command.require_command();
  for (const auto& add : kPieces) add(command, context);
}

}  // namespace papilla
