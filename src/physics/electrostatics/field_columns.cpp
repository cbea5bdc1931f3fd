#include "physics/electrostatics/field_columns.h"

namespace papilla::electrostatics {
namespace {

// Thinner layers count as this share of a pixel: nothing divides by zero.
constexpr double kThinnest = 1e-4;

}  // namespace

FieldColumns::FieldColumns(const PotentialProblem& problem, int dielectric_cells, int air_cells)
    : grid_(problem.grid),
      below_(dielectric_cells),
      nodes_(dielectric_cells + air_cells + 1),
      z_(grid_.size() * nodes_),
      inverse_height_(z_.size()),
      rise_(z_.size(), 0),
      permittivity_(z_.size(), 1),
      resistance_(z_.size()),
      skin_(grid_.size()),
      top_(grid_.size()) {
  for (std::size_t i = 0; i < grid_.size(); ++i) place_nodes(i, problem);
}

// Nodes are denser towards the dielectric's surface, where flux gathers on contact spots; droplets
// take the air's first or last cell. Any rise of the nodes between the bodies gives the same
// derivative of the exact energy; one that is steep below the skin keeps the corners at the other
// bodies, which a grid does not resolve, out of it.
void FieldColumns::place_nodes(std::size_t column, const PotentialProblem& p) {
  const double thinnest = kThinnest * std::min(grid_.dx(), grid_.dy());
  double *z = &z_[at(column, 0)], *inverse_height = &inverse_height_[at(column, 0)];
  double* rise = &rise_[at(column, 0)];
  double *permittivity = &permittivity_[at(column, 0)], *resistance = &resistance_[at(column, 0)];
  const double surface = p.surface[column];
  const double thickness = std::max(surface - p.electrode[column], thinnest);
  for (int k = 0; k <= below_; ++k) {
    z[k] = surface - thickness * square(1 - static_cast<double>(k) / below_);
    if (k < below_ && !p.dielectric.empty() && p.dielectric[column] > 0)
      permittivity[k] = thickness / p.dielectric[column];
  }
  const double gap = std::max(p.skin[column] - surface, 0.0);
  const auto water = [&](const std::vector<double>& of) {
    return of.empty() ? 0 : std::clamp(of[column], 0.0, gap);
  };
  const double low = water(p.water_below), high = std::min(water(p.water_above), gap - low);
  const double air = std::max(gap - low - high + (high > 0 ? 0 : p.skin_layer), thinnest);
  const int first = below_ + (low > 0 ? 1 : 0);
  const int last = nodes_ - 1 - (high > 0 ? 1 : 0);
  for (int k = first; k <= last; ++k) {
    const double share = static_cast<double>(k - first) / (last - first);
    z[k] = surface + low + air * share;
    rise[k] = square(square(share));
  }
  if (low > 0) permittivity[below_] = kWaterPermittivity;
  if (high > 0) {
    z[nodes_ - 1] = z[last] + high + p.skin_layer;
    rise[nodes_ - 1] = 1;
    permittivity[last] = (high * kWaterPermittivity + p.skin_layer) / (high + p.skin_layer);
  }
  for (int k = 0; k + 1 < nodes_; ++k) {
    resistance[k] = (z[k + 1] - z[k]) / permittivity[k];
    inverse_height[k] = 1 / (z[k + 1] - z[k]);
  }
  if (high > 0) resistance[last] = high / kWaterPermittivity + p.skin_layer;
  const bool bridged = !p.bridged.empty() && p.bridged[column];
  top_[column] = !bridged ? nodes_ - 1 : p.water_skin_layer > 0 ? below_ + 1 : below_;
  // Grounded water stands as high as the body.
  skin_[column] = p.water_skin_layer > 0 ? z[nodes_ - 1] - p.skin_layer : z[nodes_ - 1];
  if (bridged && p.water_skin_layer > 0) resistance[below_] = p.water_skin_layer;
}

}  // namespace papilla::electrostatics
