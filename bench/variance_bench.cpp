// What a second buys: the sampling error of mean modulation, its variation and the difference of
// two designs, by the root of the seconds of one thread; what the surface without texture, on the
// same skins, would take off as a control variate; and what the droplets alone scatter. Prints a
// table: ninja -C build/release variance_bench && build/release/bench/variance_bench designs >
// results/bench/variance.csv
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/memory.h"
#include "design/design.h"
#include "design/paths.h"
#include "forward/forward.h"
#include "metrics/metrics.h"
#include "numerics/statistics.h"

namespace {

using namespace papilla::tests;

constexpr int kSkins = 128, kPixels = 64;
// Depth that stands for none: the patch stays that of the texture, and so do the skins.
constexpr double kNoDepth = 1e-12;
constexpr double kOther = 1.1;  // the design of the difference: all depths times this

struct Case {
  std::string file, finger;
};
const std::vector<Case> kCases{
    {"m3_samples/a3h350.toml", "reference"},     {"m3_samples/dense_deep.toml", "reference"},
    {"m3_samples/a4h600.toml", "rough"},         {"m3_samples/a3h350.toml", "moist"},
    {"m3_samples/dense_shallow.toml", "smooth"}, {"m3_samples/a3h900.toml", "wet"},
};

struct Run {
  Response response;
  double seconds = 0;  // of the patches
};

Run run(const Design& design, const Texture& texture, int placements) {
  Fidelity fidelity = fidelity_level("search");
  fidelity.grid = kPixels;
  fidelity.skins = kSkins;
  fidelity.droplet_seeds = placements;
  fidelity.threads = 1;
  Run out{evaluate(scene_of(design), texture, fidelity), 0};
  const PieceSeconds& p = out.response.piece_seconds;
  out.seconds = std::max(out.response.seconds, p.contact + p.water + p.field);
  return out;
}

std::vector<double> samples(const Run& of, Summary summary) {
  return error_samples(summary, kModulation, of.response).sampling;
}

std::vector<double> less(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return a;
}

double covariance(const std::vector<double>& a, const std::vector<double>& b) {
  const double ma = mean_estimate(a).value, mb = mean_estimate(b).value;
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - ma) * (b[i] - mb);
  return sum / static_cast<double>(a.size() - 1);
}

// seconds: of all patches behind the samples. control: empty where there is none to take.
void row(const Case& at, const char* quantity, const std::vector<double>& x, double seconds,
         const std::vector<double>& control, double control_seconds,
         const std::vector<double>& twice) {
  const Estimate e = mean_estimate(x);
  const double variance = covariance(x, x);
  std::string other = ",,,";
  if (!control.empty()) {
    const double correlation =
        covariance(x, control) / std::sqrt(variance * covariance(control, control));
    const double left = std::sqrt(1 - square(correlation));
    // At equal cost: known from elsewhere, or solved beside.
    other = fmt::format("{:.2f},{:.2f},{:.2f},", correlation, left,
                        left * std::sqrt(1 + control_seconds / seconds));
  }
  // Two placements against one: their difference has half the variance of what droplets scatter.
  const double droplets = 2 * covariance(less(x, twice), less(x, twice)) / variance;
  fmt::print("{},{},{},{:.4f},{:.4f},{:.2f},{:.5f},{}{:.2f}\n", at.file, at.finger, quantity,
             e.value, e.se, 1e3 * seconds / kSkins, e.se * std::sqrt(seconds), other, droplets);
}

}  // namespace

int main(int argc, char** argv) {
  keep_freed_memory();
  const std::string folder = argc > 1 ? argv[1] : "designs";
  fmt::print(
      "design,finger,quantity,value,standard_error,ms_per_skin,error_root_second,"
      "correlation_with_flat,error_left_if_known,error_left_if_solved,share_of_droplets\n");
  for (const Case& at : kCases) {
    Design design = read_design(folder + "/" + at.file);
    design.finger = read_finger(folder + "/fingers/" + at.finger + ".toml");
    const auto of_depth = [&](double depth) {
      return with_settings(design, {{"texture.depth", depth}}).texture;
    };
    const double depth = std::get<HoleArray>(design.texture.kind).depth;
    const Run one = run(design, design.texture, 1), two = run(design, design.texture, 2);
    const Run other = run(design, of_depth(kOther * depth), 1);
    const Run other_two = run(design, of_depth(kOther * depth), 2);
    const Run flat = run(design, of_depth(kNoDepth), 1);
    for (const auto& [summary, name] :
         {std::pair{Summary::Mean, "mean"}, std::pair{Summary::Variation, "variation"}}) {
      row(at, name, samples(one, summary), one.seconds, samples(flat, summary), flat.seconds,
          samples(two, summary));
    }
    row(at, "difference of means", less(samples(other, Summary::Mean), samples(one, Summary::Mean)),
        one.seconds + other.seconds, {}, 0,
        less(samples(other_two, Summary::Mean), samples(two, Summary::Mean)));
  }
}
