// papilla solve PIECE: one piece of physics alone.
#include <CLI/CLI.hpp>

#include "cli/commands.h"

namespace papilla {

void add_solve(CLI::App& app, Context& context) {
  CLI::App* command = app.add_subcommand("solve", "One piece of physics alone");
  command->require_subcommand(1);
  for (const auto& add : kPieces) add(*command, context);
}

}  // namespace papilla
