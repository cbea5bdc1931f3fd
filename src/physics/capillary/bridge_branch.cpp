#include "physics/capillary/bridge_branch.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/quadrature.h"
#include "physics/capillary/bridge_system.h"
#include "physics/capillary/water.h"

namespace papilla::capillary::bridge_branch {
namespace {

// sin a / a, (1 - cos a) / a and their slopes, of one sine and one cosine of a / 2.
struct Turn {
  explicit Turn(double a) {
    const double half = 0.5 * a, sine = std::sin(half);
    const double versine = 2 * sine * sine;  // 1 - cos a
    cos = 1 - versine;
    sin = 2 * sine * std::cos(half);
    const double near = a * a;
    if (near > 1e-4) {
      sinc = sin / a;
      cosc = versine / a;
      sinc_slope = (cos - sinc) / a;
      cosc_slope = (sin - cosc) / a;
    } else {
      sinc = 1 - near / 6 * (1 - near / 20);
      cosc = a * (0.5 - near / 24 * (1 - near / 30));
      sinc_slope = a * (-1.0 / 3 + near / 30 * (1 - near / 28));
      cosc_slope = 0.5 - near / 8 * (1 - near / 18);
    }
  }
  double sin, cos, sinc, cosc, sinc_slope, cosc_slope;
};

// A point of the meridian (r cos phi, r sin phi) = (w, u) and its derivatives by (r1, p, s).
struct Point {
  double w, u;
  std::array<double, 3> dw, du;
};

Point point(const Unknowns& x, double cos1, double sin1, double s) {
  const Turn turn(x.p * s);
  const double c = turn.cos, n = turn.sin;
  const double w1 = -x.r1 * cos1, u1 = x.r1 * sin1;
  Point q;
  q.w = w1 * c - u1 * n + s * turn.sinc;
  q.u = u1 * c + w1 * n + s * turn.cosc;
  q.dw = {-cos1 * c - sin1 * n, -s * (w1 * n + u1 * c) + s * s * turn.sinc_slope, 1 - x.p * q.u};
  q.du = {sin1 * c - cos1 * n, s * (w1 * c - u1 * n) + s * s * turn.cosc_slope, x.p * q.w};
  return q;
}

}  // namespace

Profile profile(const Unknowns& x, double theta1) {
  static const Quadrature gauss = gauss_legendre(48, 0, 1);
  const double cos1 = std::cos(theta1), sin1 = std::sin(theta1);
  Profile out;
  for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
    const double t = gauss.nodes[k], weight = gauss.weights[k] * x.arc;
    const Point q = point(x, cos1, sin1, t * x.arc);
    const double r = std::sqrt(q.w * q.w + q.u * q.u);
    out.height += weight * q.u / r;
    out.volume += weight * kPi * r * q.u;
    out.free_area += weight * 2 * kPi * r;
    for (int i = 0; i < 3; ++i) {
      const double chain = i == 2 ? t : 1.0;
      const double dw = q.dw[i] * chain, du = q.du[i] * chain;
      const double dr = (q.w * dw + q.u * du) / r;
      out.height_slope[i] += weight * (du - q.u * dr / r) / r;
      out.volume_slope[i] += weight * kPi * (dr * q.u + r * du);
    }
    out.height_slope[2] += weight / x.arc * q.u / r;
    out.volume_slope[2] += weight / x.arc * kPi * r * q.u;
  }
  const Point end = point(x, cos1, sin1, x.arc);
  out.w = end.w;
  out.u = end.u;
  out.w_slope = end.dw;
  out.u_slope = end.du;
  out.r2 = std::hypot(end.w, end.u);
  return out;
}

System plate_system(const Profile& q, double theta2, double height) {
  const double c = std::cos(theta2), s = std::sin(theta2);
  System out;
  out.residual = {q.w * s - q.u * c, q.height - height, q.volume - 1};
  for (int i = 0; i < 3; ++i) {
    out.jacobian[0][i] = q.w_slope[i] * s - q.u_slope[i] * c;
    out.jacobian[1][i] = q.height_slope[i];
    out.jacobian[2][i] = q.volume_slope[i];
  }
  return out;
}

bool usable(const Unknowns& x) {
  return std::isfinite(x.r1) && std::isfinite(x.p) && std::isfinite(x.arc) && x.arc > 0 && x.r1 > 0;
}

std::optional<Unknowns> newton(Unknowns x, double theta1, double theta2, double height,
                               double* determinant) {
  double last = 1e300;
  for (int k = 0; k < 40; ++k) {
    if (!usable(x)) return std::nullopt;
    const Profile q = profile(x, theta1);
    System system = plate_system(q, theta2, height);
    std::array<double, 3> step = system.residual;
    const double det = solve<3>(system.jacobian, step);
    if (!(std::abs(det) > 0)) return std::nullopt;
    double shrink = 1;
    shrink = std::min(shrink, 0.5 * x.r1 / std::max(std::abs(step[0]), 1e-300));
    shrink = std::min(shrink, 0.5 * x.arc / std::max(std::abs(step[2]), 1e-300));
    shrink = std::min(shrink, (1 + std::abs(x.p)) / std::max(std::abs(step[1]), 1e-300));
    shrink = std::min(shrink, 1.0);
    x.r1 -= shrink * step[0];
    x.p -= shrink * step[1];
    x.arc -= shrink * step[2];
    const double size = std::max({std::abs(step[0]) / x.r1, std::abs(step[1]) / (1 + std::abs(x.p)),
                                  std::abs(step[2]) / x.arc});
    // Converging quadratically, the next step would be below rounding; or rounding is reached.
    if ((size < 1e-8 && size < 1e-4 * last) || (size < 1e-11 && size >= 0.5 * last)) {
      // The angle's equation also holds for the opposite direction: that is another surface.
      if (!usable(x)) return std::nullopt;
      const Point end = point(x, std::cos(theta1), std::sin(theta1), x.arc);
      if (end.w * std::cos(theta2) + end.u * std::sin(theta2) <= 0) return std::nullopt;
      if (determinant) *determinant = det;
      return x;
    }
    last = size;
  }
  return std::nullopt;
}

double force(const Unknowns& x, double theta1) {
  return 2 * kPi * (x.r1 * std::sin(theta1) - 0.5 * x.p * x.r1 * x.r1);
}

double energy(const Unknowns& x, double theta1, double theta2) {
  const Profile q = profile(x, theta1);
  return q.free_area - kPi * (x.r1 * x.r1 * std::cos(theta1) + q.r2 * q.r2 * std::cos(theta2));
}

Unknowns slab_guess(double height, double theta1, double theta2) {
  const double u = kPi / 2 - 0.5 * (theta1 + theta2), d = 0.5 * (theta1 - theta2);
  const double spread = std::max(std::cos(d), 1e-3);
  const double arc = height * (std::abs(u) < 1e-8 ? 1 : u / std::sin(u)) / spread;
  const double mean = std::sqrt(1 / (kPi * height));
  // The volume fixes the mean radius; the meniscus (a circular arc) stands off the plates by depth:
  // its mean offset from plate 1, to first order in the height.
  const double bend = -2 * u / arc;  // curvature of the arc
  double offset = 0;
  const Quadrature gauss = gauss_legendre(8, 0, arc);
  for (std::size_t k = 0; k < gauss.nodes.size(); ++k) {
    const double s = gauss.nodes[k], phi = kPi - theta1 + bend * s;
    const double along = kPi - theta1 + 0.5 * bend * s;  // chord direction of a circular arc
    const double chord = s * Turn(0.5 * bend * s).sinc;
    offset += gauss.weights[k] * chord * std::cos(along) * std::sin(phi) / height;
  }
  Unknowns x;
  x.r1 = std::max(mean - offset, 0.2 * mean);
  x.p = bend + meniscus_factor(theta1, theta2) / mean;
  x.arc = arc;
  return x;
}

Branch::Branch(double theta1, double theta2) : theta1_(theta1), theta2_(theta2) {
  for (double h : {0.05, 0.02, 0.008, 0.003}) {
    double det = 0;
    const auto x = newton(slab_guess(h, theta1, theta2), theta1, theta2, h, &det);
    if (!x) continue;
    at_ = *x;
    height_ = h;
    sign_ = det > 0 ? 1 : -1;
    valid_ = true;
    return;
  }
}

bool Branch::go_to(double height) {
  if (!valid_) return false;
  if (height < height_) {  // toward the slab the guess only gets better
    double det = 0;
    if (height <= 0.05) {
      const auto x = newton(slab_guess(height, theta1_, theta2_), theta1_, theta2_, height, &det);
      if (x && det * sign_ > 0) return accept(*x, height);
    }
  }
  double factor = 1.3;
  for (int k = 0; k < 400 && height_ != height; ++k) {
    const double ratio = std::clamp(height / height_, 1 / factor, factor);
    const double next =
        std::abs(std::log(height / height_)) <= std::log(factor) ? height : height_ * ratio;
    Unknowns guess = at_;
    if (has_previous_) {  // secant in the logarithm of the height
      const double t = std::log(next / height_) / std::log(height_ / previous_height_);
      if (std::abs(t) < 4) {
        guess.r1 = at_.r1 * std::pow(at_.r1 / previous_.r1, t);
        guess.arc = at_.arc * std::pow(at_.arc / previous_.arc, t);
        guess.p = at_.p + t * (at_.p - previous_.p);
      }
    }
    double det = 0;
    const auto x = newton(guess, theta1_, theta2_, next, &det);
    const bool near = x && std::abs(std::log(x->r1 / guess.r1)) < 0.3;
    if (x && near && det * sign_ > 0) {
      accept(*x, next);
      factor = std::min(1.3, factor * factor);
    } else {
      factor = std::sqrt(factor);
      if (factor < 1 + 1e-9) return false;
    }
  }
  return height_ == height;
}

bool Branch::accept(const Unknowns& x, double height) {
  if (height != height_) {
    previous_ = at_;
    previous_height_ = height_;
    has_previous_ = true;
  }
  at_ = x;
  height_ = height;
  return true;
}

}  // namespace papilla::capillary::bridge_branch
