#include "forward/scene_terms.h"

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "physics/electrostatics/electrowetting.h"
#include "physics/electrostatics/rules.h"

namespace papilla::forward {

std::shared_ptr<const ContactKernel> contact_kernel(const Scene& scene, const Grid& grid,
                                                    double relative_humidity) {
  const Skin& skin = scene.finger.skin;
  const double factor = scene.surface.modulus > 0 ? skin.modulus_factor(relative_humidity) : 1;
  return make_contact_kernel(grid,
                             {skin.layer_modulus * factor, skin.layer_poisson, skin.layer_thickness,
                              skin.bulk_modulus * factor, skin.bulk_poisson, scene.surface.modulus,
                              scene.surface.poisson});
}

WaterProperties water_properties(const Scene& scene, double substrate_angle) {
  const SkinWater& water = scene.finger.water;
  return {water.surface_tension, water.contact_angle, substrate_angle, water.hysteresis};
}

bool capillary_off_counts(const Scene& scene) {
  return scene.model.preset == Preset::Papilla || !scene.surface.repels_water();
}

bool retention_counts(const Scene& scene) {
  return scene.model.preset == Preset::Papilla || scene.surface.repels_water();
}

FieldMethod field_method(const ModelOptions& model) {
  const bool paper = model.preset == Preset::M3 && model.field == FieldMethod::Spread;
  return paper ? FieldMethod::Local : model.field;
}

FieldSolution solve_field(const Scene& scene, const Gap& gap, const CoveredSurface* surface,
                          const Wetting& wetting, const FieldProblem& problem, double tolerance) {
  return field_rule(field_method(scene.model)).solve(gap, surface, wetting, problem, tolerance);
}

std::vector<FilmLayer> film_of(const Scene& scene) {
  std::vector<FilmLayer> film = film_layers(scene.surface);
  if (scene.model.preset == Preset::M3) {
    for (FilmLayer& layer : film)
      layer = {FilmProcess::Directional, 0, layer.thickness, layer.permittivity};
  }
  return film;
}

FieldProblem field_problem(const Scene& scene, double relative_humidity) {
  FieldProblem p;
  p.v_rms = scene.drive.v_rms();
  p.v_peak = scene.drive.amplitude;
  p.dielectric = scene.surface.equivalent_thickness();
  p.dielectric_thickness = scene.surface.dielectric_thickness();
  p.edge_radius = scene.surface.electrode_edge_radius;
  // Stratum corneum in series: conducts below its corner frequency, h(w) = h / (1 + i wc/w).
  const double h = scene.finger.electrical.equivalent_thickness(relative_humidity);
  const double corner = scene.finger.electrical.corner_frequency;
  const double f = scene.drive.waveform == Waveform::Dc ? 0 : scene.drive.frequency;
  p.skin_layer = corner > 0 ? (f > 0 ? h / std::complex<double>(1, corner / f) : 0.0) : h;
  p.breakdown_cap = scene.model.breakdown_cap;
  p.droplet_enhancement = scene.model.droplet_enhancement;
  if (scene.model.preset == Preset::M3) {
    p.zero_under_droplets = true;
    p.screening = false;
    p.droplet_enhancement = false;
  }
  return p;
}

double driven_contact_angle(const Scene& scene, double relative_humidity) {
  if (!scene.drive.driven()) return scene.surface.contact_angle;
  const double undriven = scene.surface.contact_angle;
  const double saturated = scene.finger.saturation.angle(undriven);
  const FieldProblem field = field_problem(scene, relative_humidity);
  const double eta =
      electrowetting_number(scene.drive.amplitude, field.dielectric + std::abs(field.skin_layer),
                            scene.finger.water.surface_tension);
  const bool sine = scene.drive.waveform == Waveform::Sine || scene.drive.waveform == Waveform::Am;
  return std::acos(std::clamp(
      electrowetted_cosine(std::cos(undriven), std::cos(saturated), eta, sine), -1.0, 1.0));
}

}  // namespace papilla::forward
