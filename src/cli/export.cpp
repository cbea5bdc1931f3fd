// papilla export DESIGN.toml: heightmap and mask files.
#include "fabricate/export.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/error.h"
#include "base/files.h"
#include "base/units.h"
#include "cli/commands.h"
#include "fabricate/verify.h"
#include "search/pick.h"

namespace papilla {
namespace {

struct ExportCommand {
  DesignOptions design;
  std::vector<std::string> formats;
  std::string size, polarity, out, pick, shrink, edge_rounding, facet_error, dose_curve,
      tolerance = "5 %";
  int pixels = 1024, repeat = 1, levels = 1;
  bool verify = false;
};

// The first of the files that holds heights to be read back.
std::string heights_file(const Export& result) {
  for (const char* format : {"exr", "gsf", "tiff32", "tiff"}) {
    for (const ExportedFile& file : result.files)
      if (file.format == format) return file.path;
  }
  throw InputError("--verify needs a file of heights: exr, gsf, tiff32 or tiff");
}

// export.json of the folder, and the judgement where there is one.
void print_json(const std::string& folder, const std::optional<Verification>& v) {
  using Json = nlohmann::ordered_json;
  const auto number = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
  Json out = Json::parse(read_bytes(folder + "/export.json"));
  out["folder"] = folder;
  if (v) {
    out["verification"] = {{"min_hole", number(v->pixels.min_hole)},
                           {"min_wall", number(v->pixels.min_wall)},
                           {"pixel", v->pixels.pixel},
                           {"merit", v->merit},
                           {"design", number(v->design)},
                           {"file", number(v->file)},
                           {"loss", number(v->loss)},
                           {"faults", v->faults}};
  }
  std::cout << out.dump(2) << '\n';
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

int export_files(const ExportCommand& command) {
  namespace fs = std::filesystem;
  std::string source = command.design.file, beside;  // beside: where the files go by default
  if (command.pick.empty() && fs::exists(fs::path(source) / "design.toml")) {  // front/02
    beside = (fs::path(source) / "export").string();
    source = (fs::path(source) / "design.toml").string();
  } else if (fs::is_directory(source)) {
    const fs::path picked(picked_design_file(source, command.pick));
    beside =
        (fs::path(source) / "export" / picked.parent_path().lexically_relative(source)).string();
    source = picked.string();
  } else if (!command.pick.empty()) {
    throw InputError("--pick chooses from a folder of results; " + source + " is a file");
  }
  const Study study = read_study(source, command.design.overrides);
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
  const double tolerance = parse_si(command.tolerance, "%");
  const std::string folder = !command.out.empty() ? command.out
                             : !beside.empty()    ? beside
                                                  : "results/" + study.name + "/export";
  const Export result = export_design(study.design, options, folder);
  for (const std::string& warning : result.warnings) std::cerr << "warning: " << warning << '\n';
  std::optional<Verification> v;
  if (command.verify) {
    Study judged = study;  // the file is what the process turns into the design
    judged.design.texture = compensated(study.design.texture, options.bias);
    v = verify_export(judged, heights_file(result), tolerance);
  }
  if (command.design.json) {
    print_json(folder, v);
  } else {
    for (const ExportedFile& file : result.files) std::cout << file.path << '\n';
    std::cout << folder << "/export.json\n" << size_line(result);
    if (v) {
      std::cout << fmt::format(
          "smallest hole {:.3g} um, smallest wall {:.3g} um (pixel {:.2g} um); {} {:.4g}, of the "
          "design {:.4g}: {:.2g} % off\n",
          1e6 * v->pixels.min_hole, 1e6 * v->pixels.min_wall, 1e6 * v->pixels.pixel, v->merit,
          v->file, v->design, 100 * v->loss);
    }
  }
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
      .add_option(
          "--format", options->formats,
          "exr, tiff, tiff32, mask, gsf, npy, png, png16, x3p, gds, stl, dose; default: what the "
          "texture allows")
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
  command.add_option("--levels", options->levels, "GDSII of a free form: layers, one a level")
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

}  // namespace papilla
