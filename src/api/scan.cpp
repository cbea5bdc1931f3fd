#include "papilla/scan.h"

#include <algorithm>
#include <cmath>

#include "api/inside.h"
#include "report/surface.h"

namespace papilla::api {
namespace {

void check_tip(double tip) {
  if (!(tip >= 0 && std::isfinite(tip))) throw wrong("tip", "must not be negative");
}

Scan scan_of(const SurfaceView& view) {
  return {heights_of(view.scan.map), text(view.file, view.scan.changes), surface_json(view)};
}

}  // namespace

Scan read_scan(const std::string& file, const ScanOptions& options) {
  return across([&] {
    check_tip(options.tip);
    return scan_of(
        view_of({own_or_shipped(file), options.width, options.fill, options.as_is}, options.tip));
  });
}

Scan measured(const Heights& heights, double tip) {
  return across([&] {
    check_tip(tip);
    const Heightmap map = heightmap_of(heights);
    ScanChanges changes;
    changes.as_is = true;
    changes.width = map.grid.lx;
    changes.height = map.grid.ly;
    changes.pixels = map.z.size();
    changes.highest = *std::max_element(map.z.begin(), map.z.end());
    changes.rms = areal_parameters(map).sq;
    return scan_of(view_of("heights", {map, changes}, tip));
  });
}

}  // namespace papilla::api
