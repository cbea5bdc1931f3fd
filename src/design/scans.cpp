#include "design/scans.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
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

// Of a map that is taken as it is: over the border of its patch, the heights of the map one patch
// further less those where the patch begins anew. A wall may stand at that border, and is none of
// it; 0 along a side that is all of the map. Eq. geometry.4
std::array<BorderSteps, 2> steps_to_next_period(const Measured3d& map, const ScanChanges& changes) {
  constexpr int kPixels = 128, kLast = kPixels - 1;
  const Grid square{kPixels, kPixels, map.patch, map.patch};
  const double pixel = map.patch / kPixels;
  const Heightmap here = generate(Texture{map}, square);
  std::array<BorderSteps, 2> out = border_steps(here);
  const auto over = [&](double whole, double Measured3d::*at, const auto& z) {
    if (whole < map.patch + 2 * pixel) return 0.0;
    // A pixel towards the middle of the map, where there is room.
    const bool up = !(map.*at > 0);
    Measured3d further = map;
    further.*at += up ? pixel : -pixel;
    const Heightmap next = generate(Texture{further}, square);
    double sum = 0;
    for (int i = 0; i < kPixels; ++i) {
      const double off = z(next, up ? kLast : 0, i) - z(here, up ? 0 : kLast, i);
      sum += off * off;
    }
    return std::sqrt(sum / kPixels);
  };
  out[0].over = over(changes.width, &Measured3d::at_x,
                     [](const Heightmap& h, int across, int i) { return h(across, i); });
  out[1].over = over(changes.height, &Measured3d::at_y,
                     [](const Heightmap& h, int across, int i) { return h(i, across); });
  return out;
}

// The step that a patch has at its border, unless it is one as between neighbours: where the map
// leaves no room for all of its seam, or is said to repeat after a patch and does not. The larger
// one of both directions.
std::optional<BorderSteps> step_of(const NamedScan& scan, const ScanChanges& changes,
                                   const Grid& patch) {
  const auto* map = std::get_if<Measured3d>(&scan.texture.kind);
  const auto has_room = [](double whole, double side, double at) {
    return 0.5 * (whole - side) + at >= (1 - 1e-9) * kSeam * side;
  };
  if (!map || (!changes.as_is && has_room(changes.width, patch.lx, map->at_x) &&
               has_room(changes.height, patch.ly, map->at_y)))
    return std::nullopt;
  // Of several whole maps there is no border but its own, where it is said to repeat.
  if (changes.as_is && map->patch > (1 + 1e-9) * std::min(changes.width, changes.height))
    return std::nullopt;
  try {
    const auto [along_x, along_y] = changes.as_is ? steps_to_next_period(*map, changes)
                                                  : border_steps(generate(scan.texture, patch));
    const BorderSteps& larger = along_x.over > along_y.over ? along_x : along_y;
    constexpr double kNoticed = 0.01;  // of the rms of the map: below is rounding
    if (!larger.alike() && larger.over > kNoticed * changes.rms) return larger;
  } catch (const InputError&) {  // whoever takes the patch says what is wrong with it
  }
  return std::nullopt;
}

// What is to be done about it.
std::string step_text(const DesignScan& scan) {
  const std::string stands = fmt::format(
      "at its border stands a step of {:.3g} nm (root mean square; between neighbours "
      "{:.3g} nm)",
      1e9 * scan.step->over, 1e9 * scan.step->beside);
  if (scan.changes.as_is) {
    return fmt::format(
        "; the map does not repeat after that patch: {}; take {}.patch = a period of the map, or "
        "leave out as_is, so that the border is blended",
        stands, scan.section);
  }
  ScanChanges cut = scan.changes;
  cut.repeats = false;
  return fmt::format(
      "; the patch leaves no room for the tenth that is blended: {}; {}", stands,
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
  const bool one_period = scan.periods && scan.period > 0;
  if (one_period ||
      (scan.taken > 0 && (sides.x < (1 - 1e-9) * c.width || sides.y < (1 - 1e-9) * c.height))) {
    const std::string part =
        one_period ? fmt::format(
                         "a square of {:.4g} um is one period ({}.patch), and the simulated patch "
                         "of {:.4g} x {:.4g} um is whole periods",
                         1e6 * scan.period, scan.section, 1e6 * sides.x, 1e6 * sides.y)
        : scan.periods
            ? fmt::format("the simulated patch of {:.4g} x {:.4g} um{} is the texture{}",
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
  } else if ((sides.x > (1 + 1e-9) * c.width || sides.y > (1 + 1e-9) * c.height) &&
             divides(c.width, sides.x) && divides(c.height, sides.y)) {  // else it is refused
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
      const auto* map = std::get_if<Measured3d>(&scan.texture.kind);
      const bool part =
          map && changes.as_is && map->patch < (1 - 1e-9) * std::min(changes.width, changes.height);
      out.push_back({scan.source.file, changes, taken, scan.section, periods,
                     step_of(scan, changes, patch), part ? map->patch : 0});
    });
  }
  if (const Skin skin = scene_of(design).finger.skin; !skin.map.empty())
    mistakes.of([&] { out.push_back({skin.map, changes_of_map({skin.map, skin.map_width})}); });
  mistakes.tell();
  return out;
}

}  // namespace papilla::design
