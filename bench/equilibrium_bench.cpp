// What an equilibrium costs over one pass, as CSV: pairs of transforms and processor seconds of one
// thread at the level design, for the published samples, random scenes of every kind, and near
// pull-in, where the voltage is a share of that at which the gap jumps shut; then the median of the
// ratios. Run by hand:
// ninja -C build equilibrium_bench && build/bench/equilibrium_bench 20 >
// results/bench/equilibrium.csv
#include <fmt/format.h>

#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "base/memory.h"
#include "design/design.h"
#include "estimate/evaluation.h"
#include "forward/forward.h"
#include "forward/pull_in.h"
#include "measure/coverage.h"
#include "numerics/statistics.h"

namespace {

using namespace papilla::tests;

struct Cost {
  double pairs = 0, seconds = 0;
  Response response;
};

Cost cost(Scene scene, const Texture& texture, Coupling coupling) {
  scene.model.coupling = coupling;
  Fidelity fidelity = fidelity_level("design");
  fidelity.threads = 1;
  const std::clock_t begin = std::clock();
  Cost out;
  out.response = evaluate(scene, texture, fidelity);
  out.seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  out.pairs = out.response.fft_pairs;
  return out;
}

std::vector<double> of_pairs, of_seconds;

void row(const std::string& name, const Scene& scene, const Texture& texture) {
  const Cost one = cost(scene, texture, Coupling::OnePass),
             settled = cost(scene, texture, Coupling::Equilibrium);
  of_pairs.push_back(settled.pairs / one.pairs);
  of_seconds.push_back(settled.seconds / one.seconds);
  std::string status;
  for (const ResponsePoint& p : settled.response.points) {
    if (!p.status.sound())
      status += fmt::format("{}{:.0f} % RH: {}", status.empty() ? "" : "; ",
                            100 * p.relative_humidity, text(p.status));
  }
  fmt::print("{},{:.0f},{:.0f},{:.3f},{:.2f},{:.2f},{:.3f},{}\n", name, one.pairs, settled.pairs,
             of_pairs.back(), one.seconds, settled.seconds, of_seconds.back(),
             status.empty() ? "settled" : status);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  const int scenes = argc > 1 ? std::atoi(argv[1]) : 20;
  fmt::print(
      "design,pairs one pass,pairs equilibrium,ratio of pairs,seconds one pass,seconds "
      "equilibrium,ratio of seconds,status\n");
  const std::string folder = design_roots().front() + "/m3_samples/";
  for (const char* name : {"flat", "a3h350", "a3h600", "a3h900", "a4h350", "a4h600"}) {
    const Design d = read_design(folder + name + ".toml");
    row(name, scene_of(d), d.texture);
  }
  for (int i = 0; i < scenes; ++i) {
    Texture texture;
    const Scene scene = random_scene(2000 + i, texture);
    row(fmt::format("{} {}", texture_name(texture), 2000 + i), scene, texture);
  }
  fmt::print("median,,,{:.3f},,,{:.3f},\n", quantile(of_pairs, 0.5), quantile(of_seconds, 0.5));
  for (const char* name : {"flat", "a4h600"}) {
    const Design d = read_design(folder + name + ".toml");
    Scene scene = scene_of(d);
    scene.environment.relative_humidity = {0.35};
    scene.environment.weights.clear();
    const double fold = scene.drive.amplitude *
                        pull_in(scene, d.texture, fidelity_level("design"), 0.35).margin.value;
    for (const double share : {0.9, 0.99}) {
      scene.drive.amplitude = share * fold;
      row(fmt::format("{} at {:.0f} % of {:.0f} V", name, 100 * share, fold), scene, d.texture);
    }
  }
}
