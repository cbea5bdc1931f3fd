#include "physics/electrostatics/full_field.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "physics/electrostatics/breakdown.h"
#include "physics/electrostatics/electrode.h"

namespace papilla::electrostatics {
namespace {

// Share of a gap that droplets fill at most: as in the local rule a tenth of it stays air.
constexpr double kMostWater = 0.9;

std::vector<double> columns_in_state(const Grid& grid, const Wetting& wetting, DropletState state) {
  Wetting some;
  some.grid = wetting.grid;
  for (const Droplet& d : wetting.droplets) {
    if (d.state == state) some.droplets.push_back(d);
  }
  if (some.droplets.empty()) return {};
  return droplet_columns(grid, some);
}

// Droplets that do not bridge as dielectric layers of their heights.
void add_droplets(const Gap& gap, const Wetting& wetting, PotentialProblem& potential) {
  potential.water_below = columns_in_state(gap.grid, wetting, DropletState::OnSubstrate);
  potential.water_above = columns_in_state(gap.grid, wetting, DropletState::OnSkin);
  for (std::size_t i = 0; i < gap.value.size(); ++i) {
    const double below = potential.water_below.empty() ? 0 : potential.water_below[i];
    const double above = potential.water_above.empty() ? 0 : potential.water_above[i];
    if (below + above <= kMostWater * gap.value[i]) continue;
    const double share = kMostWater * gap.value[i] / (below + above);
    if (below > 0) potential.water_below[i] *= share;
    if (above > 0) potential.water_above[i] *= share;
  }
}

PotentialProblem potential_problem(const Gap& gap, const CoveredSurface* surface,
                                   const Wetting& wetting, const FieldProblem& p) {
  const std::size_t n = gap.grid.size();
  PotentialProblem potential;
  potential.grid = gap.grid;
  potential.surface = surface ? surface->height.z : std::vector<double>(n, 0);
  potential.electrode.resize(n);
  potential.skin.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    potential.electrode[i] =
        potential.surface[i] - (surface ? surface->film[i] : p.dielectric_thickness);
    potential.skin[i] = potential.surface[i] + gap.value[i];
  }
  potential.dielectric = surface ? surface->dielectric : std::vector<double>(n, p.dielectric);
  potential.skin_layer = p.skin_layer.real();
  potential.water_skin_layer = p.water_skin_layer;
  if (p.screening) potential.bridged = wetting.bridged;
  if (p.droplet_enhancement && !p.zero_under_droplets) add_droplets(gap, wetting, potential);
  return potential;
}

// Of the flux, squared, that the layer's real part leaves; for a flat stack exactly Eq.
// electrostatics.1.
double through_skin(double square_field, const FieldProblem& p) {
  return square_field / (1 + std::max(square_field, 0.0) * square(p.skin_layer.imag()));
}

// Eq. electrostatics.14 on every pixel that is not bridged.
void add_pull(const PotentialSolution& s, const Gap& gap, const Wetting& wetting,
              const FieldProblem& p, FieldSolution& out) {
  const std::size_t n = gap.grid.size();
  std::vector<double> hidden;  // preset m3: no pull under any droplet
  if (p.zero_under_droplets && !wetting.droplets.empty()) {
    hidden = droplet_columns(gap.grid, wetting);
  }
  const double scale = 0.5 * kVacuumPermittivity * square(p.v_rms);
  const double peak2 = (p.steady ? 1 : 2) * square(p.v_rms);
  double sum = 0, over_sum = 0;
  std::size_t over = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (!wetting.bridged.empty() && wetting.bridged[i]) continue;
    if (!hidden.empty() && hidden[i] > 0) continue;
    const double square_field = through_skin(s.square_field[i], p);
    const double g = gap.value[i];
    double pressure = scale * square_field;
    if (field_is_held(p) && square_field > 0) {
      const double most = std::min(air_field_limit(p.air_limit, std::max(g, 0.0)), p.film_holds);
      pressure *= clipped_share(most / std::sqrt(peak2 * square_field), p.steady);
    }
    out.traction.value[i] = pressure;
    sum += pressure;
    if (g > 0 && square_field > 0 &&
        std::min(p.v_peak * std::sqrt(square_field), p.film_holds) * g > air_breakdown_voltage(g)) {
      ++over;
      over_sum += pressure;
    }
  }
  out.mean_pressure = sum / static_cast<double>(n);
  out.over_limit_area = static_cast<double>(over) / static_cast<double>(n);
  out.over_limit_share = sum > 0 ? over_sum / sum : 0;
}

// Eq. electrostatics.9: of the voltage over a column's film, as ColumnLaw has it.
double peak_oxide_field(const PotentialSolution& s, const CoveredSurface* surface,
                        const Wetting& wetting, const FieldProblem& p) {
  if (p.dielectric_thickness <= 0) return 0;
  double strongest = 0;
  for (std::size_t i = 0; i < s.surface_potential.size(); ++i) {
    const double film = surface ? surface->effective[i] : p.dielectric;
    if (film <= 0) continue;
    const double flux = (1 - s.surface_potential[i]) / film;
    double of_film =
        std::min(p.film_phase * flux / std::hypot(1, p.skin_layer.imag() * flux), 1 / film);
    if (p.film_holds < kInfinity) {
      // Under water by the flux that the film itself has. Eq. electrostatics.22
      const bool bridge = p.screening && !wetting.bridged.empty() && wetting.bridged[i];
      const double field =
          bridge ? of_film : std::sqrt(std::max(through_skin(s.square_field[i], p), 0.0));
      const double held = std::min(p.film_holds / (p.v_peak * field), 1.0);
      of_film = share_on_film(film * of_film, held) / film;
    }
    strongest = std::max(strongest, of_film);
  }
  const double corner = surface && surface->walls && p.edge_radius > 0
                            ? corner_factor(p.dielectric_thickness, p.edge_radius)
                            : 1;
  return p.v_peak * strongest * p.dielectric / p.dielectric_thickness * corner;
}

}  // namespace

bool knows_skin_layer(const Grid& grid, const FieldProblem& problem) {
  constexpr double kOfPatch = 0.1;
  return problem.skin_layer.real() <= kOfPatch * std::min(grid.lx, grid.ly);
}

double full_field_seconds(const Grid& grid) { return 3e-6 * static_cast<double>(grid.size()); }

FieldSolution solve_full_field(const Gap& gap, const CoveredSurface* surface,
                               const Wetting& wetting, const FieldProblem& p,
                               const PotentialOptions& options) {
  FieldSolution out;
  const Grid& grid = gap.grid;
  out.traction = {grid, std::vector<double>(grid.size(), 0)};
  if (p.v_rms == 0 && p.v_peak == 0) return out;
  if (!knows_skin_layer(grid, p)) {
    out.ok = false;
    out.reason = fmt::format(
        "the skin's layer counts like {:.3g} um of air, more than a tenth of the patch: too thick "
        "for the 3-D field, in which flux spreads there; field = \"spread\" knows it",
        1e6 * p.skin_layer.real());
    return out;
  }
  const PotentialSolution s = solve_potential(potential_problem(gap, surface, wetting, p), options);
  out.residual = s.residual;
  out.iterations = s.iterations;
  out.ok = s.ok;
  out.reason = s.reason;
  if (s.iterations == 0 && !s.ok) return out;
  add_pull(s, gap, wetting, p, out);
  out.peak_air_field = std::min(p.v_peak * s.peak_air, p.film_holds);
  out.peak_oxide_field = peak_oxide_field(s, surface, wetting, p);
  return out;
}

}  // namespace papilla::electrostatics
