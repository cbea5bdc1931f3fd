#include "studio/files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "fabricate/formats.h"
#include "fabricate/verify.h"
#include "geometry/io/files.h"
#include "geometry/measured_map.h"
#include "geometry/texture.h"
#include "report/export.h"
#include "report/json.h"
#include "report/page_data.h"
#include "report/surface.h"
#include "studio/evaluator.h"
#include "studio/safety.h"

namespace papilla::studio {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::size_t kMostListed = 200;
constexpr int kExportPixels = 512;

// Read by code of our own: what a page sends never reaches another program.
constexpr std::array kMapEndings{".npy", ".gsf", ".exr", ".tif", ".tiff",
                                 ".x3p", ".gwy", ".sur", ".sdf"};

// A file of the folder and the channel that was named of it: "scans/a.gwy::Height".
fs::path map_inside(const fs::path& folder, const std::string& name) {
  const MapName map = map_name(name);
  fs::path file = inside(folder, map.file);
  if (!map.channel.empty()) file += "::" + map.channel;
  return file;
}

ScanSource scan_source(const fs::path& file, const std::string& size, bool fill, bool as_is) {
  const double width = size.empty() ? 0 : parse_si(size, "um");
  if (width < 0) throw InputError("size: expected a length above 0");
  return {file.string(), width, fill, as_is};
}

// The limit that a study set on a shape; nothing: none.
std::optional<double> limit_of(const Study& study, ShapeMargin margin) {
  for (const Constraint& c : study.constraints) {
    if (c.on == Limited{ShapeLimit{margin}}) return c.limit;
  }
  return std::nullopt;
}

// The name in a folder that these bytes are kept under: that of a file with the same, else one that
// nothing has.
std::string kept_name(const Folder& folder, const fs::path& wanted, const std::string& bytes) {
  std::string name = wanted.string();
  for (int copy = 2; folder.has(name) && folder.read(name) != bytes; ++copy)
    name = fmt::format("{}-{}{}", wanted.stem().string(), copy, wanted.extension().string());
  return name;
}

// A text without every place of a part.
std::string without(std::string text, const std::string& part) {
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at))
    text.erase(at, part.size());
  return text;
}

}  // namespace

Files::Files(fs::path folder) : folder_(fs::weakly_canonical(folder)), handle_(folder_) {}

Json Files::list() const {
  Json designs = Json::array(), results = Json::array();
  std::size_t seen = 0;
  std::vector<fs::path> names;
  auto it =
      fs::recursive_directory_iterator(folder_, fs::directory_options::skip_permission_denied);
  for (const auto& entry : it) {
    if (++seen > 20 * kMostListed) break;
    const fs::path name = entry.path().lexically_relative(folder_);
    if (entry.path().filename().string().front() == '.' || it.depth() > 3) {
      if (entry.is_directory()) it.disable_recursion_pending();
      continue;
    }
    // What a page cannot name, or the studio would not open.
    if (!is_utf8(name.string()) || entry.is_symlink() || !entry.is_regular_file()) continue;
    names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  for (const fs::path& name : names) {
    if (designs.size() >= kMostListed) break;
    if (name.filename() == "run.json") results.push_back(name.parent_path().generic_string());
    if (name.extension() == ".toml" && name.filename() != "resolved.toml")
      designs.push_back(name.generic_string());
  }
  return {
      {"folder", visible(folder_.filename().string())}, {"designs", designs}, {"results", results}};
}

std::string Files::open(const std::string& name) const {
  const fs::path file = inside(folder_, name);
  if (file.extension() != ".toml")
    throw InputError({Problem{name, 0, 0, "", "expected a design file, .toml"}});
  return file.string();
}

std::string Files::target(const std::string& name, bool overwrite) const {
  const fs::path out = inside(folder_, name);
  if (out.extension() != ".toml")
    throw InputError({Problem{name, 0, 0, "", "expected a name that ends with .toml"}});
  if (!overwrite && fs::exists(out)) {
    throw InputError(
        {Problem{name, 0, 0, "", "is there already: overwrite it, or choose another name"}});
  }
  return out.string();
}

void Files::save(const Draft& draft, const Study& study, const std::string& file) const {
  const fs::path target(file), name = target.lexically_relative(folder_);
  const Folder folder =
      name.has_parent_path() ? handle_.made_below(name.parent_path().string()) : handle_;
  const std::string text = saved_text(draft, target);
  // Beside its place, as its bases are looked for from there.
  const std::string trial = fmt::format(".{}.{}.trial", target.stem().string(), ::getpid());
  Design back;
  try {
    folder.write(trial, text);
    back = read_study(folder.file(trial), {}, DesignUse::Drawn).design;
  } catch (...) {
    folder.remove(trial);
    throw;
  }
  folder.remove(trial);
  if (!changes_between(back, study.design).empty())
    throw InputError({Problem{file, 0, 0, changes_between(back, study.design).front().path,
                              "the file would not read back to this design; save it under a new "
                              "name"}});
  folder.write(name.filename().string(), text);
}

Json Files::export_preview(const Study& study) const {
  const TextureFacts known = facts(study.design.texture);
  const FabricationMargins& margins = known.margins;
  const bool parts = std::holds_alternative<Stack>(study.design.texture.kind);
  const auto row = [&](const char* name, ShapeMargin margin) {
    return Json{{"name", name},
                {"value", json_number(margin_of(margin, margins))},
                {"limit", json_number(limit_of(study, margin))}};
  };
  ExportOptions options;
  options.pixels = kExportPixels;
  options.polarity = Polarity::WhiteDeep;
  Json formats = Json::array();
  for (const ExportFormat& f : chosen_formats(study.design.texture, options))
    formats.push_back({{"name", f.name}, {"file", f.file}, {"holds", f.holds}});
  return {{"margins",
           {row(parts ? "smallest hole of a part" : "smallest hole", ShapeMargin::MinHole),
            row(parts ? "smallest wall of a part" : "smallest wall", ShapeMargin::MinWall)}},
          {"aspect_ratio",
           {{"value", json_number(margins.aspect_ratio)},
            {"limit", json_number(limit_of(study, ShapeMargin::AspectRatio))}}},
          {"formats", formats}};
}

Json Files::export_files(const Study& study, const std::string& name, bool overwrite) const {
  const fs::path target = inside(folder_, name), below = target.lexically_relative(folder_);
  if (*below.begin() == kSearches)
    throw InputError(
        {Problem{name, 0, 0, "", "is a folder of searches; choose another name, as export/mine"}});
  if (!overwrite && fs::exists(target) && !(fs::is_directory(target) && fs::is_empty(target)))
    throw InputError(
        {Problem{name, 0, 0, "", "is there already: overwrite its files, or choose another name"}});
  const fs::path folder = handle_.made_below(below.string()).path();
  ExportOptions options;
  options.pixels = kExportPixels;
  options.polarity = Polarity::WhiteDeep;
  const Export made = export_with_record(study, options, folder.string());
  const ExportRecord record = record_of(study, options, made);
  ExportVerdict verdict;
  verdict.files = verify_files(record, made);
  constexpr double kTolerance = 0.05;
  const std::string unanswered = why_unanswered(study.design);
  if (unanswered.empty()) verdict.felt = verify_export(record, kTolerance);
  Json out = Json::parse(export_json(study, options, made, name, verdict));
  out["sound"] = verdict.sound();
  out["words"] = without(verdict_text(verdict), folder.string() + "/") +
                 (unanswered.empty() ? "" : "how it feels is not simulated: " + unanswered + "\n");
  out["folder"] = name;
  return out;
}

Json Files::keep_scan(const std::string& name, const std::string& bytes) const {
  const fs::path file = inside(folder_, "scans/" + name);
  if (std::find(kMapEndings.begin(), kMapEndings.end(), lower_ending(name)) == kMapEndings.end())
    throw InputError({Problem{name, 0, 0, "",
                              fmt::format("expected a map of heights: {}; others can be read by "
                                          "`papilla surface FILE --out MAP.gsf`",
                                          fmt::join(kMapEndings, " "))}});
  const fs::path below = file.parent_path().lexically_relative(folder_);
  const Folder folder = handle_.made_below(below.string());
  const std::string kept = kept_name(folder, file.filename(), bytes);
  if (!folder.has(kept)) folder.write(kept, bytes);
  return {{"name", (below / kept).generic_string()}, {"bytes", bytes.size()}};
}

Json Files::scan_view(const std::string& name, const std::string& size, bool fill,
                      bool as_is) const {
  const fs::path file = map_inside(folder_, name);
  const SurfaceView view = view_of(scan_source(file, size, fill, as_is), 0);
  Json out = Json::parse(surface_json(view));
  out["words"] = text(file.filename().string(), view.scan.changes);
  out["heights"] = picture_json(view.scan.map.grid, view.scan.map.z);
  out["scan"]["file"] = name;
  out["section"].erase("heights");
  return out;
}

Draft Files::with_scan(const Draft& draft, const std::string& name, const std::string& size,
                       bool fill, bool as_is) const {
  const fs::path file = map_inside(folder_, name);
  Draft out = draft;
  std::erase_if(out.changes, [](const Change& c) { return c.path.starts_with("texture."); });
  const ScanSource source = scan_source(file, size, fill, as_is);
  out.changes.push_back({"texture.type", "measured"});
  out.changes.push_back({"texture.file", "\"" + file.string() + "\""});
  if (source.width > 0)
    out.changes.push_back({"texture.width", format_quantity(source.width, "um")});
  if (fill) out.changes.push_back({"texture.fill", "true"});
  if (as_is) out.changes.push_back({"texture.as_is", "true"});
  // As much of the map as leaves room for the seam that makes it periodic; of a large one a square
  // that takes no longer than another texture.
  constexpr double kLargestPatch = 24e-6;
  const double patch = std::min(largest_patch(read_scan(source).changes), kLargestPatch);
  out.changes.push_back({"texture.patch", format_quantity(patch, "um")});
  return out;
}

}  // namespace papilla::studio
