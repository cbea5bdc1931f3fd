// How designs differ, with the error of the difference itself: both meet the same skins, droplets
// and grids, and what is common to them cancels. docs/theory/accuracy.md, Eq. accuracy.14
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "papilla/evaluate.h"

namespace papilla::api {

// The second less the first.
struct Difference {
  double value = 0;
  double error = 0;     // one standard error of the difference
  bool paired = false;  // from common samples; else the errors of both in squares
  // What belief leaves of the difference, one standard deviation over the members that both fingers
  // have, and by their weight the probability that the second has more; nothing without belief.
  std::optional<double> model{}, above{};
};

struct ComparedPoint {
  double relative_humidity = 0;
  Difference modulation, friction_off, friction_on;  // friction [N]; driven designs alone have
                                                     // modulation and friction_on
};

struct Comparison {
  Response first, second;
  std::vector<ComparedPoint> points;          // one per humidity
  Difference mean_modulation, mean_friction;  // over humidity
};

// Both designs at one level, by the grid and the seed of the first, on common skins; the options
// hold for both. With a target both take the grid and the skins of the one that needs more, and the
// other is evaluated once again. Throws InputError, also for designs whose humidities differ;
// Stopped.
Comparison compare(const Design& first, const Design& second, const EvaluateOptions& options = {});

struct SensitivityOptions {
  std::vector<std::string> keys;  // empty: the numbers of the texture and its contact angle
  double step = 0.05;             // of a value, relative; of a 0 the share of its range
  EvaluateOptions evaluate;       // parameters, look and voltage_for are left out
};

// What a number of the design does to a metric.
struct Sensitivity {
  std::string path, unit;   // the unit for people
  double value = 0;         // SI
  double down = 0, up = 0;  // values that were evaluated, SI; equal to `value` where the design
                            // allows no step that way
  Difference change;        // of the metric from `down` to `up`
  double slope = 0, slope_error = 0;  // change / (up - down), per SI unit
};

// Finite steps on common skins. metric: "mean(modulation)". A key that can move neither way is left
// out. With a target all are run by the grid and the skins that the design itself needs. Cost: two
// evaluations a key. Throws InputError, Stopped.
std::vector<Sensitivity> sensitivity(const Design& design, const std::string& metric,
                                     const SensitivityOptions& options = {});

}  // namespace papilla::api
