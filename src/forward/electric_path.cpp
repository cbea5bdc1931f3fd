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

// Share of a layer's d/eps that counts beside what conducts with a corner of its own: the ratio of
// their complex permittivities.
Complex beside(double other_corner, double layer_corner, double f) {
  return Complex(other_corner, f) / Complex(layer_corner, f);
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
  const Complex conducts = 2 * kPi * kVacuumPermittivity * ridges.area *
                           Complex(gap_corner(scene), frequency(scene.drive));
  return std::abs(thickness / conducts);
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
  const double f = frequency(scene.drive), gap = gap_corner(scene);
  const ElectricalLayer& skin = scene.finger.electrical;
  SeriesLayers out;
  for (const FilmDielectric& layer : scene.surface.dielectric) {
    const Complex counts = beside(gap, layer.corner_frequency(), f);
    out.of_film.emplace_back(std::clamp(counts.real(), kThinnest, kThickest), counts.imag());
  }
  out.skin = skin.equivalent_thickness(relative_humidity) * beside(gap, skin.corner_frequency, f);
  return out;
}

double wetted_series(const Scene& scene, double relative_humidity) {
  const double f = frequency(scene.drive);
  const ElectricalLayer& skin = scene.finger.electrical;
  // d/eps of each and, beside water, the part of it that does not conduct.
  Complex all = 0;
  double energy = 0;
  const auto add = [&](double thickness, double corner) {
    const Complex z = thickness * beside(0, corner, f);
    all += z;
    if (thickness > 0) energy += std::norm(z) / thickness;
  };
  for (const FilmDielectric& layer : scene.surface.dielectric)
    add(layer.equivalent_thickness(), layer.corner_frequency());
  add(skin.equivalent_thickness(relative_humidity), skin.corner_frequency);
  return energy > 0 ? std::norm(all) / energy : 0;
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
  double film = skin.equivalent_thickness(relative_humidity);
  double resistance = film > 0 ? film / skin.corner_frequency : 0;
  for (const FilmDielectric& layer : scene.surface.dielectric) {
    film += layer.equivalent_thickness();
    resistance += layer.equivalent_thickness() / layer.corner_frequency();
  }
  const double leaks = gap_corner(scene) / gap + (resistance > 0 ? 1 / resistance : kInfinity);
  return leaks > 0 ? (1 / gap + 1 / film) / (2 * kPi * leaks) : kInfinity;
}

}  // namespace papilla::forward
