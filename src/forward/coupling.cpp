#include "forward/coupling.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "base/constants.h"
#include "forward/electric_path.h"
#include "forward/equilibrium.h"
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

// Of states along a branch, where the attraction counts and not the area.
constexpr double kBranchTolerance = 3e-3;

class PatchSolver {
 public:
  PatchSolver(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity)
      : problem_(problem),
        plan_(plan),
        fidelity_(fidelity),
        // Both moduli soften by one factor, so the kernel at 15 % RH serves every humidity: loads
        // are divided by the factor on the way in, and the pressures of a state are over it until
        // they leave in `PatchFields`. A compliant surface comes with the kernel of this humidity.
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
      patch.dry = contact({}, start.dry.pressure.empty() ? nullptr : &start.dry,
                          fidelity_.contact_tolerance, out);
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

    out.area_off = out.area_on = out.area_dry;
    patch.dry_gap = out;
    if (plan_.traction_solves) close_undriven(patch, start);
    return patch;
  }

  // The undriven patch by its dry contact with its gap closed by its bridges: Eq. coupling.1 in one
  // pass, else Eq. coupling.2.
  void close_undriven(UndrivenPatch& patch, const PatchStates& start) const {
    PatchResult& out = patch.result;
    patch.off = patch.dry;
    patch.water_off = patch.water;
    if (out.capillary_off == 0) return;
    const WaterProperties water =
        water_properties(*problem_.scene, problem_.scene->surface.contact_angle);
    const Gap gap{plan_.grid, patch.dry.gap};
    const ContactSolution expected = carried(patch.dry, start.dry, start.off);
    if (!in_equilibrium()) {
      patch.off = contact(capillary_traction(patch.water, gap, water).value, &expected,
                          fidelity_.contact_tolerance, out);
    } else {
      Closed closed = close(
          {std::vector<double>(plan_.grid.size()),
           attraction(gap, patch.water, water, nullptr, out)},
          patch.dry, expected, start.slope_off,
          [&](const Gap& at) {
            return attraction(at, rewet_timed(patch.water, at, water, out), water, nullptr, out);
          },
          out);
      patch.off = std::move(closed.state);
      patch.slope = closed.slope;
      if (out.status.pull_in()) out.status.note({Trouble::UndrivenPullIn, 0, ""});
      if (patch.off.gap.empty()) return;
      patch.water_off = std::move(closed.last.water);
      note_water(patch.water_off, out);
      out.capillary_off = out.capillary_on = patch.water_off.capillary_force;
      out.retention_on = out.retention;
    }
    out.area_off = out.area_on = area(patch.off);
  }

  // Contact under tractions of that shape (even, where there are none) with another mean [Pa].
  ContactSolution closed(std::vector<double> shape, double attraction, const ContactSolution& start,
                         PatchResult& out) const {
    if (shape.empty()) shape.assign(plan_.grid.size(), 1);
    return contact(with_mean(std::move(shape), attraction), &start, kBranchTolerance, out);
  }

  // What the gap of a state attracts with under the drive of the scene [Pa].
  std::vector<double> attracted(const UndrivenPatch& dry, const ContactSolution& state,
                                PatchResult& out) const {
    return driven(dry, drive_terms(), {plan_.grid, state.gap}, out).traction;
  }

  // start: in: of a nearby humidity; out: with the driven state of this one.
  PatchResult drive(const UndrivenPatch& undriven, PatchStates& start, PatchFields* fields) const {
    const Scene& scene = *problem_.scene;
    if (undriven.dry.gap.empty()) return undriven.result;
    PatchResult out = plan_.traction_solves ? undriven.result : undriven.dry_gap;
    Wetting on;
    on.grid = plan_.grid;
    FieldSolution pull;
    pull.traction = {plan_.grid, {}};
    ContactSolution on_state;
    if (plan_.field) {
      // Without tractions, and in one pass, both fields act over the dry gap. Eq. coupling.1
      const bool closes = plan_.traction_solves && in_equilibrium();
      const ContactSolution& before = closes ? undriven.off : undriven.dry;
      if (before.gap.empty()) return out;
      const Gap gap{plan_.grid, before.gap};
      const DriveTerms terms = drive_terms();
      const auto at = [&](const Gap& here) { return driven(undriven, terms, here, out); };
      Attraction found = at(gap);
      const ContactSolution expected = carried(undriven.off, start.off, start.on);
      if (closes) {
        const WaterProperties water = water_properties(scene, scene.surface.contact_angle);
        Closed closed =
            close({capillary_traction(undriven.water_off, gap, water).value, std::move(found)},
                  undriven.dry, expected, start.slope_on, at, out);
        on_state = std::move(closed.state);
        found = std::move(closed.last);
        start.slope_on = closed.slope;
      } else if (plan_.traction_solves) {
        on_state = contact(found.traction, &expected, fidelity_.contact_tolerance, out);
        if (!on_state.gap.empty())
          note_pull_in(gap, on_state, found.water, terms.field, found.pull, out);
      }
      if (out.volume > 0) {
        out.capillary_on = found.water.capillary_force;
        out.retention_on = found.water.retention;
      }
      note_field(found.pull, out);
      if (!on_state.gap.empty()) out.area_on = area(on_state);
      on = std::move(found.water);
      pull = std::move(found.pull);
    }
    if (fields) {
      fields->off = plan_.traction_solves ? undriven.off : undriven.dry;
      fields->on = on_state.pressure.empty() ? fields->off : on_state;
      for (ContactSolution* state : {&fields->off, &fields->on}) make_physical(*state);
      fields->wetting_off = plan_.traction_solves ? undriven.water_off : undriven.water;
      fields->wetting_on = std::move(on);
      fields->pull = std::move(pull.traction);
    }
    start.on = std::move(on_state);
    return out;
  }

 private:
  // Contact under the preload and an attractive traction [Pa]. Its pressures are those of the
  // kernel's moduli, `softness_` times the physical ones.
  ContactSolution contact(std::vector<double> traction, const ContactSolution* start,
                          double tolerance, PatchResult& out) const {
    const Timed timed(out.costs.seconds.contact);
    for (double& t : traction) t *= softness_;
    ContactOptions options;
    options.tolerance = tolerance;
    options.hardness = problem_.scene->finger.skin.hardness * softness_;
    ContactSolution solution = solve_contact(
        *problem_.kernel, problem_.height, problem_.pressure * softness_, traction, options, start);
    ++out.costs.contact_solves;
    out.costs.fft_pairs += solution.fft_pairs;
    if (tolerance <= fidelity_.contact_tolerance) note_contact(solution, out);
    return solution;
  }

  void make_physical(ContactSolution& state) const {
    for (double& p : state.pressure) p /= softness_;
    state.elastic_energy /= softness_;
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

  bool in_equilibrium() const { return problem_.scene->model.coupling == Coupling::Equilibrium; }

  // What the water and the field of a gap attract with.
  struct Attraction {
    Wetting water;
    FieldSolution pull;
    std::vector<double> traction;  // [Pa], of both
  };
  Attraction attraction(const Gap& gap, Wetting wetting, const WaterProperties& water,
                        const FieldProblem* field, PatchResult& out) const {
    Attraction all{std::move(wetting), {}, {}};
    all.water.grid = plan_.grid;
    if (field) {
      all.pull =
          solve_field_timed(problem_, gap, all.water, *field, fidelity_.field_tolerance, out);
      all.traction = all.pull.traction.value;
    }
    if (all.traction.empty()) all.traction.assign(plan_.grid.size(), 0);
    if (all.water.capillary_force != 0) {
      const Traction capillary = capillary_traction(all.water, gap, water);
      for (std::size_t i = 0; i < all.traction.size(); ++i) all.traction[i] += capillary.value[i];
    }
    return all;
  }

  // The field of the drive, and water at the angle that it drives it to.
  struct DriveTerms {
    FieldProblem field;
    WaterProperties water;
  };
  DriveTerms drive_terms() const {
    const Scene& scene = *problem_.scene;
    const double humidity = problem_.relative_humidity;
    return {field_problem(scene, humidity),
            water_properties(scene, driven_contact_angle(scene, humidity))};
  }

  // What a gap attracts with under the drive: the water is that of the dry gap.
  Attraction driven(const UndrivenPatch& dry, const DriveTerms& terms, const Gap& gap,
                    PatchResult& out) const {
    return attraction(
        gap, dry.result.volume > 0 ? rewet_timed(dry.water, gap, terms.water, out) : Wetting(),
        terms.water, &terms.field, out);
  }

  // A patch whose gap is closed by what it attracts with.
  struct Known {
    std::vector<double> applied;  // tractions that closed the gap [Pa]
    Attraction attraction;
  };
  struct Closed {
    ContactSolution state;
    Attraction last;
    double slope = 0;  // of the attraction over that applied, at the end
  };

  static double touching(const ContactSolution& state) {
    return static_cast<double>(count_above(state.pressure, 0));
  }

  // Eq. coupling.2: contact under attractions, gap, water and field until they attract with what
  // presses. Early states are solved loosely. dry: under the load alone.
  template <class At>
  Closed close(Known first, const ContactSolution& dry, const ContactSolution& expected,
               double slope, const At& at, PatchResult& out) const {
    constexpr double kFirst = 1e-2, kLater = 3e-3;  // tolerances of states that are not the last
    constexpr double kShortWay = 0.05;              // of the load: the first state is near the last
    const double wanted = fidelity_.contact_tolerance, before = mean(first.applied);
    const auto pixels = static_cast<double>(plan_.grid.size());
    const double under_load = touching(dry);
    EquilibriumSearch search(problem_.pressure,
                             {std::move(first.applied), first.attraction.traction}, slope,
                             fidelity_.coupling_tolerance);
    const bool near = std::abs(mean(search.applied()) - before) < kShortWay * problem_.pressure;
    double tolerance = near ? wanted : std::max(wanted, kFirst);
    Closed now{expected, std::move(first.attraction), slope};
    for (int pass = 0; pass < fidelity_.coupling_passes; ++pass) {
      now.state = contact(search.applied(), &now.state, tolerance, out);
      if (now.state.gap.empty()) return now;
      if (is_pulled_shut(pixels, under_load, touching(now.state))) {
        out.status.note({Trouble::ClosedPullIn, 0, ""});
        return now;
      }
      now.last = at(Gap{plan_.grid, now.state.gap});
      const auto next = search.found(now.last.traction);
      now.slope = search.slope();
      if (next == EquilibriumSearch::Next::Settled) {
        out.coupling_residual = std::max(out.coupling_residual, search.residual());
        if (tolerance > wanted) now.state = contact(search.last().applied, &now.state, wanted, out);
        return now;
      }
      if (next == EquilibriumSearch::Next::Jumped) {
        out.status.note({Trouble::GrowingPullIn, 0, ""});
        return now;
      }
      tolerance = std::max(wanted, kLater);
    }
    // Droplets that bridge one gap and not the next keep a search from settling closer than what
    // they hold: what is left is in the solver's error.
    constexpr double kHeldByDroplets = 0.02;
    out.coupling_residual = std::max(out.coupling_residual, search.residual());
    if (search.residual() > kHeldByDroplets)
      out.status.note({Trouble::PassesUsedUp, static_cast<double>(fidelity_.coupling_passes), ""});
    if (tolerance > wanted) now.state = contact(search.applied(), &now.state, wanted, out);
    return now;
  }

  // Eq. coupling.5: one pass cannot see pull-in, but a next pass that would double the pull tells
  // that its answer is none. The field is solved again only where plain columns have grown by half.
  void note_pull_in(const Gap& gap, const ContactSolution& state, const Wetting& wetting,
                    const FieldProblem& field, const FieldSolution& pull, PatchResult& out) const {
    constexpr double kSuspicious = 1.5, kTwice = 2;
    const double h0 = field.dielectric + std::abs(field.skin_layer);
    double before = 0, after = 0;
    for (std::size_t i = 0; i < gap.value.size(); ++i) {
      if (!wetting.bridged.empty() && wetting.bridged[i]) continue;
      before += 1 / square(gap.value[i] + h0);
      after += 1 / square(state.gap[i] + h0);
    }
    if (!(after > kSuspicious * before) || pull.mean_pressure <= 0) return;
    const FieldSolution next = solve_field_timed(problem_, {plan_.grid, state.gap}, wetting, field,
                                                 fidelity_.field_tolerance, out);
    const double ratio = next.mean_pressure / pull.mean_pressure;
    if (ratio >= kTwice) out.status.note({Trouble::SecondPassPullIn, ratio - 1, ""});
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
    out.on_its_way = 0;
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
    out.oxide_margin =
        dielectric_margin(surface.layers(), surface.dielectric_thickness() * pull.peak_oxide_field,
                          kInfinity, film_divider(surface, problem_.scene->drive));
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

PatchBranch::PatchBranch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity)
    : problem_(problem), plan_(plan), fidelity_(fidelity) {
  plan_.traction_solves = false;
  dry_ = PatchSolver(problem_, plan_, fidelity_).undriven({});
  state_ = dry_.dry;
}

void PatchBranch::close(double attraction) {
  if (state_.gap.empty()) return;
  PatchResult costs;
  state_ = PatchSolver(problem_, plan_, fidelity_).closed(traction_, attraction, state_, costs);
}

double PatchBranch::attraction(const Scene& driven) {
  if (state_.gap.empty()) return 0;
  PatchProblem problem = problem_;
  problem.scene = &driven;
  PatchResult costs;
  traction_ = PatchSolver(problem, plan_, fidelity_).attracted(dry_, state_, costs);
  return sum(traction_) / static_cast<double>(traction_.size());
}

PatchResult settled_patch(const PatchProblem& problem, const Plan& given, const Fidelity& fidelity,
                          const UndrivenPatch& undriven, PatchStates& start) {
  Plan plan = given;
  plan.traction_solves = true;
  // Its attractions count and not its area.
  Fidelity loose = fidelity;
  loose.contact_tolerance = std::max(fidelity.contact_tolerance, kBranchTolerance);
  const PatchSolver solver(problem, plan, loose);
  UndrivenPatch closed = undriven;
  closed.result = undriven.dry_gap;
  closed.result.costs = {};
  solver.close_undriven(closed, start);
  PatchResult out = solver.drive(closed, start, nullptr);
  start.dry = std::move(closed.dry);
  start.off = std::move(closed.off);
  start.slope_off = closed.slope;
  return out;
}

PatchResult drive_patch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity,
                        const UndrivenPatch& undriven, PatchFields* fields) {
  PatchStates start;
  return PatchSolver(problem, plan, fidelity).drive(undriven, start, fields);
}

PatchResult solve_patch(const PatchProblem& problem, const Plan& plan, const Fidelity& fidelity,
                        PatchStates& states, PatchFields* fields, UndrivenPatch* before_drive) {
  const PatchSolver solver(problem, plan, fidelity);
  UndrivenPatch undriven = solver.undriven(states);
  PatchResult out = solver.drive(undriven, states, fields);
  if (before_drive) *before_drive = undriven;
  if (undriven.dry.gap.empty()) {
    states = {};
  } else {
    states.slope_off = undriven.slope;
    states.dry = std::move(undriven.dry);
    states.off = std::move(undriven.off);
  }
  return out;
}

}  // namespace papilla::forward
