#include "design/scans.h"

#include "geometry/measured_map.h"

namespace papilla::design {

std::vector<DesignScan> scans_of(const Design& design) {
  std::vector<ScanSource> sources = facts(design.texture).scans;
  if (const Skin& skin = design.finger.skin; !skin.map.empty())
    sources.push_back({skin.map, skin.map_width});
  std::vector<DesignScan> out;
  for (const ScanSource& source : sources) out.push_back({source.file, changes_of_map(source)});
  return out;
}

}  // namespace papilla::design
