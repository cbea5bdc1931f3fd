#include "scene/environment.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace papilla::scene {

void fields(FieldVisitor& v, Environment& s) {
  v.numbers({"relative_humidity", "%", 0, 100, "humidities at which the design is judged",
             Source::Paper, "M3"},
            s.relative_humidity);
  v.numbers({"weights", "", 0, 1e6, "weight of each humidity; default: equal"}, s.weights);
}

double corner_frequency(double permittivity, double resistivity) {
  return resistivity > 0 ? 1 / (2 * kPi * kVacuumPermittivity * permittivity * resistivity) : 0;
}

std::complex<double> Relaxation::share(double at_rest, double f) const {
  switch (law) {
    case RelaxationLaw::None:
      return 1;
    case RelaxationLaw::Debye:
    case RelaxationLaw::ColeCole: {
      const std::complex<double> turns(0, 2 * kPi * f * time);
      const double width = law == RelaxationLaw::Debye ? 1 : 1 - alpha;
      const double rest = infinite / at_rest;
      return rest + (1 - rest) / (1.0 + std::pow(turns, width));
    }
    case RelaxationLaw::Table:
      break;
  }
  const auto after = std::upper_bound(frequency.begin(), frequency.end(), f);
  const auto k = static_cast<std::size_t>(after - frequency.begin());
  const auto at = [&](std::size_t i) {
    return std::complex(permittivity[i], loss.empty() ? 0 : -loss[i]) / at_rest;
  };
  if (k == 0) return at(0);
  if (k == frequency.size()) return at(k - 1);
  const double t = std::log(f / frequency[k - 1]) / std::log(frequency[k] / frequency[k - 1]);
  return (1 - t) * at(k - 1) + t * at(k);
}

void fields(FieldVisitor& v, Relaxation& s) {
  v.choice({"law",
            "how the permittivity falls with frequency: not at all, by one relaxation (Debye), by "
            "a wide one (Cole and Cole), or by a table"},
           {"none", "debye", "cole_cole", "table"}, s.law);
  v.number({"infinite", "", 1, 1e5, "permittivity far above the relaxation (debye, cole_cole)"},
           s.infinite);
  v.number({"time", "us", 0, 1e12, "of the relaxation: half of it has gone at 1/(2 pi time)"},
           s.time);
  v.number({"alpha", "", 0, 0.99, "cole_cole: 0 is Debye's relaxation, more is wider"}, s.alpha);
  v.numbers({"frequency", "Hz", 1e-9, 1e12, "table: rising frequencies"}, s.frequency);
  v.numbers({"permittivity", "", 1, 1e5, "table: the storing part there"}, s.permittivity);
  v.numbers({"loss", "", 0, 1e5, "table: the lossy part there; none: lossless"}, s.loss);
}

void fields(FieldVisitor& v, Dielectric& s) {
  v.text({"material", "name"}, s.material);
  v.number({"thickness", "nm", 0, 1e7, "layer thickness", Source::Paper, "M3: 500 nm wet oxide"},
           s.thickness);
  v.number({"permittivity", "", 1, 1e5, "relative permittivity", Source::Paper, "SiO2 3.9"},
           s.permittivity);
  v.number({"resistivity", "ohm m", 0, 1e30,
            "resistivity: below 1/(2 pi eps0 eps rho) the layer conducts; 0: a perfect insulator",
            Source::Estimate, "thermal oxide"},
           s.resistivity);
  v.number({"strength", "V/um", 0, 1e6, "breakdown field", Source::Measured,
            "SiO2 1 GV/m at 50 nm (McPherson 2016)"},
           s.strength);
  v.section({"relaxation", "how the permittivity falls with frequency"}, s.relaxation);
  v.number({"saturation_field", "V/um", 0, 1e6,
            "field in the layer from which its polarisation no longer grows; 0: it grows on"},
           s.saturation_field);
}

void fields(FieldVisitor& v, FilmDielectric& s) {
  fields(v, static_cast<Dielectric&>(s));
  v.choice({"process", "how this layer was made; surface: as surface.process says"},
           {"surface", "conformal", "directional", "planar"}, s.process);
  v.number({"refractive_index", "", 0, 5,
            "refractive index (optics only): an anti-reflective stack, a hard coat; 0: "
            "surface.refractive_index"},
           s.refractive_index);
  v.number({"extinction", "", 0, 5, "extinction coefficient k of n + i k (optics only)"},
           s.extinction);
}

FilmProcess FilmDielectric::made_by(FilmProcess of_surface) const {
  switch (process) {
    case LayerProcess::Surface:
      return of_surface;
    case LayerProcess::Conformal:
      return FilmProcess::Conformal;
    case LayerProcess::Directional:
      return FilmProcess::Directional;
    case LayerProcess::Planar:
      return FilmProcess::Planar;
  }
  return of_surface;
}

double Surface::equivalent_thickness() const {
  double sum = 0;
  for (const Dielectric& layer : dielectric) sum += layer.equivalent_thickness();
  return sum;
}

std::vector<Dielectric> Surface::layers() const { return {dielectric.begin(), dielectric.end()}; }

std::vector<Dielectric> Surface::thinnest_layers(const FilmGround& ground) const {
  std::vector<Dielectric> out = layers();
  std::size_t coats = 0;  // the first layer that the texture does not end in
  if (const int carrying = carrying_layer(); carrying >= 0) {
    coats = static_cast<std::size_t>(carrying);
    out[coats].thickness = std::max(0.0, out[coats].thickness - ground.deepest);
    ++coats;
  }
  // Layers of one step coverage erode the surface together like one of their whole thickness.
  double directional = 0;
  for (std::size_t k = coats; k < out.size(); ++k) {
    if (dielectric[k].made_by(process) == FilmProcess::Directional)
      directional += dielectric[k].thickness;
  }
  if (directional <= 0) return out;
  // From the foot of the wall; a low one does not come below the film on the land beside it.
  const double along =
      std::max(std::cos(ground.steepest), 1 - ground.height / directional);  // of the normal on z
  const double left = std::sqrt(square(along) + square(step_coverage) * (1 - square(along)));
  constexpr double kNoFilm = 1e-10;  // [m] thinner than an atom: the wall is bare
  for (std::size_t k = coats; k < out.size(); ++k) {
    if (dielectric[k].made_by(process) != FilmProcess::Directional) continue;
    double& thickness = out[k].thickness;
    thickness = left * directional > kNoFilm ? left * thickness : 0;
  }
  return out;
}

double saturated_air_field(std::span<const Dielectric> layers) {
  double out = kInfinity;
  for (const Dielectric& layer : layers) {
    if (layer.saturation_field > 0)
      out = std::min(out, layer.permittivity * layer.saturation_field);
  }
  return out;
}

RelaxationProblem relaxation_problem(const Dielectric& layer) {
  const Relaxation& r = layer.relaxation;
  const bool formula = r.law == RelaxationLaw::Debye || r.law == RelaxationLaw::ColeCole;
  if (formula && r.time <= 0) return {"time", "expected the time of the relaxation, above 0"};
  if (formula && r.infinite > layer.permittivity)
    return {"infinite", "expected at most the permittivity at rest: a film loses, it gains none"};
  if (r.law != RelaxationLaw::Table) return {};
  if (r.frequency.size() < 2 || r.permittivity.size() != r.frequency.size() ||
      (!r.loss.empty() && r.loss.size() != r.frequency.size()))
    return {"frequency",
            "expected two or more frequencies, and a permittivity (and a loss) for each"};
  if (!std::is_sorted(r.frequency.begin(), r.frequency.end(), std::less_equal<>()))
    return {"frequency", "expected rising frequencies"};
  return {};
}

int Surface::carrying_layer() const {
  for (std::size_t k = dielectric.size(); k-- > 0;) {
    if (dielectric[k].made_by(process) == FilmProcess::Planar) return static_cast<int>(k);
  }
  return -1;
}

double Surface::dielectric_thickness() const {
  double sum = 0;
  for (const Dielectric& layer : dielectric) sum += layer.thickness;
  return sum;
}

void fields(FieldVisitor& v, Surface& s) {
  v.number({"contact_angle", "deg", 0, 180, "contact angle of water at rest", Source::Paper,
            "M3: SiO2 50 deg"},
           s.contact_angle);
  v.list(
      {"dielectric", "layers between the electrode and the finger, the one on the electrode first"},
      s.dielectric);
  v.choice(
      {"process",
       "how the dielectric was made. conformal: equally thick along the normal (thermal oxide, "
       "atomic layers); directional: along z (evaporation, sputtering); planar: a flat "
       "electrode, the texture cut into the film or imprinted on it (glass over ITO)",
       Source::Choice, "the M3 samples are oxidised silicon"},
      {"conformal", "directional", "planar"}, s.process);
  v.number({"step_coverage", "", 0, 1,
            "directional layers: thickness on side walls over that on top; 1 is conformal",
            Source::Choice, "evaporation 0 to 0.2, sputtering 0.3 to 0.6"},
           s.step_coverage);
  v.number({"electrode_edge_radius", "nm", 0, 1e6,
            "radius of the electrode's convex edges below walls, for the breakdown margin; 0: not "
            "stated, no edge factor",
            Source::Choice, "thermal oxide over etched silicon: 50 to 500 nm"},
           s.electrode_edge_radius);
  v.number({"refractive_index", "", 1, 5, "refractive index (optics only)", Source::Measured,
            "fused silica"},
           s.refractive_index);
  v.number({"modulus", "MPa", 0, 1e7, "Young's modulus of compliant features; 0: rigid"},
           s.modulus);
  v.number(
      {"poisson", "", 0, 0.5, "Poisson ratio of compliant features", Source::Estimate, "polymers"},
      s.poisson);
  v.number({"base_modulus", "GPa", 0, 1e4,
            "Young's modulus of what a pin presses on below texture and features; 0: rigid. Skin "
            "takes it as rigid"},
           s.base_modulus);
  v.number(
      {"base_poisson", "", 0, 0.5, "its Poisson ratio", Source::Estimate, "glass .2, metals .3"},
      s.base_poisson);
  v.number({"shear_strength", "MPa", 0, 1e3,
            "interfacial shear strength against clean skin at 15 % RH; 0: the finger's, on glass",
            Source::Choice, "polyethylene 2.5 MPa (Briscoe and Tabor 1978)"},
           s.shear_strength);
  v.number({"shear_strength_natural", "MPa", 0, 1e3,
            "the same against skin with its sebum; 0: by the finger's natural.shear_factor"},
           s.shear_strength_natural);
  v.number({"shear_strength_wet", "MPa", 0, 1e3,
            "the same against wet, saturated skin; 0: by the finger's wet.shear_factor"},
           s.shear_strength_wet);
}

double Drive::rms_of_peak() const {
  switch (waveform) {
    case Waveform::Sine:
      return 1 / std::numbers::sqrt2;
    case Waveform::Square:
    case Waveform::Dc:
      return 1;
    case Waveform::Am: {
      // [(1 + m)/2]^gamma sin(carrier), m a full-depth sine, peak = amplitude: mean square over the
      // envelope by the midpoint rule (spectrally exact for a smooth periodic integrand).
      double sum = 0;
      constexpr int kSteps = 64;
      for (int i = 0; i < kSteps; ++i) {
        const double m = std::sin(2 * std::numbers::pi * (i + 0.5) / kSteps);
        sum += std::pow((1 + m) / 2, 2 * envelope_exponent);
      }
      return std::sqrt(0.5 * sum / kSteps);
    }
  }
  return 0;
}

void fields(FieldVisitor& v, Drive& s) {
  v.choice({"control", "what the source holds"}, {"voltage", "current"}, s.control);
  v.choice({"waveform", "shape in time"}, {"sine", "square", "dc", "am"}, s.waveform);
  v.number({"amplitude", "V", 0, 1e5, "peak voltage under voltage control; 0: undriven",
            Source::Paper, "M3: 200 V"},
           s.amplitude);
  v.number({"frequency", "kHz", 0, 1e6, "frequency, or carrier", Source::Paper, "M3: 5 kHz"},
           s.frequency);
  v.number({"current", "mA", 0, 1e3, "peak current under current control"}, s.current);
  v.number({"modulation_frequency", "Hz", 0, 1e6, "am: envelope frequency"},
           s.modulation_frequency);
  v.number({"envelope_exponent", "", 0, 4, "am: exponent of the envelope; 1/2 gives no distortion"},
           s.envelope_exponent);
  v.number({"source_compliance", "V", 0, 1e5, "largest voltage of the source; 0: not given"},
           s.source_compliance);
  v.number({"current_limit", "mA", 0, 1e3, "largest current through the body", Source::Paper,
            "M3: 1 mA; Shultz 2018: 4 mA"},
           s.current_limit);
}

}  // namespace papilla::scene
