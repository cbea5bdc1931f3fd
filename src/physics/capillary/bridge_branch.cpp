#include "physics/capillary/bridge_branch.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/constants.h"
#include "numerics/loops.h"
#include "numerics/quadrature.h"
#include "physics/capillary/bridge_system.h"
#include "physics/capillary/water.h"

namespace papilla::capillary::bridge_branch {
namespace {

// sin a / a, (1 - cos a) / a and their slopes, of one sine and one cosine of a / 2. Of one number
// or of several.
template <class T>
struct Turn {
  Turn(const T& a, const T& sine_of_half, const T& cosine_of_half) {
    const T versine = 2 * sine_of_half * sine_of_half;  // 1 - cos a
    cos = 1 - versine;
    sin = 2 * sine_of_half * cosine_of_half;
    const T near = a * a;
    const auto far = near > 1e-4;  // elsewhere series: differences of near numbers
    sinc = chosen(far, sin / a, 1 - near / 6 * (1 - near / 20));
    cosc = chosen(far, versine / a, a * (0.5 - near / 24 * (1 - near / 30)));
    sinc_slope = chosen(far, (cos - sinc) / a, a * (-1.0 / 3 + near / 30 * (1 - near / 28)));
    cosc_slope = chosen(far, (sin - cosc) / a, 0.5 - near / 8 * (1 - near / 18));
  }
  T sin, cos, sinc, cosc, sinc_slope, cosc_slope;
};

Turn<double> turn_by(double a) { return {a, std::sin(0.5 * a), std::cos(0.5 * a)}; }

// Points of the meridian (r cos phi, r sin phi) = (w, u) and their derivatives by (r1, p, s).
template <class T>
struct Point {
  T w, u;
  std::array<T, 3> dw, du;
};

// At a distance s along the meridian from plate 1, of contact angle theta1.
template <class T>
Point<T> point(const Unknowns& x, double cos1, double sin1, const T& s, const Turn<T>& turn) {
  const T &c = turn.cos, &n = turn.sin;
  const double w1 = -x.r1 * cos1, u1 = x.r1 * sin1;
  Point<T> q;
  q.w = w1 * c - u1 * n + s * turn.sinc;
  q.u = u1 * c + w1 * n + s * turn.cosc;
  q.dw = {-cos1 * c - sin1 * n, -s * (w1 * n + u1 * c) + s * s * turn.sinc_slope, 1 - x.p * q.u};
  q.du = {sin1 * c - cos1 * n, s * (w1 * c - u1 * n) + s * s * turn.cosc_slope, x.p * q.w};
  return q;
}

Point<double> end_of(const Unknowns& x, double cos1, double sin1) {
  return point(x, cos1, sin1, x.arc, turn_by(x.p * x.arc));
}

}  // namespace

Profile profile(const Unknowns& x, double theta1) {
  constexpr std::size_t kNodes = 48;
  static const Quadrature gauss = gauss_legendre(kNodes, 0, 1);
  const double cos1 = std::cos(theta1), sin1 = std::sin(theta1);
  std::array<double, kNodes> sine, cosine;  // of half the turn
  for (std::size_t k = 0; k < kNodes; ++k) {
    const double half = 0.5 * x.p * x.arc * gauss.nodes[k];
    sine[k] = std::sin(half);
    cosine[k] = std::cos(half);
  }
  const auto [height, volume, area, height_slope, volume_slope] = reduce(kNodes, [&](auto at) {
    const auto t = at(gauss.nodes), weight = at(gauss.weights) * x.arc, s = t * x.arc;
    using T = std::decay_t<decltype(s)>;
    const Point<T> q = point(x, cos1, sin1, s, Turn<T>(x.p * s, at(sine), at(cosine)));
    const T r = root(q.w * q.w + q.u * q.u), per = 1 / r, climb = q.u * per;
    std::array<T, 3> climb_slope, volume_slope_here;
    for (std::size_t i = 0; i < 3; ++i) {
      const T dw = i == 2 ? q.dw[i] * t : q.dw[i], du = i == 2 ? q.du[i] * t : q.du[i];
      const T dr = (q.w * dw + q.u * du) * per;
      climb_slope[i] = weight * (du - climb * dr) * per;
      volume_slope_here[i] = weight * (dr * q.u + r * du);
    }
    return std::tuple(weight * climb, weight * r * q.u, weight * r, climb_slope, volume_slope_here);
  });
  Profile out;
  out.height = height;
  out.volume = kPi * volume;
  out.free_area = 2 * kPi * area;
  for (std::size_t i = 0; i < 3; ++i) {
    out.height_slope[i] = height_slope[i];
    out.volume_slope[i] = kPi * volume_slope[i];
  }
  out.height_slope[2] += out.height / x.arc;  // the weights grow with the arc
  out.volume_slope[2] += out.volume / x.arc;
  const Point<double> end = end_of(x, cos1, sin1);
  out.w = end.w;
  out.u = end.u;
  out.w_slope = end.dw;
  out.u_slope = end.du;
  out.r2 = std::sqrt(end.w * end.w + end.u * end.u);
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
    const double det = numerics::solve<3>(system.jacobian, step);
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
      const Point<double> end = end_of(x, std::cos(theta1), std::sin(theta1));
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
    const double chord = s * turn_by(0.5 * bend * s).sinc;
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
