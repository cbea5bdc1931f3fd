#include "fabricate/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "base/folder.h"
#include "base/memory.h"
#include "base/text.h"
#include "fabricate/formats.h"

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

// One period along x and as much of whole cells along y; sides of 0 where nothing repeats. Two
// periods along x hold two rows of a square lattice, one of a hexagonal.
Grid one_period(const Texture& texture, int pixels) {
  const double period = facts(texture).period();
  if (!(period > 0)) return {};
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

// The remedy for pixels that are too large for the smallest hole or wall [m].
std::string more_pixels(const Grid& grid, double pixels_across, double smallest) {
  const double pixels = 2 * std::ceil(0.5 * grid.lx * pixels_across / smallest);
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
  const double smallest = facts(texture).margins.smallest();
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

// A rectangle of whole periods, its pixels nearly square.
Grid rectangle(const Texture& texture, const Grid& square, double size_y) {
  const TextureFacts known = facts(texture);
  if (known.free_patch.exact && !known.cell) return square;
  Grid out = square;
  out.ly = known.cell ? known.cell->y * std::max(1.0, std::round(size_y / known.cell->y))
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
  // The height of a square is only that of its lattice.
  if (!off(grid.lx, options.size) && (options.size_y == 0 || !off(grid.ly, size_y))) return;
  const auto side = [&](double x, double y) {
    return options.size_y > 0 ? fmt::format("{:.6g} x {:.6g} um", 1e6 * x, 1e6 * y)
                              : fmt::format("{:.6g} um", 1e6 * x);
  };
  out.warnings.push_back(fmt::format(
      "{} were asked for, {} are written: {}", side(options.size, size_y), side(grid.lx, grid.ly),
      out.cells_x > 0 ? "a whole number of periods"
      : facts(out.texture).free_patch.exact
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
  const double smallest = facts(texture).margins.smallest();
  const double pixel = std::max(grid.dx(), grid.dy());
  if (!std::isfinite(smallest) || !(smallest > 0) || pixel <= 0.5 * smallest) return {};
  return fmt::format("a pixel of {} nm is more than half the smallest hole or wall, {} nm; {}",
                     significant(1e9 * pixel, 3), significant(1e9 * smallest, 3),
                     more_pixels(grid, 4, smallest));
}

const FeatureArray* array_of(const TextureFacts& known) {
  return std::get_if<FeatureArray>(&known.outline);
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
  if (const std::optional<UnitCell> cell = facts(out.texture).cell) {
    out.cells_x = static_cast<int>(std::lround(grid.lx / cell->x));
    out.cells_y = static_cast<int>(std::lround(grid.ly / cell->y));
  }
  judge_size(out, options);
  judge_repeat(formats, options, out.warnings);
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
