// How a set of values becomes one number.
#pragma once

#include <string>
#include <vector>

namespace papilla {

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

// Eq. search.10: a quantity over independent scatter, uniform within the tolerances, from its
// nominal value and those with one number at the lower and upper end: values of equal weight that
// have the exact mean (Risk::Mean), mean and variance (MeanStd), the worst (Worst) or a
// low-discrepancy sample (Cvar) of the additive quadratic model through them.
std::vector<double> scattered_values(const Risk& risk, bool higher_is_better, double nominal,
                                     const std::vector<double>& lower,
                                     const std::vector<double>& upper);

}  // namespace papilla
