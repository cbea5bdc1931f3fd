// The end of the stable branch: pseudo-arclength over the height.
#include <algorithm>
#include <array>
#include <cmath>

#include "physics/capillary/bridge_branch.h"
#include "physics/capillary/bridge_system.h"

namespace papilla::capillary::bridge_branch {
namespace {

using Vector = std::array<double, 4>;  // log r1, p, log arc, log height

Vector pack(const Unknowns& x, double h) {
  return {std::log(x.r1), x.p, std::log(x.arc), std::log(h)};
}
Unknowns unpack(const Vector& v) { return {std::exp(v[0]), v[1], std::exp(v[2])}; }

Vector along(const Vector& base, const Vector& tangent, double length) {
  Vector out = base;
  for (int j = 0; j < 4; ++j) out[j] += length * tangent[j];
  return out;
}

// A point of the branch. The determinant of the three equations at fixed height changes sign at
// the stability limit, fold or pitchfork.
struct Solved {
  bool ok = false;
  Vector v{}, tangent{};
  double det = 0;
};

class LimitSearch {
 public:
  // sign: of the determinant on the stable branch.
  LimitSearch(double theta1, double theta2, double sign)
      : theta1_(theta1), theta2_(theta2), sign_(sign) {}

  // Walks from a point of the stable branch toward larger heights until it is stable no more.
  Limit from(const Unknowns& x, double height) const {
    const Vector start = pack(x, height);
    Solved here = correct(start, start, {0, 0, 0, 1}, 0);
    if (!here.ok) return {};
    double length = 0.1;
    for (int k = 0; k < 3000; ++k) {
      const Solved next =
          correct(along(here.v, here.tangent, length), here.v, here.tangent, length);
      double turn = 0;
      if (next.ok) {
        for (int j = 0; j < 4; ++j) turn += next.tangent[j] * here.tangent[j];
      }
      // Where a fold and a pitchfork lie close together the determinant changes sign twice: the
      // fold alone turns the height round, so such a step is too long.
      // Only equal angles lose stability while the height still grows. Nearly equal ones turn round
      // just before: a step that changes the sign without turning has jumped to the other branch.
      const bool folded = next.ok && next.tangent[3] * here.tangent[3] < 0;
      const bool unstable = next.det * sign_ <= 0;
      if (!next.ok || turn < 0.95 || (folded && !unstable) ||
          (unstable && !folded && theta1_ != theta2_)) {
        length *= 0.5;
        if (length < 1e-10) return {};
        continue;
      }
      if (unstable) {
        return theta1_ == theta2_ && !folded ? pitchfork() : fold(here, next, length);
      }
      here = next;
      if (turn > 0.995) length = std::min(1.5 * length, 0.2);
    }
    return {};
  }

 private:
  // Newton from v to the point of the branch at `length` along `tangent` from `base`.
  Solved correct(Vector v, const Vector& base, const Vector& tangent, double length) const {
    Solved s;
    double last = 1e300;
    for (int k = 0; k < 25; ++k) {
      const Unknowns x = unpack(v);
      const double h = std::exp(v[3]);
      if (!usable(x) || !std::isfinite(h)) return s;
      const Profile q = profile(x, theta1_);
      const System system = plate_system(q, theta2_, h);
      std::array<std::array<double, 4>, 4> a{};
      Vector step{};
      for (int i = 0; i < 3; ++i) {
        a[i] = {system.jacobian[i][0] * x.r1, system.jacobian[i][1], system.jacobian[i][2] * x.arc,
                i == 1 ? -h : 0.0};
        step[i] = system.residual[i];
      }
      a[3] = tangent;
      step[3] = -length;
      for (int j = 0; j < 4; ++j) step[3] += tangent[j] * (v[j] - base[j]);
      if (numerics::solve<4>(a, step) == 0) return s;
      double size = 0;
      for (int j = 0; j < 4; ++j) {
        v[j] -= step[j];
        size = std::max(size, std::abs(step[j]));
      }
      if (size > 2) return s;
      if ((size < 1e-8 && size < 1e-4 * last) || (size < 1e-10 && size >= 0.5 * last)) {
        std::array<double, 3> unused = system.residual;
        s.det = numerics::solve<3>(system.jacobian, unused);
        Vector next{0, 0, 0, 1};
        if (numerics::solve<4>(a, next) == 0) return s;
        double norm = 0;
        for (double t : next) norm += t * t;
        for (int j = 0; j < 4; ++j) s.tangent[j] = next[j] / std::sqrt(norm);
        s.v = v;
        s.ok = true;
        return s;
      }
      last = size;
    }
    return s;
  }

  // Equal angles become unstable when the contact lines turn into inflections, p = sin / r1. Then
  // w = 0 at half the arc, at p s = theta.
  Limit pitchfork() const {
    const Unknowns x{1, std::sin(theta1_), 2 * theta1_ / std::sin(theta1_)};
    const Profile q = profile(x, theta1_);
    const double size = std::cbrt(q.volume);
    return {true, q.height / size, {x.r1 / size, x.p * size, x.arc / size}, true};
  }

  // Bisection on the determinant over the arclength between two points, then linear interpolation.
  Limit fold(const Solved& here, const Solved& next, double length) const {
    double lo = 0, hi = length;
    Solved below = here, above = next;
    for (int i = 0; i < 60 && hi - lo > 1e-5; ++i) {
      Solved s;
      double at = lo;
      for (double share : {0.5, 0.37, 0.61}) {  // another place where Newton fails
        at = lo + share * (hi - lo);
        s = correct(along(here.v, here.tangent, at), here.v, here.tangent, at);
        if (s.ok) break;
      }
      if (!s.ok) break;
      (s.det * sign_ > 0 ? lo : hi) = at;
      (s.det * sign_ > 0 ? below : above) = s;
    }
    const double share = below.det / (below.det - above.det);
    Vector at{};
    for (int j = 0; j < 4; ++j) at[j] = below.v[j] + share * (above.v[j] - below.v[j]);
    return {true, std::exp(at[3]), unpack(at), false};
  }

  double theta1_, theta2_, sign_;
};

}  // namespace

Limit Branch::limit() {
  if (!valid_) return {};
  go_to(0.25);  // as far as it gets: the slab's large pressures make short steps
  const Limit found = LimitSearch(theta1_, theta2_, sign_).from(at_, height_);
  // Between nearly equal angles fold and pitchfork may lie too close to be told apart, and need not
  // be.
  constexpr double kEqual = 1e-4;  // [rad]
  const double both = 0.5 * (theta1_ + theta2_);
  if (found.found || theta1_ == theta2_ || std::abs(theta1_ - theta2_) > kEqual) return found;
  return Branch(both, both).limit();
}

}  // namespace papilla::capillary::bridge_branch
