// Wall angle from 25 to 90 degrees and depth from 0 to 400 nm on common skins, three grids: what a
// step at an angle or at a pixel's height would show. Writes walls.csv and walls.svg:
// ninja -C build/release walls_bench && build/release/bench/walls_bench designs results/accuracy
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/constants.h"
#include "base/files.h"
#include "design/design.h"
#include "forward/forward.h"
#include "metrics/metrics.h"
#include "report/svg.h"

namespace {

using namespace papilla::tests;

constexpr int kSkins = 8;
constexpr std::array<int, 3> kGrids{64, 128, 256};
constexpr std::array<const char*, 3> kColours{"#9aa5b1", "#1b6ca8", "#d1495b"};

struct Sweep {
  const char *name, *axis;
  double HoleArray::*number;
  double unit, low, high, step;  // in `unit`
};
const std::array<Sweep, 2> kSweeps{
    {{"wall angle", "wall angle [deg]", &HoleArray::wall_angle, kPi / 180, 25, 90, 1},
     {"depth", "depth [nm]", &HoleArray::depth, 1e-9, 0, 400, 10}}};

double mean_modulation(const Design& design, const HoleArray& holes, int grid) {
  Fidelity fidelity = fidelity_level("search");
  fidelity.grid = grid;
  fidelity.skins = kSkins;
  fidelity.control_skins = 0;
  const Response r = evaluate(scene_of(design), Texture{holes}, fidelity);
  return summarise(Summary::Mean, kModulation, r).value().value;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string designs = argc > 1 ? argv[1] : "designs", folder = argc > 2 ? argv[2] : ".";
  std::string table = "film,sweep,grid,value,mean_modulation\n";
  std::vector<SvgPlot> plots;
  for (const Sweep& sweep : kSweeps) {
    for (const char* film : {"conformal", "directional"}) {
      const Design design = read_design(designs + "/m3_samples/common.toml",
                                        {fmt::format("surface.process=\"{}\"", film),
                                         "environment.relative_humidity=[\"15 %\", \"75 %\"]"});
      SvgPlot plot;
      plot.title = fmt::format("{} film", film);
      plot.x = sweep.axis;
      plot.y = "mean modulation";
      for (std::size_t g = 0; g < kGrids.size(); ++g) {
        SvgSeries series;
        series.name = fmt::format("{} pixels", kGrids[g]);
        series.colour = kColours[g];
        series.line = true;
        series.radius = 1.5;
        for (double v = sweep.low; v <= sweep.high + 1e-9; v += sweep.step) {
          HoleArray holes{.period = 3e-6, .diameter = 2.6e-6, .depth = 262e-9};
          holes.*sweep.number = v * sweep.unit;
          const double mean = mean_modulation(design, holes, kGrids[g]);
          table += fmt::format("{},{},{},{:.0f},{:.5f}\n", film, sweep.name, kGrids[g], v, mean);
          series.x.push_back(v);
          series.y.push_back(mean);
        }
        plot.series.push_back(std::move(series));
      }
      plots.push_back(std::move(plot));
    }
  }
  write_bytes(folder + "/walls.csv", table);
  write_bytes(folder + "/walls.svg", svg_picture(plots));
}
