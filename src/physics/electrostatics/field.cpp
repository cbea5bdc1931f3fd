#include "physics/electrostatics/field.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/constants.h"
#include "base/lanes.h"
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
    // The window holds every pixel once, the nearest image of the drop in it.
    const int x0 = static_cast<int>(std::floor((drop.x - std::min(reach, 0.5 * grid.lx)) / dx));
    const int y0 = static_cast<int>(std::floor((drop.y - std::min(reach, 0.5 * grid.ly)) / dy));
    const int nx = std::min(static_cast<int>(2 * reach / dx) + 2, grid.nx);
    const int ny = std::min(static_cast<int>(2 * reach / dy) + 2, grid.ny);
    for (int j = 0; j < ny; ++j) {
      const double y = (y0 + j + 0.5) * dy - drop.y;
      double* row = column.data() + grid.index(0, wrap(y0 + j, grid.ny));
      for (int i = 0, ix = wrap(x0, grid.nx); i < nx; ++i, ++ix) {
        if (ix == grid.nx) ix = 0;
        const double x = (x0 + i + 0.5) * dx - drop.x;
        const double r2 = x * x + y * y;
        if (r2 >= reach * reach) continue;
        const double half = std::sqrt(sphere * sphere - r2);
        const double water = r2 < a * a ? b - sphere + half : 2 * half;
        row[ix] = std::max(row[ix], water);
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

// The strongest fields per volt of the drive; 0: none.
struct Strongest {
  double air2 = 0;         // squared, of a column with air [1/m^2]
  double dielectric2 = 0;  // squared, voltage over d/eps of a column's dielectric [1/m^2]
};

void set_peaks(const FieldProblem& p, bool walls, const Strongest& strongest, FieldSolution& out) {
  out.peak_air_field = p.v_peak * std::sqrt(strongest.air2);
  if (p.dielectric_thickness <= 0) return;
  // Mean over the layers: that of a flat film with the same voltage over its d/eps.
  out.peak_oxide_field =
      p.v_peak * std::sqrt(strongest.dielectric2) * p.dielectric / p.dielectric_thickness;
  if (walls && p.edge_radius > 0)
    out.peak_oxide_field *= corner_factor(p.dielectric_thickness, p.edge_radius);
}

}  // namespace

bool holds_all_voltage(const FieldProblem& problem) {
  constexpr double kBetter = 100;  // as an insulator than the gap
  return problem.dielectric > kBetter * problem.dielectric_thickness;
}

namespace {

// Eight pixels of what `pull` goes through.
struct Columns {
  Lanes open, film, air, water, potential;
  bool spread;  // the potential is known, not that of the column

  Columns(std::size_t i, const CoveredSurface* surface, const FieldProblem& p,
          const AirColumns& columns, const FluxFactors& factors)
      : open(lanes_at(factors.open, i, 1)),
        film(surface ? lanes_at(surface->effective, i) : all_lanes(p.dielectric)),
        air(lanes_at(columns.air, i, kNoPull)),
        water(lanes_at(columns.water, i)),
        potential(lanes_at(factors.potential, i)),
        spread(!factors.potential.empty()) {}
};

// The air of a column breaks down: the voltage across it is beyond Paschen's.
bool breaks_down(double v_peak, double air, double field2) {
  return air > 0 && square(v_peak * air) * field2 > square(air_breakdown_voltage(air));
}

class PullSum {
 public:
  PullSum(const FieldProblem& p, bool walls) : p_(p), walls_(walls) {}

  // The pressure of eight columns [Pa].
  Lanes add(const Columns& c) {
    // A gap that is no number pulls: the sum must show it.
    const LaneMask bridge = c.open <= 0, pulls = ~bridge & ~(c.air < 0), film = c.film > 0;
    const Lanes reach = c.air + c.film + p_.skin_layer.real() + kPerWater * c.water;
    const Lanes series2 = reach * reach + square(p_.skin_layer.imag());
    const Lanes per_film = 1 / c.film, per_film2 = per_film * per_film;
    // Squared, per volt: the field in the air, what is over the film's d/eps [1/m^2].
    Lanes field2, of_film2;
    if (c.spread) {
      // The flux over that of the column alone.
      const Lanes skin = to_skin(c.air, c.water, p_.skin_layer.real());
      const Lanes gain = c.potential * (skin + c.film), left = 1 - c.potential;
      const Lanes flux2 = left * left * per_film2;
      field2 = gain * gain / (skin * skin * series2);
      of_film2 = flux2 / (1 + square(p_.skin_layer.imag()) * flux2);
    } else {
      of_film2 = field2 = 1 / series2;
    }
    const Lanes free = scale_ * field2;
    const Lanes pressure =
        chosen(pulls, chosen(cap_ < free, all_lanes(cap_), free) * c.open, Lanes{});
    sum_ += pressure;
    // Water leads around the skin's layer: under a bridge the dielectric carries everything.
    of_film2 *= square(p_.film_phase);
    of_film2 = chosen(bridge | (of_film2 > per_film2), per_film2, of_film2);
    raise(strongest_film2_, chosen((pulls | bridge) & film, of_film2, Lanes{}));
    raise(strongest_air2_, chosen(pulls & (c.air > 0), field2, Lanes{}));
    add_breakdown(c, pulls, field2, pressure);
    return pressure;
  }

  void finish(std::size_t columns, FieldSolution& out) const {
    const auto n = static_cast<double>(columns);
    const double sum = total(sum_);
    if (!std::isfinite(sum)) {
      out.ok = false;
      out.reason = "the pull is not finite";
      return;
    }
    set_peaks(p_, walls_, {largest(strongest_air2_), largest(strongest_film2_)}, out);
    out.mean_pressure = sum / n;
    double over = 0;
    for (std::size_t k = 0; k < kLanes; ++k) over += static_cast<double>(over_[k]);
    out.over_limit_area = over / n;
    out.over_limit_share = sum > 0 ? total(over_sum_) / sum : 0;
  }

 private:
  static void raise(Lanes& most, const Lanes& value) { most = chosen(most < value, value, most); }

  void add_breakdown(const Columns& c, const LaneMask& pulls, const Lanes& field2,
                     const Lanes& pressure) {
    // No gap breaks down below either; up to that of the minimum they are the whole law.
    const Lanes field = kAirStrength * c.air;
    const Lanes limit = chosen(field < kPaschenMinimum, field, all_lanes(kPaschenMinimum));
    const Lanes across = p_.v_peak * c.air;
    LaneMask beyond = pulls & (c.air > 0) & (across * across * field2 > limit * limit);
    const LaneMask wide = beyond & (c.air > kPaschenGap), none{};
    if (std::memcmp(&wide, &none, sizeof wide) != 0) {
      for (std::size_t k = 0; k < kLanes; ++k) {
        if (wide[k] && !breaks_down(p_.v_peak, c.air[k], field2[k])) beyond[k] = 0;
      }
    }
    over_ -= beyond;  // where it holds, -1
    over_sum_ += chosen(beyond, pressure, Lanes{});
  }

  const FieldProblem& p_;
  bool walls_;
  double scale_ = 0.5 * kVacuumPermittivity * square(p_.v_rms);
  double cap_ = p_.breakdown_cap ? 0.5 * kVacuumPermittivity * square(kAirStrength) : HUGE_VAL;
  Lanes sum_{}, over_sum_{}, strongest_film2_{}, strongest_air2_{};
  LaneMask over_{};  // columns beyond
};

}  // namespace

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
  PullSum sum(p, surface && surface->walls);
  for (std::size_t i = 0; i < n; i += kLanes) {
    store_lanes(sum.add({i, surface, p, columns, factors}), out.traction.value, i);
  }
  sum.finish(n, out);
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
    return pull(gap, surface, p, columns, {.open = open, .potential = {}});
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
