#include "fabricate/process.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/constants.h"
#include "base/error.h"
#include "fabricate/export.h"
#include "numerics/quadrature.h"

namespace papilla::fabricate {
namespace {

// e^-x I_0(x): beyond 50 by the first terms of its asymptotic series, to 1e-6.
double scaled_bessel(double x) {
  constexpr double kAsymptotic = 50;
  if (x < kAsymptotic) return std::exp(-x) * std::cyl_bessel_i(0.0, x);
  return (1 + 1 / (8 * x) + 9 / (128 * x * x)) / std::sqrt(2 * kPi * x);
}

// A disc of light after a blur, at a distance from its centre: Rice's distribution. Eq.
// fabrication.3
double blurred_disc(double radius, double blur, double distance) {
  constexpr double kFar = 9;  // deviations
  const double from = std::max(0.0, distance - kFar * blur),
               to = std::min(radius, distance + kFar * blur);
  if (to <= from) return 0;
  static const Quadrature rule = gauss_legendre(64, 0, 1);
  double sum = 0;
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double r = from + (to - from) * rule.nodes[i];
    sum += rule.weights[i] * r / square(blur) * std::exp(-0.5 * square((r - distance) / blur)) *
           scaled_bessel(r * distance / square(blur));
  }
  return sum * (to - from);
}

// A line of light after a blur, at a distance from its middle.
double blurred_line(double width, double blur, double distance) {
  const auto below = [&](double edge) { return 0.5 * std::erfc(-edge / (std::sqrt(2.0) * blur)); };
  return below(0.5 * width - distance) - below(-0.5 * width - distance);
}

// Centres of a feature's neighbours as far as two periods.
std::vector<std::pair<double, double>> neighbours(const FeatureArray& array) {
  const bool hexagons = array.lattice == Lattice::Hexagonal;
  const double row = hexagons ? 0.5 * std::sqrt(3.0) * array.period : array.period;
  std::vector<std::pair<double, double>> out;
  for (int j = -2; j <= 2; ++j) {
    for (int i = -2; i <= 2; ++i) {
      if (i == 0 && j == 0) continue;
      out.emplace_back((i + (hexagons && j % 2 != 0 ? 0.5 : 0.0)) * array.period, j * row);
    }
  }
  return out;
}

// Where a falling exposure is 1/2, between two places: by regula falsi, an end that stays counting
// half (Illinois).
template <class Light>
double edge_between(double low, double high, const Light& light) {
  constexpr int kMostSteps = 60;
  constexpr double kNear = 1e-14;  // [m]
  double at_low = light(low) - 0.5, at_high = light(high) - 0.5;
  if (at_low <= 0) return low;
  if (at_high >= 0) return high;
  double edge = low, before = high;
  bool last_bright = false;
  for (int i = 0; i < kMostSteps && std::abs(edge - before) > kNear; ++i) {
    before = std::exchange(edge, (low * at_high - high * at_low) / (at_high - at_low));
    const double at = light(edge) - 0.5;
    const bool bright = at > 0;
    (bright ? low : high) = edge;
    (bright ? at_low : at_high) = at;
    if (i > 0 && bright == last_bright) (bright ? at_high : at_low) *= 0.5;
    last_bright = bright;
  }
  return edge;
}

double exposed_line(const FeatureArray& mask, double blur, double high) {
  const auto light = [&](double x) {
    double sum = 0;
    for (int i = -2; i <= 2; ++i)
      sum += blurred_line(mask.width, blur, std::abs(x - i * mask.period));
    return sum;
  };
  return 2 * edge_between(0, high, light);
}

double exposed_disc(const FeatureArray& mask, double blur, double low, double high) {
  constexpr int kDirections = 12;  // of a sixth and of a quarter of the circle alike
  constexpr double kNothing = 9;   // deviations
  const double radius = 0.5 * mask.width;
  const auto others = neighbours(mask);
  double sum = 0;
  for (int k = 0; k < kDirections; ++k) {
    const double angle = (k + 0.5) * kPi / (2 * kDirections);
    const auto light = [&](double r) {
      double out = blurred_disc(radius, blur, r);
      for (const auto& [cx, cy] : others) {
        const double far = std::hypot(r * std::cos(angle) - cx, r * std::sin(angle) - cy);
        if (far - radius < kNothing * blur) out += blurred_disc(radius, blur, far);
      }
      return out;
    };
    sum += square(edge_between(low, high, light)) / kDirections;
  }
  return 2 * std::sqrt(sum);
}

// The width to draw for features that are `width` wide in the resist. Eq. fabrication.4
double drawn_width(FeatureArray mask, double blur, double width) {
  if (blur <= 0) return width;
  constexpr int kMostSteps = 30;
  constexpr double kNear = 1e-11;  // [m]
  double before = 0, miss_before = 0;
  mask.width = width;
  for (int step = 0; step < kMostSteps; ++step) {
    const double miss = width - exposed_width(mask, blur);
    if (std::abs(miss) < kNear) return mask.width;
    const double slope = step == 0 ? 1 : (miss_before - miss) / (mask.width - before);
    before = std::exchange(mask.width, mask.width + miss / std::clamp(slope, 0.5, 10.0));
    miss_before = miss;
    if (!(mask.width > 0 && mask.width < mask.period)) break;
  }
  throw InputError(
      fmt::format("no mask makes it: an exposure that rounds corners so far opens no {} of {:.4g} "
                  "nm; a finer exposure, or wider ones",
                  mask.drawn, 1e9 * width));
}

// Rims of the etch that leave nothing of the land, between features this wide at it. The design's
// own were held against the land that it wants, not against what an undercut leaves of it.
void check_rims(const MaskedArray& array, const Process& process, double width) {
  TextureProblems found;
  add_rim_problem(array.etched, array.wanted.deep ? array.mask.period - width : width, found);
  for (const auto& [key, message] : found)
    throw InputError((process.edge_radius > 0 ? "process." : "") + key + ": " + message);
}

// The feature as wide at the land as gives the same width at half its depth. Eq. fabrication.5
double width_at_land(const FeatureArray& wanted, const WallSection& wall,
                     const WallSection& etched) {
  const double more = etched.run() - wall.run();
  return wanted.width + (wanted.deep ? more : -more);
}

}  // namespace

WallSection wall_of(Texture texture) {
  const Roles role = roles(texture);
  return {*role.depth, *role.wall_angle, *role.edge_radius};
}

bool Process::none() const {
  Process neutral;
  neutral.compensate = compensate;
  return *this == neutral;
}

double Process::blur() const {
  // A quarter plane blurred with deviation s is one half on its diagonal at t from either edge,
  // where Phi(t/s)^2 = 1/2: t = 0.5450 s. An arc of radius r in the corner is (1 - sqrt(1/2)) r
  // from either edge there.
  constexpr double kDiagonal = 0.54495214;
  return corner_radius * (1 - std::sqrt(0.5)) / kDiagonal;
}

void fields(FieldVisitor& v, Process& s) {
  v.number(
      {"corner_radius", "nm", 0, 1e5,
       "radius to which the exposure rounds a square corner (spot of a laser or of electrons)"},
      s.corner_radius);
  v.number({"resist_bias", "nm", -1e4, 1e4,
            "each edge of an opening in the resist moves outward by this; below 0: inward"},
           s.resist_bias);
  v.number({"undercut", "%", 0, 200,
            "of the etch below the resist at each edge, of its depth; 100 %: a wet etch"},
           s.undercut);
  v.number(
      {"wall_angle", "deg", 0, 90, "that the etch leaves, from the land; 0: as each design says"},
      s.wall_angle);
  v.number({"edge_radius", "nm", 0, 1e5, "of the rims; 0: as each design says"}, s.edge_radius);
  v.number({"shrinkage", "%", 0, 20, "of an imprint along the surface"}, s.shrinkage);
  v.number({"height_shrinkage", "%", 0, 50, "of the heights of an imprint"}, s.height_shrinkage);
  v.flag({"compensate", "the mask is drawn so that the made surface is the wanted one"},
         s.compensate);
}

double exposed_width(const FeatureArray& mask, double blur) {
  constexpr double kFar = 4;  // deviations
  const double high = std::min(0.5 * mask.width + kFar * blur, 0.5 * mask.period);
  if (mask.shape == FeatureArray::Shape::Line) return exposed_line(mask, blur, high);
  return exposed_disc(mask, blur, std::max(0.0, 0.5 * mask.width - kFar * blur), high);
}

namespace {

// Lengths of the master over those of the surface, before an imprint shrinks. Eq. fabrication.6
double stretch(const Process& process) {
  return process.compensate ? 1 / (1 - process.shrinkage) : 1;
}

// The mask of one array whose period is drawn so [m].
MaskedArray masked_at(const Texture& texture, const Process& process, double period) {
  const TextureFacts known = facts(texture);
  MaskedArray out{*array_of(known), wall_of(texture), {}, 0, {}};
  const double along = stretch(process),
               up = process.compensate ? 1 / (1 - process.height_shrinkage) : 1;
  out.etch = up * out.wall.depth;
  // Walls of the master that an imprint makes those of the design.
  const double steep = std::atan(std::tan(out.wall.wall_angle) * up / along);
  out.etched = {out.etch, process.wall_angle > 0 ? process.wall_angle : steep,
                process.edge_radius > 0 ? process.edge_radius : along * out.wall.edge_radius};
  out.mask = out.wanted;
  out.mask.period = period;
  out.mask.width = along * out.wanted.width;
  const double opening = process.resist_bias + process.undercut * out.etch,
               wider = (out.wanted.deep ? 2 : -2) * opening;
  double resist = out.mask.width;
  if (process.compensate) {
    const WallSection wall{out.etch, steep, 0};
    resist = width_at_land(out.mask, wall, out.etched) - wider;
    if (!(resist > 0 && resist < out.mask.period)) {
      throw InputError(fmt::format(
          "no mask makes it: resist bias and undercut of {:.4g} nm at each edge leave nothing of "
          "its {} or of what is between them; another process, or wider ones",
          1e9 * opening, out.wanted.drawn));
    }
    out.mask.width = drawn_width(out.mask, process.blur(), resist);
  } else if (process.blur() > 0) {
    resist = exposed_width(out.mask, process.blur());
  }
  out.mask.terraces.clear();
  if (!(out.mask.width >= 2e-9 && out.mask.width <= out.mask.period - 2e-9))
    throw InputError(fmt::format("no mask makes it: nothing is left of its {} or between them",
                                 out.wanted.drawn));
  check_rims(out, process, resist + wider);
  return out;
}

}  // namespace

// Each period rounded alone would let the masks of one surface slip against each other by up to a
// nanometre a period.
std::vector<MaskedArray> masked(const std::vector<Texture>& arrays, const Process& process) {
  constexpr double kNanometre = 1e-9, kMostOff = 0.01;  // of the longest period
  double longest = 0;
  for (const Texture& array : arrays) longest = std::max(longest, facts(array).period());
  const double wanted = stretch(process) * longest;
  const auto periods_of = [&](const Texture& array) {
    return std::lround(longest / facts(array).period());
  };
  // The least number of nanometres that every part divides in whole ones.
  long common = 1;
  for (const Texture& array : arrays) {
    common = std::lcm(common, periods_of(array));
    if (static_cast<double>(common) * kNanometre > 2 * kMostOff * wanted && common > 1) {
      throw InputError(fmt::format(
          "periods of its parts have no common grid of whole nanometres within {:g} % of {:.6g} "
          "um; take periods each of which is a whole number of the next shorter one",
          100 * kMostOff, 1e6 * longest));
    }
  }
  const double step = static_cast<double>(common) * kNanometre,
               drawn = step * std::max(1.0, std::round(wanted / step));
  std::vector<MaskedArray> out;
  for (const Texture& array : arrays) {
    out.push_back(masked_at(array, process, drawn / static_cast<double>(periods_of(array))));
  }
  return out;
}

MaskedArray masked(const Texture& texture, const Process& process) {
  return masked(std::vector{texture}, process).front();
}

}  // namespace papilla::fabricate
