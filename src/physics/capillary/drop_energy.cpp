#include "physics/capillary/drop_energy.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"

namespace papilla::capillary {
namespace {

// Slopes of the gap beyond this are walls, not bowls: they are taken as this [rad].
constexpr double kLargestTilt = kPi / 4, kLargestSlope = 1;
// Slope of the rim at which half of the exact flat bridge's remainder has faded [rad].
constexpr double kFlatTilt = kPi / 12;

// How far the rim is moved for the change of the energy with its radius, by that radius.
constexpr double kForceStep = 0.04;

// Under a bowl the exact flat bridge's remainder fades (fitted on sphere and plate). angle: of the
// rim's slope [rad].
double flatness(double angle) { return 1 / (1 + square(angle / kFlatTilt)); }

double angle_of(const GapTable::Rim& rim) { return std::atan(rim.slope); }

}  // namespace

DropEnergy::DropEnergy(const Gap& gap, const WaterProperties& water, double gap_floor,
                       double largest_step)
    : grid_(gap.grid),
      table_(gap, gap_floor, largest_step),
      water_(water),
      gain_(wetting_gain(water.theta_skin, water.theta_substrate)),
      cos_skin_(std::cos(water.theta_skin)),
      exact_(bridge_table(water.theta_skin, water.theta_substrate)),
      cap_(cap_shape(std::min(water.theta_skin, water.theta_substrate))),
      cap_state_(water.theta_skin < water.theta_substrate ? DropletState::OnSkin
                                                          : DropletState::OnSubstrate) {
  fit_meniscus();
  // A drop whose centre sees a gap (per volume^(1/3)) well beyond the largest at which a flat
  // bridge has the lower energy is not worth trying as a bridge.
  const BridgeLimits& limits = exact_->limits();
  const bool none = limits.status == BridgeStatus::Converged && limits.rupture == 0;  // at any gap
  const bool known = exact_->valid() || none;
  rupture_ = known ? limits.rupture : 2;
  const double favoured = known ? limits.switching : 1;
  reach_ = std::max(1.3 * favoured, cap_.height);
}

// The meniscus factor over the slope angle, a polynomial through five angles.
void DropEnergy::fit_meniscus() {
  const auto tilted = [&](double share) {
    return meniscus_factor(water_.theta_substrate,
                           std::clamp(water_.theta_skin + share * kLargestTilt, 0.0, kPi));
  };
  meniscus_ = tilted(0);
  const double odd_half = 0.5 * (tilted(0.5) - tilted(-0.5)), odd = 0.5 * (tilted(1) - tilted(-1));
  const double even_half = 0.5 * (tilted(0.5) + tilted(-0.5)) - meniscus_;
  const double even = 0.5 * (tilted(1) + tilted(-1)) - meniscus_;
  const double cubic = (odd - 2 * odd_half) * 4 / 3, quartic = (even - 4 * even_half) * 4 / 3;
  tilt_terms_ = {odd - cubic, even - quartic, cubic, quartic};
}

double DropEnergy::meniscus_at(double angle) const {
  const double x = std::clamp(angle / kLargestTilt, -1.0, 1.0);
  const auto& [a1, a2, a3, a4] = tilt_terms_;
  return meniscus_ + x * (a1 + x * (a2 + x * (a3 + x * a4)));
}

// Eq. capillary.4, per tension: wetting and meniscus, with the slope of the gap at the rim.
double DropEnergy::slab_energy(double radius, const GapTable::Rim& rim, double angle) const {
  const double slope = std::clamp(rim.slope, -kLargestSlope, kLargestSlope);
  // Wet area of a sphere over its base, less 1: the square of the tangent of half the angle.
  const double bowl = square(slope / (1 + std::sqrt(1 + square(slope))));
  return -(gain_ + cos_skin_ * bowl) * kPi * square(radius) +
         2 * kPi * radius * meniscus_at(angle) * rim.gap;
}

// What the exact flat bridge of this volume and mean gap has beyond the slab, per tension.
BridgeTable::Value DropEnergy::beyond_slab(double volume, double radius) const {
  if (volume == bridge_.volume && radius == bridge_.radius) return bridge_.beyond;
  bridge_ = {volume, radius, {0, 0}};
  if (!exact_->valid()) return bridge_.beyond;
  const double size = size_of(volume);
  const double h = volume / (kPi * square(radius)) / size;
  if (h >= rupture_) return bridge_.beyond;
  const BridgeTable::Value exact = (*exact_)(h);
  const double root = std::sqrt(kPi * h);
  bridge_.beyond = {square(size) * (exact.energy + gain_ / h - 2 * meniscus_ * root),
                    size * (exact.force - gain_ / square(h) - meniscus_ * root / h)};
  return bridge_.beyond;
}

GapTable::Rule DropEnergy::rule(double radius) const {
  if (radius != sampled_.radius) sampled_ = {radius, table_.rule(radius)};
  return sampled_.rule;
}

double DropEnergy::bridge_energy(double volume, double radius, const GapTable::Rim& rim) const {
  const double angle = angle_of(rim);
  return water_.surface_tension *
         (slab_energy(radius, rim, angle) + flatness(angle) * beyond_slab(volume, radius).energy);
}

double DropEnergy::size_of(double volume) const {
  if (volume != sized_.volume) sized_ = {volume, std::cbrt(volume)};
  return sized_.size;
}

double DropEnergy::cap_energy(double volume) const {
  return water_.surface_tension * cap_.energy * square(size_of(volume));
}

// The footprint shrinks by dr/dh = -r / (2 h_edge).
double DropEnergy::force(const Drop& d) const {
  const double r = d.radius;
  if (water_.pressure_alone)
    return water_.surface_tension * laplace_force(water_, kPi * square(r), d.edge_gap, r);
  const GapTable::Rule rule = table_.rule(r);
  const GapTable::Rim rim{d.edge_gap, d.edge_slope};
  const double angle = angle_of(rim);
  const double fixed = 2 * kPi * r * meniscus_at(angle);
  const double step = kForceStep * r;
  const GapTable::Rim out = table_.rim(d.x, d.y, r + step, rule);
  const GapTable::Rim in = table_.rim(d.x, d.y, r - step, rule);
  const BridgeTable::Value beyond = beyond_slab(d.volume, r);
  const double angle_out = angle_of(out), angle_in = angle_of(in);
  const double by_radius =
      (slab_energy(r + step, out, angle_out) - slab_energy(r - step, in, angle_in) +
       beyond.energy * (flatness(angle_out) - flatness(angle_in))) /
      (2 * step);
  const double mean_gap = d.volume / (kPi * square(r));
  return water_.surface_tension * (fixed - r / (2 * d.edge_gap) * by_radius +
                                   flatness(angle) * beyond.force * mean_gap / d.edge_gap);
}

double DropEnergy::retention(const Drop& d) const {
  return kPi / 4 * water_.surface_tension * 2 * d.radius * water_.hysteresis;
}

void DropEnergy::bridge_over(Drop& d, const BridgeGuess& guess) {
  ++evaluations_;
  const Footprint found = solve_footprint(table_, d.x, d.y, d.volume, guess);
  d.radius = found.radius;
  d.edge_gap = found.rim.gap;
  d.edge_slope = found.rim.slope;
  d.energy = bridge_energy(d.volume, found.radius, found.rim);
  d.bridge = true;
}

double DropEnergy::estimated(const Drop& d, double x, double y) {
  ++evaluations_;
  const double r = d.radius;
  const GapTable::Rule sampling = rule(r);
  const GapTable::Rim rim = table_.rim(x, y, r, sampling);
  const double change =
      (d.volume - table_.disc_volume(x, y, r, sampling)) / (2 * kPi * r * rim.gap);
  if (std::abs(change) > 0.25 * r) {
    Drop trial = d;
    trial.x = x;
    trial.y = y;
    bridge_over(trial, 0);
    return trial.energy;
  }
  return bridge_energy(d.volume, r, rim) + water_.surface_tension * 2 * kPi * change *
                                               (-gain_ * r + meniscus_ * (rim.gap + r * rim.slope));
}

bool DropEnergy::floats_around(const Drop& d) const {
  return !reaches(d.volume, table_.lowest_around(d.x, d.y));
}

Drop DropEnergy::placed(double x, double y, double volume, const BridgeGuess& guess,
                        bool was_bridge) {
  return placed(x, y, volume, guess, was_bridge, false);
}

Drop DropEnergy::kept(double x, double y, double volume, double radius) {
  return placed(x, y, volume, radius, true, true);
}

Drop DropEnergy::placed(double x, double y, double volume, const BridgeGuess& guess,
                        bool was_bridge, bool stays) {
  Drop d;
  d.x = into_period(x, grid_.lx);
  d.y = into_period(y, grid_.ly);
  d.volume = volume;
  const double size = size_of(volume), centre = table_.at(d.x, d.y);
  const double cap = cap_energy(volume);
  if (was_bridge || reaches(volume, centre)) {
    bridge_over(d, guess);
    const bool whole = volume < rupture_ * size * kPi * square(d.radius);
    if ((whole && (d.energy < cap || stays)) || cap_.height * size >= centre) return d;
  }
  d.bridge = false;
  d.radius = cap_.widest * size;
  d.footprint = cap_.footprint * size;
  d.height = cap_.height * size;
  d.side = cap_state_;
  d.edge_gap = d.edge_slope = 0;
  d.energy = cap;
  return d;
}

}  // namespace papilla::capillary
