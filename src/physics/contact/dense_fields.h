// What the parts of the dense solver work on: the problem, its pressure and gap function, and the
// step being taken.
#pragma once

#include <vector>

#include "base/rooms.h"
#include "numerics/loops.h"
#include "physics/contact/solvers.h"

namespace papilla::contact {

// Slope of the energy along a step at its start, and its curvature; the step's end is at 1.
struct StepSlopes {
  double slope, curvature;
};

struct DenseFields {
  DenseFields(const StandardProblem& standard, StandardState& state);

  // p as given, with any mean: scaled to the load over the whole grid; below a cap what is at it
  // stays, and what overflows goes to the others.
  void scale_to_load();
  // Gap function without pressure, or empty, to `change`: what p adds to it there.
  void start(RealArray without);

  // One transform pair: what the step changes the gap function by.
  void displace_step();
  // One transform pair: `field` as displacements to the pressures of the whole plane.
  void press_field();

  // Rigid shift at t of the step: the mean gap function of the pixels between the bounds, sum /
  // count. Given the approach, the load instead.
  void set_shift(double sum, double count, double t);
  // The shift of the state returned. Below a cap the mean over the pixels that are not at it would
  // take those for elastic that a certified state may leave on their way there. Eq. contact.19
  void settle_shift();
  // Frank-Wolfe gap over load and height spread. Eq. contact.4, contact.10
  double certificate();
  // Gaps and work of the state, in one pass.
  void close_gaps();

  // Most that pixels may carry together besides `held` of them at the cap [Pa].
  double load_beside(std::size_t held) const {
    return load - (held == 0 ? 0 : cap * static_cast<double>(held));
  }

  const StandardProblem& problem;
  const ContactKernel& kernel;
  const Grid& grid;
  StandardState& state;
  const double cap;        // [Pa]
  double load;             // sum of p [Pa]; found where the approach is given
  std::vector<double>& p;  // of the state
  RealArray gap;           // gap function [m]: height difference under p, the rigid shift in it
  // The change of p by the step taken, and of the gap function, both before it is shortened.
  RealArray step, change;
  RealArray field;  // of the whole grid, for one part at a time: residual, then direction
  double shift = 0, low = 0, work = 0;  // low: the lowest gap; work: sum of p times gap function

 private:
  // A rest of the load [Pa] that what is pressed cannot take goes to the highest of the others, on
  // as few as carry it: on all of them it would close the gap everywhere, at a small certificate.
  void press_highest(double rest);

  SpectrumArray scratch_;
  std::vector<double> sorted_;
};

// level at which raw - level ones (empty: 1), cut at 0 and cap, carries `load`, to 1e-13 of
// `scale`: Newton's method on a falling, piecewise linear function, kept between bounds.
double load_level(std::span<const double> raw, std::span<const double> ones, double cap,
                  double load, double scale);

constexpr double kBarred = 1e300;  // a raw value that stands for a pixel held at a bound

// Of one pixel or of several (numerics/loops.h).

// The pressure allowed that is nearest to `wanted`.
template <class T>
T within_bounds(const T& wanted, double cap) {
  return smaller(larger(wanted, 0.0), cap);
}

// The step from the pressure `old` ends at a bound where it did not begin.
template <class T>
auto meets_bound(const T& old, const T& p, double cap) {
  return (p == 0.0 && old > 0.0) || (p == cap && old < cap);
}

// How many times a pixel's step, its end p, fits between 0 and cap.
template <class T>
T room_of(const T& step, const T& p, double cap) {
  const T open = chosen(step < 0.0, step - p, cap - p + step);
  const T length = open / chosen(step != 0.0, step, 1e-300);
  return chosen(step != 0.0, length, kInfinity);
}

}  // namespace papilla::contact
