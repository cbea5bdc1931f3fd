#include "lab/response_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace papilla::lab {
namespace {

std::string skin_key(const Experiment& e) {
  return fmt::format("{} {:.6g} {:.6g} {}", e.design, e.at.load, e.at.relative_humidity,
                     static_cast<int>(e.at.state));
}

std::string cell_key(const Experiment& e) {
  return fmt::format("{} {:.6g} {:.6g}", skin_key(e), e.at.voltage, e.at.frequency);
}

}  // namespace

void ResponseTable::add(const std::vector<Experiment>& experiments) {
  for (std::size_t d = 0; d < designs_.size(); ++d) {
    std::vector<Experiment> wanted;
    std::vector<Conditions> at;
    for (const Experiment& e : experiments) {
      if (e.design != d || cells_.count(cell_key(e))) continue;
      if (std::find(wanted.begin(), wanted.end(), e) != wanted.end()) continue;
      wanted.push_back(e);
      at.push_back(e.at);
    }
    if (wanted.empty()) continue;
    const std::vector<MemberFriction> found = model_.friction(designs_[d].design, at);
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      MeasurableCell cell;
      cell.skin = skins_.emplace(skin_key(wanted[i]), skins_.size()).first->second;
      cell.off = add_row(found[i].off, found[i].off_se);
      if (wanted[i].at.driven()) cell.on = add_row(found[i].on, found[i].on_se);
      cells_[cell_key(wanted[i])] = cell;
    }
  }
}

std::optional<std::size_t> ResponseTable::add_row(const std::vector<double>& forces, double error) {
  std::vector<double> row;
  for (const double f : forces) {
    if (!(f > 0) || !std::isfinite(f)) return std::nullopt;
    row.push_back(std::log(f));
  }
  responses_.push_back(std::move(row));
  numerical_.push_back(error);
  return responses_.size() - 1;
}

const MeasurableCell& ResponseTable::cell(const Experiment& experiment) const {
  return cells_.at(cell_key(experiment));
}

}  // namespace papilla::lab
