#include "cases/drive.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "base/files.h"
#include "cases/recording.h"
#include "config/reader.h"
#include "design/design.h"
#include "forward/electric_path.h"
#include "forward/forward.h"
#include "forward/scene_terms.h"
#include "numerics/statistics.h"
#include "physics/electrostatics/breakdown.h"

namespace papilla::cases {
namespace {

// Of a force series over one common period: tones without a short one would fill the memory.
constexpr std::size_t kMostSamples = std::size_t{1} << 22;

double insulating_if_zero(double resistivity) { return resistivity > 0 ? resistivity : kInfinity; }

bool leaks_alike(const ImpedanceLayer& a, const ImpedanceLayer& b) {
  constexpr double kAlike = 1e-9;
  const double one = a.corner_frequency(), other = b.corner_frequency();
  return std::abs(one - other) <= kAlike * std::max(one, other);
}

// Layers of one time constant are one: resistances and elastances add. Those of another one, and
// those that relax, stay by themselves.
ImpedanceLayer stack(const std::vector<Dielectric>& layers, double area, Network& network) {
  ImpedanceLayer sum{0, 0};
  for (const Dielectric& layer : layers) {
    if (layer.thickness == 0) continue;
    ImpedanceLayer one =
        slab(layer.thickness, layer.permittivity, insulating_if_zero(layer.resistivity), area);
    if (layer.relaxation.law != RelaxationLaw::None) {
      one.relaxation = layer.relaxation;
      one.permittivity = layer.permittivity;
      network.relaxing.push_back(std::move(one));
    } else if (!sum.present()) {
      sum = one;
    } else if (leaks_alike(sum, one)) {
      sum.resistance += one.resistance;
      sum.capacitance = 1 / (1 / sum.capacitance + 1 / one.capacitance);
    } else {
      network.apart.push_back(std::move(one));
    }
  }
  return sum;
}

// The film on the electrode: given, or that of the gap's design.
Surface film_of(const DriveCase& c) {
  if (!c.gap.design.empty()) return scene_of(read_design(c.gap.design)).surface;
  Surface out;
  out.dielectric.clear();
  for (const Dielectric& layer : c.surface.dielectric)
    out.dielectric.push_back(FilmDielectric{layer});
  return out;
}

// The voltage across a film at which the first of its layers breaks down [V]. They share it as at
// the drive's frequency. Eq. electrostatics.9
double breakdown_of(const Surface& film, const Drive& drive) {
  return dielectric_margin(film.layers(), 1, kInfinity, film_divider(film, drive));  // of 1 V
}

Network given_network(const DriveCase& c) {
  const double area = c.touch.area;
  Network n;
  n.dielectric = stack(c.surface.dielectric, area, n);
  n.skin =
      slab(c.skin.thickness, c.skin.permittivity, insulating_if_zero(c.skin.resistivity), area);
  n.gap = plane_gap(c.gap.distance, c.gap.permittivity,
                    insulating_if_zero(c.gap.resistivity) * c.gap.distance / area, area);
  n.gap.held = saturated_air_field(c.surface.dielectric) / c.gap.permittivity * c.gap.distance;
  return n;
}

// The scene of the gap's design, whose finger presses with the load of the case: gap, area and
// friction are of one touch.
Scene touched(const DriveCase& c, const Design& design) {
  Scene scene = scene_of(design);
  scene.finger.load = c.touch.load;
  return scene;
}

// One patch of it before the drive, its pressure times `pressed`.
PatchPicture pictured(const DriveCase& c, const Design& design, const Scene& scene, int skin,
                      double pressed = 1) {
  PatchPicture out = picture_patch(scene, design.texture, fidelity_of(design),
                                   c.gap.relative_humidity, skin, 0, pressed);
  if (out.fields.off.gap.empty())
    throw InputError(c.gap.design + ": no contact: " + out.fields.off.reason);
  return out;
}

// The gap of the load-carrying patches of a design before the drive, and their area; water is no
// layer of the network.
Network design_network(const DriveCase& c, double& area) {
  const Design design = read_design(c.gap.design);
  const Scene scene = in_its_state(touched(c, design));
  const double rh = c.gap.relative_humidity;
  const ElectricalLayer& electrical = scene.finger.electrical;
  if (electrical.skin_exponent != 1 || electrical.gap_exponent != 1)
    throw InputError(c.gap.design +
                     ": a network of resistors and capacitors does not disperse: set "
                     "finger.electrical.skin_exponent and gap_exponent to 1");
  const double skin = scene.finger.skin_layer(rh);
  const double h0 = scene.surface.equivalent_thickness() + skin;
  if (h0 <= 0) {
    throw InputError(c.gap.design +
                     ": a gap that touches a bare electrode has no voltage: give "
                     "the surface a dielectric");
  }
  double inverse = 0, inverse_square = 0;
  for (int k = 0; k < c.gap.skins; ++k) {
    const PatchPicture picture = pictured(c, design, scene, k);
    area = scene.finger.load / picture.pressure;  // that carries the load, by every closure
    const auto count = static_cast<double>(picture.fields.off.gap.size()) * c.gap.skins;
    for (double g : picture.fields.off.gap) {
      inverse += 1 / (std::max(g, 0.0) + h0) / count;
      inverse_square += 1 / square(std::max(g, 0.0) + h0) / count;
    }
  }
  Network n;
  n.dielectric = stack(scene.surface.layers(), area, n);
  if (skin > 0) {
    const double capacitance = kVacuumPermittivity * area / skin;
    const double corner = electrical.corner_frequency;
    n.skin = {corner > 0 ? 1 / (2 * kPi * corner * capacitance) : kInfinity, capacitance};
  }
  const double distance = 1 / inverse - h0;
  constexpr double kClosed = 1e-12;  // [m]
  if (!(distance > kClosed)) {
    throw InputError(c.gap.design +
                     ": its patches touch everywhere, and no gap is left that has a voltage: give "
                     "what touches a roughness, or gap.distance in place of gap.design");
  }
  n.gap = rough_gap(inverse, inverse_square, h0,
                    insulating_if_zero(c.gap.resistivity) * distance / area, area);
  n.gap.held = scene.surface.saturated_air_field() * distance;
  return n;
}

// Eq. drive.16: what the contact spots of a design's patches conduct [S]; 0: not known, of a pin.
double spots_conductance(const DriveCase& c, double area) {
  const Design design = read_design(c.gap.design);
  const double rh = c.gap.relative_humidity;
  Scene scene = touched(c, design);
  if (!scene.touch.name.empty()) {
    if (!c.gap.contact_spots) return 0;
    throw InputError(c.gap.design +
                     ": gap.contact_spots counts spots of skin, by skin.resistivity, and a pin has "
                     "none: leave it out");
  }
  scene.drive.amplitude = 0;
  constexpr double kMore = 1.05;  // pressure, for the stiffness
  double stiffness = 0;           // [Pa/m]
  for (int k = 0; k < c.gap.skins; ++k) {
    double pressure[2], gap[2];
    for (const int more : {0, 1}) {
      const PatchPicture picture = pictured(c, design, scene, k, more ? kMore : 1);
      pressure[more] = mean_estimate(picture.fields.off.pressure).value;
      gap[more] = mean_estimate(picture.fields.off.gap).value;
    }
    stiffness += (pressure[1] - pressure[0]) / (gap[0] - gap[1]) / c.gap.skins;
  }
  const Skin skin = scene_of(design).finger.applied().skin;
  const double modulus =
      skin.layer_modulus * skin.modulus_factor(rh) / (1 - square(skin.layer_poisson));
  return 2 * stiffness * area / (modulus * c.skin.resistivity);
}

// A sine whose frequency rises evenly, and starts again.
Signal chirp(double amplitude, double from, double to, double time, std::size_t samples) {
  Signal out{time, std::vector<double>(std::bit_ceil(samples))};
  for (std::size_t i = 0; i < out.value.size(); ++i) {
    const double t = time * static_cast<double>(i) / static_cast<double>(out.value.size());
    out.value[i] = amplitude * std::sin(2 * kPi * (from + 0.5 * (to - from) * t / time) * t);
  }
  return out;
}

Modulation modulation_of(const DriveCase& c) {
  Modulation m;
  if (!c.modulated()) return m;
  m.frequency = c.tones.frequency;
  m.amplitude = c.tones.amplitude;
  if (m.frequency.empty()) m = {{c.drive.modulation_frequency}, {1}};
  if (m.amplitude.empty()) {
    m.amplitude.assign(m.frequency.size(), 1 / static_cast<double>(m.frequency.size()));
  }
  return m;
}

double peak_amplitude(const Drive& drive) {
  return drive.control == DriveControl::Current ? drive.current : drive.amplitude;
}

std::vector<DriveCheck> checks_of(const DriveResult& r, const Drive& drive, const Surface& film) {
  std::vector<DriveCheck> out{
      {DriveLimit::BodyCurrent, r.series.peak_current, drive.current_limit}};
  if (drive.source_compliance > 0) {
    out.push_back(
        {DriveLimit::SourceVoltage, r.series.peak_source_voltage, drive.source_compliance});
  }
  out.push_back({DriveLimit::GapVoltage, r.series.peak_gap_voltage,
                 air_breakdown_voltage(r.network.gap.distance)});
  if (film.dielectric_thickness() > 0) {
    out.push_back({DriveLimit::FilmVoltage, r.series.peak_film_voltage, breakdown_of(film, drive)});
  }
  return out;
}

}  // namespace

void fields(FieldVisitor& v, GapSettings& s) {
  v.number(
      {"distance", "um", 1e-4, 1e4, "plane gap", Source::Paper, "Shultz 2018: 250 pF on 30 mm2"},
      s.distance);
  v.number({"resistivity", "ohm m", 0, 1e30, "of the gap; 0: an insulator", Source::Paper,
            "Shultz 2018: 17 Mohm"},
           s.resistivity);
  v.number({"permittivity", "", 1, 1e4, "of the gap"}, s.permittivity);
  v.path({"design",
          "take gap, surface, skin and area from the solved patches of this design, whose finger "
          "presses with touch.load"},
         s.design);
  v.flag({"contact_spots", "that design's contact spots conduct beside the gap"}, s.contact_spots);
  v.number({"relative_humidity", "%", 0, 100, "of that design"}, s.relative_humidity);
  v.integer({"skins", "patches that are averaged"}, 1, 1000, s.skins);
}

void fields(FieldVisitor& v, CoatingSettings& s) {
  v.list({"dielectric", "layers on the electrode"}, s.dielectric);
}

void fields(FieldVisitor& v, SkinLayerSettings& s) {
  v.number({"thickness", "um", 0, 1e5, "stratum corneum", Source::Paper, "Sirin 2019"},
           s.thickness);
  v.number({"permittivity", "", 1, 1e6, "its permittivity", Source::Paper, "Sirin 2019"},
           s.permittivity);
  v.number({"resistivity", "ohm m", 0, 1e30, "its resistivity; 0: an insulator", Source::Paper,
            "Sirin 2019"},
           s.resistivity);
}

void fields(FieldVisitor& v, DriveTouch& s) {
  v.number({"load", "N", 0, 1e3, "normal force, of the finger of gap.design too"}, s.load);
  v.number({"area", "mm2", 1e-6, 1e6, "electrical contact area", Source::Paper, "Shultz 2018"},
           s.area);
  v.number({"coefficient", "", 0, 10, "friction = coefficient (load + pull)", Source::Paper,
            "Shultz 2018: about 0.2"},
           s.coefficient);
  v.number(
      {"real_area", "mm2", 0, 1e6, "area in true contact, for the onset of sliding; 0: not known"},
      s.real_area);
  v.number({"shear_strength", "MPa", 1e-3, 1e3, "interfacial shear strength", Source::Paper,
            "M3: 9 MPa"},
           s.shear_strength);
}

void fields(FieldVisitor& v, Tones& s) {
  v.numbers({"frequency", "Hz", 1e-3, 1e6, "am: tones; default: drive.modulation_frequency"},
            s.frequency);
  v.numbers({"amplitude", "", 0, 1, "am: depth of each; default: equal, together 1"}, s.amplitude);
}

void fields(FieldVisitor& v, SourceSettings& s) {
  v.number({"shunt", "Mohm", 0, 1e12, "resistance across a current source; 0: none", Source::Paper,
            "Shultz 2018: keeps charge from building up"},
           s.shunt);
  v.path({"file", "a recording \"time,value\" [s, V or A] that repeats, for the drive's waveform"},
         s.file);
  v.number({"chirp_to", "Hz", 0, 1e6, "a sine from drive.frequency to this one; 0: none"},
           s.chirp_to);
  v.number({"chirp_time", "ms", 1e-3, 1e5, "in so long, then again"}, s.chirp_time);
}

void fields(FieldVisitor& v, SwipeSettings& s) {
  v.number({"stroke", "mm", 1e-3, 1e3, "amplitude of the finger's way to and fro"}, s.stroke);
  v.number({"frequency", "Hz", 1e-2, 100, "of it", Source::Paper, "stiction paper: 3.8 Hz"},
           s.frequency);
  v.number({"duration", "s", 1e-2, 1e3, "of the rendered swipe"}, s.duration);
  v.number({"stiffness", "N/m", 1, 1e6, "of the skin sideways (Dahl)", Source::Estimate,
            "0.3 mm to full slip at 0.25 N"},
           s.stiffness);
  v.number({"filter", "Hz", 0, 500, "low-pass on forces before the state machine; 0: none",
            Source::Paper, "stiction paper: 150 Hz"},
           s.filter);
  v.number({"stuck", "", 0, 1, "share of drive.current while stuck"}, s.stuck);
  v.number({"partial", "", 0, 1, "share of it in partial slip"}, s.partial);
  v.number({"full", "", 0, 1, "share of it in full slip"}, s.full);
}

void fields(FieldVisitor& v, ResponseSweep& s) {
  v.numbers({"frequency", "Hz", 0, 1e9, "frequencies of a table for a plain sine"}, s.frequency);
}

void fields(FieldVisitor& v, DriveCase& s) {
  v.integer(
      {"schema_version", "version of the file format", Source::Choice, "", Presence::Required}, 1,
      1, s.schema_version);
  v.text({"title", "name of the case"}, s.title);
  v.section({"drive", "the source"}, s.drive);
  v.section({"source", "the amplifier"}, s.source);
  v.section({"tones", "what modulates the carrier"}, s.tones);
  v.section({"gap", "between surface and skin"}, s.gap);
  v.section({"surface", "the coated electrode"}, s.surface);
  v.section({"skin", "stratum corneum as an electrical layer"}, s.skin);
  v.section({"touch", "finger"}, s.touch);
  v.section({"sweep", "tables"}, s.sweep);
  v.section({"swipe", "the finger of a rendered swipe"}, s.swipe);
}

DriveCase read_drive_case(const std::string& path, const std::vector<std::string>& overrides) {
  return read_drive_case(load_document(own_or_shipped(path), overrides, design_roots()));
}

DriveCase read_drive_case(Document document) {
  DriveCase c;
  read_section(document, "", c);
  const bool current = c.drive.control == DriveControl::Current;
  if (peak_amplitude(c.drive) <= 0) {
    document.problem_at(current ? "drive.current" : "drive.amplitude",
                        current ? "expected a current above 0 mA under current control"
                                : "expected a voltage above 0 V");
  }
  if (c.drive.waveform != Waveform::Dc && c.drive.frequency <= 0) {
    document.problem_at("drive.frequency", "expected a frequency above 0 kHz, or waveform dc");
  }
  if (c.drive.waveform == Waveform::Am && c.source.file.empty()) {  // a recording has no tones
    if (c.tones.frequency.empty() && c.drive.modulation_frequency <= 0) {
      document.problem_at("drive.modulation_frequency",
                          "expected a frequency above 0 Hz, or tones.frequency, for am");
    }
    if (!c.tones.amplitude.empty() && c.tones.amplitude.size() != c.tones.frequency.size()) {
      document.problem_at("tones.amplitude", "expected one amplitude for each tone");
    }
    double depth = 0;
    for (double a : modulation_of(c).amplitude) depth += a;
    if (depth > 1 + 1e-9) {
      document.problem_at(
          "tones.amplitude",
          fmt::format("the amplitudes add to {:.3g}: the envelope would be negative, "
                      "expected at most 1",
                      depth));
    }
    for (double f : modulation_of(c).frequency) {
      if (f >= c.drive.frequency) {
        document.problem_at("tones.frequency", "expected tones below the carrier's frequency");
      }
    }
  }
  for (std::size_t k = 0; k < c.surface.dielectric.size(); ++k) {
    if (const auto wrong = relaxation_problem(c.surface.dielectric[k]); !wrong.key.empty())
      document.problem_at(fmt::format("surface.dielectric.{}.relaxation.{}", k, wrong.key),
                          wrong.message);
  }
  if (current && c.drive.waveform == Waveform::Dc && c.source.shunt == 0 &&
      c.gap.resistivity == 0) {
    document.problem_at("gap.resistivity",
                        "a constant current through an insulating gap has no end: give the gap a "
                        "resistivity or the source a shunt");
  }
  if (!c.gap.design.empty() && c.touch.load <= 0) {
    document.problem_at("touch.load",
                        "expected a force above 0 N: it presses the finger of gap.design");
  }
  const bool chirps = c.source.chirp_to > 0, recorded = !c.source.file.empty();
  if (chirps && (recorded || c.drive.waveform != Waveform::Sine || !c.tones.frequency.empty())) {
    document.problem_at(
        "source.chirp_to",
        "a chirp is a sine without tones: set drive.waveform = \"sine\", and no file");
  }
  finish(document);
  if (recorded)
    c.recording = recorded_signal(read_bytes(c.source.file), c.source.file, c.drive.control);
  return c;
}

namespace {

// One period of what the source gives.
Signal source_of(const DriveCase& c, const Modulation& modulation, double frequency) {
  const Drive& drive = c.drive;
  if (!c.recording.value.empty()) return c.recording;
  if (c.source.chirp_to > 0) {
    const double samples = 32 * std::max(frequency, c.source.chirp_to) * c.source.chirp_time;
    if (samples > static_cast<double>(kMostSamples))
      throw InputError({Problem{"", 0, 0, "source.chirp_time", "too many cycles: take less time"}});
    return chirp(peak_amplitude(drive), frequency, c.source.chirp_to, c.source.chirp_time,
                 static_cast<std::size_t>(std::max(64.0, samples)));
  }
  std::vector<double> frequencies = modulation.frequency;
  frequencies.push_back(frequency);
  const double period = common_period(frequencies);
  // A plain sine needs few points per cycle; edges of a square many.
  const double cycle = drive.waveform == Waveform::Square ? 4096 : 32;
  const double samples = std::max(64.0, cycle * frequency * period);
  if (period == 0 || samples > static_cast<double>(kMostSamples)) {
    throw InputError({Problem{"", 0, 0, "tones.frequency",
                              "carrier and tones have no short common period: choose frequencies "
                              "that are multiples of one that is not too low"}});
  }
  return source_signal(drive.waveform, peak_amplitude(drive), frequency, modulation,
                       drive.envelope_exponent, period, static_cast<std::size_t>(samples));
}

// Up to where lines are listed [Hz].
double highest_line(const DriveCase& c, const Signal& signal) {
  if (!c.recording.value.empty()) return 0.5 / signal.step();
  const double carrier = c.drive.waveform == Waveform::Dc ? 0 : c.drive.frequency;
  return std::max(4 * std::max(carrier, c.source.chirp_to), 1 / signal.period);
}

}  // namespace

DriveResult solve_drive(const DriveCase& c) {
  DriveResult r;
  r.area = c.touch.area;
  r.network = c.gap.design.empty() ? given_network(c) : design_network(c, r.area);
  r.network.shunt = insulating_if_zero(c.source.shunt);
  if (!c.gap.design.empty() && c.skin.resistivity > 0) {
    const double conductance = spots_conductance(c, r.area);
    if (conductance > 0) r.spots = 1 / conductance;
    double& resistance = r.network.gap.layer.resistance;
    if (c.gap.contact_spots) resistance = 1 / (1 / resistance + conductance);
  }
  r.modulation = modulation_of(c);
  const Drive& drive = c.drive;
  const double frequency = drive.waveform == Waveform::Dc ? 0 : drive.frequency;
  r.carrier =
      carrier_response(r.network, drive.control, drive.waveform, peak_amplitude(drive), frequency);

  r.series = force_series(r.network, drive.control, source_of(c, r.modulation, frequency));
  r.friction = r.series.force;
  for (double& f : r.friction.value) f = c.touch.coefficient * (c.touch.load + f);
  r.lines = spectrum_lines(r.friction, highest_line(c, r.friction));
  if (c.modulated()) {
    r.distortion = total_distortion(r.friction, r.modulation.frequency, 0.5 * frequency);
  }
  for (double f : c.sweep.frequency) {
    r.response.push_back(respond(r.network, drive.control, peak_amplitude(drive), f));
  }
  r.checks = checks_of(r, drive, film_of(c));
  if (const DriveTouch& t = c.touch; t.real_area > 0) {
    const auto onset = [&](double pull, double still) {
      return onset_friction(t.shear_strength, t.real_area, t.coefficient, t.load, pull, still);
    };
    r.onset_off = onset(0, 0);
    r.onset_on = onset(r.series.mean_force, 0);
    r.onset_static = onset(r.series.mean_force, 1);
  }
  return r;
}

}  // namespace papilla::cases
