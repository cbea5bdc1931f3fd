// What the fit of a finger leaves open: the covariance of the logarithms of its fitted numbers.
#pragma once

#include <string>
#include <vector>

#include "scene/finger.h"

namespace papilla {

// The finger with the logarithm of each parameter of its `uncertainty` moved; values stay inside
// the limits of their keys. Throws InputError for a parameter that the finger has not.
Finger moved_finger(const Finger& finger, const std::vector<double>& logarithms);

// Lower triangular factor L, row-major n x n, of the covariance of those logarithms: C = L L'.
// Throws InputError where the correlations are no correlations (not positive definite).
std::vector<double> covariance_factor(const std::vector<ParameterDeviation>& uncertainty);

// What is wrong with the `uncertainty` of a finger, for people; "" when nothing is.
std::string uncertainty_problem(const Finger& finger);

// One independent direction of the covariance: the finger one standard deviation up and down.
struct FingerStep {
  Finger up, down;
};
// One per column of L that moves anything. Throws InputError where the finger has no `uncertainty`.
std::vector<FingerStep> finger_steps(const Finger& finger);

// What is said of a finger without `uncertainty`.
std::string unknown_parameters(const Finger& finger);

}  // namespace papilla
