#include "design/scans.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "base/error.h"
#include "geometry/measured_map.h"
#include "geometry/texture.h"

namespace papilla::design {
namespace {

struct NamedScan {
  std::string section;  // "texture.parts.1"
  ScanSource source;
  Texture texture;  // that is made of it alone
};

void add_scans(const Texture& texture, const std::string& section, std::vector<NamedScan>& out) {
  Texture copy = texture;
  if (const std::vector<Texture>* parts = roles(copy).parts) {
    for (std::size_t i = 0; i < parts->size(); ++i)
      add_scans((*parts)[i], fmt::format("{}.parts.{}", section, i), out);
    return;
  }
  for (const ScanSource& source : facts(texture).scans) out.push_back({section, source, texture});
}

// The step that a patch has at its border where the map leaves no room for all of its seam, unless
// it is one as between neighbours: the larger one of both directions.
std::optional<BorderSteps> step_of(const NamedScan& scan, const ScanChanges& changes,
                                   const Grid& patch) {
  const auto* map = std::get_if<Measured3d>(&scan.texture.kind);
  const auto has_room = [](double whole, double side, double at) {
    return 0.5 * (whole - side) + at >= (1 - 1e-9) * kSeam * side;
  };
  // What is taken as it is may have a wall at its border, and is not blended.
  if (!map || changes.as_is ||
      (has_room(changes.width, patch.lx, map->at_x) &&
       has_room(changes.height, patch.ly, map->at_y)))
    return std::nullopt;
  try {
    const auto [along_x, along_y] = border_steps(generate(scan.texture, patch));
    const BorderSteps& larger = along_x.over > along_y.over ? along_x : along_y;
    constexpr double kNoticed = 0.01;  // of the rms of the map: below is rounding
    if (!larger.alike() && larger.over > kNoticed * changes.rms) return larger;
  } catch (const InputError&) {  // whoever takes the patch says what is wrong with it
  }
  return std::nullopt;
}

// What is to be done about it.
std::string step_text(const DesignScan& scan) {
  ScanChanges cut = scan.changes;
  cut.repeats = false;
  return fmt::format(
      "; the patch leaves no room for the tenth that is blended: at its border stands a step of "
      "{:.3g} nm (root mean square; between neighbours {:.3g} nm); {}",
      1e9 * scan.step->over, 1e9 * scan.step->beside,
      scan.periods
          ? "take a map that is 1.2 times as wide, or give the other parts a shorter period"
          : fmt::format("take {}.patch = {:.4g} um or less, in the middle of the map", scan.section,
                        1e6 * largest_patch(cut)));
}

}  // namespace

std::string text(const DesignScan& scan) {
  constexpr double kWidestPixel = 0.5e-6, kShortPatch = 6e-6;  // [m]
  const ScanChanges& c = scan.changes;
  std::string out = geometry::text(scan.file, c);
  const UnitCell sides = scan.periods.value_or(UnitCell{scan.taken, scan.taken});
  if (scan.taken > 0 && (sides.x < (1 - 1e-9) * c.width || sides.y < (1 - 1e-9) * c.height)) {
    const std::string part =
        scan.periods ? fmt::format("the simulated patch of {:.4g} x {:.4g} um{} is the texture{}",
                                   1e6 * sides.x, 1e6 * sides.y,
                                   scan.section == "texture" ? "" : ", whole periods of the stack,",
                                   c.as_is ? "" : fmt::format(" ({}.at_x, at_y)", scan.section))
                     : fmt::format("a square of {:.4g} um is the texture ({}.patch, at_x, at_y)",
                                   1e6 * scan.taken, scan.section);
    out +=
        fmt::format("; of its {:.4g} x {:.4g} um {}{}", 1e6 * c.width, 1e6 * c.height, part,
                    c.as_is || scan.step
                        ? ""
                        : ", blended along two borders with what lies beyond, so that it repeats");
  } else if (sides.x > (1 + 1e-9) * c.width || sides.y > (1 + 1e-9) * c.height) {
    out += fmt::format("; repeated, it makes the simulated patch of {:.4g} x {:.4g} um",
                       1e6 * sides.x, 1e6 * sides.y);
  }
  if (scan.step) out += step_text(scan);
  const double shorter = std::min(sides.x, sides.y);
  if (shorter > 0 && shorter < (1 - 1e-9) * kShortPatch) {
    out += fmt::format(
        "; its patch of {:.4g} um is shorter than the waves of skin, and friction comes out too "
        "high: take {:g} um or more, or say as_is = true of a map that repeats by itself",
        1e6 * shorter, 1e6 * kShortPatch);
  }
  const double pixel =
      c.pixels > 0 ? std::sqrt(c.width * c.height / static_cast<double>(c.pixels)) : 0;
  if (scan.taken > 0 && pixel > kWidestPixel) {
    out += fmt::format(
        "; its pixels are {:.3g} um wide: of waves shorter than {:.3g} um, which friction rests "
        "on, nothing is in it; is its width of {:.4g} um right?",
        1e6 * pixel, 2e6 * pixel, 1e6 * c.width);
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
  const TextureFacts known = facts(design.texture);
  double taken = known.free_patch.exact.value_or(0);
  std::optional<UnitCell> periods;
  constexpr int kPixels = 128;  // as a draft has them
  const Grid patch = simulated_patch(design.texture, kPixels);
  if (taken > 0) {
    if (known.cell || std::max(patch.lx, patch.ly) > (1 + 1e-9) * taken)
      periods = UnitCell{patch.lx, patch.ly};
    taken = std::max(patch.lx, patch.ly);
  }
  std::vector<NamedScan> named;
  add_scans(design.texture, "texture", named);
  std::vector<DesignScan> out;
  Mistakes mistakes;
  for (const NamedScan& scan : named) {
    mistakes.of([&] {
      const ScanChanges changes = changes_of_map(scan.source);
      out.push_back(
          {scan.source.file, changes, taken, scan.section, periods, step_of(scan, changes, patch)});
    });
  }
  if (const Skin skin = scene_of(design).finger.skin; !skin.map.empty())
    mistakes.of([&] { out.push_back({skin.map, changes_of_map({skin.map, skin.map_width})}); });
  mistakes.tell();
  return out;
}

}  // namespace papilla::design
