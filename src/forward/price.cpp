#include "forward/price.h"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <ctime>

#include "base/constants.h"
#include "base/parallel.h"
#include "forward/field_ratio.h"
#include "forward/patch_set.h"
#include "forward/patch_setup.h"

namespace papilla::forward {
namespace {

constexpr int kSkins = 2;
constexpr double kControlSetups = 1.25;  // on all pixels, and on half of a side

// The control skins over all skins, as plans price them.
double control_share(const Plan& plan) {
  double controls = 0, patches = 0;
  for (const PlanStep& step : plan.steps) {
    if (step.piece == Piece::Errors)
      controls += step.seconds;
    else
      patches += step.seconds;
  }
  return patches > 0 ? controls / patches : 0;
}

}  // namespace

double work_seconds(const std::function<void()>& work) {
  const auto now = [] {
    timespec t{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  };
  const double begin = now();
  work();
  return now() - begin;
}

double measured_seconds(const Scene& scene, const Texture& texture, const Fidelity& fidelity) {
  Fidelity few = fidelity;
  few.threads = 1;
  const int least = std::min(kSkins, fidelity.skins);
  few.skins = least;
  few.control_skins = 0;
  few.field_skins = 0;
  const auto make = [&] { const PatchSetup made(scene, texture, few); };
  const double setup = work_seconds(make), again = work_seconds(make);  // some of it is kept
  const auto solved = [&](int skins) {
    few.skins = skins;
    return work_seconds([&] { solve_patches(scene, texture, few); }) - again;
  };
  // The first skin makes tables and transforms that the others have.
  const double first = solved(1), both = solved(least);

  Fidelity whole = fidelity;  // but for the 3-D field
  whole.field_skins = 0;
  const Plan plan = make_plan(scene, texture, whole);
  // By the load law few skins find their equilibrium, and the others take its law.
  double equilibrium = 0;
  const int settled = std::min(fidelity.equilibrium_skins, fidelity.skins);
  if (least > 1 && settled > 1 && settled < fidelity.skins && !plan.traction_solves) {
    few.equilibrium_skins = 1;
    equilibrium = std::max(0.0, both - solved(least)) / (least - 1);
    few.equilibrium_skins = fidelity.equilibrium_skins;
  }
  const double skin = std::max(0.0, both / least - equilibrium),
               made_once = std::max(0.0, first - skin - equilibrium),
               controls = control_share(plan);
  double out = setup + made_once + (fidelity.skins * skin + settled * equilibrium) * (1 + controls);
  if (controls > 0) out += setup * kControlSetups;
  if (!field_corrected(scene, fidelity)) return out;

  Scene once = scene;
  std::vector<double>& humidities = once.environment.relative_humidity;
  const auto fields = static_cast<double>(humidities.size()) * fidelity.field_skins;
  humidities = {humidities[humidities.size() / 2]};
  few.field_skins = 1;
  const double pixels =
      std::min(1.0, square(static_cast<double>(kMostFieldPixels) / fidelity.grid));
  const double one = work_seconds([&] { field_ratios(once, texture, few); });
  return out + one + (fields - 1) * std::max(0.0, one - again * pixels);
}

double machine_pace(const std::vector<Scene>& scenes, const Texture& texture,
                    const Fidelity& fidelity) {
  constexpr double kLong = 0.6;  // [s] of shorter work a busy machine says one thing, then another
  const int processors = omp_get_num_procs();
  Fidelity one = fidelity;
  one.threads = 1;
  one.control_skins = 0;
  one.field_skins = 0;
  const auto all_at_work = [&] {
    for (const Scene& scene : scenes)
      parallel_for(
          processors, [&](int) { solve_patches(scene, texture, one); }, processors);
  };
  all_at_work();  // tables and transforms, which are made once
  double took = 0;
  int times = 0;
  const auto begin = std::chrono::steady_clock::now();
  do {
    all_at_work();
    took = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    ++times;
  } while (took < kLong);
  return took / (times * static_cast<double>(scenes.size()) *
                 make_plan(scenes.front(), texture, one).seconds());
}

}  // namespace papilla::forward
