#include "forward/counterface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "geometry/texture.h"
#include "physics/contact/closed_forms.h"
#include "physics/persson/persson.h"

namespace papilla::forward {
namespace {

constexpr double kReferenceLoad = 0.2;        // of MacroContact::area_15 [N]
constexpr double kPatch = kWindow * kWindow;  // [m^2]

double area_at(const Pin& pin, const Surface& surface, double load) {
  if (pin.face == PinFace::Flat) return pin.area;
  return kPi * square(Hertz{contact_modulus(pin, surface), pin.radius}.contact_radius(load));
}

// Its roughness within patches and above them, as the finger has that of skin and of ridges.
void share_roughness(const Pin& pin, Skin& skin, MacroContact& macro) {
  const PinRoughness& r = pin.roughness;
  skin.map = r.map;
  skin.map_width = r.map_width;
  skin.hurst = macro.ridge_hurst = r.hurst;
  skin.cutoff = r.cutoff;
  skin.roll_off = std::min(r.roll_off, kWindow);
  skin.rms = macro.ridge_rms = 0;
  if (!r.map.empty() || r.rms <= 0) return;
  const double longest = 2 * kPi / r.longest, patch = 2 * kPi / kWindow,
               cutoff = 2 * kPi / r.cutoff;
  const PowerSpectrum all =
      self_affine_spectrum(r.rms, longest, 2 * kPi / r.roll_off, cutoff, r.hurst);
  if (cutoff > patch) skin.rms = std::sqrt(all.moment(0, patch, cutoff));
  macro.ridge_rms = std::sqrt(all.moment(0, longest, patch));
  macro.ridge_longest = r.longest;
  macro.ridge_roll_off = r.roll_off;
}

}  // namespace

double contact_modulus(const Pin& pin, const Surface& surface) {
  const auto compliance = [](double modulus, double poisson) {
    return (1 - square(poisson)) / modulus;
  };
  const double base =
      surface.base_modulus > 0 ? compliance(surface.base_modulus, surface.base_poisson) : 0;
  return 1 / (compliance(pin.modulus, pin.poisson) + base);
}

double nominal_area(const Pin& pin, const Surface& surface) {
  return area_at(pin, surface, pin.load);
}

Scene touched_by(const Pin& pin, Scene scene) {
  Finger f;
  f.name = pin.name;
  f.load = pin.load;
  f.fitted_to.clear();
  // Both bodies are half-spaces to a patch: their E* counts alone.
  const double modulus = contact_modulus(pin, scene.surface) * (1 - square(pin.poisson));
  Skin& skin = f.skin;
  skin.layer_modulus = skin.bulk_modulus = modulus;
  skin.layer_poisson = skin.bulk_poisson = pin.poisson;
  skin.softening = skin.softening_saturated = 1;
  skin.hardness = pin.hardness;
  skin.relief_saturated = 1;
  MacroContact& macro = f.macro;
  const bool sphere = pin.face == PinFace::Sphere;
  macro.area_15 = area_at(pin, scene.surface, kReferenceLoad);
  macro.load_exponent = sphere ? 2.0 / 3 : 0;
  macro.area_growth = macro.shear_fall = macro.shear_fall_saturated = 0;
  macro.ridge_share = macro.load_share = 1;
  macro.shear_strength = pin.shear_strength;
  macro.pressure_peak = sphere ? 1.5 : 1;  // over the mean one, of Hertz' circle
  macro.far_gaps = 1;
  macro.corneum_thickness = kInfinity;  // the same all through
  macro.tissue_modulus = modulus;
  share_roughness(pin, skin, macro);
  f.electrical = {
      .thickness_15 = 0, .thickness_75 = 0, .corner_frequency = 0, .gap_resistivity = 0};
  f.water.relative_humidity = {0.5};
  f.water.volume = {pin.water};
  f.water.contact_angle = pin.contact_angle;
  scene.model.closure = macro.ridge_rms > 0 ? Closure::Balance : Closure::Uniform;
  f.calibrated_for = scene.model;
  scene.finger = std::move(f);
  // The surface states its friction against skin.
  scene.surface.shear_strength = scene.surface.shear_strength_natural =
      scene.surface.shear_strength_wet = 0;
  scene.touch = {pin.coefficient, pin.conducting, pin.name};
  if (!pin.conducting) scene.drive.amplitude = scene.drive.current = 0;
  return scene;
}

std::string pin_refusal(const Pin& pin, const Surface& surface) {
  const double area = nominal_area(pin, surface);
  if (area < kPatch)
    return fmt::format(
        "its contact of {:.3g} um2 is smaller than a patch of {:.3g} um2: features are not small "
        "against it; a larger radius, area or load",
        1e12 * area, 1e12 * kPatch);
  const double pressure = pin.load / area;
  if (pin.hardness > 0 && pressure >= pin.hardness)
    return fmt::format(
        "its mean pressure of {:.3g} MPa reaches its hardness of {:.3g} MPa: it flows; a larger "
        "radius or area, or less load",
        1e-6 * pressure, 1e-6 * pin.hardness);
  if (surface.modulus > 0 && surface.base_modulus > 0)
    return "surface.modulus and surface.base_modulus are both given: features that yield stand on "
           "what does not; leave one out";
  return {};
}

}  // namespace papilla::forward
