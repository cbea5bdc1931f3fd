#include "forward/coupling.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "base/constants.h"
#include "forward/scene_terms.h"
#include "numerics/reductions.h"
#include "physics/capillary/droplets.h"
#include "physics/capillary/threshold.h"
#include "physics/electrostatics/breakdown.h"

namespace papilla::forward {
namespace {

// Adds the time until the end of its scope.
class Timed {
 public:
  explicit Timed(double& seconds) : seconds_(seconds) {}
  ~Timed() {
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
  }
  Timed(const Timed&) = delete;
  Timed& operator=(const Timed&) = delete;

 private:
  double& seconds_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

Wetting settle_water(const PatchProblem& problem, const Gap& gap, double volume,
                     const WaterProperties& properties, std::uint64_t seed, PatchResult& out) {
  const Timed timed(out.costs.seconds.water);
  const Scene& scene = *problem.scene;
  if (scene.model.water == WaterModel::Threshold) return fill_threshold(gap, volume, properties);
  DropletOptions options;
  options.drops_per_volume = scene.finger.water.drops_per_um3 * 1e18;
  options.first_step = scene.model.droplet_step;
  if (scene.model.rim_pinning || scene.model.corner_wicking) {
    options.rims = std::make_shared<RimMap>(problem.surface->height);
    options.rim_pinning = scene.model.rim_pinning;
    options.corner_wicking = scene.model.corner_wicking;
  }
  SettleReport report;
  Wetting wetting =
      settle_droplets(gap, volume, properties, options, seed, problem.droplet_index, &report);
  if (!report.converged)
    out.status.note({Trouble::WaterMoves, static_cast<double>(options.max_moves), ""});
  return wetting;
}

Wetting rewet_timed(const Wetting& off, const Gap& gap, const WaterProperties& driven,
                    PatchResult& out) {
  const Timed timed(out.costs.seconds.water);
  return rewet(off, gap, driven);
}

FieldSolution solve_field_timed(const PatchProblem& problem, const Gap& gap, const Wetting& wetting,
                                const FieldProblem& field, double tolerance, PatchResult& out) {
  const Timed timed(out.costs.seconds.field);
  FieldSolution solution =
      solve_field(*problem.scene, gap, problem.surface, wetting, field, tolerance);
  if (problem.field_correction != 1) {
    for (double& p : solution.traction.value) p *= problem.field_correction;
  }
  solution.mean_pressure *= problem.field_correction;
  return solution;
}

class PatchSolver {
 public:
  PatchSolver(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity)
      : problem_(problem),
        plan_(plan),
        fidelity_(fidelity),
        // Both moduli soften by one factor, so the kernel at 15 % RH serves every humidity:
        // pressures are divided by the factor on the way in and multiplied on the way out.
        // A compliant surface comes with the kernel of this humidity.
        softness_(problem.kernel->solid().counter_modulus > 0
                      ? 1
                      : 1 / problem.scene->finger.skin.modulus_factor(problem.relative_humidity)) {}

  UndrivenPatch undriven(const PatchStates& start, const ContactSolution* known = nullptr) const {
    const Scene& scene = *problem_.scene;
    const Grid& grid = plan_.grid;
    UndrivenPatch patch;
    PatchResult& out = patch.result;
    out.load = problem_.pressure * grid.area();
    patch.water.grid = grid;

    if (known) {
      patch.dry = *known;
      note_contact(patch.dry, out);
    } else {
      patch.dry = contact({}, start.dry.pressure.empty() ? nullptr : &start.dry, out);
    }
    if (patch.dry.gap.empty()) return patch;
    out.area_dry = area(patch.dry);
    const Gap gap{grid, patch.dry.gap};
    describe_gap(patch.dry, out);

    const WaterProperties water = water_properties(scene, scene.surface.contact_angle);
    out.volume = plan_.water ? problem_.water_factor * grid.area() *
                                   scene.finger.water.volume_per_area(problem_.relative_humidity)
                             : 0;
    if (out.volume > 0) {
      patch.water = settle_water(problem_, gap, out.volume, water, fidelity_.seed, out);
      note_water(patch.water, out);
    }
    if (capillary_off_counts(scene)) out.capillary_off = patch.water.capillary_force;
    out.capillary_on = out.capillary_off;  // until a field changes the angle
    out.retention_on = out.retention;

    // Eq. coupling.1: capillary tractions off; the same water and the field on.
    out.area_off = out.area_dry;
    if (plan_.traction_solves) {
      if (out.capillary_off != 0) {
        const ContactSolution expected = carried(patch.dry, start.dry, start.off);
        patch.off = contact(capillary_traction(patch.water, gap, water).value, &expected, out);
        out.area_off = area(patch.off);
      } else {
        patch.off = patch.dry;
      }
    }
    out.area_on = out.area_off;
    return patch;
  }

  // start: in: of a nearby humidity; out: with the driven state of this one.
  PatchResult drive(const UndrivenPatch& undriven, PatchStates& start, PatchFields* fields) const {
    const Scene& scene = *problem_.scene;
    PatchResult out = undriven.result;
    if (undriven.dry.gap.empty()) return out;
    Wetting on;
    on.grid = plan_.grid;
    FieldSolution pull;
    pull.traction = {plan_.grid, {}};
    ContactSolution on_state;
    if (plan_.field) {
      const Gap gap{plan_.grid, undriven.dry.gap};
      const FieldProblem field = field_problem(scene, problem_.relative_humidity);
      const WaterProperties driven =
          water_properties(scene, driven_contact_angle(scene, problem_.relative_humidity));
      if (out.volume > 0) {
        on = rewet_timed(undriven.water, gap, driven, out);
        out.capillary_on = on.capillary_force;
        out.retention_on = on.retention;
      }
      pull = solve_field_timed(problem_, gap, on, field, fidelity_.field_tolerance, out);
      note_field(pull, out);
      if (scene.model.coupling == Coupling::SelfConsistent) {
        on_state = iterate(undriven.dry, gap, undriven.water, driven, field, pull, on, out);
        if (plan_.traction_solves) out.area_on = area(on_state);
      } else if (plan_.traction_solves) {
        const ContactSolution expected = carried(undriven.off, start.off, start.on);
        on_state = contact(total_traction(on, gap, driven, pull.traction), &expected, out);
        out.area_on = area(on_state);
        if (!on_state.gap.empty()) note_pull_in(gap, on_state, on, field, out);
      }
    }
    if (fields) {
      fields->off = plan_.traction_solves ? undriven.off : undriven.dry;
      fields->on = on_state.pressure.empty() ? fields->off : on_state;
      fields->wetting_off = undriven.water;
      fields->wetting_on = std::move(on);
      fields->pull = std::move(pull.traction);
    }
    start.on = std::move(on_state);
    return out;
  }

 private:
  // Contact under the preload and an attractive traction [Pa]; pressures in and out are physical.
  ContactSolution contact(std::vector<double> traction, const ContactSolution* start,
                          PatchResult& out) const {
    const Timed timed(out.costs.seconds.contact);
    for (double& t : traction) t *= softness_;
    ContactOptions options;
    options.tolerance = fidelity_.contact_tolerance;
    options.hardness = problem_.scene->finger.skin.hardness * softness_;
    ContactSolution solution = solve_contact(
        *problem_.kernel, problem_.height, problem_.pressure * softness_, traction, options, start);
    ++out.costs.contact_solves;
    out.costs.fft_pairs += solution.fft_pairs;
    note_contact(solution, out);
    return solution;
  }

  static void note_contact(const ContactSolution& solution, PatchResult& out) {
    out.certificate = std::max(out.certificate, solution.certificate);
    if (!solution.converged()) out.status.note({Trouble::ContactUnsolved, 0, solution.reason});
  }

  // The state expected under tractions: the one without them and the pressures that the same
  // tractions added at a nearby humidity.
  static ContactSolution carried(const ContactSolution& now, const ContactSolution& before,
                                 const ContactSolution& after) {
    ContactSolution expected = now;
    if (before.pressure.size() != now.pressure.size() ||
        after.pressure.size() != now.pressure.size()) {
      return expected;
    }
    for (std::size_t i = 0; i < expected.pressure.size(); ++i) {
      expected.pressure[i] =
          std::max(0.0, expected.pressure[i] + after.pressure[i] - before.pressure[i]);
    }
    return expected;
  }

  double area(const ContactSolution& state) const {
    return measure_area(*problem_.kernel, state, problem_.scene->finger.skin.hardness * softness_)
        .near_edge;
  }

  std::vector<double> total_traction(const Wetting& wetting, const Gap& gap,
                                     const WaterProperties& water, const Traction& pull) const {
    std::vector<double> total = pull.value;
    if (total.empty()) total.assign(plan_.grid.size(), 0);
    if (wetting.capillary_force != 0) {
      const Traction capillary = capillary_traction(wetting, gap, water);
      for (std::size_t i = 0; i < total.size(); ++i) total[i] += capillary.value[i];
    }
    return total;
  }

  // Eq. coupling.5: one pass cannot see pull-in, but a next pass that would double the pull tells
  // that its answer is none. The field is solved again only where plain columns have grown by half.
  void note_pull_in(const Gap& gap, const ContactSolution& state, const Wetting& wetting,
                    const FieldProblem& field, PatchResult& out) const {
    constexpr double kSuspicious = 1.5, kTwice = 2;
    const double h0 = field.dielectric + std::abs(field.skin_layer);
    double before = 0, after = 0;
    for (std::size_t i = 0; i < gap.value.size(); ++i) {
      if (!wetting.bridged.empty() && wetting.bridged[i]) continue;
      before += 1 / square(gap.value[i] + h0);
      after += 1 / square(state.gap[i] + h0);
    }
    if (!(after > kSuspicious * before) || out.pull <= 0) return;
    const FieldSolution next = solve_field_timed(problem_, {plan_.grid, state.gap}, wetting, field,
                                                 fidelity_.field_tolerance, out);
    const double ratio = next.mean_pressure * plan_.grid.area() / out.pull;
    if (ratio >= kTwice) out.status.note({Trouble::SecondPassPullIn, ratio - 1, ""});
  }

  // Gap, water and field iterated to a fixed point. Eq. coupling.2: under-relaxed by a half in the
  // traction; pull-in is a pull that grows without settling, or a closed gap.
  ContactSolution iterate(const ContactSolution& dry, const Gap& dry_gap, const Wetting& off,
                          const WaterProperties& driven, const FieldProblem& field,
                          FieldSolution& pull, Wetting& on, PatchResult& out) const {
    std::vector<double> traction = total_traction(on, dry_gap, driven, pull.traction);
    ContactSolution state = dry;
    double previous = out.pull;
    const double first = out.pull;
    double change = 0;
    for (int pass = 0; pass < fidelity_.coupling_passes; ++pass) {
      state = contact(traction, &state, out);
      if (state.gap.empty()) return dry;
      const Gap gap{plan_.grid, state.gap};
      if (out.volume > 0) {
        on = rewet_timed(off, gap, driven, out);
        out.capillary_on = on.capillary_force;
        out.retention_on = on.retention;
      }
      pull = solve_field_timed(problem_, gap, on, field, fidelity_.field_tolerance, out);
      note_field(pull, out);
      change = (out.pull - previous) / std::max(out.pull, 1e-30);
      const std::vector<double> target = total_traction(on, gap, driven, pull.traction);
      for (std::size_t i = 0; i < traction.size(); ++i) {
        traction[i] = pass == 0 ? target[i] : 0.5 * (traction[i] + target[i]);
      }
      if (measure_area(*problem_.kernel, state).raw > 0.9) {
        out.status = {Trouble::ClosedPullIn, 0, ""};
        return state;
      }
      if (std::abs(change) < fidelity_.coupling_tolerance) return state;
      previous = out.pull;
    }
    if (change > 0 && out.pull > 2 * first) {
      out.status = {Trouble::GrowingPullIn, 0, ""};
    } else {
      out.status.note({Trouble::PassesUsedUp, static_cast<double>(fidelity_.coupling_passes), ""});
    }
    return state;
  }

  void describe_gap(const ContactSolution& dry, PatchResult& out) const {
    const auto n = static_cast<double>(dry.gap.size());
    out.mean_gap = sum(dry.gap) / n;
    out.indentation = largest(problem_.height) - sum(problem_.height) / n - out.mean_gap;
  }

  static void note_water(const Wetting& off, PatchResult& out) {
    out.bridges = off.bridges;
    out.wetted = off.wetted_fraction;
    out.bridge_volume = off.bridge_volume;
    out.retention = off.retention;
    for (const Droplet& d : off.droplets) {
      if (d.film > 0 && d.film < 1) out.on_its_way += d.volume;
    }
    if (off.status == WettingStatus::Flooded) out.status.note({Trouble::Flooded, 0, ""});
  }

  void note_field(const FieldSolution& pull, PatchResult& out) const {
    out.pull = pull.mean_pressure * plan_.grid.area();
    out.over_limit_area = pull.over_limit_area;
    out.over_limit_share = pull.over_limit_share;
    out.peak_air_field = pull.peak_air_field;
    out.peak_oxide_field = pull.peak_oxide_field;
    const Surface& surface = problem_.scene->surface;
    out.oxide_margin = dielectric_margin(
        surface.layers(), surface.dielectric_thickness() * pull.peak_oxide_field, kInfinity);
    if (!pull.ok) out.status.note({Trouble::FieldUnsolved, 0, pull.reason});
  }

  const PatchProblem& problem_;
  const Plan& plan_;
  const Fidelity& fidelity_;
  double softness_;
};

}  // namespace

UndrivenPatch undriven_patch(const PatchProblem& problem, const Plan& plan,
                             const Fidelity& fidelity, const PatchStates& start) {
  return PatchSolver(problem, plan, fidelity).undriven(start);
}

UndrivenPatch wet_patch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity,
                        const ContactSolution& dry) {
  return PatchSolver(problem, plan, fidelity).undriven({}, &dry);
}

PatchResult drive_patch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity,
                        const UndrivenPatch& undriven, PatchFields* fields) {
  PatchStates start;
  return PatchSolver(problem, plan, fidelity).drive(undriven, start, fields);
}

PatchResult solve_patch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity,
                        PatchStates& states, PatchFields* fields) {
  const PatchSolver solver(problem, plan, fidelity);
  UndrivenPatch undriven = solver.undriven(states);
  PatchResult out = solver.drive(undriven, states, fields);
  if (undriven.dry.gap.empty()) {
    states = {};
  } else {
    states.dry = std::move(undriven.dry);
    states.off = std::move(undriven.off);
  }
  return out;
}

}  // namespace papilla::forward
