// The subcommands: one file each. A new one is declared and listed here.
#pragma once

#include <array>

#include "cli/context.h"

namespace papilla {

void add_optimize(CLI::App& app, Context& context);
void add_evaluate(CLI::App& app, Context& context);
void add_rank(CLI::App& app, Context& context);
void add_explain(CLI::App& app, Context& context);
void add_export(CLI::App& app, Context& context);
void add_report(CLI::App& app, Context& context);
void add_solve(CLI::App& app, Context& context);
void add_reproduce(CLI::App& app, Context& context);
void add_calibrate(CLI::App& app, Context& context);
void add_accuracy(CLI::App& app, Context& context);
void add_bench(CLI::App& app, Context& context);
void add_describe(CLI::App& app, Context& context);
void add_completion(CLI::App& app, Context& context);

// The pieces of `papilla solve`.
void add_solve_contact(CLI::App& solve, Context& context);
void add_solve_bridge(CLI::App& solve, Context& context);
void add_solve_droplets(CLI::App& solve, Context& context);
void add_solve_drive(CLI::App& solve, Context& context);
void add_solve_field(CLI::App& solve, Context& context);
void add_solve_persson(CLI::App& solve, Context& context);
void add_solve_haze(CLI::App& solve, Context& context);

// clang-format off
// In the order of `papilla --help`, one a line.
inline constexpr std::array kCommands{
    add_optimize,
    add_evaluate,
    add_rank,
    add_explain,
    add_export,
    add_report,
    add_solve,
    add_calibrate,
    add_reproduce,
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

}  // namespace papilla
