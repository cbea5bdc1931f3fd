#include "lab/response_table.h"

#include <fmt/format.h>

#include <cmath>

namespace papilla::lab {
namespace {

std::string cell_key(const Experiment& e) {
  return fmt::format("{} {:.6g} {:.6g} {} {:.6g} {:.6g}", e.design, e.at.load,
                     e.at.relative_humidity, static_cast<int>(e.at.state), e.at.voltage,
                     e.at.frequency);
}

}  // namespace

const MemberFriction& ResponseTable::friction(const Experiment& e) {
  const std::string key = cell_key(e);
  auto found = known_.find(key);
  if (found == known_.end())
    found = known_.emplace(key, model_.friction(designs_[e.design], e.at)).first;
  return found->second;
}

void ResponseTable::lay(const std::vector<Experiment>& experiments) {
  cells_.clear();
  responses_.clear();
  sampling_.clear();
  for (const Experiment& e : experiments) {
    const auto [place, is_new] = cells_.try_emplace(cell_key(e));
    if (!is_new) continue;
    const MemberFriction& found = friction(e);
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
