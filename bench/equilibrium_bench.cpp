// What an equilibrium costs over one pass, as CSV: pairs of transforms and processor seconds of one
// thread at the level design, for the published samples and random scenes of every kind, then the
// median of the ratios; or near pull-in, where the voltage is a share of that at which the gap
// jumps shut; or the samples at the level of searches, as a search meets them: the median of nine
// runs with all tables there. Run by hand after ninja -C build/release equilibrium_bench:
//   build/release/bench/equilibrium_bench 20
//   build/release/bench/equilibrium_bench pull_in
//   build/release/bench/equilibrium_bench search
#include <fmt/format.h>

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

struct Level {
  const char* name;
  int unmeasured, runs;  // before, and whose median counts
};
constexpr Level kDesign{"design", 0, 1}, kSearch{"search", 1, 9};

Cost cost(const Level& level, Scene scene, const Texture& texture, Coupling coupling) {
  scene.model.coupling = coupling;
  Fidelity fidelity = fidelity_level(level.name);
  fidelity.threads = 1;
  Cost out;
  std::vector<double> seconds;
  for (int i = -level.unmeasured; i < level.runs; ++i) {
    const std::clock_t begin = std::clock();
    out.response = evaluate(scene, texture, fidelity);
    if (i >= 0) seconds.push_back(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  out.seconds = quantile(seconds, 0.5);
  out.pairs = out.response.fft_pairs;
  return out;
}

std::vector<double> of_pairs, of_seconds;

void row(const std::string& name, const Scene& scene, const Texture& texture,
         const Level& level = kDesign) {
  const Cost one = cost(level, scene, texture, Coupling::OnePass),
             settled = cost(level, scene, texture, Coupling::Equilibrium);
  of_pairs.push_back(settled.pairs / one.pairs);
  of_seconds.push_back(settled.seconds / one.seconds);
  std::string status;
  for (const ResponsePoint& p : settled.response.points) {
    if (!p.status.sound())
      status += fmt::format("{}{:.0f} % RH: {}", status.empty() ? "" : "; ",
                            100 * p.relative_humidity, text(p.status));
  }
  fmt::print("{},{:.0f},{:.0f},{:.3f},{:.3f},{:.3f},{:.3f},{}\n", name, one.pairs, settled.pairs,
             of_pairs.back(), one.seconds, settled.seconds, of_seconds.back(),
             status.empty() ? "settled" : status);
  std::fflush(stdout);
}

void samples(const Level& level) {
  for (const char* name : {"flat", "a3h350", "a3h600", "a3h900", "a4h350", "a4h600"}) {
    const Design d = read_design(design_roots().front() + "/m3_samples/" + name + ".toml");
    row(name, scene_of(d), d.texture, level);
  }
}

void random_scenes(int scenes) {
  for (int i = 0; i < scenes; ++i) {
    Texture texture;
    const Scene scene = random_scene(2000 + i, texture);
    row(fmt::format("{} {}", texture_name(texture), 2000 + i), scene, texture);
  }
}

void median() {
  fmt::print("median,,,{:.3f},,,{:.3f},\n", quantile(of_pairs, 0.5), quantile(of_seconds, 0.5));
}

// By the model of the finger and with air that insulates.
void near_pull_in() {
  for (const char* name : {"flat", "a4h600"}) {
    const Design d = read_design(design_roots().front() + "/m3_samples/" + name + ".toml");
    for (const bool insulates : {false, true}) {
      Scene scene = scene_of(d);
      if (insulates) scene.model.air_limit = AirLimit::None;
      scene.environment.relative_humidity = {0.35};
      scene.environment.weights.clear();
      const PullIn fold = pull_in(scene, d.texture, fidelity_level("design"), 0.35);
      const double volts = scene.drive.amplitude * fold.margin.value;
      for (const double share : {0.9, 0.99}) {
        scene.drive.amplitude = share * volts;
        row(fmt::format("{}{} at {:.0f} % of {:.0f} V{}", name,
                        insulates ? " in insulating air" : "", 100 * share, volts,
                        fold.folds > 0 ? "" : " (no pull-in below)"),
            scene, d.texture);
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  const std::string what = argc > 1 ? argv[1] : "20";
  fmt::print(
      "design,pairs one pass,pairs equilibrium,ratio of pairs,seconds one pass,seconds "
      "equilibrium,ratio of seconds,status\n");
  if (what == "search") {
    samples(kSearch);
    median();
  } else if (what == "pull_in") {
    near_pull_in();
  } else {
    samples(kDesign);
    random_scenes(std::stoi(what));
    median();
  }
}
