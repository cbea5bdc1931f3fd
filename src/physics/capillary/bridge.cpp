#include "physics/capillary/bridge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/constants.h"
#include "base/quadrature.h"
#include "physics/capillary/bridge_branch.h"
#include "physics/capillary/water.h"

namespace papilla {

namespace bridge_branch {
namespace {

double sinc(double x) {
  return std::abs(x) < 1e-3 ? 1 - x * x / 6 + x * x * x * x / 120 : std::sin(x) / x;
}
double sinc_slope(double x) {
  return std::abs(x) < 1e-2 ? x * (-1.0 / 3 + x * x / 30 - x * x * x * x / 840)
                            : (std::cos(x) - std::sin(x) / x) / x;
}
// (1 - cos x) / x and its slope
double cosc(double x) { return std::sin(0.5 * x) * sinc(0.5 * x); }
double cosc_slope(double x) {
  return std::abs(x) < 1e-2 ? 0.5 - x * x / 8 + x * x * x * x / 144 : (std::sin(x) - cosc(x)) / x;
}

// A point of the meridian (r cos phi, r sin phi) = (w, u) and its derivatives by (r1, p, s).
struct Point {
  double w, u;
  std::array<double, 3> dw, du;
};

Point point(const Unknowns& x, double cos1, double sin1, double s) {
  const double a = x.p * s, c = std::cos(a), n = std::sin(a);
  const double w1 = -x.r1 * cos1, u1 = x.r1 * sin1;
  Point q;
  q.w = w1 * c - u1 * n + s * sinc(a);
  q.u = u1 * c + w1 * n + s * cosc(a);
  q.dw = {-cos1 * c - sin1 * n, -s * (w1 * n + u1 * c) + s * s * sinc_slope(a), 1 - x.p * q.u};
  q.du = {sin1 * c - cos1 * n, s * (w1 * c - u1 * n) + s * s * cosc_slope(a), x.p * q.w};
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
    const double r = std::hypot(q.w, q.u);
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

namespace {

// Gaussian elimination with partial pivoting; returns the determinant.
template <std::size_t N>
double solve(std::array<std::array<double, N>, N> a, std::array<double, N>& b) {
  double determinant = 1;
  for (std::size_t k = 0; k < N; ++k) {
    std::size_t pivot = k;
    for (std::size_t i = k + 1; i < N; ++i) {
      if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
    }
    if (pivot != k) {
      std::swap(a[k], a[pivot]);
      std::swap(b[k], b[pivot]);
      determinant = -determinant;
    }
    determinant *= a[k][k];
    if (a[k][k] == 0) return 0;
    for (std::size_t i = k + 1; i < N; ++i) {
      const double m = a[i][k] / a[k][k];
      for (std::size_t j = k; j < N; ++j) a[i][j] -= m * a[k][j];
      b[i] -= m * b[k];
    }
  }
  for (std::size_t k = N; k-- > 0;) {
    for (std::size_t j = k + 1; j < N; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return determinant;
}

// Residuals {angle at plate 2, height, volume} and their Jacobian, for volume 1.
struct System {
  std::array<double, 3> residual;
  std::array<std::array<double, 3>, 3> jacobian;
};

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

}  // namespace

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
    if (size < 1e-15 || (size < 1e-11 && size >= 0.5 * last)) {
      // The angle's equation also holds for the opposite direction: that is another surface.
      const Profile end = profile(x, theta1);
      if (!usable(x) || end.w * std::cos(theta2) + end.u * std::sin(theta2) <= 0)
        return std::nullopt;
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
    const double chord = s * sinc(0.5 * bend * s);
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

Limit Branch::limit() {
  // Pseudo-arclength along the branch: unknowns (log r1, p, log arc, log height), the determinant
  // of the three equations at fixed height changes sign at the stability limit, fold or pitchfork.
  Limit out;
  if (!valid_) return out;
  go_to(0.25);  // as far as it gets: the slab's large pressures make short steps
  using Vector = std::array<double, 4>;
  const auto pack = [](const Unknowns& x, double h) {
    return Vector{std::log(x.r1), x.p, std::log(x.arc), std::log(h)};
  };
  const auto unpack = [](const Vector& v) {
    return Unknowns{std::exp(v[0]), v[1], std::exp(v[2])};
  };
  struct Solved {
    bool ok = false;
    Vector v{}, tangent{};
    double det = 0;
  };
  const auto correct = [&](Vector v, const Vector& base, const Vector& tangent, double length) {
    Solved s;
    double last = 1e300;
    for (int k = 0; k < 25; ++k) {
      const Unknowns x = unpack(v);
      const double h = std::exp(v[3]);
      if (!usable(x) || !std::isfinite(h)) return s;
      const Profile q = profile(x, theta1_);
      const System system = plate_system(q, theta2_, h);
      std::array<std::array<double, 4>, 4> a{};
      Vector b{};
      for (int i = 0; i < 3; ++i) {
        a[i] = {system.jacobian[i][0] * x.r1, system.jacobian[i][1], system.jacobian[i][2] * x.arc,
                i == 1 ? -h : 0.0};
        b[i] = system.residual[i];
      }
      a[3] = tangent;
      b[3] = -length;
      for (int j = 0; j < 4; ++j) b[3] += tangent[j] * (v[j] - base[j]);
      Vector step = b;
      if (solve<4>(a, step) == 0) return s;
      double size = 0;
      for (int j = 0; j < 4; ++j) {
        v[j] -= step[j];
        size = std::max(size, std::abs(step[j]));
      }
      if (size > 2) return s;
      if (size < 1e-14 || (size < 1e-10 && size >= 0.5 * last)) {
        std::array<double, 3> unused = system.residual;
        s.det = solve<3>(system.jacobian, unused);
        Vector next{0, 0, 0, 1};
        if (solve<4>(a, next) == 0) return s;
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
  };
  // The first tangent: toward larger heights.
  Solved here = correct(pack(at_, height_), pack(at_, height_), {0, 0, 0, 1}, 0);
  if (!here.ok) return out;
  double length = 0.1;
  for (int k = 0; k < 3000; ++k) {
    Vector guess = here.v;
    for (int j = 0; j < 4; ++j) guess[j] += length * here.tangent[j];
    const Solved next = correct(guess, here.v, here.tangent, length);
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
      if (length < 1e-10) return out;
      continue;
    }
    if (!unstable) {
      here = next;
      if (turn > 0.995) length = std::min(1.5 * length, 0.2);
      continue;
    }
    out.found = true;
    if (theta1_ == theta2_ && !folded) {
      // Equal angles become unstable when the contact lines turn into inflections, p = sin / r1.
      // Then w = 0 at half the arc, at p s = theta.
      Unknowns x{1, std::sin(theta1_), 2 * theta1_ / std::sin(theta1_)};
      const Profile q = profile(x, theta1_);
      const double size = std::cbrt(q.volume);
      out.pitchfork = true;
      out.height = q.height / size;
      out.at = {x.r1 / size, x.p * size, x.arc / size};
      return out;
    }
    // A fold: bisection on the determinant over the arclength, then linear interpolation.
    double lo = 0, hi = length;
    Solved below = here, above = next;
    for (int i = 0; i < 60 && hi - lo > 1e-5; ++i) {
      Solved s;
      double at = lo;
      for (double share : {0.5, 0.37, 0.61}) {
        at = lo + share * (hi - lo);
        for (int j = 0; j < 4; ++j) guess[j] = here.v[j] + at * here.tangent[j];
        s = correct(guess, here.v, here.tangent, at);
        if (s.ok) break;
      }
      if (!s.ok) break;
      (s.det * sign_ > 0 ? lo : hi) = at;
      (s.det * sign_ > 0 ? below : above) = s;
    }
    const double share = below.det / (below.det - above.det);
    Vector at{};
    for (int j = 0; j < 4; ++j) at[j] = below.v[j] + share * (above.v[j] - below.v[j]);
    out.height = std::exp(at[3]);
    out.at = unpack(at);
    return out;
  }
  return out;
}

}  // namespace bridge_branch

namespace {

bool angle(double theta) { return theta >= 0 && theta <= kPi; }

}  // namespace

std::string_view text(BridgeStatus status) {
  switch (status) {
    case BridgeStatus::Converged:
      return "converged";
    case BridgeStatus::Ruptured:
      return "ruptured";
    case BridgeStatus::NotConverged:
      return "not converged";
    case BridgeStatus::Invalid:
      return "invalid";
  }
  return "";
}

Bridge solve_bridge(double volume, double gap, double theta1, double theta2,
                    double surface_tension) {
  using namespace bridge_branch;
  Bridge out;
  if (!(volume > 0 && gap > 0 && surface_tension > 0 && angle(theta1) && angle(theta2) &&
        std::isfinite(volume + gap + surface_tension))) {
    return out;
  }
  out.status = BridgeStatus::NotConverged;
  const double size = std::cbrt(volume), h = gap / size;
  Branch branch(theta1, theta2);
  if (!branch.valid()) return out;
  if (!branch.go_to(h)) {
    const Limit limit = Branch(theta1, theta2).limit();
    if (limit.found && h > limit.height * (1 - 1e-7)) out.status = BridgeStatus::Ruptured;
    return out;
  }
  const Unknowns& x = branch.at();
  const Profile q = profile(x, theta1);
  out.status = BridgeStatus::Converged;
  out.energy = surface_tension * size * size * energy(x, theta1, theta2);
  out.force = surface_tension * size * force(x, theta1);
  out.pressure = surface_tension / size * x.p;
  out.radius1 = size * x.r1;
  out.radius2 = size * q.r2;
  out.free_area = size * size * q.free_area;
  out.arc = size * x.arc;
  return out;
}

Bridge solve_sphere_bridge(double volume, double distance, double sphere_radius, double theta_plate,
                           double theta_sphere, double surface_tension) {
  using namespace bridge_branch;
  Bridge out;
  if (!(volume > 0 && distance >= 0 && sphere_radius > 0 && surface_tension > 0 &&
        angle(theta_plate) && angle(theta_sphere) &&
        std::isfinite(volume + distance + sphere_radius + surface_tension))) {
    return out;
  }
  out.status = BridgeStatus::NotConverged;
  const double size = std::cbrt(volume), d = distance / size, radius = sphere_radius / size;
  // Start: a disc of the parabolic gap, its edge a slab of the local opening.
  const double a = std::sqrt(2 * radius * (std::sqrt(d * d + 1 / (kPi * radius)) - d));
  double beta = std::min(a / radius, 1.0);
  const double edge = d + radius * (1 - std::cos(beta));
  Unknowns x = slab_guess(edge, theta_plate, std::min(theta_sphere + beta, kPi));
  x.r1 = a;
  x.p += 1 / a - std::sqrt(kPi * edge);
  double last = 1e300;
  for (int k = 0; k < 100; ++k) {
    const Profile q = profile(x, theta_plate);
    const double psi = theta_sphere + beta, c = std::cos(psi), s = std::sin(psi);
    const double cb = std::cos(beta), sb = std::sin(beta);
    const double dipped = kPi * radius * radius * radius * (2 - 3 * cb + cb * cb * cb) / 3;
    std::array<double, 4> step = {q.w * s - q.u * c, q.height - d - radius * (1 - cb),
                                  q.volume - dipped - 1, q.r2 - radius * sb};
    std::array<std::array<double, 4>, 4> j;
    for (int i = 0; i < 3; ++i) {
      j[0][i] = q.w_slope[i] * s - q.u_slope[i] * c;
      j[1][i] = q.height_slope[i];
      j[2][i] = q.volume_slope[i];
      j[3][i] = (q.w * q.w_slope[i] + q.u * q.u_slope[i]) / q.r2;
    }
    j[0][3] = q.w * c + q.u * s;
    j[1][3] = -radius * sb;
    j[2][3] = -kPi * radius * radius * radius * sb * sb * sb;
    j[3][3] = -radius * cb;
    if (solve<4>(j, step) == 0) return out;
    double shrink = 1;
    shrink = std::min(shrink, 0.3 * x.r1 / std::max(std::abs(step[0]), 1e-300));
    shrink = std::min(shrink, 0.5 * (1 + std::abs(x.p)) / std::max(std::abs(step[1]), 1e-300));
    shrink = std::min(shrink, 0.3 * x.arc / std::max(std::abs(step[2]), 1e-300));
    shrink = std::min(shrink, 0.3 * beta / std::max(std::abs(step[3]), 1e-300));
    x.r1 -= shrink * step[0];
    x.p -= shrink * step[1];
    x.arc -= shrink * step[2];
    beta -= shrink * step[3];
    if (!usable(x) || !(beta > 0 && beta < kPi)) return out;
    const double change =
        std::max({std::abs(step[0]) / x.r1, std::abs(step[1]) / (1 + std::abs(x.p)),
                  std::abs(step[2]) / x.arc, std::abs(step[3]) / beta});
    if (change < 1e-15 || (change < 1e-10 && change >= 0.5 * last)) {
      const Profile end = profile(x, theta_plate);
      if (end.w * std::cos(theta_sphere + beta) + end.u * std::sin(theta_sphere + beta) <= 0) {
        return out;
      }
      out.status = BridgeStatus::Converged;
      const double wet_sphere = 2 * kPi * radius * radius * (1 - std::cos(beta));
      out.energy = surface_tension * size * size *
                   (end.free_area - kPi * x.r1 * x.r1 * std::cos(theta_plate) -
                    wet_sphere * std::cos(theta_sphere));
      out.force = surface_tension * size * force(x, theta_plate);
      out.pressure = surface_tension / size * x.p;
      out.radius1 = size * x.r1;
      out.radius2 = size * end.r2;
      out.free_area = size * size * end.free_area;
      out.arc = size * x.arc;
      return out;
    }
    last = change;
  }
  return out;
}

BridgeLimits bridge_limits(double theta1, double theta2) {
  using namespace bridge_branch;
  BridgeLimits out;
  if (!angle(theta1) || !angle(theta2)) return out;
  out.status = BridgeStatus::NotConverged;
  const CapShape cap = cap_shape(std::min(theta1, theta2));
  out.snap_in = cap.height;
  const Limit limit = Branch(theta1, theta2).limit();
  if (!limit.found) return out;
  const Branch branch(theta1, theta2);
  out.status = BridgeStatus::Converged;
  out.rupture = limit.height;
  out.pitchfork = limit.pitchfork;
  // Height at which a function of the branch changes sign, between two heights of opposite sign.
  const auto root = [&](auto&& f, double lo, double hi) {
    Branch walk(theta1, theta2);
    for (int k = 0; k < 60 && hi - lo > 1e-12 * hi; ++k) {
      const double middle = 0.5 * (lo + hi);
      if (!walk.go_to(middle)) return 0.0;
      (f(walk.at()) < 0 ? lo : hi) = middle;
    }
    return 0.5 * (lo + hi);
  };
  const auto surplus = [&](const Unknowns& x) { return energy(x, theta1, theta2) - cap.energy; };
  const auto pull = [&](const Unknowns& x) { return force(x, theta1); };
  const double first = branch.height();  // the start of the branch: a thin slab
  double floor = first;
  if (pull(branch.at()) < 0) {
    floor = force(limit.at, theta1) > 0 ? root(pull, first, limit.height) : limit.height;
    out.zero_force = floor < limit.height ? floor : 0;
  }
  Branch low(theta1, theta2);
  if (floor < limit.height && low.go_to(floor) && surplus(low.at()) < 0 && surplus(limit.at) > 0) {
    out.switching = root(surplus, floor, limit.height);
  }
  return out;
}

}  // namespace papilla
