#include "forward/electric_path.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <tuple>

#include "base/cache.h"
#include "base/constants.h"
#include "forward/ridges.h"
#include "physics/macro/fingertip.h"

namespace papilla::forward {
namespace {

using Complex = std::complex<double>;

// Stands for a constant voltage: below every corner that a material has [Hz].
constexpr double kConstant = 1e-9;

double frequency(const Drive& drive) {
  return drive.waveform == Waveform::Dc ? kConstant : std::max(drive.frequency, kConstant);
}

// A layer whose d/eps counts so little or so much has next to nothing, or all, of the voltage.
constexpr double kThinnest = 1e-4, kThickest = 1e4;

double gap_corner(const Scene& scene) {
  return corner_frequency(1, scene.finger.electrical.gap_resistivity);
}

// Complex permittivities over that of the lossless material, times the frequency [Hz]: what an
// element conducts, its storing part along the imaginary axis.
//
// A resistor beside a capacitor.
Complex conducts(double corner, double f) { return {corner, f}; }

// Of a layer of the film: its resistor beside what stores and relaxes. Eq. drive.22
Complex layer_conducts(const Dielectric& layer, double f) {
  if (layer.relaxation.law == RelaxationLaw::None) return conducts(layer.corner_frequency(), f);
  return layer.corner_frequency() + Complex(0, f) * layer.relaxation.share(layer.permittivity, f);
}

// Of the stratum corneum: a resistor beside a constant-phase element that is the capacitor of the
// stated thickness at `dispersion_frequency`. Eq. drive.19
Complex skin_conducts(const ElectricalLayer& skin, double f) {
  if (skin.skin_exponent == 1) return conducts(skin.corner_frequency, f);  // to the last bit
  const double turned = 0.5 * kPi * skin.skin_exponent;
  const double stores = f * std::pow(f / skin.dispersion_frequency, skin.skin_exponent - 1);
  return {skin.corner_frequency + stores * std::cos(turned), stores * std::sin(turned)};
}

// Of the gap: its capacitor of air beside leakage whose conductance rises above its corner. Eq.
// drive.20
Complex gap_conducts(const Scene& scene, double f) {
  const double corner = gap_corner(scene), exponent = scene.finger.electrical.gap_exponent;
  if (exponent == 1 || corner <= 0) return conducts(corner, f);
  return Complex(0, f) + corner * std::pow(Complex(1, f / corner), 1 - exponent);
}

// Volts that one ampere through the finger needs, peak for peak.
double impedance(const Scene& scene, double relative_humidity) {
  const Finger& finger = scene.finger;
  const RidgeLoad ridges = ridge_load(finger.macro, finger.load, relative_humidity);
  if (ridges.area <= 0) return kInfinity;
  const SeriesLayers layers = series_layers(scene, relative_humidity);
  const double gap =
      capacitive_gap(finger, ridges.mean_pressure, scene.surface.equivalent_thickness(),
                     relative_humidity, rings_of(scene.model, finger.macro));
  const Complex thickness = gap + layers.film(scene.surface) + layers.skin;
  const Complex per_thickness =
      2 * kPi * kVacuumPermittivity * ridges.area * gap_conducts(scene, frequency(scene.drive));
  return std::abs(thickness / per_thickness);
}

// What the impedance depends on.
using ImpedanceKey = std::tuple<double, Finger, Surface, Waveform, double, Closure>;

double known_impedance(const Scene& scene, double relative_humidity) {
  static Cache<ImpedanceKey, double> cache(64, 64);
  const ImpedanceKey key{relative_humidity,    scene.finger,          scene.surface,
                         scene.drive.waveform, scene.drive.frequency, scene.model.closure};
  return *cache.get(
      key, 1, [&] { return std::make_shared<const double>(impedance(scene, relative_humidity)); });
}

}  // namespace

Complex SeriesLayers::film(const Surface& surface) const {
  Complex sum = 0;
  for (std::size_t k = 0; k < of_film.size(); ++k)
    sum += of_film[k] * surface.dielectric[k].equivalent_thickness();
  return sum;
}

SeriesLayers series_layers(const Scene& scene, double relative_humidity) {
  const double f = frequency(scene.drive);
  // Share of a layer's d/eps that counts in the gap: the ratio of their complex permittivities.
  const Complex gap = gap_conducts(scene, f);
  SeriesLayers out;
  for (const FilmDielectric& layer : scene.surface.dielectric) {
    const Complex counts = gap / layer_conducts(layer, f);
    out.of_film.emplace_back(std::clamp(counts.real(), kThinnest, kThickest), counts.imag());
  }
  const Complex counts = gap / skin_conducts(scene.finger.electrical, f);
  out.skin = scene.finger.skin_layer(relative_humidity) * counts;
  return out;
}

std::vector<Complex> film_divider(const Surface& surface, const Drive& drive) {
  const double f = frequency(drive);
  std::vector<Complex> out;
  for (const FilmDielectric& layer : surface.dielectric) {
    out.push_back(out.empty()
                      ? 1.0
                      : layer_conducts(surface.dielectric.front(), f) / layer_conducts(layer, f));
  }
  return out;
}

double wetted_series(const Scene& scene, double relative_humidity) {
  const double f = frequency(scene.drive);
  // d/eps of each and, beside water, the part of it that does not conduct.
  Complex all = 0;
  double energy = 0;
  const auto add = [&](double thickness, Complex layer) {
    const Complex z = thickness * (Complex(0, f) / layer);
    all += z;
    if (thickness > 0) energy += std::norm(z) / thickness * (layer.imag() / f);
  };
  for (const FilmDielectric& layer : scene.surface.dielectric)
    add(layer.equivalent_thickness(), layer_conducts(layer, f));
  add(scene.finger.skin_layer(relative_humidity), skin_conducts(scene.finger.electrical, f));
  return energy > 0 ? std::norm(all) / energy : 0;
}

double water_skin_layer(const Scene& scene, double relative_humidity, double dielectric) {
  const double f = frequency(scene.drive);
  const auto beside_water = [&](double thickness, Complex layer) {
    return thickness * (Complex(0, f) / layer);
  };
  const Complex skin = beside_water(scene.finger.skin_layer(relative_humidity),
                                    skin_conducts(scene.finger.electrical, f));
  Complex film = 0;
  for (const FilmDielectric& layer : scene.surface.dielectric)
    film += beside_water(layer.equivalent_thickness(), layer_conducts(layer, f));
  const double share = std::abs(skin) / std::max(std::abs(skin + film), 1e-300);
  // Eq. drive.21; behind a film that leads the water is at the electrode's potential, nearly.
  return dielectric * std::min(share / std::max(1 - share, 1 / kThickest), kThickest);
}

SourceVoltage source_voltage(const Scene& scene, double relative_humidity) {
  const Drive& drive = scene.drive;
  SourceVoltage out;
  out.peak = drive.amplitude;
  if (drive.control == DriveControl::Current) {
    out.peak = drive.current > 0 ? drive.current * known_impedance(scene, relative_humidity) : 0;
    out.at_compliance = drive.source_compliance > 0 && out.peak > drive.source_compliance;
    if (out.at_compliance) out.peak = drive.source_compliance;
  }
  out.rms = out.peak * drive.rms_of_peak();
  return out;
}

double relaxation_time(const Scene& scene, double relative_humidity, double gap) {
  // Charge between film and gap: of capacitances in parallel through conductances in parallel.
  const ElectricalLayer& skin = scene.finger.electrical;
  // d/eps over the corner is resistance: of layers in series they add up.
  double film = scene.finger.skin_layer(relative_humidity);
  double resistance = film > 0 ? film / skin.corner_frequency : 0;
  for (const FilmDielectric& layer : scene.surface.dielectric) {
    film += layer.equivalent_thickness();
    resistance += layer.equivalent_thickness() / layer.corner_frequency();
  }
  if (film <= 0) return 0;  // bare conductors on both sides keep no charge from the gap
  const double leaks = gap_corner(scene) / gap + (resistance > 0 ? 1 / resistance : kInfinity);
  return leaks > 0 ? (1 / gap + 1 / film) / (2 * kPi * leaks) : kInfinity;
}

}  // namespace papilla::forward
