#include "report/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/folder.h"
#include "base/sole_writer.h"
#include "base/text.h"
#include "fabricate/record.h"
#include "report/json.h"

namespace papilla::report {
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

std::string file_name(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

const char* text_of(FileState state) {
  switch (state) {
    case FileState::Sound:
      return "sound";
    case FileState::Differs:
      return "differs";
    case FileState::Missing:
      return "missing";
    case FileState::Unreadable:
      return "unreadable";
  }
  return "";
}

Json verdict_files(const ExportVerdict& verdict) {
  Json out = Json::array();
  for (const FileVerdict& file : verdict.files) {
    out.push_back(
        {{"file", file_name(file.path)}, {"state", text_of(file.state)}, {"faults", file.faults}});
  }
  return out;
}

std::string felt_line(const Verification& v) {
  const std::string edges =
      std::isfinite(v.pixels.min_hole) || std::isfinite(v.pixels.min_wall)
          ? fmt::format(
                "at half the depth smallest hole {:.3g} um, smallest wall {:.3g} um (pixel {:.2g} "
                "um); ",
                1e6 * v.pixels.min_hole, 1e6 * v.pixels.min_wall, 1e6 * v.pixels.pixel)
          : std::string();
  std::string out =
      edges + (std::isfinite(v.file)
                   ? fmt::format("{} {:.4g}, of {} {:.4g}: {:.2g} % off\n", v.merit, v.file,
                                 v.against, v.design, 100 * v.loss)
                   : fmt::format("{} not known, of {} {:.4g}\n", v.merit, v.against, v.design));
  for (const std::string& note : v.notes) out += note + '\n';
  return out;
}

Json verification_json(const Verification& v) {
  Json out{{"min_hole", json_number(v.pixels.min_hole)},
           {"min_wall", json_number(v.pixels.min_wall)},
           {"pixel", v.pixels.pixel},
           {"merit", v.merit},
           {"against", v.against},
           {"design", json_number(v.design)},
           {"file", json_number(v.file)},
           {"loss", json_number(v.loss)},
           {"faults", v.faults}};
  if (!v.notes.empty()) out["notes"] = v.notes;
  return out;
}

Json record(const Study& study, const ExportOptions& options, const Export& result) {
  const Design& design = study.design;
  const Heightmap& h = result.heightmap;
  const auto [low, high] = std::minmax_element(h.z.begin(), h.z.end());
  const FabricationMargins margins = facts(result.texture).margins;
  Json files = Json::array();
  for (const ExportedFile& file : result.files)
    files.push_back({{"format", file.format}, {"file", file_name(file.path)}});
  Json out{{"schema", 1},
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
           {"layout", layout_json(result)},
           {"dose", dose_json(result.dose)},
           {"files", files},
           {"warnings", result.warnings},
           {"made_from", Json::parse(record_json(record_of(study, options, result)))}};
  // What features of two parts leave between them is in none of the three.
  if (std::holds_alternative<Stack>(result.texture.kind)) out["margins_of"] = "each part alone";
  return out;
}

// The layout of an array is drawn period by period: its files alone have no pixels.
bool has_pixels(const Export& result) {
  return !result.array ||
         !std::all_of(result.files.begin(), result.files.end(), [](const ExportedFile& file) {
           return file.format == "gds" || file.format == "oasis";
         });
}

std::string size_line(const Export& result) {
  const Grid& grid = result.heightmap.grid;
  std::string out = fmt::format("size {:.8g} x {:.8g} um", 1e6 * grid.lx, 1e6 * grid.ly);
  if (has_pixels(result))
    out += fmt::format(", {} x {} pixels of {} x {} nm", grid.nx, grid.ny,
                       significant(1e9 * grid.dx(), 4), significant(1e9 * grid.dy(), 4));
  if (result.cells_x > 0) {
    out += fmt::format(", {} x {} periods of {:.6g} x {:.6g} um", result.cells_x, result.cells_y,
                       1e6 * grid.lx / result.cells_x, 1e6 * grid.ly / result.cells_y);
  }
  if (result.repeat > 1) {
    out += fmt::format("; the EXR {0} x {0} times that: {1:.8g} x {2:.8g} um", result.repeat,
                       1e6 * result.repeat * grid.lx, 1e6 * result.repeat * grid.ly);
  }
  return out + '\n';
}

}  // namespace

Export export_with_record(const Study& study, const ExportOptions& options,
                          const std::string& folder, const FileProgress& progress,
                          const std::vector<ExportedFile>& beside,
                          const std::vector<std::string>& warnings) {
  Export result = prepare_export(study.design, options);  // what is refused leaves no folder
  result.warnings.insert(result.warnings.begin(), warnings.begin(), warnings.end());
  const Folder place = Folder::made(folder);
  const SoleWriter alone(place, "another export is writing");
  write_files(study.design, options, folder, progress, result);
  result.files.insert(result.files.end(), beside.begin(), beside.end());
  Study kept = study;
  // The folder of a run has its design beside the files, which names the maps where they lie.
  if (beside.empty()) kept.design = with_own_maps(study.design, place);
  place.write(kRecordName, record(kept, options, result).dump(2) + "\n");
  return result;
}

bool ExportVerdict::sound() const {
  return std::all_of(files.begin(), files.end(),
                     [](const FileVerdict& f) { return f.state == FileState::Sound; }) &&
         (!felt || felt->faults.empty());
}

bool ExportVerdict::readable() const {
  return std::none_of(files.begin(), files.end(),
                      [](const FileVerdict& f) { return f.state == FileState::Unreadable; });
}

std::string export_text(const Export& result, const std::string& folder,
                        const ExportVerdict& verdict) {
  std::string out;
  for (const ExportedFile& file : result.files) out += file.path + '\n';
  out += folder + "/" + kRecordName + "\n" + size_line(result);
  return verdict.felt ? out + felt_line(*verdict.felt) : out;
}

std::string export_json(const Study& study, const ExportOptions& options, const Export& result,
                        const std::string& folder, const ExportVerdict& verdict) {
  Json out = record(study, options, result);
  out["folder"] = folder;
  out["verdict"] = verdict_files(verdict);
  if (verdict.felt) out["verification"] = verification_json(*verdict.felt);
  return out.dump(2);
}

std::vector<std::string> fault_lines(const ExportVerdict& verdict) {
  std::vector<std::string> out;
  for (const FileVerdict& file : verdict.files) {
    for (const std::string& fault : file.faults) out.push_back(file.path + ": " + fault);
  }
  if (verdict.felt) out.insert(out.end(), verdict.felt->faults.begin(), verdict.felt->faults.end());
  return out;
}

std::string verdict_text(const ExportVerdict& verdict) {
  std::vector<std::vector<std::string>> rows;
  for (const FileVerdict& file : verdict.files) rows.push_back({file.path, text_of(file.state)});
  return aligned_table(rows, 2) + (verdict.felt ? felt_line(*verdict.felt) : "");
}

std::string verdict_json(const std::vector<std::pair<std::string, ExportVerdict>>& folders) {
  Json out{{"schema", 1}, {"sound", true}, {"folders", Json::array()}};
  for (const auto& [folder, verdict] : folders) {
    if (!verdict.sound()) out["sound"] = false;
    out["folders"].push_back(
        {{"folder", folder},
         {"sound", verdict.sound()},
         {"files", verdict_files(verdict)},
         {"verification", verdict.felt ? verification_json(*verdict.felt) : Json(nullptr)}});
  }
  return out.dump(2);
}

}  // namespace papilla::report
