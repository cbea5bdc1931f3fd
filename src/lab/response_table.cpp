#include "lab/response_table.h"

#include <fmt/format.h>

#include <cmath>
#include <set>

namespace papilla::lab {
namespace {

std::string cell_key(const Experiment& e) {
  return fmt::format("{} {:.6g} {:.6g} {} {:.6g} {:.6g}", e.design, e.at.load,
                     e.at.relative_humidity, static_cast<int>(e.at.state), e.at.voltage,
                     e.at.frequency);
}

}  // namespace

// Those that are kept first, so that it can be said how many are left to evaluate.
void ResponseTable::know(const std::vector<Experiment>& experiments) {
  std::vector<const Experiment*> open;
  std::set<std::string> seen;
  for (const Experiment& e : experiments) {
    const std::string key = cell_key(e);
    if (known_.contains(key) || !seen.insert(key).second) continue;
    if (auto kept = model_.kept_friction(designs_[e.design], e.at))
      known_.emplace(key, std::move(*kept));
    else
      open.push_back(&e);
  }
  for (std::size_t i = 0; i < open.size(); ++i) {
    const Experiment& e = *open[i];
    known_.emplace(cell_key(e), model_.friction(designs_[e.design], e.at,
                                                fmt::format("{} of {}: ", i + 1, open.size())));
  }
}

void ResponseTable::lay(const std::vector<Experiment>& experiments) {
  cells_.clear();
  responses_.clear();
  sampling_.clear();
  know(experiments);
  for (const Experiment& e : experiments) {
    const auto [place, is_new] = cells_.try_emplace(cell_key(e));
    if (!is_new) continue;
    const MemberFriction& found = known_.at(place->first);
    MeasurableCell& cell = place->second;
    cell.off = add_row(found.off);
    if (e.at.driven()) cell.on = add_row(found.on);
  }
}

std::optional<std::size_t> ResponseTable::add_row(const MemberNumbers& friction) {
  for (const double f : friction.at) {
    if (!(f > 0) || !std::isfinite(f)) return std::nullopt;
  }
  MemberNumbers logs = logarithms(friction);
  responses_.push_back(std::move(logs.at));
  sampling_.push_back(std::move(logs.sampling));
  return responses_.size() - 1;
}

const MeasurableCell& ResponseTable::cell(const Experiment& experiment) const {
  return cells_.at(cell_key(experiment));
}

}  // namespace papilla::lab
