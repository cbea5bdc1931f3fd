// papilla export DESIGN.toml: heightmap and mask files.
#include "report/export.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "base/error.h"
#include "base/text.h"
#include "base/units.h"
#include "cli/commands.h"
#include "fabricate/formats.h"
#include "fabricate/verify.h"
#include "search/pick.h"

namespace papilla::cli {
namespace {

struct ExportCommand {
  DesignOptions design;
  std::vector<std::string> formats;
  std::string size, polarity, out, pick, shrink, edge_rounding, facet_error, dose_curve,
      tolerance = "5 %";
  int pixels = 1024, repeat = 1, levels = 1;
  bool verify = false;
};

// What is exported, and where its files go by default: beside a folder of results.
struct ExportSourceFile {
  std::string design, beside;
};

ExportSourceFile source_of(const ExportCommand& command) {
  namespace fs = std::filesystem;
  const fs::path named(command.design.file);
  if (command.pick.empty() && fs::exists(named / "design.toml"))  // front/02
    return {(named / "design.toml").string(), (named / "export").string()};
  if (fs::is_directory(named)) {
    const fs::path picked(picked_design_file(named.string(), command.pick));
    return {picked.string(),
            (named / "export" / picked.parent_path().lexically_relative(named)).string()};
  }
  if (!command.pick.empty())
    throw InputError("--pick chooses from a folder of results; " + named.string() + " is a file");
  return {named.string(), ""};
}

ExportOptions options_of(const ExportCommand& command) {
  ExportOptions options;
  options.formats = command.formats;
  options.pixels = command.pixels;
  if (!command.size.empty()) {
    options.size = parse_si(command.size, "um");
    if (!(options.size > 0 && options.size <= 1))
      throw InputError("--size: expected a length above 0 and up to 1 m");
  }
  if (!command.polarity.empty()) {
    options.polarity = command.polarity == "white-high" ? Polarity::WhiteHigh : Polarity::WhiteDeep;
  }
  options.repeat = command.repeat;
  options.levels = command.levels;
  options.dose_curve = command.dose_curve;
  if (!command.shrink.empty()) options.bias.shrink = parse_si(command.shrink, "nm");
  if (!command.edge_rounding.empty())
    options.bias.edge_radius = parse_si(command.edge_rounding, "nm");
  if (!command.facet_error.empty()) options.facet_error = parse_si(command.facet_error, "nm");
  if (!(options.facet_error > 0)) throw InputError("--facet-error: expected a length above 0");
  return options;
}

int export_files(const ExportCommand& command) {
  const ExportSourceFile source = source_of(command);
  const Study study = read_study(source.design, command.design.overrides);
  const ExportOptions options = options_of(command);
  const double tolerance = parse_si(command.tolerance, "%");
  const std::string folder = !command.out.empty()     ? command.out
                             : !source.beside.empty() ? source.beside
                                                      : "results/" + study.name + "/export";
  const Export result = export_with_record(study.design, options, folder);
  for (const std::string& warning : result.warnings) std::cerr << "warning: " << warning << '\n';
  std::optional<Verification> v;
  if (command.verify) {
    Study judged = study;  // the file is what the process turns into the design
    judged.design.texture = compensated(study.design.texture, options.bias);
    v = verify_export(judged, heights_file(result), tolerance);
  }
  std::cout << (command.design.json ? export_json(study.design, options, result, folder, v) + '\n'
                                    : export_text(result, folder, v));
  if (!v) return kSuccess;
  for (const std::string& fault : v->faults) std::cerr << "not sound: " << fault << '\n';
  return v->faults.empty() ? kSuccess : kWorkFailed;
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
                  join_names(export_formats()) + "; default: what the texture allows")
      .separator(',');
  command.add_option("--size", options->size,
                     "Side, rounded to whole periods, e.g. \"1 mm\"; default: about 12 um");
  command.add_option("--pixels", options->pixels, "Pixels along x").range(8, 65536).show_default();
  command
      .add_option("--polarity", options->polarity,
                  "white-high (bright is high) or white-deep; needed for tiff and mask")
      .one_of({"white-high", "white-deep"});
  command.add_option("--repeat", options->repeat, "EXR: the map so many times each way, streamed")
      .range(1, 4096);
  command.add_option("--levels", options->levels, "GDSII of a free form: layers, one per level")
      .range(1, 64);
  command.add_option("--facet-error", options->facet_error, "GDSII: of circles; default 2 nm");
  command.add_option("--shrink", options->shrink,
                     "The process moves each wall into the hole by this; undone in the files");
  command.add_option("--edge-rounding", options->edge_rounding,
                     "The process rounds rims by this; left out of the files");
  command.add_option("--dose-curve", options->dose_curve, "CSV depth_nm,grey: writes dose.png")
      .type_name("FILE");
  command.add_flag("--verify", options->verify,
                   "Read the heights back, measure holes and walls, simulate again");
  command.add_option("--tolerance", options->tolerance, "Largest loss of merit of --verify")
      .show_default();
  command
      .add_option("--out", options->out,
                  "Folder; default results/NAME/export, of a folder FILE in FILE/export")
      .type_name("DIR");
  add_pick_option(command, options->pick);
  command.on_chosen(
      [&context, options] { context.action = [options] { return export_files(*options); }; });
}

}  // namespace papilla::cli
