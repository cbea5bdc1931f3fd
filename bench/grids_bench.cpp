// Ten hole arrays from 0.2 to 6 um of period, walls of 70 to 90 degrees, at 256, 512 and 1024
// pixels on the same skins: is what finer pixels change inside the bars that 256 state?
// ninja -C build/release grids_bench && build/release/bench/grids_bench designs >
// results/accuracy/grids.csv
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "base/constants.h"
#include "design/design.h"
#include "forward/forward.h"
#include "metrics/metrics.h"

namespace {

using namespace papilla::tests;

constexpr int kSkins = 6;
constexpr std::array<int, 3> kGrids{256, 512, 1024};

struct Case {
  double period, diameter, depth, wall;  // [um], [um], [nm], [deg]
};
constexpr std::array<Case, 10> kCases{{{0.2, 0.1, 50, 90},
                                       {0.3, 0.2, 60, 80},
                                       {0.5, 0.25, 100, 85},
                                       {0.8, 0.5, 150, 70},
                                       {1.2, 0.6, 250, 90},
                                       {1.5, 1.0, 350, 75},
                                       {2.0, 1.2, 500, 85},
                                       {3.0, 2.4, 300, 88},
                                       {4.5, 2.5, 700, 80},
                                       {6.0, 3.0, 600, 90}}};
constexpr std::array<const char*, 3> kMetrics{"friction", "capillary_force", "modulation"};

}  // namespace

int main(int argc, char** argv) {
  const std::string designs = argc > 1 ? argv[1] : "designs";
  const Design design = read_design(designs + "/m3_samples/common.toml",
                                    {"environment.relative_humidity=[\"35 %\", \"75 %\"]"});
  fmt::print(
      "period_um,diameter_um,depth_nm,wall_deg,pixels_per_feature,quantity,grid,value,"
      "half_width,change,inside\n");
  for (const Case& c : kCases) {
    const HoleArray holes{.period = c.period * 1e-6,
                          .diameter = c.diameter * 1e-6,
                          .depth = c.depth * 1e-9,
                          .wall_angle = c.wall * kPi / 180};
    std::array<double, kMetrics.size()> coarse{}, bar{};
    for (const int grid : kGrids) {
      Fidelity fidelity = fidelity_level("design");
      fidelity.grid = grid;
      fidelity.skins = kSkins;
      if (grid != kGrids[0]) fidelity.control_skins = 0;
      const Response r = evaluate(scene_of(design), Texture{holes}, fidelity);
      for (std::size_t q = 0; q < kMetrics.size(); ++q) {
        const SummaryValue v = summarise(Summary::Mean, *find_metric(kMetrics[q]), r).value();
        if (grid == kGrids[0]) {
          ErrorParts parts = v.parts;  // the skins and humidities are the same
          parts.sampling = 0;
          parts.humidity.reset();
          coarse[q] = v.value;
          bar[q] = 1.96 * parts.total();
        }
        const double change = v.value - coarse[q];
        fmt::print("{:g},{:g},{:g},{:g},{:.1f},{},{},{:.5g},{:.3g},{:.3g},{}\n", c.period,
                   c.diameter, c.depth, c.wall, r.plan.feature_pixels, kMetrics[q], grid, v.value,
                   bar[q], change, std::abs(change) <= bar[q] ? 1 : 0);
      }
      std::fflush(stdout);
    }
  }
}
