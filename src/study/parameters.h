// What the fit of the finger leaves open: its covariance carried to every number of a response.
#pragma once

#include <string>
#include <vector>

#include "forward/forward.h"

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
// One a column of L that moves anything. Throws InputError where the finger has no `uncertainty`.
std::vector<FingerStep> finger_steps(const Finger& finger);

// What is said of a finger without `uncertainty`.
std::string unknown_parameters(const Finger& finger);

// What the steps are run with: the load law, at most 8 skins and 128 pixels.
Fidelity step_fidelity(const Fidelity& fidelity);

// Eq. accuracy.11: central differences over the steps, on common skins, offsets and droplets. Fills
// response.parameters and the part `parameters` of every number. Cost: 2 n evaluations at
// step_fidelity. Throws as finger_steps.
void add_parameter_errors(Response& response, const Scene& scene, const Texture& texture,
                          const Fidelity& fidelity);

}  // namespace papilla
