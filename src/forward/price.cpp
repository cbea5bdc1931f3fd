#include "forward/price.h"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <optional>

#include "base/constants.h"
#include "base/parallel.h"
#include "forward/errors.h"
#include "forward/field_ratio.h"
#include "forward/load_law.h"
#include "forward/patch_set.h"
#include "forward/patch_setup.h"

namespace papilla::forward {
namespace {

constexpr int kSkins = 2;

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
  few.control_skins = 0;
  few.field_skins = 0;
  const auto make = [&](const Fidelity& of) {
    return work_seconds([&] { const PatchSetup made(scene, texture, of); });
  };
  const double setup = make(few), again = make(few);  // some of it is kept
  double out = setup;

  // First the field: its patches are pulled as it corrects them, which may take most of the pull.
  FieldRatios ratios;
  if (field_solved(scene, fidelity)) {
    const std::vector<double>& humidities = scene.environment.relative_humidity;
    Scene ends = scene;  // fields may differ in cost from the driest to the dampest
    if (humidities.size() > 2)
      ends.environment.relative_humidity = {humidities.front(), humidities.back()};
    Fidelity in_3d = few;
    in_3d.field_skins = 1;
    const double measured = work_seconds([&] { ratios = field_ratios(ends, texture, in_3d); });
    const double pixels =
        std::min(1.0, square(static_cast<double>(kMostFieldPixels) / fidelity.grid));
    const auto fields = static_cast<double>(humidities.size()) * fidelity.field_skins;
    out += measured + (fields / static_cast<double>(ratios.size()) - 1) *
                          std::max(0.0, measured - again * pixels);
    ratios.resize(humidities.size(), ratios.back());
  }

  const auto solved = [&](const Fidelity& of) {
    return work_seconds([&] { solve_patches(scene, texture, of, ratios); });
  };
  const PatchSetup whole(scene, texture, fidelity);
  const Plan& plan = whole.plan();
  // By the load law few skins find their equilibrium, and the others take its law. Of those no more
  // are solved here than there are skins: they would be solved beside them.
  const int settling = sampled_skins(whole, plan);
  const auto of_skins = [&](int skins, int settled) {
    few.skins = skins;
    few.equilibrium_skins = std::min(settled, settling);
    return solved(few) - again;
  };
  // The first skin makes tables and transforms that the others have.
  const int least = std::min(kSkins, fidelity.skins);
  const double first = of_skins(1, 1), both = of_skins(least, least);
  const int settled = std::min(least, settling);
  const double equilibrium = settled > 0 ? std::max(0.0, both - of_skins(least, 0)) / settled : 0.0;
  const double skin = std::max(0.0, (both - settled * equilibrium) / least),
               made_once = std::max(0.0, first - skin - std::min(1, settling) * equilibrium);
  out += made_once + std::max(fidelity.skins, settling) * skin + settling * equilibrium;

  const ControlFidelities controls = control_fidelities(fidelity, plan);
  for (const std::optional<Fidelity>& of : {controls.areas, controls.coarse}) {
    if (!of) continue;
    Fidelity one = *of;
    one.threads = 1;
    one.skins = 1;
    const double made = make(one);
    out += made + controls.skins * std::max(0.0, solved(one) - made);
  }
  return out;
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
