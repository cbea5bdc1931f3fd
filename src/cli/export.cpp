// papilla export DESIGN.toml: heightmap and mask files.
#include "report/export.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "base/error.h"
#include "base/folder.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/commands.h"
#include "cli/file_work.h"
#include "cli/scan_options.h"
#include "fabricate/formats.h"
#include "fabricate/verify.h"
#include "geometry/io/layout.h"
#include "geometry/texture.h"
#include "report/limits.h"
#include "report/results.h"
#include "search/pick.h"

namespace papilla::cli {
namespace {

// An option that some files alone depend on.
struct OptionOfFiles {
  Option option;
  // array: of the texture, whose layout repeats one shape; null: contours are drawn.
  bool (*shapes)(const ExportFormat& format, const FeatureArray* array);
  // Why no file of a texture depends on it, where none does.
  const char* of_no_file = "";
};

struct ExportCommand {
  DesignOptions design;
  std::vector<std::string> formats;
  std::string size, polarity, out, pick, shrink, edge_rounding, facet_error, dose_curve,
      tolerance = "5 %";
  int pixels = 1024, repeat = 1, levels = 1;
  bool verify = false, unrounded = false;
  std::vector<OptionOfFiles> of_files;
  std::vector<Option> of_verify;
};

// Throws InputError for an option that nothing of what is written depends on.
void refuse_without_effect(const ExportCommand& command, const Texture& design,
                           const ExportOptions& options) {
  const Texture drawn = compensated(design, options.bias);
  const TextureFacts known = facts(drawn);
  const std::vector<ExportFormat> written = chosen_formats(drawn, options);
  for (const OptionOfFiles& of : command.of_files) {
    if (!of.option.given()) continue;
    const std::string why = without_effect(
        written, of.option.name(), "--format",
        [&](const ExportFormat& format) { return of.shapes(format, array_of(known)); },
        of.of_no_file);
    if (!why.empty()) throw InputError(why);
  }
  if (!command.verify) refuse(command.of_verify, "--verify: add that, or leave --tolerance out");
}

// What is exported, and where its files go by default: beside a folder of results.
struct ExportSourceFile {
  std::string design, beside;
  std::string run{};   // the folder of results that it is of; "": of none
  bool built = false;  // the build sheet's design
};

ExportSourceFile source_of(const ExportCommand& command) {
  namespace fs = std::filesystem;
  const fs::path named(command.design.file);
  const bool folder_of_design = command.pick.empty() && fs::exists(named / "design.toml");
  if (!folder_of_design && !fs::is_directory(named)) {
    if (!command.pick.empty())
      throw InputError("--pick chooses from a folder of results; " + named.string() + " is a file");
    if (command.unrounded)
      throw InputError("--unrounded is for a folder of results; " + named.string() + " is a file");
    return {named.string(), ""};
  }
  const fs::path found = folder_of_design
                             ? named / "design.toml"  // front/02
                             : fs::path(picked_design_file(named.string(), command.pick));
  const fs::path beside = folder_of_design
                              ? named / "export"
                              : named / "export" / found.parent_path().lexically_relative(named);
  // As it was named: the record of the files has no other place of this machine.
  fs::path run = folder_of_design ? (named / "..").lexically_normal() : named;
  if (!run.has_filename()) run = run.parent_path();  // "run/"
  const fs::path build = found.parent_path() / "build.toml";
  if (!command.unrounded && fs::exists(build))
    return {build.string(), beside.string(), run.string(), true};
  return {found.string(), beside.string(), run.string()};
}

// "1 mm", or "110x62 mm", "110 mm x 62 mm": one side, or both.
std::pair<double, std::optional<double>> parse_sides(const std::string& text) {
  constexpr std::string_view kTimes = "×";
  const std::size_t times = text.find(kTimes), letter = text.find('x');
  const std::size_t cross = std::min(times, letter);
  if (cross == std::string::npos) return {parse_si(text, "um"), std::nullopt};
  const std::string_view all = text, first = all.substr(0, cross),
                         second = all.substr(cross + (cross == times ? kTimes.size() : 1));
  const auto width = parse_quantity(first), height = parse_quantity(second);
  // "110x62 mm": the unit of the second is that of both.
  const bool bare = width && width->unit.empty() && height;
  return {parse_si(bare ? fmt::format("{} {}", first, height->unit) : std::string(first), "um"),
          parse_si(second, "um")};
}

ExportOptions options_of(const ExportCommand& command) {
  ExportOptions options;
  options.formats = command.formats;
  options.pixels = command.pixels;
  if (!command.size.empty()) {
    const auto [width, height] = parse_sides(command.size);
    const auto allowed = [](double side) { return side > 0 && side <= 1; };
    if (!allowed(width) || (height && !allowed(*height)))
      throw InputError("--size: expected lengths above 0 and up to 1 m");
    options.size = width;
    options.size_y = height.value_or(0);
  }
  if (!command.polarity.empty()) {
    options.polarity = command.polarity == "white-high" ? Polarity::WhiteHigh : Polarity::WhiteDeep;
  }
  options.repeat = command.repeat;
  options.levels = command.levels;
  if (!command.dose_curve.empty()) options.dose_curve = read_dose_curve(command.dose_curve);
  if (!command.shrink.empty()) options.bias.shrink = parse_si(command.shrink, "nm");
  if (!command.edge_rounding.empty())
    options.bias.edge_radius = parse_si(command.edge_rounding, "nm");
  if (!(options.bias.edge_radius >= 0))
    throw InputError("--edge-rounding: expected a radius, 0 or above");
  if (!command.facet_error.empty()) options.facet_error = parse_si(command.facet_error, "nm");
  if (!(options.facet_error > 0)) throw InputError("--facet-error: expected a length above 0");
  return options;
}

int export_files(const Context& context, const ExportCommand& command) {
  const ExportSourceFile source = source_of(command);
  DesignOptions chosen = command.design;
  chosen.file = source.design;
  // Only --verify simulates: without it files are drawn of a design that no simulation settles too.
  const Study study = chosen.study(command.verify ? DesignUse::Simulated : DesignUse::Drawn);
  const ExportOptions options = options_of(command);
  refuse_without_effect(command, study.design.texture, options);
  if (source.built) context.note(source.design + ": " + build_sheet_text(source.run));
  if (!facts(study.design.texture).relief.present)
    context.note(source.design + ": a flat surface, so every height is 0" +
                 (source.beside.empty() || !command.pick.empty()
                      ? ""
                      : "; --pick takes a texture of the front by its number"));
  say_scans({study.design});
  const double tolerance = parse_si(command.tolerance, "%");
  const std::string folder = !command.out.empty()     ? command.out
                             : !source.beside.empty() ? source.beside
                                                      : "results/" + study.name + "/export";
  // The results may be a stranger's: no link in them is followed.
  if (command.out.empty() && !source.beside.empty()) {
    const std::filesystem::path results(command.design.file);
    Folder(results).made_below(std::filesystem::path(folder).lexically_relative(results).string());
  }
  Export result;
  ExportVerdict verdict;
  std::vector<std::string> warnings;
  if (std::string none = none_keeps_text(source.run); !none.empty())
    warnings.push_back(std::move(none));
  {
    FileWork work(context, "writing");
    result = export_with_record(study, options, folder, work.progress(), {}, warnings);
  }
  for (const std::string& warning : result.warnings)
    std::cerr << "warning: " << visible(warning) << '\n';
  {
    FileWork work(context, "checking");
    const ExportRecord record = record_of(study, options, result);
    verdict.files = verify_files(record, result, work.progress());
    if (command.verify) {
      work.progress()("how the heights of " + folder + " feel", 0);
      verdict.felt = verify_export(record, tolerance);
    }
  }
  std::cout << (command.design.json ? export_json(study, options, result, folder, verdict) + '\n'
                                    : visible(export_text(result, folder, verdict)));
  return verdict_status(verdict);
}

}  // namespace

void add_export(Command app, Context& context) {
  Command command = app.add_command("export", "Heightmap and mask files of a design");
  auto options = std::make_shared<ExportCommand>();
  command.add_option("file", options->design.file, "Design or study file, or a folder of results")
      .required()
      .type_name("FILE");
  add_set_option(command, options->design.overrides);
  command.add_flag("--json", options->design.json, "One JSON object on standard output");
  command
      .add_option("--format", options->formats,
                  join_names(export_formats()) +
                      "; several by commas, or named again; default: what the texture allows")
      .separator(',')
      .repeatable();
  command.add_option("--size", options->size,
                     "Side, or both of them, rounded to whole periods: \"1 mm\", \"110x62 mm\"; "
                     "default: about 12 um");
  command.add_option("--pixels", options->pixels, "Pixels along x").range(8, 65536).show_default();
  options->of_files.push_back(
      {command
           .add_option("--polarity", options->polarity,
                       "white-high (bright is high) or white-deep; needed for tiff and mask")
           .one_of({"white-high", "white-deep"}),
       [](const ExportFormat& format, const FeatureArray*) { return format.needs_polarity; }});
  options->of_files.push_back(
      {command
           .add_option("--repeat", options->repeat,
                       "Of the EXR alone: the map so many times each way, streamed; --size is of "
                       "all files")
           .range(1, 4096),
       [](const ExportFormat& format, const FeatureArray*) { return format.repeated; }});
  options->of_files.push_back(
      {command
           .add_option("--levels", options->levels, "Layout of a free form: layers, one per level")
           .range(1, kMostLevels),
       [](const ExportFormat& format, const FeatureArray* array) {
         return format.needs_outline && !array;
       },
       "the layout of holes, pillars and grooves has one layer"});
  options->of_files.push_back(
      {command.add_option("--facet-error", options->facet_error,
                          "Layouts: of circles; default 2 nm"),
       [](const ExportFormat& format, const FeatureArray* array) {
         return format.needs_outline && array && array->shape == FeatureArray::Shape::Disc;
       },
       "the layout of this texture has no circles; contours follow --pixels, and grooves are "
       "straight"});
  command.add_option("--shrink", options->shrink,
                     "The process moves each wall into the hole by this; undone in the files");
  options->of_files.push_back(
      {command.add_option("--edge-rounding", options->edge_rounding,
                          "The process rounds rims by this; left out of the files"),
       [](const ExportFormat& format, const FeatureArray*) { return format.has_pixels(); }});
  options->of_files.push_back(
      {command.add_option("--dose-curve", options->dose_curve, "CSV depth_nm,grey: writes dose.png")
           .type_name("FILE"),
       [](const ExportFormat& format, const FeatureArray*) { return format.needs_dose_curve; }});
  command.add_flag(
      "--verify", options->verify,
      "Also measure holes and walls in the written heights and simulate them (every file is "
      "held against the design in any case)");
  options->of_verify = {
      command.add_option("--tolerance", options->tolerance, "Largest loss of merit of --verify")
          .check(share_mistake)
          .show_default()};
  command
      .add_option("--out", options->out,
                  "Folder; default results/NAME/export, of a folder FILE in FILE/export")
      .type_name("DIR");
  add_pick_option(command, options->pick);
  command.add_flag(
      "--unrounded", options->unrounded,
      "Of a folder of results the design as the search left it; without it that of the "
      "build sheet, rounded to the grid of the fab");
  command.document(
      {"Writes a design as heightmaps, masks and layouts, in whole periods, and holds every file "
       "against the design again. TIFF and masks need a polarity, since a wrong one inverts the "
       "plate.",
       {{"papilla export m3_samples/a3h600.toml --format exr --format gds",
         "a heightmap and a layout"},
        {"papilla export m3_samples/a3h600.toml --format mask --polarity white-deep --size \"1 "
         "mm\" --pixels 4096",
         "a mask of a square millimetre"},
        {"papilla export m3_samples/a3h600.toml --verify", "simulate what was written, too"}},
       {{"heightmap.exr, .tif, .gsf, .x3p, .npy, .png", "heights"},
        {"texture.stl, texture.gds, texture.oas, mask.tif, dose.png", "for makers"},
        {"export.json",
         "where each file comes from and what is in it: `papilla verify` reads it"}}});
  command.on_chosen([&context, options] {
    context.action = [&context, options] { return export_files(context, *options); };
  });
}

}  // namespace papilla::cli
