#include "geometry/textures/stack.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "base/error.h"
#include "geometry/texture.h"

namespace papilla::geometry {
namespace {

std::vector<TextureFacts> part_facts(const Stack& t) {
  std::vector<TextureFacts> out;
  for (const Texture& part : t.parts) out.push_back(facts(part));
  return out;
}

// Planes add up, or the higher ones stay; a part without planes leaves none.
Relief relief_of(Combine combine, const std::vector<TextureFacts>& parts) {
  if (parts.empty()) return Relief::between(0, 0);
  bool present = false, known = true;
  Planes planes = parts.front().relief.planes.value_or(Planes{0, 0});
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Relief& relief = parts[i].relief;
    present = present || relief.present;
    known = known && relief.planes;
    if (i == 0 || !known) continue;
    if (combine == Combine::Sum) {
      planes = {planes.low + relief.planes->low, planes.high + relief.planes->high};
    } else {
      planes = {std::max(planes.low, relief.planes->low),
                std::max(planes.high, relief.planes->high)};
    }
  }
  return known ? Relief::between(planes.low, planes.high) : Relief{present, std::nullopt};
}

// The longest period: all others divide it (problems() says so otherwise).
std::optional<UnitCell> cell_of(const std::vector<TextureFacts>& parts) {
  std::optional<UnitCell> out;
  for (const TextureFacts& part : parts) {
    if (part.cell && (!out || part.cell->x > out->x)) out = part.cell;
  }
  return out;
}

FreePatch patch_of(const std::vector<TextureFacts>& parts) {
  FreePatch out{0, std::nullopt, false};
  for (const TextureFacts& part : parts) {
    const FreePatch& patch = part.free_patch;
    out.least = std::max(out.least, patch.least);
    if (!patch.exact) continue;
    out.repeats = patch.repeats && (out.repeats || !out.exact);
    out.exact = out.exact ? std::min(*out.exact, *patch.exact) : *patch.exact;
  }
  return out;
}

FabricationMargins margins_of(const std::vector<TextureFacts>& parts) {
  FabricationMargins worst = FabricationMargins::none();
  for (const TextureFacts& part : parts) {
    worst.min_hole = std::min(worst.min_hole, part.margins.min_hole);
    worst.min_wall = std::min(worst.min_wall, part.margins.min_wall);
    worst.aspect_ratio = std::max(worst.aspect_ratio, part.margins.aspect_ratio);
  }
  return worst;
}

std::optional<double> rim_of(const std::vector<TextureFacts>& parts) {
  std::optional<double> least;
  for (const TextureFacts& part : parts) {
    if (part.rim_radius) least = least ? std::min(*least, *part.rim_radius) : *part.rim_radius;
  }
  return least;
}

std::vector<ScanSource> scans_of(const std::vector<TextureFacts>& parts) {
  std::vector<ScanSource> out;
  for (const TextureFacts& part : parts)
    out.insert(out.end(), part.scans.begin(), part.scans.end());
  return out;
}

// Contours, if one part with relief has an outline; else why the last of them has none.
Outline outline_of(const std::vector<TextureFacts>& parts) {
  Outline out = facts(Flat{}).outline;
  for (const TextureFacts& part : parts) {
    if (!part.relief.present) continue;
    if (!std::holds_alternative<NoOutline>(part.outline)) return Contours{};
    out = part.outline;
  }
  return out;
}

// What is wrong with a part is said by its own keys: texture.patch is texture.parts.1.patch here.
Heightmap part_heights(const Texture& part, std::size_t index, const Grid& grid) {
  const std::string whole = "texture.";
  try {
    return generate(part, grid);
  } catch (const InputError& error) {
    std::vector<Problem> problems = error.problems();
    for (Problem& p : problems) {
      if (p.key.starts_with(whole))
        p.key = fmt::format("texture.parts.{}.{}", index, p.key.substr(whole.size()));
    }
    throw InputError(std::move(problems));
  }
}

}  // namespace

bool Stack::operator==(const Stack& other) const {
  return combine == other.combine && parts == other.parts;
}

void fields(FieldVisitor& v, Stack& t) {
  v.choice({"combine", "how the parts make one surface"}, {"sum", "maximum"}, t.combine);
  v.list({"parts", "textures to combine"}, t.parts);
}

Heightmap heights(const Stack& t, const Grid& grid) {
  const bool sum = t.combine == Combine::Sum;
  Heightmap out{grid, std::vector<double>(grid.size(), sum ? 0 : -kInfinity)};
  for (std::size_t k = 0; k < t.parts.size(); ++k) {
    const Heightmap layer = part_heights(t.parts[k], k, grid);
    for (std::size_t i = 0; i < out.z.size(); ++i)
      out.z[i] = sum ? out.z[i] + layer.z[i] : std::max(out.z[i], layer.z[i]);
  }
  if (t.parts.empty()) std::fill(out.z.begin(), out.z.end(), 0.0);
  return out;
}

TextureProblems problems(const Stack& t) {
  TextureProblems out;
  if (t.parts.empty()) out.emplace_back("parts", "a stack needs at least one part");
  const std::optional<UnitCell> largest = cell_of(part_facts(t));
  for (std::size_t i = 0; i < t.parts.size(); ++i) {
    for (auto& [key, message] : problems(t.parts[i]))
      out.emplace_back(fmt::format("parts.{}.{}", i, key), message);
    const double period = facts(t.parts[i]).period();
    if (period > 0 && std::abs(largest->x / period - std::round(largest->x / period)) > 1e-6) {
      out.emplace_back(fmt::format("parts.{}.period", i),
                       "does not divide the largest period of the stack");
    }
  }
  return out;
}

TextureFacts facts(const Stack& t) {
  const std::vector<TextureFacts> parts = part_facts(t);
  const Relief relief = relief_of(t.combine, parts);
  return {.relief = relief,
          .cell = relief.present ? cell_of(parts) : std::nullopt,
          .free_patch = patch_of(parts),
          .margins = margins_of(parts),
          .open_share = std::nullopt,  // the parts overlap
          .rim_radius = rim_of(parts),
          .outline = outline_of(parts),
          .scans = scans_of(parts),
          .rough = kNoRoughness,
          .directional = std::any_of(parts.begin(), parts.end(),
                                     [](const TextureFacts& part) { return part.directional; }),
          .quick_look = false};
}

Roles roles(Stack& t) {
  Roles out = Roles::none();
  out.parts = &t.parts;
  return out;
}

}  // namespace papilla::geometry
