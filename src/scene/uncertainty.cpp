#include "scene/uncertainty.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "base/units.h"
#include "config/describe.h"

namespace papilla::scene {
namespace {

constexpr const char* kWaterScale = "water.scale";

}  // namespace

Finger moved_finger(const Finger& finger, const std::vector<double>& logarithms) {
  Finger out = finger;
  const std::vector<NumberField> numbers = number_fields(out);
  for (std::size_t i = 0; i < logarithms.size(); ++i) {
    const double factor = std::exp(logarithms[i]);
    const std::string& path = finger.uncertainty[i].parameter;
    if (path == kWaterScale) {
      for (double& v : out.water.volume) v *= factor;
      continue;
    }
    const NumberField field = find_number_field(numbers, path);
    const double unit = find_unit(field.unit)->to_si;
    *field.value = std::clamp(*field.value * factor, field.low * unit, field.high * unit);
  }
  return out;
}

std::vector<double> covariance_factor(const std::vector<ParameterDeviation>& uncertainty) {
  const std::size_t n = uncertainty.size();
  std::vector<double> l(n * n, 0.0);  // of the correlations first
  for (std::size_t i = 0; i < n; ++i) {
    const ParameterDeviation& row = uncertainty[i];
    if (row.correlation.size() > i)
      throw InputError(fmt::format("uncertainty of {}: {} correlations, but {} entries before it",
                                   row.parameter, row.correlation.size(), i));
    double left = 1;
    for (std::size_t j = 0; j < i; ++j) {
      double sum = j < row.correlation.size() ? row.correlation[j] : 0;
      for (std::size_t k = 0; k < j; ++k) sum -= l[i * n + k] * l[j * n + k];
      l[i * n + j] = sum / l[j * n + j];
      left -= square(l[i * n + j]);
    }
    if (!(left > 1e-12))
      throw InputError(fmt::format(
          "uncertainty of {}: its correlations contradict those before it (not positive definite)",
          row.parameter));
    l[i * n + i] = std::sqrt(left);
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) l[i * n + j] *= uncertainty[i].deviation;
  }
  return l;
}

std::string uncertainty_problem(const Finger& finger) {
  try {
    moved_finger(finger, std::vector<double>(finger.uncertainty.size(), 0.0));
    covariance_factor(finger.uncertainty);
  } catch (const InputError& error) {
    return error.problems().front().message;
  }
  return {};
}

std::string unknown_parameters(const Finger& finger) {
  return fmt::format(
      "finger \"{}\" has no [[uncertainty]]: nothing is known about its parameters (papilla "
      "calibrate writes it)",
      finger.name);
}

std::vector<FingerStep> finger_steps(const Finger& finger) {
  const std::size_t n = finger.uncertainty.size();
  if (n == 0) throw InputError(unknown_parameters(finger));
  const std::vector<double> factor = covariance_factor(finger.uncertainty);
  std::vector<FingerStep> out;
  for (std::size_t k = 0; k < n; ++k) {
    if (finger.uncertainty[k].deviation <= 0) continue;
    std::vector<double> up, down;
    for (std::size_t i = 0; i < n; ++i) {
      up.push_back(factor[i * n + k]);
      down.push_back(-up.back());
    }
    out.push_back({moved_finger(finger, up), moved_finger(finger, down)});
  }
  return out;
}

}  // namespace papilla::scene
