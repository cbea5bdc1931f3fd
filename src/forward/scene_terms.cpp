#include "forward/scene_terms.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/constants.h"
#include "forward/electric_path.h"
#include "physics/electrostatics/electrowetting.h"
#include "physics/electrostatics/rules.h"

namespace papilla::forward {

Scene in_its_state(const Scene& scene) {
  Scene out = scene;
  out.finger = scene.finger.applied();
  Surface& surface = out.surface;
  const MacroContact& macro = out.finger.macro;
  if (scene.finger.macro.shear_strength > 0)
    surface.shear_strength *= macro.shear_strength / scene.finger.macro.shear_strength;
  // What a surface says of a state itself stands in place of the finger's factor. Eq. scene.12
  if (scene.finger.state == FingerState::Natural && surface.shear_strength_natural > 0)
    surface.shear_strength = surface.shear_strength_natural;
  if (scene.finger.state == FingerState::Wet && surface.shear_strength_wet > 0 &&
      macro.shear_strength > 0)
    // It is that of saturated skin, which has lost to the water what skin at 15 % RH has not.
    surface.shear_strength =
        surface.shear_strength_wet * macro.shear_strength / macro.shear_strength_at(1);
  return out;
}

double CompliantBody::compliance(const Surface& surface) const {
  if (!present() || surface.modulus <= 0) return 0;
  const double nu = surface.poisson;
  // Laterally confined: it does not bulge between neighbours. Eq. contact.17
  return thickness * (1 + nu) * (1 - 2 * nu) / (surface.modulus * (1 - nu) * solid);
}

CompliantBody compliant_body(const Surface& surface, const Heightmap& height) {
  if (surface.modulus <= 0 || height.z.empty()) return {};
  const double floor = *std::min_element(height.z.begin(), height.z.end());
  double sum = 0, square_sum = 0;
  for (const double z : height.z) {
    sum += z - floor;
    square_sum += square(z - floor);
  }
  if (sum <= 0) return {};
  const double thickness = square_sum / sum;
  return {thickness, sum / static_cast<double>(height.z.size()) / thickness};
}

double shear_strength(const Scene& scene, double relative_humidity) {
  const MacroContact& macro = scene.finger.macro;
  const double of_finger = macro.shear_strength_at(relative_humidity, scene.finger.skin.hydration);
  if (scene.surface.shear_strength <= 0 || macro.shear_strength <= 0) return of_finger;
  return of_finger * scene.surface.shear_strength / macro.shear_strength;
}

std::shared_ptr<const ContactKernel> contact_kernel(const Scene& scene, const CompliantBody& body,
                                                    const Grid& grid, double relative_humidity) {
  const Skin& skin = scene.finger.skin;
  const double factor = body.present() ? skin.modulus_factor(relative_humidity) : 1;
  return make_contact_kernel(
      grid, {skin.layer_modulus * factor, skin.layer_poisson, skin.layer_thickness,
             skin.bulk_modulus * factor, skin.bulk_poisson,
             body.present() ? scene.surface.modulus : 0, scene.surface.poisson, body.thickness});
}

WaterProperties water_properties(const Scene& scene, double substrate_angle) {
  const SkinWater& water = scene.finger.water;
  return {water.surface_tension, water.contact_angle, substrate_angle, water.hysteresis,
          scene.model.preset == Preset::M3};
}

namespace {

// Whether the pressure of a bridge draws skin and surface together.
bool bridges_pull(const Scene& scene) {
  return wetting_gain(scene.finger.applied().water.contact_angle, scene.surface.contact_angle) > 0;
}

}  // namespace

bool capillary_off_counts(const Scene& scene) {
  return scene.model.preset == Preset::Papilla || bridges_pull(scene);
}

bool retention_counts(const Scene& scene) {
  return scene.model.preset == Preset::Papilla || !bridges_pull(scene);
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
  // A layer that conducts more than the gap is thinner to the field by that, one that conducts less
  // is thicker; humidity does not reach it.
  const SeriesLayers series = series_layers(scene, 0.5);
  for (std::size_t k = 0; k < film.size(); ++k) film[k].permittivity /= series.of_film[k].real();
  if (scene.model.preset == Preset::M3) {
    for (FilmLayer& layer : film)
      layer = {FilmProcess::Directional, 0, layer.thickness, layer.permittivity};
  }
  return film;
}

FieldProblem field_problem(const Scene& scene, double relative_humidity) {
  FieldProblem p;
  const SourceVoltage source = source_voltage(scene, relative_humidity);
  p.v_rms = source.rms;
  p.v_peak = source.peak;
  for (const FilmLayer& layer : film_of(scene))
    p.dielectric += layer.thickness / layer.permittivity;
  p.dielectric_thickness = scene.surface.dielectric_thickness();
  p.edge_radius = scene.surface.electrode_edge_radius;
  // What of the film lags behind counts like that of the skin, as on a flat surface. Eq. drive.12
  const SeriesLayers series = series_layers(scene, relative_humidity);
  const std::complex<double> film = series.film(scene.surface);
  p.skin_layer = series.skin + std::complex<double>(0, film.imag());
  p.film_phase = film.real() > 0 ? std::abs(film) / film.real() : 1;
  p.water_skin_layer = water_skin_layer(scene, relative_humidity, p.dielectric);
  p.air_limit = scene.model.air_limit;
  p.film_holds = scene.surface.saturated_air_field();
  p.steady = scene.drive.waveform == Waveform::Dc || scene.drive.waveform == Waveform::Square;
  p.droplet_enhancement = scene.model.droplet_enhancement;
  if (scene.model.preset == Preset::M3) {
    p.zero_under_droplets = true;
    p.even_screening = true;
    p.water_skin_layer = 0;  // the paper's water is at the body's potential
    p.droplet_enhancement = false;
  }
  return p;
}

double driven_contact_angle(const Scene& scene, double relative_humidity) {
  if (!scene.drive.driven()) return scene.surface.contact_angle;
  const double undriven = scene.surface.contact_angle;
  const double saturated = scene.finger.saturation.angle(undriven);
  // A modulated carrier counts as the sine that has its mean square.
  const bool modulated = scene.drive.waveform == Waveform::Am;
  const SourceVoltage source = source_voltage(scene, relative_humidity);
  const double peak = modulated ? std::numbers::sqrt2 * source.rms : source.peak;
  const double series = wetted_series(scene, relative_humidity);
  const double eta = electrowetting_number(peak, series, scene.finger.water.surface_tension);
  // Eq. electrostatics.22: below water a film takes no more charge from here on; a bare electrode
  // has no film that would.
  const double held = series > 0 ? scene.surface.saturated_air_field() * series / peak : 1;
  const bool sine = modulated || scene.drive.waveform == Waveform::Sine;
  return std::acos(std::clamp(
      electrowetted_cosine(std::cos(undriven), std::cos(saturated), eta, sine, held), -1.0, 1.0));
}

}  // namespace papilla::forward
