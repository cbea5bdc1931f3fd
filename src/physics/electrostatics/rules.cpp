#include "physics/electrostatics/rules.h"

#include <algorithm>

#include "base/check.h"
#include "fields/price.h"
#include "physics/electrostatics/full_field.h"

namespace papilla::electrostatics {
namespace {

const FieldRule kLocal{
    "columns, one by one", "pull 20 to 45 % below the 3-D field", 0.3,
    [](const Grid& grid, double) { return 2e-8 * static_cast<double>(grid.size()); },
    [](const Gap& gap, const CoveredSurface* surface, const Wetting& wetting,
       const FieldProblem& problem,
       double) { return solve_local_field(gap, surface, wetting, problem); }};

const FieldRule kSpread{"columns, the flux spreading in the dielectric",
                        "uncorrected: pull 0 to 30 % above the 3-D field, more on deep holes", 0.12,
                        [](const Grid& grid, double tolerance) {
                          return std::max(6.0, 10.5 * digits(tolerance) - 12) *
                                 fft_pair_seconds(grid);
                        },
                        solve_spread_field};

FieldSolution full_field(const Gap& gap, const CoveredSurface* surface, const Wetting& wetting,
                         const FieldProblem& problem, double) {
  FieldSolution out = solve_full_field(gap, surface, wetting, problem);
  if (out.ok && out.mean_pressure < 0) {
    out.ok = false;
    out.reason = "the 3-D field is not resolved on these pixels: its pull is negative";
  }
  return out;
}

const FieldRule kFull{"3-D potential", "asked for; pull stated to 2 %", 0.02,
                      [](const Grid& grid, double) { return full_field_seconds(grid); },
                      full_field};

}  // namespace

const FieldRule& field_rule(FieldMethod method) {
  switch (method) {
    case FieldMethod::Local:
      return kLocal;
    case FieldMethod::Spread:
      return kSpread;
    case FieldMethod::Full:
      return kFull;
  }
  PAPILLA_CHECK(false, "a method without a rule");
  return kLocal;
}

}  // namespace papilla::electrostatics
