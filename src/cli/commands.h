// The subcommands: one file each. A new one is declared and listed here.
#pragma once

#include <array>

#include "base/rooms.h"
#include "cli/context.h"

namespace papilla::cli {

void add_optimize(Command app, Context& context);
void add_evaluate(Command app, Context& context);
void add_studio(Command app, Context& context);
void add_rank(Command app, Context& context);
void add_explain(Command app, Context& context);
void add_export(Command app, Context& context);
void add_verify(Command app, Context& context);
void add_wafer(Command app, Context& context);
void add_report(Command app, Context& context);
void add_surface(Command app, Context& context);
void add_solve(Command app, Context& context);
void add_reproduce(Command app, Context& context);
void add_predict(Command app, Context& context);
void add_calibrate(Command app, Context& context);
void add_next(Command app, Context& context);
void add_tell(Command app, Context& context);
void add_accuracy(Command app, Context& context);
void add_bench(Command app, Context& context);
void add_describe(Command app, Context& context);
void add_completion(Command app, Context& context);

// The pieces of `papilla solve`.
void add_solve_contact(Command solve, Context& context);
void add_solve_bridge(Command solve, Context& context);
void add_solve_droplets(Command solve, Context& context);
void add_solve_drive(Command solve, Context& context);
void add_solve_field(Command solve, Context& context);
void add_solve_persson(Command solve, Context& context);
void add_solve_haze(Command solve, Context& context);

// clang-format off
// In the order of `papilla --help`, one per line.
inline constexpr std::array kCommands{
    add_optimize,
    add_evaluate,
    add_studio,
    add_rank,
    add_explain,
    add_export,
    add_verify,
    add_wafer,
    add_report,
    add_surface,
    add_solve,
    add_calibrate,
    add_next,
    add_tell,
    add_reproduce,
    add_predict,
    add_accuracy,
    add_bench,
    add_describe,
    add_completion,
};

inline constexpr std::array kPieces{
    add_solve_contact,
    add_solve_bridge,
    add_solve_droplets,
    add_solve_field,
    add_solve_persson,
    add_solve_haze,
    add_solve_drive,
};
// clang-format on

}  // namespace papilla::cli
