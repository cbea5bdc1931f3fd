#include "physics/electrostatics/field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/constants.h"

namespace papilla {
namespace {

constexpr double kAirStrength = 350e6;   // V/m below 1 um (Peschot 2014)
constexpr double kPaschenMinimum = 327;  // V

// tanh^2 profile towards zero at every bridge; factors of several bridges multiply.
void screen_disc(const Gap& gap, const Droplet& bridge, double thickness,
                 std::vector<double>& factor) {
  const Grid& grid = gap.grid;
  const double edge_gap = std::max(bridge.edge_gap, 1e-9);
  // Width of the profile: the axisymmetric reach relative to the planar one keeps the lost force.
  const double width = std::max(screening_reach(edge_gap, thickness, bridge.radius), 1e-12);
  const double reach = bridge.radius + 3 * width;  // tanh^2(3) = 0.99
  const int nx = std::min(static_cast<int>(reach / grid.dx()) + 1, grid.nx / 2);
  const int ny = std::min(static_cast<int>(reach / grid.dy()) + 1, grid.ny / 2);
  const int cx = static_cast<int>(std::floor(bridge.x / grid.dx()));
  const int cy = static_cast<int>(std::floor(bridge.y / grid.dy()));
  for (int iy = cy - ny; iy < cy + ny; ++iy) {
    const double dy = (iy + 0.5) * grid.dy() - bridge.y;
    for (int ix = cx - nx; ix < cx + nx; ++ix) {
      const double dx = (ix + 0.5) * grid.dx() - bridge.x;
      const double r = std::sqrt(dx * dx + dy * dy);
      if (r >= reach) continue;
      const double t = std::tanh(std::max(0.0, r - bridge.radius) / width);
      factor[grid.index(wrap(ix, grid.nx), wrap(iy, grid.ny))] *= t * t;
    }
  }
}

// Distance in metres to the nearest bridged pixel, by two chamfer sweeps over a periodic patch.
std::vector<double> distance_to_water(const Wetting& wetting) {
  const Grid& g = wetting.grid;
  std::vector<double> d(g.size(), std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (wetting.bridged[i]) d[i] = 0;
  }
  const double dx = g.dx(), dy = g.dy(), dd = std::hypot(dx, dy);
  for (int round = 0; round < 2; ++round) {  // the second round carries across the periodic seam
    for (int iy = 0; iy < g.ny; ++iy) {
      for (int ix = 0; ix < g.nx; ++ix) {
        double& v = d[g.index(ix, iy)];
        const int l = wrap(ix - 1, g.nx), r = wrap(ix + 1, g.nx), u = wrap(iy - 1, g.ny);
        v = std::min({v, d[g.index(l, iy)] + dx, d[g.index(ix, u)] + dy, d[g.index(l, u)] + dd,
                      d[g.index(r, u)] + dd});
      }
    }
    for (int iy = g.ny - 1; iy >= 0; --iy) {
      for (int ix = g.nx - 1; ix >= 0; --ix) {
        double& v = d[g.index(ix, iy)];
        const int l = wrap(ix - 1, g.nx), r = wrap(ix + 1, g.nx), u = wrap(iy + 1, g.ny);
        v = std::min({v, d[g.index(r, iy)] + dx, d[g.index(ix, u)] + dy, d[g.index(l, u)] + dd,
                      d[g.index(r, u)] + dd});
      }
    }
  }
  return d;
}

void screen_mask(const Gap& gap, const Wetting& wetting, double thickness,
                 std::vector<double>& factor) {
  const std::vector<double> distance = distance_to_water(wetting);
  for (std::size_t i = 0; i < factor.size(); ++i) {
    const double width = screening_length(std::max(gap.value[i], 1e-9), thickness);
    if (distance[i] < 3 * width) factor[i] *= square(std::tanh(distance[i] / width));
  }
}

// Water column b [m] of droplets that do not bridge, a pixel.
void add_caps(const Grid& grid, const Wetting& wetting, std::vector<double>& column) {
  for (const Droplet& drop : wetting.droplets) {
    if (drop.state == DropletState::Bridge || drop.radius <= 0 || drop.height <= 0) continue;
    // Spherical cap of foot radius a and height b0 (an overhanging cap counts by its foot).
    const double a = drop.radius, b0 = drop.height;
    const double sphere = (a * a + b0 * b0) / (2 * b0);
    const int nx = std::min(static_cast<int>(a / grid.dx()) + 1, grid.nx / 2);
    const int ny = std::min(static_cast<int>(a / grid.dy()) + 1, grid.ny / 2);
    const int cx = static_cast<int>(std::floor(drop.x / grid.dx()));
    const int cy = static_cast<int>(std::floor(drop.y / grid.dy()));
    for (int iy = cy - ny; iy <= cy + ny; ++iy) {
      for (int ix = cx - nx; ix <= cx + nx; ++ix) {
        const double dx = (ix + 0.5) * grid.dx() - drop.x, dy = (iy + 0.5) * grid.dy() - drop.y;
        const double r2 = dx * dx + dy * dy;
        if (r2 >= a * a) continue;
        const double b = b0 - sphere + std::sqrt(std::max(0.0, sphere * sphere - r2));
        double& c = column[grid.index(wrap(ix, grid.nx), wrap(iy, grid.ny))];
        c = std::max(c, b);
      }
    }
  }
}

// Oxide on a wall counts by its column: beside a step of height s the oxide is s thicker within one
// oxide thickness of the wall on the low side. The share of such pixels blends the two local rules.
// Returns the extra oxide [m] of the column rule a pixel, empty for a surface without steps.
std::vector<double> wall_oxide(const Heightmap& texture, double thickness) {
  const Grid& g = texture.grid;
  const auto [low, high] = std::minmax_element(texture.z.begin(), texture.z.end());
  if (*high - *low < 1e-9 || thickness <= 0) return {};
  std::vector<double> extra(g.size(), 0);
  const int nx = static_cast<int>(thickness / g.dx()), ny = static_cast<int>(thickness / g.dy());
  bool any = false;
  // Largest drop from a pixel up to the oxide thickness away: row pass, then column pass of a
  // running maximum (separable: a square window stands for the disc).
  std::vector<double> rows(g.size());
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      double m = texture(ix, iy);
      for (int k = 1; k <= nx; ++k) {
        m = std::max({m, texture(wrap(ix + k, g.nx), iy), texture(wrap(ix - k, g.nx), iy)});
      }
      rows[g.index(ix, iy)] = m;
    }
  }
  for (int iy = 0; iy < g.ny; ++iy) {
    for (int ix = 0; ix < g.nx; ++ix) {
      double m = rows[g.index(ix, iy)];
      for (int k = 1; k <= ny; ++k) {
        m = std::max(
            {m, rows[g.index(ix, wrap(iy + k, g.ny))], rows[g.index(ix, wrap(iy - k, g.ny))]});
      }
      const double step = m - texture(ix, iy);
      if (step > 0.5 * (*high - *low)) {  // beside a wall, not on a gentle slope
        extra[g.index(ix, iy)] = step;
        any = true;
      }
    }
  }
  if (!any) extra.clear();
  return extra;
}

}  // namespace

double air_breakdown_voltage(double gap) {
  return std::max(kAirStrength * std::min(gap, 1e-6), gap > 1e-6 ? kPaschenMinimum : 0);
}

double corner_factor(double thickness, double rim_radius) {
  if (thickness <= 0 || std::isinf(rim_radius)) return 1;
  if (rim_radius <= 0) return std::numeric_limits<double>::infinity();
  const double x = thickness / rim_radius;
  return x / std::log1p(x);
}

double screening_length(double gap, double thickness) {
  const double x = std::min(thickness / gap, 10.0);
  return gap * (2 / kPi + 0.48308 * std::pow(x, 1.29906) / (1 + 0.22282 * x));
}

double screening_reach(double gap, double thickness, double radius) {
  const double x = std::min(thickness / gap, 10.0);
  const double i = std::min(gap / std::max(radius, 1e-12), 4.0);  // fitted for a/g >= 0.25
  return screening_length(gap, thickness) / (1 + 0.06715 * x * i / (1 - 0.0239 * i)) *
         (1 - 0.248 * i / (1 + 2 * i));
}

FieldSolution solve_local_field(const Gap& gap, const Heightmap* texture, const Wetting& wetting,
                                const FieldProblem& p) {
  FieldSolution out;
  const Grid& grid = gap.grid;
  const std::size_t n = grid.size();
  out.traction = {grid, std::vector<double>(n, 0)};
  if (p.v_rms == 0 && p.v_peak == 0) return out;
  if (p.dielectric <= 0 && std::abs(p.skin_layer) <= 0) {
    out.ok = false;
    out.reason = "no dielectric anywhere: contact would short the drive";
    return out;
  }
  std::vector<double> factor(n, 1.0), column;
  const bool wet = wetting.bridges > 0 || wetting.status == WettingStatus::Film;
  if (wet && p.screening) {
    if (wetting.status == WettingStatus::Discs) {
      for (const Droplet& drop : wetting.droplets) {
        if (drop.state == DropletState::Bridge)
          screen_disc(gap, drop, p.dielectric_thickness, factor);
      }
    } else if (!wetting.bridged.empty()) {
      screen_mask(gap, wetting, p.dielectric_thickness, factor);
    }
  }
  if (!wetting.bridged.empty()) {
    for (std::size_t i = 0; i < n; ++i) {
      if (wetting.bridged[i]) factor[i] = 0;  // electrowetting carries the load of a bridge
    }
  }
  if (p.droplet_enhancement || p.zero_under_droplets) {
    column.assign(n, 0);
    add_caps(grid, wetting, column);
  }
  const std::vector<double> extra =
      texture ? wall_oxide(*texture, p.dielectric_thickness) : std::vector<double>{};
  const double per_thickness =
      p.dielectric_thickness > 0 ? p.dielectric / p.dielectric_thickness : 0;

  const double scale = 0.5 * kVacuumPermittivity * p.v_rms * p.v_rms;
  const double cap = 0.5 * kVacuumPermittivity * square(kAirStrength);
  const std::complex<double> series = p.dielectric + p.skin_layer;
  double sum = 0, over_sum = 0;
  std::size_t over = 0;
  bool oxide_loaded = false;
  for (std::size_t i = 0; i < n; ++i) {
    if (factor[i] <= 0) {
      oxide_loaded = true;  // under a bridge the dielectric carries the whole voltage
      continue;
    }
    double g = gap.value[i];
    double water = 0;
    if (!column.empty() && column[i] > 0) {
      if (p.zero_under_droplets) continue;
      // Eq. electrostatics.4: water fills b of the gap (series formula, a conductor but for eps_w);
      // valid to about 10 % for b <= 0.6 g, and held there beyond.
      const double b = std::min(column[i], 0.9 * g);
      g -= b;
      water = b / kWaterPermittivity;
    }
    const double distance2 = std::norm(std::complex<double>(g + water) + series);
    double pressure = scale / distance2;
    if (!extra.empty() && extra[i] > 0) {
      // Eq. electrostatics.2: the column of oxide beside a wall replaces as much of the gap.
      const double oxide = std::min(extra[i], g);
      pressure =
          0.5 * (pressure +
                 scale / std::norm(std::complex<double>(g - oxide + water + oxide * per_thickness) +
                                   series));
    }
    const double gap_voltage = p.v_peak * g / std::sqrt(distance2);
    if (g > 0) {
      out.peak_air_field = std::max(out.peak_air_field, p.v_peak / std::sqrt(distance2));
    } else {
      oxide_loaded = true;
    }
    const bool beyond = g > 0 && gap_voltage > air_breakdown_voltage(g);
    if (p.breakdown_cap) pressure = std::min(pressure, cap);
    pressure *= factor[i];
    out.traction.value[i] = pressure;
    sum += pressure;
    if (beyond) {
      ++over;
      over_sum += pressure;
    }
  }
  if (oxide_loaded && p.dielectric_thickness > 0) {
    out.peak_oxide_field = p.v_peak * (p.dielectric / std::abs(series)) / p.dielectric_thickness;
    // A bridge touches the skin inside out: without its series layer the oxide carries everything.
    if (wet) out.peak_oxide_field = p.v_peak / p.dielectric_thickness;
  }
  out.mean_pressure = sum / static_cast<double>(n);
  out.over_limit_area = static_cast<double>(over) / static_cast<double>(n);
  out.over_limit_share = sum > 0 ? over_sum / sum : 0;
  if (!std::isfinite(sum)) {
    out.ok = false;
    out.reason = "the pull is not finite";
  }
  return out;
}

}  // namespace papilla
