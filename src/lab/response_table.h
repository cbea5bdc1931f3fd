// Every friction that can be or was measured, as rows of an ensemble.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/rooms.h"
#include "lab/ensemble.h"
#include "lab/member_model.h"

namespace papilla::lab {

// The readings of one experiment: rows of the ensemble.
struct MeasurableCell {
  std::optional<std::size_t> off, on;  // none: some member has no such state
};

class ResponseTable {
 public:
  // Both outlive this.
  ResponseTable(const std::vector<LabDesign>& designs, MemberModel& model)
      : designs_(designs), model_(model) {}

  // Its rows are those of these experiments, in their order, each once; what it has not known yet
  // is evaluated.
  void lay(const std::vector<Experiment>& experiments);
  // Of an experiment that was laid.
  const MeasurableCell& cell(const Experiment& experiment) const;

  const std::vector<std::vector<double>>& responses() const { return responses_; }
  const std::vector<Sampling>& sampling() const { return sampling_; }

 private:
  void know(const std::vector<Experiment>& experiments);
  std::optional<std::size_t> add_row(const MemberNumbers& friction);

  const std::vector<LabDesign>& designs_;
  MemberModel& model_;
  std::map<std::string, MemberFriction> known_;  // by cell
  std::map<std::string, MeasurableCell> cells_;
  std::vector<std::vector<double>> responses_;
  std::vector<Sampling> sampling_;
};

}  // namespace papilla::lab
