#include "cases/persson.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/constants.h"
#include "base/error.h"
#include "config/reader.h"
#include "design/design.h"
#include "physics/electrostatics/breakdown.h"

namespace papilla::cases {

PowerSpectrum SpectrumSettings::spectrum() const {
  if (wave_number.empty()) {
    return self_affine_spectrum(rms, lowest, roll_off, cutoff, hurst).scaled(scale);
  }
  return PowerSpectrum{wave_number, density}.scaled(scale);
}

void fields(FieldVisitor& v, SpectrumSettings& s) {
  v.number({"rms", "um", 1e-6, 1e6, "rms height", Source::Fit, "skin of the wrist, Sirin 2019"},
           s.rms);
  v.number({"lowest", "1/m", 1e-3, 1e12, "lowest wave number", Source::Paper, "Sirin 2019"},
           s.lowest);
  v.number({"roll_off", "1/m", 1e-3, 1e12, "flat below this wave number", Source::Fit,
            "to the printed numbers of Sirin 2019"},
           s.roll_off);
  v.number({"cutoff", "1/m", 1e-3, 1e12, "highest wave number", Source::Fit,
            "to the printed numbers of Sirin 2019"},
           s.cutoff);
  v.number({"hurst", "", 0.01, 1, "Hurst exponent", Source::Paper, "Sirin 2019"}, s.hurst);
  v.number({"scale", "", 1e-12, 1e12, "factor of the whole spectrum"}, s.scale);
  v.numbers({"wave_number", "1/m", 1e-3, 1e12, "knots of a measured spectrum instead"},
            s.wave_number);
  v.numbers({"density", "m4", 1e-60, 1e6, "C(q) at the knots, straight in log-log between"},
            s.density);
}

std::vector<std::pair<std::string, std::string>> spectrum_problems(const SpectrumSettings& s) {
  std::vector<std::pair<std::string, std::string>> out;
  if (!(s.lowest <= s.roll_off && s.roll_off < s.cutoff))
    out.emplace_back("roll_off", "expected lowest <= roll_off < cutoff");
  if (s.wave_number.size() != s.density.size() || s.wave_number.size() == 1) {
    out.emplace_back("density", "expected one density for each of at least two wave numbers");
  } else if (!std::is_sorted(s.wave_number.begin(), s.wave_number.end(), std::less_equal<>())) {
    out.emplace_back("wave_number", "expected rising wave numbers");
  }
  return out;
}

void fields(FieldVisitor& v, SolidSettings& s) {
  v.number({"modulus", "MPa", 1e-6, 1e7, "Young's modulus of the stratum corneum", Source::Paper,
            "Sirin 2019"},
           s.solid.layer_modulus);
  v.number({"poisson", "", 0, 0.5, "its Poisson ratio", Source::Paper, "Sirin 2019"},
           s.solid.layer_poisson);
  v.number({"thickness", "um", 0, 1e6, "its thickness", Source::Paper, "Sirin 2019"},
           s.solid.layer_thickness);
  v.number(
      {"bulk_modulus", "kPa", 1e-6, 1e10, "Young's modulus below", Source::Paper, "Sirin 2019"},
      s.solid.bulk_modulus);
  v.number({"bulk_poisson", "", 0, 0.5, "Poisson ratio below", Source::Paper, "Sirin 2019"},
           s.solid.bulk_poisson);
  v.number({"hardness", "MPa", 0, 1e6, "yields at this pressure; 0: elastic"}, s.hardness);
}

double InterfaceSettings::surface_thickness() const {
  double sum = 0;
  for (const Dielectric& layer : dielectric) sum += layer.equivalent_thickness();
  return sum;
}

std::complex<double> InterfaceSettings::thickness(double skin_thickness, double frequency) const {
  const double surface = surface_thickness();
  if (frequency <= 0) {
    if (gap_resistivity > 0) return std::numeric_limits<double>::infinity();
    return surface + (lossy_skin ? 0.0 : skin_equivalent);
  }
  if (lossy_skin) {
    return series_thickness(surface, skin_thickness, SkinDielectric{}, frequency, gap_resistivity);
  }
  return (surface + skin_equivalent) * gap_permittivity(frequency, gap_resistivity);
}

double InterfaceSettings::dielectric_margin(double skin_thickness, double voltage,
                                            double frequency) const {
  const double surface = surface_thickness();
  if (surface <= 0) return kInfinity;
  InterfaceSettings touching = *this;  // no gap lies between, so none conducts
  touching.gap_resistivity = 0;
  const double share = surface / std::abs(touching.thickness(skin_thickness, frequency));
  return electrostatics::dielectric_margin(dielectric, share * voltage, kInfinity);
}

void fields(FieldVisitor& v, InterfaceSettings& s) {
  v.list({"dielectric", "layers on the electrode"}, s.dielectric);
  v.number({"skin_equivalent", "nm", 0, 1e7, "d/eps of the skin where it is lossless"},
           s.skin_equivalent);
  v.flag({"lossy_skin", "skin by frequency (printed anchors) with the layer's thickness",
          Source::Paper, "Sirin 2019"},
         s.lossy_skin);
  v.number({"gap_resistivity", "ohm m", 0, 1e30, "of the gap; 0: insulating"}, s.gap_resistivity);
}

void fields(FieldVisitor& v, TouchSettings& s) {
  v.number({"load", "N", 0, 1e3, "normal force"}, s.load);
  v.number({"area", "mm2", 1e-6, 1e6, "nominal contact area", Source::Estimate, "1 cm2"}, s.area);
  v.number({"shear_strength", "MPa", 0, 1e4, "of true contact", Source::Paper, "Sirin 2019"},
           s.shear_strength);
  v.number(
      {"finite_size_pressure", "kPa", 0, 1e6,
       "below it the gaps stay as they are there; 0: infinite body", Source::Paper, "Sirin 2019"},
      s.finite_size_pressure);
}

void fields(FieldVisitor& v, SweepSettings& s) {
  v.numbers({"voltage", "V", 0, 1e5, "peak voltages of a table"}, s.voltage);
  v.numbers({"load", "N", 0, 1e3, "normal forces of a table"}, s.load);
  v.numbers({"frequency", "kHz", 0, 1e6, "frequencies of a table"}, s.frequency);
}

void fields(FieldVisitor& v, TheorySettings& s) {
  v.number({"kappa", "", 0.1, 10, "area = kappa p/(slope E*) at small load; pure theory 1.596",
            Source::Fit, "boundary elements"},
           s.kappa);
  v.number({"energy_factor", "", 0.01, 1, "elastic energy of partial contact over full contact's",
            Source::Fit, "Yang and Persson 2008"},
           s.energy_factor);
}

void fields(FieldVisitor& v, MeanFieldCase& s) {
  v.integer(
      {"schema_version", "version of the file format", Source::Choice, "", Presence::Required}, 1,
      1, s.schema_version);
  v.text({"title", "name of the case"}, s.title);
  v.section({"roughness", "spectrum of the skin"}, s.roughness);
  v.section({"skin", "elasticity of the skin"}, s.skin);
  v.section({"interface", "dielectric layers"}, s.interface);
  v.section({"touch", "load and friction"}, s.touch);
  v.section({"drive", "electrical drive"}, s.drive);
  v.section({"sweep", "tables"}, s.sweep);
  v.section({"theory", "constants of the theory"}, s.theory);
}

namespace {

double own_frequency(const MeanFieldCase& c) {
  return c.drive.waveform == Waveform::Dc ? 0 : c.drive.frequency;
}

// The pull in contact goes as 1/|h0|^2, so that the square has to be a number apart from zero.
bool insulates(std::complex<double> h0) {
  return std::norm(h0) >= std::numeric_limits<double>::min();
}

// Of the case's own point and its sweep, without a constant voltage; infinite where all are.
double lowest_frequency(const MeanFieldCase& c) {
  double out = kInfinity;
  for (const double f : c.sweep.frequency) out = f > 0 ? std::min(out, f) : out;
  const double own = own_frequency(c);
  return own > 0 ? std::min(out, own) : out;
}

// At the case's own point or anywhere in its sweeps.
bool voltage_meets_no_layer(const MeanFieldCase& c) {
  const auto bare = [&](double frequency) {
    return !insulates(c.interface.thickness(c.skin.solid.layer_thickness, frequency));
  };
  const auto driven = [](double voltage) { return voltage > 0; };
  const bool own = driven(c.drive.amplitude);
  const auto& [voltages, loads, frequencies] = c.sweep;
  return ((own || std::any_of(voltages.begin(), voltages.end(), driven)) &&
          bare(own_frequency(c))) ||
         (own && std::any_of(frequencies.begin(), frequencies.end(), bare));
}

}  // namespace

MeanFieldCase read_mean_field(const std::string& path, const std::vector<std::string>& overrides) {
  return read_mean_field(load_document(own_or_shipped(path), overrides, design_roots()));
}

MeanFieldCase read_mean_field(Document document) {
  MeanFieldCase c;
  c.drive.amplitude = 100;
  c.drive.frequency = 1e3;
  read_section(document, "", c);
  for (const auto& [key, message] : spectrum_problems(c.roughness))
    document.problem_at("roughness." + key, message);
  for (std::size_t k = 0; k < c.interface.dielectric.size(); ++k) {
    const Dielectric& layer = c.interface.dielectric[k];
    if (layer.relaxation.law != RelaxationLaw::None || layer.saturation_field > 0)
      document.problem_at(fmt::format("interface.dielectric.{}", k),
                          "the mean field takes films at rest: leave relaxation and "
                          "saturation_field out, or use papilla evaluate with a pin");
    constexpr double kInsulates = 0.01;  // corner frequency over the voltage's
    if (const double lowest = lowest_frequency(c); layer.corner_frequency() > kInsulates * lowest)
      document.problem_at(
          fmt::format("interface.dielectric.{}.resistivity", k),
          fmt::format("the mean field takes films that insulate, and below {:.4g} Hz this one "
                      "conducts, {:.4g} Hz are asked for: take higher frequencies, a resistivity "
                      "of 0 for an insulator, or papilla evaluate with a pin",
                      layer.corner_frequency() / kInsulates, lowest));
  }
  if (c.drive.control == DriveControl::Current) {
    document.problem_at("drive.control", "the mean field takes a voltage; see papilla solve drive");
  }
  if (c.touch.finite_size_pressure == 0 &&
      (c.touch.load == 0 ||
       std::find(c.sweep.load.begin(), c.sweep.load.end(), 0.0) != c.sweep.load.end())) {
    document.problem_at("touch.load",
                        "without load the gaps of an infinite body are infinite: give a load or a "
                        "finite_size_pressure");
  }
  if (c.skin.hardness > 0) {
    const auto yields = [&](double load) { return load / c.touch.area >= c.skin.hardness; };
    if (yields(c.touch.load)) {
      document.problem_at("skin.hardness", "the nominal pressure reaches the hardness");
    } else if (c.touch.finite_size_pressure >= c.skin.hardness) {
      document.problem_at("skin.hardness", "touch.finite_size_pressure reaches the hardness");
    }
    if (std::any_of(c.sweep.load.begin(), c.sweep.load.end(), yields)) {
      document.problem_at("sweep.load", "a nominal pressure of the sweep reaches the hardness");
    }
  }
  if (voltage_meets_no_layer(c)) {
    document.problem_at("interface.dielectric",
                        "no layer holds the voltage where the surfaces touch (at 0 Hz a lossy skin "
                        "holds none): give a dielectric, or no voltage");
  }
  finish(document);
  return c;
}

namespace {

// Spectrum and theory of a case.
class CaseField {
 public:
  explicit CaseField(const MeanFieldCase& c) : case_(c), given_(c.roughness.spectrum()) {}

  const PowerSpectrum& given() const { return given_; }
  // The theory under a load [N]. A skin that yields is flattened by the pressure of that load, so
  // that each has a spectrum of its own; an elastic one has one for all. Eq. persson.10
  const MeanField& field(double load) const {
    const double hardness = case_.skin.hardness;
    const double pressure =
        hardness > 0 ? std::max(load / case_.touch.area, case_.touch.finite_size_pressure) : 0;
    auto found = fields_.find(pressure);
    if (found == fields_.end())
      found = fields_.emplace(pressure, theory(hardness > 0 ? flattened(pressure) : given_)).first;
    return found->second;
  }
  MeanField theory(const PowerSpectrum& spectrum) const {
    return {spectrum,
            case_.skin.solid,
            {.kappa = case_.theory.kappa, .energy_factor = case_.theory.energy_factor}};
  }

  std::complex<double> thickness(double frequency) const {
    return case_.interface.thickness(case_.skin.solid.layer_thickness, frequency);
  }

  MeanFieldPoint at(double voltage, double load, double frequency) const {
    const TouchSettings& touch = case_.touch;
    MeanFieldPoint point;
    point.voltage = voltage;
    point.load = load;
    point.frequency = frequency;
    point.thickness = thickness(frequency);
    Drive drive = case_.drive;
    drive.amplitude = voltage;
    const bool pulls = std::isfinite(point.thickness.real());
    const std::complex<double> h0 = pulls ? point.thickness : 1.0;
    const MeanField& loaded = field(load);
    point.on = friction_at(loaded, load, touch.area, touch.shear_strength,
                           pulls ? drive.v_rms() : 0, h0, touch.finite_size_pressure);
    point.dielectric_margin =
        case_.interface.dielectric_margin(case_.skin.solid.layer_thickness, voltage, frequency);
    point.yielded =
        point.sound() && case_.skin.hardness > 0 && point.on.pull.pressure >= case_.skin.hardness;
    point.area_off = loaded.area(load / touch.area);
    // A gap that conducts passes more than its capacitance. Eq. persson.9
    if (pulls && insulates(point.thickness))
      point.capacitance = kVacuumPermittivity * touch.area *
                          std::abs(gap_permittivity(frequency, case_.interface.gap_resistivity) *
                                   gaps_of(point).inverse(point.thickness));
    return point;
  }

  GapDistribution gaps_of(const MeanFieldPoint& point) const {
    return field(point.load)
        .gaps(std::max(point.on.pull.pressure, case_.touch.finite_size_pressure));
  }

 private:
  PowerSpectrum flattened(double pressure) const {
    PowerSpectrum smooth = plastic_smoothing(given_, case_.skin.solid, case_.skin.hardness,
                                             pressure, case_.theory.kappa);
    if (smooth.wave_number.size() < 2) {
      throw InputError({Problem{
          "", 0, 0, "skin.hardness",
          "the skin yields at every scale of its roughness: take more, or a lower modulus"}});
    }
    return smooth;
  }

  const MeanFieldCase& case_;
  PowerSpectrum given_;
  mutable std::map<double, MeanField> fields_;  // by the pressure that flattens [Pa]
};

// From low to high, both included, evenly in the logarithm.
std::vector<double> spaced(double low, double high, int count) {
  std::vector<double> out;
  for (int k = 0; k < count; ++k)
    out.push_back(low * std::pow(high / low, static_cast<double>(k) / (count - 1)));
  return out;
}

constexpr int kCurve = 121;  // points of a curve

}  // namespace

MeanFieldResult solve_mean_field(const MeanFieldCase& c) {
  const CaseField of(c);
  MeanFieldResult result;
  const PowerSpectrum& spectrum = of.field(c.touch.load).spectrum();
  result.rms = spectrum.rms();
  result.slope = spectrum.slope();
  result.contact_modulus = effective_modulus(c.skin.solid, spectrum.highest());
  const double v = c.drive.amplitude, load = c.touch.load, f = own_frequency(c);
  result.point = of.at(v, load, f);
  for (double x : c.sweep.voltage) result.voltage.push_back(of.at(x, load, f));
  for (double x : c.sweep.load) result.load.push_back(of.at(v, x, f));
  for (double x : c.sweep.frequency) result.frequency.push_back(of.at(v, load, x));
  return result;
}

MeanFieldCurves mean_field_curves(const MeanFieldCase& c) {
  const CaseField of(c);
  const MeanField& field = of.field(c.touch.load);
  const MeanField rough = of.theory(of.given());
  const double pressure = c.touch.load / c.touch.area;
  MeanFieldCurves out;
  for (const double q : spaced(of.given().lowest(), of.given().highest(), kCurve)) {
    ContactShares shares{field.area(pressure, q), 0};
    if (c.skin.hardness > 0)
      shares = plastic_shares(pressure, rough.stress_measure(q), c.skin.hardness);
    out.roughness.push_back({q, of.given().at(q), field.spectrum().at(q), field.area(pressure, q),
                             shares.elastic, shares.plastic});
  }
  for (double x : c.sweep.voltage) {
    for (double y : c.sweep.load) out.grid.push_back(of.at(x, y, own_frequency(c)));
  }
  const double smallest = c.touch.finite_size_pressure;
  for (const double p : spaced(1, 1e6, kCurve))
    out.separation.push_back({p, field.mean_gap(p), field.mean_gap(std::max(p, smallest))});
  const MeanFieldPoint point = of.at(c.drive.amplitude, c.touch.load, own_frequency(c));
  if (!std::isfinite(point.thickness.real()) || c.drive.amplitude <= 0 || !point.sound())
    return out;
  const GapDistribution gaps = of.gaps_of(point);
  const std::vector<double> at = spaced(1e-11, 1e-3, kCurve);
  out.stress = stress_distribution(gaps, c.drive.v_rms(), point.thickness, at);
  const double surface = c.interface.surface_thickness();
  if (!c.interface.lossy_skin || !insulates(surface)) return out;
  const SkinDielectric skin;
  const double f = std::max(own_frequency(c), 1.0);
  const StepResponse step{surface, c.skin.solid.layer_thickness, skin.permittivity_at(f),
                          skin.resistivity_at(f)};
  const double slowest = step.relaxation_time(0);
  for (const double t : spaced(1e-3 * slowest, 1e2 * slowest, kCurve))
    out.step.push_back({t, step.field(c.drive.amplitude, gaps.mean_gap, t),
                        step.pull(gaps, c.drive.amplitude, t)});
  return out;
}

}  // namespace papilla::cases
