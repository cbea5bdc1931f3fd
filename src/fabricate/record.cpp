#include "fabricate/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/error.h"
#include "base/files.h"
#include "config/writer.h"
#include "fabricate/formats.h"
#include "geometry/io/files.h"

namespace papilla::fabricate {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kWhiteHigh = "white-high";
constexpr const char* kWhiteDeep = "white-deep";

// One member after the other, each refused with its name where it is not what it should be.
class RecordReader {
 public:
  RecordReader(const Json& json, std::string folder)
      : json_(json), folder_(std::move(folder)), path_(folder_ + "/" + kRecordName) {}

  ExportRecord read() const {
    ExportRecord out;
    out.design = parse_study(text("design"), path_, {}, DesignUse::Drawn).design;
    ExportOptions& o = out.options;
    o.size = number("size", 0, 1);
    o.size_y = number("size_y", 0, 1);
    o.pixels = static_cast<int>(number("pixels", 8, 65536));
    o.repeat = static_cast<int>(number("repeat", 1, 4096));
    o.levels = static_cast<int>(number("levels", 1, kMostLevels));
    o.facet_error = number("facet_error", 0, 1);
    o.bias = {number("shrink", -1, 1), number("edge_rounding", 0, 1)};
    if (const Json& polarity = member("polarity"); !polarity.is_null()) {
      const std::string said = text("polarity");
      if (said != kWhiteHigh && said != kWhiteDeep) fail("polarity");
      o.polarity = said == kWhiteHigh ? Polarity::WhiteHigh : Polarity::WhiteDeep;
    }
    if (!member("dose_curve").is_null())
      o.dose_curve = DoseCurve{numbers("dose_curve", "depth"), numbers("dose_curve", "grey")};
    for (const auto& [name, limit] : member("limits").items()) {
      const auto found =
          std::find_if(constraint_kinds().begin(), constraint_kinds().end(),
                       [&key = name](const ConstraintKind& kind) { return kind.name == key; });
      if (!limit.is_number() || found == constraint_kinds().end() || !in_pixels(found->on, {}))
        fail("limits");
      out.limits.push_back({found->on, limit.get<double>(), found->at_least});
    }
    for (const Json& file : member("files")) read_file(file, out);
    if (json_.contains("version")) out.version = text("version");
    if (o.dose_curve &&
        (o.dose_curve->depth.size() < 2 || o.dose_curve->depth.size() != o.dose_curve->grey.size()))
      fail("dose_curve");
    return out;
  }

 private:
  [[noreturn]] void fail(const std::string& key) const {
    throw InputError({Problem{path_, 0, 0, "made_from." + key,
                              "not as `papilla export` writes it; export the design again"}});
  }
  const Json& member(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end()) fail(key);
    return *found;
  }
  double number(const char* key, double low, double high) const {
    const Json& value = member(key);
    if (!value.is_number() || !(value >= low && value <= high)) fail(key);
    return value;
  }
  std::string text(const char* key) const {
    const Json& value = member(key);
    if (!value.is_string()) fail(key);
    return value;
  }
  std::vector<double> numbers(const char* key, const char* part) const {
    const Json& list = member(key);
    std::vector<double> out;
    if (!list.is_object() || !list.contains(part) || !list[part].is_array()) fail(key);
    for (const Json& value : list[part]) {
      if (!value.is_number()) fail(key);
      out.push_back(value);
    }
    return out;
  }
  void read_file(const Json& file, ExportRecord& out) const {
    if (!file.is_object() || !file.contains("format") || !file.contains("file") ||
        !file["format"].is_string() || !file["file"].is_string())
      fail("files");
    const std::string format = file["format"], name = file["file"];
    if (name.empty() || name.find('/') != std::string::npos) fail("files");
    if (format != kDesignFormat) {
      if (find_export_format(format).needs_dose_curve && !out.options.dose_curve)
        fail("dose_curve");
      if (find_export_format(format).needs_polarity && !out.options.polarity) fail("polarity");
      out.options.formats.push_back(format);
    }
    out.files.push_back({format, folder_ + "/" + name});
  }

  const Json& json_;
  std::string folder_, path_;
};

}  // namespace

std::optional<double> in_pixels(const Limited& on, const PixelMargins& pixels) {
  const auto* shape = std::get_if<ShapeLimit>(&on);
  if (!shape) return std::nullopt;
  switch (shape->margin) {
    case ShapeMargin::MinHole:
      return pixels.min_hole;
    case ShapeMargin::MinWall:
      return pixels.min_wall;
    case ShapeMargin::AspectRatio:
      break;
  }
  return std::nullopt;
}

Design with_own_maps(const Design& design, const Folder& folder) {
  Design out = design;
  std::vector<std::pair<std::string, std::string>> copies;  // all read before any is written
  for (std::string* map : map_files(out)) {
    const MapName named = map_name(*map);
    const std::string number = copies.empty() ? "" : fmt::format("_{}", copies.size() + 1);
    copies.emplace_back("map" + number + std::filesystem::path(named.file).extension().string(),
                        read_bytes(named.file));
    *map = copies.back().first + (named.channel.empty() ? "" : "::" + named.channel);
  }
  for (const auto& [name, bytes] : copies) folder.write(name, bytes);
  return out;
}

ExportRecord record_of(const Study& study, const ExportOptions& options, const Export& result) {
  ExportRecord out{study.design, options, result.files, {}, PAPILLA_VERSION};
  // No file is made or judged by what is not known of the finger, and the belief lies elsewhere: a
  // record that named it could not be read on another machine.
  out.design.finger.belief.clear();
  out.options.formats.clear();
  for (const ExportedFile& file : result.files) {
    if (file.format != kDesignFormat) out.options.formats.push_back(file.format);
  }
  for (const Constraint& c : study.constraints) {
    if (in_pixels(c.on, {})) out.limits.push_back(c);
  }
  return out;
}

std::string record_json(const ExportRecord& record) {
  const ExportOptions& o = record.options;
  Json files = Json::array(), limits = Json::object(), dose, polarity;
  for (const ExportedFile& file : record.files) {
    files.push_back(
        {{"format", file.format}, {"file", std::filesystem::path(file.path).filename().string()}});
  }
  for (const Constraint& c : record.limits) limits[limit_name(c.on)] = c.limit;
  if (o.polarity) polarity = *o.polarity == Polarity::WhiteHigh ? kWhiteHigh : kWhiteDeep;
  if (o.dose_curve) dose = {{"depth", o.dose_curve->depth}, {"grey", o.dose_curve->grey}};
  return Json{{"design", to_toml(record.design)},
              {"size", o.size},
              {"size_y", o.size_y},
              {"pixels", o.pixels},
              {"polarity", polarity},
              {"repeat", o.repeat},
              {"levels", o.levels},
              {"facet_error", o.facet_error},
              {"shrink", o.bias.shrink},
              {"edge_rounding", o.bias.edge_radius},
              {"dose_curve", dose},
              {"limits", limits},
              {"files", files},
              {"version", record.version}}
      .dump();
}

ExportRecord read_record(const std::string& folder) {
  const std::string path = folder + "/" + kRecordName;
  if (!std::filesystem::exists(path)) {
    throw InputError({Problem{path, 0, 0, "",
                              "not there: no folder of `papilla export`, nor best/ or front/ of a "
                              "run; without it nothing says what the files should hold"}});
  }
  const Json json = Json::parse(read_bytes(path, 1 << 24), nullptr, false);
  const auto broken = [&](const char* why) -> InputError {
    return InputError({Problem{path, 0, 0, "", why}});
  };
  if (!json.is_object()) throw broken("no JSON object; export the design again");
  const auto made_from = json.find("made_from");
  if (made_from == json.end() || !made_from->is_object())
    throw broken("it does not say what the files were made from; export the design again");
  return RecordReader(*made_from, folder).read();
}

}  // namespace papilla::fabricate
