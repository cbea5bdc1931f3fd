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

// Eq. accuracy.11: central differences over one standard deviation along each column of L, on
// common skins, offsets and droplets. Fills response.parameters and the part `parameters` of every
// number. Cost: 2 n evaluations by the load law with at most 8 skins and 128 pixels. Throws
// InputError where the finger has no `uncertainty`.
void add_parameter_errors(Response& response, const Scene& scene, const Texture& texture,
                          const Fidelity& fidelity);

}  // namespace papilla
