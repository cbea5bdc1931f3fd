#include "search/rounding.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "base/constants.h"
#include "base/units.h"
#include "design/families.h"

namespace papilla::search {
namespace {

constexpr double kMostChange = 0.02;  // a step of the grid over the length
constexpr double kFinest = 1e-12;     // [m]
constexpr int kDigits = 3;
constexpr int kReach = 3;  // values of the grid on either side of a number

bool is_length(const std::string& unit) { return find_unit(unit)->same_dimension(*find_unit("m")); }

// On the mask, whose writer puts edges on the places of its grid and nowhere between, however short
// the length is. Depths, films and radii are made by times and doses, which no grid bounds.
bool is_drawn(const Variable& v) {
  const std::optional<Measure> measure = measure_of(v.path);
  return measure == Measure::Period || measure == Measure::Width;
}

// As a file would write it: 7.05 um, not 7.050000000000001.
double multiple(double value, double step, const std::string& unit) {
  const double shown = std::round(value / step) * step / find_unit(unit)->to_si;
  return unit.empty() ? std::strtod(fmt::format("{:.12g}", shown).c_str(), nullptr)
                      : parse_si(fmt::format("{:.12g} {}", shown, unit), unit);
}

double step_of(const Variable& v, double value, double grid) {
  if (is_length(v.unit)) {
    double step = grid;
    if (is_drawn(v)) return step;
    while (step > kMostChange * std::abs(value) && step > 1.5 * kFinest) step /= 10;
    return step;
  }
  const double unit = find_unit(v.unit)->to_si;
  if (find_unit(v.unit)->same_dimension(*find_unit("deg"))) return find_unit("deg")->to_si;
  const double size = std::floor(std::log10(std::abs(value) / unit));
  return unit * std::pow(10, size - kDigits + 1);
}

bool rounds(const Variable& v, double value) {
  return value != 0 && v.choices.empty() && !v.is_kind() && !v.is_levels();
}

// Values of the grid that the variable may take, nearest first; empty: there is none beside it.
std::vector<double> grid_values(const Variable& v, double value, double grid) {
  std::vector<double> out;
  const auto add = [&](double k, double step) {
    const double at = multiple(k * step, step, v.unit);
    // Beside a number on a finer grid lie values that are on a coarser one, as 502 nm beside 499.
    const bool coarser = multiple(at, step_of(v, at, grid), v.unit) != at;
    const bool excluded = std::any_of(v.excluded.begin(), v.excluded.end(),
                                      [&](const Excluded& e) { return e.holds(at); });
    if (at >= v.low && at <= v.high && !coarser && !excluded &&
        std::count(out.begin(), out.end(), at) == 0)
      out.push_back(at);
  };
  const double step = step_of(v, value, grid), below = std::floor(value / step);
  for (int k = 1 - kReach; k <= kReach; ++k) add(below + k, step);
  for (const Excluded& e : v.excluded) {  // beyond both ends of what is left out, or on them
    const double from = step_of(v, e.from, grid), to = step_of(v, e.to, grid);
    add(std::floor(e.from / from + kLimitTolerance), from);
    add(std::ceil(e.to / to - kLimitTolerance), to);
  }
  std::stable_sort(out.begin(), out.end(),
                   [&](double a, double b) { return std::abs(a - value) < std::abs(b - value); });
  return out;
}

}  // namespace

double on_grid(const Variable& v, double value, double grid) {
  if (!rounds(v, value)) return value;
  const std::vector<double> values = grid_values(v, value, grid);
  return values.empty() ? value : values.front();
}

bool lies_on_grid(const Variable& v, double value, double grid) {
  if (!rounds(v, value)) return true;
  const std::vector<double> values = grid_values(v, value, grid);
  return !values.empty() && std::abs(values.front() - value) <= kLimitTolerance * value;
}

double finer_grid_below(double grid) { return grid / kMostChange; }

GridDesigns::GridDesigns(const StudyProblem& problem, const Point& around, bool flat)
    : space_(problem.space()), value_(space_.value(around)) {
  const Study& study = problem.study();
  const Point here = space_.snapped(around);
  for (std::size_t k = 0; k < value_.size(); ++k) {
    const Variable& v = study.variables[k];
    std::vector<Step>& steps = steps_.emplace_back();
    const bool still = !rounds(v, value_[k]) || (flat && v.path.starts_with("texture."));
    const double step = still ? 0 : step_of(v, value_[k], study.search.rounding);
    for (double value :
         still ? std::vector<double>{} : grid_values(v, value_[k], study.search.rounding)) {
      const double distance = std::abs(value - value_[k]) / step;
      steps.push_back({value, square(distance)});
    }
    // A number that this design does not have keeps its value.
    const bool felt = std::any_of(steps.begin(), steps.end(), [&](const Step& s) {
      std::vector<double> moved = value_;
      moved[k] = s.value;
      return space_.snapped(space_.unit(moved)) != here;
    });
    if (!felt) steps.assign(1, {value_[k], 0});
  }
  add(std::vector<std::size_t>(value_.size(), 0));
}

void GridDesigns::add(std::vector<std::size_t> places) {
  double squared = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (places[k] >= steps_[k].size()) return;
    squared += steps_[k][places[k]].squared;
  }
  if (known_.insert(places).second) open_.push({squared, std::move(places)});
}

std::optional<GridDesign> GridDesigns::next() {
  if (open_.empty()) return std::nullopt;
  const std::vector<std::size_t> places = open_.top().of;
  open_.pop();
  GridDesign out{value_, {}};
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Step& step = steps_[k][places[k]];
    out.value[k] = step.value;
    std::vector<std::size_t> farther = places;
    ++farther[k];
    add(std::move(farther));
  }
  out.unit = space_.snapped(space_.unit(out.value));
  return out;
}

}  // namespace papilla::search
