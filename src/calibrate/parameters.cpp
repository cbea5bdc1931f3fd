// Fingers that a calibration moves through: under a hypothesis, with parameters set.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/units.h"
#include "calibrate/calibration_file.h"
#include "config/describe.h"

namespace papilla::calibrate {
namespace {

// Where the fit of a parameter begins.
void start(CalibrationParameter& p, const BeliefValue& v, const std::vector<NumberField>& numbers) {
  const Place& at = v.value.key_place;
  const auto wrong = [&](const std::string& message) {
    throw InputError({Problem{at.file, at.line, at.column, "hypothesis." + p.path, message}});
  };
  if (p.path == kWaterScale) wrong("begins at 1: leave it out of `start`");
  p.fit.start = *find_number_field(numbers, p.path).value;
  if (p.fit.start < p.fit.low || p.fit.start > p.fit.high)
    wrong(fmt::format("{} lies outside the parameter's bounds",
                      format_quantity(p.fit.start, p.unit)));
}

}  // namespace

Calibration under(const Calibration& calibration, const Hypothesis& hypothesis) {
  Calibration out = calibration;
  std::vector<BeliefValue> values = hypothesis.set;
  values.insert(values.end(), hypothesis.start.begin(), hypothesis.start.end());
  const MemberScene at = with_member({}, {1, hypothesis.name, values}, calibration.finger,
                                     calibration.finger.calibrated_for);
  out.finger = at.finger;
  out.finger.calibrated_for = at.model;
  const std::vector<NumberField> numbers = number_fields(out.finger);
  for (const BeliefValue& v : hypothesis.start) {
    for (CalibrationParameter& p : out.parameters) {
      if (p.path == v.path) start(p, v, numbers);
    }
  }
  return out;
}

std::vector<FitParameter> fit_parameters(const Calibration& calibration) {
  std::vector<FitParameter> out;
  for (const CalibrationParameter& p : calibration.parameters) out.push_back(p.fit);
  return out;
}

Finger with_parameters(const Calibration& calibration, std::span<const double> values) {
  Finger finger = calibration.finger;
  const std::vector<NumberField> numbers = number_fields(finger);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::string& path = calibration.parameters[i].path;
    if (path == kWaterScale) {
      for (double& v : finger.water.volume) v *= values[i];
    } else {
      *find_number_field(numbers, path).value = values[i];
    }
  }
  return finger;
}

}  // namespace papilla::calibrate
