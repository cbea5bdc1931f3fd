// The load law (Eq. coupling.14) against the equilibrium of every skin, as CSV. Run by hand after
// ninja -C build/release load_law_bench:
//   build/release/bench/load_law_bench skins
//     what skins and equilibria leave to luck, and cost: gratings of 3 nm, which are flat glass, of
//     periods that give each another patch
//   build/release/bench/load_law_bench exponents FILE [KEY=VALUE ...]
//     loads by the law of a few skins on the others of 24, beside exponents that are not shrunk and
//     forces that grow to twice the load, by 100, 200 and 400 V
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/constants.h"
#include "design/design.h"
#include "forward/coupling.h"
#include "forward/forward.h"
#include "forward/load_law.h"
#include "forward/patch_setup.h"
#include "metrics/metrics.h"
#include "numerics/statistics.h"

namespace {

using namespace papilla::tests;

struct MeanAndDeviation {
  double mean = 0, deviation = 0;
};
MeanAndDeviation spread(const std::vector<double>& values) {
  const Estimate of = mean_estimate(values);
  return {of.value, of.se * std::sqrt(static_cast<double>(values.size()))};
}

void skins_and_equilibria() {
  constexpr int kPeriods = 24;
  fmt::print(
      "3-D fields,skins,equilibria,mean modulation,its deviation,variation,its deviation,"
      "processor s\n");
  for (const int fields : {0, 1}) {
    for (const auto& [skins, equilibria] :
         {std::pair{4, 2}, {4, 4}, {8, 2}, {8, 4}, {8, 8}, {16, 2}, {16, 4}, {32, 2}}) {
      Fidelity f = fidelity_level("search");
      f.grid = 64, f.threads = 1, f.field_skins = fields;
      f.skins = skins, f.equilibrium_skins = equilibria;
      std::vector<double> means, variations;
      const std::clock_t begin = std::clock();
      for (int k = 0; k < kPeriods; ++k) {
        const double share = std::fmod(0.618034 * k, 1.0);
        const Design d = read_design(
            find_design("m3_glass/conformal.toml"),
            {"texture.type=grating", "texture.depth=3 nm", "texture.width=1.2 um",
             "surface.contact_angle=80 deg", fmt::format("texture.period={} um", 3 + 7 * share)});
        const Response r = evaluate(scene_of(d), d.texture, f);
        means.push_back(summarise(Summary::Mean, kModulation, r)->value);
        variations.push_back(summarise(Summary::Variation, kModulation, r)->value);
      }
      const double each = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / kPeriods;
      const MeanAndDeviation mean = spread(means), variation = spread(variations);
      fmt::print("{},{},{},{:.4f},{:.4f},{:.4f},{:.4f},{:.3f}\n", fields, skins, equilibria,
                 mean.mean, mean.deviation, variation.mean, variation.deviation, each);
      std::fflush(stdout);
    }
  }
}

double load_of(const PatchResult& p) { return 1 + (p.capillary_on + p.pull) / p.load; }

// Exponents that take the few samples at their word.
AttractionLaw unshrunk(std::span<const AttractionSample> samples) {
  AttractionLaw law = attraction_law(samples);
  double dry[2] = {}, settled[2] = {}, load = 0;
  for (const AttractionSample& s : samples) {
    load += s.dry.load;
    dry[0] += s.dry.capillary_on, dry[1] += s.dry.pull;
    settled[0] += s.settled.capillary_on, settled[1] += s.settled.pull;
  }
  const double closed = std::log(1 + (settled[0] + settled[1]) / load);
  for (const auto& [exponent, k] : {std::pair{&law.capillary_on, 0}, {&law.pull, 1}}) {
    if (dry[k] * settled[k] > 0) *exponent = std::log(settled[k] / dry[k]) / closed;
  }
  return law;
}

// Forces that go on growing to twice the load that was sampled.
AttractionLaw farther(std::span<const AttractionSample> samples) {
  AttractionLaw law = attraction_law(samples);
  law.sampled_off *= 2, law.sampled_on *= 2;
  return law;
}

void exponents(const std::string& file, const std::vector<std::string>& keys) {
  constexpr std::size_t kSkins = 24;
  fmt::print(
      "V,humidity,skins that close their gap,skins of the law,rms error of a skin's load,"
      "of the mean load,of a skin unshrunk,of the mean unshrunk,of a skin to twice the load,"
      "of the mean to twice the load\n");
  for (const double volts : {100.0, 200.0, 400.0}) {
    const Design d = read_design(file, keys);
    Scene scene = scene_of(d);
    scene.drive.amplitude = volts;
    scene.model.coupling = Coupling::Equilibrium;
    Fidelity f = fidelity_level("search");
    f.grid = 64;
    for (const double humidity : d.environment.relative_humidity) {
      scene.environment.relative_humidity = {humidity};
      const PatchSetup setup(scene, d.texture, f);
      const auto kernel = contact_kernel(setup.scene(), setup.body(), setup.plan().grid, humidity);
      std::vector<AttractionSample> all;
      for (std::size_t k = 0; k < kSkins; ++k) {
        const std::vector<double> height = setup.height(setup.skin(static_cast<int>(k)));
        const PatchProblem problem =
            setup.problem(height, *kernel, humidity, setup.scene().finger.patch_pressure(humidity),
                          {1, static_cast<std::uint64_t>(k)});
        PatchStates states, there;
        UndrivenPatch before;
        const PatchResult dry = solve_patch(problem, setup.plan(), f, states, nullptr, &before);
        all.push_back({dry, settled_patch(problem, setup.plan(), f, before, there)});
      }
      const auto closed = std::count_if(all.begin(), all.end(), [](const AttractionSample& s) {
        return s.settled.status.pull_in();
      });
      for (const std::size_t few : {2, 4}) {
        std::string row;
        for (const auto& law_of : {attraction_law, unshrunk, farther}) {
          double of_skin = 0, of_mean = 0;
          int others = 0, laws = 0;
          for (std::size_t from = 0; from + few <= kSkins; from += few) {
            const auto samples = std::span(all).subspan(from, few);
            const AttractionLaw law = law_of(samples);
            if (!law.status.sound()) continue;
            double by_law = 0, solved = 0;
            for (std::size_t k = 0; k < kSkins; ++k) {
              if (k >= from && k < from + few) continue;
              PatchResult p = all[k].dry;
              law.apply(p);
              of_skin += square(std::log(load_of(p) / load_of(all[k].settled)));
              by_law += load_of(p), solved += load_of(all[k].settled);
              ++others;
            }
            of_mean += square(std::log(by_law / solved)), ++laws;
          }
          row +=
              fmt::format(",{:.4f},{:.4f}", std::sqrt(of_skin / others), std::sqrt(of_mean / laws));
        }
        fmt::print("{:.0f},{},{},{}{}\n", volts, humidity, closed, few, row);
        std::fflush(stdout);
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 2 && std::string(argv[1]) == "exponents") {
    exponents(argv[2], {argv + 3, argv + argc});
    return 0;
  }
  skins_and_equilibria();
}
