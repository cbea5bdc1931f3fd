#include "physics/electrostatics/field.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/constants.h"
#include "numerics/loops.h"
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

// The air of a column breaks down: the voltage across it is beyond Paschen's.
bool breaks_down(double v_peak, double air, double field2) {
  return air > 0 && square(v_peak * air) * field2 > square(air_breakdown_voltage(air));
}

// Of one column or of several (numerics/loops.h).
template <class T>
struct Column {
  T open, film, air, water, potential;
};

// What a column with these media carries.
template <class T>
struct ColumnPull {
  T pressure;                 // [Pa]
  T air_field2, film_field2;  // as in Strongest
  T over_limit;               // 1 where the air breaks down
};

class ColumnLaw {
 public:
  // spread: the potential on the film is known, not that of the column.
  ColumnLaw(const FieldProblem& p, bool spread) : p_(p), spread_(spread) {}

  template <class T>
  ColumnPull<T> operator()(const Column<T>& c) const {
    // A gap that is no number pulls: the sum must show it.
    const auto bridge = c.open <= 0.0, pulls = !bridge && !(c.air < 0.0), film = c.film > 0.0;
    const T reach = c.air + c.film + p_.skin_layer.real() + kPerWater * c.water;
    const T series2 = reach * reach + square(p_.skin_layer.imag());
    const T per_film = 1 / c.film, per_film2 = per_film * per_film;
    // Under water: what the divider leaves, or the potential that the water has.
    const T dry =
        1 - (spread_ ? c.potential : p_.water_skin_layer / (p_.water_skin_layer + c.film));
    // Squared, per volt: the field in the air, what is over the film's d/eps [1/m^2].
    T field2, of_film2;
    if (spread_) {
      // The flux over that of the column alone.
      const T skin = to_skin(c.air, c.water, p_.skin_layer.real());
      const T gain = c.potential * (skin + c.film), left = 1 - c.potential;
      const T flux2 = left * left * per_film2;
      field2 = gain * gain / (skin * skin * series2);
      of_film2 = flux2 / (1 + square(p_.skin_layer.imag()) * flux2);
    } else {
      of_film2 = field2 = 1 / series2;
    }
    ColumnPull<T> out;
    out.pressure = chosen(pulls, scale_ * field2 * c.open, 0.0);
    if (field_is_held(p_)) {
      // Eqs. electrostatics.21, 22
      const T most = smaller(air_field_limit(p_.air_limit, larger(c.air, T(0))), p_.film_holds);
      out.pressure = out.pressure * clipped_share(most / root(peak2_ * field2), p_.steady);
    }
    of_film2 = chosen(bridge, dry * dry * per_film2, of_film2) * square(p_.film_phase);
    of_film2 = smaller(of_film2, per_film2);
    // A film that saturates leaves the air no more than this. Eq. electrostatics.22
    const T air2 = smaller(T(most2_), field2);
    if (p_.film_holds < kInfinity) {
      // Under water by the flux that the film itself has.
      const T held2 = smaller(most2_ / chosen(bridge, of_film2, field2), T(1));
      const T on_film = share_on_film(c.film * root(of_film2), root(held2));
      of_film2 = on_film * on_film * per_film2;
    }
    out.film_field2 = chosen((pulls || bridge) && film, of_film2, 0.0);
    const auto with_air = pulls && c.air > 0.0;
    out.air_field2 = chosen(with_air, air2, 0.0);
    // No gap breaks down below either; up to that of the minimum they are the whole law.
    const T limit = smaller(kAirStrength * c.air, kPaschenMinimum), across = p_.v_peak * c.air;
    const auto beyond = with_air && across * across * air2 > limit * limit;
    const auto lasts = holds_for(
        beyond && c.air > kPaschenGap,
        [&](double air, double squared) { return !breaks_down(p_.v_peak, air, squared); }, c.air,
        air2);
    out.over_limit = chosen(beyond && !lasts, 1.0, 0.0);
    return out;
  }

 private:
  const FieldProblem& p_;
  bool spread_;
  double scale_ = 0.5 * kVacuumPermittivity * square(p_.v_rms);
  double most2_ = square(p_.film_holds / p_.v_peak);  // of the air's field, as in Strongest
  // Of a sine with the effective voltage, or that voltage.
  double peak2_ = (p_.steady ? 1 : 2) * square(p_.v_rms);
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
  const ColumnLaw law(p, !factors.potential.empty());
  const std::span<const double> film =
      surface ? std::span<const double>(surface->effective) : std::span<const double>();
  const auto [pulled, air2, film2, over, pulled_over] = reduce(n, [&](auto at) {
    const ColumnPull c = law(Column{at(factors.open, 1), at(film, p.dielectric), at(columns.air),
                                    at(columns.water, 0), at(factors.potential, 0)});
    at.store(out.traction.value, c.pressure);
    return std::tuple(c.pressure, Largest(c.air_field2), Largest(c.film_field2), c.over_limit,
                      chosen(c.over_limit > 0.0, c.pressure, 0.0));
  });
  if (!std::isfinite(pulled)) {
    out.ok = false;
    out.reason = "the pull is not finite";
    return out;
  }
  set_peaks(p, surface && surface->walls, {air2, film2}, out);
  const auto pixels = static_cast<double>(n);
  out.mean_pressure = pulled / pixels;
  out.over_limit_area = over / pixels;
  out.over_limit_share = pulled > 0 ? pulled_over / pulled : 0;
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
    return screening_factor(gap, wetting,
                            {p.dielectric_thickness, p.dielectric, p.water_skin_layer}, fade);
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
