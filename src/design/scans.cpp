#include "design/scans.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "base/error.h"
#include "geometry/measured_map.h"

namespace papilla::design {
namespace {

struct NamedScan {
  std::string section;  // "texture.parts.1"
  ScanSource source;
};

void add_scans(const Texture& texture, const std::string& section, std::vector<NamedScan>& out) {
  Texture copy = texture;
  if (const std::vector<Texture>* parts = roles(copy).parts) {
    for (std::size_t i = 0; i < parts->size(); ++i)
      add_scans((*parts)[i], fmt::format("{}.parts.{}", section, i), out);
    return;
  }
  for (const ScanSource& source : facts(texture).scans) out.push_back({section, source});
}

}  // namespace

std::string text(const DesignScan& scan) {
  const ScanChanges& c = scan.changes;
  std::string out = geometry::text(scan.file, c);
  if (scan.taken > 0 && scan.taken < (1 - 1e-9) * std::max(c.width, c.height)) {
    out += fmt::format(
        "; of its {:.4g} x {:.4g} um a square of {:.4g} um is the texture "
        "({}.patch, at_x, at_y){}",
        1e6 * c.width, 1e6 * c.height, 1e6 * scan.taken, scan.section,
        c.as_is ? "" : ", blended along two borders with what lies beyond, so that it repeats");
  }
  return out;
}

std::vector<std::string> scan_as_texture(const std::string& scan,
                                         const std::vector<std::string>& others) {
  std::vector<std::string> out{
      "texture.type=measured",
      "texture.file=" + std::filesystem::absolute(scan).lexically_normal().string()};
  out.insert(out.end(), others.begin(), others.end());
  return out;
}

std::vector<DesignScan> scans_of(const Design& design) {
  const double taken = facts(design.texture).free_patch.exact.value_or(0);
  std::vector<NamedScan> named;
  add_scans(design.texture, "texture", named);
  std::vector<DesignScan> out;
  Mistakes mistakes;
  for (const NamedScan& scan : named) {
    mistakes.of([&] {
      out.push_back({scan.source.file, changes_of_map(scan.source), taken, scan.section});
    });
  }
  if (const Skin skin = scene_of(design).finger.skin; !skin.map.empty())
    mistakes.of([&] { out.push_back({skin.map, changes_of_map({skin.map, skin.map_width})}); });
  mistakes.tell();
  return out;
}

}  // namespace papilla::design
