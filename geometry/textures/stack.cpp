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

// Whether what repeats of a part is alike all along y: its cell is as high as what it is combined
// with. Parts of it without a cell, rough or flat, set no height.
bool is_uniform(const Texture& texture, const TextureFacts& known) {
  const auto* stack = std::get_if<Stack>(&texture.kind);
  if (!stack) return known.directional;
  return std::all_of(stack->parts.begin(), stack->parts.end(), [](const Texture& part) {
    const TextureFacts of = facts(part);
    return !of.cell || is_uniform(part, of);
  });
}

// The longest period along either side: all others divide it (problems() says so otherwise). A map
// that repeats and is whole cells of the others along a side makes the cell as long as itself
// there: cut within, it would have a step at the border.
std::optional<UnitCell> cell_of(const Stack& t, const std::vector<TextureFacts>& parts) {
  UnitCell out{0, 0};
  double uniform = 0;  // height where all parts are alike along y
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::optional<UnitCell>& cell = parts[i].cell;
    if (!cell) continue;
    out.x = std::max(out.x, cell->x);
    double& height = is_uniform(t.parts[i], parts[i]) ? uniform : out.y;
    height = std::max(height, cell->y);
  }
  if (out.x == 0) return std::nullopt;
  if (out.y == 0) out.y = uniform;
  for (const TextureFacts& part : parts) {
    const FreePatch& map = part.free_patch;
    if (part.cell || !map.exact || !map.repeats) continue;
    const double side = *map.exact;
    if (divides(out.x, side)) out.x = side;
    if (divides(out.y, side)) out.y = side;
  }
  return out;
}

// The key and the words of a part whose cell is no whole fraction of that of the stack.
std::optional<std::pair<std::string, std::string>> misfit(Texture part, const TextureFacts& known,
                                                          const UnitCell& whole) {
  if (!known.cell) return std::nullopt;
  const UnitCell& own = *known.cell;
  // A stack has neither key: its parts do.
  const Roles role = roles(part);
  if (!divides(own.x, whole.x)) {
    const double times = whole.x / own.x;
    return std::pair{
        role.parts ? "parts" : "period",
        fmt::format("{:.8g} um does not divide the largest period of the stack, {:.6g} "
                    "um; the nearest that do are {:.6g} um and {:.6g} um",
                    1e6 * own.x, 1e6 * whole.x, 1e6 * whole.x / std::ceil(times),
                    1e6 * whole.x / std::floor(times))};
  }
  if (is_uniform(part, known) || divides(own.y, whole.y)) return std::nullopt;
  return std::pair{role.parts     ? "parts"
                   : role.lattice ? "lattice"
                                  : "period",
                   fmt::format("its rows repeat after {:.6g} um along y, which does not divide the "
                               "{:.6g} um of the stack; make all lattices of it square, or all "
                               "hexagonal",
                               1e6 * own.y, 1e6 * whole.y)};
}

FreePatch patch_of(const std::vector<TextureFacts>& parts) {
  FreePatch out{0, std::nullopt, false};
  for (const TextureFacts& part : parts) {
    const FreePatch& patch = part.free_patch;
    out.least = std::max(out.least, patch.least);
    if (!patch.exact) continue;
    // Of two that repeat the longer, which the other divides; else what all of them hold.
    const bool both_repeat = patch.repeats && out.repeats;
    const double exact = out.exact.value_or(*patch.exact);
    out.repeats = patch.repeats && (out.repeats || !out.exact);
    out.exact = both_repeat ? std::max(exact, *patch.exact) : std::min(exact, *patch.exact);
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

// Slopes add up at worst, or the steepest stays; of parts that state theirs.
std::optional<double> steepest_of(Combine combine, const std::vector<TextureFacts>& parts) {
  std::optional<double> slope;
  for (const TextureFacts& part : parts) {
    if (!part.steepest) continue;
    const double of_part = std::tan(*part.steepest), before = slope.value_or(0);
    slope = combine == Combine::Sum ? before + of_part : std::max(before, of_part);
  }
  return slope ? std::optional(std::atan(*slope)) : std::nullopt;
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
  v.list({"parts",
          "textures to combine, of square lattices or of hexagonal ones, their periods whole "
          "fractions of the longest; min_hole, min_wall and aspect_ratio are the worst of the "
          "parts, each for itself: what the features of two parts leave between them is not in "
          "them"},
         t.parts);
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
  const std::vector<TextureFacts> parts = part_facts(t);
  const std::optional<UnitCell> largest = cell_of(t, parts);
  for (std::size_t i = 0; i < t.parts.size(); ++i) {
    for (auto& [key, message] : problems(t.parts[i]))
      out.emplace_back(fmt::format("parts.{}.{}", i, key), message);
    if (!largest) continue;
    if (const auto why = misfit(t.parts[i], parts[i], *largest))
      out.emplace_back(fmt::format("parts.{}.{}", i, why->first), why->second);
  }
  return out;
}

TextureFacts facts(const Stack& t) {
  const std::vector<TextureFacts> parts = part_facts(t);
  const Relief relief = relief_of(t.combine, parts);
  return {.relief = relief,
          .cell = relief.present ? cell_of(t, parts) : std::nullopt,
          .free_patch = patch_of(parts),
          .margins = margins_of(parts),
          .open_share = std::nullopt,  // the parts overlap
          .rim_radius = rim_of(parts),
          .steepest = steepest_of(t.combine, parts),
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
