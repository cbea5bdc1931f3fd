#include "forward/open_gaps.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/constants.h"
#include "physics/electrostatics/breakdown.h"

namespace papilla::forward {
namespace {

constexpr std::size_t kLevels = 32;
// Droplets merge until so much of the skin is covered by their feet.
constexpr double kCovered = 0.5;
// Places that a droplet tries on its way to a narrow gap: what settled droplets hold under hanging
// skin (results/accuracy/far_water.csv, clean and natural, 35 to 75 % RH) within a factor of two.
constexpr double kPlaces = 2.5;
// Patches with less of their area within reach hold next to nothing.
constexpr double kLeastShare = 1e-9;

double normal_share(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }
double bell(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2 * kPi); }

// Gaps |N(offset + below, width)| of a patch over the levels of the surface.
class PatchGaps {
 public:
  PatchGaps(double offset, double width, const SurfaceLevels& levels)
      : offset_(offset), width_(width), levels_(levels) {}

  double up_to(double h) const {  // share of the area
    return sum(
        [&](double m) { return normal_share((h - m) / width_) - normal_share(-(h + m) / width_); });
  }
  double volume(double h) const {  // of the gaps up to h, per area [m]
    return sum([&](double m) { return one_side(h, m) + one_side(h, -m); });
  }

 private:
  template <class Of>
  double sum(const Of& of) const {
    if (levels_.share.empty()) return of(offset_);
    double out = 0;
    for (std::size_t i = 0; i < levels_.share.size(); ++i)
      out += levels_.share[i] * of(offset_ + levels_.below[i]);
    return out;
  }
  // int_0^h g N(g; m) dg
  double one_side(double h, double m) const {
    return m * (normal_share((h - m) / width_) - normal_share(-m / width_)) -
           width_ * (bell((h - m) / width_) - bell(m / width_));
  }

  double offset_, width_;
  const SurfaceLevels& levels_;
};

// Levels in fewer, for water, which is asked for its volume at many heights.
SurfaceLevels coarse(const SurfaceLevels& levels) {
  constexpr std::size_t kFew = 8;
  if (levels.share.size() <= kFew) return levels;
  SurfaceLevels out;
  for (std::size_t i = 0; i < kFew; ++i) {
    double share = 0, below = 0;
    const std::size_t from = i * levels.share.size() / kFew;
    for (std::size_t k = from; k < (i + 1) * levels.share.size() / kFew; ++k) {
      share += levels.share[k];
      below += levels.share[k] * levels.below[k];
    }
    out.share.push_back(share);
    out.below.push_back(below / share);
  }
  return out;
}

}  // namespace

SurfaceLevels surface_levels(const CoveredSurface& surface, double flat_film) {
  const std::vector<double>& z = surface.height.z;
  SurfaceLevels out;
  if (z.empty()) return out;
  std::vector<std::size_t> order(z.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return z[a] < z[b]; });
  const bool has_film = surface.effective.size() == z.size();
  for (std::size_t k = 0; k < kLevels; ++k) {
    const std::size_t from = k * z.size() / kLevels, to = (k + 1) * z.size() / kLevels;
    if (to == from) continue;
    double height = 0, film = 0;
    for (std::size_t i = from; i < to; ++i) {
      height += z[order[i]];
      film += has_film ? surface.effective[order[i]] : flat_film;
    }
    const auto count = static_cast<double>(to - from);
    const double share = count / static_cast<double>(z.size());
    height /= count;
    film /= count;
    constexpr double kSame = 1e-14;  // [m]
    if (!out.share.empty() && std::abs(out.below.back() + height) < kSame &&
        std::abs(out.film.back() - film) < kSame) {
      out.share.back() += share;
      continue;
    }
    out.share.push_back(share);
    out.below.push_back(-height);
    out.film.push_back(film);
  }
  return out;
}

SurfaceLevels resting(SurfaceLevels levels, double skin_rms, double contact) {
  if (levels.share.empty()) return levels;
  const double width = std::max(skin_rms, 1e-9);
  const auto touches = [&](double level) {  // share of the skin at `level` below the surface
    double out = 0;
    for (std::size_t i = 0; i < levels.share.size(); ++i)
      out += levels.share[i] * normal_share(-(level + levels.below[i]) / width);
    return out;
  };
  const auto solve = [](double low, double high, const auto& falls, double wanted) {
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (falls(middle) > wanted ? low : high) = middle;
    }
    return 0.5 * (low + high);
  };
  // Above 40 standard deviations there is no skin.
  const auto [least, most] = std::minmax_element(levels.below.begin(), levels.below.end());
  const double flat = solve(
      -40 * width, 40 * width, [&](double level) { return normal_share(-level / width); }, contact);
  const double here = solve(-*most - 40 * width, -*least + 40 * width, touches, contact);
  for (double& below : levels.below) below += here - flat;
  return levels;
}

FarDroplet far_droplet(const FarWater& water) {
  FarDroplet out;
  if (!(water.per_area > 0)) return out;
  const CapShape skin = cap_shape(water.rest.theta_skin);
  const CapShape surface = cap_shape(water.rest.theta_substrate);
  const double foot = 0.5 * (skin.widest + surface.widest);
  // Of the volume per foot^3, V = r^3 / foot^3 with r = pi v foot^3 / covered.
  const double merged = cube(kPi * water.per_area / kCovered) * square(cube(foot));
  out.volume = 1 / water.drops_per_volume + merged;
  out.reach = 0.5 * (skin.height + surface.height) * std::cbrt(out.volume);
  return out;
}

HeldByWater held_by_water(const SurfaceLevels& levels, double skin_rms, double mean_gap,
                          const FarWater& water) {
  if (!(water.per_area > 0)) return {};
  const PatchGaps gaps(mean_gap, std::max(skin_rms, 1e-9), levels);
  const FarDroplet drop = far_droplet(water);
  // Eq. coupling.9: a droplet bridges where one of the places that it tries is within its reach,
  // and is a disc as high as such places are in the mean.
  const double within = gaps.up_to(drop.reach);
  if (within < kLeastShare) return {};
  const double height = gaps.volume(drop.reach) / within;
  const double volume = -std::expm1(kPlaces * std::log1p(-std::min(within, 1.0))) * water.per_area;
  const double wet = volume / height;
  if (wet >= 1) return {};                              // flooded: no meniscus
  const double open = 1 - square(square(square(wet)));  // menisci vanish as water meets water
  const double tension = water.rest.surface_tension;
  // Eq. capillary.14 for discs of one droplet each.
  const double radius = std::sqrt(drop.volume / (kPi * height));
  return {tension * open * wet / height,
          0.25 * kPi * tension * open * 2 * radius * volume / drop.volume};
}

double touching_gap(double rms, double slope, double area) {
  if (rms <= 0) return 0;
  // Excursions above t rms: area slope^2 / (2 rms^2) (2 pi)^(-3/2) t e^(-t^2/2); e^-0.5772 of them
  // at the mean of the highest.
  const double places = area * square(slope / rms) / 2 * std::pow(2 * kPi, -1.5);
  constexpr double kAtMean = 0.5615;
  double t = 3;
  for (int i = 0; i < 50; ++i) t = std::sqrt(2 * std::log(std::max(places * t / kAtMean, 2.0)));
  return t * rms;
}

HungWater::HungWater(const SurfaceLevels& levels, double skin_rms, double touching_gap,
                     const FarWater& water)
    : water_(water) {
  if (!(water.per_area > 0)) return;
  constexpr int kNodes = 128;
  // Six standard deviations beyond the reach of its droplets nothing bridges.
  step_ = (far_droplet(water).reach + 6 * std::max(skin_rms, 1e-9)) / kNodes;
  const SurfaceLevels few = coarse(levels);
  for (int i = 0; i <= kNodes; ++i) {
    const HeldByWater held = held_by_water(few, skin_rms, touching_gap + i * step_, water);
    capillary_.push_back(held.capillary);
    retention_.push_back(held.retention);
  }
}

double HungWater::at(const std::vector<double>& values, double hang) const {
  const double x = hang / step_;
  const auto last = static_cast<double>(values.size() - 1);
  if (x >= last) return 0;
  const auto i = static_cast<std::size_t>(x);
  return values[i] + (x - static_cast<double>(i)) * (values[i + 1] - values[i]);
}

void HungWater::add(const GapShares& hangs, OpenGapForces& out) const {
  if (capillary_.empty()) return;
  const std::span<const double> hang = hangs.gaps();
  double capillary = 0, held = 0;
  for (std::size_t i = 0; i < hang.size(); ++i) {
    capillary += hangs.share[i] * at(capillary_, hang[i]);
    held += hangs.share[i] * at(retention_, hang[i]) * water_.rest.hysteresis;
  }
  out.capillary += wetting_gain(water_.rest.theta_skin, water_.rest.theta_substrate) * capillary;
  out.capillary_on +=
      wetting_gain(water_.driven.theta_skin, water_.driven.theta_substrate) * capillary;
  out.retention += held;
  out.retention_on += held;
}

double open_gap_pull(const GapShares& gaps, const SurfaceLevels& levels,
                     const FieldProblem& field) {
  if (!(field.v_rms > 0)) return 0;
  const double im2 = square(field.skin_layer.imag());
  // Squared field per volt of a column of air [1/m^2], as far as the air holds it. Eq.
  // electrostatics.21
  const double peak = field.v_rms * (field.steady ? 1 : std::sqrt(2.0));
  const auto held = [&](double air, double rest) {
    const double field2 = 1 / (square(air + rest) + im2);
    if (!field_is_held(field)) return field2;
    const double most = std::min(air_field_limit(field.air_limit, air), field.film_holds);
    return field2 * clipped_share(most / (peak * std::sqrt(field2)), field.steady);
  };
  const std::span<const double> gap = gaps.gaps();
  // Eq. coupling.8: levels one by one, all gaps over each.
  const auto mean = [&](double below, double film) {
    const double rest = film + field.skin_layer.real();
    double sum = 0;
    for (std::size_t k = 0; k < gap.size(); ++k)
      sum += gaps.share[k] * held(std::abs(gap[k] + below), rest);
    return sum;
  };
  double sum = 0;
  for (std::size_t i = 0; i < levels.share.size(); ++i)
    sum += levels.share[i] * mean(levels.below[i], levels.film[i]);
  if (levels.share.empty()) sum = mean(0, field.dielectric);
  return 0.5 * kVacuumPermittivity * square(field.v_rms) * sum;
}

}  // namespace papilla::forward
