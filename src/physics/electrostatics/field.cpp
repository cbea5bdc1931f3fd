#include "physics/electrostatics/field.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "physics/electrostatics/breakdown.h"
#include "physics/electrostatics/pull.h"
#include "physics/electrostatics/screening.h"

namespace papilla::electrostatics {

std::vector<double> droplet_columns(const Grid& grid, const Wetting& wetting) {
  std::vector<double> column(grid.size(), 0);
  const double dx = grid.dx(), dy = grid.dy();
  for (const Droplet& drop : wetting.droplets) {
    if (drop.state == DropletState::Bridge || drop.radius <= 0 || drop.height <= 0) continue;
    // Spherical cap of foot radius a and height b; above 90 degrees it overhangs its foot.
    const double a = drop.radius, b = drop.height;
    const double sphere = (a * a + b * b) / (2 * b);
    const double reach = b > a ? sphere : a;
    const int x0 = static_cast<int>(std::floor((drop.x - reach) / dx));
    const int y0 = static_cast<int>(std::floor((drop.y - reach) / dy));
    const int nx = std::min(static_cast<int>(2 * reach / dx) + 2, grid.nx);
    const int ny = std::min(static_cast<int>(2 * reach / dy) + 2, grid.ny);
    for (int j = 0; j < ny; ++j) {
      const double y = (y0 + j + 0.5) * dy - drop.y;
      for (int i = 0; i < nx; ++i) {
        const double x = (x0 + i + 0.5) * dx - drop.x;
        const double r2 = x * x + y * y;
        if (r2 >= reach * reach) continue;
        const double half = std::sqrt(sphere * sphere - r2);
        const double water = r2 < a * a ? b - sphere + half : 2 * half;
        double& c = column[grid.index(wrap(x0 + i, grid.nx), wrap(y0 + j, grid.ny))];
        c = std::max(c, water);
      }
    }
  }
  return column;
}

AirColumns columns_above(const Gap& gap, const Wetting& wetting, const FieldProblem& p) {
  AirColumns out{gap.value, {}};
  if ((!p.droplet_enhancement && !p.zero_under_droplets) || wetting.droplets.empty()) return out;
  out.water = droplet_columns(gap.grid, wetting);
  for (std::size_t i = 0; i < out.air.size(); ++i) {
    if (out.water[i] <= 0) continue;
    if (p.zero_under_droplets) {
      out.air[i] = kNoPull;
      continue;
    }
    // Eq. electrostatics.4: good to about 10 % up to b = 0.6 g, held at 0.9 g beyond.
    out.water[i] = std::min(out.water[i], 0.9 * out.air[i]);
    out.air[i] -= out.water[i];
  }
  return out;
}

namespace {

// What the strongest fields stand in.
struct Strongest {
  double air2 = HUGE_VAL;  // least squared distance in d/eps of a column with air [m^2]
  // Largest voltage over d/eps of a column's dielectric, per volt of the drive [1/m]; 0: none.
  double dielectric = 0;
};

void set_peaks(const FieldProblem& p, bool walls, const Strongest& strongest, FieldSolution& out) {
  if (strongest.air2 < HUGE_VAL) out.peak_air_field = p.v_peak / std::sqrt(strongest.air2);
  if (p.dielectric_thickness <= 0) return;
  // Mean over the layers: that of a flat film with the same voltage over its d/eps.
  out.peak_oxide_field = p.v_peak * strongest.dielectric * p.dielectric / p.dielectric_thickness;
  if (walls && p.edge_radius > 0)
    out.peak_oxide_field *= corner_factor(p.dielectric_thickness, p.edge_radius);
}

}  // namespace

bool holds_all_voltage(const FieldProblem& problem) {
  constexpr double kBetter = 100;  // as an insulator than the gap
  return problem.dielectric > kBetter * problem.dielectric_thickness;
}

FieldSolution pull(const Gap& gap, const CoveredSurface* surface, const FieldProblem& p,
                   const AirColumns& columns, const FluxFactors& factors) {
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
  const double scale = 0.5 * kVacuumPermittivity * square(p.v_rms);
  const double cap = p.breakdown_cap ? 0.5 * kVacuumPermittivity * square(kAirStrength) : HUGE_VAL;
  const double quadrature = square(p.skin_layer.imag());
  double sum = 0, over_sum = 0;
  std::size_t over = 0;
  Strongest strongest;
  for (std::size_t i = 0; i < n; ++i) {
    const double open = factors.open.empty() ? 1 : factors.open[i];
    const double film = surface ? surface->effective[i] : p.dielectric;
    if (open <= 0) {
      // Water leads around the skin's layer: under a bridge the dielectric carries everything.
      if (film > 0) strongest.dielectric = std::max(strongest.dielectric, 1 / film);
      continue;
    }
    const double g = columns.air[i];
    if (g < 0) continue;
    const double gain = factors.gain.empty() ? 1 : factors.gain[i];
    const double water = columns.water.empty() ? 0 : columns.water[i];
    const double in_series = film + p.skin_layer.real() + water / kWaterPermittivity;
    const double distance2 = (square(g + in_series) + quadrature) / gain;
    const double pressure = std::min(scale / distance2, cap) * open;
    out.traction.value[i] = pressure;
    sum += pressure;
    const double share = factors.voltage.empty() ? film / std::sqrt(distance2) : factors.voltage[i];
    if (film > 0)
      strongest.dielectric =
          std::max(strongest.dielectric, std::min(share * p.film_phase, 1.0) / film);
    if (g > 0) {
      strongest.air2 = std::min(strongest.air2, distance2);
      if (square(p.v_peak * g) > square(air_breakdown_voltage(g)) * distance2) {
        ++over;
        over_sum += pressure;
      }
    }
  }
  if (!std::isfinite(sum)) {
    out.ok = false;
    out.reason = "the pull is not finite";
    return out;
  }
  set_peaks(p, surface && surface->walls, strongest, out);
  out.mean_pressure = sum / static_cast<double>(n);
  out.over_limit_area = static_cast<double>(over) / static_cast<double>(n);
  out.over_limit_share = sum > 0 ? over_sum / sum : 0;
  return out;
}

namespace {

// Eq. electrostatics.18: `pressure` is what water does not cover; `faded` what is left around it.
double share_left(const std::vector<double>& pressure, const std::vector<double>& faded) {
  double left = 0, all = 0;
  for (std::size_t i = 0; i < faded.size(); ++i) {
    all += pressure[i];
    left += pressure[i] * faded[i];
  }
  return all > 0 ? left / all : 1;
}

}  // namespace

FieldSolution solve_local_field(const Gap& gap, const CoveredSurface* surface,
                                const Wetting& wetting, const FieldProblem& p) {
  const AirColumns columns = columns_above(gap, wetting, p);
  const auto under = [&](const std::vector<double>& open) {
    return pull(gap, surface, p, columns, {.open = open, .gain = {}, .voltage = {}});
  };
  const auto screened = [&](bool fade) {
    return screening_factor(gap, wetting, p.dielectric_thickness, fade);
  };
  if (!p.screening || !p.even_screening) return under(screened(p.screening));
  std::vector<double> open = screened(false);
  const FieldSolution uncovered = under(open);
  if (open.empty() || !uncovered.ok) return uncovered;
  const double left = share_left(uncovered.traction.value, screened(true));
  for (double& share : open) share *= left;
  return under(open);
}

}  // namespace papilla::electrostatics
