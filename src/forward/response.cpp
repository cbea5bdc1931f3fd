#include "forward/response.h"

#include <fmt/format.h>

#include <cmath>

#include "base/check.h"
#include "base/text.h"

namespace papilla::forward {

ModelStatus ResponsePoint::said() const {
  if (oxide_margin < 1) return {Trouble::Breakdown, 1 / oxide_margin, ""};
  return status;
}

// What was before a pull-in of the drive stands. Of one without a voltage the numbers are those of
// a state on its way to a closed gap.
bool ResponsePoint::knows_undriven() const {
  return !(area_fraction_off.value > 1) && !status.pull_in_undriven() &&
         !(source_voltage == 0 && status.pull_in());
}

bool ResponsePoint::knows_driven() const {
  const Trouble trouble = said().trouble;
  return knows_undriven() && !(area_fraction_on.value > 1) && !status.pull_in() &&
         trouble != Trouble::Breakdown && trouble != Trouble::FullContact &&
         trouble != Trouble::FieldUnsolved;
}

double BeliefRuns::effective() const {
  double squares = 0;
  for (const BeliefRun& m : members) squares += m.weight * m.weight;
  return squares > 0 ? 1 / squares : 0;
}

std::vector<PointTrouble> Response::said() const {
  std::vector<PointTrouble> out;
  for (const ResponsePoint& point : points) {
    const ModelStatus said = point.said();
    if (!said.sound()) out.push_back({point.relative_humidity, said});
    if (!point.water_fit.sound() && point.water_fit != said)
      out.push_back({point.relative_humidity, point.water_fit});
  }
  return out;
}

std::vector<PointTrouble> Response::troubles() const {
  std::vector<PointTrouble> out;
  for (const ResponsePoint& point : points) {
    if (!point.status.sound()) out.push_back({point.relative_humidity, point.status});
  }
  return out;
}

std::string text(const VoltageAnswer& answer) {
  switch (answer.end) {
    case VoltageEnd::Reached:
      return "reached";
    case VoltageEnd::NoField:
      return "what touches does not conduct: no field reaches it";
    case VoltageEnd::NoDielectric:
      return "no dielectric, or none on side walls: contact would short the drive";
    case VoltageEnd::Breakdown:
      return fmt::format("the dielectric breaks down at {} V", significant(answer.limit, 4));
    case VoltageEnd::SourceEnds:
      return fmt::format("the source ends at {} V", significant(answer.limit, 4));
    case VoltageEnd::ModelEnds:
      return fmt::format("{} at {} V", text(answer.model), significant(answer.limit, 3));
    case VoltageEnd::Unsound:
      return text(answer.model);
    case VoltageEnd::NotConverged:
      return "the search for the voltage has not converged";
  }
  PAPILLA_CHECK(false, "an end without words");
  return {};
}

std::string text(const TargetReport& report) {
  switch (report.end) {
    case TargetEnd::Reached:
      return "reached";
    case TargetEnd::NoRelativeError:
      return report.quantity + " is zero: no relative error";
    case TargetEnd::PlanUnsettled:
      return "not reached: the plan does not settle";
    case TargetEnd::LimitsReached:
      return fmt::format(
          "not reached: {} {:.2g} % is the largest part; at most {} pixels, {} skins",
          report.largest_part, 100 * report.largest_share, report.largest_grid, report.most_skins);
    case TargetEnd::TimeSpent:
      return "not reached: the time limit of the run left no more";
  }
  PAPILLA_CHECK(false, "an end without words");
  return {};
}

}  // namespace papilla::forward
