#include "report/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/files.h"
#include "report/json.h"

namespace papilla {
namespace {

using Json = nlohmann::ordered_json;

Json polarity_json(const std::optional<Polarity>& polarity) {
  if (!polarity) return nullptr;
  return *polarity == Polarity::WhiteHigh ? "white-high" : "white-deep";
}

Json layout_json(const Export& result) {
  if (const auto& a = result.array) {
    return {{"columns", a->columns}, {"rows", a->rows},   {"pitch", {a->pitch_x, a->pitch_y}},
            {"drift", a->drift},     {"sides", a->sides}, {"drawn", a->drawn}};
  }
  if (const auto& c = result.contours)
    return {{"polygons", c->polygons}, {"levels", c->levels}, {"drawn", "deep"}};
  return nullptr;
}

Json dose_json(const std::optional<DoseMap>& dose) {
  if (!dose) return nullptr;
  return {{"lowest_grey", dose->lowest},
          {"highest_grey", dose->highest},
          {"clipped_shallow", dose->shallow},
          {"clipped_deep", dose->deep}};
}

Json verification_json(const Verification& v) {
  return {{"min_hole", json_number(v.pixels.min_hole)},
          {"min_wall", json_number(v.pixels.min_wall)},
          {"pixel", v.pixels.pixel},
          {"merit", v.merit},
          {"design", json_number(v.design)},
          {"file", json_number(v.file)},
          {"loss", json_number(v.loss)},
          {"faults", v.faults}};
}

Json record(const Design& design, const ExportOptions& options, const Export& result) {
  const Heightmap& h = result.heightmap;
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  const FabricationMargins margins = facts(result.texture).margins;
  Json files = Json::array();
  for (const ExportedFile& file : result.files) {
    files.push_back(
        {{"format", file.format}, {"file", std::filesystem::path(file.path).filename().string()}});
  }
  return {{"schema", 1},
          {"title", design.title},
          {"texture", texture_name(result.texture)},
          {"pixels", {h.grid.nx, h.grid.ny}},
          {"size", {h.grid.lx, h.grid.ly}},
          {"cells", {result.cells_x, result.cells_y}},
          {"lowest", *low},
          {"highest", *high},
          {"polarity", polarity_json(options.polarity)},
          {"min_hole", json_number(margins.min_hole)},
          {"min_wall", json_number(margins.min_wall)},
          {"aspect_ratio", json_number(margins.aspect_ratio)},
          {"process_shrink", options.bias.shrink},
          {"exr_repeat", options.repeat},
          {"gds", layout_json(result)},
          {"dose", dose_json(result.dose)},
          {"files", files},
          {"warnings", result.warnings}};
}

std::string size_line(const Export& result) {
  const Grid& grid = result.heightmap.grid;
  std::string out =
      fmt::format("size {:.6g} x {:.6g} um, {} x {} pixels of {:.4g} x {:.4g} nm", 1e6 * grid.lx,
                  1e6 * grid.ly, grid.nx, grid.ny, 1e9 * grid.dx(), 1e9 * grid.dy());
  if (result.cells_x > 0) {
    out += fmt::format(", {} x {} periods of {:.6g} x {:.6g} um", result.cells_x, result.cells_y,
                       1e6 * grid.lx / result.cells_x, 1e6 * grid.ly / result.cells_y);
  }
  return out + '\n';
}

}  // namespace

Export export_with_record(const Design& design, const ExportOptions& options,
                          const std::string& folder) {
  Export result = export_design(design, options, folder);
  write_bytes(folder + "/export.json", record(design, options, result).dump(2) + "\n");
  return result;
}

std::string export_text(const Export& result, const std::string& folder,
                        const std::optional<Verification>& v) {
  std::string out;
  for (const ExportedFile& file : result.files) out += file.path + '\n';
  out += folder + "/export.json\n" + size_line(result);
  if (!v) return out;
  return out + fmt::format(
                   "smallest hole {:.3g} um, smallest wall {:.3g} um (pixel {:.2g} um); {} {:.4g}, "
                   "of the design {:.4g}: {:.2g} % off\n",
                   1e6 * v->pixels.min_hole, 1e6 * v->pixels.min_wall, 1e6 * v->pixels.pixel,
                   v->merit, v->file, v->design, 100 * v->loss);
}

std::string export_json(const Design& design, const ExportOptions& options, const Export& result,
                        const std::string& folder, const std::optional<Verification>& v) {
  Json out = record(design, options, result);
  out["folder"] = folder;
  if (v) out["verification"] = verification_json(*v);
  return out.dump(2);
}

}  // namespace papilla
