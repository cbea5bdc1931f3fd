// How a set of values becomes one number.
#pragma once

#include <string>
#include <vector>

#include "base/rooms.h"
#include "design/scatter.h"

namespace papilla::search {

// Eq. search.4-6
struct Risk {
  enum class Kind { Mean, MeanStd, Cvar, Worst };
  Kind kind = Kind::Mean;
  double parameter = 0;  // k of mean - k std; share of the cvar
};
Risk parse_risk(const std::string& text);  // "" is the mean; throws InputError

// Weighted values to one, towards the bad side (low when higher is better).
double apply_risk(const Risk& risk, bool higher_is_better, const std::vector<double>& values,
                  const std::vector<double>& weights);

// Eq. search.10: a quantity over the scatter, from its nominal value and those with one number at
// the lower and upper end (Scatter::end): values of equal weight that have the exact mean
// (Risk::Mean), mean and variance (MeanStd of independent numbers), the worst between the ends
// (Worst) or are a low-discrepancy sample (else) of the additive quadratic model through them.
std::vector<double> scattered_values(const Risk& risk, bool higher_is_better, double nominal,
                                     const std::vector<double>& lower,
                                     const std::vector<double>& upper, const ScatterLaw& law);

// One quantity over the scatter: nominal + sum of a u + b u^2, u the deviation of a number in units
// of its end. Eq. search.10
struct ScatterQuadratic {
  ScatterQuadratic(double nominal, const std::vector<double>& lower,
                   const std::vector<double>& upper);
  double at(const std::vector<double>& deviation) const;

  double nominal;
  std::vector<double> a, b;
};

}  // namespace papilla::search
