#include "physics/capillary/bridge.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/constants.h"
#include "physics/capillary/bridge_branch.h"
#include "physics/capillary/bridge_system.h"
#include "physics/capillary/water.h"

namespace papilla::capillary {
namespace {

using namespace bridge_branch;

bool angle(double theta) { return theta >= 0 && theta <= kPi; }

// Water that wholly wets the one plate and wholly keeps off the other spreads on the one: as the
// angles come near to that, the largest gap with a bridge goes to zero (0.5 % of the drop at 1 and
// 180 deg).
bool held_apart(double theta1, double theta2) {
  constexpr double kWholly = 0.01;  // [rad]
  return std::min(theta1, theta2) < kWholly && std::max(theta1, theta2) > kPi - kWholly;
}

// A plate below, a sphere above; lengths per volume^(1/3), tension 1.
class SphereBridge {
 public:
  SphereBridge(double distance, double radius, double theta_plate, double theta_sphere)
      : distance_(distance), radius_(radius), plate_(theta_plate), sphere_(theta_sphere) {
    // Start: a disc of the parabolic gap, its edge a slab of the local opening.
    const double a =
        std::sqrt(2 * radius * (std::sqrt(distance * distance + 1 / (kPi * radius)) - distance));
    beta_ = std::min(a / radius, 1.0);
    const double edge = distance + radius * (1 - std::cos(beta_));
    x_ = slab_guess(edge, theta_plate, std::min(theta_sphere + beta_, kPi));
    x_.r1 = a;
    x_.p += 1 / a - std::sqrt(kPi * edge);
  }

  // Newton on (r1, p, arc, beta). False: it fails or finds another surface.
  bool solve() {
    double last = 1e300;
    for (int k = 0; k < 100; ++k) {
      const double change = step();
      if (!(change >= 0)) return false;
      if (change < 1e-15 || (change < 1e-10 && change >= 0.5 * last)) {
        end_ = profile(x_, plate_);
        const double psi = sphere_ + beta_;
        return end_.w * std::cos(psi) + end_.u * std::sin(psi) > 0;
      }
      last = change;
    }
    return false;
  }

  const Unknowns& at() const { return x_; }
  const Profile& end() const { return end_; }
  double energy() const {
    const double wet_sphere = 4 * kPi * square(radius_ * std::sin(0.5 * beta_));
    return end_.free_area - kPi * x_.r1 * x_.r1 * std::cos(plate_) - wet_sphere * std::cos(sphere_);
  }

 private:
  // Returns the largest relative change; negative where there is no way on.
  double step() {
    const Profile q = profile(x_, plate_);
    const double psi = sphere_ + beta_, c = std::cos(psi), s = std::sin(psi);
    const double cb = std::cos(beta_), sb = std::sin(beta_), radius = radius_;
    const double rise = 2 * square(std::sin(0.5 * beta_));  // 1 - cb, of large spheres too
    const double dipped = kPi * radius * radius * radius * square(rise) * (2 + cb) / 3;
    std::array<double, 4> step = {q.w * s - q.u * c, q.height - distance_ - radius * rise,
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
    if (numerics::solve<4>(j, step) == 0) return -1;
    double shrink = 1;
    shrink = std::min(shrink, 0.3 * x_.r1 / std::max(std::abs(step[0]), 1e-300));
    shrink = std::min(shrink, 0.5 * (1 + std::abs(x_.p)) / std::max(std::abs(step[1]), 1e-300));
    shrink = std::min(shrink, 0.3 * x_.arc / std::max(std::abs(step[2]), 1e-300));
    shrink = std::min(shrink, 0.3 * beta_ / std::max(std::abs(step[3]), 1e-300));
    x_.r1 -= shrink * step[0];
    x_.p -= shrink * step[1];
    x_.arc -= shrink * step[2];
    beta_ -= shrink * step[3];
    if (!usable(x_) || !(beta_ > 0 && beta_ < kPi)) return -1;
    return std::max({std::abs(step[0]) / x_.r1, std::abs(step[1]) / (1 + std::abs(x_.p)),
                     std::abs(step[2]) / x_.arc, std::abs(step[3]) / beta_});
  }

  double distance_, radius_, plate_, sphere_;
  Unknowns x_;
  double beta_;  // angle of the contact circle seen from the sphere's centre [rad]
  Profile end_;
};

// In SI units from volume 1 and tension 1; size: volume^(1/3) [m].
Bridge scaled(const Unknowns& x, const Profile& q, double energy, double theta1, double size,
              double surface_tension) {
  Bridge out;
  out.status = BridgeStatus::Converged;
  out.energy = surface_tension * size * size * energy;
  out.force = surface_tension * size * force(x, theta1);
  out.pressure = surface_tension / size * x.p;
  out.radius1 = size * x.r1;
  out.radius2 = size * q.r2;
  out.free_area = size * size * q.free_area;
  out.arc = size * x.arc;
  return out;
}

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
  Bridge out;
  if (!(volume > 0 && gap > 0 && surface_tension > 0 && angle(theta1) && angle(theta2) &&
        std::isfinite(volume + gap + surface_tension))) {
    return out;
  }
  out.status = BridgeStatus::NotConverged;
  const double size = std::cbrt(volume), h = gap / size;
  if (held_apart(theta1, theta2)) {
    out.status = BridgeStatus::Ruptured;
    return out;
  }
  Branch branch(theta1, theta2);
  if (!branch.valid()) return out;
  if (!branch.go_to(h)) {
    const Limit limit = Branch(theta1, theta2).limit();
    if (limit.found && h > limit.height * (1 - 1e-7)) out.status = BridgeStatus::Ruptured;
    return out;
  }
  const Unknowns& x = branch.at();
  return scaled(x, profile(x, theta1), energy(x, theta1, theta2), theta1, size, surface_tension);
}

Bridge solve_sphere_bridge(double volume, double distance, double sphere_radius, double theta_plate,
                           double theta_sphere, double surface_tension) {
  Bridge out;
  if (!(volume > 0 && distance >= 0 && sphere_radius > 0 && surface_tension > 0 &&
        angle(theta_plate) && angle(theta_sphere) &&
        std::isfinite(volume + distance + sphere_radius + surface_tension))) {
    return out;
  }
  out.status = BridgeStatus::NotConverged;
  const double size = std::cbrt(volume);
  SphereBridge bridge(distance / size, sphere_radius / size, theta_plate, theta_sphere);
  if (!bridge.solve()) return out;
  return scaled(bridge.at(), bridge.end(), bridge.energy(), theta_plate, size, surface_tension);
}

BridgeLimits bridge_limits(double theta1, double theta2) {
  Limit end;
  return limits_and_end(theta1, theta2, end);
}

namespace bridge_branch {

BridgeLimits limits_and_end(double theta1, double theta2, Limit& end) {
  BridgeLimits out;
  if (!angle(theta1) || !angle(theta2)) return out;
  out.status = BridgeStatus::NotConverged;
  const CapShape cap = cap_shape(std::min(theta1, theta2));
  out.snap_in = cap.height;
  if (held_apart(theta1, theta2)) {
    out.status = BridgeStatus::Converged;
    return out;
  }
  const Branch branch(theta1, theta2);
  end = Branch(branch).limit();
  if (!end.found) return out;
  out.status = BridgeStatus::Converged;
  out.rupture = end.height;
  out.pitchfork = end.pitchfork;
  const auto surplus = [&](const Unknowns& x) { return energy(x, theta1, theta2) - cap.energy; };
  const auto pull = [&](const Unknowns& x) { return force(x, theta1); };
  // Height at which a function of the branch changes from negative at a place of it to positive at
  // its end: secants of the last two signs, an end that stays counting half (Illinois).
  const auto root = [&](auto&& f, const Branch& from) {
    Branch walk = from;
    double lo = from.height(), below = f(from.at()), hi = end.height, above = f(end.at);
    double last = lo;
    for (int k = 0, side = 0; k < 60; ++k) {
      const double middle = (lo * above - hi * below) / (above - below);
      if (!walk.go_to(middle)) return 0.0;
      if (std::abs(middle - last) < 1e-12 * middle) return middle;
      last = middle;
      const double value = f(walk.at());
      if (value < 0) {
        lo = middle, below = value;
        if (side < 0) above *= 0.5;
        side = -1;
      } else {
        hi = middle, above = value;
        if (side > 0) below *= 0.5;
        side = 1;
      }
    }
    return last;
  };
  Branch low = branch;  // the start of the branch: a thin slab
  if (pull(branch.at()) < 0) {
    if (!(pull(end.at) > 0)) return out;  // repels at all gaps
    out.zero_force = root(pull, branch);
    if (!low.go_to(out.zero_force)) return out;
  }
  if (surplus(low.at()) < 0 && surplus(end.at) > 0) out.switching = root(surplus, low);
  return out;
}

}  // namespace bridge_branch

}  // namespace papilla::capillary
