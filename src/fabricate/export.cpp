#include "fabricate/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "geometry/io/layout.h"

namespace papilla {
namespace {

using Json = nlohmann::ordered_json;

// Equal features that a layout repeats; null: none.
const FeatureArray* array_of(const TextureFacts& known) {
  return std::get_if<FeatureArray>(&known.outline);
}

// Why a layout or a mask cannot draw the texture; empty: it can.
std::string undrawable(const TextureFacts& known) {
  if (!known.relief.present) return std::get<NoOutline>(facts(Texture{}).outline).reason;
  const auto* none = std::get_if<NoOutline>(&known.outline);
  if (!none) return {};
  return none->reason + "; take its heights, exr, tiff, gsf, npy, x3p or stl, or a dose map";
}

bool needs_polarity(const std::string& format) { return format == "tiff" || format == "mask"; }

std::vector<std::string> chosen_formats(const Design& design, const ExportOptions& options) {
  const TextureFacts known = facts(design.texture);
  const std::string reason = undrawable(known);
  if (options.formats.empty()) {
    std::vector<std::string> out;
    for (const std::string& format : export_formats()) {
      if (needs_polarity(format) && !options.polarity) continue;
      if (format == "gds" && (!reason.empty() || !array_of(known))) continue;
      if (format == "mask" && known.relief.present && !reason.empty()) continue;
      if (format == "stl" || format == "x3p" || format == "png16" || format == "tiff32")
        continue;  // on request
      if (format == "dose" && options.dose_curve.empty()) continue;
      out.push_back(format);
    }
    return out;
  }
  for (const std::string& format : options.formats) {
    const auto& names = export_formats();
    if (std::find(names.begin(), names.end(), format) == names.end()) {
      throw InputError(fmt::format("unknown format \"{}\"; known: {}", format, join_names(names)));
    }
    const bool drawn = format == "gds" || (format == "mask" && known.relief.present);
    if (drawn && !reason.empty())
      throw InputError(fmt::format("format \"{}\": {}", format, reason));
    if (format == "dose" && options.dose_curve.empty())
      throw InputError("format \"dose\" needs --dose-curve, a CSV of depth_nm,grey");
    if (needs_polarity(format) && !options.polarity) {
      throw InputError(
          fmt::format("format \"{}\" needs a polarity: white-high (bright is high) or white-deep "
                      "(bright is deep)",
                      format));
    }
  }
  return options.formats;
}

// One cell of the lattice; sides of 0 where nothing repeats. Two periods along x hold two rows of a
// square lattice, one of a hexagonal.
Grid unit_cell(const Texture& texture, int pixels) {
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

// GDSII places whole cells on a grid of 1 nm, where a period that a search found never lies. All
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
    throw InputError("on the 1 nm grid of GDSII: texture." + key + ": " + message);
  const double after = 1e9 * facts(snapped).period();
  warnings.push_back(fmt::format(
      "the period of {:.8g} nm is not on the 1 nm grid of GDSII: all files of this export, maps "
      "and layout, have {:.0f} nm, {:.2g} nm ({:.2g} %) {}",
      nm, after, std::abs(after - nm), 100 * std::abs(after / nm - 1),
      after > nm ? "more" : "less"));
  texture = snapped;
}

// Heights and masks of too few pixels move and round every edge.
void judge_pixels(const Texture& texture, const Grid& grid, std::vector<std::string>& warnings) {
  constexpr double kPixelsAcross = 4;
  const double smallest = facts(texture).margins.smallest();
  const double pixel = std::max(grid.dx(), grid.dy());
  if (!std::isfinite(smallest) || !(smallest > 0) || pixel <= smallest / kPixelsAcross) return;
  const double pixels = 2 * std::ceil(0.5 * std::max(grid.lx, grid.ly) * kPixelsAcross / smallest);
  constexpr double kMost = 1 << 14;  // 2^28 of a square
  warnings.push_back(fmt::format(
      "a pixel of {:.3g} nm is more than a quarter of the smallest hole or wall, {:.3g} nm: edges "
      "are not where the design has them; {}",
      1e9 * pixel, 1e9 * smallest,
      pixels <= kMost
          ? fmt::format("--pixels {:.0f} would do", pixels)
          : fmt::format(
                "that would take {:.0f} pixels a side: ask for a smaller --size (one period "
                "to be repeated) or a layout, --format gds",
                pixels)));
}

Json margin(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

const std::vector<std::string>& export_formats() {
  static const std::vector<std::string> names{"exr", "tiff",  "tiff32", "mask", "gsf", "npy",
                                              "png", "png16", "x3p",    "gds",  "stl", "dose"};
  return names;
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

Export export_design(const Design& wanted, const ExportOptions& options,
                     const std::string& folder) {
  Design design = wanted;
  design.texture = compensated(wanted.texture, options.bias);
  const std::vector<std::string> formats = chosen_formats(design, options);
  Json gds_json, dose_json;
  Export out;
  const bool layout = std::find(formats.begin(), formats.end(), "gds") != formats.end();
  if (layout && array_of(facts(design.texture))) snap_period(design.texture, out.warnings);
  const TextureFacts known = facts(design.texture);
  const FeatureArray* array = array_of(known);
  const Grid cell = unit_cell(design.texture, options.pixels);
  Grid grid = patch_grid(design.texture, options.pixels, options.size > 0 ? options.size : kWindow);
  if (options.size > 0 && cell.lx > 0 && options.size < 1.5 * cell.lx) grid = cell;
  constexpr double kLargest = 1 << 28;
  if (static_cast<double>(grid.nx) * grid.ny > kLargest) {
    throw InputError(
        fmt::format("{} x {} pixels are more than 2^28; ask for fewer", grid.nx, grid.ny));
  }
  // The heights, the encoded file, and both again when the file is read back.
  require_memory(32.0 * static_cast<double>(grid.size()),
                 fmt::format("a heightmap of {} x {} pixels", grid.nx, grid.ny));
  out.heightmap = generate(design.texture, grid);
  if (cell.lx > 0) {
    out.cells_x = static_cast<int>(std::lround(grid.lx / cell.lx));
    out.cells_y = static_cast<int>(std::lround(grid.ly / cell.ly));
  }
  if (options.size > 0 && std::abs(grid.lx - options.size) > 1e-6 * options.size) {
    out.warnings.push_back(fmt::format(
        "{:.6g} um were asked for, {:.6g} um are written: {}", 1e6 * options.size, 1e6 * grid.lx,
        out.cells_x > 0 ? "a whole number of periods"
        : known.free_patch.exact
            ? "a measured surface is its patch, texture.patch (`--repeat` tiles the EXR)"
            : "the smallest patch that holds the texture"));
  }
  if (std::any_of(formats.begin(), formats.end(), [](const auto& f) { return f != "gds"; }) ||
      (layout && !array))
    judge_pixels(design.texture, grid, out.warnings);
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw InputError(fmt::format("cannot make the folder {}: {}", folder, error.message()));

  const FileInfo info{design.title.empty() ? "papilla heightmap" : design.title,
                      texture_name(design.texture)};
  const Heightmap& h = out.heightmap;
  for (const std::string& format : formats) {
    std::string path = folder + "/heightmap." + format;
    if (format == "exr") {
      if (options.repeat > 1) {
        write_exr_repeated(path, h, options.repeat, info);
      } else {
        write_exr(path, h, info);
      }
    } else if (format == "tiff32") {
      path = folder + "/heightmap_float.tif";
      write_tiff_float(path, h, info);
    } else if (format == "png16") {
      path = folder + "/heightmap.png";
      write_png16(path, h);
    } else if (format == "x3p") {
      write_x3p(path, h);
    } else if (format == "dose") {
      path = folder + "/dose.png";
      const DoseMap dose = write_dose(path, h, read_dose_curve(options.dose_curve));
      dose_json = {{"lowest_grey", dose.lowest},
                   {"highest_grey", dose.highest},
                   {"clipped_shallow", dose.shallow},
                   {"clipped_deep", dose.deep}};
      const auto share = [&](std::size_t pixels) {
        return 100 * static_cast<double>(pixels) / static_cast<double>(grid.size());
      };
      if (dose.deep > 0 || dose.shallow > 0) {
        out.warnings.push_back(fmt::format(
            "the dose curve does not reach all depths: {:.3g} % of the pixels are deeper than its "
            "end, {:.3g} % shallower than its start; they get the dose of that end",
            share(dose.deep), share(dose.shallow)));
      }
    } else if (format == "tiff") {
      path = folder + "/heightmap.tif";
      write_tiff16(path, h, *options.polarity, info);
    } else if (format == "mask") {
      path = folder + "/mask.tif";
      write_mask_tiff(path, h, *options.polarity, info);
    } else if (format == "gsf") {
      write_gsf(path, h, info);
    } else if (format == "npy") {
      write_npy(path, h);
    } else if (format == "png") {
      path = folder + "/preview.png";
      write_png(path, h);
    } else if (format == "gds") {
      path = folder + "/texture.gds";
      if (array) {
        const GdsArray a = write_gds(path, *array, grid.lx, grid.ly, options.facet_error);
        gds_json = {{"columns", a.columns}, {"rows", a.rows},   {"pitch", {a.pitch_x, a.pitch_y}},
                    {"drift", a.drift},     {"sides", a.sides}, {"drawn", a.drawn}};
      } else {
        gds_json = {{"polygons", write_gds_mask(path, h, options.levels)},
                    {"levels", options.levels},
                    {"drawn", "deep"}};
      }
    } else if (format == "stl") {
      path = folder + "/texture.stl";
      write_stl(path, h);
    }
    out.files.push_back({format, path});
  }

  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  const FabricationMargins& margins = known.margins;
  Json files = Json::array();
  for (const ExportedFile& file : out.files) {
    files.push_back(
        {{"format", file.format}, {"file", std::filesystem::path(file.path).filename().string()}});
  }
  const Json json{
      {"schema", 1},
      {"title", design.title},
      {"texture", texture_name(design.texture)},
      {"pixels", {grid.nx, grid.ny}},
      {"size", {grid.lx, grid.ly}},
      {"cells", {out.cells_x, out.cells_y}},
      {"lowest", *low},
      {"highest", *high},
      {"polarity", !options.polarity                          ? Json(nullptr)
                   : *options.polarity == Polarity::WhiteHigh ? Json("white-high")
                                                              : Json("white-deep")},
      {"min_hole", margin(margins.min_hole)},
      {"min_wall", margin(margins.min_wall)},
      {"aspect_ratio", margin(margins.aspect_ratio)},
      {"process_shrink", options.bias.shrink},
      {"exr_repeat", options.repeat},
      {"gds", gds_json},
      {"dose", dose_json},
      {"files", files},
      {"warnings", out.warnings},
  };
  write_bytes(folder + "/export.json", json.dump(2) + "\n");
  return out;
}

}  // namespace papilla
