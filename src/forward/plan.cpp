#include "forward/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "base/constants.h"
#include "base/text.h"
#include "forward/electric_path.h"
#include "forward/field_ratio.h"
#include "forward/scene_terms.h"
#include "geometry/measured_map.h"
#include "physics/capillary/facts.h"
#include "physics/contact/facts.h"
#include "physics/electrostatics/rules.h"

namespace papilla::forward {
namespace {

// Lands and holes of few pixels have another width than the texture's.
std::string coarse_features(const Plan& plan, const Fidelity& fidelity, double smallest) {
  constexpr double kFewPixels = 8;
  constexpr int kLargestKey = 4096;
  if (!(plan.feature_pixels < kFewPixels)) return {};
  int grid = fidelity.grid;
  double pixels = plan.feature_pixels;
  for (; pixels < kFewPixels && grid < kLargestKey; grid *= 2) pixels *= 2;
  return fmt::format(
      "the smallest feature of the texture, {} nm, is {:.2g} pixels wide: its friction is "
      "known as well as its error part `grid` says and not better; {}",
      significant(1e9 * smallest, 3), plan.feature_pixels,
      pixels >= kFewPixels ? fmt::format("accuracy.grid = {} gives it {:.2g}", grid, pixels)
                           : fmt::format("no grid up to {} resolves it", kLargestKey));
}

// Friction is shear strength times area, whichever way the finger slides.
std::string sliding_direction(const Texture& texture) {
  if (!facts(texture).directional) return {};
  return "the texture has a direction and friction has none here: shear strength times contact "
         "area, the same along the grooves or crests and across them; what the direction does is "
         "not known";
}

// What becomes of a direct voltage: the pull that stays, and how soon it is that.
std::string direct_voltage(const Scene& scene) {
  if (!scene.drive.driven() || scene.drive.waveform != Waveform::Dc) return {};
  constexpr double kHumidity = 0.5, kNarrow = 0.1e-6, kWide = 1e-6;  // of gaps under a ridge [m]
  const double slow = relaxation_time(scene, kHumidity, kNarrow);
  const double fast = relaxation_time(scene, kHumidity, kWide);
  if (std::isinf(slow)) return "direct voltage: nothing leaks, the charge stays where it is";
  return fmt::format(
      "direct voltage: the pull is the one that stays when charge has leaked through gap, film and "
      "skin, {:.2g} to {:.2g} ms after the touch (gaps of {:g} and {:g} um); a film that insulates "
      "better than the gap has taken the voltage by then",
      1e3 * std::min(slow, fast), 1e3 * std::max(slow, fast), 1e6 * kNarrow, 1e6 * kWide);
}

// Where a current source reaches its largest voltage before its current.
std::string source_at_compliance(const Scene& scene) {
  std::string humidities;
  for (const double rh : scene.environment.relative_humidity) {
    if (!source_voltage(scene, rh).at_compliance) continue;
    humidities += fmt::format("{}{:.0f} %", humidities.empty() ? "" : ", ", 100 * rh);
  }
  if (humidities.empty()) return {};
  return fmt::format(
      "at {} RH {:.3g} mA would need more than source_compliance, {} V: judged at that voltage",
      humidities, 1e3 * scene.drive.current, significant(scene.drive.source_compliance, 3));
}

// The impedance is that of a spectrum, and a pin by a map has none.
std::string mapped_under_current(const Scene& scene) {
  const Finger& finger = scene.finger;
  const bool current = scene.drive.driven() && scene.drive.control == DriveControl::Current;
  if (!current || finger.skin.map.empty() || finger.macro.ridge_rms > 0) return {};
  return "under a current the voltage is that of the film alone: the roughness of the map is not "
         "in the impedance (Eq. coupling.4), so that voltage and pull come out too small; state "
         "roughness.rms in place of the map, or drive by voltage";
}

// Water on a surface that it nearly wets: caps so flat that they meet where they are laid down, and
// merge into a few large drops, where the film that they are would fill the narrowest gaps.
std::string nearly_wetting(const Scene& scene, bool water) {
  constexpr double kFlat = 10 * kPi / 180;
  const double angle = std::min(scene.surface.contact_angle, scene.finger.water.contact_angle);
  if (!water || angle >= kFlat || scene.model.water != WaterModel::Droplets) return {};
  return fmt::format(
      "nearly wetting, {:.2g} deg: droplets this flat merge into few, and a film would spread in "
      "their place; model.water = \"threshold\" gives that limit (flat glass at 0 deg, 55 % RH: "
      "modulation of some 0.75 by droplets, 0.25 by a film), and what is between is not known",
      angle * 180 / kPi);
}

// A patch so much longer than the window that its pixels, limited in number, drop waves of the skin
// that every level keeps on the window.
std::string unresolved_skin(const Plan& plan, const Fidelity& fidelity, double cutoff) {
  constexpr int kCoarsestLevel = 128, kLargestKey = 4096;
  constexpr double kNoticed = 1.2;  // shares of a pixel are no reason to warn
  const double usual = std::max(cutoff, 2 * kWindow / std::min(fidelity.grid, kCoarsestLevel));
  if (plan.effective_cutoff <= kNoticed * usual) return {};
  const double side = std::max(plan.grid.lx, plan.grid.ly);
  const double needed = std::ceil(2 * side / usual);
  const double period = 0.5 * usual * fidelity.pixels_per_side();
  const std::string remedy =
      needed <= kLargestKey
          ? fmt::format(
                "accuracy.grid = {:.0f}, or a period of at most {:.3g} um, resolves it as "
                "on a small patch",
                needed, 1e6 * period)
          : fmt::format(
                "a period of at most {:.3g} um resolves it as on a small patch, "
                "accuracy.grid = {} to {:.0f} nm",
                1e6 * period, kLargestKey, 1e9 * std::max(cutoff, 2 * side / kLargestKey));
  return fmt::format(
      "the patch is {:.3g} um long and has {} pixels per side, so its skin has no waves below "
      "{:.0f} "
      "nm (the finger's end at {:.0f} nm): this is a smoother skin, its contact area and friction "
      "are not the finger's; {}",
      1e6 * side, std::max(plan.grid.nx, plan.grid.ny), 1e9 * plan.effective_cutoff, 1e9 * cutoff,
      remedy);
}

// Seconds of the pieces for one patch at one humidity.
struct Prices {
  double contact = 0, water = 0, field = 0, tractions = 0;

  double sum() const { return contact + water + field + tractions; }
};

// The mean over the humidities; the water of a skin may be several placements and volumes.
// room: about the mean gap [m].
Prices prices(const Scene& scene, const Plan& plan, const Grid& grid, const Fidelity& fidelity,
              bool tractions, double room) {
  const SkinWater& water = scene.finger.water;
  const std::vector<double>& humidities = scene.environment.relative_humidity;
  double droplets = 0;
  for (const double rh : humidities) {
    const double volume = water.volume_per_area(rh);
    if (volume < room)  // else the gap is full, and no droplet moves
      droplets += starting_droplets(grid, volume, water.drops_per_um3) /
                  static_cast<double>(humidities.size());
  }
  double members = 1;
  if (plan.water && water.volume_spread > 0) members *= 2;
  if (plan.water && scene.model.water == WaterModel::Droplets) members *= fidelity.droplet_seeds;
  Prices out;
  out.contact = contact_seconds(grid, fidelity.contact_tolerance);
  if (plan.water) out.water = members * water_facts(scene.model.water).seconds(grid, droplets);
  if (plan.field)
    out.field =
        members * field_rule(field_method(scene.model)).seconds(grid, fidelity.field_tolerance);
  if (tractions) out.tractions = members * (plan.field ? 2 : 1) * out.contact;
  return out;
}

// What every piece decides by.
struct Setting {
  const Scene& scene;
  const Texture& texture;
  const Fidelity& fidelity;
  const Plan& plan;           // grid and decisions
  std::vector<double> water;  // volumes per area [m], one per humidity
  Prices price;
  double states;  // patches to solve: skins, humidities, patch pressures
  double room;    // about the mean gap [m]
};

// A piece says what it does, or why it is skipped and what that costs; or nothing, where there is
// nothing to say.
using Entry = std::variant<std::monostate, PlanStep, PlanSkip>;

Entry contact(const Setting& s) {
  const Grid& grid = s.plan.grid;
  return PlanStep{Piece::Contact, contact_method(s.fidelity.contact_tolerance),
                  fmt::format("{} skins on {} x {} pixels, skin resolved to {:.0f} nm",
                              s.fidelity.skins, grid.nx, grid.ny, 1e9 * s.plan.effective_cutoff),
                  s.states * s.price.contact, 0};
}

Entry water(const Setting& s) {
  if (!s.plan.water) return PlanSkip{Piece::Water, "no water at any of these humidities"};
  const WaterFacts& facts = water_facts(s.scene.model.water);
  return PlanStep{Piece::Water, facts.method, facts.reason, s.states * s.price.water,
                  facts.error(s.water)};
}

const char* undriven(const Setting& s) {
  return s.scene.touch.conducts ? "the drive is at 0"
                                : "what touches does not conduct: no field reaches it";
}

Entry field(const Setting& s) {
  if (!s.plan.field) return PlanSkip{Piece::Field, undriven(s)};
  const FieldMethod method = field_method(s.scene.model);
  const FieldRule& rule = field_rule(method);
  PlanStep step{Piece::Field, rule.method, rule.accuracy, s.states * s.price.field,
                rule.usual_error};
  if (field_corrected(s.scene, s.fidelity)) {
    step.reason = fmt::format("scaled to the 3-D field of {} skin{}", s.fidelity.field_skins,
                              s.fidelity.field_skins > 1 ? "s" : "");
    step.error = kCorrectedFieldError;
    step.seconds += field_ratio_seconds(s.scene, s.plan.grid, s.fidelity);
  }
  return step;
}

Entry electrowetting(const Setting& s) {
  if (!s.plan.field) return PlanSkip{Piece::Electrowetting, undriven(s)};
  if (!s.plan.water) return PlanSkip{Piece::Electrowetting, "no bridges without water"};
  return PlanStep{Piece::Electrowetting, "saturated law, averaged over the cycle",
                  "bridges conduct; the angle saturates"};
}

Entry tractions(const Setting& s) {
  const bool field = s.plan.field;
  if (s.plan.traction_solves) {
    return PlanStep{Piece::Tractions, field ? "off and on states" : "off state",
                    "areas from resolved contact, not from the load law",
                    s.states * s.price.tractions};
  }
  if (!s.plan.water && !field) return {};
  // Worst of the scenes in results/accuracy (PlanSkips.*); without a field, what is measured on the
  // published samples.
  const char* worst =
      field ? ": within 5 % of F_on/F_off and 15 % of the modulation on 95 % of 180 random scenes, "
              "7 and 31 % on the worst"
            : "";
  return PlanSkip{Piece::Tractions,
                  fmt::format("the load law F ~ L^{:g} stands for it (Eq. friction.3){}",
                              s.fidelity.load_exponent, worst),
                  field ? 0.071 : 0.02};
}

Entry coupling(const Setting& s) {
  if (!s.plan.field) return {};
  if (s.scene.model.coupling == Coupling::OnePass) {
    return PlanSkip{
        Piece::Coupling,
        "one pass: the gap before the attractions gives them; an equilibrium would raise the "
        "modulation by 5 to 50 %",
        0.5};
  }
  const bool all = s.plan.traction_solves;
  const int skins =
      all ? s.fidelity.skins : std::min(s.fidelity.equilibrium_skins, s.fidelity.skins);
  // A loose and a final contact before the drive and under it, where one pass has one each.
  const double more = all ? 1 : 3;
  return PlanStep{
      Piece::Coupling, "equilibrium",
      fmt::format("gap, field and water until they agree within {:.2g} % of the load{}",
                  100 * s.fidelity.coupling_tolerance,
                  all ? "" : fmt::format(", on {} of the skins, by the load law on all", skins)),
      s.states / s.fidelity.skins * skins * more *
          (s.price.contact + s.price.water + s.price.field)};
}

Entry retention(const Setting& s) {
  if (s.plan.retention)
    return PlanStep{Piece::Retention, "contact-angle hysteresis", "F = tau A + F_ret"};
  if (!s.plan.water) return PlanSkip{Piece::Retention, "no water"};
  return PlanSkip{Piece::Retention, "preset m3 counts it for hydrophobic surfaces only", 0.05};
}

// Between one patch pressure and six, relative (docs/theory/coupling.md).
constexpr double kOfBalance = 0.03;

Entry patch_pressures(const Setting& s) {
  if (s.scene.model.closure == Closure::Uniform) {
    return PlanSkip{Piece::PatchPressures,
                    "closure = uniform: phi of the finger file stands for it"};
  }
  if (s.scene.model.closure == Closure::Balance) {
    const bool far = s.scene.finger.macro.far_gaps > 0;
    return PlanStep{Piece::PatchPressures,
                    fmt::format("one balance of all gaps, {} patch pressure{}",
                                s.fidelity.balance_nodes, s.fidelity.balance_nodes > 1 ? "s" : ""),
                    far ? "open gaps of the ridges pull and hold water over this texture and film"
                        : "finger.macro.far_gaps = 0: open gaps of the ridges left out",
                    0, kOfBalance};
  }
  return PlanStep{Piece::PatchPressures,
                  fmt::format("Persson, {} patch pressures", s.fidelity.bridge_nodes),
                  "patches under a fingertip do not share one pressure", 0, 0.03};
}

Entry van_der_waals(const Setting&) {
  return PlanSkip{Piece::VanDerWaals,
                  "Hamaker estimate below 5 % of the contact load (reported by reproduce)", 0.05};
}

Entry kelvin(const Setting&) {
  return PlanSkip{
      Piece::Kelvin,
      "menisci of nanometres; Eq. accuracy.8 on the published samples (a smooth skin: three times "
      "that), `papilla explain --measure` on this scene",
      0.15};
}

Entry optics(const Setting&) {
  return PlanSkip{Piece::Optics,
                  "no part of friction: computed apart, where a metric or a limit asks"};
}

Entry sampling(const Setting& s) {
  // One standard error of the modulation from one skin patch, relative (m3-prototype, section 3).
  const double scatter = s.fidelity.estimator == Estimator::Load ? 0.09 : 0.11;
  return PlanStep{Piece::Sampling, fmt::format("{} skins, common to all designs", s.fidelity.skins),
                  "patches differ by tens of percent; designs are compared on the same skins", 0,
                  scatter / std::sqrt(static_cast<double>(s.fidelity.skins))};
}

// measure_errors
Entry errors(const Setting& s) {
  const Fidelity& fidelity = s.fidelity;
  const int controls = std::min(fidelity.control_skins, fidelity.skins);
  if (controls < 2) return {};
  const bool forces = s.plan.water || s.plan.field;
  const bool load_law = !s.plan.traction_solves && forces;
  const Grid half = simulated_patch(s.texture, fidelity.grid / 2, fidelity.pixels_per_side() / 2);
  double seconds = prices(s.scene, s.plan, half, fidelity, forces, s.room).sum();
  if (load_law) seconds += prices(s.scene, s.plan, s.plan.grid, fidelity, true, s.room).sum();
  return PlanStep{Piece::Errors, fmt::format("{} of the skins on half the pixels", controls),
                  load_law ? "what the grid and the load law may be off by, on solved areas"
                           : "what the grid may be off by",
                  s.states / fidelity.skins * controls * seconds};
}

// Each piece, its answer, and its names where it is modelled and where it is skipped.
struct PieceRow {
  Piece piece;
  Entry (*entry)(const Setting&);
  const char* modelled;
  const char* skipped;
};
constexpr std::array kPieces{
    PieceRow{Piece::Contact, contact, "contact", "contact"},
    PieceRow{Piece::Water, water, "water", "water"},
    PieceRow{Piece::Field, field, "field", "field"},
    PieceRow{Piece::Electrowetting, electrowetting, "electrowetting", "electrowetting"},
    PieceRow{Piece::Tractions, tractions, "contact with tractions", "contact with tractions"},
    PieceRow{Piece::Coupling, coupling, "coupling", "equilibrium"},
    PieceRow{Piece::Retention, retention, "retention", "retention"},
    PieceRow{Piece::PatchPressures, patch_pressures, "scale bridge",
             "distribution of patch pressures"},
    PieceRow{Piece::VanDerWaals, van_der_waals, "van der Waals", "van der Waals"},
    PieceRow{Piece::Kelvin, kelvin, "Kelvin condensation", "Kelvin condensation"},
    PieceRow{Piece::Optics, optics, "optics", "optics"},
    PieceRow{Piece::Sampling, sampling, "sampling", "sampling"},
    PieceRow{Piece::Errors, errors, "errors", "errors"}};
static_assert([] {
  for (std::size_t i = 0; i < kPieces.size(); ++i) {
    if (kPieces[i].piece != static_cast<Piece>(i)) return false;
  }
  return kPieces.size() == static_cast<std::size_t>(Piece::Errors) + 1;
}());

const PieceRow& row(Piece piece) { return kPieces[static_cast<std::size_t>(piece)]; }

void set_resolution(Plan& plan, const Skin& skin, const Texture& texture,
                    const Fidelity& fidelity) {
  plan.grid = simulated_patch(texture, fidelity.grid, fidelity.pixels_per_side());
  // The same for every texture, although its patch may have somewhat finer pixels.
  plan.skin_cutoff =
      skin.map.empty() ? skin.cutoff : measured_skin_cutoff(skin.map, skin.map_width);
  plan.effective_cutoff = std::max({plan.skin_cutoff, 2 * kWindow / fidelity.grid,
                                    2 * std::max(plan.grid.dx(), plan.grid.dy())});
  const double smallest = facts(texture).margins.smallest();
  plan.feature_pixels = smallest / std::max(plan.grid.dx(), plan.grid.dy());
  for (std::string said : {unresolved_skin(plan, fidelity, plan.skin_cutoff),
                           coarse_features(plan, fidelity, smallest)})
    if (!said.empty()) plan.warnings.push_back(std::move(said));
}

}  // namespace

std::string duration(double seconds) {
  if (seconds < 10) return fmt::format("{:.2g} s", seconds);
  if (seconds <= 120) return fmt::format("{:.0f} s", seconds);
  if (seconds <= 2 * 3600) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.0f} h", seconds / 3600);
}

const char* PlanStep::name() const { return row(piece).modelled; }
const char* PlanSkip::name() const { return row(piece).skipped; }

double Plan::seconds() const {
  double sum = 0;
  for (const PlanStep& step : steps) sum += step.seconds;
  return sum;
}

Plan make_plan(const Scene& given, const Texture& texture, const Fidelity& fidelity) {
  const Scene scene = in_its_state(given);
  Plan plan;
  set_resolution(plan, scene.finger.skin, texture, fidelity);
  const std::vector<double>& humidities = scene.environment.relative_humidity;
  Setting setting{scene, texture, fidelity, plan, {}, {}, 0, 0};
  // Peaks of a rough skin rest on the land.
  constexpr double kPeakOverRms = 3;
  setting.room = kPeakOverRms * scene.finger.skin.rms * scene.finger.skin.relief_factor() +
                 0.5 * facts(texture).relief.height().value_or(0);
  for (const double rh : humidities)
    setting.water.push_back(scene.finger.water.volume_per_area(rh));
  plan.water =
      std::any_of(setting.water.begin(), setting.water.end(), [](double v) { return v > 0; });
  plan.field = scene.drive.driven() && scene.touch.conducts;
  for (std::string said :
       {direct_voltage(scene), source_at_compliance(scene), mapped_under_current(scene),
        sliding_direction(texture), nearly_wetting(scene, plan.water)})
    if (!said.empty()) plan.warnings.push_back(std::move(said));
  plan.retention = plan.water && scene.finger.water.hysteresis > 0 && retention_counts(scene);
  plan.traction_solves = fidelity.estimator == Estimator::Area && (plan.water || plan.field);
  setting.price = prices(scene, plan, plan.grid, fidelity, plan.traction_solves, setting.room);
  setting.states = static_cast<double>(fidelity.skins) * static_cast<double>(humidities.size()) *
                   fidelity.pressure_nodes(scene.model.closure);
  for (const PieceRow& piece : kPieces) {
    const Entry entry = piece.entry(setting);
    if (const auto* step = std::get_if<PlanStep>(&entry)) plan.steps.push_back(*step);
    if (const auto* skip = std::get_if<PlanSkip>(&entry)) plan.skipped.push_back(*skip);
  }
  return plan;
}

Plan with_look(Plan plan, const std::string& theory) {
  std::erase_if(plan.skipped, [](const PlanSkip& s) { return s.piece == Piece::Optics; });
  const auto later = std::find_if(plan.steps.begin(), plan.steps.end(),
                                  [](const PlanStep& s) { return s.piece > Piece::Optics; });
  plan.steps.insert(
      later, {Piece::Optics, theory, "a metric or a limit asks for the look; no part of friction"});
  return plan;
}

std::string Plan::text() const {
  std::string out = fmt::format("patch {:.3g} x {:.3g} um, {} x {} pixels of {:.0f} nm\n",
                                1e6 * grid.lx, 1e6 * grid.ly, grid.nx, grid.ny, 1e9 * grid.dx());
  out += "modelled:\n";
  for (const PlanStep& step : steps) {
    out += fmt::format("  {:<22} {:<44} {}", step.name(), step.method, step.reason);
    if (step.seconds > 0) out += "; about " + duration(step.seconds);
    if (step.error > 0) out += fmt::format("; error {:.1f} %", 100 * step.error);
    out += '\n';
  }
  out += "not modelled:\n";
  for (const PlanSkip& skip : skipped) {
    out += fmt::format("  {:<32} {}", skip.name(), skip.reason);
    if (std::isinf(skip.bound)) {
      out += " (no bound)";
    } else if (skip.bound > 0) {
      out += fmt::format(" ({} {:.2g} % of friction)", skip.estimate ? "estimate" : "bound",
                         100 * skip.bound);
    }
    out += '\n';
  }
  out += "expected " + duration(seconds()) + " on one core of a usual machine\n";
  for (const std::string& said : warnings) out += "warning: " + said + '\n';
  return out;
}

}  // namespace papilla::forward
