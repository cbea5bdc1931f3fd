#include "study/export.h"

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

bool is_array(const Texture& texture) {
  return std::holds_alternative<HoleArray>(texture.kind) ||
         std::holds_alternative<PillarArray>(texture.kind) ||
         std::holds_alternative<Grating>(texture.kind);
}

bool needs_polarity(const std::string& format) { return format == "tiff" || format == "mask"; }

std::vector<std::string> chosen_formats(const Design& design, const ExportOptions& options) {
  if (options.formats.empty()) {
    std::vector<std::string> out;
    for (const std::string& format : export_formats()) {
      if (needs_polarity(format) && !options.polarity) continue;
      if (format == "gds" && !is_array(design.texture)) continue;
      if (format == "stl") continue;  // large; on request
      out.push_back(format);
    }
    return out;
  }
  for (const std::string& format : options.formats) {
    const auto& known = export_formats();
    if (std::find(known.begin(), known.end(), format) == known.end()) {
      throw InputError(fmt::format("unknown format \"{}\"; known: {}", format, join_names(known)));
    }
    if (format == "gds" && !is_array(design.texture)) {
      throw InputError(fmt::format(
          "GDSII holds arrays of holes, pillars or grooves, not \"{}\"; use exr, tiff or stl",
          texture_name(design.texture)));
    }
    if (needs_polarity(format) && !options.polarity) {
      throw InputError(
          fmt::format("format \"{}\" needs a polarity: white-high (bright is high) or white-deep "
                      "(bright is deep)",
                      format));
    }
  }
  return options.formats;
}

Json margin(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

}  // namespace

const std::vector<std::string>& export_formats() {
  static const std::vector<std::string> names{"exr", "tiff", "mask", "gsf",
                                              "npy", "png",  "gds",  "stl"};
  return names;
}

Export export_design(const Design& design, const ExportOptions& options,
                     const std::string& folder) {
  const std::vector<std::string> formats = chosen_formats(design, options);
  const Grid grid = patch_grid(design.texture, options.pixels, options.size);
  constexpr double kLargest = 1 << 28;
  if (static_cast<double>(grid.nx) * grid.ny > kLargest) {
    throw InputError(
        fmt::format("{} x {} pixels are more than 2^28; ask for fewer", grid.nx, grid.ny));
  }
  // The heights, the encoded file, and both again when the file is read back.
  require_memory(32.0 * static_cast<double>(grid.size()),
                 fmt::format("a heightmap of {} x {} pixels", grid.nx, grid.ny));
  Export out;
  out.heightmap = generate(design.texture, grid);
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
      write_exr(path, h, info);
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
      write_gds(path, design.texture, grid.lx, grid.ly);
    } else if (format == "stl") {
      path = folder + "/texture.stl";
      write_stl(path, h);
    }
    out.files.push_back({format, path});
  }

  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  const FabricationMargins margins = fabrication_margins(design.texture);
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
      {"lowest", *low},
      {"highest", *high},
      {"polarity", !options.polarity                          ? Json(nullptr)
                   : *options.polarity == Polarity::WhiteHigh ? Json("white-high")
                                                              : Json("white-deep")},
      {"min_hole", margin(margins.min_hole)},
      {"min_wall", margin(margins.min_wall)},
      {"aspect_ratio", margin(margins.aspect_ratio)},
      {"files", files},
  };
  write_bytes(folder + "/export.json", json.dump(2) + "\n");
  return out;
}

}  // namespace papilla
