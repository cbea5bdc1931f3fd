#include "search/rounding.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "base/units.h"

namespace papilla::search {
namespace {

constexpr double kMostChange = 0.02;  // a step of the grid over the length
constexpr double kFinest = 1e-12;     // [m]
constexpr int kDigits = 3;

bool is_length(const std::string& unit) { return find_unit(unit)->same_dimension(*find_unit("m")); }

// As a file would write it: 7.05 um, not 7.050000000000001.
double multiple(double value, double step, const std::string& unit) {
  const double shown = std::round(value / step) * step / find_unit(unit)->to_si;
  return unit.empty() ? std::strtod(fmt::format("{:.12g}", shown).c_str(), nullptr)
                      : parse_si(fmt::format("{:.12g} {}", shown, unit), unit);
}

double step_of(const Variable& v, double value, double grid) {
  if (is_length(v.unit)) {
    double step = grid;
    while (step > kMostChange * std::abs(value) && step > 1.5 * kFinest) step /= 10;
    return step;
  }
  const double unit = find_unit(v.unit)->to_si;
  if (find_unit(v.unit)->same_dimension(*find_unit("deg"))) return find_unit("deg")->to_si;
  const double size = std::floor(std::log10(std::abs(value) / unit));
  return unit * std::pow(10, size - kDigits + 1);
}

}  // namespace

double on_grid(const Variable& v, double value, double grid) {
  if (value == 0 || !v.choices.empty() || v.is_kind() || v.is_levels()) return value;
  const double step = step_of(v, value, grid);
  double out = multiple(value, step, v.unit);
  if (out > v.high) out = multiple(out - step, step, v.unit);
  if (out < v.low) out = multiple(out + step, step, v.unit);
  for (const Excluded& e : v.excluded) {
    if (!e.holds(out)) continue;
    const double below = std::floor(e.from / step) * step, above = std::ceil(e.to / step) * step;
    out = multiple(value <= e.from ? below : above, step, v.unit);
  }
  return out < v.low || out > v.high ? value : out;
}

Point rounded(const StudyProblem& problem, const Point& unit) {
  std::vector<double> value = problem.space().value(unit);
  for (std::size_t k = 0; k < value.size(); ++k)
    value[k] = on_grid(problem.study().variables[k], value[k], problem.study().search.rounding);
  return problem.space().snapped(problem.space().unit(value));
}

}  // namespace papilla::search
