#include "fabricate/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/constants.h"
#include "base/error.h"
#include "base/folder.h"
#include "base/memory.h"
#include "base/text.h"
#include "fabricate/formats.h"
#include "fabricate/process.h"

namespace papilla::fabricate {
namespace {

// Why a layout or a mask cannot draw the texture; empty: it can.
std::string undrawable(const TextureFacts& known) {
  if (!known.relief.present) return std::get<NoOutline>(facts(Texture{}).outline).reason;
  const auto* none = std::get_if<NoOutline>(&known.outline);
  if (!none) return {};
  return none->reason +
         "; take its heights, exr, tiff, gsf, npy, x3p or stl, or a dose map; `--format gds "
         "--levels 3` draws its contour lines";
}

// Why a format cannot be written; empty: it can.
std::string refusal(const ExportFormat& format, const TextureFacts& known,
                    const ExportOptions& options) {
  const std::string subject = fmt::format("format \"{}\"", format.name);
  // Contour lines at several heights are a map, not a mask: any relief has them.
  const bool lines = format.needs_outline && options.levels > 1 && known.relief.present;
  if (!lines && (format.needs_outline || (format.follows_outline && known.relief.present))) {
    if (const std::string reason = undrawable(known); !reason.empty())
      return subject + ": " + reason;
  }
  if (format.needs_dose_curve && !options.dose_curve)
    return subject + " needs --dose-curve, a CSV of depth_nm,grey";
  if (format.needs_polarity && !options.polarity) {
    return subject +
           " needs a polarity: white-high (bright is high) or white-deep (bright is deep)";
  }
  return {};
}

// One period along x and as much of whole cells along y; sides of 0 where nothing repeats, or not
// all of it: a film of particles beside a lattice. Two periods along x hold two rows of a square
// lattice, one of a hexagonal.
Grid one_period(const Texture& texture, int pixels) {
  const TextureFacts known = facts(texture);
  const double period = known.period();
  if (!(period > 0) || known.free_patch.least > (1 + 1e-6) * period) return {};
  Grid cell = patch_grid(texture, 2 * (pixels + pixels % 2), 2 * period);
  cell.lx = period;
  cell.nx /= 2;
  if (std::abs(cell.ly - 2 * period) < 1e-6 * period) {
    cell.ly = period;
    cell.ny /= 2;
  }
  return cell;
}

// Layouts place whole cells on a grid of 1 nm, where a period that a search found never lies. All
// files of an export are of one texture, so that a map and a layout of it lie on each other.
void snap_period(Texture& texture, std::vector<std::string>& warnings) {
  const double period = facts(texture).period(), nm = 1e9 * period;
  const auto with = [&](double whole) {
    Texture out = texture;
    if (double* own = roles(out).period) *own = 1e-9 * whole;
    return out;
  };
  if (std::abs(nm - std::round(nm)) <= 1e-4) return;
  Texture snapped = with(std::round(nm));
  if (!problems(snapped).empty()) snapped = with(std::ceil(nm));  // walls may be that thin
  for (const auto& [key, message] : problems(snapped))
    throw InputError("on the 1 nm grid of layouts: texture." + key + ": " + message);
  const double after = 1e9 * facts(snapped).period();
  warnings.push_back(fmt::format(
      "the period of {:.8g} nm is not on the 1 nm grid of layouts: all files of this export, maps "
      "and layout, have {:.0f} nm, {:.2g} nm ({:.2g} %) {}",
      nm, after, std::abs(after - nm), 100 * std::abs(after / nm - 1),
      after > nm ? "more" : "less"));
  texture = snapped;
}

// The smallest hole or wall half-way down, where masks and contours have their edges [m]; infinite:
// there is none. The floor of slanted walls may be far narrower, and the land between holes.
double smallest_edge(const Texture& texture) {
  if (const auto* stack = std::get_if<Stack>(&texture.kind)) {
    double smallest = kInfinity;
    for (const Texture& part : stack->parts) smallest = std::min(smallest, smallest_edge(part));
    return smallest;
  }
  const TextureFacts known = facts(texture);
  const FeatureArray* array = array_of(known);
  if (!array || !known.relief.present) return known.margins.smallest();
  const double width = width_at_half_depth(*array, wall_of(texture));
  return std::min(width, array->period - width);
}

// The remedy for pixels that are too large for the smallest hole or wall [m].
std::string more_pixels(const Grid& grid, double pixels_across, double smallest) {
  constexpr double kSame = 1e-9;  // of a number that is whole but for its last digits
  const double pixels = 2 * std::ceil(0.5 * grid.lx * pixels_across / smallest * (1 - kSame));
  constexpr double kMost = 1 << 14;  // 2^28 of a square
  return pixels <= kMost ? fmt::format("--pixels {:.0f} would do", pixels)
                         : fmt::format(
                               "that would take {:.0f} pixels per side: ask for a smaller "
                               "--size (one period to be repeated) or a layout, --format "
                               "gds or oasis",
                               pixels);
}

// Of too few pixels heights have their edges elsewhere, and what follows edges means nothing.
void judge_pixels(const Texture& texture, const Grid& grid, bool follows_edges,
                  std::vector<std::string>& warnings) {
  const double smallest = smallest_edge(texture);
  const double pixel = std::max(grid.dx(), grid.dy());
  if (!std::isfinite(smallest) || !(smallest > 0)) return;
  if (const std::string lost = lost_between_pixels(texture, grid); !lost.empty()) {
    if (follows_edges)
      throw InputError("a mask of these pixels means nothing: " + lost +
                       "; or name other files, --format exr,tiff");
    warnings.push_back(lost);
    return;
  }
  if (pixel <= smallest / 4) return;
  warnings.push_back(fmt::format(
      "a pixel of {} nm is more than a quarter of the smallest hole or wall, {} nm: edges "
      "are not where the design has them; {}",
      significant(1e9 * pixel, 3), significant(1e9 * smallest, 3), more_pixels(grid, 4, smallest)));
}

// A pixel is the mean over its area: a map of sharp ridges or bottoms is shallower than its design,
// at whose half depth masks and contours have their edges all the same.
void judge_depth(const Texture& texture, const Heightmap& h, std::vector<std::string>& warnings) {
  constexpr double kMost = 0.01, kEitherSide = 2;  // the end of two pixels, or within one
  const auto depth = [](const Planes& p) { return p.high - p.low; };
  const double is = depth(planes_of(h)), wanted = depth(edge_planes(texture, h));
  const double miss = wanted > 0 ? 1 - is / wanted : 0;
  if (!(miss > kMost)) return;
  // What is missing of a sharp end is in proportion to the pixel.
  warnings.push_back(fmt::format(
      "the map is {} nm deep, the design {} nm: a pixel of {} nm is the mean over its area and "
      "cuts sharp ends off; {}",
      significant(1e9 * is, 4), significant(1e9 * wanted, 4), significant(1e9 * h.grid.dx(), 3),
      more_pixels(h.grid, kEitherSide, h.grid.dx() * kMost / miss)));
}

// A rectangle of whole periods, its pixels nearly square.
Grid rectangle(const Texture& texture, const Grid& square, double size_y) {
  const TextureFacts known = facts(texture);
  if (known.free_patch.exact && !known.cell) return square;
  Grid out = square;
  const double least = std::max(size_y, known.free_patch.least);
  out.ly = known.cell ? known.cell->y * std::max(1.0, std::round(least / known.cell->y))
                      : known.free_patch.side(size_y);
  constexpr double kMost = 1 << 29;  // more than any export has
  const double half = std::min(kMost, std::round(0.5 * out.nx * out.ly / out.lx));
  out.ny = 2 * std::max(1, static_cast<int>(half));
  return out;
}

// The grid of the heights. Throws InputError above so many pixels and for more than the memory
// holds.
Grid export_grid(const Texture& texture, const Grid& period, const ExportOptions& options,
                 double most_pixels = kMostPixels) {
  Grid grid = patch_grid(texture, options.pixels, options.size > 0 ? options.size : kWindow);
  if (options.size > 0 && period.lx > 0 && options.size < 1.5 * period.lx) grid = period;
  if (options.size_y > 0) grid = rectangle(texture, grid, options.size_y);
  if (static_cast<double>(grid.nx) * grid.ny > most_pixels) {
    throw InputError(
        most_pixels == kMostPixels
            ? fmt::format("{} x {} pixels are more than 2^28; ask for fewer", grid.nx, grid.ny)
            : fmt::format("{} x {} pixels are more than the {:.3g} that files of this size can "
                          "hold; export the design again",
                          grid.nx, grid.ny, most_pixels));
  }
  // The heights, the encoded file, and both again when the file is read back.
  require_memory(32.0 * static_cast<double>(grid.size()),
                 fmt::format("a heightmap of {} x {} pixels", grid.nx, grid.ny));
  return grid;
}

// Another side than asked for.
void judge_size(Export& out, const ExportOptions& options) {
  const Grid& grid = out.heightmap.grid;
  const double size_y = options.size_y > 0 ? options.size_y : options.size;
  const auto off = [](double made, double asked) { return std::abs(made - asked) > 1e-6 * asked; };
  if (!(options.size > 0)) return;
  const TextureFacts known = facts(out.texture);
  // The height of a square is only that of its lattice.
  if (!off(grid.lx, options.size) && (options.size_y == 0 || !off(grid.ly, size_y))) return;
  const auto side = [&](double x, double y) {
    // As many digits as part sides that count as others.
    return options.size_y > 0 ? fmt::format("{:.8g} x {:.8g} um", 1e6 * x, 1e6 * y)
                              : fmt::format("{:.8g} um", 1e6 * x);
  };
  out.warnings.push_back(fmt::format(
      "{} were asked for, {} are written: {}", side(options.size, size_y), side(grid.lx, grid.ly),
      out.cells_x > 0 && !(known.free_patch.least > std::min(options.size, size_y))
          ? "a whole number of periods"
      : known.free_patch.exact && out.cells_x == 0
          ? "a measured surface is its patch, texture.patch (`--repeat` tiles the EXR)"
          : "the smallest patch that holds the texture"));
}

// Files that hold the map once beside one that repeats it.
void judge_repeat(const std::vector<ExportFormat>& formats, const ExportOptions& options,
                  std::vector<std::string>& warnings) {
  if (options.repeat == 1) return;
  std::vector<std::string> once;
  for (const ExportFormat& format : formats) {
    if (!format.repeated) once.emplace_back(format.name);
  }
  if (once.empty()) return;
  warnings.push_back(
      fmt::format("--repeat {} is of exr alone: {} {} the map once; --size is of all files",
                  options.repeat, join_names(once), once.size() > 1 ? "hold" : "holds"));
}

}  // namespace

std::string lost_between_pixels(const Texture& texture, const Grid& grid) {
  const double smallest = smallest_edge(texture);
  const double pixel = std::max(grid.dx(), grid.dy());
  if (!std::isfinite(smallest) || !(smallest > 0) || pixel <= 0.5 * smallest) return {};
  return fmt::format("a pixel of {} nm is more than half the smallest hole or wall, {} nm; {}",
                     significant(1e9 * pixel, 3), significant(1e9 * smallest, 3),
                     more_pixels(grid, 4, smallest));
}

const FeatureArray* array_of(const TextureFacts& known) {
  return std::get_if<FeatureArray>(&known.outline);
}

std::vector<Texture> arrays_of(const Texture& texture) {
  const TextureFacts known = facts(texture);
  if (!known.relief.present) return {};
  if (array_of(known)) return {texture};
  const auto* stack = std::get_if<Stack>(&texture.kind);
  if (!stack || stack->combine != Combine::Sum) return {};
  std::vector<Texture> out;
  for (const Texture& part : stack->parts) {
    const std::vector<Texture> own = arrays_of(part);
    if (own.empty() && facts(part).relief.present) return {};
    out.insert(out.end(), own.begin(), own.end());
  }
  // What a part leaves standing would be cut away by the others: only holes add up as masks.
  const bool all_deep = std::all_of(out.begin(), out.end(),
                                    [](const Texture& t) { return array_of(facts(t))->deep; });
  return out.size() == 1 || all_deep ? out : std::vector<Texture>{};
}

Planes edge_planes(const Texture& texture, const Heightmap& h) {
  const TextureFacts known = facts(texture);
  const bool reached = known.relief.planes && !std::holds_alternative<Stack>(texture.kind) &&
                       !std::holds_alternative<NoOutline>(known.outline);
  return reached ? *known.relief.planes : planes_of(h);
}

std::optional<double> width_by_area(const Texture& texture, double share) {
  const TextureFacts known = facts(texture);
  const FeatureArray* array = array_of(known);
  if (!array || !known.cell) return std::nullopt;
  const double features = array->deep ? share : 1 - share;
  if (array->shape == FeatureArray::Shape::Line) return features * array->period;
  const double cell = known.cell->x * known.cell->y / (array->lattice == Lattice::Square ? 1 : 2);
  return std::sqrt(4 / kPi * features * cell);
}

Texture compensated(const Texture& texture, const ProcessBias& bias) {
  Texture out = texture;
  const auto rim = [&](double& radius) { radius = std::max(0.0, radius - bias.edge_radius); };
  const auto width = [](double w) {
    if (w <= 0) throw InputError("process bias: nothing is left of the features");
    return w;
  };
  const TextureFacts known = facts(texture);
  if (const FeatureArray* array = array_of(known)) {
    const Roles role = roles(out);
    *role.width = width(*role.width + (array->deep ? 2 : -2) * bias.shrink);
    rim(*role.edge_radius);
  } else if (bias.shrink != 0 || bias.edge_radius != 0) {
    throw InputError(fmt::format("process bias is for holes, pillars and grooves, not \"{}\"",
                                 texture_name(texture)));
  }
  for (const auto& [key, message] : problems(out))
    throw InputError("process bias: texture." + key + ": " + message);
  return out;
}

std::vector<ExportFormat> chosen_formats(const Texture& texture, const ExportOptions& options) {
  const TextureFacts known = facts(texture);
  std::vector<ExportFormat> out;
  if (options.formats.empty()) {
    for (const ExportFormat& format : export_format_table()) {
      if (format.asked_only || !refusal(format, known, options).empty()) continue;
      if (format.needs_outline && !array_of(known)) continue;  // contours are on request
      out.push_back(format);
    }
    return out;
  }
  for (const std::string& name : options.formats) {
    if (std::any_of(out.begin(), out.end(), [&](const ExportFormat& f) { return f.name == name; }))
      continue;  // named twice: one file
    out.push_back(find_export_format(name));
    if (const std::string why = refusal(out.back(), known, options); !why.empty())
      throw InputError(why);
  }
  return out;
}

namespace {

bool any_of(const std::vector<ExportFormat>& formats, bool (*holds)(const ExportFormat&)) {
  return std::any_of(formats.begin(), formats.end(), holds);
}

// What follows edges, by name; "": none of it is written.
struct EdgeFiles {
  std::string masks, layouts;  // "mask"; "gds, oasis"
};

EdgeFiles edge_files(const std::vector<ExportFormat>& formats) {
  std::vector<std::string> masks, layouts;
  for (const ExportFormat& format : formats) {
    if (format.follows_outline) masks.emplace_back(format.name);
    if (format.needs_outline) layouts.emplace_back(format.name);
  }
  return {join_names(masks), join_names(layouts)};
}

// A stack without one of its parts that have edges.
struct Lacking {
  std::string name;  // of the part: "2", of a stack in a stack "1.2"
  std::string kind;  // "hole_array, 100 nm"
  Texture rest;
};

std::vector<Lacking> without_each(const Stack& whole, const std::string& above) {
  std::vector<Lacking> out;
  for (std::size_t i = 0; i < whole.parts.size(); ++i) {
    const Texture& part = whole.parts[i];
    const std::string name = above + std::to_string(i + 1);
    Stack rest = whole;
    if (const auto* inner = std::get_if<Stack>(&part.kind)) {
      for (Lacking& lacking : without_each(*inner, name + ".")) {
        rest.parts[i] = std::move(lacking.rest);
        out.push_back({lacking.name, lacking.kind, Texture{rest}});
      }
      continue;
    }
    const TextureFacts known = facts(part);
    // Roughness without edges is made by no mask.
    if (!known.relief.present || !std::isfinite(known.margins.smallest())) continue;
    const std::optional<double> height = known.relief.height();
    rest.parts.erase(rest.parts.begin() + static_cast<std::ptrdiff_t>(i));
    out.push_back({name,
                   std::string(texture_name(part)) +
                       (height ? fmt::format(", {:.4g} nm", 1e9 * *height) : ""),
                   Texture{rest}});
  }
  return out;
}

// What edges are judged on: one period, four pixels across the smallest hole or wall, or the whole
// of a map that is smaller.
Grid judged_grid(const Texture& texture, const Grid& whole) {
  constexpr double kFewest = 256, kMost = 1024;
  const double across = std::ceil(4 * facts(texture).period() / smallest_edge(texture));
  const int pixels = static_cast<int>(std::clamp(across, kFewest, kMost));
  const Grid period = one_period(texture, pixels);
  const Grid own = period.lx > 0 ? period : patch_grid(texture, pixels);
  return own.size() < whole.size() ? own : whole;
}

// The share of a part's places where the edges at so many levels of the depth follow it. Its places
// are where it makes more than half of what it makes anywhere of the heights.
double drawn_share(const Heightmap& whole, const Heightmap& without, int levels) {
  const auto [low, high] = std::minmax_element(whole.z.begin(), whole.z.end());
  const double top = *high, depth = *high - *low;
  // How many levels a height lies below, as masks and layouts have them. On a level it is below for
  // one of them and rounding decides for the other, so that it is not drawn there.
  constexpr double kOnLevel = 1e-6;
  const auto below = [&](double z) {
    return std::clamp(std::ceil((top - z) / depth * levels + 0.5 - kOnLevel) - 1, 0.0,
                      1.0 * levels);
  };
  double most = 0;
  for (std::size_t i = 0; i < whole.z.size(); ++i)
    most = std::max(most, std::abs(whole.z[i] - without.z[i]));
  std::size_t places = 0, followed = 0;
  for (std::size_t i = 0; i < whole.z.size(); ++i) {
    if (!(std::abs(whole.z[i] - without.z[i]) > 0.5 * most)) continue;
    ++places;
    followed += below(whole.z[i]) != below(without.z[i]);
  }
  return places > 0 ? static_cast<double>(followed) / static_cast<double>(places) : 1;
}

// Slanted walls and round rims take a third of a small hole; of two equal gratings that cross, one
// is drawn on the half of its places that lie on the other.
bool is_drawn(double share) { return share >= 0.6; }

// Parts of a stack that the edges of a mask or layout do not follow.
void judge_parts(const std::vector<ExportFormat>& formats, const ExportOptions& options,
                 Export& out) {
  const auto* stack = std::get_if<Stack>(&out.texture.kind);
  const EdgeFiles files = edge_files(formats);
  if (!stack || (files.masks.empty() && files.layouts.empty())) return;
  const auto [low, high] = std::minmax_element(out.heightmap.z.begin(), out.heightmap.z.end());
  const double depth = *high - *low;
  if (!(depth > 0)) return;
  const std::vector<Lacking> parts = without_each(*stack, "");
  const Grid grid = judged_grid(out.texture, out.heightmap.grid);
  const Heightmap whole = generate(out.texture, grid);
  std::vector<Heightmap> without;
  for (const Lacking& part : parts) without.push_back(generate(part.rest, grid));
  // The fewest levels above so many that draw all parts; none: they are too many.
  const auto enough = [&](int levels) -> std::optional<int> {
    for (int n = levels + 1; n <= kMostLevels; ++n) {
      if (std::all_of(without.begin(), without.end(),
                      [&](const Heightmap& h) { return is_drawn(drawn_share(whole, h, n)); }))
        return n;
    }
    return std::nullopt;
  };
  const auto judge = [&](const std::string& names, int levels) {
    if (names.empty()) return;
    std::vector<double> shares;
    for (const Heightmap& h : without) shares.push_back(drawn_share(whole, h, levels));
    if (std::all_of(shares.begin(), shares.end(), is_drawn)) return;
    std::vector<std::string> ways;
    if (const std::optional<int> n = enough(levels))
      ways.push_back(fmt::format("--levels {} draws it in a layout", *n));
    if (!arrays_of(out.texture).empty())
      ways.emplace_back("`papilla wafer` draws a mask for each part");
    for (std::size_t i = 0; i < parts.size(); ++i) {
      if (is_drawn(shares[i])) continue;
      constexpr double kNone = 0.005;  // no whole per cent
      out.warnings.push_back(fmt::format(
          "part {} of the stack ({}) is {} in {}, whose edges are {} below the highest place{}{}",
          parts[i].name, parts[i].kind,
          shares[i] < kNone ? "not drawn"
                            : fmt::format("drawn on {:.0f} % of its area only", 100 * shares[i]),
          names,
          levels == 1 ? fmt::format("{:.4g} nm, half of the depth,", 0.5e9 * depth)
                      : fmt::format("{:.4g} nm and more", 0.5e9 * depth / levels),
          ways.empty() ? "" : ": ", join_names(ways)));
    }
  };
  if (options.levels == 1) {
    const bool both = !files.masks.empty() && !files.layouts.empty();
    judge(files.masks + (both ? " and " : "") + files.layouts, 1);
  } else {
    judge(files.masks, 1);
    judge(files.layouts, options.levels);
  }
}

// A mask has its edges at half the depth, a layout of an array at the land or the top of a pillar:
// slanted walls and round rims part them.
void judge_edges(const std::vector<ExportFormat>& formats, Export& out) {
  const EdgeFiles files = edge_files(formats);
  const TextureFacts known = facts(out.texture);
  const FeatureArray* array = array_of(known);
  if (!array || !known.relief.present || files.masks.empty() || files.layouts.empty()) return;
  const Heightmap& h = out.heightmap;
  const double width = width_at_half_depth(*array, wall_of(out.texture));
  if (std::abs(width - array->width) <= std::max(h.grid.dx(), h.grid.dy())) return;
  const Planes planes = edge_planes(out.texture, h);
  const double middle = 0.5 * (planes.low + planes.high);
  const auto deep = std::count_if(h.z.begin(), h.z.end(), [&](double z) { return z < middle; });
  const auto drawn =
      width_by_area(out.texture, static_cast<double>(deep) / static_cast<double>(h.z.size()));
  out.warnings.push_back(fmt::format(
      "{} and {} have other widths: {} are {:.4g} um wide at half their depth, where {} is drawn "
      "({:.4g} um by its whole pixels), and {:.4g} um at the {}, where {} is",
      files.masks, files.layouts, array->drawn, 1e6 * width, files.masks,
      1e6 * drawn.value_or(width), 1e6 * array->width, array->deep ? "land" : "top",
      files.layouts));
}

Export prepared(Texture drawn, const ExportOptions& options,
                const std::vector<ExportFormat>& formats, double most_pixels = kMostPixels) {
  Export out;
  out.texture = std::move(drawn);
  const bool array = array_of(facts(out.texture)) != nullptr;
  const bool layout = any_of(formats, [](const ExportFormat& f) { return f.needs_outline; });
  const bool mask = any_of(formats, [](const ExportFormat& f) { return f.follows_outline; });
  const bool pixels = any_of(formats, [](const ExportFormat& f) { return f.has_pixels(); });
  if (layout && array) snap_period(out.texture, out.warnings);
  const Grid period = one_period(out.texture, options.pixels);
  const Grid grid = export_grid(out.texture, period, options, most_pixels);
  const bool contours = layout && !array;
  if (pixels || contours) judge_pixels(out.texture, grid, mask || contours, out.warnings);
  out.heightmap = generate(out.texture, grid);
  if (pixels || contours) judge_depth(out.texture, out.heightmap, out.warnings);
  if (const std::optional<UnitCell> cell = facts(out.texture).cell) {
    out.cells_x = static_cast<int>(std::lround(grid.lx / cell->x));
    out.cells_y = static_cast<int>(std::lround(grid.ly / cell->y));
  }
  judge_size(out, options);
  judge_repeat(formats, options, out.warnings);
  judge_parts(formats, options, out);
  judge_edges(formats, out);
  if (any_of(formats, [](const ExportFormat& f) { return f.repeated; }))
    out.repeat = options.repeat;
  return out;
}

}  // namespace

Export prepare_export(const Design& design, const ExportOptions& options, double most_pixels) {
  Texture drawn = compensated(design.texture, options.bias);
  const std::vector<ExportFormat> formats = chosen_formats(drawn, options);
  return prepared(std::move(drawn), options, formats, most_pixels);
}

bool mask_shows(const Texture& texture, const ExportOptions& options) {
  const TextureFacts known = facts(texture);
  if (known.relief.present && !undrawable(known).empty()) return false;
  return lost_between_pixels(texture,
                             export_grid(texture, one_period(texture, options.pixels), options))
      .empty();
}

FileInfo info_of(const Design& design) {
  return {design.title.empty() ? "papilla heightmap" : design.title, texture_name(design.texture)};
}

Export export_design(const Design& design, const ExportOptions& options, const std::string& folder,
                     const FileProgress& progress) {
  Export out = prepare_export(design, options);
  Folder::made(folder);
  write_files(design, options, folder, progress, out);
  return out;
}

void write_files(const Design& design, const ExportOptions& options, const std::string& folder,
                 const FileProgress& progress, Export& prepared) {
  const FileInfo info = info_of(design);
  for (const ExportFormat& format :
       chosen_formats(compensated(design.texture, options.bias), options)) {
    const std::string path = folder + "/" + format.file;
    const std::function<void(double)> share = [&](double done) {
      if (progress) progress(path, done);
    };
    share(0);
    format.write({prepared.heightmap, prepared.texture, options, info, share}, path, prepared);
    prepared.files.push_back({format.name, path});
  }
}

}  // namespace papilla::fabricate
