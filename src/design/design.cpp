#include "design/design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "base/files.h"
#include "base/installation.h"
#include "base/units.h"
#include "config/reader.h"
#include "config/writer.h"
#include "design/title.h"
#include "forward/appearance.h"
#include "forward/counterface.h"
#include "geometry/measured_map.h"
#include "geometry/roughness.h"
#include "physics/capillary/facts.h"
#include "scene/belief.h"
#include "scene/uncertainty.h"

namespace papilla::design {
namespace {

namespace fs = std::filesystem;

// Each is evaluated and kept: far more than any curve of friction shows.
constexpr std::size_t kMostHumidities = 1000;

// The mistakes across the fields of one part of a design.
using Problems = std::vector<DesignProblem>;

void environment_problems(const Environment& air, Problems& out) {
  if (air.relative_humidity.empty()) {
    out.push_back({"environment.relative_humidity", "expected at least one humidity"});
  }
  if (air.relative_humidity.size() > kMostHumidities) {
    out.push_back({"environment.relative_humidity",
                   fmt::format("{} humidities: expected {} at most", air.relative_humidity.size(),
                               kMostHumidities)});
  }
  for (std::size_t i = 1; i < air.relative_humidity.size(); ++i) {
    if (air.relative_humidity[i] <= air.relative_humidity[i - 1]) {
      out.push_back({"environment.relative_humidity", "expected rising values"});
      break;
    }
  }
  if (!air.weights.empty()) {
    if (air.weights.size() != air.relative_humidity.size()) {
      out.push_back(
          {"environment.weights", fmt::format("expected {} weights, one per humidity, got {}",
                                              air.relative_humidity.size(), air.weights.size())});
    } else if (*std::max_element(air.weights.begin(), air.weights.end()) <= 0) {
      out.push_back({"environment.weights", "expected at least one weight above 0"});
    }
  }
}

// at: of the finger in the file, "finger." or nothing where the file is a finger's; options: of the
// model there.
void finger_problems(const Finger& finger, const ModelOptions& model, const std::string& at,
                     const std::string& options, Problems& out) {
  const SkinWater& water = finger.water;
  if (water.volume.empty() || water.volume.size() != water.relative_humidity.size()) {
    out.push_back(
        {at + "water.volume",
         fmt::format("expected {} volumes, one per humidity of {}water.relative_humidity, got {}",
                     water.relative_humidity.size(), at, water.volume.size())});
  }
  for (std::size_t i = 1; i < water.relative_humidity.size(); ++i) {
    if (water.relative_humidity[i] <= water.relative_humidity[i - 1]) {
      out.push_back({at + "water.relative_humidity", "expected rising values"});
      break;
    }
  }
  if (finger.load <= 0) out.push_back({at + "load", "expected a force above 0 N"});
  if (finger.saturation.rest_low == finger.saturation.rest_high) {
    out.push_back({at + "saturation.rest_high", "expected another angle than rest_low"});
  }
  if (finger.skin.map.empty() && finger.skin.cutoff >= finger.skin.roll_off) {
    out.push_back({at + "skin.cutoff", "expected a shorter wavelength than roll_off"});
  }
  if (finger.skin.map.empty() && finger.skin.cutoff > Spectrum{}.reference_length) {
    out.push_back(
        {at + "skin.cutoff", "expected at most the 12 um that rms is of: no wave would be left"});
  }
  if (!finger.skin.map.empty() && model.closure != Closure::Uniform) {
    out.push_back({at + "skin.map",
                   fmt::format("closures persson and balance take the spectrum of the skin; use "
                               "{}.closure = \"uniform\" with a map",
                               options)});
  }
}

void drive_problems(const Drive& drive, const Surface& surface, Problems& out) {
  const bool current = drive.control == DriveControl::Current;
  if (current && drive.amplitude > 0) {
    out.push_back(
        {"drive.amplitude",
         "a voltage, beside control = \"current\": set it to 0 V, give drive.current, and "
         "the largest voltage of the source as drive.source_compliance"});
  }
  if (!current && drive.current > 0) {
    out.push_back(
        {"drive.current",
         "a current, beside control = \"voltage\": say control = \"current\", or set it to "
         "0 mA and give drive.amplitude"});
  }
  if (current && drive.waveform == Waveform::Dc && drive.driven()) {
    out.push_back({"drive.waveform",
                   "a constant current through a film that insulates has no end: give an "
                   "alternating one"});
  }
  if (current && drive.waveform == Waveform::Square && drive.driven()) {
    out.push_back({"drive.waveform",
                   "a square current makes a triangular voltage across film and gap, which is not "
                   "modelled: give a sine, or control = \"voltage\" with drive.amplitude "
                   "(`papilla solve drive` follows the circuit in time)"});
  }
  if (current && drive.current > drive.current_limit) {
    out.push_back({"drive.current", fmt::format("{} is above drive.current_limit, {}",
                                                format_quantity(drive.current, "mA"),
                                                format_quantity(drive.current_limit, "mA"))});
  }
  if (drive.waveform == Waveform::Am && drive.driven() && drive.modulation_frequency <= 0) {
    out.push_back({"drive.modulation_frequency", "expected a frequency above 0 Hz for am"});
  }
  if (!current && drive.source_compliance > 0 && drive.amplitude > drive.source_compliance) {
    out.push_back({"drive.amplitude", fmt::format("{} is above source_compliance, {}",
                                                  format_quantity(drive.amplitude, "V"),
                                                  format_quantity(drive.source_compliance, "V"))});
  }
  if (drive.driven() && surface.equivalent_thickness() <= 0) {
    out.push_back(
        {"surface.dielectric", "a driven surface needs a dielectric layer thicker than 0"});
  }
}

void film_problems(const Texture& texture, const Surface& surface, Problems& out) {
  const int carrying = surface.carrying_layer();
  for (int k = 0; k < carrying; ++k) {
    if (surface.dielectric[static_cast<std::size_t>(k)].made_by(surface.process) !=
        FilmProcess::Planar) {
      out.push_back({fmt::format("surface.dielectric.{}.process", k),
                     "a layer that follows the texture cannot lie below a planar one: list the "
                     "layers from the electrode up, or make it planar"});
    }
  }
  const std::optional<Planes> planes = facts(texture).relief.planes;
  if (carrying < 0 || !planes) return;
  const double thickness = surface.dielectric[static_cast<std::size_t>(carrying)].thickness;
  if (-planes->low >= thickness) {
    out.push_back(
        {fmt::format("surface.dielectric.{}.thickness", carrying),
         fmt::format("{}: the texture is cut {} deep into this planar layer and would reach {}; "
                     "make it thicker, or the texture shallower",
                     format_quantity(thickness, "nm"), format_quantity(-planes->low, "nm"),
                     carrying > 0 ? "the layer below it, and cuts through several layers are not "
                                    "modelled"
                                  : "its electrode")});
  }
}

// On a patch shorter than the waves of skin the finger is another one: of a flat surface friction
// comes out 4 to 14 % too high on 3 um, as air is dry or moist (docs/how_to/scans.md).
void patch_problems(const Design& design, Problems& out) {
  constexpr double kShortest = 3e-6;  // [m]
  const TextureFacts known = facts(design.texture);
  const FreePatch& patch = known.free_patch;
  if (known.cell || !patch.exact || patch.repeats || *patch.exact >= (1 - 1e-9) * kShortest) return;
  out.push_back(
      {"texture.patch",
       fmt::format("{} is shorter than the waves of skin, and friction would come out far "
                   "too high: take {} or more, better 12 um, or a larger map; a map that "
                   "repeats by itself is pressed several times side by side where that "
                   "is said of it, as_is = true",
                   format_quantity(*patch.exact, "um"), format_quantity(kShortest, "um"))});
}

// What makes a patch that is longer than the window shorter, "" of one that is not.
std::string shorter_patch(const TextureFacts& known) {
  const FreePatch& free = known.free_patch;
  if (free.least > kWindow) return "smaller particles or more coverage by them, ";
  if (known.period() > kWindow) return "a shorter period, ";
  return free.exact.value_or(0) > kWindow ? "a shorter patch, " : "";
}

// What would take minutes for every patch is refused before it begins.
void droplet_problems(const Design& design, Problems& out) {
  const Scene scene = scene_of(design);
  const SkinWater& water = scene.finger.water;
  if (design.model.water != WaterModel::Droplets || water.volume.empty()) return;
  const Grid patch = simulated_patch(design.texture, 16);
  double most = 0;
  for (const double rh : design.environment.relative_humidity)
    most = std::max(most, starting_droplets(patch, water.volume_per_area(rh), water.drops_per_um3));
  if (most <= kMostDroplets) return;
  out.push_back({"finger.water.drops_per_um3",
                 fmt::format("{:.3g} makes {:.2g} droplets on a patch of {:.3g} um, more than the "
                             "{:g} that are settled in reasonable time: fewer of them, {}"
                             "or model.water = \"threshold\"",
                             water.drops_per_um3, most, 1e6 * patch.lx, kMostDroplets,
                             shorter_patch(facts(design.texture)))});
}

// Of a pin at a path of the design.
void pin_problems(const Pin& pin, const std::string& path, const Design& design, Problems& out) {
  const std::vector<PinProblem> own = scene::pin_problems(pin);
  for (const auto& [key, message] : own) out.push_back({path + "." + key, message});
  if (!own.empty()) return;
  if (const std::string why = pin_refusal(pin, design.surface); !why.empty())
    out.push_back({path, why});
}

void counterface_problems(const Design& design, Problems& out) {
  const Counterface& c = design.counterface;
  const bool pen = c.type == CounterfaceType::Pen;
  if (c.type == CounterfaceType::Pin) {
    pin_problems(c.pin, "counterface", design, out);
  } else if (c.pin != Pin{}) {
    out.push_back({"counterface.type",
                   "a pin is described beside it: say \"pin\", or move its keys to "
                   "[counterface.pen]"});
  }
  if (pen && !c.has_pen()) {
    out.push_back({"counterface.type", "there is no pen: describe it under [counterface.pen]"});
  } else if (c.has_pen()) {
    pin_problems(c.pen, "counterface.pen", design, out);
  }
  if (c.in_place() && design.model.preset == Preset::M3)
    out.push_back({"model.preset", "the published model is one of skin: \"papilla\" takes pins"});
}

void relaxation_problems(const Surface& surface, Problems& out) {
  for (std::size_t k = 0; k < surface.dielectric.size(); ++k) {
    if (const auto wrong = relaxation_problem(surface.dielectric[k]); !wrong.key.empty())
      out.push_back(
          {fmt::format("surface.dielectric.{}.relaxation.{}", k, wrong.key), wrong.message});
  }
}

void view_problems(const View& view, const Surface& surface, Problems& out) {
  if (view.angles.empty()) out.push_back({"view.angles", "expected at least one angle"});
  if (const double index = media_of(surface, view).index; view.fill_index > index) {
    out.push_back(
        {"view.fill_index",
         fmt::format("expected at most {:.4g}, the index of what the texture is cut into", index)});
  }
}

void add_map_files(Texture& texture, std::vector<std::string*>& out) {
  if (auto* measured = std::get_if<Measured3d>(&texture.kind)) out.push_back(&measured->file);
  if (std::vector<Texture>* parts = roles(texture).parts) {
    for (Texture& part : *parts) add_map_files(part, out);
  }
}

}  // namespace

const std::vector<std::string>& accuracy_level_names() {
  static const std::vector<std::string> names{"draft", "design", "reference"};
  return names;
}

std::string AccuracySettings::level_name() const {
  return accuracy_level_names()[static_cast<std::size_t>(level)];
}

void fields(FieldVisitor& v, AccuracySettings& s) {
  v.choice({"level", "grid, samples and tolerances by name"}, accuracy_level_names(), s.level);
  v.integer(
      {"grid",
       "pixels along 12 um of the patch, for features finer than eight pixels; a longer patch "
       "has at most this many per side, or 1024; 0: by level"},
      0, 4096, s.grid);
  v.number({"target", "%", 0, 100, "instead of a level: standard error of the modulation; 0: none"},
           s.target);
  v.flag({"parameters",
          "also the error that the finger's fitted numbers leave (its `uncertainty`); optimize "
          "states it of the best design, and with this of all confirmed ones"},
         s.parameters);
  v.integer(
      {"seed",
       "which skins, offsets and droplets, the same for all designs; searches take search.seed"},
      0, 1 << 30, s.seed);
  v.integer({"droplet_seeds", "placements of the droplets on each skin, averaged (M3: 6)"}, 1, 64,
            s.droplet_seeds);
}

void fields(FieldVisitor& v, Design& s) {
  v.integer(
      {"schema_version", "version of the file format", Source::Choice, "", Presence::Required}, 1,
      1, s.schema_version);
  v.text({"title", "a line for reports"}, s.title);
  v.section({"texture", "the shape of the surface"}, s.texture);
  v.section({"surface", "the finish of the surface"}, s.surface);
  v.section({"view", "how the texture is looked at (optics only)"}, s.view);
  v.section({"finger", "the finger that touches it"}, s.finger);
  v.section({"counterface", "what touches the surface, where it is no finger"}, s.counterface);
  v.section({"environment", "the air"}, s.environment);
  v.section({"drive", "the voltage"}, s.drive);
  if (v.reading()) s.model = s.finger.calibrated_for;
  v.section({"model", "model options; default: those that the finger was fitted with"}, s.model);
  v.section({"accuracy", "speed against error"}, s.accuracy);
}

std::vector<DesignProblem> design_problems(const Design& design, DesignUse use) {
  std::vector<DesignProblem> out;
  for (const auto& [key, message] : problems(design.texture)) {
    out.push_back({"texture." + key, message});
  }
  if (design.title.size() > kLongestTitle)
    out.push_back({"title", "longer than 1000 letters; it is a line for reports"});
  environment_problems(design.environment, out);
  if (!design.counterface.in_place())
    finger_problems(design.finger, design.model, "finger.", "model", out);
  if (design.accuracy.grid > 0 && design.accuracy.grid < 16)
    out.push_back({"accuracy.grid", "expected 0 (by level) or at least 16 pixels"});
  drive_problems(design.drive, design.surface, out);
  film_problems(design.texture, design.surface, out);
  if (!design.counterface.in_place()) patch_problems(design, out);
  view_problems(design.view, design.surface, out);
  relaxation_problems(design.surface, out);
  counterface_problems(design, out);
  if (out.empty() && use == DesignUse::Simulated)
    droplet_problems(design, out);  // of a design that has a patch and a finger
  return out;
}

Scene scene_of(const Design& design) {
  const Scene scene{design.surface, design.finger, design.environment, design.drive, design.model};
  const Pin* pin = design.counterface.in_place();
  return pin ? touched_by(*pin, scene) : scene;
}

Design under_pen(Design design) {
  design.counterface.type = CounterfaceType::Pen;
  return design;
}

Fidelity fidelity_of(const Design& design) {
  Fidelity out = fidelity_level(design.accuracy.level_name());
  if (design.accuracy.grid > 0) out.grid = design.accuracy.grid;
  out.seed = static_cast<std::uint64_t>(design.accuracy.seed);
  out.droplet_seeds = design.accuracy.droplet_seeds;
  return out;
}

Optics appearance_of(const Design& design) {
  return appearance(design.texture, design.surface, design.view);
}

std::vector<std::string> calibration_mismatch(const Design& design) {
  if (design.counterface.in_place()) return {};  // nothing of a pin is fitted
  const Node now = to_table(design.model), fitted = to_table(design.finger.calibrated_for);
  std::vector<std::string> out;
  for (const Node& option : fitted.children) {
    const Node& used = *now.find(option.key);
    if (describe(used) != describe(option)) {
      out.push_back(fmt::format("model.{} is {}, the finger \"{}\" was fitted with {}", option.key,
                                describe(used), design.finger.name, describe(option)));
    }
  }
  return out;
}

std::vector<std::string> design_roots() {
  std::vector<std::string> roots;
  std::error_code error;
  const char* named = std::getenv("PAPILLA_DESIGNS");
  if (named && fs::is_directory(named, error)) roots.emplace_back(named);
  for (const std::string& folder : own_designs()) roots.push_back(folder);
  return roots;
}

std::string find_design(const std::string& name) {
  for (const std::string& root : design_roots()) {
    const std::string path = root + "/" + name;
    if (std::filesystem::exists(path)) return path;
  }
  throw InputError(name + " is in no designs folder; set PAPILLA_DESIGNS to the one that has it");
}

std::vector<std::string*> map_files(Design& design) {
  std::vector<std::string*> out;
  add_map_files(design.texture, out);
  for (std::string* file : {&design.finger.skin.map, &design.counterface.pin.roughness.map,
                            &design.counterface.pen.roughness.map}) {
    if (!file->empty()) out.push_back(file);
  }
  return out;
}

std::string maps_state(Design design) {
  std::string out;
  for (const std::string* file : map_files(design)) {
    const MapVersion version = map_version(*file);
    out += fmt::format(" {} {}", version.written.time_since_epoch().count(), version.size);
  }
  return out;
}

std::string maps_state(const Finger& finger) {
  Design design;
  design.finger = finger;
  return maps_state(std::move(design));
}

std::string designs_state(const std::string& folder) {
  std::set<std::string> names;
  for (const std::string& root : design_roots()) {
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(root + "/" + folder, none)) {
      if (entry.path().extension() == ".toml") names.insert(entry.path().filename().string());
    }
  }
  std::string out;
  for (const std::string& name : names) {
    try {
      const Design design = read_design(find_design(folder + "/" + name));
      out += fmt::format("# {}\n{}{}\n", name, to_toml(design), maps_state(design));
    } catch (const InputError&) {  // whoever needs it is told why
    }
  }
  return out;
}

std::string own_or_shipped(const std::string& file) {
  std::error_code ignored;
  if (file.empty() || fs::exists(file, ignored)) return file;
  const std::string found = find_beside(file, "", design_roots());
  return found.empty() ? file : found;
}

Finger read_finger(const std::string& path) {
  Document document = load_document(own_or_shipped(path), {}, design_roots());
  document.take("schema_version");
  Finger finger;
  read_section(document, "", finger);
  Problems wrong_together;
  if (document.problems().empty())  // else values may stand for ones that could not be read
    finger_problems(finger, finger.calibrated_for, "", "calibrated_for", wrong_together);
  for (const DesignProblem& p : wrong_together) document.problem_at(p.path, p.message);
  if (const std::string wrong = uncertainty_problem(finger); !wrong.empty())
    document.problem_at("uncertainty", wrong);
  for (const Problem& p : belief_problems(finger))
    document.problem({p.file, p.line, p.column}, p.key, p.message);
  finish(document);
  return finger;
}

void write_design(const std::string& path, const Design& design) {
  write_bytes(path, to_toml(design));
}

void write_finger(const std::string& path, const Finger& finger, const std::string& comment) {
  write_bytes(path, (comment.empty() ? "" : "# " + comment + "\n") + "schema_version = 1\n" +
                        to_toml(finger));
}

}  // namespace papilla::design
