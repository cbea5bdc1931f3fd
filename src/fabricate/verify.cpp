#include "fabricate/verify.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/constants.h"
#include "base/error.h"
#include "forward/forward.h"
#include "geometry/io/files.h"
#include "metrics/metrics.h"

namespace papilla {
namespace {

double mean_of(const std::string& metric, const Response& response) {
  const auto value = summarise(Summary::Mean, metric, response);
  if (!value) throw InputError("the file cannot be judged: " + text(response.troubles()));
  return value->value;
}

}  // namespace

Verification verify_export(const Study& study, const std::string& file, double tolerance) {
  const Design& design = study.design;
  const Heightmap h = read_heightmap(file);
  Verification out;
  out.pixels = measure_margins(h);
  for (const Constraint& c : study.constraints) {
    const double width = c.name == "min_hole"   ? out.pixels.min_hole
                         : c.name == "min_wall" ? out.pixels.min_wall
                                                : kInfinity;
    if (width < c.limit - out.pixels.pixel) {
      out.faults.push_back(
          fmt::format("{} of the file is {:.3g} um, below {:.3g} um (pixel {:.2g} um)", c.name,
                      1e6 * width, 1e6 * c.limit, 1e6 * out.pixels.pixel));
    }
  }
  Fidelity fidelity = fidelity_level("draft");
  fidelity.grid = std::max(fidelity.grid, design.accuracy.grid);
  const Scene scene = scene_of(design);
  const Plan plan = make_plan(scene, design.texture, fidelity);
  out.merit = design.drive.driven() ? "mean(modulation)" : "mean(friction)";
  const char* metric = design.drive.driven() ? "modulation" : "friction";
  out.design = mean_of(metric, evaluate(scene, design.texture, fidelity));
  // As much of the map as a patch of the design is; whole, where it is hardly larger.
  const double side = std::min(h.grid.lx, h.grid.ly);
  Measured3d map;
  map.file = file;
  map.patch = side < 1.5 * plan.grid.lx ? side : plan.grid.lx;
  out.file = mean_of(metric, evaluate(scene, Texture{map}, fidelity));
  out.loss = std::abs(out.file - out.design) / std::abs(out.design);
  if (!(out.loss <= tolerance)) {
    out.faults.push_back(
        fmt::format("{} of the file is {:.4g}, of the design {:.4g}: {:.2g} % off, "
                    "more than {:.2g} %",
                    out.merit, out.file, out.design, 100 * out.loss, 100 * tolerance));
  }
  return out;
}

}  // namespace papilla
