// The two solvers of the standard problem (Eq. contact.2), inside this folder.
#pragma once

#include <span>

#include "base/constants.h"
#include "base/rooms.h"
#include "numerics/fft.h"
#include "physics/contact/contact.h"

namespace papilla::contact {

// Minimise 1/2 pSp + p.g0 over 0 <= p <= cap, g0 = -height - S traction (Eq. contact.3): with the
// sum of p given (load control), or with the rigid level given (approach control: minimise
// 1/2 pSp + p.(g0 - level)).
struct StandardProblem {
  const ContactKernel& kernel;
  std::span<const double> height;    // [m]
  std::span<const double> traction;  // attractive [Pa], or empty
  double spread = 1;                 // height that normalises the certificate [m]
  double load = 0;                   // sum of p [Pa]
  double cap = kInfinity;
  bool approach = false;
  double level = 0;  // [m], approach control

  // The surface's rise by the tractions alone, S traction. Returns the transform pairs it took.
  double rise_unpressed(RealArray& rise, SpectrumArray& scratch) const;
};

struct StandardState {
  std::vector<double> p;    // pressure [Pa]
  std::vector<double> gap;  // [m], zero under pressure
  double work = 0;          // sum of (traction - p) S (traction - p): twice energy per pixel area
  double shift = 0, certificate = 0;
  double pairs = 0;  // in units of the problem's grid
  int iterations = 0;
  bool certified = false, exhausted = false;  // exhausted: by the number of iterations
};

// start: pressures of a nearby problem, or empty: from coarser grids.
StandardState solve_dense(const StandardProblem& problem, double tolerance, int max_iterations,
                          std::span<const double> start);

// Start of a dense solve from the grid of half the pixels, its gaps the 2x2 minimum, solved as far
// as a start is worth: pressures [Pa] on the finer grid. g0: the finer grid's gap function without
// pressure. pairs: the transform pairs it took, in units of the finer grid, are added.
std::vector<double> nested_start(const StandardProblem& fine, const RealArray& g0, double tolerance,
                                 double& pairs);

// Candidate set with an exact active set; certified over all pixels. False: too much contact for it
// (state.p is then a start for the dense solver where pairs were spent, and they count). start: a
// nearby solution or null. demand: tried whatever amount of contact is expected.
bool solve_sparse(const StandardProblem& problem, double tolerance, const ContactSolution* start,
                  bool demand, StandardState& state);

}  // namespace papilla::contact
