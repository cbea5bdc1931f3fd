#include "forward/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/units.h"
#include "geometry/measured_map.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/threshold.h"

namespace papilla {
namespace {

// Seconds of the pieces for one patch at one humidity on one core, between two machines of which
// one is twice as fast. FFT pairs a solve, seconds a pair and the water: `papilla evaluate --json`
// of the published samples on 128 to 512 pixels (a smooth finger takes three times the water).
struct Prices {
  double contact, water, field, tractions;

  double sum() const { return contact + water + field + tractions; }
};

Prices prices(const Scene& scene, const Plan& plan, const Grid& grid, const Fidelity& fidelity,
              bool tractions) {
  const auto n = static_cast<double>(grid.size());
  const double pair = 3.3e-10 * n * std::log2(n);
  const auto digits = [](double tolerance) { return std::max(1.0, -std::log10(tolerance)); };
  const double contact = std::max(3.0, 3.3 * digits(fidelity.contact_tolerance) - 5) * pair;
  Prices out{contact, 0, 0, 0};
  // More droplets on a longer patch: 100 um take 16 times the water of the window, not 69.
  const double room = std::pow(std::max(1.0, grid.area() / square(kWindow)), 2.0 / 3);
  if (plan.water)
    out.water = scene.model.water == WaterModel::Droplets ? 1e-5 * std::sqrt(n) * room : 9e-9 * n;
  if (plan.field) {
    switch (field_method(scene.model)) {
      case FieldMethod::Local:
        out.field = 2e-8 * n;
        break;
      case FieldMethod::Spread:
        out.field = std::max(6.0, 10.5 * digits(fidelity.field_tolerance) - 12) * pair;
        break;
      case FieldMethod::Full:
        out.field = 2.0 * n / 65536;
        break;
    }
  }
  if (tractions) out.tractions = (plan.field ? 2 : 1) * contact;
  return out;
}

// One standard error of the modulation from one skin patch, relative (m3-prototype, section 3).
double patch_scatter(const Fidelity& f) { return f.estimator == Estimator::Load ? 0.09 : 0.11; }

std::string duration(double seconds) {
  if (seconds < 10) return fmt::format("{:.2g} s", seconds);
  if (seconds <= 120) return fmt::format("{:.0f} s", seconds);
  if (seconds <= 2 * 3600) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.0f} h", seconds / 3600);
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
  const double period = 0.5 * usual * fidelity.pixels_a_side();
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
      "the patch is {:.3g} um long and has {} pixels a side, so its skin has no waves below {:.0f} "
      "nm (the finger's end at {:.0f} nm): this is a smoother skin, its contact area and friction "
      "are not the finger's; {}",
      1e6 * side, std::max(plan.grid.nx, plan.grid.ny), 1e9 * plan.effective_cutoff, 1e9 * cutoff,
      remedy);
}

}  // namespace

double Plan::seconds() const {
  double sum = 0;
  for (const PlanStep& step : steps) sum += step.seconds;
  return sum;
}

FieldMethod field_method(const ModelOptions& model) {
  const bool paper = model.preset == Preset::M3 && model.field == FieldMethod::Spread;
  return paper ? FieldMethod::Local : model.field;
}

Plan make_plan(const Scene& scene, const Texture& texture, const Fidelity& fidelity) {
  Plan plan;
  plan.grid = simulated_patch(texture, fidelity.grid, fidelity.pixels_a_side());
  // The same for every texture, although its patch may have somewhat finer pixels.
  const Skin& skin = scene.finger.skin;
  plan.skin_cutoff =
      skin.map.empty() ? skin.cutoff : measured_skin_cutoff(skin.map, skin.map_width);
  plan.effective_cutoff = std::max({plan.skin_cutoff, 2 * kWindow / fidelity.grid,
                                    2 * std::max(plan.grid.dx(), plan.grid.dy())});
  plan.warning = unresolved_skin(plan, fidelity, plan.skin_cutoff);

  double largest_volume = 0, droplet_error = 0;
  for (double rh : scene.environment.relative_humidity) {
    const double water = scene.finger.water.volume_per_area(rh);
    largest_volume = std::max(largest_volume, water);
    // The share of the water in bridges as on the published samples (results/accuracy/water.csv).
    const double share = std::min(0.75, 0.2 + 0.009 * (water / 1e-9));
    droplet_error = std::max(droplet_error, droplet_band(water, 0, share).pull);
  }
  plan.water = largest_volume > 0;
  plan.field = scene.drive.driven();
  plan.retention =
      plan.water && scene.finger.water.hysteresis > 0 &&
      (scene.model.preset == Preset::Papilla || scene.surface.contact_angle > 1.5707963267948966);
  plan.traction_solves = fidelity.estimator == Estimator::Area && (plan.water || plan.field);

  const auto states = static_cast<double>(fidelity.skins) *
                      static_cast<double>(scene.environment.relative_humidity.size()) *
                      (scene.model.closure == Closure::Persson ? fidelity.bridge_nodes : 1);
  const Prices price = prices(scene, plan, plan.grid, fidelity, plan.traction_solves);

  plan.steps.push_back(
      {"contact", fmt::format("layered half-space, certified to {:g}", fidelity.contact_tolerance),
       fmt::format("{} skins on {} x {} pixels, skin resolved to {:.0f} nm", fidelity.skins,
                   plan.grid.nx, plan.grid.ny, 1e9 * plan.effective_cutoff),
       states * price.contact, 0});
  if (plan.water) {
    const bool droplets = scene.model.water == WaterModel::Droplets;
    plan.steps.push_back(
        {"water", droplets ? "droplet ensemble by lowest energy" : "volume threshold",
         droplets
             ? "its variation over humidity is what textures change; error: mobility and number"
             : "cheap and smooth; it reverses the sign of the texture's effect on variation",
         states * price.water, droplets ? droplet_error : threshold_shortfall(largest_volume)});
  } else {
    plan.skipped.push_back({"water", "no water at any of these humidities", 0});
  }
  if (plan.field) {
    const double seconds = states * price.field;
    switch (field_method(scene.model)) {
      case FieldMethod::Local:
        plan.steps.push_back({"field", "columns, one by one",
                              "pull typically 20 % (dry) to 35 % (wet) below the 3-D field",
                              seconds, 0.2});
        break;
      case FieldMethod::Spread:
        plan.steps.push_back({"field", "columns, the flux spreading in the dielectric",
                              "pull typically 3 % (wet) to 9 % (dry) above the 3-D field", seconds,
                              0.09});
        break;
      case FieldMethod::Full:
        plan.steps.push_back({"field", "3-D potential",
                              "asked for; pull stated to 8 % on these pixels", seconds, 0.08});
        break;
    }
    plan.steps.push_back(
        {"electrowetting", "saturated law, averaged over the cycle",
         plan.water ? "bridges conduct; the angle saturates" : "no bridges: no effect", 0, 0});
    if (!plan.water) {
      plan.steps.pop_back();
      plan.skipped.push_back({"electrowetting", "no bridges without water", 0});
    }
  } else {
    plan.skipped.push_back({"field", "the drive is at 0 V", 0});
    plan.skipped.push_back({"electrowetting", "the drive is at 0 V", 0});
  }
  if (plan.traction_solves) {
    plan.steps.push_back({"contact with tractions", plan.field ? "off and on states" : "off state",
                          "areas from resolved contact, not from the load law",
                          states * price.tractions, 0});
  } else if (plan.water || plan.field) {
    // Worst of the scenes in results/accuracy (PlanSkips.*); without a field, what is measured on
    // the published samples.
    plan.skipped.push_back(
        {"contact with tractions",
         fmt::format(
             "the load law F ~ L^{:g} stands for it (Eq. friction.3){}", fidelity.load_exponent,
             plan.field ? ": within 4 % of F_on/F_off and 13 % of the modulation on 95 % of "
                          "130 random scenes, 10 and 34 % on the worst"
                        : ""),
         plan.field ? 0.10 : 0.02});
  }
  if (scene.model.coupling == Coupling::SelfConsistent && plan.field) {
    plan.steps.push_back({"coupling", "self-consistent",
                          fmt::format("gap, field and water to a fixed point, {} passes at most",
                                      fidelity.coupling_passes),
                          states * 6 * (price.contact + price.water + price.field), 0});
  } else if (plan.field) {
    plan.skipped.push_back(
        {"self-consistent coupling",
         "one pass, as the finger was calibrated; iterating would raise the modulation by 30-60 %",
         0.6});
  }
  if (plan.retention) {
    plan.steps.push_back({"retention", "contact-angle hysteresis", "F = tau A + F_ret", 0, 0});
  } else {
    plan.skipped.push_back(
        {"retention", plan.water ? "preset m3 counts it for hydrophobic surfaces only" : "no water",
         plan.water ? 0.05 : 0});
  }
  if (scene.model.closure == Closure::Persson) {
    plan.steps.push_back({"scale bridge",
                          fmt::format("Persson, {} patch pressures", fidelity.bridge_nodes),
                          "patches under a fingertip do not share one pressure", 0, 0.03});
  } else {
    plan.skipped.push_back({"distribution of patch pressures",
                            "closure = uniform: phi of the finger file stands for it", 0});
  }
  plan.skipped.push_back({"van der Waals",
                          "Hamaker estimate below 5 % of the contact load (reported by reproduce)",
                          0.05});
  plan.skipped.push_back(
      {"Kelvin condensation",
       "menisci of nanometres; Eq. accuracy.8 on the published samples (a smooth skin: three times "
       "that), `papilla explain --measure` on this scene",
       0.15});
  plan.skipped.push_back(
      {"optics", "no part of friction: computed apart, where a metric or a limit asks", 0});

  const double se = patch_scatter(fidelity) / std::sqrt(static_cast<double>(fidelity.skins));
  plan.steps.push_back({"sampling", fmt::format("{} skins, common to all designs", fidelity.skins),
                        "patches differ by tens of percent; designs are compared on the same skins",
                        0, se});
  const int controls = std::min(fidelity.control_skins, fidelity.skins);
  if (controls >= 2) {  // measure_errors
    const bool load_law = !plan.traction_solves && (plan.water || plan.field);
    const Grid half = simulated_patch(texture, fidelity.grid / 2, fidelity.pixels_a_side() / 2);
    double seconds = prices(scene, plan, half, fidelity, plan.water || plan.field).sum();
    if (load_law) seconds += prices(scene, plan, plan.grid, fidelity, true).sum();
    plan.steps.push_back({"errors", fmt::format("{} of the skins on half the pixels", controls),
                          load_law ? "what the grid and the load law may be off by, on solved areas"
                                   : "what the grid may be off by",
                          states / fidelity.skins * controls * seconds, 0});
  }
  return plan;
}

std::string Plan::text() const {
  std::string out = fmt::format("patch {:.3g} x {:.3g} um, {} x {} pixels of {:.0f} nm\n",
                                1e6 * grid.lx, 1e6 * grid.ly, grid.nx, grid.ny, 1e9 * grid.dx());
  out += "modelled:\n";
  for (const PlanStep& step : steps) {
    out += fmt::format("  {:<22} {:<44} {}", step.piece, step.method, step.reason);
    if (step.seconds > 0) out += "; about " + duration(step.seconds);
    if (step.error > 0) out += fmt::format("; error {:.1f} %", 100 * step.error);
    out += '\n';
  }
  out += "not modelled:\n";
  for (const PlanSkip& skip : skipped) {
    out += fmt::format("  {:<32} {}", skip.piece, skip.reason);
    if (std::isinf(skip.bound)) {
      out += " (no bound)";
    } else if (skip.bound > 0) {
      out += fmt::format(" ({} {:.2g} % of friction)", skip.estimate ? "estimate" : "bound",
                         100 * skip.bound);
    }
    out += '\n';
  }
  out += "expected " + duration(seconds()) + " on one core\n";
  if (!warning.empty()) out += "warning: " + warning + '\n';
  return out;
}

}  // namespace papilla
