#include "estimate/belief.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "base/parallel.h"
#include "estimate/parameters.h"
#include "forward/dry_areas.h"
#include "forward/price.h"
#include "metrics/metrics.h"

namespace papilla::estimate {
namespace {

constexpr int kFinestMemberGrid = 64;
constexpr double kMemberTolerance = 3e-3;  // of the contact, at the finest

std::string absent_belief(const Scene& scene) {
  if (scene.finger.belief.empty())
    return !scene.touch.name.empty()
               ? fmt::format("nothing is fitted of \"{}\"", scene.touch.name)
               : fmt::format("finger \"{}\" names no belief (finger.belief)", scene.finger.name);
  if (scene.model != scene.finger.calibrated_for)
    return fmt::format("the belief of finger \"{}\" is of other model options than [model]",
                       scene.finger.name);
  return {};
}

// The scene as it is or at a member; `resolved`: with areas as the number itself has them, where
// the pixels leave octaves out. Eq. accuracy.17
Response run_few(const Scene& scene, const Texture& texture, const Fidelity& few, bool resolved) {
  const Watch quiet({}, Watch::stop_of_piece());  // members are counted, not their skins
  return resolved ? evaluate_resolved(scene, texture, few, kFewDrySkins)
                  : evaluate(scene, texture, few);
}

// Whether the number that members move has resolved areas.
bool resolves(const Fidelity& fidelity) { return fidelity.control_skins > 1; }

}  // namespace

Fidelity belief_fidelity(const Fidelity& fidelity, int skins) {
  Fidelity few = step_fidelity(fidelity);
  few.skins = std::min(fidelity.skins, skins);
  few.equilibrium_skins = std::max(few.equilibrium_skins, few.skins);
  few.grid = std::min(few.grid, kFinestMemberGrid);
  few.contact_tolerance = std::max(few.contact_tolerance, kMemberTolerance);
  return few;
}

std::vector<Scene> belief_scenes(const Belief& belief, const Scene& scene) {
  std::vector<Scene> out;
  for (const BeliefMember& member : belief.members) {
    MemberScene moved = with_member(belief, member, scene.finger, scene.model);
    out.push_back(scene);
    out.back().finger = std::move(moved.finger);
    out.back().model = moved.model;
  }
  return out;
}

void add_belief(Response& response, const Scene& scene, const Texture& texture,
                const Fidelity& fidelity, int skins) {
  BeliefRuns& out = response.belief;
  out = {};
  out.absent = absent_belief(scene);
  if (!out.absent.empty()) return;
  const Belief belief = belief_of(scene.finger);
  Fidelity few = belief_fidelity(fidelity, skins);
  const int threads = few.threads;
  few.threads = 1;  // a member each
  out.file = belief.file;
  out.skins = few.skins;
  out.grid = few.grid;
  std::vector<Scene> scenes = belief_scenes(belief, scene);
  for (const Scene& member : scenes)
    out.over_air_limits |= member.model.air_limit != scene.model.air_limit;
  scenes.push_back(scene);
  std::vector<Response> runs(scenes.size());
  const auto begin = std::chrono::steady_clock::now();
  parallel_for(
      static_cast<int>(scenes.size()),
      [&](int i) {
        const auto k = static_cast<std::size_t>(i);
        runs[k] = run_few(scenes[k], texture, few, resolves(fidelity));
      },
      threads);
  out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (std::size_t k = 0; k < runs.size(); ++k) {
    response.contact_solves += runs[k].contact_solves;
    response.fft_pairs += runs[k].fft_pairs;
    if (out.troubles.empty()) out.troubles = runs[k].troubles();
    if (k + 1 == runs.size())
      out.own = std::move(runs[k]);
    else
      out.members.push_back(
          {belief.members[k].weight, belief.members[k].hypothesis, std::move(runs[k])});
  }
  response.seconds += out.seconds;
  state_belief(response);
}

double measured_belief_seconds(const Scene& scene, const Texture& texture, const Fidelity& fidelity,
                               int skins) {
  if (!absent_belief(scene).empty()) return 0;
  Fidelity few = belief_fidelity(fidelity, skins);
  few.threads = 1;
  const auto seconds = [&](const Scene& at) {
    return work_seconds([&] { run_few(at, texture, few, resolves(fidelity)); });
  };
  // The first makes tables and transforms that the others have.
  const double own = seconds(scene);
  const std::vector<Scene> members = belief_scenes(belief_of(scene.finger), scene);
  const std::size_t timed = std::min<std::size_t>(3, members.size());
  double some = 0;
  for (std::size_t k = 0; k < timed; ++k) some += seconds(members[k * members.size() / timed]);
  return own + some * static_cast<double>(members.size()) / static_cast<double>(timed);
}

void state_belief(Response& response) {
  take_felt_errors(response.belief.own, response.points);
  for (BeliefRun& member : response.belief.members) take_felt_errors(member.run, response.points);
  for (std::size_t i = 0; i < response.points.size(); ++i) {
    for (const PointQuantity& quantity : kPointQuantities) {
      const auto values = belief_values_at(i, QuantityMetric{quantity.value}, response);
      if (values) (response.points[i].*quantity.value).parts.model = values->deviation();
    }
  }
}

std::string unknown_model(const Finger& finger) {
  if (!finger.belief.empty() || !finger.uncertainty.empty()) return {};
  return unknown_parameters(finger);
}

void add_model_errors(Response& response, const Scene& scene, const Texture& texture,
                      const Fidelity& fidelity, int member_skins) {
  if (absent_belief(scene).empty())
    add_belief(response, scene, texture, fidelity, member_skins);
  else if (!scene.finger.uncertainty.empty())
    add_parameter_errors(response, scene, texture, fidelity);
}

ModelCost model_cost(const Scene& scene, const Fidelity& fidelity, int member_skins) {
  const Finger& finger = scene.finger;
  if (absent_belief(scene).empty()) {
    const auto members = static_cast<int>(belief_of(finger).members.size());
    return {members + 1, members, belief_fidelity(fidelity, member_skins)};
  }
  const auto steps = finger.uncertainty.empty() ? 0 : static_cast<int>(finger_steps(finger).size());
  return {2 * steps, 0, step_fidelity(fidelity)};
}

}  // namespace papilla::estimate
