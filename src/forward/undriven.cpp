#include "forward/undriven.h"

#include <algorithm>
#include <span>
#include <utility>

#include "base/check.h"
#include "base/parallel.h"
#include "forward/load_law.h"
#include "forward/point.h"
#include "forward/scale_bridge.h"
#include "forward/scene_terms.h"

namespace papilla::forward {
namespace {

// Any voltage: the plan is that of a driven scene.
Scene driven(const Scene& scene) {
  PAPILLA_CHECK(scene.environment.relative_humidity.size() == 1, "one humidity");
  Scene out = scene;
  out.drive.control = DriveControl::Voltage;
  if (!out.drive.driven()) out.drive.amplitude = 1;
  return out;
}

}  // namespace

UndrivenPatches::UndrivenPatches(const Scene& scene, const Texture& texture,
                                 const Fidelity& fidelity)
    : driven_(driven(scene)),
      setup_(std::make_unique<const PatchSetup>(driven_, texture, fidelity)),
      field_(field_ratios(driven_, texture, fidelity)) {
  const Grid& grid = setup_->plan().grid;
  kernel_ = contact_kernel(setup_->scene(), setup_->body(), grid, humidity());
  pressures_ =
      ScaleBridge(setup_->scene(), fidelity, grid, humidity(), setup_->body(), setup_->levels())
          .pressures();
  // By the load law the first skins are its samples, even where fewer are asked for.
  Plan by_load = setup_->plan();
  by_load.traction_solves = false;
  const int skins = std::max(fidelity.skins, sampled_skins(*setup_, by_load));
  height_.resize(static_cast<std::size_t>(skins));
  patches_.resize(height_.size());
  parallel_for(
      skins,
      [&](int k) {
        height_[k] = setup_->height(setup_->skin(k));
        const std::vector<WaterMember> members = setup_->water_members(k);
        for (const double pressure : pressures_) {
          PatchStates start;  // the dry contact is that of the first member
          for (const WaterMember& member : members) {
            const PatchProblem problem =
                setup_->problem(height_[k], *kernel_, humidity(), pressure, member);
            patches_[k].push_back(undriven_patch(problem, setup_->plan(), fidelity, start));
            if (members.size() > 1) start.dry = patches_[k].back().dry;
          }
        }
      },
      fidelity.threads);
}

void UndrivenPatches::correct_at(double amplitude) {
  driven_.drive.amplitude = amplitude;
  field_ = field_ratios(driven_, setup_->described(), setup_->fidelity());
}

double UndrivenPatches::corrected_at() const {
  return field_corrected(driven_, setup_->fidelity()) ? driven_.drive.amplitude : 0;
}

Resampled UndrivenPatches::drive(double amplitude, Estimator estimator) const {
  Scene scene = setup_->scene();
  scene.drive.control = DriveControl::Voltage;
  scene.drive.amplitude = amplitude;
  Fidelity fidelity = setup_->fidelity();
  fidelity.estimator = estimator;
  Plan plan = setup_->plan();
  plan.traction_solves = plan.traction_solves && estimator == Estimator::Area;
  const ScaleBridge bridge(scene, fidelity, plan.grid, humidity(), setup_->body(),
                           setup_->levels());
  const int samples = sampled_skins(*setup_, plan);
  std::vector<std::vector<SolvedPatch>> solved(patches_.size());
  parallel_for(
      std::max(fidelity.skins, samples),
      [&](int k) {
        auto before = patches_[k].begin();
        for (const double pressure : pressures_) {
          PatchStates start;
          solved[k].push_back(over_members(
              setup_->water_members(k), plan, fidelity, k < samples ? &start : nullptr,
              [&](const WaterMember& member) {
                PatchProblem problem =
                    setup_->problem(height_[k], *kernel_, humidity(), pressure, member);
                problem.scene = &scene;
                problem.field_correction = field_.front().correction;
                return problem;
              },
              [&](const PatchProblem& problem) {
                const UndrivenPatch& patch = *before++;
                return DrivenPatch{drive_patch(problem, plan, fidelity, patch), &patch};
              }));
        }
      },
      fidelity.threads);
  solved.resize(static_cast<std::size_t>(std::max(fidelity.skins, samples)));
  const std::vector<PatchResult> results =
      combined(bridge, samples > 0 ? load_laws(bridge, solved) : LoadLaws{},
               std::span(solved).first(static_cast<std::size_t>(fidelity.skins)));
  std::vector<std::vector<PatchResult>> by_own_laws;
  if (samples > 0 && samples <= fidelity.skins) by_own_laws = without_each(bridge, solved);
  SkinPoints points =
      skin_points({scene, plan, fidelity}, humidity(), 1, bridge, results, std::move(by_own_laws));
  add_field_error(field_.front(), load_exponents(fidelity.load_exponent, scene.touch.coefficient),
                  points.all);
  Resampled out;
  out.points.push_back(std::move(points.all));
  for (ResponsePoint& point : points.without) out.without.push_back({std::move(point)});
  return out;
}

}  // namespace papilla::forward
