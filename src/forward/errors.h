// The grid and method parts of the error: a few skins run again, one choice changed at a time.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "base/rooms.h"
#include "forward/patch_set.h"

namespace papilla::forward {

// Fills patches.errors and patches.controls, the grid and method parts of the error, from
// fidelity.control_skins of the patches run again: on half the pixels (Eq. accuracy.2), and with
// contact areas solved in place of the load law (Eq. accuracy.3). Nothing with fewer than two
// control skins.
void measure_errors(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                    PatchSet& patches);

// What control skins are run again by: contact areas solved in place of the load law, and half the
// pixels; none where there is no such run.
struct ControlFidelities {
  int skins = 0;
  std::optional<Fidelity> areas, coarse;
};
ControlFidelities control_fidelities(const Fidelity& fidelity, const Plan& plan);

// What contact areas of the runs are to be multiplied with, so that they are those of the whole
// skin: the octaves of its spectrum that the grid leaves out would make them smaller, by as much
// each as half the pixels make them larger. 1 where none are left out. Eq. accuracy.2
double resolved_areas(const ControlRuns& runs);

// A number read off the points of a response; nothing where it is not defined.
using Reading = std::function<std::optional<double>(const std::vector<ResponsePoint>&)>;

// Relative to the number, or by itself: what is left of a spread over humidity near zero says
// nothing about how far off another would be.
enum class Change { Relative, Absolute };

// What grid and load law do to a number that stands on a quantity, as samples of the control skins:
// Eq. accuracy.2, accuracy.3. Empty where they were not run or the number is not defined.
struct ControlledChange {
  std::vector<double> grid, method;
  std::vector<double> halving;  // of the grid, all of the step from half the pixels
};
ControlledChange controlled_change(const ControlRuns& runs, GridLaw quantity, const Reading& number,
                                   Change kind = Change::Relative);
// Relative errors of one origin at each humidity, each given the larger of its own and the weighted
// root mean square over humidity, as a difference may cross zero between two of them. of: how much
// of the quantity there is at each. Eq. accuracy.2, accuracy.3
void level_out(std::vector<double>& size, const std::vector<double>& of);
// The errors that they state: the scatter between skins is added, of the load law taken off. 0 for
// no samples.
double grid_error(const std::vector<double>& samples);
double method_error(const std::vector<double>& samples);

}  // namespace papilla::forward
