#include "report/surface_changes.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "base/text.h"
#include "base/units.h"
#include "metrics/shown.h"
#include "report/run_numbers.h"

namespace papilla::report {

std::string score_changes(const ResultFiles& f, const Pair& words, const Score& design,
                          const Score& other) {
  std::vector<std::string> better, worse;
  for (std::size_t k = 0; k < design.values.size(); ++k) {
    const StudyObjective& o = f.problem.objectives()[k];
    const double change = design.values[k] - other.values[k];
    const double error = difference_error(design, other, k);
    if (std::abs(change) <= error) continue;
    // A quantity without an error, an appearance, changes by rounding alone.
    if (!scatters(design.values[k], std::abs(change)) ||
        std::abs(change) < resolution(o.expression))
      continue;
    const bool raised = change > 0, gain = raised == o.maximise;
    const StatedNumber by =
        raised ? difference_number(f, words.design + " less " + words.other, design, other, k)
               : difference_number(f, words.other + " less " + words.design, other, design, k);
    const std::string size = scatters(change, error)
                                 ? shown_with_error(o.expression, std::abs(change), error)
                                 : shown_value(o.expression, std::abs(change));
    const std::string unit = shown_unit(o.expression).unit;
    (gain ? better : worse)
        .push_back(fmt::format("{} {} by {} ({})", raised ? "raises" : "lowers", o.name,
                               stated(by, size + (unit.empty() ? "" : " " + unit)),
                               gain ? "better" : "worse"));
  }
  better.insert(better.end(), worse.begin(), worse.end());
  return join_names(better, " and ");
}

std::string chosen_value(const Variable& v, double value, const std::string& of) {
  const std::string text = variable_text(v, value);
  if (v.is_kind()) return text;
  return stated(bare_number(v.path + " of " + of, value / find_unit(v.unit)->to_si, v.unit, kChosen,
                            {Stage::Confirm}),
                text);
}

}  // namespace papilla::report
