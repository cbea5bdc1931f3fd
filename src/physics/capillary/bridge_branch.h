// The family of exact plate-plate bridges of volume 1 and tension 1 over the gap, at fixed angles:
// what the solver, the limits and the table share.
#pragma once

#include <array>
#include <optional>

#include "base/rooms.h"

namespace papilla::capillary::bridge_branch {

struct Unknowns {
  double r1 = 0;   // contact radius on plate 1
  double p = 0;    // pressure over tension
  double arc = 0;  // length of the meridian
};

// The Delaunay meridian of these unknowns that leaves plate 1 at its contact angle: its end, its
// integrals, and their derivatives by (r1, p, arc).
struct Profile {
  double height = 0, volume = 0, free_area = 0;
  double w = 0, u = 0, r2 = 0;  // end: r cos(phi), r sin(phi), r
  std::array<double, 3> height_slope{}, volume_slope{}, w_slope{}, u_slope{};
};
Profile profile(const Unknowns& x, double theta1);

// From a guess to the bridge of this height; nothing if Newton fails or finds another surface.
std::optional<Unknowns> newton(Unknowns x, double theta1, double theta2, double height,
                               double* determinant = nullptr);
double force(const Unknowns& x, double theta1);
double energy(const Unknowns& x, double theta1, double theta2);
Unknowns slab_guess(double height, double theta1, double theta2);  // good for small heights

struct Limit {
  bool found = false;
  double height = 0;
  Unknowns at;
  bool pitchfork = false;
};

// Walks along the stable branch from the slab.
class Branch {
 public:
  Branch(double theta1, double theta2);

  bool valid() const { return valid_; }
  bool go_to(double height);  // false: not reached (at or beyond the limit); stays where it got to
  double height() const { return height_; }
  const Unknowns& at() const { return at_; }
  Limit limit();  // of stability; moves along the branch

 private:
  bool accept(const Unknowns& x, double height);

  double theta1_, theta2_;
  bool valid_ = false, has_previous_ = false;
  double height_ = 0, previous_height_ = 0;
  double sign_ = 1;  // of the Jacobian on the stable branch
  Unknowns at_, previous_;
};

}  // namespace papilla::capillary::bridge_branch
